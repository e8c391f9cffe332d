//! Promise: where a field of a volume jumps, each side keeps its values at every level, and the
//! place of the jump stays. Vertices at one position with the same values are one.
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small meshes")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::generate::box_volume;
use nephrite::measure::{MeasureOptions, measure, measure_fields};
use nephrite::{
    Attribute, Lod, ScalarType, TetrahedronMesh, VolumeBuild, VolumeOptions, boundary, build_volume,
};
use std::cell::Cell;
use std::collections::HashMap;
use support::served::served;

fn built(mesh: &TetrahedronMesh) -> (VolumeBuild, Lod) {
    let build = build_volume(mesh, &VolumeOptions::default()).unwrap();
    let lod = served(|stream, options| build.write_to(stream, options));
    (build, lod)
}

/// A mesh whose tetrahedra share vertices only within one part, and the part of each vertex.
fn in_parts(mesh: &TetrahedronMesh, part: impl Fn([f32; 3]) -> u32) -> (TetrahedronMesh, Vec<u32>) {
    let mut numbers = HashMap::new();
    let (mut sources, mut parts) = (Vec::new(), Vec::new());
    let mut tetrahedra = mesh.tetrahedra.clone();
    for tetrahedron in &mut tetrahedra {
        let corners = tetrahedron.map(|v| mesh.positions[v as usize]);
        let part = part(std::array::from_fn(|axis| corners.iter().map(|p| p[axis]).sum::<f32>() / 4.0));
        for v in tetrahedron {
            *v = *numbers.entry((*v, part)).or_insert_with(|| {
                sources.push(*v as usize);
                parts.push(part);
                parts.len() as u32 - 1
            });
        }
    }
    let attributes = mesh.attributes.iter().map(|attribute| {
        let stride = attribute.stride_bytes();
        let bytes = sources.iter().flat_map(|&v| attribute.bytes[v * stride..][..stride].to_vec());
        Attribute { bytes: bytes.collect(), ..attribute.clone() }
    });
    let positions = sources.iter().map(|&v| mesh.positions[v]).collect();
    let attributes = attributes.collect();
    (TetrahedronMesh { positions, attributes, tetrahedra, ..mesh.clone() }, parts)
}

fn field(name: &str, values: impl IntoIterator<Item = f64>) -> Attribute {
    Attribute::from_values(name, ScalarType::F64, 1, values)
}

/// A box in two halves, with `slip` -1 in one and 1 in the other, and a field that does not jump.
fn faulted(cells: u32) -> TetrahedronMesh {
    let (mut mesh, parts) = in_parts(&box_volume([cells; 3]), |[x, _, _]| u32::from(x > 0.5));
    mesh.attributes.push(field("slip", parts.iter().map(|&part| 2.0 * f64::from(part) - 1.0)));
    mesh
}

/// Places and values of the corners of every tetrahedron.
fn corners(mesh: &TetrahedronMesh) -> Vec<Vec<(Vec<u32>, Vec<u64>)>> {
    let values: Vec<Vec<f64>> = mesh.attributes.iter().map(|field| field.values().collect()).collect();
    let corner = |&v: &u32| {
        let v = v as usize;
        let place = mesh.positions[v].iter().map(|x| x.to_bits()).collect();
        (place, values.iter().map(|values| values[v].to_bits()).collect())
    };
    let tetrahedron = |t: &[u32; 4]| {
        let mut corners: Vec<_> = t.iter().map(corner).collect();
        corners.sort();
        corners
    };
    let mut all: Vec<_> = mesh.tetrahedra.iter().map(tetrahedron).collect();
    all.sort();
    all
}

#[test]
fn both_sides_of_a_fault_keep_their_values_and_their_place() {
    let input = faulted(8);
    let (build, lod) = built(&input);
    assert_eq!((build.repairs().vertices_welded, build.repairs().vertices_at_jumps), (0, 81));
    assert_eq!(corners(&lod.at_level(0).to_volume().unwrap()), corners(&input));
    for level in 0..lod.n_levels() {
        let mesh = lod.at_level(level).to_volume().unwrap();
        let slip: Vec<f64> = mesh.attribute("slip").unwrap().values().collect();
        let mut volumes = [0.0; 2];
        for &tetrahedron in &mesh.tetrahedra {
            let side = slip[tetrahedron[0] as usize];
            assert!((side.abs() - 1.0).abs() < 1e-9);
            assert!(tetrahedron.iter().all(|&v| (slip[v as usize] - side).abs() < 1e-9));
            assert!(
                tetrahedron.iter().all(|&v| f64::from(mesh.positions[v as usize][0] - 0.5) * side >= 0.0)
            );
            volumes[usize::from(side > 0.0)] += mesh.six_volumes(tetrahedron) / 6.0;
        }
        assert!(volumes.iter().all(|volume| (volume - 0.5).abs() < 1e-6), "{volumes:?} at level {level}");
        // The fault is no boundary.
        let surface = boundary(&mesh).unwrap();
        assert!(surface.positions.iter().all(|p| p.iter().any(|x| [0.0, 1.0].contains(x))));
        for field in measure_fields(&input, &mesh).unwrap() {
            assert!(field.max < 1e-6 && field.n_outside == 0, "{field:?} at level {level}");
        }
    }
    let last = lod.deviations().find(|(name, _)| *name == "slip").unwrap().1.last().copied();
    assert!(last.unwrap() < 1e-9, "{last:?}");
    let n_coarsest = lod.at_level(lod.n_levels() - 1).n_simplices();
    assert!(n_coarsest * 3 < input.tetrahedra.len(), "{n_coarsest} of {}", input.tetrahedra.len());
}

