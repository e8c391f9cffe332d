//! Promise: whichever operation of the file system fails, and however, the output path holds the
//! old file or the new one, success means the new one, and the next write removes what a crash has
//! left.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{Build, BuildOptions, Lod, ProgressiveOptions, StoreOptions, TriangleMesh};
use nephrite_formats::publish::{Disk, LEFTOVER_PREFIX, LEFTOVER_SUFFIX, Storage, publish_in};
use nephrite_formats::{MeshError, MeshFormat, PublishError, read_mesh_bytes, write_mesh_to};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use support::faulty::{Fault, Faulty};

const FAULTS: [Fault; 5] = [Fault::Error, Fault::ShortWrite, Fault::Full, Fault::LostWrite, Fault::Crash];

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// What a write with a fault did.
struct Attempt {
    is_done: bool,
    /// Where the fault struck.
    struck: Option<&'static str>,
    /// Bytes at the path afterwards.
    bytes: Vec<u8>,
    leftovers: usize,
}

/// Makes operation 1, 2, ... of `write` fail in every way until there is none left, and checks the
/// folder after each. Returns how often each operation failed.
fn strike_every_operation<E: std::fmt::Debug>(
    write: impl Fn(&Faulty, &Path) -> Result<(), E>,
    write_well: impl Fn(&Path),
) -> BTreeMap<&'static str, usize> {
    let mut n_struck = BTreeMap::new();
    for fault in FAULTS {
        let mut n_quiet = 0;
        // Operations of other kinds pass the fault; after many of them in a row there are no more.
        for at in 1.. {
            let attempt = attempt(fault, at, &write, &write_well);
            let Some(operation) = attempt.struck else {
                assert!(attempt.is_done && attempt.bytes != b"old");
                n_quiet += 1;
                if n_quiet > 60 { break } else { continue }
            };
            n_quiet = 0;
            *n_struck.entry(operation).or_insert(0) += 1;
            check(fault, operation, &attempt);
        }
    }
    n_struck
}

fn attempt<E: std::fmt::Debug>(
    fault: Fault,
    at: usize,
    write: impl Fn(&Faulty, &Path) -> Result<(), E>,
    write_well: impl Fn(&Path),
) -> Attempt {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    std::fs::write(&path, b"old").unwrap();
    let disk = Faulty::new(fault, at);
    let is_done = write(&disk, &path).is_ok();
    if fault == Fault::Crash {
        disk.lose_unsynced();
    }
    let bytes = std::fs::read(&path).unwrap();
    let there = names(folder.path());
    let is_leftover = |name: &&String| name.starts_with(LEFTOVER_PREFIX) && name.ends_with(LEFTOVER_SUFFIX);
    let leftovers = there.iter().filter(is_leftover).count();
    assert_eq!(there.len(), leftovers + 1, "{there:?}");
    write_well(&path);
    assert_eq!(names(folder.path()), ["out"], "{fault:?} at {at}: something is left");
    if bytes != b"old" {
        assert!(
            bytes == std::fs::read(&path).unwrap(),
            "{fault:?} at {at}: neither the old file nor the new one"
        );
    }
    Attempt { is_done, struck: disk.struck(), bytes, leftovers }
}

fn check(fault: Fault, operation: &str, attempt: &Attempt) {
    let is_old = attempt.bytes == b"old";
    // A folder that cannot be listed hides leftovers, but a file can still be written. A short
    // write is not a fault.
    let is_harmless = fault == Fault::ShortWrite || (operation == "names" && fault == Fault::Error);
    let is_renamed = operation == "sync folder";
    assert_eq!(attempt.is_done, is_harmless, "{fault:?} of {operation}");
    assert_eq!(is_old, !is_harmless && !is_renamed, "{fault:?} of {operation}");
    assert!(
        attempt.leftovers == 0 || fault == Fault::Crash || operation == "remove",
        "{fault:?} of {operation}"
    );
}

fn assert_all_struck(n_struck: &BTreeMap<&'static str, usize>) {
    for operation in ["names", "create", "write", "seek", "sync", "open", "read", "rename", "sync folder"] {
        assert!(n_struck.contains_key(operation), "{operation}: {n_struck:?}");
    }
}

#[test]
fn of_a_build() {
    let mesh = support::synthetic::grid(12);
    let build = nephrite::build(&mesh, &BuildOptions::default()).unwrap();
    check_build(&build, StoreOptions::default());
}

#[test]
fn of_a_build_in_compact_form() {
    let mesh = support::synthetic::grid(5);
    let build = nephrite::build(&mesh, &BuildOptions::default()).unwrap();
    check_build(&build, StoreOptions { is_compact: true, ..StoreOptions::default() });
}

#[test]
fn of_a_build_with_operations() {
    let mesh = support::synthetic::grid(5);
    let options = BuildOptions::with(ProgressiveOptions::default());
    let build = nephrite::build(&mesh, &options).unwrap();
    check_build(&build, StoreOptions { operations: true, ..StoreOptions::default() });
}

/// Writes a build on disks that fail in every way.
fn check_build(build: &Build, options: StoreOptions) {
    let write_badly = |disk: &Faulty, path: &Path| build.write_in(disk, path, &options).map(drop);
    let write_well = |path: &Path| {
        build.write_in(&Disk, path, &options).unwrap();
        Lod::open(path).unwrap().verify().unwrap();
    };
    assert_all_struck(&strike_every_operation(write_badly, write_well));
}

/// An error of either kind.
#[derive(Debug)]
enum MeshFailure {
    Mesh(MeshError),
    Publish(PublishError),
}

impl From<PublishError> for MeshFailure {
    fn from(error: PublishError) -> Self {
        Self::Publish(error)
    }
}

fn write_mesh_in<S: Storage>(disk: &S, path: &Path, mesh: &TriangleMesh) -> Result<(), MeshFailure> {
    let write =
        |file: &mut S::File| write_mesh_to(file, mesh, MeshFormat::Ply).map(drop).map_err(MeshFailure::Mesh);
    // Meshes have no checksums, so what is read back is compared with the mesh.
    publish_in(disk, path, write, |file, temporary| {
        let mut bytes = Vec::new();
        let failed = |source| PublishError { action: "check", path: temporary.to_owned(), source };
        io::Read::read_to_end(file, &mut bytes).map_err(failed)?;
        let same = read_mesh_bytes(&bytes, MeshFormat::Ply)
            .is_ok_and(|(again, _)| again.triangles == mesh.triangles && again.positions == mesh.positions);
        if same { Ok(()) } else { Err(failed(io::Error::from(io::ErrorKind::InvalidData)).into()) }
    })
}

#[test]
fn of_a_mesh() {
    let mesh = TriangleMesh { origin: [0.0; 3], attributes: Vec::new(), ..support::synthetic::grid(3) };
    let n_struck = strike_every_operation(
        |disk, path| match write_mesh_in(disk, path, &mesh) {
            Err(MeshFailure::Mesh(error)) => panic_unless_io(&error).map_err(|()| "mesh"),
            Err(MeshFailure::Publish(error)) => Err(error.action),
            Ok(()) => Ok(()),
        },
        |path| write_mesh_in(&Disk, path, &mesh).unwrap(),
    );
    assert!(n_struck.contains_key("rename") && n_struck["write"] > 40, "{n_struck:?}");
}

fn panic_unless_io(error: &MeshError) -> Result<(), ()> {
    assert!(matches!(error, MeshError::Io(_)), "{error}");
    Err(())
}
