//! Bad contents of sections that are in their places.

use super::Cases;
use super::valid::{Valid, record};
use nephrite_formats::neph::{AttributeRecord, SectionKind};

pub(crate) fn cases() -> Cases {
    [attributes(), contents(), deviations(), compact()].concat()
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

fn deviations() -> Cases {
    let deviations = Valid::with_deviations();
    vec![
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
    ]
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
        (
            "compact-source-of-a-later-slot",
            compact.section::<u32>(SectionKind::RepeatSources, |s| s[0] = *s.iter().max().unwrap()),
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
