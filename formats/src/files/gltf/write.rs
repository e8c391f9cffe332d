//! GLB: one mesh of one primitive, its origin the translation of the only node.

use std::io::Write;

use serde_json::{Map, Value, json};

use super::names::semantic;
use crate::files::coordinates::nearest_f32;
use crate::files::distinct::DistinctNames;
use crate::{Attribute, Change, FileReport, Kind, MeshError, MeshFormat, ScalarType, TriangleMesh};

/// Writes a mesh with all its attributes.
///
/// Names with a meaning in glTF get it where type and shape allow; others become an application's
/// `_NAME`. glTF has no 32-bit integers and no `f64` for vertices: these become `f32`. Attributes
/// of more than four components are split.
///
/// # Errors
///
/// [`MeshError::TooLargeForFormat`] beyond 4 GiB, or [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let parts = if mesh.triangles.is_empty() { Vec::new() } else { parts(mesh, report) };
    let n_binary_bytes: u64 = parts.iter().map(|part| part.bytes.len() as u64).sum();
    let mut json = document(mesh, &parts, n_binary_bytes).to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let n_bytes = 12 + 8 + json.len() as u64 + if parts.is_empty() { 0 } else { 8 + n_binary_bytes };
    let limit = u64::from(u32::MAX);
    let too_large =
        |count| MeshError::TooLargeForFormat { format: MeshFormat::Glb, what: "bytes", count, limit };
    let word = |count: u64| Ok(u32::try_from(count).map_err(|_| too_large(n_bytes))?.to_le_bytes());
    let mut put =
        |bytes: Result<[u8; 4], MeshError>| -> Result<(), MeshError> { Ok(out.write_all(&bytes?)?) };
    put(Ok(*b"glTF"))?;
    put(word(2))?;
    put(word(n_bytes))?;
    put(word(json.len() as u64))?;
    put(Ok(*b"JSON"))?;
    out.write_all(&json)?;
    if !parts.is_empty() {
        out.write_all(&word(n_binary_bytes)?)?;
        out.write_all(b"BIN\0")?;
        for part in &parts {
            out.write_all(&part.bytes)?;
        }
    }
    Ok(())
}

/// A buffer view with its only accessor.
struct Part {
    /// Attribute semantic; `None` for the indices.
    semantic: Option<String>,
    accessor: Value,
    stride_bytes: Option<usize>,
    /// Padded to a multiple of four.
    bytes: Vec<u8>,
}

fn parts(mesh: &TriangleMesh, report: &mut FileReport) -> Vec<Part> {
    let mut parts = vec![position_part(mesh)];
    let mut names = DistinctNames::without(&["POSITION"]);
    for attribute in &mesh.attributes {
        let id = report.named(Kind::Attribute, &attribute.name);
        report.keep(id);
        if matches!(attribute.scalar, ScalarType::I32 | ScalarType::U32 | ScalarType::F64) {
            report.change(id, Change::Narrowed { scalar: "f32" });
        }
        for mut part in attribute_parts(attribute) {
            part.semantic = part.semantic.map(|semantic| {
                // Only an application's own semantics, which begin so, can have any name.
                let is_second = !semantic.starts_with('_') && names.is_taken(&semantic);
                names.take(if is_second { format!("_{semantic}") } else { semantic })
            });
            parts.push(part);
        }
    }
    parts.push(index_part(mesh));
    parts
}

fn position_part(mesh: &TriangleMesh) -> Part {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for position in &mesh.positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    // As f64 the limits are exact, which a validator compares.
    let [low, high] = [low, high].map(|limit| limit.map(f64::from));
    let accessor = json!({"componentType": 5126, "type": "VEC3", "count": mesh.positions.len(), "min": low, "max": high});
    let bytes = mesh.positions.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    Part { semantic: Some("POSITION".into()), accessor, stride_bytes: None, bytes }
}

/// Indices of 16 bits where they suffice; the largest value of a type is reserved.
fn index_part(mesh: &TriangleMesh) -> Part {
    let indices = mesh.triangles.iter().flatten();
    let narrow: Option<Vec<u16>> = if mesh.positions.len() <= usize::from(u16::MAX) {
        indices.clone().map(|&index| u16::try_from(index).ok()).collect()
    } else {
        None
    };
    let (code, mut bytes): (u32, Vec<u8>) = match narrow {
        Some(narrow) => (5123, narrow.iter().flat_map(|index| index.to_le_bytes()).collect()),
        None => (5125, indices.flat_map(|index| index.to_le_bytes()).collect()),
    };
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let accessor = json!({"componentType": code, "type": "SCALAR", "count": 3 * mesh.triangles.len()});
    Part { semantic: None, accessor, stride_bytes: None, bytes }
}

