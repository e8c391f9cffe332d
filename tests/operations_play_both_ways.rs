//! Promise: an operation stream builds the input from nothing and takes it down again, exactly. The
//! beginning of a stream can be played as far as it goes; damaged streams end in an error.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "a test"
)]

mod support;

use nephrite::{
    Build, BuildOptions, Lod, ProgressiveBound, ProgressiveMesh, ProgressiveOptions, StoreOptions,
    TriangleMesh, VerifyError, build, generate,
};
use nephrite_formats::neph::SectionKind;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::io::Cursor;
use support::damage::with_section;

fn decimate(mesh: &TriangleMesh, pre_split: bool) -> Build {
    let bound = ProgressiveBound::Accumulated;
    let options = ProgressiveOptions { bound, pre_split, ..ProgressiveOptions::default() };
    build(mesh, &BuildOptions::with(options)).unwrap()
}

/// Triangles as the bits of the positions of their corners, independent of vertex numbers.
fn shape(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[[u32; 3]; 3]> {
    let bits = |&v: &u32| positions[v as usize].map(f32::to_bits);
    let mut shape: Vec<_> =
        triangles.iter().map(|corners| [0, 1, 2].map(|i: usize| bits(&corners[i]))).collect();
    shape.sort_unstable();
    shape
}

/// The triangles that the build began with.
fn input(build: &Build) -> Vec<[[u32; 3]; 3]> {
    shape(build.vertices().positions, &build.history().alive(0).collect::<Vec<_>>())
}

fn samples() -> Vec<Build> {
    vec![
        decimate(&generate::plate(3, 2, 12), true),
        decimate(&generate::torus(20, 10), false),
        decimate(&generate::moebius(20, 3), false),
        decimate(&generate::cosine(14), false),
    ]
}

#[test]
fn everything_comes_back_bit_by_bit() {
    for build in samples() {
        let mut mesh = ProgressiveMesh::from_bytes(&build.operations().unwrap().bytes).unwrap();
        assert!(mesh.is_whole() && mesh.triangles().is_empty() && mesh.positions().is_empty());
        mesh.refine(usize::MAX);
        let expected = input(&build);
        assert_eq!(shape(mesh.positions(), mesh.triangles()), expected);
        mesh.coarsen(usize::MAX);
        assert!(mesh.triangles().is_empty() && mesh.positions().is_empty());
    }
}

#[test]
fn any_count_is_met_with_one_operation_of_slack() {
    for build in samples() {
        let mut mesh = ProgressiveMesh::from_bytes(&build.operations().unwrap().bytes).unwrap();
        let n_in = build.history().n_alive(0);
        for n in (0..=n_in).rev().chain([n_in / 2, 3, n_in]) {
            let found = mesh.seek(n);
            assert!(found <= n && found + 2 > n, "{found} for {n}");
            let corners = mesh.triangles().as_flattened();
            assert!(corners.iter().all(|&v| (v as usize) < mesh.positions().len()));
            assert!(mesh.triangles().iter().all(|&[a, b, c]| a != b && b != c && c != a));
            let distinct: BTreeSet<[u32; 3]> = mesh.triangles().iter().copied().collect();
            assert_eq!(distinct.len(), found);
        }
    }
}

#[test]
fn streams_cut_anywhere_give_what_there_is() {
    let encoded = decimate(&generate::torus(24, 16), false).operations().unwrap();
    let mut whole = ProgressiveMesh::from_bytes(&encoded.bytes).unwrap();
    let mut growing = ProgressiveMesh::new();
    for (at, byte) in encoded.bytes.iter().enumerate() {
        let n_there = growing.append(&[*byte]).unwrap();
        if at % 97 == 0 {
            let cut = ProgressiveMesh::from_bytes(&encoded.bytes[..=at]).unwrap();
            assert_eq!(cut.n_operations(), n_there);
        }
        growing.refine(usize::MAX);
    }
    assert!(growing.is_whole());
    whole.refine(usize::MAX);
    assert_eq!(growing.triangles(), whole.triangles());
}

#[test]
fn streams_are_half_as_long_as_indices_and_positions() {
    let encoded = decimate(&generate::torus(120, 60), false).operations().unwrap();
    let standard = 36 * 120 * 60;
    let (plain, coded) = (encoded.plain_bytes, encoded.bytes.len());
    assert!(plain * 9 <= standard * 8, "{plain} of {standard}");
    assert!(coded * 9 <= standard * 4, "{coded} of {standard}");
}

/// The result of verifying a file with these operations.
fn verify_with(build: &Build, operations: &[u8]) -> Result<(), VerifyError> {
    let mut file = Cursor::new(Vec::new());
    build.write_to(&mut file, &StoreOptions::default()).unwrap();
    let file = with_section(file.get_ref(), SectionKind::Operations, operations);
    Lod::from_bytes(&file).unwrap().verify()
}

#[test]
fn files_are_verified_to_hold_operations_that_build_their_input() {
    for build in samples() {
        let operations = build.operations().unwrap().bytes;
        let mut file = Cursor::new(Vec::new());
        build.write_to(&mut file, &StoreOptions { operations: true, ..StoreOptions::default() }).unwrap();
        Lod::from_bytes(file.get_ref()).unwrap().verify().unwrap();
        verify_with(&build, &operations).unwrap();
        let cut = &operations[..operations.len() - 1];
        assert!(matches!(verify_with(&build, cut), Err(VerifyError::OperationCount { found: 0.., .. })));
        let mut damaged = operations.clone();
        damaged[operations.len() - 1] ^= 1;
        assert!(matches!(verify_with(&build, &damaged), Err(VerifyError::Operations(_))));
        let other = decimate(&generate::torus(9, 5), false).operations().unwrap().bytes;
        let found = verify_with(&build, &other);
        assert!(matches!(found, Err(VerifyError::OperationsMesh { found: 0, .. })), "{found:?}");
    }
}

proptest! {
    #[test]
    fn random_walks_lead_to_the_same_meshes(moves in prop::collection::vec((any::<bool>(), 0_usize..90), 1..60)) {
        let encoded = decimate(&generate::plate(2, 1, 8), true).operations().unwrap();
        let mut mesh = ProgressiveMesh::from_bytes(&encoded.bytes).unwrap();
        for (forward, n) in moves {
            if forward { mesh.refine(n) } else { mesh.coarsen(n) };
            let mut fresh = ProgressiveMesh::from_bytes(&encoded.bytes).unwrap();
            fresh.refine(mesh.position());
            prop_assert_eq!(mesh.triangles(), fresh.triangles());
            prop_assert_eq!(mesh.positions(), fresh.positions());
        }
    }

    #[test]
    fn damaged_bytes_end_in_an_error_or_a_mesh(at in 0_usize..4000, byte in any::<u8>(), reseal in any::<bool>()) {
        let mut bytes = decimate(&generate::torus(12, 8), false).operations().unwrap().bytes;
        let at = at % bytes.len();
        bytes[at] = byte;
        if reseal && at >= 28 {
            let coded_len = u32::from_le_bytes(bytes[20..24].try_into().unwrap()) as usize;
            let end = (28 + coded_len).min(bytes.len());
            let checksum = nephrite_formats::neph::checksum(&bytes[28..end]) as u32;
            bytes[24..28].copy_from_slice(&checksum.to_le_bytes());
        }
        let mut mesh = ProgressiveMesh::new();
        // What was read before an error can be played.
        let _ = mesh.append(&bytes);
        mesh.refine(usize::MAX);
        let n_vertices = mesh.positions().len();
        prop_assert!(mesh.triangles().as_flattened().iter().all(|&v| (v as usize) < n_vertices));
        mesh.coarsen(usize::MAX);
        prop_assert!(mesh.triangles().is_empty());
    }
}

#[test]
fn an_edge_of_many_faces_comes_back() {
    for n_faces in [63, 64, 65, 300] {
        let mut mesh = TriangleMesh { positions: vec![[0.0; 3], [0.0, 0.0, 1.0]], ..TriangleMesh::default() };
        for page in 0..n_faces {
            let angle = f64::from(page) * std::f64::consts::TAU / f64::from(n_faces);
            mesh.positions.push([angle.cos() as f32, angle.sin() as f32, 0.5]);
            mesh.triangles.push([0, 1, page + 2]);
        }
        let build = decimate(&mesh, false);
        let mut played = ProgressiveMesh::from_bytes(&build.operations().unwrap().bytes).unwrap();
        played.refine(usize::MAX);
        let expected = input(&build);
        assert_eq!(shape(played.positions(), played.triangles()), expected, "{n_faces} faces");
    }
}
