//! Using a file that may be damaged, and correcting its checksums after an edit.

use nephrite::{Lod, OpenError, QueryError, VerifyError};
use nephrite_formats::neph::{
    self, Directory, HEADER_BYTES, Header, SECTION_RECORD_BYTES, SectionKind, SectionRecord,
};

/// Where a valid file has its checksums.
pub struct Seal {
    directory: Directory,
}

impl Seal {
    pub fn of(bytes: &[u8]) -> Self {
        let directory = Directory::read(bytes, bytes.len() as u64).unwrap();
        Self { directory }
    }

    /// The header of the valid file.
    pub fn header(&self) -> &Header {
        self.directory.header()
    }

    /// Offset and length of a section.
    pub fn section(&self, kind: SectionKind) -> (usize, usize) {
        let (offset, len) = self.directory.section(kind);
        (offset as usize, len as usize)
    }

    /// Corrects all checksums of an edited copy of the file.
    pub fn renew(&self, bytes: &mut [u8]) {
        let body = self.directory.body();
        let (offset, len) = self.section(SectionKind::Checksums);
        let chunk_bytes = self.directory.header().chunk_bytes as usize;
        let checksums: Vec<u64> =
            bytes[body.start as usize..body.end as usize].chunks(chunk_bytes).map(neph::checksum).collect();
        bytes[offset..][..len].copy_from_slice(bytemuck::cast_slice(&checksums));
        let checksums_checksum = neph::checksum(bytemuck::cast_slice(&checksums));
        edit_header(bytes, |header| header.checksums_checksum = checksums_checksum);
        self.renew_head(bytes);
    }

    /// Corrects the checksum of header and directory.
    pub fn renew_head(&self, bytes: &mut [u8]) {
        let n_sections = self.directory.header().n_sections as usize;
        let directory = bytes[HEADER_BYTES..][..n_sections * SECTION_RECORD_BYTES].to_vec();
        edit_header(bytes, |header| header.head_checksum = neph::head_checksum(header, &directory));
    }
}

/// A valid file with other contents of one section, which may be longer or shorter than before, or
/// not there.
pub fn with_section(bytes: &[u8], kind: SectionKind, content: &[u8]) -> Vec<u8> {
    let seal = Seal::of(bytes);
    let mut sections: Vec<(SectionKind, Vec<u8>)> = SectionKind::ALL
        .into_iter()
        .filter(|&other| other != kind && other != SectionKind::Checksums)
        .map(|kind| (kind, seal.section(kind)))
        .filter(|&(_, (offset, _))| offset > 0)
        .map(|(kind, (offset, len))| (kind, bytes[offset..offset + len].to_vec()))
        .collect();
    sections.push((kind, content.to_vec()));
    let lens: Vec<_> = sections.iter().map(|(kind, content)| (*kind, content.len() as u64)).collect();
    let placement = neph::plan(&lens, seal.header().chunk_bytes).unwrap();
    let mut file = vec![0; placement.file_bytes as usize];
    for (record, (_, content)) in placement.records.iter().zip(&sections) {
        file[record.offset as usize..][..content.len()].copy_from_slice(content);
    }
    let directory: &[u8] = bytemuck::cast_slice(&placement.records);
    let header = Header {
        n_sections: placement.records.len() as u32,
        file_bytes: placement.file_bytes,
        ..*seal.header()
    };
    file[..HEADER_BYTES].copy_from_slice(bytemuck::bytes_of(&header));
    file[HEADER_BYTES..][..directory.len()].copy_from_slice(directory);
    assert!(reseal(&mut file));
    file
}

/// Corrects the checksums of any bytes, if their head is good enough to find them. Returns whether
/// it is.
pub fn reseal(bytes: &mut [u8]) -> bool {
    let Some(head) = bytes.get(..HEADER_BYTES) else { return false };
    let header: Header = bytemuck::pod_read_unaligned(head);
    let Some(directory) =
        bytes.get(HEADER_BYTES..HEADER_BYTES + SECTION_RECORD_BYTES * header.n_sections.min(600) as usize)
    else {
        return false;
    };
    let records: Vec<SectionRecord> = bytemuck::pod_collect_to_vec(directory);
    let file_bytes = bytes.len() as u64;
    let body_start = neph::align((HEADER_BYTES + directory.len()) as u64);
    edit_header(bytes, |header| {
        header.magic = neph::MAGIC;
        header.version = neph::VERSION;
        header.file_bytes = file_bytes;
    });
    if let Some(checksums) = records.last().filter(|record| record.kind == SectionKind::Checksums.code()) {
        let in_body = usize::try_from(body_start).ok().zip(usize::try_from(checksums.offset).ok());
        let body = in_body.and_then(|(start, end)| bytes.get(start..end));
        let chunk_bytes = usize::try_from(header.chunk_bytes).unwrap_or(0).max(1 << 12);
        let sums: Vec<u64> = body.unwrap_or(&[]).chunks(chunk_bytes).map(neph::checksum).collect();
        let sums: &[u8] = bytemuck::cast_slice(&sums);
        let place = usize::try_from(checksums.offset).ok();
        if let Some(target) =
            place.and_then(|start| bytes.get_mut(start..)).and_then(|rest| rest.get_mut(..sums.len()))
        {
            target.copy_from_slice(sums);
            edit_header(bytes, |header| header.checksums_checksum = neph::checksum(sums));
        }
    }
    let directory = bytes[HEADER_BYTES..][..records.len() * SECTION_RECORD_BYTES].to_vec();
    edit_header(bytes, |header| header.head_checksum = neph::head_checksum(header, &directory));
    true
}

