//! STL: binary where single precision holds the coordinates, text where it does not.

use std::io::Write;

use crate::files::coordinates::nearest_f32;
use crate::{FileReport, Kind, MeshError, MeshFormat, TriangleMesh};

/// Writes a mesh. Attributes have no place in STL and are left out.
///
/// A mesh about an origin other than zero needs more digits than the binary form has, so it is
/// written as text.
///
/// # Errors
///
/// [`MeshError::TooLargeForFormat`] or [`MeshError::Io`].
pub(crate) fn write(
    mesh: &TriangleMesh,
    out: &mut dyn Write,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    for attribute in &mesh.attributes {
        let id = report.named(Kind::Attribute, &attribute.name);
        report.leave_out(id, "STL has no values at vertices");
    }
    if mesh.origin == [0.0; 3] { write_binary(mesh, out) } else { write_text(mesh, out) }
}

fn write_binary(mesh: &TriangleMesh, out: &mut dyn Write) -> Result<(), MeshError> {
    let (format, what, count) = (MeshFormat::Stl, "triangles", mesh.triangles.len() as u64);
    let too_large = MeshError::TooLargeForFormat { format, what, count, limit: u32::MAX.into() };
    let n_triangles = u32::try_from(count).map_err(|_| too_large)?;
    out.write_all(&[0; 80])?;
    out.write_all(&n_triangles.to_le_bytes())?;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|index| mesh.positions[index as usize]);
        let mut record = [0; 50];
        let values = unit_normal(corners).into_iter().chain(corners.into_iter().flatten());
        for (bytes, value) in record.chunks_exact_mut(4).zip(values) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(())
}

fn write_text(mesh: &TriangleMesh, out: &mut dyn Write) -> Result<(), MeshError> {
    out.write_all(b"solid\n")?;
    for triangle in &mesh.triangles {
        let [x, y, z] = unit_normal(triangle.map(|index| mesh.positions[index as usize]));
        writeln!(out, "facet normal {x:?} {y:?} {z:?}\nouter loop")?;
        for index in triangle {
            let [x, y, z] = mesh.point(*index);
            writeln!(out, "vertex {x:?} {y:?} {z:?}")?;
        }
        out.write_all(b"endloop\nendfacet\n")?;
    }
    out.write_all(b"endsolid\n")?;
    Ok(())
}

/// Unit normal of a triangle, zero where it has no area.
fn unit_normal(corners: [[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let u: [f64; 3] = std::array::from_fn(|axis| b[axis] - a[axis]);
    let v: [f64; 3] = std::array::from_fn(|axis| c[axis] - a[axis]);
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
    if length > 0.0 { normal.map(|value| nearest_f32(value / length)) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::stl::read;

    #[test]
    fn far_from_the_origin_text_keeps_the_digits() {
        let mesh = TriangleMesh {
            origin: [1e7, 0.0, 0.0],
            positions: vec![[0.0, 0.0, 0.0], [0.001, 0.0, 0.0], [0.0, 0.002, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..TriangleMesh::default()
        };
        let mut bytes = Vec::new();
        write(&mesh, &mut bytes, &mut FileReport::new(MeshFormat::Stl)).unwrap();
        let (again, _) = read(&bytes).unwrap();
        for vertex in 0..3 {
            let (a, b) = (mesh.point(vertex), again.point(vertex));
            assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() < 4e-9), "{a:?} {b:?}");
        }
    }

    #[test]
    fn normals_are_of_unit_length() {
        assert_eq!(unit_normal([[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]), [0.0, 0.0, 1.0]);
        assert_eq!(unit_normal([[0.0; 3], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]), [0.0; 3]);
    }
}
