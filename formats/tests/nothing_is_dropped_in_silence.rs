//! Promise: everything that a file declares beside vertices and faces is in the mesh or in the
//! notes, by its name; and what a writer cannot write is in its notes.
//!
//! What a file declares is found by the few lines of `declared`, which share nothing with the
//! readers.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a failed step is a failed test")]
#![allow(clippy::cast_possible_truncation, reason = "small numbers")]

mod samples;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use nephrite_formats::{
    Fate, FileReport, Kind, MeshFormat, TriangleMesh, read_mesh, read_mesh_bytes, write_mesh_to,
};
use samples::{WRITTEN, data_folder, decorated_square, gltf};
use serde_json::Value;

/// A thing of a file: what it is called in the notes, and as which attribute it may be kept.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Declared {
    name: String,
    attribute: Option<String>,
}

fn noted(name: impl Into<String>) -> Declared {
    Declared { name: name.into(), attribute: None }
}

fn attribute(name: &str, kept_as: &str) -> Declared {
    Declared { name: name.into(), attribute: Some(kept_as.into()) }
}

/// What is neither in the mesh nor among the things that the report says are left out.
fn losses(declared: &BTreeSet<Declared>, mesh: &TriangleMesh, report: &FileReport) -> Vec<Declared> {
    let is_noted = |name: &str| {
        report.items().iter().any(|item| {
            &*item.name == name && matches!(item.fate, Fate::LeftOut { .. })
                || name == "#color" && matches!(item.kind, Kind::FaceColor)
                || name == item.kind.plural() && item.count > 0
        })
    };
    let is_kept = |name: &Option<String>| name.as_ref().is_some_and(|name| mesh.attribute(name).is_some());
    let is_lost = |thing: &&Declared| {
        let is_extension = report.items().iter().any(|item| {
            item.kind == Kind::Extension && *item.name == thing.name && matches!(item.fate, Fate::Kept { .. })
        });
        !is_kept(&thing.attribute) && !is_noted(&thing.name) && !is_extension
    };
    declared.iter().filter(is_lost).cloned().collect()
}

fn declared(bytes: &[u8], format: MeshFormat) -> BTreeSet<Declared> {
    match format {
        MeshFormat::Ply => of_ply(bytes),
        MeshFormat::Obj => of_obj(&String::from_utf8_lossy(bytes)),
        MeshFormat::Off => of_off(bytes),
        MeshFormat::Stl => of_stl(bytes),
        MeshFormat::Gltf => of_gltf(&serde_json::from_slice(bytes).unwrap()),
        _ => {
            let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
            of_gltf(&serde_json::from_slice(&bytes[20..20 + length]).unwrap())
        }
    }
}

fn of_ply(bytes: &[u8]) -> BTreeSet<Declared> {
    let end = bytes.windows(10).position(|window| window == b"end_header").unwrap();
    let mut found = BTreeSet::new();
    let mut element = (String::new(), 0_u64);
    for line in String::from_utf8_lossy(&bytes[..end]).lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["comment", "TextureFile", name] => drop(found.insert(noted(name))),
            ["element", name, count] => {
                element = (name.to_owned(), count.parse().unwrap());
                if !name.starts_with("vert")
                    && !matches!(name, "face" | "faces" | "tristrips")
                    && element.1 > 0
                {
                    found.insert(noted(name));
                }
            }
            ["property", .., name] if element.0.starts_with("vert") => {
                let kept_as = match name {
                    "x" | "y" | "z" => continue,
                    "nx" | "ny" | "nz" => "normal",
                    "red" | "green" | "blue" | "alpha" | "diffuse_red" | "diffuse_green" | "diffuse_blue" => {
                        "color"
                    }
                    "s" | "t" | "u" | "v" | "texture_u" | "texture_v" => "texcoord",
                    other => other,
                };
                found.insert(attribute(name, kept_as));
            }
            ["property", .., name] if matches!(element.0.as_str(), "face" | "faces") && element.1 > 0 => {
                match name {
                    "vertex_indices" | "vertex_index" => {}
                    "red" | "green" | "blue" | "alpha" => drop(found.insert(noted("#color"))),
                    "texcoord" => drop(found.insert(attribute(name, "texcoord"))),
                    other => drop(found.insert(noted(other))),
                }
            }
            _ => {}
        }
    }
    found
}

