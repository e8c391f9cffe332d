//! Writing a legacy file: binary, version 3.0, which every reader knows.

use std::io::Write;

use super::cell_type::TETRAHEDRON;
use crate::{Attribute, FileReport, Kind, MeshError, ScalarType, TetrahedronMesh};

/// Writes a mesh in file coordinates: `f32` where the origin is zero, `f64` otherwise.
///
/// # Errors
///
/// [`MeshError::Io`].
pub(in crate::files::volume) fn write(
    mesh: &TetrahedronMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let (n_points, n_cells) = (mesh.positions.len(), mesh.tetrahedra.len());
    let is_shifted = mesh.origin != [0.0; 3];
    let name = if is_shifted { "double" } else { "float" };
    write!(out, "# vtk DataFile Version 3.0\nnephrite\nBINARY\nDATASET UNSTRUCTURED_GRID\n")?;
    writeln!(out, "POINTS {n_points} {name}")?;
    for position in &mesh.positions {
        for (origin, &coordinate) in mesh.origin.iter().zip(position) {
            if is_shifted {
                out.write_all(&(origin + f64::from(coordinate)).to_be_bytes())?;
            } else {
                out.write_all(&coordinate.to_be_bytes())?;
            }
        }
    }
    writeln!(out, "\nCELLS {n_cells} {}", 5 * n_cells)?;
    for tetrahedron in &mesh.tetrahedra {
        out.write_all(&4_u32.to_be_bytes())?;
        for vertex in tetrahedron {
            out.write_all(&vertex.to_be_bytes())?;
        }
    }
    writeln!(out, "\nCELL_TYPES {n_cells}")?;
    for _ in 0..n_cells {
        out.write_all(&u32::from(TETRAHEDRON).to_be_bytes())?;
    }
    writeln!(out)?;
    if !mesh.attributes.is_empty() {
        writeln!(out, "POINT_DATA {n_points}\nFIELD FieldData {}", mesh.attributes.len())?;
    }
    for attribute in &mesh.attributes {
        write_field(attribute, n_points, out)?;
        let id = report.named(Kind::Field, &attribute.name);
        report.keep(id);
    }
    Ok(())
}

fn write_field(attribute: &Attribute, n_points: usize, out: &mut dyn Write) -> Result<(), MeshError> {
    let type_name = match attribute.scalar {
        ScalarType::I8 => "char",
        ScalarType::U8 => "unsigned_char",
        ScalarType::I16 => "short",
        ScalarType::U16 => "unsigned_short",
        ScalarType::I32 => "int",
        ScalarType::U32 => "unsigned_int",
        ScalarType::F32 => "float",
        ScalarType::F64 => "double",
    };
    writeln!(out, "{} {} {n_points} {type_name}", encode(&attribute.name), attribute.n_components)?;
    let size_bytes = attribute.scalar.size_bytes();
    for value in attribute.bytes.chunks_exact(size_bytes) {
        let mut turned = [0; 8];
        turned[..size_bytes].copy_from_slice(value);
        turned[..size_bytes].reverse();
        out.write_all(&turned[..size_bytes])?;
    }
    Ok(writeln!(out)?)
}

/// The name as one word: blanks, quotes, percent signs and what is not ASCII as `%` and two digits.
fn encode(name: &str) -> String {
    let mut word = String::with_capacity(name.len());
    for byte in name.bytes() {
        if byte.is_ascii_graphic() && byte != b'%' && byte != b'"' {
            word.push(char::from(byte));
        } else {
            word.push_str(&format!("%{byte:02X}"));
        }
    }
    word
}