/// Changes the header in place.
pub fn edit_header(bytes: &mut [u8], edit: impl FnOnce(&mut Header)) {
    let mut header: Header = bytemuck::pod_read_unaligned(&bytes[..HEADER_BYTES]);
    edit(&mut header);
    bytes[..HEADER_BYTES].copy_from_slice(bytemuck::bytes_of(&header));
}

/// The outcome of a file.
#[derive(Debug)]
pub enum Outcome {
    Refused(OpenError),
    /// It opened, and every answer was bounded and in range; this is the result of verifying it.
    Used(Result<(), VerifyError>),
}

/// Opens a file, calls every query at every level, and checks that each answer is in range.
pub fn open_and_use(bytes: &[u8]) -> Outcome {
    let lod = match Lod::from_bytes(bytes) {
        Ok(lod) => lod,
        Err(error) => return Outcome::Refused(error),
    };
    let verified = lod.verify();
    let n_slots = lod.indices().len() / lod.n_corners() as usize;
    let mut buffer = vec![0; lod.indices().len()];
    let n_levels = lod.n_levels();
    let mut queries: Vec<_> = (0..n_levels.min(200)).map(|level| lod.at_level(level)).collect();
    queries.extend([lod.at_error(f64::NAN), lod.at_error(0.1), lod.at_count(0), lod.at_count(10)]);
    queries.push(lod.at_level(n_levels.wrapping_add(7)));
    for cut in queries {
        let mut end = 0;
        for run in cut.runs() {
            assert!(run.range().start >= end && run.range().end <= n_slots);
            end = run.range().end;
        }
        let n_indices = cut.extract_into(&mut buffer).unwrap();
        assert!(n_indices == cut.n_indices() && n_indices <= buffer.len());
        let stated = lod.errors()[cut.level() as usize];
        // The largest number stands for no bound.
        let expected = if stated.to_bits() == f64::MAX.to_bits() { f64::INFINITY } else { stated };
        assert!(cut.vertices().len() == cut.prefix_len() && cut.error().to_bits() == expected.to_bits());
        assert!(cut.n_vertices() <= cut.prefix_len());
        match cut.to_mesh() {
            Ok(mesh) => {
                assert!(mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < mesh.positions.len()));
                assert!(
                    mesh.attributes.iter().all(|a| a.bytes.len() == a.stride_bytes() * mesh.positions.len())
                );
            }
            Err(QueryError::NotTriangles { found }) => assert!(found != 3),
            Err(_) => assert!(verified.is_err(), "verified, but its levels are damaged"),
        }
    }
    use_deltas(&lod, n_slots);
    assert_eq!(lod.curve().len(), n_levels as usize);
    let _ = lod.metadata();
    assert!(lod.bounding_diagonal() >= 0.0);
    Outcome::Used(verified)
}

/// What changes between any two levels is inside the slots.
fn use_deltas(lod: &Lod, n_slots: usize) {
    let last = lod.n_levels() - 1;
    if let Ok(landings) = lod.geomorph(0, last) {
        let corners = landings.iter().flatten().flat_map(|landing| landing.triangle);
        assert!({ corners }.all(|vertex| (vertex as usize) < lod.vertices().len()));
    }
    for (from, to) in
        [(0, 1), (1, 0), (0, last), (last, 0), (last / 2, last / 2 + 1), (last / 3, last), (2, 2)]
    {
        let delta = lod.delta(from, to);
        for runs in [delta.leaving(), delta.entering()] {
            // At most one run per slot of each height.
            assert!(runs.clone().count() <= 32 * (n_slots + 1));
            assert!(runs.into_iter().all(|run| run.range().end <= n_slots));
        }
    }
}
