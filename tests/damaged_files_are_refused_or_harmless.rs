//! Promise: any bytes end in a typed error or in answers that are bounded and in range; and no
//! damage passes verification.
//!
//! All edits of all places take minutes. By default every 17th place is damaged, in every way;
//! `NEPHRITE_STRIDE=1` damages every place.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small files")]

mod support;

use nephrite::OpenError;
use nephrite_formats::neph::{HEADER_BYTES, NephError};
use rayon::prelude::*;
use support::damage::{Outcome, Seal, open_and_use};
use support::synthetic::{decimate, grid};

/// A file of some 4 KiB with a tree of several heights and two attributes.
fn small_file() -> Vec<u8> {
    let mesh = grid(5);
    let bytes = support::file_bytes(&mesh, &decimate(&mesh, usize::MAX, 3), None);
    assert!((3500..4500).contains(&bytes.len()), "{}", bytes.len());
    bytes
}

/// A file of some 20 KiB.
fn medium_file() -> Vec<u8> {
    let mesh = grid(10);
    let bytes = support::file_bytes(&mesh, &decimate(&mesh, usize::MAX, 4), None);
    assert!((14_000..24_000).contains(&bytes.len()), "{}", bytes.len());
    bytes
}

/// The places among `n` that are damaged, `NEPHRITE_STRIDE` apart.
fn places(n: usize) -> impl ParallelIterator<Item = usize> {
    let stride = std::env::var("NEPHRITE_STRIDE").ok().and_then(|stride| stride.parse().ok());
    (0..n).into_par_iter().step_by(stride.unwrap_or(17).max(1))
}

fn is_valid(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Used(Ok(())))
}

#[test]
fn every_truncation_and_every_tail_is_refused() {
    let bytes = medium_file();
    assert!(is_valid(&open_and_use(&bytes)));
    places(bytes.len()).for_each(|len| {
        let outcome = open_and_use(&bytes[..len]);
        let Outcome::Refused(OpenError::Format(error)) = outcome else { panic!("{len} bytes: {outcome:?}") };
        let expected = matches!(error, NephError::Truncated { .. } | NephError::FileBytes { .. });
        assert!(expected, "{len} bytes: {error:?}");
    });
    for tail in [1, 63, 64, 4096] {
        let longer = [&bytes[..], &vec![0; tail]].concat();
        let outcome = open_and_use(&longer);
        assert!(
            matches!(outcome, Outcome::Refused(OpenError::Format(NephError::FileBytes { .. }))),
            "{outcome:?}"
        );
    }
}

#[test]
fn every_edit_of_a_byte_is_found() {
    let bytes = small_file();
    places(bytes.len()).for_each(|place| {
        let mut edited = bytes.clone();
        for change in 1..=255 {
            edited[place] = bytes[place] ^ change;
            let outcome = open_and_use(&edited);
            assert!(!is_valid(&outcome), "byte {place} ^ {change:#x}");
            assert!(place >= HEADER_BYTES || matches!(outcome, Outcome::Refused(_)));
        }
    });
}

#[test]
fn every_edit_of_a_byte_under_renewed_checksums_is_harmless() {
    let bytes = small_file();
    let seal = Seal::of(&bytes);
    let n_valid: usize = places(bytes.len())
        .map(|place| {
            let mut edited = bytes.clone();
            let mut n_valid = 0;
            for change in 1..=255 {
                edited.copy_from_slice(&bytes);
                edited[place] ^= change;
                seal.renew(&mut edited);
                // Coordinates, names, attribute values and similar bytes are free; a change
                // anywhere else must be found.
                n_valid += usize::from(is_valid(&open_and_use(&edited)));
            }
            n_valid
        })
        .sum();
    let n_edits = 255 * places(bytes.len()).count();
    assert!(n_valid > 0 && n_valid < n_edits * 3 / 5, "{n_valid} of {n_edits} edits verify");
}

