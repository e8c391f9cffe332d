//! Promise: any bytes end in a typed error or in answers that are bounded and in range; and no damage passes verification.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small files")]

mod support;

use nephrite::store::OpenError;
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

/// A file of some 16 KiB.
fn medium_file() -> Vec<u8> {
    let mesh = grid(10);
    let bytes = support::file_bytes(&mesh, &decimate(&mesh, usize::MAX, 4), None);
    assert!((14_000..19_000).contains(&bytes.len()), "{}", bytes.len());
    bytes
}

fn is_valid(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Used(Ok(())))
}

#[test]
fn every_truncation_and_every_tail_is_refused() {
    let bytes = medium_file();
    assert!(is_valid(&open_and_use(&bytes)));
    (0..bytes.len()).into_par_iter().for_each(|len| {
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
    (0..bytes.len()).into_par_iter().for_each(|place| {
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
    let n_valid: usize = (0..bytes.len())
        .into_par_iter()
        .map(|place| {
            let mut edited = bytes.clone();
            let mut n_valid = 0;
            for change in 1..=255 {
                edited.copy_from_slice(&bytes);
                edited[place] ^= change;
                seal.renew(&mut edited);
                // Coordinates, names, attribute values and the like are free, all else must be found.
                n_valid += usize::from(is_valid(&open_and_use(&edited)));
            }
            n_valid
        })
        .sum();
    let n_edits = 255 * bytes.len();
    assert!(n_valid > 0 && n_valid < n_edits * 3 / 5, "{n_valid} of {n_edits} edits verify");
}

#[test]
fn every_two_bits_flipped_in_the_header_are_refused() {
    let bytes = small_file();
    let seal = Seal::of(&bytes);
    let n_bits = 8 * HEADER_BYTES;
    (0..n_bits).into_par_iter().for_each(|first| {
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
