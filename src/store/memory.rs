//! The bytes of a file: owned and aligned, or held by the caller.

use super::OpenError;
use bytemuck::{Pod, Zeroable};
use nephrite_formats::neph::{Directory, MAX_HEAD_BYTES};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Sections begin at multiples of this length, and their records are read in place.
#[repr(C, align(64))]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Block([u8; 64]);

/// Where records begin at least: none has a field of more than 8 bytes.
const RECORD_ALIGNMENT: usize = 8;

/// The bytes of an opened file, aligned for its records.
pub(super) enum Memory {
    /// Read into memory.
    Owned(OwnedBytes),
    /// Held by a map or by the caller.
    Shared(Box<dyn AsRef<[u8]> + Send + Sync>),
}

impl Memory {
    /// The bytes where they are, or a copy if records would not be aligned there.
    pub(super) fn shared(owner: impl AsRef<[u8]> + Send + Sync + 'static) -> Result<Self, OpenError> {
        let bytes = owner.as_ref();
        if bytes.as_ptr().addr().is_multiple_of(RECORD_ALIGNMENT) {
            Ok(Self::Shared(Box::new(owner)))
        } else {
            OwnedBytes::copy_of(bytes).map(Self::Owned)
        }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        match self {
            Self::Owned(owned) => owned.bytes(),
            Self::Shared(owner) => (**owner).as_ref(),
        }
    }
}

/// Memory of its own, aligned to 64 bytes.
pub(super) struct OwnedBytes {
    blocks: Vec<Block>,
    len: usize,
}

impl OwnedBytes {
    fn zeroed(bytes: u64) -> Result<Self, OpenError> {
        let error = || OpenError::OutOfMemory { bytes };
        let len = usize::try_from(bytes).map_err(|_| error())?;
        let blocks = bytemuck::allocation::try_zeroed_vec(len.div_ceil(64)).map_err(|()| error())?;
        Ok(Self { blocks, len })
    }

    /// A copy of `bytes`.
    pub(super) fn copy_of(bytes: &[u8]) -> Result<Self, OpenError> {
        let mut owned = Self::zeroed(bytes.len() as u64)?;
        owned.bytes_mut().copy_from_slice(bytes);
        Ok(owned)
    }

    /// Reads a file whose head is in order; another file is refused before memory is allocated.
    pub(super) fn read(path: &Path) -> Result<Self, OpenError> {
        let failed = |action| move |source| OpenError::Io { action, path: path.to_owned(), source };
        let mut file = open_regular(path)?;
        let file_bytes = file.metadata().map_err(failed("read"))?.len();
        let mut head = Vec::new();
        (&mut file).take(MAX_HEAD_BYTES as u64).read_to_end(&mut head).map_err(failed("read"))?;
        Directory::read(&head, file_bytes)?;
        let mut owned = Self::zeroed(file_bytes)?;
        let rest = owned.bytes_mut();
        let Some((start, rest)) = rest.split_at_mut_checked(head.len()) else {
            return Err(failed("read")(io::Error::from(io::ErrorKind::UnexpectedEof)));
        };
        start.copy_from_slice(&head);
        file.read_exact(rest).map_err(failed("read"))?;
        Ok(owned)
    }

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.blocks).get(..self.len).unwrap_or(&[])
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        let len = self.len;
        bytemuck::cast_slice_mut(&mut self.blocks).get_mut(..len).unwrap_or(&mut [])
    }
}

/// Opens a regular file; anything else is refused before opening it can block.
pub(super) fn open_regular(path: &Path) -> Result<File, OpenError> {
    let failed = |source| OpenError::Io { action: "open", path: path.to_owned(), source };
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(OpenError::NotAFile { path: path.to_owned() });
    }
    File::open(path).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// Bytes from a place on.
    struct From(Arc<Vec<u64>>, usize);

    impl AsRef<[u8]> for From {
        fn as_ref(&self) -> &[u8] {
            &bytemuck::cast_slice(&self.0)[self.1..]
        }
    }

    #[test]
    fn bytes_are_copied_only_if_records_would_not_be_aligned() {
        let words = Arc::new(vec![7_u64; 9]);
        let whole: &[u8] = bytemuck::cast_slice(&words);
        for start in 0..=16 {
            let memory = Memory::shared(From(Arc::clone(&words), start)).unwrap();
            assert_eq!(memory.bytes(), &whole[start..]);
            let is_there = memory.bytes().as_ptr() == whole[start..].as_ptr();
            assert_eq!(is_there, start % 8 == 0, "from {start}");
        }
    }
}
