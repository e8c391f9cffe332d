//! Bad interval trees: runs, their offsets, slots and stamps.

use super::Cases;
use super::support::damage::reseal;
use super::support::file_bytes_with;
use super::support::synthetic::{decimate, grid};
use super::valid::Valid;
use nephrite::StoreOptions;
use nephrite_formats::neph::{CHUNK_BYTES, HEADER_BYTES, SectionKind, plan};

pub(crate) fn cases() -> Cases {
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
                let other = s.iter().rposition(|&stamp| stamp != s[0]).unwrap();
                s.swap(0, other)
            }),
        ),
        ("stamps-second-all-ones", stamps(|s| s[1] = u32::MAX)),
        ("stamps-last-another", stamps(|s| *s.last_mut().unwrap() += 1)),
        ("slots-no-run-reaches", no_run_reaches()),
        ("runs-one-more-than-heights", one_run_more()),
    ]
}

/// The run of the last node of height 0 is left out of the offsets, so that no run reaches the last
/// slots.
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

/// A level with a run that no height has; every section has the right length.
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
    let n_levels = offsets.len() as u32 - 1;
    let n_heights = u32::BITS - (n_levels - 1).leading_zeros() + 1;
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
