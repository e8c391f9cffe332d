//! The compact form of slots: each simplex once, stamps and indices as narrow as their ranges
//! allow.
//!
//! A renderer draws from slots as they lie, so the plain form holds every simplex once in its
//! node's birth list and once in its death list, and in windowed files in every window that sees
//! it. On a disk or a wire that is waste: here a slot either brings a new simplex or names an
//! earlier one. Opening such a file lays the slots out again in memory, once.

use super::pieces::Pieces;
use super::{CompactFault, OpenError};
use crate::flat::NO_INDEX;
use nephrite_formats::neph::{index_bytes, stamp_bytes};

/// Bits of a word.
const WORD_BITS: usize = u64::BITS as usize;

/// What a file of compact form holds instead of the simplices of its slots.
pub(super) struct CompactSlots {
    /// Id of a piece for each distinct simplex, in the order of first slots.
    pub distinct: Vec<u32>,
    /// A bit per slot, set where the simplex is one of an earlier slot.
    pub repeat_bits: Vec<u64>,
    /// For each set bit, the place of the simplex in `distinct`.
    pub repeat_sources: Vec<u32>,
}

impl CompactSlots {
    /// `slots` holds the id of a piece each. Memory: 4 bytes per simplex of the history and per
    /// slot.
    pub(super) fn new<const CORNERS: usize>(slots: &[u32], pieces: &Pieces<'_, CORNERS>) -> Self {
        let mut places = vec![NO_INDEX; pieces.n_simplices()];
        let (mut distinct, mut repeat_sources) = (Vec::new(), Vec::new());
        let mut repeat_bits = vec![0u64; slots.len().div_ceil(WORD_BITS)];
        let mut next = 0;
        for (slot, &id) in slots.iter().enumerate() {
            let place = &mut places[pieces.simplex(id) as usize];
            if *place == NO_INDEX {
                *place = next;
                next += 1;
                distinct.push(id);
            } else {
                repeat_bits[slot / WORD_BITS] |= 1 << (slot % WORD_BITS);
                repeat_sources.push(*place);
            }
        }
        Self { distinct, repeat_bits, repeat_sources }
    }
}

/// Numbers of 2 or 4 bytes.
#[derive(Clone, Copy)]
pub(super) enum Narrow<'a> {
    /// 2 bytes each.
    U16(&'a [u16]),
    /// 4 bytes each.
    U32(&'a [u32]),
}

impl<'a> Narrow<'a> {
    /// Vertex indices of a file; nothing if the bytes are no whole number of them.
    pub(super) fn indices(bytes: &'a [u8], n_vertices: u64) -> Self {
        Self::new(bytes, index_bytes(n_vertices))
    }

    /// Stamps of a file; nothing if the bytes are no whole number of them.
    pub(super) fn stamps(bytes: &'a [u8], n_levels: u32) -> Self {
        Self::new(bytes, stamp_bytes(n_levels))
    }

    fn new(bytes: &'a [u8], width: u64) -> Self {
        match width {
            2 => Self::U16(bytemuck::try_cast_slice(bytes).unwrap_or(&[])),
            _ => Self::U32(bytemuck::try_cast_slice(bytes).unwrap_or(&[])),
        }
    }

    fn get(self, place: usize) -> Option<u32> {
        match self {
            Self::U16(numbers) => numbers.get(place).map(|&number| u32::from(number)),
            Self::U32(numbers) => numbers.get(place).copied(),
        }
    }
}

/// The sections of the compact form.
#[derive(Clone, Copy)]
pub(super) struct CompactSections<'a> {
    /// Corners of a simplex.
    pub n_corners: usize,
    /// Slots of the file.
    pub n_slots: usize,
    /// Corners of the distinct simplices.
    pub distinct: Narrow<'a>,
    /// See [`CompactSlots`].
    pub repeat_bits: &'a [u64],
    /// See [`CompactSlots`].
    pub repeat_sources: &'a [u32],
    /// A stamp per slot.
    pub stamps: Narrow<'a>,
}

/// Slots in the plain form, made from the compact one.
pub(super) struct Expanded {
    /// Corners of the simplex in each slot.
    pub simplices: Vec<u32>,
    /// A stamp per slot.
    pub stamps: Vec<u32>,
}

impl CompactSections<'_> {
    /// Lays the slots out in the plain form. A simplex that is named and not there has zeros for
    /// corners; a file in which this happens does not pass [`check`](Self::check). Cost: some 3 ns
    /// per slot.
    ///
    /// # Errors
    ///
    /// [`OpenError::OutOfMemory`].
    pub(super) fn expand(self) -> Result<Expanded, OpenError> {
        let zeroed = |len: usize| {
            bytemuck::allocation::try_zeroed_vec::<u32>(len)
                .map_err(|()| OpenError::OutOfMemory { bytes: 4 * len as u64 })
        };
        let mut simplices = zeroed(self.n_slots * self.n_corners)?;
        let mut stamps = zeroed(self.n_slots)?;
        for (slot, stamp) in stamps.iter_mut().enumerate() {
            *stamp = self.stamps.get(slot).unwrap_or(0);
        }
        let mut sources = self.repeat_sources.iter().map(|&source| source as usize);
        let mut fresh = 0..;
        for (slot, corners) in simplices.chunks_exact_mut(self.n_corners).enumerate() {
            let place = if self.is_repeat(slot) { sources.next() } else { fresh.next() };
            let Some(start) = place.and_then(|place: usize| place.checked_mul(self.n_corners)) else {
                continue;
            };
            for (i, corner) in corners.iter_mut().enumerate() {
                *corner = self.distinct.get(start + i).unwrap_or(0);
            }
        }
        Ok(Expanded { simplices, stamps })
    }

    /// Checks that bits and sources are as many as there are repeats, and that every source is the
    /// simplex of an earlier slot.
    pub(super) fn check(self) -> Result<(), CompactFault> {
        let n_set: u64 = self.repeat_bits.iter().map(|word| u64::from(word.count_ones())).sum();
        let n_sources = self.repeat_sources.len() as u64;
        if n_set != n_sources {
            return Err(CompactFault::Repeats { found: n_set, expected: n_sources });
        }
        let mut behind = self.n_slots..WORD_BITS * self.repeat_bits.len();
        if let Some(slot) = behind.find(|&slot| self.is_repeat(slot)) {
            return Err(CompactFault::Slot { found: slot as u64, n_slots: self.n_slots as u64 });
        }
        let mut sources = self.repeat_sources.iter();
        let mut n_distinct = 0;
        for slot in 0..self.n_slots {
            if !self.is_repeat(slot) {
                n_distinct += 1;
            } else if let Some(&found) = sources.next().filter(|&&source| u64::from(source) >= n_distinct) {
                return Err(CompactFault::Source { found: found.into(), n_distinct });
            }
        }
        Ok(())
    }

    fn is_repeat(self, slot: usize) -> bool {
        self.repeat_bits.get(slot / WORD_BITS).is_some_and(|word| word >> (slot % WORD_BITS) & 1 == 1)
    }
}
