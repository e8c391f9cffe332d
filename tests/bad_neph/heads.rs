//! Bad headers and directories, and files that are no such thing.

use super::Cases;
use super::support::damage::edit_header;
use super::valid::{Valid, record};
use nephrite_formats::neph::{HEADER_BYTES, Header, REQUIRED, SectionKind, SectionRecord};

pub(crate) fn cases() -> Cases {
    [whole(), headers(), records(), places()].concat()
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

/// The header alone.
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

/// Which sections the directory lists, and how.
fn records() -> Cases {
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
    ]
}

/// Where the directory has its sections.
fn places() -> Cases {
    let valid = Valid::plain();
    let d = |edit: fn(&mut [SectionRecord])| valid.records(edit);
    vec![
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
