//! Small valid files, and copies with one change and correct checksums.

use super::support::damage::{Seal, edit_header};
use super::support::file_bytes_with;
use super::support::synthetic::{decimate, grid, succeed};
use bytemuck::Pod;
use nephrite::{Deviation, StoreOptions};
use nephrite_formats::neph::{HEADER_BYTES, Header, SECTION_RECORD_BYTES, SectionKind, SectionRecord};

/// A valid file and the places of its sections.
pub(crate) struct Valid {
    pub(crate) bytes: Vec<u8>,
    pub(crate) seal: Seal,
}

impl Valid {
    /// What these bytes are.
    pub(crate) fn new(bytes: Vec<u8>) -> Self {
        let seal = Seal::of(&bytes);
        Self { bytes, seal }
    }

    /// The usual form.
    pub(crate) fn plain() -> Self {
        let mesh = grid(4);
        Self::new(file_bytes_with(&mesh, &decimate(&mesh, usize::MAX, 3), &StoreOptions::default()))
    }

    /// The compact form.
    pub(crate) fn compact() -> Self {
        let mesh = grid(4);
        let options = StoreOptions { is_compact: true, ..StoreOptions::default() };
        Self::new(file_bytes_with(&mesh, &decimate(&mesh, usize::MAX, 3), &options))
    }

    /// With vertices that are born.
    pub(crate) fn with_births() -> Self {
        let mut mesh = grid(4);
        let mut history = decimate(&mesh, usize::MAX, 3);
        succeed(&mut mesh, &mut history, 5);
        Self::new(file_bytes_with(&mesh, &history, &StoreOptions::default()))
    }

    /// With a deviation beside the error.
    pub(crate) fn with_deviations() -> Self {
        let mesh = grid(4);
        let mut history = decimate(&mesh, usize::MAX, 3);
        let values = (0..history.errors.len()).map(|step| step as f64).collect();
        history.deviations = vec![Deviation { name: "height".into(), values }];
        Self::new(file_bytes_with(&mesh, &history, &StoreOptions::default()))
    }

    /// With an edited header.
    pub(crate) fn header(&self, edit: impl FnOnce(&mut Header)) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        edit_header(&mut bytes, edit);
        self.seal.renew_head(&mut bytes);
        bytes
    }

    /// With an edited directory.
    pub(crate) fn records(&self, edit: impl FnOnce(&mut [SectionRecord])) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        let header: Header = bytemuck::pod_read_unaligned(&bytes[..HEADER_BYTES]);
        let range = HEADER_BYTES..HEADER_BYTES + header.n_sections as usize * SECTION_RECORD_BYTES;
        let mut records: Vec<SectionRecord> = bytemuck::pod_collect_to_vec(&bytes[range.clone()]);
        edit(&mut records);
        bytes[range].copy_from_slice(bytemuck::cast_slice(&records));
        self.seal.renew_head(&mut bytes);
        bytes
    }

    /// With another content of a section.
    pub(crate) fn section<T: Pod>(&self, kind: SectionKind, edit: impl FnOnce(&mut [T])) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        let (offset, len) = self.seal.section(kind);
        let mut records: Vec<T> = bytemuck::pod_collect_to_vec(&bytes[offset..offset + len]);
        edit(&mut records);
        bytes[offset..offset + len].copy_from_slice(bytemuck::cast_slice(&records));
        self.seal.renew(&mut bytes);
        bytes
    }

    /// Edited anywhere, not sealed again.
    pub(crate) fn raw(&self, edit: impl FnOnce(&mut Vec<u8>, &Seal)) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        edit(&mut bytes, &self.seal);
        bytes
    }
}

/// The record of a section that is there.
pub(crate) fn record(records: &mut [SectionRecord], kind: SectionKind) -> &mut SectionRecord {
    records.iter_mut().find(|record| record.kind == kind.code()).unwrap()
}
