//! OBJ with colours, texture coordinates and normals where the mesh has them.

use std::io::Write;

use crate::{Attribute, FileReport, Kind, MeshError, TriangleMesh};

/// Writes a mesh in file coordinates, with as many digits as tell every number apart.
///
/// Of the attributes, `color`, `texcoord` and `normal` have a place in OBJ; others are left out.
/// Integer colours become numbers from 0 to 1.
///
/// # Errors
///
/// [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let attribute = |name: &str, fits: &dyn Fn(u32) -> bool| {
        mesh.attribute(name).filter(|attribute| fits(attribute.n_components))
    };
    let color = attribute("color", &|n_components| n_components == 3 || n_components == 4);
    let texcoord = attribute("texcoord", &|n_components| n_components == 2);
    let normal = attribute("normal", &|n_components| n_components == 3);
    for kept in [color, texcoord, normal].into_iter().flatten() {
        let id = report.named(Kind::Attribute, &kept.name);
        report.keep(id);
    }
    write_positions(mesh, color, out)?;
    if let Some(texcoord) = texcoord {
        let mut texts = texcoord.texcoord_texts();
        while let (Some(u), Some(v)) = (texts.next(), texts.next()) {
            writeln!(out, "vt {u} {v}")?;
        }
    }
    write_list("vn", normal, out)?;
    for triangle in &mesh.triangles {
        out.write_all(b"f")?;
        for index in triangle.map(|index| u64::from(index) + 1) {
            match (texcoord, normal) {
                (None, None) => write!(out, " {index}")?,
                (Some(_), None) => write!(out, " {index}/{index}")?,
                (None, Some(_)) => write!(out, " {index}//{index}")?,
                (Some(_), Some(_)) => write!(out, " {index}/{index}/{index}")?,
            }
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_positions(
    mesh: &TriangleMesh,
    color: Option<&Attribute>,
    out: &mut dyn Write,
) -> Result<(), MeshError> {
    let is_shifted = mesh.origin != [0.0; 3];
    let n_components = color.map_or(0, |color| color.n_components as usize);
    let mut colors = color.into_iter().flat_map(Attribute::unit_values);
    for position in &mesh.positions {
        out.write_all(b"v")?;
        for (origin, coordinate) in mesh.origin.iter().zip(position) {
            if is_shifted {
                write!(out, " {:?}", origin + f64::from(*coordinate))?;
            } else {
                write!(out, " {coordinate:?}")?;
            }
        }
        for component in colors.by_ref().take(n_components) {
            write!(out, " {:?}", crate::files::coordinates::nearest_f32(component))?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn write_list(keyword: &str, attribute: Option<&Attribute>, out: &mut dyn Write) -> Result<(), MeshError> {
    let Some(attribute) = attribute else { return Ok(()) };
    let n_components = attribute.n_components as usize;
    for (i, value) in attribute.values().enumerate() {
        if i % n_components == 0 {
            out.write_all(keyword.as_bytes())?;
        }
        write!(out, " {:?}", crate::files::coordinates::nearest_f32(value))?;
        if i % n_components == n_components - 1 {
            out.write_all(b"\n")?;
        }
    }
    Ok(())
}
