//! Promise: a mesh that contradicts itself is refused with what is wrong and where, before anything
//! else is done with it.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::measure::{MeasureError, MeasureOptions, measure, measure_fields};
use nephrite::{
    Attribute, BuildError, BuildOptions, EstimateKind, History, HistoryError, JadeOptions, Levels, MeshFault,
    NEVER, ProgressiveOptions, ScalarType, TetrahedronMesh, TriangleMesh, VolumeOptions, boundary, build,
    build_volume, generate, repair_volume,
};
use watchdog::Watchdog;

#[path = "support/watchdog.rs"]
mod watchdog;

/// What is wrong, and how a mesh comes to be so.
type Fault = (MeshFault, fn(&mut TriangleMesh));

/// Every fault but NaN, which is not equal to itself, and wrong indices, which each kind of simplex
/// has of its own.
fn faults() -> Vec<Fault> {
    vec![
        (MeshFault::Rounding { found: -1.0 }, |mesh| mesh.rounding = -1.0),
        (MeshFault::Rounding { found: f64::INFINITY }, |mesh| mesh.rounding = f64::INFINITY),
        (MeshFault::Origin { found: f64::NEG_INFINITY }, |mesh| mesh.origin[1] = f64::NEG_INFINITY),
        (MeshFault::NotFinite { vertex: 3, found: f32::INFINITY }, |mesh| {
            mesh.positions[3][2] = f32::INFINITY;
        }),
        (MeshFault::AttributeBytes { at: 0, found: 11, expected: 12 }, |mesh| {
            mesh.attributes[0].bytes.pop();
        }),
        (MeshFault::AttributeBytes { at: 0, found: 13, expected: 12 }, |mesh| {
            mesh.attributes[0].bytes.push(0);
        }),
        (MeshFault::NoComponents { at: 0 }, |mesh| mesh.attributes[0].n_components = 0),
    ]
}

/// An icosahedron with one byte at each vertex.
fn mesh() -> TriangleMesh {
    let mut mesh = generate::sphere(1);
    let bytes = vec![7; mesh.positions.len()];
    mesh.attributes =
        vec![Attribute { name: "shade".into(), scalar: ScalarType::U8, n_components: 1, bytes }];
    mesh
}

/// The same vertices with one tetrahedron.
fn volume(mesh: &TriangleMesh) -> TetrahedronMesh {
    let TriangleMesh { origin, positions, triangles: _, attributes, rounding } = mesh.clone();
    TetrahedronMesh { origin, positions, tetrahedra: vec![[0, 1, 2, 3]], attributes, rounding }
}

fn ways() -> [BuildOptions; 3] {
    [
        BuildOptions::default(),
        BuildOptions::with(JadeOptions::estimate(EstimateKind::Joint)),
        BuildOptions::with(ProgressiveOptions::default()),
    ]
}

#[test]
fn of_surfaces() {
    for (fault, spoil) in faults() {
        let mut mesh = mesh();
        spoil(&mut mesh);
        let _watchdog = Watchdog::over(format_args!("{fault}"));
        for options in ways() {
            assert_eq!(build(&mesh, &options), Err(BuildError::Mesh(fault)));
        }
    }
    let mut mesh = mesh();
    mesh.triangles[5][1] = 12;
    let fault = MeshFault::Index { simplex: "triangle", at: 5, found: 12, n_vertices: 12 };
    let refused = build(&mesh, &BuildOptions::default()).unwrap_err();
    assert_eq!(refused, BuildError::Mesh(fault));
    let told = "the mesh contradicts itself: triangle 5 names vertex 12, the mesh has 12 vertices";
    assert_eq!(refused.to_string(), told);
}

#[test]
fn of_volumes() {
    for (fault, spoil) in faults() {
        let mut mesh = mesh();
        spoil(&mut mesh);
        let volume = volume(&mesh);
        assert_eq!(build_volume(&volume, &VolumeOptions::default()), Err(BuildError::Mesh(fault)));
        assert_eq!(boundary(&volume), Err(fault));
        assert_eq!(repair_volume(&volume).map(drop), Err(fault));
        let refused = measure_fields(&volume, &volume);
        assert!(matches!(refused, Err(MeasureError::Inconsistent { fault: found, .. }) if found == fault));
    }
    let mut volume = volume(&mesh());
    volume.tetrahedra[0][3] = u32::MAX;
    let fault = MeshFault::Index { simplex: "tetrahedron", at: 0, found: u32::MAX, n_vertices: 12 };
    assert_eq!(boundary(&volume), Err(fault));
}

#[test]
fn of_what_is_not_a_number() {
    let mut spoilt = [mesh(), mesh(), mesh()];
    spoilt[0].rounding = f64::NAN;
    spoilt[1].origin[0] = f64::NAN;
    spoilt[2].positions[11][0] = f32::NAN;
    for mesh in spoilt {
        assert!(matches!(build(&mesh, &BuildOptions::default()), Err(BuildError::Mesh(_))));
        let refused = build_volume(&volume(&mesh), &VolumeOptions::default());
        assert!(matches!(refused, Err(BuildError::Mesh(_))));
    }
}

#[test]
fn of_roundings_in_a_measurement() {
    for found in [-1.0, f64::INFINITY] {
        let bad = TriangleMesh { rounding: found, ..mesh() };
        let fault = MeshFault::Rounding { found };
        let refused = measure(&mesh(), &bad, &MeasureOptions::default()).unwrap_err();
        assert!(matches!(refused, MeasureError::Inconsistent { fault: told, .. } if told == fault));
    }
}

#[test]
fn of_histories_that_levels_are_chosen_of() {
    let history = History {
        simplices: vec![[0, 1, 2]],
        birth: vec![0],
        death: vec![NEVER],
        vertex_death: vec![NEVER; 3],
        errors: vec![0.0, 1.0],
        ..History::default()
    };
    assert!(Levels::choose(&history, None).is_ok());
    let spoilt = [
        History { errors: vec![], ..history.clone() },
        History { errors: vec![0.0, f64::NAN], ..history.clone() },
        History { death: vec![], ..history.clone() },
        History { birth: vec![9], ..history.clone() },
    ];
    for history in spoilt {
        let refused: HistoryError = Levels::choose(&history, None).unwrap_err();
        assert_eq!(history.check().map_err(|error| error.to_string()), Err(refused.to_string()));
        let written = history.write_to(
            &mut std::io::Cursor::new(Vec::new()),
            &mesh(),
            &nephrite::StoreOptions::default(),
        );
        assert!(written.is_err());
    }
}
