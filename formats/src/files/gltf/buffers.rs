//! Where a document's bytes come from: the GLB chunk, `data:` URIs, and files below the document's
//! folder.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::document::Buffer;
use crate::files::error::{MeshError, Place, excerpt};
use crate::files::input::{path_below, read_below};

/// The bytes of every buffer.
pub(crate) struct Buffers<'a> {
    contents: Vec<Cow<'a, [u8]>>,
    /// Which of the contents each buffer has; `None` for a buffer without any.
    of_buffer: Vec<Option<usize>>,
}

impl<'a> Buffers<'a> {
    /// Gathers the bytes. Every file is read once, however many buffers name it, so that no more is
    /// held than there is.
    ///
    /// # Errors
    ///
    /// [`MeshError::Reference`] for what is refused or missing, [`MeshError::Truncated`] for too
    /// few bytes.
    pub(crate) fn load(
        buffers: &[Buffer],
        binary: Option<&'a [u8]>,
        folder: Option<&Path>,
    ) -> Result<Self, MeshError> {
        let mut loaded = Self { contents: Vec::new(), of_buffer: Vec::new() };
        let mut files: HashMap<PathBuf, usize> = HashMap::new();
        for (i, buffer) in buffers.iter().enumerate() {
            let place = Place::item("buffer", i);
            let refuse = |uri: &str, problem: String| MeshError::Reference {
                place,
                uri: excerpt(uri.as_bytes()).trim_matches('"').into(),
                problem,
            };
            let contents = match &buffer.uri {
                None => binary.filter(|_| i == 0).map(|binary| loaded.push(Cow::Borrowed(binary))),
                Some(uri) if uri.starts_with("data:") => {
                    let bytes = decode_data(uri).map_err(|problem| refuse(uri, problem.into()))?;
                    Some(loaded.push(Cow::Owned(bytes)))
                }
                Some(uri) => {
                    let path = relative_path(uri).map_err(|problem| refuse(uri, problem.into()))?;
                    let known = files.get(&path).copied();
                    Some(match known {
                        Some(contents) => contents,
                        None => {
                            let bytes = read_below(folder, &path).map_err(|problem| refuse(uri, problem))?;
                            let contents = loaded.push(Cow::Owned(bytes));
                            files.insert(path, contents);
                            contents
                        }
                    })
                }
            };
            if let Some(contents) = contents {
                let (expected, found) = (buffer.byte_length, loaded.contents[contents].len() as u64);
                if found < expected {
                    return Err(MeshError::Truncated { place, what: "contents", expected, found });
                }
            }
            loaded.of_buffer.push(contents);
        }
        Ok(loaded)
    }

    /// The bytes of a buffer; `None` if there is no such buffer or it is empty.
    pub(crate) fn get(&self, buffer: usize) -> Option<&[u8]> {
        let contents = (*self.of_buffer.get(buffer)?)?;
        Some(&self.contents[contents])
    }

    /// Bytes in all buffers, each counted once.
    pub(crate) fn n_bytes(&self) -> u64 {
        self.contents.iter().map(|contents| contents.len() as u64).sum()
    }

    fn push(&mut self, contents: Cow<'a, [u8]>) -> usize {
        self.contents.push(contents);
        self.contents.len() - 1
    }
}

/// The bytes of a `data:` URI.
fn decode_data(uri: &str) -> Result<Vec<u8>, &'static str> {
    const ANY_PADDING: GeneralPurposeConfig =
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let (_, data) = uri.split_once(";base64,").ok_or("is not in base64")?;
    GeneralPurpose::new(&STANDARD, ANY_PADDING).decode(data).map_err(|_| "is not valid base64")
}

/// The path that a relative URI names, if it stays below the folder it starts from.
fn relative_path(uri: &str) -> Result<PathBuf, &'static str> {
    path_below(&decode_percent(uri).ok_or("is not valid percent-encoding of UTF-8")?)
}

/// Replaces `%41` and the like; `None` where a sequence is incomplete or the result is not UTF-8.
fn decode_percent(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        bytes.push(digit(*rest.first()?)? * 16 + digit(*rest.get(1)?)?);
        rest = &rest[2..];
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn load<'a>(uri: &str, byte_length: u64, folder: Option<&Path>) -> Result<Buffers<'a>, MeshError> {
        Buffers::load(&[Buffer { uri: Some(uri.into()), byte_length }], None, folder)
    }

    #[test]
    fn base64_with_and_without_padding() {
        for uri in ["data:application/octet-stream;base64,AQID/w==", "data:;base64,AQID/w"] {
            assert_eq!(load(uri, 4, None).unwrap().get(0), Some(&[1, 2, 3, 255][..]));
        }
        assert!(load("data:;base64,AQ!D", 1, None).is_err());
        assert!(load("data:text/plain,hello", 1, None).is_err());
    }

    #[test]
    fn only_files_below_the_folder_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        fs::create_dir_all(inner.join("a b")).unwrap();
        fs::write(folder.path().join("outside.bin"), [1]).unwrap();
        fs::write(inner.join("a b/c.bin"), [7, 8]).unwrap();
        assert_eq!(load("./a%20b//c.bin", 2, Some(&inner)).unwrap().get(0), Some(&[7, 8][..]));
        for uri in [
            "../outside.bin",
            "a%20b/../../outside.bin",
            "%2e%2e/outside.bin",
            "..\\outside.bin",
            "/etc/passwd",
            "file:///etc/passwd",
            "http://example.org/a.bin",
            "C:/a.bin",
            "",
            ".",
            "a%2",
            "%ff",
            "a%00b",
            "missing.bin",
            "a b",
        ] {
            let error = load(uri, 1, Some(&inner)).err().unwrap();
            assert!(
                matches!(error, MeshError::Reference { place: Place::Item("buffer", 0), .. }),
                "{uri}: {error}"
            );
        }
        assert!(matches!(load("c.bin", 2, None).err().unwrap(), MeshError::Reference { .. }));
        let error = load("a%20b/c.bin", 3, Some(&inner)).err().unwrap();
        assert!(matches!(error, MeshError::Truncated { expected: 3, found: 2, .. }));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_inside_the_folder_only() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        fs::create_dir_all(inner.join("below")).unwrap();
        fs::write(folder.path().join("outside.bin"), [1]).unwrap();
        fs::write(inner.join("below/c.bin"), [7]).unwrap();
        symlink("below/c.bin", inner.join("good.bin")).unwrap();
        symlink("../outside.bin", inner.join("bad.bin")).unwrap();
        symlink("..", inner.join("up")).unwrap();
        // The folder itself may be reached by a link.
        symlink(&inner, folder.path().join("door")).unwrap();
        for folder in [&inner, &folder.path().join("door")] {
            assert_eq!(load("good.bin", 1, Some(folder)).unwrap().get(0), Some(&[7][..]));
            for uri in ["bad.bin", "up/outside.bin", "below"] {
                let error = load(uri, 1, Some(folder)).err().unwrap();
                assert!(matches!(error, MeshError::Reference { .. }), "{uri}: {error}");
            }
        }
    }

    #[test]
    fn a_file_named_by_many_buffers_is_held_once() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.bin"), [0; 100]).unwrap();
        let buffer = |uri: &str| Buffer { uri: Some(uri.into()), byte_length: 100 };
        let buffers = [buffer("a.bin"), buffer("./a.bin"), buffer("%61.bin")];
        assert_eq!(Buffers::load(&buffers, None, Some(folder.path())).unwrap().n_bytes(), 100);
    }
}
