//! Promise: opening reads the head only, whatever the size and the source of the file. Offsets
//! beyond 4 GiB work.

#![expect(unsafe_code, reason = "nobody writes to the files that are mapped here")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed"
)]

use nephrite::{Lod, OpenError};
use nephrite_formats::neph::{self, CHUNK_BYTES, HEADER_BYTES, Header, MAGIC, SectionKind, VERSION};
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// A sparse file of more than 20 GiB: a valid head, and zeros in every section except the runs of
/// one level.
fn write_giant(path: &Path) -> u64 {
    let (n_levels, n_vertices, n_slots) = (1_000_000u32, 400_000_000u64, 1_200_000_000u64);
    let sections = [
        (SectionKind::Metadata, 2),
        (SectionKind::Simplices, 12 * n_slots),
        (SectionKind::Stamps, 4 * n_slots),
        (SectionKind::Positions, 12 * n_vertices),
        (SectionKind::Errors, 8 * u64::from(n_levels)),
        (SectionKind::SimplexCounts, 4 * u64::from(n_levels)),
        (SectionKind::VertexCounts, 4 * u64::from(n_levels)),
        (SectionKind::RunOffsets, 8 * (u64::from(n_levels) + 1)),
        (SectionKind::Runs, 16),
    ];
    let placement = neph::plan(&sections, CHUNK_BYTES).unwrap();
    let directory: &[u8] = bytemuck::cast_slice(&placement.records);
    let mut header = Header {
        magic: MAGIC,
        version: VERSION,
        n_sections: placement.records.len() as u32,
        file_bytes: placement.file_bytes,
        chunk_bytes: CHUNK_BYTES,
        n_corners: 3,
        n_levels,
        n_vertices,
        n_slots,
        n_lifetimes: n_slots,
        ..bytemuck::Zeroable::zeroed()
    };
    header.head_checksum = neph::head_checksum(&header, directory);
    let mut file = File::create(path).unwrap();
    file.set_len(placement.file_bytes).unwrap();
    file.write_all(bytemuck::bytes_of(&header)).unwrap();
    file.write_all(directory).unwrap();
    let mut put = |kind: SectionKind, place: u64, bytes: &[u8]| {
        let record = placement.records.iter().find(|record| record.kind == kind.code()).unwrap();
        file.seek(SeekFrom::Start(record.offset + place)).unwrap();
        file.write_all(bytes).unwrap();
    };
    // The last level has two runs, one at the very end of the slots.
    put(SectionKind::RunOffsets, 8 * u64::from(n_levels), &2u64.to_le_bytes());
    put(SectionKind::Runs, 0, bytemuck::cast_slice(&[5u32, 2, n_slots as u32 - 3, 3]));
    let last_corner: [u32; 3] = [7, 8, 9];
    put(SectionKind::Simplices, 12 * (n_slots - 1), bytemuck::cast_slice(&last_corner));
    placement.file_bytes
}

#[test]
fn a_file_of_twenty_gigabytes_opens_by_its_head() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("giant.neph");
    let file_bytes = write_giant(&path);
    assert!(file_bytes > 20 << 30);

    let faults_before = page_faults();
    // SAFETY: no other process knows the temporary file.
    let lod = unsafe { Lod::map(&path) }.unwrap();
    let n_faults = page_faults().zip(faults_before).map(|(after, before)| after - before);
    // The head is one page, or 16 if the system maps neighbouring pages; the rest are of the
    // allocator.
    assert!(n_faults.is_none_or(|n_faults| n_faults < 64), "{n_faults:?} pages touched");

    assert_eq!(lod.file_bytes(), file_bytes);
    assert_eq!(lod.at_level(0).n_runs(), 0);
    let cut = lod.at_level(u32::MAX);
    assert_eq!(cut.n_simplices(), 5);
    let mut indices = vec![1; 15];
    assert_eq!(cut.extract_into(&mut indices), Ok(15));
    assert_eq!(indices[9..], [0, 0, 0, 7, 8, 9]);
    assert_eq!(lod.at_error(0.0).level(), 999_999);
}

/// Page faults of this thread so far; `None` if the system does not tell.
fn page_faults() -> Option<u64> {
    let stat = std::fs::read_to_string("/proc/thread-self/stat").ok()?;
    // Fields after the name of the program, which is in parentheses: minor faults are the 8th.
    stat.rsplit_once(')')?.1.split_whitespace().nth(7)?.parse().ok()
}

#[test]
fn what_is_no_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Lod::open(folder.path().join("missing.neph"));
    assert!(matches!(missing, Err(OpenError::Io { action: "open", .. })));
    assert!(matches!(Lod::open(folder.path()), Err(OpenError::NotAFile { .. })));
    #[cfg(unix)]
    assert!(matches!(Lod::open("/dev/zero"), Err(OpenError::NotAFile { .. })));
    let empty = folder.path().join("empty.neph");
    File::create(&empty).unwrap();
    assert!(matches!(Lod::open(&empty), Err(OpenError::Format(neph::NephError::Truncated { found: 0, .. }))));
    // SAFETY: no other process knows the temporary file.
    let mapped = unsafe { Lod::map(&empty) };
    assert!(matches!(mapped, Err(OpenError::Format(neph::NephError::Truncated { found: 0, .. }))));
    // A short file that claims to be long is refused before memory for the claim is allocated.
    let claim = folder.path().join("claim.neph");
    let header =
        Header { magic: MAGIC, version: VERSION, file_bytes: 1 << 60, ..bytemuck::Zeroable::zeroed() };
    std::fs::write(&claim, &bytemuck::bytes_of(&header)[..HEADER_BYTES]).unwrap();
    assert!(matches!(Lod::open(&claim), Err(OpenError::Format(neph::NephError::FileBytes { .. }))));
}
