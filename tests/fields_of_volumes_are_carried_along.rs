//! Promise: whatever the fields of a volume hold, it builds, and the values of its levels come from
//! those of the input.
#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "small meshes")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::generate::box_volume;
use nephrite::{Attribute, Lod, ScalarType, TetrahedronMesh, VolumeBuild, VolumeOptions, build_volume};
use support::served::served;

fn built_with(mesh: &TetrahedronMesh, options: &VolumeOptions) -> (VolumeBuild, Lod) {
    let build = build_volume(mesh, options).unwrap();
    let lod = served(|stream, options| build.write_to(stream, options));
    (build, lod)
}

fn built(mesh: &TetrahedronMesh) -> (VolumeBuild, Lod) {
    built_with(mesh, &VolumeOptions::default())
}

/// A box with these fields.
fn boxed(attributes: Vec<Attribute>) -> TetrahedronMesh {
    TetrahedronMesh { attributes, ..box_volume([6; 3]) }
}

/// A field with a value for each vertex of [`boxed`], from its number and place.
fn field(
    name: &str,
    scalar: ScalarType,
    n_components: u32,
    value: impl Fn(usize, [f32; 3]) -> Vec<f64>,
) -> Attribute {
    let positions = box_volume([6; 3]).positions;
    let values = positions.iter().enumerate().flat_map(|(v, &p)| value(v, p));
    Attribute::from_values(name, scalar, n_components, values)
}

/// The bytes of every value of a field at every level.
fn values_at_all_levels(lod: &Lod, name: &str) -> Vec<Vec<f64>> {
    let values = |level| {
        let mesh = lod.at_level(level).to_volume().unwrap();
        mesh.attribute(name).unwrap().values().collect()
    };
    (0..lod.n_levels()).map(values).collect()
}

#[test]
fn fields_that_do_not_vary_stay_as_they_are() {
    use ScalarType::{F32, F64, I32, U8};
    let constants = [
        field("T", F32, 1, |_, _| vec![293.15]),
        field("T", F64, 1, |_, _| vec![0.1]),
        field("T", I32, 1, |_, _| vec![-7.0]),
        field("T", U8, 3, |_, _| vec![0.0; 3]),
        field("T", F64, 3, |_, _| vec![0.0; 3]),
        field("T", F64, 1, |_, _| vec![f64::NAN]),
        field("T", F64, 2, |_, _| vec![f64::INFINITY, 5.0]),
        field("T", F32, 1, |_, _| vec![f64::NEG_INFINITY]),
    ];
    for constant in constants {
        let bytes = constant.bytes[..constant.stride_bytes()].to_vec();
        let (build, lod) = built(&boxed(vec![constant]));
        assert!(build.fusions().n_fusions > 100 && lod.n_levels() > 10);
        for level in 0..lod.n_levels() {
            let mesh = lod.at_level(level).to_volume().unwrap();
            assert!(mesh.attributes[0].bytes.chunks(bytes.len()).all(|value| value == bytes));
        }
        assert!(build.history().deviations[1].values.iter().all(|&deviation| deviation == 0.0));
    }
    let (build, _) = built(&boxed(vec![]));
    assert!(build.fusions().n_fusions > 100);
}

#[test]
fn fields_without_weight_are_interpolated() {
    let mut options = VolumeOptions::default();
    options.fusion.field_weight = 0.0;
    let (build, lod) = built_with(&box_volume([6; 3]), &options);
    assert!(build.fusions().n_fusions > 100);
    for values in values_at_all_levels(&lod, "linear") {
        assert!(values.iter().all(|value| (-3.0..=6.0).contains(value)));
    }
}

#[test]
fn whole_numbers_are_those_of_the_input() {
    let label = |_, [x, _, _]: [f32; 3]| vec![if x < 0.4 { 3.0 } else { 7.0 }];
    let mesh = boxed(vec![
        field("label", ScalarType::U8, 1, label),
        field("pair", ScalarType::I32, 2, |v, _| vec![v as f64, -(v as f64)]),
        field("T", ScalarType::F64, 1, |_, [x, y, z]| vec![f64::from(x * y + z)]),
    ]);
    let (build, lod) = built(&mesh);
    assert!(lod.at_level(lod.n_levels() - 1).n_simplices() * 10 < mesh.tetrahedra.len());
    for values in values_at_all_levels(&lod, "label") {
        assert!(values.iter().all(|&label| label == 3.0 || label == 7.0));
    }
    for values in values_at_all_levels(&lod, "pair") {
        let is_of_input = |pair: &[f64]| pair[0] == -pair[1] && (0.0..343.0).contains(&pair[0]);
        assert!(values.chunks(2).all(is_of_input));
    }
    // Numbers of vertices cannot be right where vertices are gone; where they differ is all that
    // can be said.
    let deviation = |name: &str| {
        let named = build.history().deviations.iter().find(|deviation| deviation.name == name);
        [0, 1].map(|step| named.unwrap().values[step * build.fusions().n_fusions])
    };
    assert_eq!(deviation("pair"), [0.0, 1.0]);
    assert!([[0.0, 0.0], [0.0, 1.0]].contains(&deviation("label")));
}