fn of_obj(text: &str) -> BTreeSet<Declared> {
    let mut found = BTreeSet::new();
    let joined = text.replace("\\\r\n", " ").replace("\\\n", " ");
    for line in joined.lines() {
        let line = line.split('#').next().unwrap();
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or("f");
        let rest: Vec<&str> = words.collect();
        let name = rest.join(" ");
        match keyword {
            "f" | "fo" => {}
            "v" if rest.len() >= 6 => drop(found.insert(attribute("color", "color"))),
            "v" => {}
            "vt" => drop(found.insert(attribute("texcoord", "texcoord"))),
            "vn" => drop(found.insert(attribute("normal", "normal"))),
            "usemtl" | "g" | "o" | "mtllib" if name.is_empty() => {}
            "s" if matches!(name.as_str(), "" | "off" | "0") => {}
            "usemtl" | "g" | "o" | "mtllib" | "s" => drop(found.insert(noted(name))),
            "l" => drop(found.insert(noted("lines"))),
            "p" => drop(found.insert(noted("points"))),
            "curv" | "curv2" | "surf" => drop(found.insert(noted("curves and free-form surfaces"))),
            other => drop(found.insert(noted(other))),
        }
    }
    found
}

fn of_off(bytes: &[u8]) -> BTreeSet<Declared> {
    let mut found = BTreeSet::new();
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap().split_whitespace().collect::<Vec<_>>())
        .filter(|words| !words.is_empty());
    let mut head = lines.next().unwrap();
    let keyword = head[0];
    if keyword.ends_with("OFF") {
        if head.get(1) == Some(&"BINARY") {
            return found;
        }
        head.remove(0);
        for (letters, name) in [("ST", "texcoord"), ("C", "color"), ("N", "normal")] {
            if keyword.contains(letters) {
                found.insert(attribute(name, name));
            }
        }
    }
    while head.len() < 2 {
        head.extend(lines.next().unwrap());
    }
    let [n_vertices, n_faces] = [0, 1].map(|i| head[i].parse::<usize>().unwrap());
    for words in lines.by_ref().take(n_vertices) {
        if words.len() > 3 && keyword == "OFF" {
            found.insert(attribute("numbers behind the coordinates", "color"));
        }
    }
    for words in lines.take(n_faces) {
        if words.len() > words[0].parse::<usize>().unwrap() + 1 {
            found.insert(noted("#color"));
        }
    }
    found
}

fn of_stl(bytes: &[u8]) -> BTreeSet<Declared> {
    let count = bytes.get(80..84).map(|count| u32::from_le_bytes(count.try_into().unwrap()) as usize);
    if let Some(count) = count.filter(|count| bytes.len() == 84 + 50 * count) {
        let has_colors = (0..count).any(|i| bytes[84 + 50 * i + 48..][..2] != [0, 0]);
        return has_colors.then(|| noted("#color")).into_iter().collect();
    }
    let text = String::from_utf8_lossy(bytes);
    let names = text.lines().filter_map(|line| line.trim_start().strip_prefix("solid"));
    names
        .map(|name| name.split_whitespace().collect::<Vec<_>>().join(" "))
        .filter(|name| !name.is_empty())
        .map(noted)
        .collect()
}

