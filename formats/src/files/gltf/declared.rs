//! What a document declares beside geometry, registered by name.

use super::document::{Document, Keys};
use crate::files::error::{MeshError, Place, shown_name};
use crate::{FileReport, Kind};

/// Extensions that the reader carries out.
const CARRIED_OUT: [&str; 5] = [
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_mesh_gpu_instancing",
];

/// Beginnings of extensions that change how a surface looks and not where it is: a file that
/// requires one is read, and the extension is noted.
const OF_LOOKS: [&str; 9] = [
    "KHR_materials_",
    "ADOBE_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_",
];

/// Refuses a document that requires an extension which is not carried out.
///
/// # Errors
///
/// [`MeshError::Unsupported`] with the extension's name.
pub(crate) fn check_required(document: &Document) -> Result<(), MeshError> {
    let is_read = |name: &&String| {
        CARRIED_OUT.contains(&name.as_str()) || OF_LOOKS.iter().any(|beginning| name.starts_with(beginning))
    };
    match document.extensions_required.iter().find(|name| !is_read(name)) {
        Some(name) => {
            let feature = format!("the required extension {}", shown_name(name));
            Err(MeshError::Unsupported { place: Place::File, feature })
        }
        None => Ok(()),
    }
}

/// Registers everything that the lists of the document declare, except what nodes and primitives
/// refer to, which is registered when they are read.
pub(crate) fn register(document: &Document, keys: &Keys, report: &mut FileReport) {
    for name in document.extensions_used.iter().chain(&document.extensions_required) {
        let id = report.named(Kind::Extension, name);
        if CARRIED_OUT.contains(&name.as_str()) {
            report.keep(id);
        }
    }
    for (i, material) in document.materials.iter().enumerate() {
        report.named(Kind::Material, &name_or_number(material.name.as_ref(), i));
    }
    for (i, image) in document.images.iter().enumerate() {
        let uri = image.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
        report.named(Kind::Image, &name_or_number(image.name.as_ref().or(uri), i));
    }
    report.count(Kind::Texture, document.textures.len() as u64);
    let lists = [
        (Kind::Animation, &document.animations),
        (Kind::Skin, &document.skins),
        (Kind::Camera, &document.cameras),
    ];
    for (kind, list) in lists {
        for (i, named) in list.iter().enumerate() {
            report.named(kind, &name_or_number(named.name.as_ref(), i));
        }
    }
    let default = document.scene.unwrap_or(0);
    for (i, scene) in document.scenes.iter().enumerate().filter(|&(i, _)| i != default) {
        let id = report.named(Kind::Scene, &name_or_number(scene.name.as_ref(), i));
        report.leave_out(id, "it is not the default scene");
    }
    let n_extras = document.nodes.iter().filter(|node| node.extras.is_some()).count()
        + document.meshes.iter().filter(|mesh| mesh.extras.is_some()).count();
    report.count(Kind::Extras, n_extras as u64);
    for key in keys.0.keys().filter(|key| !KNOWN_KEYS.contains(&key.as_str())) {
        report.named(Kind::Property, key);
    }
}

/// Keys of a document that are read, or that only serve what is registered by another.
const KNOWN_KEYS: [&str; 17] = [
    "asset",
    "scene",
    "scenes",
    "nodes",
    "meshes",
    "accessors",
    "bufferViews",
    "buffers",
    "materials",
    "images",
    "textures",
    "samplers",
    "animations",
    "skins",
    "cameras",
    "extensionsUsed",
    "extensionsRequired",
];

/// The name of an object of a list, or its number where it has none.
pub(crate) fn name_or_number(name: Option<&String>, i: usize) -> String {
    name.filter(|name| !name.is_empty()).cloned().unwrap_or_else(|| format!("#{i}"))
}
