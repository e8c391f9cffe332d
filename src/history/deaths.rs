//! The dead simplices of a decimation, in few bytes.
//!
//! Some five triangles die for every vertex of the input, and nothing reads them until the
//! decimator has ended. In the form of a history they take 20 bytes each and would be most of the
//! memory of a build. Triangles that die together share corners, births and the step; written as
//! differences from the record before, a triangle takes 6 to 8 bytes.
//!
//! No branch predictor can guess which corners a record shares and how long its numbers are. So
//! neither is a branch: a number is written as one whole word, and the next number begins where the
//! last significant byte of the word ends, or at the start of the word if it has none.

/// Bytes of a chunk. A chunk does not move while it fills, and is freed when it has been read;
/// allocators map blocks of this size.
const CHUNK_BYTES: usize = 1 << 17;

/// Most bytes of a number: 35 bits, 7 per byte.
const MAX_NUMBER_BYTES: usize = 5;

/// Bytes written or read for a number, whatever its length.
const WORD_BYTES: usize = size_of::<u64>();

/// Room for one record, with its last number as a whole word: corner codes, up to four corners,
/// birth and step.
const ROOM_BYTES: usize = 1 + (4 + 1) * MAX_NUMBER_BYTES + WORD_BYTES;

/// Code of a corner that is not among the first three of the record before.
const NEW: u8 = 3;

/// Values of a birth below those that give an age.
const BIRTH_AS_BEFORE: u64 = 0;
const BIRTH_AT_START: u64 = 1;
const FIRST_AGE: u64 = 2;

/// How many steps after the record before a simplex dies, in the lowest bits of its birth: 0, 1, or
/// a number that follows.
const LATER: u64 = 2;
const STEP_BITS: u32 = 2;

/// Simplices of up to four corners in order of death, with births and deaths.
///
/// Memory: 6 to 8 bytes per triangle if neighbours have similar numbers, at most 32.
#[derive(Clone, Debug)]
pub(super) struct Deaths<const CORNERS: usize> {
    chunks: Vec<Chunk>,
    len: usize,
    last: Record<CORNERS>,
}

/// Records one after the other, with room for one more after them.
#[derive(Clone, Debug)]
struct Chunk {
    bytes: Vec<u8>,
    /// Where the records end.
    end: usize,
}

/// A simplex that has lived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Record<const CORNERS: usize> {
    pub(super) simplex: [u32; CORNERS],
    pub(super) birth: u32,
    pub(super) death: u32,
}

impl<const CORNERS: usize> Record<CORNERS> {
    /// The first record is written as a difference from this one.
    const START: Self = Self { simplex: [0; CORNERS], birth: 0, death: 0 };
}

impl<const CORNERS: usize> Deaths<CORNERS> {
    /// An empty list.
    pub(super) fn new() -> Self {
        const { assert!(CORNERS <= 4, "a room is for so many corners") };
        Self { chunks: vec![], len: 0, last: Record::START }
    }

    /// Number of simplices that have died.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Appends a record that dies no earlier than the last one, and after its own birth.
    pub(super) fn push(&mut self, record: Record<CORNERS>) {
        if self.chunks.last().is_none_or(|chunk| chunk.end + ROOM_BYTES > CHUNK_BYTES) {
            self.chunks.push(Chunk { bytes: vec![0; CHUNK_BYTES], end: 0 });
        }
        // The last chunk exists and has room.
        let Some(Chunk { bytes, end }) = self.chunks.last_mut() else { return };
        let Some(room) = bytes[*end..].first_chunk_mut() else { return };
        *end += write(room, record, self.last);
        self.last = record;
        self.len += 1;
    }

    /// Passes all records to `take`, in order, and frees what has been read.
    pub(super) fn drain(self, mut take: impl FnMut(Record<CORNERS>)) {
        let mut last = Record::START;
        for Chunk { bytes, end } in self.chunks {
            let mut at = 0;
            while at < end
                && let Some(room) = bytes[at..].first_chunk()
            {
                let (record, len) = read(room, last);
                take(record);
                last = record;
                at += len;
            }
        }
    }
}

