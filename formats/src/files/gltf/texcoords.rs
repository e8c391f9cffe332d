//! Where a material's textures read a set of texture coordinates (`KHR_texture_transform`).

use super::document::{Material, TextureTransform, TextureUse};

/// The transform of each set of texture coordinates, those that have one, in the order of the sets.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SetTransforms {
    of_sets: Vec<(usize, TextureTransform)>,
    /// Sets that another texture of the material reads under another transform.
    pub disputed: Vec<usize>,
}

impl SetTransforms {
    /// Those of a material. Where its textures disagree about a set, the base colour's counts, or
    /// else the first of the others.
    pub(crate) fn of(material: &Material) -> Self {
        let uses = [
            &material.pbr_metallic_roughness.base_color_texture,
            &material.pbr_metallic_roughness.metallic_roughness_texture,
            &material.normal_texture,
            &material.occlusion_texture,
            &material.emissive_texture,
        ];
        let mut seen: Vec<(usize, Option<TextureTransform>)> = Vec::new();
        let mut disputed = Vec::new();
        for texture in uses.into_iter().flatten() {
            let (set, transform) = set_of(texture);
            match seen.iter().find(|&&(other, _)| other == set) {
                None => seen.push((set, transform)),
                Some(&(_, first)) if first != transform && !disputed.contains(&set) => disputed.push(set),
                Some(_) => {}
            }
        }
        let mut of_sets: Vec<_> =
            seen.into_iter().filter_map(|(set, transform)| Some((set, transform?))).collect();
        of_sets.sort_by_key(|&(set, _)| set);
        Self { of_sets, disputed }
    }

    /// The transform of a set.
    pub(crate) fn get(&self, set: usize) -> Option<&TextureTransform> {
        self.of_sets.iter().find(|&&(other, _)| other == set).map(|(_, transform)| transform)
    }

    /// Whether no set has a transform.
    pub(crate) fn is_empty(&self) -> bool {
        self.of_sets.is_empty()
    }
}

/// The set that a texture reads, with its transform.
fn set_of(texture: &TextureUse) -> (usize, Option<TextureTransform>) {
    let transform = texture.extensions.transform;
    let set = transform.and_then(|transform| transform.set).unwrap_or(texture.set);
    (set, transform.map(|transform| TextureTransform { set: None, ..transform }))
}

impl TextureTransform {
    /// Where the texture is read for a pair of texture coordinates: scaled, turned, then moved.
    pub(crate) fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        [u * cos + v * sin + self.offset[0], v * cos - u * sin + self.offset[1]]
    }
}

/// The number of a set of texture coordinates by its semantic.
pub(crate) fn set_number(semantic: &str) -> Option<usize> {
    semantic.strip_prefix("TEXCOORD_")?.parse().ok()
}
