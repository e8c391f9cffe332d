//! Promise: every level of a file is the mesh that a linear scan of its history gives, over a
//! prefix of the vertices.
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small meshes")]

mod support;

use nephrite::{History, Levels, Lod, NEVER, QueryError, StoreOptions, TriangleMesh};
use proptest::prelude::*;
use support::synthetic::{Random, decimate, grid, succeed};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn of_any_history_at_every_level(
        side in 2usize..12, n_removals in 0usize..100, seed: u64, limit in prop::option::of(1u32..40)
    ) {
        let mesh = grid(side);
        let history = decimate(&mesh, n_removals, seed);
        prop_assert_eq!(history.check(), Ok(()));
        let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, limit)).unwrap();
        lod.verify().unwrap();
        let levels = Levels::choose(&history, limit).unwrap();
        support::assert_levels_equal_scans(&lod, &mesh, &history, &levels);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn of_any_history_in_which_vertices_are_born(
        side in 2usize..12, n_removals in 0usize..100, seed: u64, limit in prop::option::of(1u32..40)
    ) {
        let mut mesh = grid(side);
        let mut history = decimate(&mesh, n_removals, seed);
        succeed(&mut mesh, &mut history, seed ^ 1);
        prop_assert_eq!(history.check(), Ok(()));
        let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, limit)).unwrap();
        lod.verify().unwrap();
        let levels = Levels::choose(&history, limit).unwrap();
        support::assert_levels_equal_scans(&lod, &mesh, &history, &levels);
        for level in 0..lod.n_levels() {
            let cut = lod.at_level(level);
            let found = cut.to_mesh().unwrap();
            // A mesh of its own has only the vertices that its triangles use, each with its own
            // values.
            let n_used = found.triangles.iter().flatten().collect::<std::collections::BTreeSet<_>>().len();
            prop_assert_eq!((found.positions.len(), cut.n_vertices()), (n_used, n_used));
            prop_assert!(found.check().is_ok());
        }
    }
}

#[test]
fn vertices_that_no_level_sees_are_not_stored() {
    let mut mesh = grid(12);
    let mut history = decimate(&mesh, usize::MAX, 3);
    succeed(&mut mesh, &mut history, 4);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, Some(3))).unwrap();
    let levels = Levels::choose(&history, Some(3)).unwrap();
    let lifetimes = (0..).zip(&history.vertex_death);
    let is_seen = |v: u32, death: u32| levels.lifetime(history.vertex_birth(v), death).is_some();
    let n_seen = lifetimes.filter(|&(v, &death)| is_seen(v, death)).count();
    assert_eq!(lod.vertices().len(), n_seen);
    assert!(n_seen < mesh.positions.len());
}

#[test]
fn the_first_level_is_the_input_with_its_attributes() {
    let mesh = grid(40);
    let history = decimate(&mesh, usize::MAX, 1);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, None)).unwrap();
    let found = lod.at_level(0).to_mesh().unwrap();
    assert_eq!(support::triangle_set(&found), support::triangle_set(&mesh));
    assert_eq!(found.origin, mesh.origin);
    assert_eq!(found.attributes.len(), mesh.attributes.len());

    // The attribute `quality` is the number of the vertex in the input, so it tells where each
    // vertex went.
    let quality: Vec<f64> = bytemuck::pod_collect_to_vec(&found.attributes[1].bytes);
    for (place, &vertex) in quality.iter().enumerate() {
        let vertex = vertex as usize;
        assert_eq!(found.positions[place], mesh.positions[vertex]);
        assert_eq!(found.attributes[0].bytes[3 * place..][..3], mesh.attributes[0].bytes[3 * vertex..][..3]);
    }
    let mut vertices: Vec<usize> = quality.iter().map(|&vertex| vertex as usize).collect();
    vertices.sort_unstable();
    assert!(vertices.into_iter().eq(0..mesh.positions.len()));
}

#[test]
fn queries_give_the_level_that_a_scan_of_the_curve_gives() {
    let mesh = grid(60);
    let history = decimate(&mesh, usize::MAX, 2);
    let lod = Lod::from_bytes(&support::file_bytes(&mesh, &history, None)).unwrap();
    let curve: Vec<_> = lod.curve().collect();
    assert!(curve.len() > 100);

    let mut errors: Vec<f64> =
        curve.iter().flat_map(|point| [point.error, point.error * 0.999, point.error * 1.001]).collect();
    errors.extend([0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE]);
    for error in errors {
        let expected = curve.iter().rposition(|point| point.error <= error).unwrap_or(0);
        assert_eq!(lod.at_error(error).level() as usize, expected, "{error}");
    }
    for n_triangles in (0..curve[0].simplices as usize + 2).chain([usize::MAX]) {
        let expected = curve.iter().position(|point| point.simplices as usize <= n_triangles);
        let cut = lod.at_count(n_triangles);
        assert_eq!(cut.level() as usize, expected.unwrap_or(curve.len() - 1), "{n_triangles}");
    }
    for (level, point) in (0..).zip(&curve) {
        let cut = lod.at_level(level);
        assert_eq!((cut.error(), cut.n_simplices()), (point.error, point.simplices as usize));
        assert_eq!(cut.prefix_len(), point.vertices as usize);
        assert!(cut.n_runs() <= (usize::BITS - (curve.len() - 1).leading_zeros()) as usize + 1);
    }
    assert_eq!(lod.at_level(u32::MAX).level(), lod.n_levels() - 1);
}

#[test]
fn tetrahedra_are_stored_like_triangles() {
    let mut random = Random(8);
    let (n_steps, n_vertices) = (40u32, 60u32);
    let mesh = TriangleMesh { positions: vec![[0.5; 3]; n_vertices as usize], ..TriangleMesh::default() };
    let mut history = History::<4> {
        vertex_death: (0..n_vertices).map(|v| if v < 20 { NEVER } else { n_vertices - v }).collect(),
        errors: (0..=n_steps).map(f64::from).collect(),
        ..History::default()
    };
    for _ in 0..300 {
        let birth = random.below(2) as u32 * random.below(n_steps as usize) as u32;
        let death = birth + 1 + random.below((n_steps - birth) as usize) as u32;
        // Every vertex below this one lives until the death.
        let n_usable = (n_vertices - death) as usize;
        history.simplices.push(std::array::from_fn(|_| random.below(n_usable + 1) as u32));
        history.birth.push(birth);
        history.death.push(death);
    }
    let mut stream = std::io::Cursor::new(Vec::new());
    let options = StoreOptions { levels: Some(u32::MAX), ..StoreOptions::default() };
    history.write_to(&mut stream, &mesh, &options).unwrap();
    let lod = Lod::from_bytes(stream.get_ref()).unwrap();
    lod.verify().unwrap();
    assert_eq!(lod.n_corners(), 4);
    let levels = Levels::choose(&history, options.levels).unwrap();
    for (level, &step) in (0..).zip(levels.steps()) {
        let cut = lod.at_level(level);
        let mut indices = vec![0; cut.n_indices()];
        cut.extract_into(&mut indices).unwrap();
        assert!(indices.iter().all(|&index| (index as usize) < cut.prefix_len()));
        let n_alive = (0..300).filter(|&id| history.birth[id] <= step && step < history.death[id]).count();
        assert_eq!(cut.n_simplices(), n_alive);
        assert_eq!(cut.to_mesh(), Err(QueryError::NotTriangles { found: 4 }));
    }
}
