//! Writing a VTU file: arrays appended raw, which needs no second copy of the data.

use std::io::Write;

use crate::files::volume::vtk::TETRAHEDRON;
use crate::{FileReport, Kind, MeshError, ScalarType, TetrahedronMesh};

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
    let (point_type, point_bytes) = if is_shifted { ("Float64", 24) } else { ("Float32", 12) };
    let mut offset = 0_u64;
    let mut array = |head: String, n_bytes: usize| {
        let text = format!("<DataArray {head} format=\"appended\" offset=\"{offset}\"/>\n");
        offset += 8 + n_bytes as u64;
        text
    };
    write!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{n_points}\" NumberOfCells=\"{n_cells}\">\n"
    )?;
    let points = array(
        format!("type=\"{point_type}\" Name=\"Points\" NumberOfComponents=\"3\""),
        point_bytes * n_points,
    );
    write!(out, "<Points>\n{points}</Points>\n<Cells>\n")?;
    out.write_all(array("type=\"Int64\" Name=\"connectivity\"".to_owned(), 32 * n_cells).as_bytes())?;
    out.write_all(array("type=\"Int64\" Name=\"offsets\"".to_owned(), 8 * n_cells).as_bytes())?;
    out.write_all(array("type=\"UInt8\" Name=\"types\"".to_owned(), n_cells).as_bytes())?;
    write!(out, "</Cells>\n<PointData>\n")?;
    for attribute in &mesh.attributes {
        let (name, n) = (escape(&attribute.name), attribute.n_components);
        let shape = if n == 1 { String::new() } else { format!(" NumberOfComponents=\"{n}\"") };
        let head = format!("type=\"{}\" Name=\"{name}\"{shape}", type_name(attribute.scalar));
        out.write_all(array(head, attribute.bytes.len()).as_bytes())?;
        let id = report.named(Kind::Field, &attribute.name);
        report.keep(id);
    }
    write!(out, "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_")?;
    write_data(mesh, is_shifted, out)?;
    Ok(writeln!(out, "\n</AppendedData>\n</VTKFile>")?)
}

fn write_data(mesh: &TetrahedronMesh, is_shifted: bool, out: &mut dyn Write) -> Result<(), MeshError> {
    let (n_points, n_cells) = (mesh.positions.len() as u64, mesh.tetrahedra.len() as u64);
    let length = |out: &mut dyn Write, n_bytes: u64| out.write_all(&n_bytes.to_le_bytes());
    length(out, n_points * if is_shifted { 24 } else { 12 })?;
    for position in &mesh.positions {
        for (origin, &coordinate) in mesh.origin.iter().zip(position) {
            if is_shifted {
                out.write_all(&(origin + f64::from(coordinate)).to_le_bytes())?;
            } else {
                out.write_all(&coordinate.to_le_bytes())?;
            }
        }
    }
    length(out, 32 * n_cells)?;
    for &vertex in mesh.tetrahedra.as_flattened() {
        out.write_all(&i64::from(vertex).to_le_bytes())?;
    }
    length(out, 8 * n_cells)?;
    for cell in 1..=n_cells {
        out.write_all(&(4 * cell).to_le_bytes())?;
    }
    length(out, n_cells)?;
    for _ in 0..n_cells {
        out.write_all(&[TETRAHEDRON])?;
    }
    for attribute in &mesh.attributes {
        length(out, attribute.bytes.len() as u64)?;
        out.write_all(&attribute.bytes)?;
    }
    Ok(())
}

fn type_name(scalar: ScalarType) -> &'static str {
    match scalar {
        ScalarType::I8 => "Int8",
        ScalarType::U8 => "UInt8",
        ScalarType::I16 => "Int16",
        ScalarType::U16 => "UInt16",
        ScalarType::I32 => "Int32",
        ScalarType::U32 => "UInt32",
        ScalarType::F32 => "Float32",
        ScalarType::F64 => "Float64",
    }
}

/// A name as the value of an XML attribute; characters that XML cannot hold are left out.
fn escape(name: &str) -> String {
    let mut escaped = String::with_capacity(name.len());
    for character in name.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' | '\r' => escaped.push_str(&format!("&#{};", u32::from(character))),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => {}
            other => escaped.push(other),
        }
    }
    escaped
}
