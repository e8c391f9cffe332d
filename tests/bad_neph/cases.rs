//! The bad files: small valid ones with one thing wrong, all checksums made right where the fault is not in them.

use super::support::damage::{Seal, edit_header, reseal};
use super::support::file_bytes_with;
use super::support::synthetic::{decimate, grid, succeed};
use bytemuck::Pod;
use nephrite::history::Deviation;
use nephrite::store::StoreOptions;
use nephrite_formats::neph::{
    AttributeRecord, CHUNK_BYTES, HEADER_BYTES, Header, REQUIRED, SECTION_RECORD_BYTES, SectionKind,
    SectionRecord, plan,
};
use std::collections::BTreeMap;

/// A valid file and where its sections are.
struct Valid {
    bytes: Vec<u8>,
    seal: Seal,
}

impl Valid {
    fn new(bytes: Vec<u8>) -> Self {
        let seal = Seal::of(&bytes);
        Self { bytes, seal }
    }

    fn plain() -> Self {
        let mesh = grid(4);
        Self::new(file_bytes_with(&mesh, &decimate(&mesh, usize::MAX, 3), &StoreOptions::default()))
    }

    fn compact() -> Self {
        let mesh = grid(4);
        let options = StoreOptions { is_compact: true, ..StoreOptions::default() };
        Self::new(file_bytes_with(&mesh, &decimate(&mesh, usize::MAX, 3), &options))
    }

    fn with_births() -> Self {
        let mut mesh = grid(4);
        let mut history = decimate(&mesh, usize::MAX, 3);
        succeed(&mut mesh, &mut history, 5);
        Self::new(file_bytes_with(&mesh, &history, &StoreOptions::default()))
    }

    fn with_deviations() -> Self {
        let mesh = grid(4);
        let mut history = decimate(&mesh, usize::MAX, 3);
        let values = (0..history.errors.len()).map(|step| step as f64).collect();
        history.deviations = vec![Deviation { name: "height".into(), values }];
        Self::new(file_bytes_with(&mesh, &history, &StoreOptions::default()))
    }

    fn header(&self, edit: impl FnOnce(&mut Header)) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        edit_header(&mut bytes, edit);
        self.seal.renew_head(&mut bytes);
        bytes
    }

    fn records(&self, edit: impl FnOnce(&mut [SectionRecord])) -> Vec<u8> {
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
    fn section<T: Pod>(&self, kind: SectionKind, edit: impl FnOnce(&mut [T])) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        let (offset, len) = self.seal.section(kind);
        let mut records: Vec<T> = bytemuck::pod_collect_to_vec(&bytes[offset..offset + len]);
        edit(&mut records);
        bytes[offset..offset + len].copy_from_slice(bytemuck::cast_slice(&records));
        self.seal.renew(&mut bytes);
        bytes
    }

    /// Edited anywhere, not sealed again.
    fn raw(&self, edit: impl FnOnce(&mut Vec<u8>, &Seal)) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        edit(&mut bytes, &self.seal);
        bytes
    }
}

fn record(records: &mut [SectionRecord], kind: SectionKind) -> &mut SectionRecord {
    records.iter_mut().find(|record| record.kind == kind.code()).unwrap()
}