fn of_gltf(json: &Value) -> BTreeSet<Declared> {
    let mut found = BTreeSet::new();
    let list = |key: &str| json[key].as_array().cloned().unwrap_or_default();
    for key in ["materials", "animations", "skins", "cameras"] {
        for (i, item) in list(key).iter().enumerate() {
            let name = item["name"].as_str().filter(|name| !name.is_empty());
            found.insert(noted(name.map_or(format!("#{i}"), str::to_owned)));
        }
    }
    for (i, image) in list("images").iter().enumerate() {
        let uri = image["uri"].as_str().filter(|uri| !uri.starts_with("data:"));
        found.insert(noted(image["name"].as_str().or(uri).map_or(format!("#{i}"), str::to_owned)));
    }
    if !list("textures").is_empty() {
        found.insert(noted("textures"));
    }
    for extension in list("extensionsUsed") {
        found.insert(noted(extension.as_str().unwrap()));
    }
    for node in list("nodes").iter().filter(|node| node["mesh"].is_u64()) {
        let mesh = &json["meshes"][node["mesh"].as_u64().unwrap() as usize];
        if let Some(name) = node["name"].as_str().or(mesh["name"].as_str()).filter(|name| !name.is_empty()) {
            found.insert(noted(name));
        }
        for primitive in mesh["primitives"].as_array().unwrap() {
            for semantic in
                primitive["attributes"].as_object().unwrap().keys().filter(|key| *key != "POSITION")
            {
                let name = semantic.trim_start_matches('_');
                let kept_as = match semantic.as_str() {
                    "TEXCOORD_0" => "texcoord".to_owned(),
                    "COLOR_0" => "color".to_owned(),
                    _ if semantic.starts_with('_') => name.to_owned(),
                    _ => name.to_ascii_lowercase(),
                };
                found.insert(attribute(semantic, &kept_as));
            }
            if primitive["targets"].is_array() {
                found.insert(noted("morph targets"));
            }
        }
    }
    found
}

/// Literal files that declare a bit of everything.
fn everything() -> Vec<(MeshFormat, Vec<u8>)> {
    let ply = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        property float quality\nproperty list uchar int tags\nelement face 1\nproperty list uchar int vertex_indices\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int flags\nproperty list uchar float texcoord\n\
        element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
        0 0 0 0 0 1 1 2 3 0.5 1 7\n1 0 0 0 0 1 1 2 3 0.5 0\n0 1 0 0 0 1 1 2 3 0.5 0\n\
        3 0 1 2 255 0 0 9 6 0 0 1 0 0 1\n0 1\n";
    let obj = "mtllib a.mtl b.mtl\no thing\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng left side\nusemtl steel\ns 1\n\
        f 1/1/1 2/1/1 3/1/1\nl 1 2\np 1\nvp 0 0\ncurv 0 1 1 2\nlod 3\n";
    let off = "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 255 0 0 255\n0 1 0 0 0 1 255 0 0 255\n3 0 1 2 0 255 0\n";
    let stl = "solid the inlet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
        endsolid the inlet\nsolid wall\nendsolid wall\n";
    let lists = r#""scene": 0, "scenes": [{"nodes": [0]}, {"name": "other"}], "nodes": [{"mesh": 0, "name": "ball", "camera": 0, "extras": {}}],
        "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "_HEAT": 0, "FOO": 0}, "material": 0,
        "targets": [{"POSITION": 0}]}]}, {"name": "hidden", "primitives": []}],
        "materials": [{"name": "steel", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}],
        "images": [{"uri": "wood.png"}], "animations": [{"name": "Walk", "channels": [], "samplers": []}],
        "skins": [{"joints": [0]}], "cameras": [{"name": "eye", "type": "perspective"}], "extensionsUsed": ["KHR_materials_unlit", "KHR_mesh_quantization"],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "somethingElse": 1"#;
    let buffer = samples::floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    vec![
        (MeshFormat::Ply, ply.into()),
        (MeshFormat::Obj, obj.into()),
        (MeshFormat::Off, off.into()),
        (MeshFormat::Stl, stl.into()),
        (MeshFormat::Gltf, gltf(lists, &buffer)),
    ]
}

