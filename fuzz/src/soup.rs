//! Random triangles made into a file, and random histories.

use crate::script::Script;
use nephrite::{
    Attribute, BuildError, BuildOptions, EstimateKind, FusionOptions, History, JadeOptions, Lod, NEVER,
    Placement, ProgressiveBound, ProgressiveMesh, ProgressiveOptions, ScalarType, StoreOptions,
    TetrahedronMesh, TriangleMesh, VolumeOptions, build_volume,
};
use std::io::Cursor;

/// Most vertices and triangles of a soup: enough for every kind of star, and a build takes a
/// fraction of a millisecond.
const MAX_VERTICES: usize = 16;
const MAX_TRIANGLES: usize = 24;

/// Builds all levels of random triangles, writes them, and opens, verifies and uses the file.
///
/// The script: bound and scale, vertices on a small lattice so that they often coincide, triangles
/// until it ends.
///
/// # Panics
///
/// If the build fails although triangles are left after repair, or its file does not verify.
pub(crate) fn build_soup(script: &[u8]) {
    let mut script = Script::new(script);
    let estimates = [EstimateKind::Joint, EstimateKind::Removed, EstimateKind::Accumulated];
    let [joint, removed, accumulated] = estimates.map(JadeOptions::estimate);
    let jade = [JadeOptions::default(), joint, removed, accumulated][script.below(4)];
    let options = BuildOptions {
        max_error: [None, Some(0.1), Some(5.0)][script.below(3)],
        feature_angle_degrees: [60.0, 0.0, 180.0][script.below(3)],
        ..BuildOptions::with(jade)
    };
    build_any(&soup(&mut script), &options);
}

/// As [`build_soup`], with the other decimators: by collapses and splits, and with vertices that
/// move; up to the largest coordinates. A stream of operations must end as the input.
///
/// # Panics
///
/// As [`build_soup`].
pub(crate) fn build_soup_otherwise(script: &[u8]) {
    let mut script = Script::new(script);
    let by_collapses =
        |bound, pre_split, reduction| BuildOptions::with(ProgressiveOptions { bound, pre_split, reduction });
    let mut options = match script.below(4) {
        0 => by_collapses(ProgressiveBound::Certified, false, None),
        1 => by_collapses(ProgressiveBound::Accumulated, true, None),
        2 => by_collapses(ProgressiveBound::Certified, script.u8() % 2 == 1, Some(0.5)),
        _ => BuildOptions::with(JadeOptions::certified(Placement::Best)),
    };
    options.max_error = [None, Some(0.1), Some(5.0)][script.below(3)];
    build_any(&soup(&mut script), &options);
}

fn build_any(mesh: &TriangleMesh, options: &BuildOptions) {
    let build = match nephrite::build(mesh, options) {
        Ok(build) => build,
        Err(BuildError::NoTriangles { .. }) => return,
        Err(error) => panic!("{error}"),
    };
    let n_triangles = build.history().n_alive(0);
    let mut stream = Cursor::new(Vec::new());
    build.write_to(&mut stream, &StoreOptions::default()).unwrap();
    check_file(stream.get_ref(), n_triangles);
    if build.progressive().is_some() {
        let mut played = ProgressiveMesh::new();
        played.append(&build.operations().unwrap().bytes).unwrap();
        played.refine(usize::MAX);
        assert_eq!(played.triangles().len(), n_triangles);
    }
}

/// Fuses random tetrahedra, writes them, and opens, verifies and uses the file.
///
/// The script: options, scale and vertices as in [`build_soup`], tetrahedra until it ends.
///
/// # Panics
///
/// If the build fails although tetrahedra are left after repair, or its file does not verify.
pub(crate) fn fuse_soup(script: &[u8]) {
    let mut script = Script::new(script);
    let options = VolumeOptions {
        max_error: [None, Some(0.1), Some(5.0)][script.below(3)],
        fusion: FusionOptions {
            tetrahedron_share: [0.1, 1.0, 0.0][script.below(3)],
            volume_loss: [0.001, 1.0, 0.0][script.below(3)],
            ..FusionOptions::default()
        },
        ..VolumeOptions::default()
    };
    let (positions, attributes) = vertices(&mut script);
    let n_vertices = small(positions.len());
    let mut tetrahedra = Vec::new();
    while !script.is_empty() && tetrahedra.len() < 2 * MAX_TRIANGLES {
        tetrahedra.push(std::array::from_fn(|_| u32::from(script.u8() % n_vertices)));
    }
    let mesh = TetrahedronMesh { positions, attributes, tetrahedra, ..TetrahedronMesh::default() };
    let build = match build_volume(&mesh, &options) {
        Ok(build) => build,
        Err(BuildError::NoTetrahedra { .. }) => return,
        Err(error) => panic!("{error}"),
    };
    let mut stream = Cursor::new(Vec::new());
    build.write_to(&mut stream, &StoreOptions::default()).unwrap();
    let lod = Lod::from_bytes(stream.get_ref()).unwrap();
    lod.verify().unwrap();
    let mut before = usize::MAX;
    for level in 0..lod.n_levels() {
        let mesh = lod.at_level(level).to_volume().unwrap();
        mesh.check().unwrap();
        assert!(mesh.tetrahedra.len() <= before);
        before = mesh.tetrahedra.len();
    }
}

