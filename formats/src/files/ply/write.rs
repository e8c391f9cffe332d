//! Binary little-endian PLY.

use std::borrow::Cow;
use std::io::Write;

use super::names::property_names;
use crate::files::face_colors::unit_to_byte;
use crate::{Attribute, Change, FileReport, Kind, MeshError, ScalarType, TriangleMesh};

/// Writes a mesh; coordinates are `float` where the origin is zero and `double`, in file
/// coordinates, where it is not.
///
/// # Errors
///
/// [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let attributes: Vec<Cow<'_, Attribute>> =
        mesh.attributes.iter().map(|attribute| as_written(attribute, report)).collect();
    let is_shifted = mesh.origin != [0.0; 3];
    write_header(mesh, &attributes, is_shifted, out)?;
    let mut record = Vec::new();
    for (i, position) in mesh.positions.iter().enumerate() {
        record.clear();
        for (origin, coordinate) in mesh.origin.iter().zip(position) {
            if is_shifted {
                record.extend((origin + f64::from(*coordinate)).to_le_bytes());
            } else {
                record.extend(coordinate.to_le_bytes());
            }
        }
        for attribute in &attributes {
            let stride_bytes = attribute.stride_bytes();
            record.extend_from_slice(&attribute.bytes[i * stride_bytes..(i + 1) * stride_bytes]);
        }
        out.write_all(&record)?;
    }
    for triangle in &mesh.triangles {
        let mut record = [3_u8; 13];
        for (corner, index) in triangle.iter().enumerate() {
            record[1 + 4 * corner..5 + 4 * corner].copy_from_slice(&index.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(())
}

/// An attribute as PLY readers expect it: colours in bytes, V counted from the bottom.
fn as_written<'a>(attribute: &'a Attribute, report: &mut FileReport) -> Cow<'a, Attribute> {
    let id = report.named(Kind::Attribute, &attribute.name);
    report.keep(id);
    let is_float = matches!(attribute.scalar, ScalarType::F32 | ScalarType::F64);
    match (attribute.name.as_str(), attribute.n_components) {
        ("color", 3 | 4) if attribute.scalar != ScalarType::U8 => {
            report
                .change(id, Change::Narrowed { scalar: "8 bits a channel, which is what PLY readers know" });
            let bytes = attribute.unit_values().map(unit_to_byte).collect();
            Cow::Owned(Attribute { scalar: ScalarType::U8, bytes, ..attribute.clone() })
        }
        ("texcoord", 2) if is_float => Cow::Owned(attribute.with_v_turned()),
        _ => Cow::Borrowed(attribute),
    }
}

fn write_header(
    mesh: &TriangleMesh,
    attributes: &[Cow<'_, Attribute>],
    is_shifted: bool,
    out: &mut dyn Write,
) -> Result<(), MeshError> {
    let coordinate = if is_shifted { "double" } else { "float" };
    // Most programs expect signed indices and write them so.
    let index = if i32::try_from(mesh.positions.len()).is_ok() { "int" } else { "uint" };
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.positions.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property {coordinate} {axis}")?;
    }
    for (attribute, names) in attributes.iter().zip(property_names(&mesh.attributes)) {
        for name in names {
            writeln!(out, "property {} {name}", type_name(attribute.scalar))?;
        }
    }
    writeln!(out, "element face {}", mesh.triangles.len())?;
    writeln!(out, "property list uchar {index} vertex_indices\nend_header")?;
    Ok(())
}

fn type_name(scalar: ScalarType) -> &'static str {
    match scalar {
        ScalarType::I8 => "char",
        ScalarType::U8 => "uchar",
        ScalarType::I16 => "short",
        ScalarType::U16 => "ushort",
        ScalarType::I32 => "int",
        ScalarType::U32 => "uint",
        ScalarType::F32 => "float",
        ScalarType::F64 => "double",
    }
}