/// Writes `record` as a difference from `last`; returns the number of bytes.
fn write<const CORNERS: usize>(
    room: &mut [u8; ROOM_BYTES],
    record: Record<CORNERS>,
    last: Record<CORNERS>,
) -> usize {
    let (mut codes, mut len) = (0, 1);
    for (at, &v) in record.simplex.iter().enumerate() {
        let code = code(&last.simplex, v);
        codes |= code << (2 * at);
        let end = put(room, len, zigzag(v, last.simplex[0]));
        len = if code == NEW { end } else { len };
    }
    room[0] = codes;
    let n_steps = u64::from(record.death - last.death);
    let age = match record.birth {
        birth if birth == last.birth => BIRTH_AS_BEFORE,
        0 => BIRTH_AT_START,
        birth => FIRST_AGE + u64::from(record.death - birth),
    };
    len = put(room, len, age << STEP_BITS | n_steps.min(LATER));
    if n_steps >= LATER {
        len = put(room, len, n_steps);
    }
    len
}

/// The record at the beginning of `room`, and its number of bytes.
fn read<const CORNERS: usize>(room: &[u8; ROOM_BYTES], last: Record<CORNERS>) -> (Record<CORNERS>, usize) {
    let mut simplex = last.simplex;
    let mut len = 1;
    for (at, v) in simplex.iter_mut().enumerate() {
        let code = room[0] >> (2 * at) & NEW;
        let (value, end) = get(room, len);
        (*v, len) = match code {
            NEW => (unzigzag(value, last.simplex[0]), end),
            code => (last.simplex[usize::from(code)], len),
        };
    }
    let (value, mut len) = get(room, len);
    let mut n_steps = value & ((1 << STEP_BITS) - 1);
    if n_steps == LATER {
        (n_steps, len) = get(room, len);
    }
    let death = last.death.wrapping_add(low(n_steps));
    let birth = match value >> STEP_BITS {
        BIRTH_AS_BEFORE => last.birth,
        BIRTH_AT_START => 0,
        age => death.wrapping_sub(low(age - FIRST_AGE)),
    };
    (Record { simplex, birth, death }, len)
}

/// The first of the first three corners of `last` that is `v`, or [`NEW`].
#[expect(clippy::cast_possible_truncation, reason = "a place among three")]
fn code<const CORNERS: usize>(last: &[u32; CORNERS], v: u32) -> u8 {
    let places = last.iter().enumerate().take(usize::from(NEW)).rev();
    places.fold(NEW, |code, (at, &corner)| if corner == v { at as u8 } else { code })
}

/// The difference of two numbers as a number that is small if they are close.
fn zigzag(v: u32, from: u32) -> u64 {
    let difference = i64::from(v) - i64::from(from);
    (difference << 1 ^ difference >> 63).cast_unsigned()
}

fn unzigzag(value: u64, from: u32) -> u32 {
    let difference = low(value >> 1) ^ 0_u32.wrapping_sub(low(value & 1));
    from.wrapping_add(difference)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "numbers here were made of 32 bits; differences are taken modulo 2^32"
)]
fn low(value: u64) -> u32 {
    value as u32
}

/// The highest bit of each byte of a number except the last.
const MORE: u64 = 0x80_8080_8080;

/// Writes a number of at most 35 bits, 7 bits per byte, lowest first. The highest bit of a byte
/// tells whether more follow. Returns the end.
fn put(room: &mut [u8; ROOM_BYTES], at: usize, value: u64) -> usize {
    let n_bytes = 1 + (value | 1).ilog2() as usize / 7;
    let sevens = (0..MAX_NUMBER_BYTES).fold(0, |word, i| word | (value & 0x7f << (7 * i)) << i);
    let word = sevens | MORE & !(u64::MAX << (8 * (n_bytes - 1)));
    room[at..at + WORD_BYTES].copy_from_slice(&word.to_le_bytes());
    at + n_bytes
}

