//! Mesh files of any bytes.

use crate::script::Script;
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

/// Reads bytes as compressed values at the points of a VTU file: the compressor, the length that
/// the block claims, the block.
pub(crate) fn read_compressed(bytes: &[u8]) {
    let mut script = Script::new(bytes);
    let compressor = ["LZ4", "LZMA", "ZLib"][usize::from(script.u8()) % 3];
    let claimed = u32::from(script.u16());
    let block = bytes.get(3..).unwrap_or_default();
    let head = format!(
        "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtk{compressor}DataCompressor\"><UnstructuredGrid><Piece>\
         <PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" offset=\"0\"/></PointData>\
         <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>\
         <DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int8\" Name=\"offsets\">4</DataArray>\
         <DataArray type=\"Int8\" Name=\"types\">10</DataArray></Cells></Piece></UnstructuredGrid>\
         <AppendedData encoding=\"raw\">_"
    );
    let length = u32::try_from(block.len()).unwrap();
    let table = [1, claimed, 0, length].map(u32::to_le_bytes).concat();
    read_volume(&[head.as_bytes(), &table, block].concat(), VolumeFormat::Vtu);
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
