//! One primitive: its triangles and its attributes under a map.

use super::accessor::{Elements, Source};
use super::affine::{Affine, unit};
use super::document::{POINTS, Primitive, TRIANGLE_FAN, TRIANGLE_STRIP, TRIANGLES, TextureTransform};
use super::names::attribute_name;
use super::texcoords::{SetTransforms, set_number};
use crate::files::coordinates::nearest_f32;
use crate::files::error::{MeshError, Place};
use crate::{Attribute, Change, FileReport, Kind, ScalarType};

/// The positions of a primitive before its map is applied.
///
/// # Errors
///
/// [`MeshError::Missing`] without positions, [`MeshError::Unexpected`] for positions of other than
/// three components, [`MeshError::Unsupported`] where they are compressed.
pub(crate) fn positions(
    source: &Source<'_>,
    primitive: &Primitive,
    place: Place,
) -> Result<Vec<[f64; 3]>, MeshError> {
    let missing = MeshError::Missing { place, what: "attribute POSITION" };
    let accessor = *primitive.attributes.get("POSITION").ok_or(missing)?;
    let is_placeholder =
        source.document.accessors.get(accessor).is_some_and(|accessor| accessor.buffer_view.is_none());
    let compression = "KHR_draco_mesh_compression";
    if is_placeholder && primitive.extensions.contains_key(compression) {
        return Err(MeshError::Unsupported { place, feature: compression.into() });
    }
    let elements = source.elements(accessor)?;
    if elements.n_components != 3 {
        let found = format!("{} components", elements.n_components);
        return Err(MeshError::Unexpected {
            place: Place::item("accessor", accessor),
            expected: "positions",
            found,
        });
    }
    let mut values = elements.values();
    let points = std::iter::from_fn(|| Some([values.next()?, values.next()?, values.next()?]));
    Ok(points.collect())
}

/// Every attribute but the positions: normals and tangents turned with the map, texture coordinates
/// where the material's textures read them. Attributes that cannot be kept are noted.
///
/// # Errors
///
/// Those of [`Source::elements`].
pub(crate) fn attributes(
    source: &Source<'_>,
    primitive: &Primitive,
    (map, transforms): (&Affine, &SetTransforms),
    n_vertices: usize,
    report: &mut FileReport,
) -> Result<Vec<Attribute>, MeshError> {
    let mut attributes: Vec<Attribute> = Vec::new();
    // Upper-case letters sort before the underscore, so glTF's own semantics come first and win
    // over an application's.
    for (semantic, &accessor) in &primitive.attributes {
        if semantic == "POSITION" {
            continue;
        }
        let Some(name) = attribute_name(semantic) else {
            let id = report.named(Kind::Attribute, semantic);
            report.leave_out(id, "glTF does not define it");
            continue;
        };
        let elements = source.elements(accessor)?;
        if elements.count as usize != n_vertices {
            let id = report.named(Kind::Attribute, semantic);
            report.leave_out(id, "it has another length than the positions");
        } else if attributes.iter().any(|attribute| attribute.name == name) {
            let id = report.named(Kind::Attribute, semantic);
            report.leave_out(id, "another attribute has the same name");
        } else {
            let id = report.named(Kind::Attribute, &name);
            report.keep(id);
            let read = match set_number(semantic).filter(|_| elements.n_components == 2) {
                Some(set) => texcoords(name, &elements, transforms.get(set)),
                None => attribute(name, &elements, map),
            };
            if set_number(semantic).is_some_and(|set| transforms.disputed.contains(&set)) {
                let clause = "under the transform of the base colour's texture; other textures have others";
                report.change(id, Change::Otherwise(clause.into()));
            }
            attributes.push(read);
        }
    }
    Ok(attributes)
}

