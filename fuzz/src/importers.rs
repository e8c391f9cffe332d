//! Mesh files of any bytes.

use nephrite_formats::{
    MeshFormat, VolumeFormat, read_mesh_bytes, read_volume_bytes, write_mesh_to, write_volume_to,
};

/// Reads bytes as a mesh file. The result must be a consistent mesh that can be written, or an
/// error of one line.
///
/// # Panics
///
/// If it is neither.
pub(crate) fn read_mesh(bytes: &[u8], format: MeshFormat) {
    let detected = MeshFormat::detect(bytes, Some(format));
    assert!(detected.is_some());
    match read_mesh_bytes(bytes, format) {
        Ok((mesh, report)) => {
            mesh.check().unwrap();
            assert!(
                !mesh.triangles.is_empty() && mesh.rounding.is_finite() && report.format == format.into()
            );
            let mut written = Vec::new();
            write_mesh_to(&mut written, &mesh, MeshFormat::Ply).unwrap();
            let (again, _) = read_mesh_bytes(&written, MeshFormat::Ply).unwrap();
            assert_eq!(again.triangles, mesh.triangles);
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && !message.contains('\n') && message.len() < 400, "{message}");
        }
    }
}

/// Reads bytes as a volume file. The result must be a consistent volume, or an error of one line.
///
/// # Panics
///
/// If it is neither.
pub(crate) fn read_volume(bytes: &[u8], format: VolumeFormat) {
    match read_volume_bytes(bytes, format) {
        Ok((mesh, report)) => {
            mesh.check().unwrap();
            assert!(report.notes().iter().all(|note| note.len() < 400));
            assert!(!mesh.tetrahedra.is_empty() && mesh.rounding.is_finite());
            write_volume_to(&mut Vec::new(), &mesh, VolumeFormat::Vtu).unwrap();
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && !message.contains('\n') && message.len() < 400, "{message}");
        }
    }
}
