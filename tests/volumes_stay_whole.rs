//! Promise: every level of a volume is a whole volume. No tetrahedron is inverted; the volume stays
//! within 0.1 %; the topology of the boundary, its corners and creases, and a linear field are
//! kept; and the boundary is as close to that of the input as the level states.
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small meshes")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::generate::{ball_volume, box_volume};
use nephrite::measure::{Verdict, check_within, measure_fields};
use nephrite::{
    Attribute, Bound, ErrorTable, FusionOptions, Lod, ReproveError, ScalarType, TetrahedronMesh,
    TriangleMesh, VolumeBuild, VolumeOptions, build_volume,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use support::served::served;

fn built(mesh: &TetrahedronMesh, options: &VolumeOptions) -> (VolumeBuild, Lod) {
    let build = build_volume(mesh, options).unwrap();
    let lod = served(|stream, options| build.write_to(stream, options));
    (build, lod)
}

/// All tetrahedra that can be are fused whole before edges, as in the paper.
fn fused_whole() -> VolumeOptions {
    let fusion = FusionOptions { tetrahedron_share: 1.0, ..FusionOptions::default() };
    VolumeOptions { fusion, ..VolumeOptions::default() }
}

/// Levels spread over the file, the first and the last among them.
fn spread(lod: &Lod, n: u32) -> BTreeSet<u32> {
    (0..=n).map(|i| (lod.n_levels() - 1) * i / n).collect()
}

/// Euler characteristic and components of a closed surface whose every edge has two faces.
fn topology(surface: &TriangleMesh) -> (i64, usize) {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    let mut roots: Vec<u32> = (0..surface.positions.len() as u32).collect();
    fn root(roots: &[u32], mut v: u32) -> u32 {
        while roots[v as usize] != v {
            v = roots[v as usize];
        }
        v
    }
    for &[a, b, c] in &surface.triangles {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            *edges.entry([p.min(q), p.max(q)]).or_insert(0) += 1;
            let (p, q) = (root(&roots, p), root(&roots, q));
            roots[p.max(q) as usize] = p.min(q);
        }
    }
    assert!(edges.values().all(|&n_faces| n_faces == 2), "the boundary is not a surface");
    let n_components = roots.iter().enumerate().filter(|&(v, &root)| v == root as usize).count();
    let [n_vertices, n_edges, n_triangles] =
        [surface.positions.len(), edges.len(), surface.triangles.len()].map(|n| i64::try_from(n).unwrap());
    let characteristic = n_vertices - n_edges + n_triangles;
    (characteristic, n_components)
}

/// Checks what holds of every volume, at every level given.
fn check(input: &TetrahedronMesh, lod: &Lod, levels: &BTreeSet<u32>) {
    let surface = nephrite::boundary(&lod.at_level(0).to_volume().unwrap()).unwrap();
    let expected = topology(&surface);
    for &level in levels {
        let cut = lod.at_level(level);
        let mesh = cut.to_volume().unwrap();
        mesh.check().unwrap();
        assert!(mesh.tetrahedra.iter().all(|&t| mesh.six_volumes(t) > 0.0), "inverted at level {level}");
        let kept = mesh.volume() / input.volume();
        assert!((kept - 1.0).abs() <= 0.001, "{kept} of the volume at level {level}");
        let boundary = cut.boundary().unwrap();
        assert_eq!(topology(&boundary), expected, "level {level}");
        let limit = cut.error().max(1e-6 * nephrite::bounding_diagonal(input));
        let verdict = check_within(&surface, &boundary, limit, 50_000_000).unwrap();
        assert_eq!(verdict, Verdict::Within, "level {level} states {}", cut.error());
    }
}

#[test]
fn a_box_keeps_its_corners_edges_and_linear_field() {
    let input = box_volume([12, 11, 10]);
    let (build, lod) = built(&input, &VolumeOptions::default());
    let levels: BTreeSet<u32> = (0..lod.n_levels()).collect();
    check(&input, &lod, &levels);
    // Flat faces give no reason to stop.
    let coarsest = lod.at_level(lod.n_levels() - 1);
    assert!(coarsest.n_simplices() * 20 < input.tetrahedra.len(), "{}", coarsest.n_simplices());
    assert!(build.fusions().n_tetrahedron_fusions > 0);
    for &level in &levels {
        let mesh = lod.at_level(level).to_volume().unwrap();
        let positions: BTreeSet<[u32; 3]> = mesh.positions.iter().map(|p| p.map(f32::to_bits)).collect();
        for corner in 0..8 {
            let corner =
                [corner & 1, corner >> 1 & 1, corner >> 2 & 1].map(|bit: u32| (bit as f32).to_bits());
            assert!(positions.contains(&corner), "level {level}");
        }
        // Volume 1 in the box [0, 1]^3 with straight faces: the box itself, with its edges.
        assert!((mesh.volume() - 1.0).abs() < 1e-6);
        assert!(mesh.positions.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
        let field: Vec<f64> = mesh.attribute("linear").unwrap().values().collect();
        for (p, value) in mesh.positions.iter().zip(field) {
            let [x, y, z] = p.map(f64::from);
            assert!((1.0 + 2.0 * x + 3.0 * y - 4.0 * z - value).abs() < 1e-12, "level {level}");
        }
        for field in measure_fields(&input, &mesh).unwrap() {
            assert!(field.max < 1e-6 && field.n_outside == 0, "{field:?}");
        }
    }
    let linear = build.history().deviations.iter().find(|deviation| deviation.name == "linear").unwrap();
    let deviation = *linear.values.last().unwrap();
    assert!(deviation < 1e-6, "{deviation:e}");
}

#[test]
fn a_ball_stays_a_ball() {
    let input = ball_volume(16);
    let (build, lod) = built(&input, &fused_whole());
    check(&input, &lod, &spread(&lod, 20));
    // A tetrahedron inside takes at least eleven with it, the lower bound of the paper.
    let n_left = lod.at_level(lod.n_levels() - 1).n_simplices();
    assert!(
        build.fusions().n_left_by_tetrahedra * 10 < 7 * input.tetrahedra.len(),
        "{}",
        build.fusions().n_left_by_tetrahedra
    );
    assert!(n_left * 2 < input.tetrahedra.len(), "{n_left}");
    assert!(
        input.tetrahedra.len() - build.fusions().n_left_by_tetrahedra
            >= 11 * build.fusions().n_tetrahedron_fusions
    );
}

#[test]
fn a_limit_on_the_error_is_kept() {
    let input = ball_volume(12);
    let limit = 0.002;
    let options = VolumeOptions { max_error: Some(limit), ..VolumeOptions::default() };
    let (_, lod) = built(&input, &options);
    assert!(lod.errors().iter().all(|&error| error <= limit));
    check(&input, &lod, &spread(&lod, 5));
}

#[test]
fn threads_do_not_change_the_history() {
    let input = ball_volume(8);
    let build = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| build_volume(&input, &VolumeOptions::default()).unwrap())
    };
    assert_eq!(build(1), build(3));
}

