//! A disk that fails: the real one, on which one operation, or all from one on, go wrong.

use nephrite_formats::publish::{Disk, Storage};
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io::{self, Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// One operation fails; a failing write has written half of its bytes.
    Error,
    /// One write takes half of its bytes and says so, which is allowed.
    ShortWrite,
    /// From one operation on there is no space: writes fail, everything else works.
    Full,
    /// One write reports success and has written nothing, or other bytes.
    LostWrite,
    /// From one operation on nothing happens: the process was killed or the power failed. Of what
    /// was not synced, half is there.
    Crash,
}

/// The disk. Operations are counted from 1.
#[derive(Debug)]
pub struct Faulty {
    state: Rc<State>,
}

#[derive(Debug)]
struct State {
    fault: Fault,
    at: usize,
    n_operations: Cell<usize>,
    /// The operation at which the fault struck.
    struck: Cell<Option<&'static str>>,
    unsynced: RefCell<BTreeSet<PathBuf>>,
}

/// An open file of this disk.
#[derive(Debug)]
pub struct FaultyFile {
    file: File,
    path: PathBuf,
    state: Rc<State>,
}

impl Faulty {
    pub fn new(fault: Fault, at: usize) -> Self {
        let state = State {
            fault,
            at,
            n_operations: Cell::new(0),
            struck: Cell::new(None),
            unsynced: RefCell::default(),
        };
        Self { state: Rc::new(state) }
    }

    /// The operation at which the fault struck, if it did.
    pub fn struck(&self) -> Option<&'static str> {
        self.state.struck.get()
    }

    /// After a crash: of every file that was never synced only half is left, with wrong bytes.
    pub fn lose_unsynced(&self) {
        for path in self.state.unsynced.borrow().iter().filter(|path| path.exists()) {
            let len = path.metadata().unwrap().len();
            let file = OpenOptions::new().write(true).open(path).unwrap();
            file.set_len(len / 2).unwrap();
        }
    }

    fn wrap(&self, file: io::Result<File>, path: &Path) -> io::Result<FaultyFile> {
        Ok(FaultyFile { file: file?, path: path.to_owned(), state: Rc::clone(&self.state) })
    }
}

impl State {
    /// Counts an operation; whether the fault strikes it.
    fn strikes(&self, operation: &'static str) -> bool {
        let n = self.n_operations.get() + 1;
        self.n_operations.set(n);
        let strikes = match self.fault {
            Fault::Error => n == self.at,
            Fault::ShortWrite | Fault::LostWrite => n == self.at && operation == "write",
            Fault::Full => n >= self.at && operation == "write",
            Fault::Crash => n >= self.at,
        };
        if strikes && self.struck.get().is_none() {
            self.struck.set(Some(operation));
        }
        strikes
    }

    /// An operation that is not a write.
    fn pass(&self, operation: &'static str) -> io::Result<()> {
        if self.strikes(operation) { Err(Error::other(format!("{operation} failed"))) } else { Ok(()) }
    }
}

impl Storage for Faulty {
    type File = FaultyFile;

    fn create(&self, path: &Path) -> io::Result<FaultyFile> {
        self.state.pass("create")?;
        self.state.unsynced.borrow_mut().insert(path.to_owned());
        self.wrap(Disk.create(path), path)
    }

    fn open(&self, path: &Path) -> io::Result<FaultyFile> {
        self.state.pass("open")?;
        self.wrap(Disk.open(path), path)
    }

    fn sync(&self, file: &mut FaultyFile) -> io::Result<()> {
        self.state.pass("sync")?;
        self.state.unsynced.borrow_mut().remove(&file.path);
        Disk.sync(&mut file.file)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.state.pass("rename")?;
        assert!(!self.state.unsynced.borrow().contains(from), "renamed before its bytes are on the disk");
        Disk.rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.state.pass("remove")?;
        Disk.remove(path)
    }

    fn sync_folder(&self, folder: &Path) -> io::Result<()> {
        self.state.pass("sync folder")?;
        Disk.sync_folder(folder)
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>> {
        self.state.pass("names")?;
        Disk.names(folder)
    }

    fn remove_if_abandoned(&self, path: &Path) -> io::Result<()> {
        self.state.pass("remove if abandoned")?;
        Disk.remove_if_abandoned(path)
    }
}

impl Read for FaultyFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.state.pass("read")?;
        self.file.read(bytes)
    }
}

impl Write for FaultyFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.state.unsynced.borrow_mut().insert(self.path.clone());
        if !self.state.strikes("write") {
            return self.file.write(bytes);
        }
        match self.state.fault {
            Fault::ShortWrite => self.file.write(&bytes[..bytes.len().div_ceil(2)]),
            Fault::LostWrite => self.file.write(&vec![0x55; bytes.len()]),
            Fault::Full => Err(Error::from(ErrorKind::StorageFull)),
            Fault::Error => {
                self.file.write_all(&bytes[..bytes.len() / 2])?;
                Err(Error::other("write failed"))
            }
            Fault::Crash => Err(Error::other("gone")),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for FaultyFile {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.state.pass("seek")?;
        self.file.seek(position)
    }
}
