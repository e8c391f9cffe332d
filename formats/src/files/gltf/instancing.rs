//! Copies of a node's mesh (`EXT_mesh_gpu_instancing`).

use super::accessor::Source;
use super::affine::Affine;
use super::document::{Instancing, Node};
use crate::files::error::{MeshError, Place};

/// The map of each copy within its node: scale, then rotation, then translation. One copy where it
/// lies if none of them is given.
///
/// # Errors
///
/// Those of [`Source::elements`], and [`MeshError::Unexpected`] for accessors of other shapes or of
/// different lengths.
pub(crate) fn maps(
    source: &Source<'_>,
    instancing: &Instancing,
    place: Place,
) -> Result<Vec<Affine>, MeshError> {
    let read =
        |name: &str| instancing.attributes.get(name).map(|&accessor| source.elements(accessor)).transpose();
    let [translations, rotations, scales] = [read("TRANSLATION")?, read("ROTATION")?, read("SCALE")?];
    let shapes = [(&translations, 3), (&rotations, 4), (&scales, 3)];
    let mut count = None;
    for (elements, n_components) in shapes {
        let Some(elements) = elements else { continue };
        if elements.n_components != n_components || *count.get_or_insert(elements.count) != elements.count {
            let found = format!("{} elements of {} components", elements.count, elements.n_components);
            let expected = "translations, rotations and scales of one number";
            return Err(MeshError::Unexpected { place, expected, found });
        }
    }
    let [translations, rotations, scales] = [translations, rotations, scales]
        .map(|elements| elements.map(|elements| elements.values().collect::<Vec<f64>>()));
    let mut maps = Vec::new();
    for i in 0..count.unwrap_or(1) as usize {
        let node = Node {
            translation: translations.as_ref().map(|values| std::array::from_fn(|k| values[3 * i + k])),
            rotation: rotations.as_ref().map(|values| std::array::from_fn(|k| values[4 * i + k])),
            scale: scales.as_ref().map(|values| std::array::from_fn(|k| values[3 * i + k])),
            ..Node::default()
        };
        maps.push(Affine::of_node(&node, place)?);
    }
    Ok(maps)
}
