//! Promise: every rule of the head has its own error, which names what was found.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small files")]
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{Lod, OpenError, VerifyError};
use nephrite_formats::neph::{
    AttributeRecord, HEADER_BYTES, Header, NephError, SECTION_RECORD_BYTES, SectionKind, SectionRecord,
};
use support::damage::{Outcome, Seal, edit_header, open_and_use};
use support::synthetic::{decimate, grid, succeed};

fn valid_file() -> Vec<u8> {
    let mesh = grid(5);
    support::file_bytes(&mesh, &decimate(&mesh, usize::MAX, 3), None)
}

fn refusal(bytes: &[u8]) -> NephError {
    match open_and_use(bytes) {
        Outcome::Refused(OpenError::Format(error)) => error,
        outcome => panic!("{outcome:?}"),
    }
}

/// The error of opening a file with a changed header and correct checksums.
fn with_header(edit: impl FnOnce(&mut Header)) -> NephError {
    let mut bytes = valid_file();
    let seal = Seal::of(&bytes);
    edit_header(&mut bytes, edit);
    seal.renew_head(&mut bytes);
    refusal(&bytes)
}

/// A file with a changed directory and correct checksums.
fn with_records(edit: impl FnOnce(&mut [SectionRecord])) -> Vec<u8> {
    let mut bytes = valid_file();
    let seal = Seal::of(&bytes);
    let header: Header = bytemuck::pod_read_unaligned(&bytes[..HEADER_BYTES]);
    let range = HEADER_BYTES..HEADER_BYTES + header.n_sections as usize * SECTION_RECORD_BYTES;
    let mut records: Vec<SectionRecord> = bytemuck::pod_collect_to_vec(&bytes[range.clone()]);
    edit(&mut records);
    bytes[range].copy_from_slice(bytemuck::cast_slice(&records));
    seal.renew_head(&mut bytes);
    bytes
}

fn record(records: &mut [SectionRecord], kind: SectionKind) -> &mut SectionRecord {
    records.iter_mut().find(|record| record.kind == kind.code()).unwrap()
}

#[test]
fn of_the_header() {
    let file_bytes = valid_file().len() as u64;
    assert_eq!(refusal(&[]), NephError::Truncated { found: 0, expected: 192 });
    assert_eq!(refusal(b"ply\nformat ascii"), NephError::Magic { found: *b"ply\nform" });
    assert_eq!(with_header(|h| h.magic[4] = b'h'), NephError::Magic { found: *b"\x89NEPh\r\n\x1a" });
    assert_eq!(with_header(|h| h.version = 2), NephError::Version { found: 2, expected: 1 });
    for found in [0, 1, file_bytes + 1, u64::MAX] {
        let error = NephError::FileBytes { found: file_bytes, expected: found };
        assert_eq!(with_header(|h| h.file_bytes = found), error);
    }
    let mut bytes = valid_file();
    edit_header(&mut bytes, |h| h.head_checksum ^= 1);
    assert!(matches!(refusal(&bytes), NephError::HeadChecksum { .. }));
    for found in [507, u32::MAX] {
        let error = NephError::TooManySections { found: found.into() };
        let mut bytes = valid_file();
        edit_header(&mut bytes, |h| h.n_sections = found);
        assert_eq!(refusal(&bytes), error);
    }
    for found in [0, 1, 4095, 4097, 1 << 31, u64::MAX] {
        assert_eq!(with_header(|h| h.chunk_bytes = found), NephError::ChunkBytes { found });
    }
    assert_eq!(with_header(|h| h.reserved[6] = 1), NephError::Reserved { place: "header" });
    for found in [0, 2, 5, u32::MAX] {
        assert!(matches!(with_header(|h| h.n_corners = found), NephError::Count { field: "n_corners", .. }));
    }
    for found in [0, (1 << 31) + 1, u32::MAX] {
        assert!(matches!(with_header(|h| h.n_levels = found), NephError::Count { field: "n_levels", .. }));
    }
    for found in [1 << 32, u64::MAX] {
        assert!(matches!(
            with_header(|h| h.n_vertices = found),
            NephError::Count { field: "n_vertices", .. }
        ));
        assert!(matches!(with_header(|h| h.n_slots = found), NephError::Count { field: "n_slots", .. }));
        assert!(matches!(
            with_header(|h| h.n_lifetimes = found),
            NephError::Count { field: "n_lifetimes", .. }
        ));
    }
    assert!(matches!(with_header(|h| h.n_lifetimes = 0), NephError::Count { field: "n_lifetimes", .. }));
    for found in [f64::NAN, f64::INFINITY] {
        assert_eq!(with_header(|h| h.origin[2] = found), NephError::Geometry { field: "origin" });
        assert_eq!(with_header(|h| h.rounding = found), NephError::Geometry { field: "rounding" });
    }
    assert_eq!(with_header(|h| h.rounding = -1.0), NephError::Geometry { field: "rounding" });
    assert_eq!(with_header(|h| h.bounds_min[0] = 1e9), NephError::Geometry { field: "bounds" });
    assert_eq!(with_header(|h| h.bounds_max[0] = f32::INFINITY), NephError::Geometry { field: "bounds" });
}