#[test]
fn every_two_bits_flipped_in_the_header_are_refused() {
    let bytes = small_file();
    let seal = Seal::of(&bytes);
    let n_bits = 8 * HEADER_BYTES;
    places(n_bits).for_each(|first| {
        let mut edited = bytes.clone();
        for second in 0..first {
            edited[..HEADER_BYTES].copy_from_slice(&bytes[..HEADER_BYTES]);
            edited[first / 8] ^= 1 << (first % 8);
            edited[second / 8] ^= 1 << (second % 8);
            assert!(matches!(open_and_use(&edited), Outcome::Refused(_)), "bits {first} and {second}");
            seal.renew_head(&mut edited);
            open_and_use(&edited);
        }
    });
}

/// Values of a number that are easy to forget.
fn boundary_values(valid: u64, size_bytes: usize) -> Vec<u64> {
    let mut values: Vec<u64> = [7, 8, 15, 16, 23, 31, 32, 52, 62, 63]
        .into_iter()
        .map(|bit| 1u64 << bit)
        .chain([0, u64::MAX, valid])
        .flat_map(|value| [value.wrapping_sub(1), value, value.wrapping_add(1)])
        .collect();
    // Floats: NaN, infinities, largest, smallest, negative zero, in both precisions.
    values.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5e-324, -0.0].map(f64::to_bits));
    values.extend(
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e-45, -0.0].map(|x| u64::from(x.to_bits())),
    );
    let mask = if size_bytes == 8 { u64::MAX } else { (1 << (8 * size_bytes)) - 1 };
    values.iter_mut().for_each(|value| *value &= mask);
    values.sort_unstable();
    values.dedup();
    values
}

/// Header, directory, attribute table and every section are taken as numbers of 2, 4 and 8 bytes,
/// whatever their fields are. Each number is set to each boundary value, one at a time.
#[test]
fn every_field_at_its_boundary_values_is_refused_or_harmless() {
    let mesh = grid(4);
    let history = decimate(&mesh, usize::MAX, 3);
    let forms = [false, true].map(|is_compact| {
        let options = nephrite::StoreOptions { is_compact, ..Default::default() };
        support::file_bytes_with(&mesh, &history, &options)
    });
    for bytes in forms {
        let seal = Seal::of(&bytes);
        for size_bytes in [4, 8] {
            places(bytes.len() / size_bytes).for_each(|field| {
                let range = field * size_bytes..(field + 1) * size_bytes;
                let mut valid = [0; 8];
                valid[..size_bytes].copy_from_slice(&bytes[range.clone()]);
                let mut edited = bytes.clone();
                for value in boundary_values(u64::from_le_bytes(valid), size_bytes) {
                    edited.copy_from_slice(&bytes);
                    edited[range.clone()].copy_from_slice(&value.to_le_bytes()[..size_bytes]);
                    // A number of sections that exceeds the file cannot be sealed; the file is
                    // refused as it is.
                    let n_sections: [u8; 4] = edited[12..16].try_into().unwrap();
                    if u32::from_le_bytes(n_sections) < 100 {
                        seal.renew(&mut edited);
                    }
                    open_and_use(&edited);
                }
            });
        }
    }
}

/// Whole sections are filled with one byte, or with the bytes of another section, under correct
/// checksums.
#[test]
fn every_section_filled_with_anything_is_refused_or_harmless() {
    let bytes = small_file();
    let seal = Seal::of(&bytes);
    let sections: Vec<_> = nephrite_formats::neph::SectionKind::ALL.map(|kind| seal.section(kind)).to_vec();
    for &(offset, len) in &sections {
        for fill in [0, 1, 0x7f, 0x80, 0xff] {
            let mut edited = bytes.clone();
            edited[offset..offset + len].fill(fill);
            seal.renew(&mut edited);
            open_and_use(&edited);
        }
        for &(other, other_len) in &sections {
            let mut edited = bytes.clone();
            let len = len.min(other_len);
            edited[offset..offset + len].copy_from_slice(&bytes[other..other + len]);
            seal.renew(&mut edited);
            open_and_use(&edited);
        }
    }
}
