//! PLOT3D: dimensions against bytes, framing, coordinates, blanks.

use super::{Case, Cases, named};

/// A grid of points with its dimensions, as little-endian floats.
fn grid(dimensions: [u32; 3], map: impl Fn([f32; 3]) -> [f32; 3]) -> Vec<u8> {
    [words(dimensions).concat(), values(dimensions, map)].concat()
}

fn words<const N: usize>(values: [u32; N]) -> [[u8; 4]; N] {
    values.map(u32::to_le_bytes)
}

/// All x, then all y, then all z, the first index fastest.
fn values([ni, nj, nk]: [u32; 3], map: impl Fn([f32; 3]) -> [f32; 3]) -> Vec<u8> {
    let points: Vec<[f32; 3]> = (0..ni * nj * nk)
        .map(|index| map([index % ni, index / ni % nj, index / (ni * nj)].map(|i| i as f32)))
        .collect();
    (0..3).flat_map(|axis| points.iter().flat_map(move |point| point[axis].to_le_bytes())).collect()
}

/// A Fortran record: its length before and behind it.
fn record(bytes: &[u8], stated_bytes: u32) -> Vec<u8> {
    [&stated_bytes.to_le_bytes()[..], bytes, &stated_bytes.to_le_bytes()].concat()
}

pub(crate) fn cases() -> Vec<Case> {
    let mut cases = named("p3d", lengths());
    cases.extend(named("p3d", contents()));
    cases
}

fn lengths() -> Cases {
    let whole = grid([3, 3, 2], |point| point);
    let claimed = |dimensions: [u32; 3]| [words(dimensions).concat(), whole[12..].to_vec()].concat();
    let (head, body) = whole.split_at(12);
    let framed = |stated: u32| [record(head, 12), record(body, stated)].concat();
    let length = body.len() as u32;
    vec![
        ("whole", whole.clone()),
        ("empty", Vec::new()),
        ("dimensions-cut", whole[..11].to_vec()),
        ("dimensions-only", head.to_vec()),
        ("dimensions-all-ones", claimed([u32::MAX; 3])),
        ("dimensions-2-64", claimed([1 << 31, 1 << 31, 4])),
        ("dimensions-zero", claimed([0, 3, 2])),
        ("dimensions-one", grid([3, 3, 1], |point| point)),
        ("dimensions-one-more", claimed([4, 3, 2])),
        ("dimensions-big-endian", [words([3, 3, 2].map(u32::swap_bytes)).concat(), body.to_vec()].concat()),
        ("values-cut", whole[..whole.len() - 1].to_vec()),
        ("trailing-byte", [&whole[..], b"x"].concat()),
        ("blocks-1", [&1_u32.to_le_bytes()[..], &whole].concat()),
        ("blocks-2", [&2_u32.to_le_bytes()[..], &whole].concat()),
        ("blocks-all-ones", [&u32::MAX.to_le_bytes()[..], &whole].concat()),
        ("records-whole", framed(length)),
        ("records-wrong-length", framed(length + 1)),
        ("text", b"3 3 2\n0 0 0 1 1 1\n".to_vec()),
        ("all-ones", vec![0xff; 300]),
        ("all-zeros", vec![0; 300]),
    ]
}

fn contents() -> Cases {
    let blanked = |blanks: [u32; 18]| [grid([3, 3, 2], |point| point), words(blanks).concat()].concat();
    let mut one_blank = [1; 18];
    one_blank[4] = 0;
    vec![
        ("coordinate-nan", grid([3, 3, 2], |[x, y, z]| [x, if y > 1.0 { f32::NAN } else { y }, z])),
        ("coordinate-infinity", grid([3, 3, 2], |[x, y, z]| [x, y, if z > 0.0 { f32::INFINITY } else { z }])),
        ("coordinates-all-equal", grid([3, 3, 2], |_| [5.0; 3])),
        ("coordinates-planar", grid([3, 3, 2], |[x, y, _]| [x, y, 0.0])),
        ("coordinates-inside-out", grid([3, 3, 2], |[x, y, z]| [-x, y, z])),
        ("coordinates-folded", grid([3, 3, 2], |[x, y, z]| [if x > 1.5 { 0.5 } else { x }, y, z])),
        ("coordinates-subnormal", grid([3, 3, 2], |point| point.map(|x| x * 1e-42))),
        ("coordinates-largest", grid([3, 3, 2], |point| point.map(|x| x * 1.6e38))),
        ("blanks-none", blanked([1; 18])),
        ("blanks-all", blanked([0; 18])),
        ("blanks-one", blanked(one_blank)),
        ("blanks-any-number", blanked([u32::MAX; 18])),
    ]
}