#[test]
fn of_counts_that_contradict_the_sections() {
    let section_bytes = |error, expected_kind| match error {
        NephError::SectionBytes { kind, .. } => assert_eq!(kind, expected_kind),
        other => panic!("{other:?}"),
    };
    section_bytes(with_header(|h| h.n_corners = 4), SectionKind::Simplices);
    section_bytes(with_header(|h| h.n_levels += 1), SectionKind::Errors);
    section_bytes(with_header(|h| h.n_levels = 1 << 31), SectionKind::Errors);
    section_bytes(with_header(|h| h.n_vertices -= 1), SectionKind::Positions);
    section_bytes(with_header(|h| h.n_vertices = u32::MAX.into()), SectionKind::Positions);
    section_bytes(with_header(|h| h.n_slots += 1), SectionKind::Simplices);
}

#[test]
fn of_the_directory() {
    let refused = |edit: fn(&mut [SectionRecord])| refusal(&with_records(edit));
    assert_eq!(refused(|r| r[0].reserved = 1), NephError::Reserved { place: "directory" });
    assert_eq!(refused(|r| r[3].flags = 2), NephError::Reserved { place: "directory" });
    assert_eq!(refused(|r| r[0].kind = 99), NephError::UnknownRequired { kind: 99 });
    assert_eq!(refused(|r| r[1].kind = r[0].kind), NephError::Duplicate { kind: 1 });
    let missing = NephError::Missing { kind: SectionKind::Metadata };
    assert_eq!(refused(|r| (r[0].kind, r[0].flags) = (99, 0)), missing);
    assert_eq!(refused(|r| r[12].kind = 99), NephError::ChecksumsNotLast);
    assert!(matches!(refused(|r| r[2].offset += 64), NephError::Coverage { kind: 3, .. }));
    assert!(matches!(refused(|r| r[2].offset += 1), NephError::Coverage { kind: 3, .. }));
    assert!(matches!(refused(|r| r[2].offset = 0), NephError::Coverage { kind: 3, .. }));
    assert!(matches!(refused(|r| r.swap(3, 4)), NephError::Coverage { .. }));
    assert!(matches!(refused(|r| r[12].bytes += 8), NephError::Coverage { kind: 0, .. }));
    assert_eq!(refused(|r| r[5].bytes = u64::MAX), NephError::TooLarge);
    let mut bytes = valid_file();
    bytes[HEADER_BYTES + 13 * SECTION_RECORD_BYTES] = 1;
    assert_eq!(refusal(&bytes), NephError::Reserved { place: "the padding after the directory" });
}

