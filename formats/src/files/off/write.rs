//! OFF with normals, colours and texture coordinates where the mesh has them.

use std::io::Write;

use crate::files::coordinates::nearest_f32;
use crate::{Attribute, FileReport, Kind, MeshError, ScalarType, TriangleMesh};

/// Writes a mesh in file coordinates, with as many digits as tell every number apart.
///
/// Of the attributes, `normal`, `color` and `texcoord` have a place in OFF; others are left out.
/// Colours have four components there: opaque where the mesh has three; bytes stay bytes, other
/// integers become numbers from 0 to 1.
///
/// # Errors
///
/// [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let attribute = |name: &str, fits: &[u32]| {
        mesh.attribute(name).filter(|attribute| fits.contains(&attribute.n_components))
    };
    let texcoord = attribute("texcoord", &[2]);
    let color = attribute("color", &[3, 4]);
    let normal = attribute("normal", &[3]);
    for kept in [texcoord, color, normal].into_iter().flatten() {
        let id = report.named(Kind::Attribute, &kept.name);
        report.keep(id);
    }
    let flag = |is_set: bool, letters: &'static str| if is_set { letters } else { "" };
    let keyword =
        [flag(texcoord.is_some(), "ST"), flag(color.is_some(), "C"), flag(normal.is_some(), "N")].concat();
    writeln!(out, "{keyword}OFF\n{} {} 0", mesh.positions.len(), mesh.triangles.len())?;
    let mut normals = normal.into_iter().flat_map(Attribute::values);
    let mut colors = color.map(Colors::new);
    let mut texcoords = texcoord.into_iter().flat_map(Attribute::texcoord_texts);
    let is_shifted = mesh.origin != [0.0; 3];
    for position in &mesh.positions {
        for (axis, (origin, coordinate)) in mesh.origin.iter().zip(position).enumerate() {
            let blank = if axis > 0 { " " } else { "" };
            if is_shifted {
                write!(out, "{blank}{:?}", origin + f64::from(*coordinate))?;
            } else {
                write!(out, "{blank}{coordinate:?}")?;
            }
        }
        for value in normals.by_ref().take(3) {
            write!(out, " {:?}", nearest_f32(value))?;
        }
        if let Some(colors) = &mut colors {
            colors.write_next(out)?;
        }
        for text in texcoords.by_ref().take(2) {
            write!(out, " {text}")?;
        }
        out.write_all(b"\n")?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "3 {a} {b} {c}")?;
    }
    Ok(())
}

/// Colours, one after another, with the alpha that the format wants.
struct Colors<'a> {
    values: Box<dyn Iterator<Item = f64> + 'a>,
    is_bytes: bool,
    n_components: usize,
}

impl<'a> Colors<'a> {
    fn new(color: &'a Attribute) -> Self {
        let is_bytes = color.scalar == ScalarType::U8;
        let values: Box<dyn Iterator<Item = f64> + 'a> =
            if is_bytes { Box::new(color.values()) } else { Box::new(color.unit_values()) };
        Self { values, is_bytes, n_components: color.n_components as usize }
    }

    fn write_next(&mut self, out: &mut dyn Write) -> Result<(), MeshError> {
        for value in self.values.by_ref().take(self.n_components) {
            if self.is_bytes {
                write!(out, " {value}")?;
            } else {
                write!(out, " {:?}", nearest_f32(value))?;
            }
        }
        if self.n_components == 3 {
            out.write_all(if self.is_bytes { b" 255" } else { b" 1.0" })?;
        }
        Ok(())
    }
}
