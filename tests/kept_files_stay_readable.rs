//! Promise: a file that one version has written is read by every later version, and means the same.
//!
//! `kept_files/` has a file of every form, as it was written when that form was new, and
//! `answers.txt` says what is in it. Neither is written again: if this test fails, files that
//! people have are lost. `KEEP=1 cargo test --test kept_files_stay_readable` adds a file for each
//! form that has none yet.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use nephrite::{
    Attribute, BuildOptions, JadeOptions, Lod, Placement, ProgressiveMesh, ProgressiveOptions, ScalarType,
    StoreOptions, TriangleMesh, VolumeOptions, build, build_volume, generate,
};
use nephrite_formats::neph::checksum;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// A form of file, and a file of that form.
type Form = (&'static str, Vec<u8>);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/kept_files")
}

/// A rugged patch with attributes of two types, far from the origin.
fn patch() -> TriangleMesh {
    let mut mesh = generate::terrain(6, 3);
    mesh.origin = [1e6, 0.0, -0.5];
    let n_vertices = mesh.positions.len();
    let colors = (0..=u8::MAX).cycle().take(3 * n_vertices).collect();
    let heights = mesh.positions.iter().flat_map(|p| f64::from(p[2]).to_le_bytes()).collect();
    mesh.attributes = vec![
        Attribute { name: "color".into(), scalar: ScalarType::U8, n_components: 3, bytes: colors },
        Attribute { name: "height".into(), scalar: ScalarType::F64, n_components: 1, bytes: heights },
    ];
    mesh
}

fn surface_forms() -> Vec<Form> {
    let usual = StoreOptions::default();
    let jade = build(patch(), &BuildOptions::default()).unwrap();
    let forms = [
        ("whole-lifetimes", usual),
        ("windows", StoreOptions { window_levels: Some(2), ..usual }),
        ("compact", StoreOptions { is_compact: true, ..usual }),
        ("compact-windows", StoreOptions { window_levels: Some(2), is_compact: true, ..usual }),
        ("one-level", StoreOptions { levels: Some(1), ..usual }),
    ];
    let mut files: Vec<Form> = forms
        .iter()
        .map(|(name, options)| {
            let mut stream = Cursor::new(Vec::new());
            jade.write_to(&mut stream, options).unwrap();
            (*name, stream.into_inner())
        })
        .collect();
    let moving = BuildOptions::with(JadeOptions::certified(Placement::Best));
    let moved = build(generate::sphere(2), &moving).unwrap();
    let mut stream = Cursor::new(Vec::new());
    moved.write_to(&mut stream, &usual).unwrap();
    files.push(("vertices-born", stream.into_inner()));
    let collapses = BuildOptions::with(ProgressiveOptions::default());
    let collapsed = build(patch(), &collapses).unwrap();
    let mut stream = Cursor::new(Vec::new());
    collapsed.write_to(&mut stream, &StoreOptions { operations: true, ..usual }).unwrap();
    files.push(("operations", stream.into_inner()));
    files
}

fn volume_forms() -> Vec<Form> {
    let fused = build_volume(&generate::box_volume([3; 3]), &VolumeOptions::default()).unwrap();
    [("volume", false), ("volume-compact", true)]
        .map(|(name, is_compact)| {
            let options = StoreOptions { is_compact, ..StoreOptions::default() };
            let mut stream = Cursor::new(Vec::new());
            fused.write_to(&mut stream, &options).unwrap();
            (name, stream.into_inner())
        })
        .into()
}

