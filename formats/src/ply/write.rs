//! Binary little-endian PLY.

use std::io::Write;

use super::names::property_names;
use crate::{FileReport, Kind, MeshError, ScalarType, TriangleMesh};

/// Writes a mesh; coordinates are `float` where the origin is zero and `double`, in file coordinates, where it is not.
///
/// # Errors
///
/// [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    for attribute in &mesh.attributes {
        let id = report.named(Kind::Attribute, &attribute.name);
        report.keep(id);
    }
    let is_shifted = mesh.origin != [0.0; 3];
    write_header(mesh, is_shifted, out)?;
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
        for attribute in &mesh.attributes {
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

fn write_header(mesh: &TriangleMesh, is_shifted: bool, out: &mut dyn Write) -> Result<(), MeshError> {
    let coordinate = if is_shifted { "double" } else { "float" };
    // Most programs expect signed indices and write them so.
    let index = if i32::try_from(mesh.positions.len()).is_ok() { "int" } else { "uint" };
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.positions.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property {coordinate} {axis}")?;
    }
    for (attribute, names) in mesh.attributes.iter().zip(property_names(&mesh.attributes)) {
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