/// One part, or one for each component where there are more than a vector can have.
fn attribute_parts(attribute: &Attribute) -> Vec<Part> {
    let n_components = attribute.n_components as usize;
    if let Some((full, is_normalized)) = known_semantic(attribute) {
        let converted = if is_narrow(attribute.scalar) { attribute.clone() } else { to_f32(attribute) };
        return vec![attribute_part(full, &converted, is_normalized)];
    }
    let converted = if is_narrow(attribute.scalar) { attribute.clone() } else { to_f32(attribute) };
    if n_components <= 4 {
        return vec![attribute_part(format!("_{}", attribute.name), &converted, false)];
    }
    let size_bytes = converted.scalar.size_bytes();
    let component = |i: usize| {
        let values = converted.bytes.chunks_exact(size_bytes).skip(i).step_by(n_components);
        let bytes = values.flatten().copied().collect();
        let name = format!("{}_{i}", attribute.name);
        let single = Attribute { name: name.clone(), scalar: converted.scalar, n_components: 1, bytes };
        attribute_part(format!("_{name}"), &single, false)
    };
    (0..n_components).map(component).collect()
}

/// The semantic of glTF that an attribute can have, with whether its integers are normalized.
fn known_semantic(attribute: &Attribute) -> Option<(String, bool)> {
    let (kind, full) = semantic(&attribute.name)?;
    let is_float = matches!(attribute.scalar, ScalarType::F32 | ScalarType::F64);
    let is_unsigned = matches!(attribute.scalar, ScalarType::U8 | ScalarType::U16);
    let fits = match (kind, attribute.n_components) {
        ("NORMAL", 3) | ("TANGENT" | "WEIGHTS", 4) | ("TEXCOORD", 2) => is_float,
        ("COLOR", 3 | 4) => is_float || is_unsigned,
        ("JOINTS", 4) => is_unsigned,
        _ => false,
    };
    fits.then_some((full, kind == "COLOR" && is_unsigned))
}

/// Whether glTF has the type for vertices.
fn is_narrow(scalar: ScalarType) -> bool {
    !matches!(scalar, ScalarType::I32 | ScalarType::U32 | ScalarType::F64)
}

fn to_f32(attribute: &Attribute) -> Attribute {
    Attribute::from_f32(attribute.name.clone(), attribute.n_components, attribute.values().map(nearest_f32))
}

/// A part for an attribute of one to four components; every element starts at a multiple of four
/// bytes.
fn attribute_part(semantic: String, attribute: &Attribute, is_normalized: bool) -> Part {
    let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"][attribute.n_components as usize - 1];
    let code = match attribute.scalar {
        ScalarType::I8 => 5120,
        ScalarType::U8 => 5121,
        ScalarType::I16 => 5122,
        ScalarType::U16 => 5123,
        _ => 5126,
    };
    let element_bytes = attribute.stride_bytes();
    let stride_bytes = element_bytes.next_multiple_of(4);
    let count = attribute.bytes.len() / element_bytes;
    let mut accessor = json!({"componentType": code, "type": shape, "count": count});
    if is_normalized {
        accessor["normalized"] = true.into();
    }
    let mut bytes = Vec::with_capacity(count * stride_bytes);
    for element in attribute.bytes.chunks_exact(element_bytes) {
        bytes.extend_from_slice(element);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    let stride_bytes = (stride_bytes != element_bytes).then_some(stride_bytes);
    Part { semantic: Some(semantic), accessor, stride_bytes, bytes }
}

fn document(mesh: &TriangleMesh, parts: &[Part], n_binary_bytes: u64) -> Value {
    let asset = json!({"version": "2.0", "generator": "nephrite"});
    if parts.is_empty() {
        return json!({"asset": asset, "scene": 0, "scenes": [{}]});
    }
    const ARRAY_BUFFER: u32 = 34962;
    const ELEMENT_ARRAY_BUFFER: u32 = 34963;
    let mut attributes = Map::new();
    let (mut accessors, mut views) = (Vec::new(), Vec::new());
    let mut offset = 0;
    for (i, part) in parts.iter().enumerate() {
        let mut accessor = part.accessor.clone();
        accessor["bufferView"] = i.into();
        accessors.push(accessor);
        let target = if part.semantic.is_some() { ARRAY_BUFFER } else { ELEMENT_ARRAY_BUFFER };
        let mut view =
            json!({"buffer": 0, "byteOffset": offset, "byteLength": part.bytes.len(), "target": target});
        if let Some(stride_bytes) = part.stride_bytes {
            view["byteStride"] = stride_bytes.into();
        }
        views.push(view);
        offset += part.bytes.len();
        if let Some(semantic) = &part.semantic {
            attributes.insert(semantic.clone(), i.into());
        }
    }
    let mut node = json!({"mesh": 0});
    if mesh.origin != [0.0; 3] {
        node["translation"] = json!(mesh.origin);
    }
    json!({
        "asset": asset,
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": parts.len() - 1}]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": n_binary_bytes}],
    })
}
