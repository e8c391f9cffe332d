//! Meshes of both kinds, from files or standard input and to files or standard output.

use std::io;
use std::path::Path;

use nephrite::{Simplex, TetrahedronMesh, TriangleMesh};
use nephrite_formats::neph::MAGIC;
use nephrite_formats::{FileFormat, FileReport, MeshError, MeshFormat, VolumeFormat};

use crate::failure::Failure;
use crate::streams::{Source, Target};

/// A surface or a volume.
pub(crate) enum Mesh {
    /// Triangles.
    Surface(TriangleMesh),
    /// Tetrahedra.
    Volume(TetrahedronMesh),
}

impl Mesh {
    /// What it consists of.
    pub(crate) fn simplex(&self) -> Simplex {
        match self {
            Self::Surface(_) => Simplex::Triangle,
            Self::Volume(_) => Simplex::Tetrahedron,
        }
    }

    /// Number of triangles or tetrahedra.
    pub(crate) fn n_simplices(&self) -> usize {
        match self {
            Self::Surface(mesh) => mesh.triangles.len(),
            Self::Volume(mesh) => mesh.tetrahedra.len(),
        }
    }

    /// Number of vertices.
    pub(crate) fn n_vertices(&self) -> usize {
        match self {
            Self::Surface(mesh) => mesh.positions.len(),
            Self::Volume(mesh) => mesh.positions.len(),
        }
    }

    /// Writes the mesh in a format. The report says what the format has no place for.
    ///
    /// # Errors
    ///
    /// A format of the other kind, and those of the writer.
    pub(crate) fn write(&self, target: &Target, format: FileFormat) -> Result<FileReport, Failure> {
        let written = match (self, format) {
            (Self::Surface(mesh), FileFormat::Surface(format)) => {
                target.publish(|out| nephrite_formats::write_mesh_to(out, mesh, format))
            }
            (Self::Volume(mesh), FileFormat::Volume(format)) => {
                target.publish(|out| nephrite_formats::write_volume_to(out, mesh, format))
            }
            (_, format) => return Err(wrong_kind(target, format, self.simplex())),
        };
        written.map_err(|error: MeshError| error.in_file(target.to_string()).into())
    }
}

impl From<(TriangleMesh, FileReport)> for Read {
    fn from((mesh, report): (TriangleMesh, FileReport)) -> Self {
        Self { mesh: Mesh::Surface(mesh), report }
    }
}

impl From<(TetrahedronMesh, FileReport)> for Read {
    fn from((mesh, report): (TetrahedronMesh, FileReport)) -> Self {
        Self { mesh: Mesh::Volume(mesh), report }
    }
}

/// A mesh that was read.
pub(crate) struct Read {
    /// The mesh.
    pub(crate) mesh: Mesh,
    /// What its reader converted or left out.
    pub(crate) report: FileReport,
}

/// Reads a surface or a volume. The format is `format` if given, else the one that the extension
/// names, else the one that the contents show.
///
/// # Errors
///
/// [`MeshError`] with the name of the source, and [`Failure::IsBuilt`] for a file that `build`
/// wrote.
pub(crate) fn read(source: &Source, format: Option<FileFormat>) -> Result<Read, Failure> {
    if let (Source::File(path), None) = (source, format)
        && let Some(format) = format_of_name(path)
    {
        return read_file(path, format);
    }
    let bytes = source.read().map_err(|error| Failure::file(source.to_string(), error))?;
    if bytes.starts_with(&MAGIC) {
        return Err(Failure::IsBuilt { path: source.to_string().into() });
    }
    let found = format_of_contents(&bytes);
    let Some(format) = format.or(found) else {
        return match source {
            // The reader knows the names of formats that it does not read.
            Source::File(path) => Ok(nephrite_formats::read_mesh(path)?.into()),
            Source::Stdin => Err(MeshError::UnknownFormat.in_file(source.to_string()).into()),
        };
    };
    match source {
        // From a file the reader also finds what lies beside it: buffers, a second file.
        Source::File(path) if Some(format) == found => read_file(path, format),
        _ => read_bytes(&bytes, format).map_err(|error| error.in_file(source.to_string()).into()),
    }
}

fn read_file(path: &Path, format: FileFormat) -> Result<Read, Failure> {
    Ok(match format {
        FileFormat::Surface(_) => nephrite_formats::read_mesh(path)?.into(),
        FileFormat::Volume(_) => nephrite_formats::read_volume(path)?.into(),
    })
}

/// Reads a mesh from the bytes of a file.
///
/// # Errors
///
/// [`MeshError`] without a name.
pub(crate) fn read_bytes(bytes: &[u8], format: FileFormat) -> Result<Read, MeshError> {
    Ok(match format {
        FileFormat::Surface(format) => nephrite_formats::read_mesh_bytes(bytes, format)?.into(),
        FileFormat::Volume(format) => nephrite_formats::read_volume_bytes(bytes, format)?.into(),
    })
}

/// The format that a path's extension names.
pub(crate) fn format_of_name(path: &Path) -> Option<FileFormat> {
    let surface = MeshFormat::from_path(path).map(FileFormat::Surface);
    surface.or_else(|| VolumeFormat::from_path(path).map(FileFormat::Volume))
}

