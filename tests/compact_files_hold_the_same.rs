//! Promise: a file in the compact form gives the same answers as one in the plain form, in fewer
//! bytes. Damage to it is refused or harmless.

#![allow(clippy::cast_possible_truncation, reason = "small files")]
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{CompactFault, Lod, OpenError, StoreOptions, VerifyError};
use nephrite_formats::neph::{Header, NephError, SECTION_RECORD_BYTES, SectionKind, SectionRecord};
use rayon::prelude::*;
use support::damage::{Outcome, Seal, open_and_use};
use support::synthetic::{decimate, grid};

/// The file of a grid in the plain form and in the compact one.
fn both_forms(side: usize, n_removals: usize, window_levels: Option<u32>) -> [Vec<u8>; 2] {
    let mesh = grid(side);
    let history = decimate(&mesh, n_removals, 3);
    [false, true].map(|is_compact| {
        let options = StoreOptions { window_levels, is_compact, ..StoreOptions::default() };
        support::file_bytes_with(&mesh, &history, &options)
    })
}

fn small_file() -> Vec<u8> {
    let [_, compact] = both_forms(5, usize::MAX, None);
    compact
}

#[test]
fn slots_and_levels_are_the_same() {
    // The largest grid has more vertices than 16 bits can number.
    for (side, n_removals, window_levels) in [
        (2, 0, None),
        (20, usize::MAX, None),
        (20, usize::MAX, Some(4)),
        (257, 500, None),
        (257, 500, Some(16)),
    ] {
        let files = both_forms(side, n_removals, window_levels);
        let [plain, compact] = files.each_ref().map(|bytes| Lod::from_bytes(bytes).unwrap());
        compact.verify().unwrap();
        assert_eq!(plain.indices(), compact.indices());
        assert_eq!(plain.vertices(), compact.vertices());
        assert!(plain.curve().eq(compact.curve()));
        for level in 0..plain.n_levels() {
            assert!(plain.at_level(level).runs().eq(compact.at_level(level).runs()));
        }
        let last = plain.n_levels() - 1;
        let changes = [&plain, &compact].map(|lod| lod.delta(0, last).leaving().collect::<Vec<_>>());
        assert_eq!(changes[0], changes[1]);
        assert!(side == 2 || 3 * files[1].len() < 2 * files[0].len() || side == 257);
        assert!(files[1].len() <= files[0].len() + 2 * SECTION_RECORD_BYTES + 128, "{side}");
    }
}

#[test]
fn every_truncation_is_refused_and_every_flipped_bit_is_harmless() {
    let bytes = small_file();
    let seal = Seal::of(&bytes);
    assert!(matches!(open_and_use(&bytes), Outcome::Used(Ok(()))));
    (0..bytes.len()).into_par_iter().for_each(|place| {
        assert!(matches!(open_and_use(&bytes[..place]), Outcome::Refused(OpenError::Format(_))), "{place}");
        for bit in 0..8 {
            let mut edited = bytes.clone();
            edited[place] ^= 1 << bit;
            assert!(!matches!(open_and_use(&edited), Outcome::Used(Ok(()))), "bit {bit} of byte {place}");
            seal.renew(&mut edited);
            open_and_use(&edited);
        }
    });
}

/// The error of verifying a copy of the small file with other bytes at the beginning of a section
/// and correct checksums.
fn fault(kind: SectionKind, edit: impl FnOnce(&mut [u8])) -> CompactFault {
    let mut bytes = small_file();
    let seal = Seal::of(&bytes);
    let (offset, len) = seal.section(kind);
    edit(&mut bytes[offset..][..len]);
    seal.renew(&mut bytes);
    match open_and_use(&bytes) {
        Outcome::Used(Err(VerifyError::Compact(fault))) => fault,
        outcome => panic!("{outcome:?}"),
    }
}

#[test]
fn every_rule_of_the_slots_has_its_error() {
    let is_repeats =
        |fault| matches!(fault, CompactFault::Repeats { found, expected } if found == expected + 1);
    // The first slot cannot be a repeat.
    assert!(is_repeats(fault(SectionKind::RepeatBits, |bits| bits[0] |= 1)));
    let n_slots = Seal::of(&small_file()).header().n_slots;
    let moved = fault(SectionKind::RepeatBits, |bits| {
        let first = bits.iter().position(|&byte| byte != 0).unwrap();
        bits[first] &= bits[first] - 1;
        bits[bits.len() - 1] |= 0x80;
    });
    assert_eq!(moved, CompactFault::Slot { found: n_slots.next_multiple_of(64) - 1, n_slots });
    let source = fault(SectionKind::RepeatSources, |sources| sources[..4].fill(0xff));
    assert!(matches!(source, CompactFault::Source { found: 0xffff_ffff, .. }));
}

/// The error of opening a file of the form with a changed directory and correct checksums.
fn refusal(bytes: Vec<u8>, edit: impl FnOnce(&mut [SectionRecord])) -> NephError {
    let mut bytes = bytes;
    let seal = Seal::of(&bytes);
    let range =
        size_of::<Header>()..size_of::<Header>() + seal.header().n_sections as usize * SECTION_RECORD_BYTES;
    let mut records: Vec<SectionRecord> = bytemuck::pod_collect_to_vec(&bytes[range.clone()]);
    edit(&mut records);
    bytes[range].copy_from_slice(bytemuck::cast_slice(&records));
    seal.renew_head(&mut bytes);
    match open_and_use(&bytes) {
        Outcome::Refused(OpenError::Format(error)) => error,
        outcome => panic!("{outcome:?}"),
    }
}

fn rename(records: &mut [SectionRecord], from: SectionKind, to: SectionKind) {
    let record = records.iter_mut().find(|record| record.kind == from.code()).unwrap();
    record.kind = to.code();
}

#[test]
fn slots_are_in_one_form() {
    let [plain, compact] = both_forms(5, usize::MAX, None);
    let both = refusal(compact.clone(), |records| {
        rename(records, SectionKind::RepeatBits, SectionKind::Simplices);
    });
    assert_eq!(both, NephError::Forms { found: 2 });
    let neither = refusal(plain, |records| {
        for (kind, code) in [(SectionKind::Simplices, 1000), (SectionKind::Stamps, 1001)] {
            let record = records.iter_mut().find(|record| record.kind == kind.code()).unwrap();
            (record.kind, record.flags) = (code, 0);
        }
    });
    assert_eq!(neither, NephError::Forms { found: 0 });
    for kind in SectionKind::COMPACT {
        let error = refusal(compact.clone(), |records| {
            let record = records.iter_mut().find(|record| record.kind == kind.code()).unwrap();
            (record.kind, record.flags) = (1000, 0);
        });
        assert_eq!(error, NephError::Missing { kind });
    }
}