#[test]
fn of_the_attribute_table() {
    let bytes = valid_file();
    let (offset, len) = Seal::of(&bytes).section(SectionKind::AttributeTable);
    let refused = |edit: fn(&mut [AttributeRecord])| {
        let mut bytes = bytes.clone();
        let range = offset..offset + len;
        let mut table: Vec<AttributeRecord> = bytemuck::pod_collect_to_vec(&bytes[range.clone()]);
        edit(&mut table);
        bytes[range].copy_from_slice(bytemuck::cast_slice(&table));
        refusal(&bytes)
    };
    let is_field = |error, expected| matches!(error, NephError::Attribute { field, .. } if field == expected);
    assert!(is_field(refused(|t| t[0].scalar = 8), "scalar"));
    assert!(is_field(refused(|t| t[0].n_components = 0), "n_components"));
    assert!(is_field(refused(|t| t[0].name_bytes = 0), "name_bytes"));
    assert!(is_field(refused(|t| t[1].name_offset = 0), "name_offset"));
    assert!(is_field(refused(|t| t[1].values_offset += 64), "values_offset"));
    assert!(is_field(refused(|t| t[1].values_bytes -= 8), "values_bytes"));
    assert!(is_field(refused(|t| t[1].n_components = u32::MAX), "values_bytes"));
    assert_eq!(refused(|t| t[1].name_bytes = 800), NephError::AttributeName { index: 1 });
    let names = NephError::SectionBytes { kind: SectionKind::AttributeNames, found: 12, expected: 11 };
    assert_eq!(refused(|t| t[1].name_bytes = 6), names);
    // Without the table, names and values belong to no attribute.
    let orphaned = with_records(|r| record(r, SectionKind::AttributeTable).kind = 99);
    let orphaned_names =
        NephError::SectionBytes { kind: SectionKind::AttributeNames, found: 12, expected: 0 };
    assert_eq!(refusal(&orphaned), orphaned_names);
}

#[test]
fn except_that_unknown_optional_sections_are_skipped() {
    let bytes = with_records(|records| {
        for kind in [SectionKind::AttributeTable, SectionKind::AttributeNames, SectionKind::AttributeValues] {
            record(records, kind).kind += 1000;
        }
    });
    let lod = Lod::from_bytes(&bytes).unwrap();
    lod.verify().unwrap();
    assert_eq!(lod.attributes().len(), 0);
    assert!(lod.at_level(0).to_mesh().is_ok());
}

/// As [`valid_file`], with vertices that are born at later levels.
fn valid_file_with_births() -> Vec<u8> {
    let mut mesh = grid(5);
    let mut history = decimate(&mesh, usize::MAX, 3);
    succeed(&mut mesh, &mut history, 5);
    support::file_bytes(&mesh, &history, None)
}

#[test]
fn of_the_births_of_vertices() {
    let bytes = valid_file_with_births();
    let seal = Seal::of(&bytes);
    let (offset, len) = seal.section(SectionKind::VertexBirths);
    assert!(len > 0 && matches!(open_and_use(&bytes), Outcome::Used(Ok(()))));
    let verdict = |vertex: usize, birth: u32| {
        let mut bytes = bytes.clone();
        bytes[offset + 4 * vertex..][..4].copy_from_slice(&birth.to_le_bytes());
        seal.renew(&mut bytes);
        match open_and_use(&bytes) {
            Outcome::Used(Err(error)) => error,
            outcome => panic!("{outcome:?}"),
        }
    };
    let last = len / 4 - 1;
    assert!(matches!(verdict(last, u32::MAX), VerifyError::VertexBirth { found: u32::MAX, .. }));
    let n_levels = Lod::from_bytes(&bytes).unwrap().n_levels();
    assert!(matches!(verdict(0, n_levels), VerifyError::VertexBirth { vertex: 0, .. }));
    // Vertices that are never gone come first.
    let births: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes[offset..offset + len]);
    let first_old = births.iter().position(|&birth| birth == 0).unwrap();
    let found = first_old as u32;
    assert!(matches!(verdict(first_old, 1), VerifyError::UnbornVertex { found: f, .. } if f == found));

    // The section has an entry for every vertex, or the file does not have it.
    let bytes = with_records(|records| {
        record(records, SectionKind::AttributeValues).kind = SectionKind::VertexBirths.code();
    });
    let wrong = |error| matches!(error, NephError::SectionBytes { kind: SectionKind::VertexBirths, .. });
    assert!(wrong(refusal(&bytes)));
}

