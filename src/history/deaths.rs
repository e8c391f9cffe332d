//! The dead of a decimation, packed.
//!
//! Some five triangles die for every vertex of the input, and nobody reads them before the decimator is done. As a history holds them
//! they take 20 bytes each, and would be the most of what a build keeps in memory. But those that die together share corners, births
//! and the step: written as differences from the one before, a triangle takes 6 to 8 bytes.

/// Bytes of a chunk. Chunks neither move while they fill nor stay when they have been read: allocators map blocks of this size.
const CHUNK_BYTES: usize = 1 << 17;

/// Most bytes of a record: corner codes, corners, birth and step.
const MAX_RECORD_BYTES: usize = 1 + 4 * 5 + 6 + 5;

/// Code of a corner that is none of the first three of the simplex before.
const NEW: u8 = 3;

/// Values of a birth before those that tell an age.
const BIRTH_AS_BEFORE: u64 = 0;
const BIRTH_AT_START: u64 = 1;
const FIRST_AGE: u64 = 2;

/// How many steps after the one before a simplex dies, in the lowest bits of its birth: none, one, or a number that follows.
const LATER: u64 = 2;
const STEP_BITS: u32 = 2;

/// Simplices in order of death, with births and deaths, of up to four corners.
///
/// Memory: 6 to 8 bytes per triangle where neighbours have near numbers, at most 32.
#[derive(Clone, Debug)]
pub(super) struct Deaths<const CORNERS: usize> {
    chunks: Vec<Vec<u8>>,
    len: usize,
    last: Record<CORNERS>,
}

/// A simplex that has lived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Record<const CORNERS: usize> {
    pub(super) simplex: [u32; CORNERS],
    pub(super) birth: u32,
    pub(super) death: u32,
}

impl<const CORNERS: usize> Record<CORNERS> {
    /// What the first one is written as a difference from.
    const START: Self = Self { simplex: [0; CORNERS], birth: 0, death: 0 };
}

impl<const CORNERS: usize> Deaths<CORNERS> {
    /// Nobody has died.
    pub(super) fn new() -> Self {
        Self { chunks: vec![], len: 0, last: Record::START }
    }

    /// How many have died.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Writes one down that dies no earlier than the one before, and after its birth.
    pub(super) fn push(&mut self, record: Record<CORNERS>) {
        let last = std::mem::replace(&mut self.last, record);
        self.len += 1;
        let chunk = match self.chunks.last_mut() {
            Some(chunk) if chunk.len() + MAX_RECORD_BYTES <= CHUNK_BYTES => chunk,
            _ => {
                self.chunks.push(Vec::with_capacity(CHUNK_BYTES));
                let at = self.chunks.len() - 1;
                &mut self.chunks[at]
            }
        };
        let codes = record.simplex.map(|v| code(&last.simplex, v));
        chunk.push((0..).zip(codes).fold(0, |all, (at, code)| all | code << (2 * at)));
        for (v, _) in record.simplex.into_iter().zip(codes).filter(|&(_, code)| code == NEW) {
            put(chunk, zigzag(v, last.simplex[0]));
        }
        let n_steps = u64::from(record.death - last.death);
        let age = match record.birth {
            birth if birth == last.birth => BIRTH_AS_BEFORE,
            0 => BIRTH_AT_START,
            birth => FIRST_AGE + u64::from(record.death - birth),
        };
        put(chunk, age << STEP_BITS | n_steps.min(LATER));
        if n_steps >= LATER {
            put(chunk, n_steps);
        }
    }

    /// Shows `take` all of them in order, letting go of what has been read.
    pub(super) fn drain(self, mut take: impl FnMut(Record<CORNERS>)) {
        let mut last = Record::START;
        for chunk in self.chunks {
            let mut bytes = chunk.as_slice();
            while let Some(record) = read(&mut bytes, last) {
                take(record);
                last = record;
            }
        }
    }
}

/// The next record of a chunk, or `None` at its end.
fn read<const CORNERS: usize>(bytes: &mut &[u8], last: Record<CORNERS>) -> Option<Record<CORNERS>> {
    let (&codes, rest) = bytes.split_first()?;
    *bytes = rest;
    let simplex = std::array::from_fn(|at| match codes >> (2 * at) & NEW {
        NEW => unzigzag(get(bytes), last.simplex[0]),
        code => last.simplex[usize::from(code)],
    });
    let value = get(bytes);
    let n_steps = match value & ((1 << STEP_BITS) - 1) {
        LATER => get(bytes),
        n_steps => n_steps,
    };
    let death = last.death.wrapping_add(low(n_steps));
    let birth = match value >> STEP_BITS {
        BIRTH_AS_BEFORE => last.birth,
        BIRTH_AT_START => 0,
        age => death.wrapping_sub(low(age - FIRST_AGE)),
    };
    Some(Record { simplex, birth, death })
}

/// Which of the first three corners of the simplex before `v` is.
#[expect(clippy::cast_possible_truncation, reason = "a place among three")]
fn code<const CORNERS: usize>(last: &[u32; CORNERS], v: u32) -> u8 {
    last.iter().take(usize::from(NEW)).position(|&corner| corner == v).map_or(NEW, |at| at as u8)
}

/// The difference of two numbers, small where they are near.
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

/// Writes a number by seven bits a byte, lowest first, the highest bit of each telling whether there are more.
fn put(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push((value & 0x7f) as u8 | 0x80);
        value >>= 7;
    }
    bytes.push((value & 0x7f) as u8);
}

fn get(bytes: &mut &[u8]) -> u64 {
    let mut value = 0;
    for shift in (0..u64::BITS).step_by(7) {
        let Some((&byte, rest)) = bytes.split_first() else { break };
        *bytes = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            break;
        }
    }
    value
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
    fn chunks_follow_one_another_and_neighbours_take_few_bytes() {
        let fans = (0..40_000_u32)
            .map(|at| ([at / 6, at % 6 + 1000, (at + 1) % 6 + 1000], at / 7, u32::from(at % 6 == 0)));
        let mut deaths = Deaths::new();
        let mut death = 40_000;
        for (simplex, birth, n_steps) in fans.clone() {
            death += n_steps;
            deaths.push(Record { simplex, birth, death });
        }
        assert!(deaths.chunks.len() > 1 && deaths.chunks.iter().map(Vec::len).sum::<usize>() < 8 * 40_000);
        check(fans.collect());
    }
}