#[test]
fn everything_that_a_file_declares_is_kept_or_noted() {
    let expected_losses = [5, 9, 1, 2, 11];
    for ((format, bytes), n_at_least) in everything().into_iter().zip(expected_losses) {
        let (mesh, report) = read_mesh_bytes(&bytes, format).unwrap();
        let things = declared(&bytes, format);
        assert_eq!(losses(&things, &mesh, &report), [], "{format}: {:#?}", report.notes());
        assert!(report.notes().len() >= n_at_least, "{format}: {:#?}", report.notes());
        // Without attributes and notes nothing would be accounted for.
        let empty = TriangleMesh { attributes: Vec::new(), ..mesh };
        let plain = read_mesh_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshFormat::Obj).unwrap().1;
        assert_eq!(losses(&things, &empty, &plain).len(), things.len(), "{format}");
        assert!(plain.notes().is_empty());
    }
}

#[test]
fn notes_of_gltf_tell_everything_once() {
    let (_, bytes) = everything().pop().unwrap();
    let (_, report) = read_mesh_bytes(&bytes, MeshFormat::Gltf).unwrap();
    let expected = [
        "extension \"KHR_materials_unlit\" is left out",
        "material \"steel\" (1 triangle) is left out",
        "image \"wood.png\" is left out",
        "1 texture is left out",
        "animation \"Walk\" is left out",
        "skin \"#0\" is left out",
        "camera \"eye\" is left out",
        "scene \"other\" is left out: it is not the default scene",
        "1 extra data is left out",
        "property \"somethingElse\" is left out",
        "mesh \"hidden\" is left out: no node of the scene shows it",
        "object \"ball\" (1 triangle) is left out",
        "1 morph target is left out",
        "attribute \"FOO\" is left out: glTF does not define it",
    ];
    assert_eq!(report.notes(), expected);
}

#[test]
fn writers_note_the_attributes_that_have_no_place() {
    let mut mesh = decorated_square(3);
    mesh.attributes[0].name = "wind".into();
    mesh.attributes.push(samples::counting("id", nephrite_formats::ScalarType::F64, 1, 9));
    for format in WRITTEN {
        let mut bytes = Vec::new();
        let report = write_mesh_to(&mut bytes, &mesh, format).unwrap();
        let (again, _) = read_mesh_bytes(&bytes, format).unwrap();
        for attribute in &mesh.attributes {
            let name = attribute.name.as_str();
            // PLY has a property for each component of what is not one of its groups.
            let is_there = again.attribute(name).or(again.attribute(&format!("{name}_0"))).is_some();
            let is_noted = report
                .notes()
                .iter()
                .any(|note| note.starts_with(&format!("attribute \"{name}\" is left out")));
            assert!(is_there != is_noted, "{format}: {name}: {:?}", report.notes());
        }
        let is_narrowed = report.notes().iter().any(|note| note == "attribute \"id\" is kept as f32");
        assert_eq!(is_narrowed, format == MeshFormat::Glb, "{format}");
    }
}

fn mesh_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            mesh_files(&path, found);
        } else if MeshFormat::from_path(&path).is_some() {
            found.push(path);
        }
    }
}

#[test]
fn no_real_file_loses_anything_in_silence() {
    let Some(folder) = data_folder() else { return };
    let mut files = Vec::new();
    mesh_files(&folder, &mut files);
    files.sort();
    let mut n_read = 0;
    let mut n_things = 0;
    for path in &files {
        let Ok((mesh, report)) = read_mesh(path) else { continue };
        let bytes = std::fs::read(path).unwrap();
        if bytes.starts_with(&[0xFF, 0xFE]) {
            continue;
        }
        let format = MeshFormat::detect(&bytes, MeshFormat::from_path(path)).unwrap();
        let things = declared(&bytes, format);
        assert_eq!(losses(&things, &mesh, &report), [], "{}: {:#?}", path.display(), report.notes());
        n_read += 1;
        n_things += things.len();
    }
    println!("{n_read} files read of {}, {n_things} things declared", files.len());
    assert!(n_read >= 90 && n_things >= 200, "{n_read} files, {n_things} things");
}