/// A set of texture coordinates as the textures see it, in `f32` whatever the file's type.
fn texcoords(name: String, elements: &Elements<'_>, transform: Option<&TextureTransform>) -> Attribute {
    if transform.is_none() && elements.scalar == ScalarType::F32 {
        let bytes = elements.bytes.to_vec();
        return Attribute { name, scalar: ScalarType::F32, n_components: 2, bytes };
    }
    let values: Vec<f64> = elements.values().collect();
    let moved = values.as_chunks().0.iter().flat_map(|&pair| match transform {
        Some(transform) => transform.apply(pair),
        None => pair,
    });
    Attribute::from_f32(name, 2, moved.map(nearest_f32))
}

fn attribute(name: String, elements: &Elements<'_>, map: &Affine) -> Attribute {
    let Elements { scalar, n_components, is_normalized, .. } = *elements;
    let is_turned = (name == "normal" && n_components == 3) || (name == "tangent" && n_components == 4);
    if is_turned && map.linear != Affine::IDENTITY.linear {
        let map = if name == "normal" { map.of_normals() } else { *map };
        return Attribute::from_f32(name, n_components, turned(elements, &map));
    }
    let is_color = name == "color" || name.starts_with("color_");
    if is_normalized && scalar != ScalarType::F32 && !is_color {
        return Attribute::from_f32(name, n_components, elements.values().map(nearest_f32));
    }
    Attribute { name, scalar, n_components, bytes: elements.bytes.to_vec() }
}

/// Vectors under a map at unit length; a fourth component stays.
fn turned(elements: &Elements<'_>, map: &Affine) -> Vec<f32> {
    let n_components = elements.n_components as usize;
    let mut values: Vec<f32> = elements.values().map(nearest_f32).collect();
    for vector in values.chunks_exact_mut(n_components) {
        let turned = unit(map.turn([vector[0].into(), vector[1].into(), vector[2].into()]));
        for (value, turned) in vector.iter_mut().zip(turned) {
            *value = nearest_f32(turned);
        }
    }
    values
}

/// Triangles of a primitive over its own vertices, turned over where the map mirrors. Primitives of
/// points and lines are counted as ignored, corners beyond the last whole triangle as dropped.
///
/// # Errors
///
/// [`MeshError::IndexOutOfRange`] and those of [`Source::elements`].
pub(crate) fn triangles(
    source: &Source<'_>,
    primitive: &Primitive,
    n_vertices: u32,
    mirrors: bool,
    report: &mut FileReport,
) -> Result<Vec<[u32; 3]>, MeshError> {
    let corners: Vec<u32> = match primitive.indices {
        None => (0..n_vertices).collect(),
        Some(accessor) => {
            let place = Place::item("accessor", accessor);
            let elements = source.elements(accessor)?;
            let found = format!("{:?} with {} components", elements.scalar, elements.n_components);
            let indices = elements.indices();
            let indices =
                indices.ok_or(MeshError::Unexpected { place, expected: "unsigned scalar indices", found })?;
            if let Some(&index) = indices.iter().find(|&&index| index >= n_vertices) {
                let (what, count) = ("vertex", n_vertices.into());
                return Err(MeshError::IndexOutOfRange { place, what, index: index.into(), count });
            }
            indices
        }
    };
    let is_whole = |[a, b, c]: &[u32; 3]| a != b && b != c && a != c;
    let mut triangles: Vec<[u32; 3]> = match primitive.mode {
        TRIANGLES => {
            let (triangles, rest) = corners.as_chunks();
            report.n_faces_dropped += usize::from(!rest.is_empty());
            triangles.to_vec()
        }
        TRIANGLE_STRIP => {
            let turned = |i: usize| if i.is_multiple_of(2) { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
            let places = (0..corners.len().saturating_sub(2)).map(turned);
            places.map(|triangle| triangle.map(|place| corners[place])).filter(is_whole).collect()
        }
        TRIANGLE_FAN => match corners.split_first() {
            Some((&apex, rest)) => {
                rest.windows(2).map(|edge| [apex, edge[0], edge[1]]).filter(is_whole).collect()
            }
            None => Vec::new(),
        },
        _ => {
            let kind = if primitive.mode == POINTS { Kind::Point } else { Kind::Line };
            report.count(kind, corners.len() as u64);
            Vec::new()
        }
    };
    if mirrors {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    Ok(triangles)
}