#[test]
fn the_paper_s_smallest_volume_reaches_its_reduction() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data/volume/spx.vtk");
    if !path.is_file() {
        return;
    }
    let (input, _) = nephrite_formats::read_volume(&path).unwrap();
    let (build, lod) = built(&input, &fused_whole());
    check(&input, &lod, &spread(&lod, 12));
    let n_coarsest = lod.at_level(lod.n_levels() - 1).n_simplices();
    let reduction = 1.0 - n_coarsest as f64 / input.tetrahedra.len() as f64;
    assert!(reduction >= 0.536_48, "{reduction}");
    let n_fused = input.tetrahedra.len() - build.fusions().n_left_by_tetrahedra;
    assert!(
        n_fused >= 11 * build.fusions().n_tetrahedron_fusions,
        "{n_fused} in {}",
        build.fusions().n_tetrahedron_fusions
    );
}

/// Promise: `verify --bound` proves the boundary of a volume's levels from the file alone.
#[test]
fn the_boundary_s_errors_are_proven_anew() {
    let input = ball_volume(8);
    let (build, certified) = built(&input, &VolumeOptions::default());
    let table = ErrorTable::new(&certified).unwrap();
    for &level in &spread(&certified, 6) {
        table.prove(level).unwrap();
    }
    // The history alone states nothing.
    let unstated = served(|stream, options| build.history().write_to(stream, build.vertices(), options));
    let refused = ErrorTable::new(&unstated).map(drop);
    assert_eq!(refused, Err(ReproveError::NotCertified { found: Bound::Unstated }));
}

#[test]
fn fields_of_the_largest_values_are_written() {
    let mut mesh = box_volume([4; 3]);
    let values = (0..mesh.positions.len()).map(|v| if v % 2 == 0 { f64::MAX } else { -f64::MAX });
    mesh.attributes = vec![Attribute::from_values("f", ScalarType::F64, 1, values)];
    let (build, lod) = built(&mesh, &VolumeOptions::default());
    assert!(build.fusions().n_fusions > 0 && lod.n_levels() > 1);
}

#[test]
fn a_locked_boundary_stays() {
    let input = ball_volume(12);
    let options = VolumeOptions { lock_boundary: true, ..VolumeOptions::default() };
    let (_, lod) = built(&input, &options);
    check(&input, &lod, &spread(&lod, 5));
    let triangles = |level: u32| {
        let surface = lod.at_level(level).boundary().unwrap();
        let place = |v: u32| surface.positions[v as usize].map(f32::to_bits);
        let sorted = |t: &[u32; 3]| {
            let mut corners = t.map(place);
            corners.sort_unstable();
            corners
        };
        surface.triangles.iter().map(sorted).collect::<BTreeSet<_>>()
    };
    let last = lod.n_levels() - 1;
    assert!(spread(&lod, 8).iter().all(|&level| triangles(level) == triangles(0)));
    assert!(lod.errors().iter().all(|&error| error == 0.0));
    let n_coarsest = lod.at_level(last).n_simplices();
    assert!(n_coarsest * 2 < input.tetrahedra.len(), "{n_coarsest}");
}

/// A coarse box beside a fine one.
#[test]
fn hanging_nodes_are_told() {
    let [mut mesh, fine] = [[4; 3], [8; 3]].map(box_volume);
    let build = |mesh: &TetrahedronMesh| {
        let build = build_volume(mesh, &VolumeOptions::default()).unwrap();
        (build.repairs().faces_at_hanging_nodes, build.inner_wall_area())
    };
    assert_eq!(build(&mesh), (0, 0.0));
    let n_vertices = mesh.positions.len() as u32;
    mesh.attributes.clear();
    mesh.positions.extend(fine.positions.iter().map(|&[x, y, z]| [x + 1.0, y, z]));
    mesh.tetrahedra.extend(fine.tetrahedra.iter().map(|t| t.map(|v| v + n_vertices)));
    let (n_faces, area) = build(&mesh);
    assert_eq!(n_faces, 2 * (16 + 64));
    assert!((area - 2.0).abs() < 1e-9, "{area}");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases/volumes/amr_hanging.vtu");
    if !path.is_file() {
        eprintln!("skipped: no {}", path.display());
        return;
    }
    let (input, _) = nephrite_formats::read_volume(&path).unwrap();
    assert!((build(&input).1 - 2.0).abs() < 1e-9 && (input.volume() - 2.0).abs() < 1e-6);
}