#[test]
fn vertices_of_their_own_in_every_tetrahedron() {
    let mesh = box_volume([4; 3]);
    let n_parts = Cell::new(0);
    let (mut apart, parts) = in_parts(&mesh, |_| n_parts.replace(n_parts.get() + 1));
    assert_eq!(apart.positions.len(), 4 * mesh.tetrahedra.len());
    // Without a jump it is the mesh that it would be otherwise.
    let (build, lod) = built(&apart);
    assert_eq!(build.repairs().vertices_at_jumps, 0);
    assert_eq!(lod.at_level(0).n_vertices(), mesh.positions.len());
    let plain = built(&mesh).1;
    let n_coarsest = [&lod, &plain].map(|lod| lod.at_level(lod.n_levels() - 1).n_simplices());
    assert!(n_coarsest[0] < 2 * n_coarsest[1], "{n_coarsest:?}");
    let distance = measure_fields(&apart, &lod.at_level(0).to_volume().unwrap()).unwrap();
    assert!(distance[0].max < 1e-9 && distance[0].n_outside == 0, "{distance:?}");
    // A value for each tetrahedron: nothing can be fused, and nothing is lost.
    apart.attributes = vec![field("own", parts.iter().map(|&part| f64::from(part % 1000)))];
    let (build, lod) = built(&apart);
    assert_eq!(corners(&lod.at_level(0).to_volume().unwrap()), corners(&apart));
    assert_eq!((build.fusions().n_fusions, build.repairs().vertices_welded), (0, 0));
}

#[test]
fn pieces_of_one_grid_are_measured_as_one() {
    let input = faulted(6);
    let (_, lod) = built(&input);
    let level = lod.at_level(0).to_volume().unwrap();
    let surfaces = [&input, &level].map(|mesh| boundary(mesh).unwrap());
    assert_eq!(surfaces[0].triangles.len(), 6 * 6 * 6 * 2);
    let options = MeasureOptions { n_samples: 1000, ..MeasureOptions::default() };
    let distance = measure(&surfaces[0], &surfaces[1], &options).unwrap();
    assert!(distance.max < 1e-12, "{}", distance.max);
    // A side that is lost shows: its vertices find the other one only.
    let mut one_sided = level;
    one_sided.attributes[1] = field("slip", one_sided.positions.iter().map(|_| 1.0));
    let slip = &measure_fields(&input, &one_sided).unwrap()[1];
    assert_eq!((slip.max_forward, slip.max_backward), (2.0, 2.0));
}

#[test]
fn numbers_that_are_equal_do_not_jump() {
    let (mut mesh, parts) = in_parts(&box_volume([4; 3]), |[x, _, _]| u32::from(x > 0.5));
    let zeros = parts.iter().map(|&part| if part == 0 { 0.0 } else { -0.0 });
    let nans = parts.iter().map(|&part| f64::from_bits(f64::NAN.to_bits() + u64::from(part)));
    mesh.attributes = vec![field("zero", zeros), field("nan", nans)];
    let (build, _) = built(&mesh);
    assert_eq!((build.repairs().vertices_welded, build.repairs().vertices_at_jumps), (25, 0));
}

/// What the folder of cases has of these.
#[test]
fn cases_of_split_vertices() {
    let folder = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases/volumes");
    if !folder.is_dir() {
        eprintln!("skipped: no {}", folder.display());
        return;
    }
    for name in ["fault_split_nodes.vtu", "own_vertices_tet_dg.vtu", "two_pieces.vtu"] {
        let (input, _) = nephrite_formats::read_volume(folder.join(name)).unwrap();
        let (_, lod) = built(&input);
        let level = lod.at_level(0).to_volume().unwrap();
        assert_eq!(corners(&level), corners(&input), "{name}");
        let surfaces = [&input, &level].map(|mesh| boundary(mesh).unwrap());
        let options = MeasureOptions { n_samples: 1000, ..MeasureOptions::default() };
        assert!(measure(&surfaces[0], &surfaces[1], &options).unwrap().max < 1e-12, "{name}");
        let fields = measure_fields(&input, &level).unwrap();
        assert!(fields.iter().all(|field| field.max < 1e-12 && field.n_outside == 0), "{name}: {fields:?}");
    }
}