/// The error of verifying a file in which one number of a section is changed, with correct
/// checksums.
fn verdict<T: bytemuck::Pod>(kind: SectionKind, edit: impl FnOnce(&mut [T])) -> VerifyError {
    let mut bytes = valid_file();
    let seal = Seal::of(&bytes);
    let (offset, len) = seal.section(kind);
    let mut records: Vec<T> = bytemuck::pod_collect_to_vec(&bytes[offset..offset + len]);
    edit(&mut records);
    bytes[offset..offset + len].copy_from_slice(bytemuck::cast_slice(&records));
    seal.renew(&mut bytes);
    match open_and_use(&bytes) {
        Outcome::Used(Err(error)) => error,
        outcome => panic!("{outcome:?}"),
    }
}

#[test]
fn of_the_contents() {
    use VerifyError as E;
    assert!(matches!(verdict::<u8>(SectionKind::Metadata, |m| m[0] = b'['), E::Metadata(_)));
    assert!(matches!(verdict::<f64>(SectionKind::Errors, |e| e[1] = f64::NAN), E::Error { level: 1, .. }));
    assert!(matches!(verdict::<f64>(SectionKind::Errors, |e| e[0] = -1.0), E::Error { level: 0, .. }));
    assert!(matches!(verdict::<f64>(SectionKind::Errors, |e| e[2] = 9.0), E::Error { level: 3, .. }));
    let is_count = |error, expected| matches!(error, E::Count { what, .. } if what == expected);
    assert!(is_count(verdict::<u32>(SectionKind::SimplexCounts, |c| c[1] += 1), "simplices"));
    assert!(is_count(verdict::<u32>(SectionKind::VertexCounts, |c| c[0] -= 1), "vertices"));
    assert!(is_count(verdict::<u32>(SectionKind::VertexCounts, |c| c[2] = u32::MAX), "vertices"));
    assert!(matches!(verdict::<u32>(SectionKind::VertexCounts, |c| c[1..].fill(4)), E::Vertex { .. }));
    assert!(matches!(verdict::<f32>(SectionKind::Positions, |p| p[4] = f32::NAN), E::Position { vertex: 1 }));
    assert!(matches!(verdict::<f32>(SectionKind::Positions, |p| p[4] = 1e9), E::Position { vertex: 1 }));
    assert!(matches!(verdict::<u64>(SectionKind::RunOffsets, |o| o[0] = 1), E::Tree(_)));
    assert!(matches!(verdict::<u32>(SectionKind::Runs, |r| r[1] = u32::MAX), E::Tree(_)));
    assert!(matches!(verdict::<u32>(SectionKind::Simplices, |s| s[5] = 1 << 30), E::Vertex { .. }));
    assert!(matches!(verdict::<u32>(SectionKind::Simplices, |s| s.swap(0, 1)), E::Tree(_)));
    assert!(matches!(verdict::<u32>(SectionKind::Stamps, |s| s[0] = u32::MAX), E::Tree(_)));

    let seal_and_verify = |edit: fn(&mut Vec<u8>, &Seal)| {
        let mut bytes = valid_file();
        let seal = Seal::of(&bytes);
        edit(&mut bytes, &seal);
        match open_and_use(&bytes) {
            Outcome::Used(Err(error)) => error,
            outcome => panic!("{outcome:?}"),
        }
    };
    let lifetimes = seal_and_verify(|bytes, seal| {
        edit_header(bytes, |h| h.n_lifetimes += 1);
        seal.renew_head(bytes);
    });
    assert!(matches!(lifetimes, E::Lifetimes { .. }));
    let chunk = seal_and_verify(|bytes, seal| bytes[seal.section(SectionKind::Stamps).0] ^= 1);
    assert!(matches!(chunk, E::Chunk { chunk: 0, .. }));
    let checksums = seal_and_verify(|bytes, seal| bytes[seal.section(SectionKind::Checksums).0] ^= 1);
    assert!(matches!(checksums, E::Checksums { .. }));
    let padding = seal_and_verify(|bytes, seal| {
        let (offset, len) = seal.section(SectionKind::Metadata);
        bytes[offset + len] = 1;
        seal.renew(bytes);
    });
    assert!(matches!(padding, E::Padding { .. }));
}
