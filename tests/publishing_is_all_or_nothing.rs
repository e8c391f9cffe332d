//! Promise: after a failed write the path holds what it held before, nothing is left beside it, and
//! readers of the old file keep it.

#![expect(unsafe_code, reason = "nobody writes to the files that are mapped here")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use nephrite::{
    History, Lod, ScalarType, StoreOptions, StreamError, TriangleMesh, WriteError, check_attributes,
};
use std::fs;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use support::synthetic::{decimate, grid};

fn surface() -> (TriangleMesh, History<3>) {
    let mesh = grid(8);
    let history = decimate(&mesh, usize::MAX, 1);
    (mesh, history)
}

fn publish(path: &Path, mesh: &TriangleMesh, history: &History<3>) -> Result<(), WriteError> {
    history.write(path, mesh, &StoreOptions::default()).map(drop)
}

fn names(folder: &Path) -> Vec<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_file_is_written_replaced_and_opened_both_ways() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.neph");
    let (mesh, history) = surface();
    publish(&path, &mesh, &history).unwrap();
    assert_eq!(names(folder.path()), ["surface.neph"]);

    let read = Lod::open(&path).unwrap();
    // SAFETY: the file is replaced by rename below, never written to.
    let mapped = unsafe { Lod::map(&path) }.unwrap();
    let levels_before = read.n_levels();
    publish(&path, &mesh, &decimate(&mesh, 3, 1)).unwrap();
    assert_eq!(names(folder.path()), ["surface.neph"]);
    let after = Lod::open(&path).unwrap();
    assert!(after.n_levels() < levels_before);
    for old in [&read, &mapped] {
        assert_eq!(old.n_levels(), levels_before);
        old.verify().unwrap();
    }
    fs::remove_file(&path).unwrap();
    mapped.verify().unwrap();
    assert_eq!(read.at_level(9).to_mesh(), mapped.at_level(9).to_mesh());
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("a.neph"), folder.path().join("b"));
    let (mesh, history) = surface();
    publish(&path, &mesh, &history).unwrap();
    fs::write(&other, b"").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&other));
}

#[test]
fn failures_leave_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.neph");
    let (mesh, history) = surface();
    fs::write(&path, b"what was here before").unwrap();

    let mut broken = history.clone();
    broken.errors[3] = f64::NAN;
    assert!(matches!(publish(&path, &mesh, &broken), Err(WriteError::History(_))));
    let mut short = mesh.clone();
    short.positions.pop();
    let error = publish(&path, &short, &history);
    assert!(matches!(error, Err(WriteError::VertexCount { found: 64, expected: 63 })));
    assert_eq!(fs::read(&path).unwrap(), b"what was here before");
    assert_eq!(names(folder.path()), ["surface.neph"]);

    let taken = folder.path().join("taken");
    fs::create_dir(&taken).unwrap();
    fs::write(taken.join("inside"), b"").unwrap();
    assert!(matches!(publish(&taken, &mesh, &history), Err(WriteError::Io { .. })));
    assert_eq!(names(&taken), ["inside"]);
    assert_eq!(names(folder.path()).len(), 2);
    let nowhere = folder.path().join("missing/surface.neph");
    assert!(matches!(publish(&nowhere, &mesh, &history), Err(WriteError::Io { .. })));
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_to_keeps_its_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.neph");
    let (mesh, history) = surface();
    fs::write(&path, b"what was here before").unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    let is_superuser = fs::write(folder.path().join("probe"), b"").is_ok();
    let result = publish(&path, &mesh, &history);
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    if !is_superuser {
        assert!(matches!(result, Err(WriteError::Io { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"what was here before");
        assert_eq!(names(folder.path()), ["surface.neph"]);
    }
}

/// A stream that takes few bytes at a time and fails at operation number `n_good`.
struct Failing {
    inner: Cursor<Vec<u8>>,
    n_good: usize,
}

impl Failing {
    fn count_down(&mut self) -> io::Result<()> {
        self.n_good =
            self.n_good.checked_sub(1).ok_or_else(|| io::Error::from(io::ErrorKind::StorageFull))?;
        Ok(())
    }
}

impl Write for Failing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.count_down()?;
        self.inner.write(&bytes[..bytes.len().min(100)])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.count_down()
    }
}