type Cases = Vec<(&'static str, Vec<u8>)>;

/// All files, by name.
pub(crate) fn all() -> BTreeMap<String, Vec<u8>> {
    let lists = [whole(), headers(), directories(), attributes(), contents(), trees(), others()];
    let n_cases: usize = lists.iter().map(Vec::len).sum();
    let cases: BTreeMap<_, _> =
        lists.into_iter().flatten().map(|(name, bytes)| (format!("{name}.neph"), bytes)).collect();
    assert_eq!(cases.len(), n_cases, "two files of one name");
    cases
}

fn whole() -> Cases {
    let valid = Valid::plain();
    let bytes = &valid.bytes;
    vec![
        ("valid", bytes.clone()),
        ("valid-compact", Valid::compact().bytes),
        ("valid-with-births", Valid::with_births().bytes),
        ("empty", Vec::new()),
        ("another-format", b"ply\nformat ascii 1.0\n".to_vec()),
        (
            "line-ends-converted",
            valid.raw(|bytes, _| {
                bytes.remove(5);
            }),
        ),
        ("cut-in-header", bytes[..100].to_vec()),
        ("cut-in-directory", bytes[..HEADER_BYTES + 40].to_vec()),
        ("cut-by-one-byte", bytes[..bytes.len() - 1].to_vec()),
        ("one-byte-more", [&bytes[..], &[0]].concat()),
        ("twice", [&bytes[..], bytes].concat()),
        ("zeros", vec![0; 4096]),
        ("head-and-zeros", valid.raw(|bytes, seal| bytes[seal.section(SectionKind::Metadata).0..].fill(0))),
    ]
}

fn headers() -> Cases {
    let valid = Valid::plain();
    let h = |edit: fn(&mut Header)| valid.header(edit);
    vec![
        ("header-magic", h(|h| h.magic[7] = 0)),
        ("header-version-0", h(|h| h.version = 0)),
        ("header-version-2", h(|h| h.version = 2)),
        ("header-file-bytes", h(|h| h.file_bytes += 64)),
        ("header-checksum", valid.raw(|bytes, _| edit_header(bytes, |h| h.head_checksum ^= 1))),
        ("header-checksum-of-checksums", h(|h| h.checksums_checksum ^= 1)),
        ("header-507-sections", valid.raw(|bytes, _| edit_header(bytes, |h| h.n_sections = 507))),
        ("header-506-sections", valid.raw(|bytes, _| edit_header(bytes, |h| h.n_sections = 506))),
        ("header-no-sections", valid.raw(|bytes, _| edit_header(bytes, |h| h.n_sections = 0))),
        ("header-chunks-of-0", h(|h| h.chunk_bytes = 0)),
        ("header-chunks-of-4095", h(|h| h.chunk_bytes = 4095)),
        ("header-chunks-of-2-gib", h(|h| h.chunk_bytes = 1 << 31)),
        ("header-chunks-of-4-kib", h(|h| h.chunk_bytes = 1 << 12)),
        ("header-reserved", h(|h| h.reserved[0] = 1)),
        ("header-corners-0", h(|h| h.n_corners = 0)),
        ("header-corners-4", h(|h| h.n_corners = 4)),
        ("header-levels-0", h(|h| h.n_levels = 0)),
        ("header-levels-2-31", h(|h| h.n_levels = 1 << 31)),
        ("header-levels-2-31-and-1", h(|h| h.n_levels = (1 << 31) + 1)),
        ("header-vertices-2-32", h(|h| h.n_vertices = 1 << 32)),
        ("header-vertices-all-ones", h(|h| h.n_vertices = u64::MAX)),
        ("header-vertices-one-less", h(|h| h.n_vertices -= 1)),
        ("header-slots-2-32", h(|h| h.n_slots = 1 << 32)),
        ("header-slots-one-more", h(|h| h.n_slots += 1)),
        ("header-lifetimes-one-less", h(|h| h.n_lifetimes -= 1)),
        ("header-lifetimes-0", h(|h| h.n_lifetimes = 0)),
        ("header-origin-nan", h(|h| h.origin[1] = f64::NAN)),
        ("header-origin-largest", h(|h| h.origin = [f64::MAX; 3])),
        ("header-bounds-reversed", h(|h| h.bounds_min[2] = 1e9)),
        ("header-bounds-nan", h(|h| h.bounds_max[2] = f32::NAN)),
        ("header-bounds-too-tight", h(|h| h.bounds_max[0] = h.bounds_min[0])),
        ("header-rounding-negative", h(|h| h.rounding = -1.0)),
        ("header-rounding-infinite", h(|h| h.rounding = f64::INFINITY)),
    ]
}

fn directories() -> Cases {
    let valid = Valid::plain();
    let d = |edit: fn(&mut [SectionRecord])| valid.records(edit);
    vec![
        ("directory-reserved", d(|r| r[0].reserved = 1)),
        ("directory-flags", d(|r| r[0].flags |= 1 << 31)),
        (
            "directory-padding",
            valid.raw(|bytes, seal| {
                let body = seal.section(SectionKind::Metadata).0;
                if bytes[body - 32..body].iter().all(|&byte| byte == 0) {
                    bytes[body - 1] = 1
                } else {
                    bytes[body - 32] = 9
                }
            }),
        ),
        (
            "section-unknown-optional",
            d(|r| {
                for kind in 10..=12 {
                    r.iter_mut().filter(|r| r.kind == kind).for_each(|r| r.kind = 7000 + kind)
                }
            }),
        ),
        ("section-unknown-required", d(|r| (r[0].kind, r[0].flags) = (7000, REQUIRED))),
        ("section-twice", d(|r| r[1].kind = r[2].kind)),
        ("section-missing", d(|r| (r[0].kind, r[0].flags) = (7000, 0))),
        ("section-required-but-flagged-optional", d(|r| r[0].flags = 0)),
        (
            "section-checksums-not-last",
            d(|r| {
                let last = r.len() - 1;
                r[last].kind = 7000;
                r[last].flags = 0;
                (r[0].kind, r[0].flags) = (13, REQUIRED)
            }),
        ),
        (
            "section-checksums-unknown",
            d(|r| {
                let last = r.len() - 1;
                (r[last].kind, r[last].flags) = (7000, 0)
            }),
        ),
        ("sections-swapped", d(|r| r.swap(2, 3))),
        (
            "sections-swapped-kinds",
            d(|r| {
                let kind = r[2].kind;
                r[2].kind = r[3].kind;
                r[3].kind = kind
            }),
        ),
        (
            "sections-swapped-positions-and-simplices",
            d(|r| {
                let positions = record(r, SectionKind::Positions).kind;
                record(r, SectionKind::Simplices).kind = 999;
                record(r, SectionKind::Positions).kind = SectionKind::Simplices.code();
                r.iter_mut().find(|r| r.kind == 999).unwrap().kind = positions;
            }),
        ),
        ("sections-overlap", d(|r| r[2].offset -= 64)),
        ("sections-overlap-wholly", d(|r| r[3].offset = r[2].offset)),
        ("sections-hole", d(|r| r[2].offset += 64)),
        ("section-unaligned", d(|r| r[2].offset += 1)),
        ("section-in-the-head", d(|r| r[0].offset = 0)),
        ("section-beyond-the-file", d(|r| r[4].offset = 1 << 40)),
        ("section-offset-all-ones", d(|r| r[4].offset = u64::MAX)),
        ("section-longer-than-the-file", d(|r| r[4].bytes = 1 << 40)),
        ("section-length-all-ones", d(|r| r[4].bytes = u64::MAX)),
        ("section-length-wraps-around", d(|r| r[4].bytes = u64::MAX - r[4].offset + 1)),
        ("section-one-byte-longer", d(|r| r[1].bytes += 1)),
        ("section-one-byte-shorter", d(|r| r[1].bytes -= 1)),
        ("section-empty-metadata", d(|r| r[0].bytes = 0)),
        ("sections-end-before-the-file", d(|r| r[r.len() - 1].bytes -= 8)),
        ("forms-mixed", d(|r| record(r, SectionKind::Stamps).kind = SectionKind::CompactStamps.code())),
    ]
}

fn attributes() -> Cases {
    let valid = Valid::plain();
    let a = |edit: fn(&mut [AttributeRecord])| valid.section(SectionKind::AttributeTable, edit);
    vec![
        ("attribute-scalar", a(|t| t[0].scalar = 8)),
        ("attribute-no-components", a(|t| t[0].n_components = 0)),
        ("attribute-components-all-ones", a(|t| t[1].n_components = u32::MAX)),
        ("attribute-name-empty", a(|t| t[0].name_bytes = 0)),
        ("attribute-name-offset", a(|t| t[1].name_offset = 0)),
        ("attribute-name-beyond", a(|t| t[1].name_bytes = 900)),
        ("attribute-name-all-ones", a(|t| t[1].name_bytes = u32::MAX)),
        ("attribute-values-offset", a(|t| t[1].values_offset += 64)),
        ("attribute-values-bytes", a(|t| t[1].values_bytes = u64::MAX)),
        (
            "attribute-name-not-utf-8",
            valid.section::<u8>(SectionKind::AttributeNames, |names| names[0] = 0xff),
        ),
        (
            "attribute-values-any-bits",
            valid.section::<u8>(SectionKind::AttributeValues, |values| values[..40].fill(0xff)),
        ),
        ("attribute-table-alone", valid.records(|r| record(r, SectionKind::AttributeNames).kind = 7000)),
    ]
}

fn contents() -> Cases {
    let (valid, births) = (Valid::plain(), Valid::with_births());
    let chunk = |kind| valid.raw(|bytes, seal| bytes[seal.section(kind).0] ^= 1);
    vec![
        ("chunk-damaged", chunk(SectionKind::Stamps)),
        ("checksums-damaged", chunk(SectionKind::Checksums)),
        (
            "padding-not-zero",
            valid.raw(|bytes, seal| {
                let (offset, len) = seal.section(SectionKind::Metadata);
                bytes[offset + len] = 1;
                seal.renew(bytes);
            }),
        ),
        ("metadata-array", valid.section::<u8>(SectionKind::Metadata, |m| m[0] = b'[')),
        ("metadata-not-utf-8", valid.section::<u8>(SectionKind::Metadata, |m| m[3] = 0xff)),
        ("metadata-deep", valid.section::<u8>(SectionKind::Metadata, |m| m.fill(b'['))),
        ("errors-nan", valid.section::<f64>(SectionKind::Errors, |e| e[1] = f64::NAN)),
        (
            "errors-infinite",
            valid.section::<f64>(SectionKind::Errors, |e| *e.last_mut().unwrap() = f64::INFINITY),
        ),
        ("errors-negative", valid.section::<f64>(SectionKind::Errors, |e| e[0] = -1e-300)),
        ("errors-falling", valid.section::<f64>(SectionKind::Errors, |e| e[1] = 9.0)),
        ("simplex-counts-rising", valid.section::<u32>(SectionKind::SimplexCounts, |c| c[1] = u32::MAX)),
        ("simplex-counts-zero", valid.section::<u32>(SectionKind::SimplexCounts, |c| c.fill(0))),
        ("vertex-counts-rising", valid.section::<u32>(SectionKind::VertexCounts, |c| c[1] = u32::MAX)),
        ("vertex-counts-first", valid.section::<u32>(SectionKind::VertexCounts, |c| c[0] -= 1)),
        ("vertex-counts-zero", valid.section::<u32>(SectionKind::VertexCounts, |c| c[1..].fill(0))),
        ("position-nan", valid.section::<f32>(SectionKind::Positions, |p| p[0] = f32::NAN)),
        ("position-infinite", valid.section::<f32>(SectionKind::Positions, |p| p[7] = f32::INFINITY)),
        ("position-outside-the-bounds", valid.section::<f32>(SectionKind::Positions, |p| p[7] = 1e9)),
        ("births-beyond-the-levels", births.section::<u32>(SectionKind::VertexBirths, |b| b[0] = u32::MAX)),
        (
            "births-after-use",
            births.section::<u32>(SectionKind::VertexBirths, |b| {
                // Of those that are there from the beginning, the first lives longest.
                *b.iter_mut().find(|birth| **birth == 0).unwrap() = 1;
            }),
        ),
        ("births-all-zero", births.section::<u32>(SectionKind::VertexBirths, |b| b.fill(0))),
    ]
}

fn trees() -> Cases {
    let valid = Valid::plain();
    let offsets = |edit: fn(&mut [u64])| valid.section(SectionKind::RunOffsets, edit);
    let runs = |edit: fn(&mut [u32])| valid.section(SectionKind::Runs, edit);
    let simplices = |edit: fn(&mut [u32])| valid.section(SectionKind::Simplices, edit);
    let stamps = |edit: fn(&mut [u32])| valid.section(SectionKind::Stamps, edit);
    vec![
        ("run-offsets-first", offsets(|o| o[0] = 1)),
        ("run-offsets-falling", offsets(|o| o.swap(1, 2))),
        ("run-offsets-all-ones", offsets(|o| o.fill(u64::MAX))),
        ("run-offsets-all-zero", offsets(|o| o.fill(0))),
        (
            "run-offsets-one-level-has-all",
            offsets(|o| {
                let last = o[o.len() - 1];
                o[1..].fill(last)
            }),
        ),
        ("runs-all-ones", runs(|r| r.fill(u32::MAX))),
        ("runs-all-zero", runs(|r| r.fill(0))),
        ("runs-overlap", runs(|r| r[2] = r[0])),
        ("runs-begin-later", runs(|r| r[0] += 1)),
        ("runs-too-long", runs(|r| r[1] = u32::MAX)),
        ("runs-one-shorter", runs(|r| r[1] -= 1)),
        ("runs-empty", runs(|r| r.iter_mut().skip(1).step_by(2).for_each(|len| *len = 0))),
        ("runs-last-one-shorter", runs(|r| *r.last_mut().unwrap() -= 1)),
        ("simplices-all-ones", simplices(|s| s.fill(u32::MAX))),
        ("simplices-all-zero", simplices(|s| s.fill(0))),
        ("simplices-one-out-of-range", simplices(|s| s[4] = 1 << 20)),
        (
            "simplices-one-of-a-dead-vertex",
            simplices(|s| {
                let most = *s.iter().max().unwrap();
                *s.last_mut().unwrap() = most
            }),
        ),
        ("simplices-turned", simplices(|s| s.swap(0, 1))),
        ("stamps-all-ones", stamps(|s| s.fill(u32::MAX))),
        ("stamps-all-zero", stamps(|s| s.fill(0))),
        (
            "stamps-swapped",
            stamps(|s| {
                let last = s.len() - 1;
                s.swap(0, last)
            }),
        ),
        ("stamps-second-all-ones", stamps(|s| s[1] = u32::MAX)),
        ("stamps-last-another", stamps(|s| *s.last_mut().unwrap() += 1)),
        ("slots-no-run-reaches", no_run_reaches()),
        ("runs-one-more-than-heights", one_run_more()),
    ]
}

/// The last height-0 node's run left out of the offsets, so that the last slots belong to nobody.
fn no_run_reaches() -> Vec<u8> {
    let valid = Valid::plain();
    let (offset, len) = valid.seal.section(SectionKind::Runs);
    let runs: Vec<u32> = bytemuck::pod_collect_to_vec(&valid.bytes[offset..offset + len]);
    let end = runs.chunks(2).map(|run| run[0] + run[1]).max().unwrap();
    valid.section::<u32>(SectionKind::Runs, |runs| {
        for run in runs.chunks_mut(2).filter(|run| run[0] + run[1] == end) {
            run[1] -= 1;
        }
    })
}

/// A level with a run that no height has, every section in its place.
fn one_run_more() -> Vec<u8> {
    let mesh = grid(7);
    let valid = Valid::new(file_bytes_with(&mesh, &decimate(&mesh, usize::MAX, 3), &StoreOptions::default()));
    let mut sections: Vec<(SectionKind, Vec<u8>)> = SectionKind::ALL
        .into_iter()
        .filter(|&kind| kind != SectionKind::Checksums && valid.seal.section(kind).1 > 0)
        .map(|kind| (kind, valid.seal.section(kind)))
        .map(|(kind, (offset, len))| (kind, valid.bytes[offset..offset + len].to_vec()))
        .collect();
    let (start, len) = valid.seal.section(SectionKind::RunOffsets);
    let mut offsets: Vec<u64> = bytemuck::pod_collect_to_vec(&valid.bytes[start..start + len]);
    let n_heights = nephrite::tree::n_heights(offsets.len() as u32 - 1);
    let level = offsets.windows(2).position(|pair| pair[1] - pair[0] < u64::from(n_heights)).unwrap();
    let place = 8 * offsets[level + 1] as usize;
    offsets[level + 1..].iter_mut().for_each(|offset| *offset += 1);
    for (kind, contents) in &mut sections {
        match kind {
            SectionKind::Runs => drop(contents.splice(place..place, [0; 8])),
            SectionKind::RunOffsets => contents.copy_from_slice(bytemuck::cast_slice(&offsets)),
            _ => {}
        }
    }
    let lengths: Vec<_> = sections.iter().map(|(kind, contents)| (*kind, contents.len() as u64)).collect();
    let placement = plan(&lengths, CHUNK_BYTES).unwrap();
    let mut bytes = vec![0; placement.file_bytes as usize];
    bytes[..HEADER_BYTES].copy_from_slice(&valid.bytes[..HEADER_BYTES]);
    let directory: &[u8] = bytemuck::cast_slice(&placement.records);
    bytes[HEADER_BYTES..][..directory.len()].copy_from_slice(directory);
    for (record, (_, contents)) in placement.records.iter().zip(&sections) {
        bytes[record.offset as usize..][..contents.len()].copy_from_slice(contents);
    }
    assert!(reseal(&mut bytes));
    bytes
}

fn others() -> Cases {
    let deviations = Valid::with_deviations();
    let mut cases = compact();
    cases.extend([
        ("valid-with-deviations", deviations.bytes.clone()),
        ("deviations-falling", deviations.section::<f64>(SectionKind::Deviations, |d| d[0] = 1e9)),
        ("deviations-nan", deviations.section::<f64>(SectionKind::Deviations, |d| d[1] = f64::NAN)),
        (
            "deviations-without-name",
            deviations.section::<u8>(SectionKind::DeviationNames, |names| names.fill(0)),
        ),
        (
            "deviations-name-without-end",
            deviations.section::<u8>(SectionKind::DeviationNames, |names| names.fill(b'x')),
        ),
        (
            "deviations-name-not-utf-8",
            deviations.section::<u8>(SectionKind::DeviationNames, |names| names[0] = 0xff),
        ),
    ]);
    cases
}

fn compact() -> Cases {
    let compact = Valid::compact();
    vec![
        ("compact-repeats-all", compact.section::<u64>(SectionKind::RepeatBits, |bits| bits.fill(u64::MAX))),
        ("compact-repeats-none", compact.section::<u64>(SectionKind::RepeatBits, |bits| bits.fill(0))),
        (
            "compact-repeat-behind-the-last-slot",
            compact.section::<u64>(SectionKind::RepeatBits, |bits| {
                let last = bits.last_mut().unwrap();
                let lowest = last.trailing_zeros();
                *last = *last & !(1 << lowest) | 1 << 63;
            }),
        ),
        (
            "compact-source-out-of-range",
            compact.section::<u32>(SectionKind::RepeatSources, |s| s[0] = u32::MAX),
        ),
        ("compact-source-another", compact.section::<u32>(SectionKind::RepeatSources, |s| s[0] ^= 1)),
        (
            "compact-simplices-all-ones",
            compact.section::<u16>(SectionKind::DistinctSimplices, |s| s.fill(u16::MAX)),
        ),
        ("compact-stamps-all-ones", compact.section::<u16>(SectionKind::CompactStamps, |s| s.fill(u16::MAX))),
        ("compact-slots-one-more", compact.header(|h| h.n_slots += 1)),
        ("compact-slots-largest", compact.header(|h| h.n_slots = u32::MAX.into())),
    ]
}