/// Hands in triangles and tetrahedra of which one thing contradicts the rest: a build refuses them.
///
/// The script: what to spoil and with what, then a soup as of [`build_soup`].
///
/// # Panics
///
/// If a build accepts what contradicts itself.
pub(crate) fn refuse_contradictions(script: &[u8]) {
    let mut script = Script::new(script);
    let (what, value) = (script.below(6), script.below(3));
    let mut mesh = soup(&mut script);
    let n_vertices = small(mesh.positions.len());
    mesh.triangles.push([0, 1, 2]);
    let length = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][value];
    match what {
        0 => mesh.rounding = [-1.0, f64::NAN, f64::INFINITY][value],
        1 => mesh.origin[value] = length,
        2 => mesh.positions[0][value] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][value],
        3 => mesh.triangles[0][value] = u32::from(n_vertices) + u32::from(script.u8()),
        _ => {
            let bytes = vec![0; (usize::from(n_vertices) + 4 - what).min(value)];
            let n_components = u32::from(what == 4);
            mesh.attributes.push(Attribute { name: "a".into(), scalar: ScalarType::U8, n_components, bytes });
        }
    }
    let refused = nephrite::build(&mesh, &BuildOptions::default());
    assert!(matches!(refused, Err(BuildError::Mesh(_))), "{mesh:?}");
    let TriangleMesh { origin, positions, triangles, attributes, rounding } = mesh;
    let tetrahedra = triangles.into_iter().map(|[a, b, c]| [a, b, c, 0]).collect();
    let volume = TetrahedronMesh { origin, positions, tetrahedra, attributes, rounding };
    let refused = build_volume(&volume, &VolumeOptions::default()).map(drop);
    assert!(matches!(refused, Err(BuildError::Mesh(_))), "{volume:?}");
}

fn soup(script: &mut Script<'_>) -> TriangleMesh {
    let (positions, attributes) = vertices(script);
    let n_vertices = small(positions.len());
    let mut triangles = Vec::new();
    while !script.is_empty() && triangles.len() < MAX_TRIANGLES {
        triangles.push(std::array::from_fn(|_| u32::from(script.u8() % n_vertices)));
    }
    TriangleMesh { positions, triangles, attributes, ..TriangleMesh::default() }
}

fn vertices(script: &mut Script<'_>) -> (Vec<[f32; 3]>, Vec<Attribute>) {
    let scale = [1.0, 1e-30, 1e-40, 1e30, 1e-3, 1e37][script.below(6)];
    let has_attribute = script.u8().is_multiple_of(4);
    let n_vertices = 3 + script.below(MAX_VERTICES - 2);
    let positions = (0..n_vertices)
        .map(|_| std::array::from_fn(|_| (f32::from(script.u8()) - 128.0) * 0.25 * scale))
        .collect();
    let color = Attribute {
        name: "color".into(),
        scalar: ScalarType::U8,
        n_components: 1,
        bytes: (0..n_vertices).map(|v| u8::from(v % 3 == 0)).collect(),
    };
    (positions, if has_attribute { vec![color] } else { Vec::new() })
}

/// Writes a random history. It must be refused with an error, or give a file that verifies.
///
/// The script: steps, deaths and births of vertices, then lifetimes until it ends.
///
/// # Panics
///
/// If a file is written that does not verify.
pub(crate) fn write_history(script: &[u8]) {
    let mut script = Script::new(script);
    let options = StoreOptions {
        levels: [None, Some(1), Some(3), Some(0)][script.below(4)],
        window_levels: [None, Some(1), Some(2), Some(5)][script.below(4)],
        is_compact: script.u8() % 2 == 1,
        operations: false,
    };
    let n_steps = script.below(12);
    let stamp = |script: &mut Script<'_>| match script.u8() {
        255 => NEVER,
        // Mostly steps that exist.
        stamp => u32::from(stamp) % (u32::from(small(n_steps)) + 2),
    };
    let n_vertices = 1 + script.below(10);
    let mut history = History::<3>::default();
    let mut error = 0.0;
    for _ in 0..=n_steps {
        error += f64::from(script.u8()) - f64::from(u8::from(script.u8() == 77));
        history.errors.push(error);
    }
    history.vertex_death = (0..n_vertices).map(|_| stamp(&mut script)).collect();
    if script.u8() % 2 == 1 {
        history.vertex_birth = (0..n_vertices).map(|_| stamp(&mut script)).collect();
    }
    while !script.is_empty() && history.simplices.len() < 60 {
        history
            .simplices
            .push(std::array::from_fn(|_| u32::from(script.u8()) % u32::from(small(n_vertices))));
        history.birth.push(stamp(&mut script));
        history.death.push(stamp(&mut script));
    }
    let mesh = TriangleMesh {
        positions: (0..n_vertices).map(|v| [f32::from(small(v)), 1.0, 0.5]).collect(),
        ..TriangleMesh::default()
    };
    let mut stream = Cursor::new(Vec::new());
    match history.write_to(&mut stream, &mesh, &options) {
        Ok(report) => {
            let lod = check_file(stream.get_ref(), report_len(&history));
            assert_eq!(lod.n_levels(), report.n_levels);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Simplices alive at step 0.
fn report_len(history: &History<3>) -> usize {
    history.birth.iter().filter(|&&birth| birth == 0).count()
}

/// Checks a file that must verify, with `n_triangles` triangles at level 0 and no level larger than
/// the one before.
fn check_file(bytes: &[u8], n_triangles: usize) -> Lod {
    let lod = Lod::from_bytes(bytes).unwrap();
    lod.verify().unwrap();
    assert_eq!(lod.at_level(0).n_simplices(), n_triangles);
    let mut before = usize::MAX;
    for level in 0..lod.n_levels() {
        let mesh = lod.at_level(level).to_mesh().unwrap();
        assert!(mesh.triangles.len() <= before);
        before = mesh.triangles.len();
    }
    lod
}

/// Counts of a soup fit a byte.
fn small(count: usize) -> u8 {
    u8::try_from(count).unwrap()
}