/// The format that the first bytes of a file show.
pub(crate) fn format_of_contents(bytes: &[u8]) -> Option<FileFormat> {
    let volume = VolumeFormat::detect(bytes, None).map(FileFormat::Volume);
    volume.or_else(|| MeshFormat::detect(bytes, None).map(FileFormat::Surface))
}

/// A format as it is typed: by the file extension that names it.
///
/// # Errors
///
/// Says what was expected.
pub(crate) fn parse_format(extension: &str) -> Result<FileFormat, String> {
    format_of_name(Path::new(&format!("mesh.{extension}"))).ok_or_else(|| {
        let surfaces = MeshFormat::ALL.map(MeshFormat::extension);
        let volumes = VolumeFormat::ALL.map(|format| format.extensions()[0]);
        format!("expected one of {}, {}", surfaces.join(", "), volumes.join(", "))
    })
}

/// The format to write to a target: the one asked for, else the one that the extension names.
///
/// # Errors
///
/// [`Failure::Usage`] if neither is there, if they differ, and for a format that is only read;
/// [`Failure::Kind`] for a format of the other kind.
pub(crate) fn format_to_write(
    target: &Target,
    asked: Option<FileFormat>,
    simplex: Simplex,
) -> Result<FileFormat, Failure> {
    let named = target.path().and_then(format_of_name);
    if let (Some(asked), Some(named)) = (asked, named)
        && asked != named
    {
        let message = format!("--output-format is {asked}, but the extension of {target} names {named}");
        return Err(Failure::usage(message));
    }
    let Some(format) = asked.or(named) else {
        return Err(match target {
            Target::Stdout => Failure::usage("--output-format must name the format of standard output"),
            Target::File(path) => {
                let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
                let error = match simplex {
                    Simplex::Triangle => MeshError::UnknownExtension { extension },
                    Simplex::Tetrahedron => MeshError::UnknownVolumeExtension { extension },
                };
                error.in_file(path).into()
            }
        });
    };
    match (format, simplex) {
        (FileFormat::Surface(MeshFormat::Gltf), Simplex::Triangle) => {
            let error = MeshError::UnknownExtension { extension: "gltf".to_owned() };
            Err(error.in_file(target.to_string()).into())
        }
        (FileFormat::Volume(format), Simplex::Tetrahedron)
            if !format.is_written() || !is_main_extension(target, format) =>
        {
            let error = MeshError::UnknownVolumeExtension { extension: format.extensions()[0].to_owned() };
            Err(error.in_file(target.to_string()).into())
        }
        (FileFormat::Surface(_), Simplex::Triangle) | (FileFormat::Volume(_), Simplex::Tetrahedron) => {
            Ok(format)
        }
        _ => Err(wrong_kind(target, format, simplex)),
    }
}

/// False for a name such as `grid.pvtu`, which the format reads but does not write.
fn is_main_extension(target: &Target, format: VolumeFormat) -> bool {
    let extension = target.path().and_then(Path::extension);
    extension.is_none_or(|extension| extension.eq_ignore_ascii_case(format.extensions()[0]))
}

fn wrong_kind(target: &Target, format: FileFormat, simplex: Simplex) -> Failure {
    let kind = match simplex {
        Simplex::Triangle => "a surface",
        Simplex::Tetrahedron => "a volume",
    };
    Failure::Kind { output: target.to_string(), format: format.to_string(), kind }
}

/// The format of the mesh in a file, as far as name and first bytes tell; `None` also for a file
/// that cannot be read.
pub(crate) fn looks_like_mesh(path: &Path) -> Option<FileFormat> {
    const LOOKED_AT_BYTES: u64 = 64 * 1024;
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).ok()?;
    io::Read::read_to_end(&mut io::Read::take(file, LOOKED_AT_BYTES), &mut bytes).ok()?;
    format_of_name(path).or_else(|| format_of_contents(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_typed_as_extensions() {
        assert_eq!(parse_format("stl"), Ok(FileFormat::Surface(MeshFormat::Stl)));
        assert_eq!(parse_format("MSH"), Ok(FileFormat::Volume(VolumeFormat::Gmsh)));
        assert!(parse_format("xyz").unwrap_err().contains("ply, obj"));
    }

    #[test]
    fn an_output_has_the_format_of_its_name_or_the_one_asked_for() {
        let file = Target::File("a.stl".into());
        let [stl, vtu] = ["stl", "vtu"].map(|name| parse_format(name).unwrap());
        let choose = |target: &Target, asked, simplex| format_to_write(target, asked, simplex);
        assert_eq!(choose(&file, None, Simplex::Triangle).unwrap(), stl);
        assert_eq!(choose(&Target::Stdout, Some(vtu), Simplex::Tetrahedron).unwrap(), vtu);
        assert_eq!(choose(&Target::Stdout, None, Simplex::Triangle).unwrap_err().status(), 2);
        assert_eq!(choose(&file, Some(vtu), Simplex::Triangle).unwrap_err().status(), 2);
        assert!(choose(&file, None, Simplex::Tetrahedron).unwrap_err().line().contains("STL"));
        let nothing = Target::File("a".into());
        assert_eq!(choose(&nothing, None, Simplex::Triangle).unwrap_err().status(), 1);
    }
}
