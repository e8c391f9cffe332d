//! Random triangles made into a file, and random histories.

use crate::script::Script;
use nephrite::decimate::fusion::FusionOptions;
use nephrite::decimate::jade::{JadeOptions, Placement};
use nephrite::decimate::progressive::ProgressiveOptions;
use nephrite::history::{History, NEVER};
use nephrite::progressive_mesh::{ProgressiveMesh, encode};
use nephrite::store::Vertices;
use nephrite::store::{Provenance, StoreOptions, WriteError, write_to};
use nephrite::{
    Attribute, Bound, BuildError, BuildOptions, Lod, Method, ScalarType, TetrahedronMesh, TriangleMesh,
    VolumeOptions, build_volume,
};
use std::io::Cursor;
use std::ops::ControlFlow::Continue;

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
    let options = BuildOptions {
        bound: [Bound::Certified, Bound::Joint, Bound::Removed, Bound::Accumulated][script.below(4)],
        max_error: [None, Some(0.1), Some(5.0)][script.below(3)],
        feature_angle_degrees: [60.0, 0.0, 180.0][script.below(3)],
        ..BuildOptions::default()
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
    let by_collapses = |bound, pre_split, reduction| BuildOptions {
        method: Method::Progressive,
        bound,
        progressive: ProgressiveOptions { pre_split, reduction },
        ..BuildOptions::default()
    };
    let mut options = match script.below(4) {
        0 => by_collapses(Bound::Certified, false, None),
        1 => by_collapses(Bound::Accumulated, true, None),
        2 => by_collapses(Bound::Certified, script.u8() % 2 == 1, Some(0.5)),
        _ => BuildOptions { jade: JadeOptions::of_placement(Placement::Best), ..BuildOptions::default() },
    };
    options.max_error = [None, Some(0.1), Some(5.0)][script.below(3)];
    build_any(&soup(&mut script), &options);
}

fn build_any(mesh: &TriangleMesh, options: &BuildOptions) {
    let build = match nephrite::build(mesh, options, &|_| Continue(())) {
        Ok(build) => build,
        Err(BuildError::NoTriangles { .. }) => return,
        Err(error) => panic!("{error}"),
    };
    let bytes = written(&build.mesh, &build.history).unwrap();
    check_file(&bytes, build.mesh.triangles.len());
    if build.passage.is_some() {
        let mut played = ProgressiveMesh::new();
        played.append(&encode(&build).unwrap().bytes).unwrap();
        played.refine(usize::MAX);
        assert_eq!(played.triangles().len(), build.mesh.triangles.len());
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
    let build = match build_volume(&mesh, &options, &|_| Continue(())) {
        Ok(build) => build,
        Err(BuildError::NoTetrahedra { .. }) => return,
        Err(error) => panic!("{error}"),
    };
    let bytes = written(&build.mesh, &build.history).unwrap();
    let lod = Lod::from_bytes(&bytes).unwrap();
    lod.verify().unwrap();
    let mut before = usize::MAX;
    for level in 0..lod.n_levels() {
        let mesh = lod.at_level(level).to_volume().unwrap();
        mesh.check().unwrap();
        assert!(mesh.tetrahedra.len() <= before);
        before = mesh.tetrahedra.len();
    }
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
    match write_to(&mut stream, &mesh, &history, &Provenance::default(), &options) {
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

fn written<'a, const CORNERS: usize>(
    mesh: impl Into<Vertices<'a>>,
    history: &History<CORNERS>,
) -> Result<Vec<u8>, WriteError> {
    let mut stream = Cursor::new(Vec::new());
    write_to(&mut stream, mesh, history, &Provenance::default(), &StoreOptions::default())?;
    Ok(stream.into_inner())
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