#[test]
fn values_that_are_no_numbers_leave_the_others_alone() {
    let wave = |[x, y, z]: [f32; 3]| f64::from((5.0 * x).sin() + y * z);
    let masked = |_, p: [f32; 3]| vec![if p[2] > 0.8 { f64::NAN } else { wave(p) }];
    let mesh = boxed(vec![
        field("masked", ScalarType::F32, 1, masked),
        field("none", ScalarType::F64, 1, |_, _| vec![f64::NAN]),
        field("vector", ScalarType::F64, 2, |v, p| vec![wave(p), if v == 7 { f64::INFINITY } else { 0.0 }]),
        field("T", ScalarType::F32, 1, |_, p| vec![wave(p)]),
    ]);
    let (build, lod) = built(&mesh);
    assert_eq!((build.repairs().values_nan, build.repairs().values_infinite), (2 * 49 + 343, 1));
    let alone = boxed(vec![field("T", ScalarType::F32, 1, |_, p| vec![wave(p)])]);
    let [deviation, expected] = [&build, &built(&alone).0].map(|build| {
        let last = |name| {
            build.history().deviations.iter().find(|d| d.name == name).map(|d| d.values[d.values.len() - 1])
        };
        ["masked", "none", "vector", "T"].map(|name| last(name).unwrap_or(0.0))
    });
    // The range of the wave is 3 at most.
    assert!(deviation[0] > 0.0 && deviation[0] < 3.0, "{deviation:?}");
    assert_eq!(deviation[1], 0.0);
    assert!(deviation[2] > 0.0 && deviation[2] < 3.0 && deviation[3] < 2.0 * expected[3], "{deviation:?}");
    let n_not_numbers = |values: &Vec<f64>| values.iter().filter(|value| value.is_nan()).count();
    for (level, values) in values_at_all_levels(&lod, "masked").iter().enumerate() {
        let (n_nan, mesh) = (n_not_numbers(values), lod.at_level(level as u32).to_volume().unwrap());
        assert!(n_nan > 0 && n_nan < values.len(), "{n_nan} of {} at level {level}", values.len());
        for (value, p) in values.iter().zip(&mesh.positions) {
            assert!(value.is_nan() || p[2] < 0.9, "{value} at {p:?}, level {level}");
        }
    }
}

/// What the folder of cases has of these.
#[test]
fn cases_of_fields() {
    let folder = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cases/volumes");
    if !folder.is_dir() {
        eprintln!("skipped: no {}", folder.display());
        return;
    }
    let read = |name: &str| nephrite_formats::read_volume(folder.join(name)).unwrap().0;
    for name in [
        "panic_const.vtu",
        "panic_const.msh",
        "panic_zero_vec.vtu",
        "panic_const_int.vtu",
        "panic_allnan.vtu",
    ] {
        let mesh = read(name);
        let field = &mesh.attributes[0];
        let bytes = &field.bytes[..field.stride_bytes()];
        let (_, lod) = built(&mesh);
        let level = lod.at_level(lod.n_levels() - 1).to_volume().unwrap();
        assert!(level.tetrahedra.len() < mesh.tetrahedra.len(), "{name}");
        assert!(level.attributes[0].bytes.chunks(bytes.len()).all(|value| value == bytes), "{name}");
        assert!(
            lod.deviations()
                .all(|(name, values)| name == "planar quadric" || values.iter().all(|&x| x == 0.0))
        );
    }
    let mesh = read("twomat.vtu");
    let (_, lod) = built(&mesh);
    for n_most in [2000, 200, 50] {
        let level = (0..lod.n_levels()).find(|&level| lod.at_level(level).n_simplices() <= n_most);
        let level = lod.at_level(level.unwrap_or(lod.n_levels() - 1)).to_volume().unwrap();
        assert!(level.attribute("mat").unwrap().values().all(|mat| mat == 3.0 || mat == 7.0));
        let ids: Vec<f64> = mesh.attribute("gid").unwrap().values().collect();
        assert!(level.attribute("gid").unwrap().values().all(|id| ids.contains(&id)));
    }
    let mesh = read("fields_nan.vtu");
    let (build, lod) = built(&mesh);
    assert!(build.repairs().values_nan > 0);
    let masked: Vec<f64> = mesh.attribute("masked_nan").unwrap().values().filter(|x| x.is_finite()).collect();
    let range =
        masked.iter().fold(f64::MIN, |a, &b| a.max(b)) - masked.iter().fold(f64::MAX, |a, &b| a.min(b));
    for (name, values) in lod.deviations() {
        let most = match name {
            "masked_nan" => 2.0 * range,
            "allnan" | "const" => 0.0,
            _ => continue,
        };
        assert!(values.iter().all(|&deviation| deviation <= most), "{name}: {values:?}");
    }
}