/// The number at a position, and its end.
fn get(room: &[u8; ROOM_BYTES], at: usize) -> (u64, usize) {
    let word = room[at..].first_chunk().map_or(0, |&bytes| u64::from_le_bytes(bytes));
    // The lowest byte without the bit is the last one; clear everything above its lowest bit.
    let last = !word & MORE;
    let n_bytes = 1 + last.trailing_zeros() as usize / 8;
    let word = word & (last ^ last.wrapping_sub(1));
    let value = (0..MAX_NUMBER_BYTES).fold(0, |value, i| value | (word & 0x7f << (8 * i)) >> i);
    (value, at + n_bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check<const CORNERS: usize>(lives: Vec<([u32; CORNERS], u32, u32)>) {
        let mut deaths = Deaths::new();
        let mut death = 1;
        let records: Vec<Record<CORNERS>> = lives
            .into_iter()
            .map(|(simplex, birth, n_steps)| {
                death += n_steps;
                Record { simplex, birth: birth % death, death }
            })
            .collect();
        records.iter().for_each(|&record| deaths.push(record));
        assert_eq!(deaths.len(), records.len());
        let mut read = vec![];
        deaths.drain(|record| read.push(record));
        assert_eq!(read, records);
    }

    fn lives<const CORNERS: usize>() -> impl Strategy<Value = Vec<([u32; CORNERS], u32, u32)>> {
        let vertex = prop_oneof![0_u32..8, any::<u32>()];
        let n_steps = prop_oneof![0_u32..4, 0_u32..1 << 20];
        let birth = prop_oneof![0_u32..3, any::<u32>()];
        let simplex = prop::collection::vec(vertex, CORNERS).prop_map(|corners| corners.try_into().unwrap());
        prop::collection::vec((simplex, birth, n_steps), 0..300)
    }

    proptest! {
        #[test]
        fn triangles_come_back_as_they_were(lives in lives::<3>()) {
            check(lives);
        }

        #[test]
        fn tetrahedra_come_back_as_they_were(lives in lives::<4>()) {
            check(lives);
        }
    }

    #[test]
    fn numbers_of_every_length_end_where_the_next_begins() {
        let around = |bits: u32| [(1_u64 << bits) - 1, 1 << bits];
        for value in (0..35).flat_map(around).chain([(1 << 35) - 1]) {
            let n_bytes = (1..).find(|n_bytes| value >> (7 * n_bytes) == 0).unwrap();
            let mut room = [0xff; ROOM_BYTES];
            for at in [1, ROOM_BYTES - WORD_BYTES] {
                assert_eq!(put(&mut room, at, value), at + n_bytes, "{value:#x}");
                assert_eq!(get(&room, at), (value, at + n_bytes), "{value:#x}");
            }
        }
    }

    #[test]
    fn the_longest_records_fill_chunks_to_their_ends() {
        let far =
            |at: u32| [[0, 1, 2, 3], [u32::MAX, u32::MAX - 1, u32::MAX - 2, u32::MAX - 3]][at as usize % 2];
        check::<4>((0..9000).map(|at| (far(at), at, 1 << 18)).collect());
        let record = Record { simplex: [u32::MAX; 4], birth: 1, death: u32::MAX };
        let longest = 1 + (4 + 2) * MAX_NUMBER_BYTES;
        assert_eq!(write(&mut [0; ROOM_BYTES], record, Record::START), longest);
    }

    #[test]
    fn chunks_follow_one_another_and_neighbours_take_few_bytes() {
        let fans = (0..40_000_u32)
            .map(|at| ([at / 6, at % 6 + 1000, (at + 1) % 6 + 1000], at / 7, u32::from(at % 6 == 0)));
        let mut deaths = Deaths::new();
        let mut death = 40_000;
        for (simplex, birth, n_steps) in fans.clone() {
            death += n_steps;
            deaths.push(Record { simplex, birth, death });
        }
        assert!(
            deaths.chunks.len() > 1
                && deaths.chunks.iter().map(|chunk| chunk.end).sum::<usize>() < 8 * 40_000
        );
        check(fans.collect());
    }
}
