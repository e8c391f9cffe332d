//! Operation streams that do not build level 0: of a mesh of one triangle, made by hand from the
//! description of the format.

use super::Cases;
use super::support::damage::with_section;
use super::support::file_bytes_with;
use nephrite::{History, NEVER, StoreOptions, TriangleMesh};
use nephrite_formats::neph::{self, SectionKind};

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -2.0]];

pub(crate) fn cases() -> Cases {
    let valid = stream(&CORNERS, 1);
    let changed = |edit: fn(&mut Vec<u8>)| {
        let mut stream = valid.clone();
        edit(&mut stream);
        file(&stream)
    };
    vec![
        ("operations-of-one-triangle", file(&valid)),
        ("operations-of-another-triangle", file(&stream(&[CORNERS[0], CORNERS[2], CORNERS[1]], 1))),
        ("operations-cut", changed(|bytes| bytes.truncate(bytes.len() - 1))),
        ("operations-header-alone", changed(|bytes| bytes.truncate(16))),
        ("operations-header-cut", changed(|bytes| bytes.truncate(15))),
        ("operations-fewer-than-announced", file(&stream(&CORNERS, u64::MAX))),
        ("operations-another-format", changed(|bytes| bytes[3] = b'2')),
        ("operations-damaged", changed(|bytes| *bytes.last_mut().unwrap() ^= 1)),
        ("operations-attributes-all-ones", changed(|bytes| bytes[4..8].fill(0xff))),
        ("operations-block-all-ones", changed(|bytes| bytes[16..24].fill(0xff))),
    ]
}

/// A file of one level and one triangle with these operations.
fn file(operations: &[u8]) -> Vec<u8> {
    let mesh =
        TriangleMesh { positions: CORNERS.to_vec(), triangles: vec![[0, 1, 2]], ..TriangleMesh::default() };
    let history = History {
        simplices: vec![[0, 1, 2]],
        birth: vec![0],
        death: vec![NEVER],
        vertex_death: vec![NEVER; 3],
        errors: vec![0.0],
        ..History::default()
    };
    let file = file_bytes_with(&mesh, &history, &StoreOptions::default());
    with_section(&file, SectionKind::Operations, operations)
}

/// One operation, a triangle of three new vertices, in one uncompressed block.
fn stream(corners: &[[f32; 3]; 3], n_announced: u64) -> Vec<u8> {
    let mut planes = vec![Vec::new(); 12];
    planes[0].push(2);
    let mut before = [0.0; 3];
    for (number, &corner) in (0u32..).zip(corners) {
        put(&mut planes[1..5], number);
        (0..3).for_each(|axis| put(&mut planes[8..12], difference(corner[axis], before[axis])));
        before = corner;
    }
    let mut coded = Vec::new();
    for plane in &planes {
        let len = (plane.len() as u32).to_le_bytes();
        coded.extend(len.into_iter().chain(len).chain(plane.iter().copied()));
    }
    let mut stream = b"NPS1".to_vec();
    stream.extend(0u32.to_le_bytes());
    stream.extend(n_announced.to_le_bytes());
    stream.extend(1u32.to_le_bytes());
    stream.extend((coded.len() as u32).to_le_bytes());
    stream.extend(&neph::checksum(&coded).to_le_bytes()[..4]);
    stream.extend(coded);
    stream
}

/// Puts the bytes of a number into four planes, the lowest first.
fn put(planes: &mut [Vec<u8>], value: u32) {
    planes.iter_mut().zip(value.to_le_bytes()).for_each(|(plane, byte)| plane.push(byte));
}

/// The difference of the ranks of two floats in the order of all floats, doubled, with the sign in
/// the last bit.
fn difference(value: f32, from: f32) -> u32 {
    let place = |x: f32| if x.is_sign_negative() { !x.to_bits() } else { x.to_bits() | 1 << 31 };
    let steps = place(value).wrapping_sub(place(from));
    if steps >> 31 == 1 { !(steps << 1) } else { steps << 1 }
}
