//! Promise: a mesh that cannot be written leaves the folder as it was.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use std::io;

use nephrite_formats::{MeshError, MeshFormat, read_mesh, write_mesh, write_mesh_to};
use samples::{WRITTEN, bumpy_square, decorated_square, written};

fn n_files(folder: &std::path::Path) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

#[test]
fn inconsistent_meshes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut no_such_vertex = bumpy_square(2);
    no_such_vertex.triangles.push([0, 1, 4]);
    let mut not_finite = bumpy_square(2);
    not_finite.positions[1][2] = f32::NAN;
    let mut short_attribute = decorated_square(2);
    short_attribute.attributes[0].bytes.pop();
    let mut empty_attribute = decorated_square(2);
    empty_attribute.attributes[0].n_components = 0;
    empty_attribute.attributes[0].bytes.clear();
    for format in WRITTEN {
        let path = folder.path().join("mesh").with_extension(format.extension());
        for mesh in [&no_such_vertex, &not_finite, &short_attribute, &empty_attribute] {
            assert!(write_mesh(&path, mesh).is_err(), "{format}");
            assert_eq!(n_files(folder.path()), 0);
        }
    }
    let error = write_mesh(folder.path().join("a.ply"), &no_such_vertex).unwrap_err();
    assert!(error.to_string().ends_with("triangle 2 names vertex 4, the mesh has 4 vertices"), "{error}");
}

#[test]
fn extensions_without_a_writer_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["mesh", "mesh.", "mesh.txt", "mesh.gltf", "mesh.ply.gz"] {
        let error = write_mesh(folder.path().join(name), &bumpy_square(2)).unwrap_err();
        assert!(matches!(error.root(), MeshError::UnknownExtension { .. }), "{name}: {error}");
    }
    assert_eq!(n_files(folder.path()), 0);
}

/// A writer on a disk with limited space.
struct Full {
    room: usize,
}

impl io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n_bytes = bytes.len().min(self.room);
        self.room -= n_bytes;
        if n_bytes == 0 && !bytes.is_empty() { Err(io::ErrorKind::StorageFull.into()) } else { Ok(n_bytes) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_reported_wherever_it_happens() {
    let mesh = decorated_square(3);
    for format in WRITTEN {
        let n_bytes = written(&mesh, format).len();
        for room in 0..n_bytes {
            let error = write_mesh_to(&mut Full { room }, &mesh, format).unwrap_err();
            assert!(matches!(error, MeshError::Io(_)), "{format} {room}: {error}");
        }
        write_mesh_to(&mut Full { room: n_bytes }, &mesh, format).unwrap();
    }
}

#[test]
fn an_old_file_is_replaced_only_by_a_whole_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.ply");
    write_mesh(&path, &bumpy_square(3)).unwrap();
    let mut broken = bumpy_square(5);
    broken.triangles[0][0] = 99;
    assert!(write_mesh(&path, &broken).is_err());
    assert_eq!(read_mesh(&path).unwrap().0, bumpy_square(3));
    write_mesh(&path, &bumpy_square(4)).unwrap();
    assert_eq!(read_mesh(&path).unwrap().0, bumpy_square(4));
    assert_eq!(n_files(folder.path()), 1);
    assert!(write_mesh(folder.path().join("none/mesh.ply"), &bumpy_square(2)).is_err());
    assert_eq!(MeshFormat::from_path(&path), Some(MeshFormat::Ply));
}