/// The corners of the simplices of a level, with positions and attributes, independent of the order
/// of simplices and vertices.
fn contents<const CORNERS: usize>(
    simplices: &[[u32; CORNERS]],
    positions: &[[f32; 3]],
    attributes: &[Attribute],
) -> u64 {
    let corner = |v: u32| -> Vec<u8> {
        let v = v as usize;
        let position = positions[v].iter().flat_map(|x| x.to_le_bytes());
        let values = attributes.iter().flat_map(|a| {
            let stride = a.bytes.len() / positions.len();
            a.name.bytes().chain(a.bytes[v * stride..][..stride].iter().copied())
        });
        position.chain(values).collect()
    };
    let mut all: Vec<Vec<u8>> = simplices
        .iter()
        .map(|simplex| {
            let corners = simplex.map(corner);
            // Even permutations keep the orientation: of the last three corners of a tetrahedron,
            // or of all three of a triangle.
            let (fixed, turning) = corners.split_at(CORNERS - 3);
            let least = (0..3).min_by_key(|&i| &turning[i]).unwrap();
            fixed.iter().chain((0..3).map(|i| &turning[(least + i) % 3])).flatten().copied().collect()
        })
        .collect();
    all.sort_unstable();
    checksum(&all.concat())
}

/// The contents of a file, in one line.
fn answers(bytes: &[u8]) -> String {
    let lod = Lod::from_bytes(bytes).unwrap();
    lod.verify().unwrap();
    let counts: Vec<usize> = lod.curve().map(|point| point.simplices as usize).collect();
    let mut all = Vec::new();
    for level in 0..lod.n_levels() {
        let cut = lod.at_level(level);
        assert_eq!(cut.n_simplices(), counts[level as usize]);
        let contents = if lod.n_corners() == 4 {
            let mesh = cut.to_volume().unwrap();
            contents(&mesh.tetrahedra, &mesh.positions, &mesh.attributes)
        } else {
            let mesh = cut.to_mesh().unwrap();
            contents(&mesh.triangles, &mesh.positions, &mesh.attributes)
        };
        all.extend([contents, cut.error().to_bits(), cut.n_vertices() as u64]);
    }
    all.extend(lod.origin().map(f64::to_bits));
    for (name, values) in lod.deviations() {
        all.push(checksum(name.as_bytes()));
        all.extend(values.iter().map(|value| value.to_bits()));
    }
    let all: Vec<u8> = all.into_iter().flat_map(u64::to_le_bytes).collect();
    let (first, last) = (counts[0], counts[counts.len() - 1]);
    let mut line = format!("{} levels of {first} to {last} simplices, {:016x}", counts.len(), checksum(&all));
    let operations = lod.operations();
    if !operations.is_empty() {
        let mut played = ProgressiveMesh::from_bytes(operations).unwrap();
        let n_operations = played.refine(usize::MAX);
        let contents = contents(played.triangles(), played.positions(), &[]);
        write!(line, ", {n_operations} operations to {contents:016x}").unwrap();
    }
    line
}

/// Answers by file name.
fn stated() -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(folder().join("answers.txt")).unwrap_or_default();
    let split = |line: &str| line.split_once(": ").map(|(name, line)| (name.to_owned(), line.to_owned()));
    text.lines().filter_map(split).collect()
}

#[test]
fn every_form_has_a_file_that_means_what_it_meant() {
    let mut stated = stated();
    let keep = std::env::var_os("KEEP").is_some();
    for (name, bytes) in surface_forms().into_iter().chain(volume_forms()) {
        let answers = answers(&bytes);
        if keep && !stated.contains_key(name) {
            std::fs::write(folder().join(name).with_extension("neph"), &bytes).unwrap();
            stated.insert(name.to_owned(), answers);
        }
        assert!(stated.contains_key(name), "no {name} is kept");
    }
    if keep {
        let lines: String = stated.iter().map(|(name, line)| format!("{name}: {line}\n")).collect();
        std::fs::write(folder().join("answers.txt"), lines).unwrap();
    }
    for (name, line) in &stated {
        let bytes = std::fs::read(folder().join(name).with_extension("neph")).unwrap();
        assert_eq!(&answers(&bytes), line, "{name}");
    }
    let n_files = std::fs::read_dir(folder()).unwrap().count() - 1;
    assert_eq!(n_files, stated.len(), "a file without an answer");
}
