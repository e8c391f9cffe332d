//! Promise: truncated and edited files of every format end in a consistent mesh or in an error,
//! never in a panic.

#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod samples;

use nephrite_formats::{MeshError, MeshFormat, read_mesh_bytes};
use proptest::prelude::*;
use samples::small_files;

/// Reads bytes as any caller could, and uses the result. Returns whether there is a mesh.
fn is_read(bytes: &[u8], format: MeshFormat) -> bool {
    match read_mesh_bytes(bytes, format) {
        Ok((mesh, _)) => {
            mesh.check().unwrap();
            assert!(!mesh.triangles.is_empty() && mesh.rounding.is_finite());
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && !message.contains('\n') && message.len() < 300, "{message}");
            false
        }
    }
}

#[test]
fn files_cut_at_every_length() {
    for (name, format, bytes) in small_files() {
        let n_read = (0..bytes.len()).filter(|&length| is_read(&bytes[..length], format)).count();
        // A format that states its length must notice; text may end in the middle of a number or in
        // lines without meaning.
        let is_exact =
            matches!(name, "ply binary" | "ply doubles" | "ply big-endian strips" | "stl binary" | "glb");
        assert!(!is_exact || n_read == 0, "{name}: {n_read} of its beginnings were read");
        let is_measured = matches!(name, "stl text" | "gltf" | "gltf sparse strip" | "off" | "ply text");
        assert!(!is_measured || n_read <= 2, "{name}: {n_read} of its beginnings were read");
    }
}

#[test]
fn every_byte_edited() {
    const TEXT: &[u8] = b"0 9-./\n#ev\"{";
    for (_, format, bytes) in small_files() {
        let mut edited = bytes.clone();
        for at in 0..bytes.len() {
            let flipped = (0..8).map(|bit| bytes[at] ^ (1 << bit));
            for value in flipped.chain([0, 255]).chain(TEXT.iter().copied()) {
                edited[at] = value;
                is_read(&edited, format);
            }
            edited[at] = bytes[at];
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn many_bytes_edited(
        file in 0_usize..12,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
    ) {
        let (_, format, mut bytes) = small_files().swap_remove(file);
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        is_read(&bytes, format);
        // A cut in the middle.
        let cut = cut.index(bytes.len());
        bytes.drain(cut..(cut + 7).min(bytes.len()));
        is_read(&bytes, format);
    }

    #[test]
    fn any_bytes_at_all(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for format in MeshFormat::ALL {
            is_read(&bytes, format);
        }
        MeshFormat::detect(&bytes, None);
    }

    #[test]
    fn files_read_as_another_format(file in 0_usize..12) {
        let (_, _, bytes) = small_files().swap_remove(file);
        for format in MeshFormat::ALL {
            is_read(&bytes, format);
        }
    }
}

#[test]
fn contents_decide_over_the_extension() {
    for (name, format, bytes) in small_files() {
        for extension in MeshFormat::ALL {
            let detected = MeshFormat::detect(&bytes, Some(extension));
            // OBJ and text STL have no signature, so the extension decides.
            let has_magic = !matches!(format, MeshFormat::Obj | MeshFormat::Stl);
            assert!(!has_magic || detected == Some(format), "{name} as {extension}: {detected:?}");
        }
        assert_eq!(MeshFormat::detect(&bytes, None), Some(format), "{name}");
    }
    assert_eq!(MeshFormat::detect(b"", None), None);
    assert_eq!(MeshFormat::detect(b"hello", None), None);
}

#[test]
fn errors_name_file_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.obj");
    std::fs::write(&path, "v 0 0 0\nf 1 2 3\n").unwrap();
    let error = nephrite_formats::read_mesh(&path).unwrap_err();
    let message = format!("{}: line 2: vertex index 3 is out of range (1 there)", path.display());
    assert_eq!(error.to_string(), message);
    let missing = nephrite_formats::read_mesh(folder.path().join("none.ply")).unwrap_err();
    assert!(missing.to_string().contains("none.ply: ") && matches!(missing.root(), MeshError::Io(_)));
    let unknown = folder.path().join("notes.txt");
    std::fs::write(&unknown, "hello").unwrap();
    assert!(matches!(nephrite_formats::read_mesh(&unknown).unwrap_err().root(), MeshError::UnknownFormat));
    assert!(matches!(nephrite_formats::read_mesh(folder.path()).unwrap_err().root(), MeshError::Io(_)));
}