impl Seek for Failing {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.count_down()?;
        self.inner.seek(position)
    }
}

#[test]
fn a_stream_that_fails_at_any_operation_gives_its_error() {
    let (mesh, history) = surface();
    let whole = support::file_bytes(&mesh, &history, None);
    for n_good in 0.. {
        let mut stream = Failing { inner: Cursor::new(Vec::new()), n_good };
        match history.write_to(&mut stream, &mesh, &StoreOptions::default()) {
            Err(WriteError::Stream(error)) => {
                assert_eq!(error.kind(), io::ErrorKind::StorageFull);
                // The head is written last: until then the file does not open, unless only a flush
                // was missing.
                let written = stream.inner.get_ref();
                assert!(Lod::from_bytes(written).is_err() || *written == whole);
            }
            result => {
                assert_eq!(result.unwrap().file_bytes, whole.len() as u64);
                assert_eq!(stream.inner.into_inner(), whole);
                assert!(n_good > 50);
                break;
            }
        }
    }
}

#[test]
fn input_that_does_not_fit_is_refused_with_its_error() {
    let (mesh, history) = surface();
    let refused = |edit: fn(&mut TriangleMesh)| {
        let mut mesh = mesh.clone();
        edit(&mut mesh);
        let (stream, options) = (&mut Cursor::new(Vec::new()), StoreOptions::default());
        let error = history.write_to(stream, &mesh, &options).unwrap_err();
        // Already known before a build.
        let is_of_attributes =
            matches!(error, WriteError::Attribute { .. } | WriteError::TooManyAttributes { .. });
        let before = check_attributes(&mesh).err().map(|error| error.to_string());
        assert_eq!(before, is_of_attributes.then(|| error.to_string()));
        error
    };
    let attribute = |error: WriteError| match error {
        WriteError::Attribute { what, .. } => what,
        other => other.to_string().leak(),
    };
    assert!(matches!(refused(|m| m.positions[5][1] = f32::NAN), WriteError::NotFinite { .. }));
    assert!(matches!(refused(|m| m.origin[0] = f64::INFINITY), WriteError::NotFinite { .. }));
    assert!(matches!(refused(|m| m.rounding = -1.0), WriteError::NotFinite { .. }));
    assert_eq!(attribute(refused(|m| m.attributes[0].bytes.truncate(9))), "bytes");
    assert_eq!(attribute(refused(|m| m.attributes[0].n_components = 0)), "bytes");
    assert_eq!(attribute(refused(|m| m.attributes[0].name.clear())), "bytes of name");
    assert_eq!(attribute(refused(|m| m.attributes[0].name = "quality".into())), "attributes of that name");
    let no_components = |m: &mut TriangleMesh| {
        m.attributes[0].n_components = 0;
        m.attributes[0].bytes.clear();
    };
    assert_eq!(attribute(refused(no_components)), "components");
    let many = |m: &mut TriangleMesh| {
        m.attributes = (0..257)
            .map(|i| nephrite::Attribute {
                name: format!("a{i}"),
                scalar: ScalarType::U8,
                n_components: 1,
                bytes: vec![0; m.positions.len()],
            })
            .collect();
    };
    assert!(matches!(refused(many), WriteError::TooManyAttributes { found: 257, max: 256, .. }));
    let long = |m: &mut TriangleMesh| m.attributes[0].name = "x".repeat(70_000);
    assert!(matches!(refused(long), WriteError::TooManyAttributes { what: "bytes of attribute names", .. }));

    let wanted = StoreOptions { operations: true, ..StoreOptions::default() };
    let error = history.write_to(&mut Cursor::new(Vec::new()), &mesh, &wanted);
    assert!(matches!(error, Err(WriteError::Operations(StreamError::NoOperations))));
}

#[test]
fn the_same_history_gives_the_same_bytes_on_any_number_of_threads() {
    // Large enough for the sorts that use several threads.
    let mesh = grid(200);
    let history = decimate(&mesh, usize::MAX, 5);
    let on_threads = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| support::file_bytes(&mesh, &history, None))
    };
    let one = on_threads(1);
    assert!(one == on_threads(2));
    assert!(one == on_threads(7));
}
