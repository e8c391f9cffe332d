//! GLB: a header and chunks, of which the first holds the JSON and the second the first buffer.

use crate::files::error::{MeshError, Place};

/// The chunks of a file; a file that is not GLB is all JSON.
pub(crate) struct Container<'a> {
    pub json: &'a [u8],
    pub binary: Option<&'a [u8]>,
    /// Bytes after the end that the header states.
    pub n_trailing_bytes: u64,
}

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const JSON_CHUNK: &[u8] = b"JSON";
const BINARY_CHUNK: &[u8] = b"BIN\0";

impl<'a> Container<'a> {
    /// Finds the chunks. Allocates nothing.
    ///
    /// # Errors
    ///
    /// [`MeshError::Truncated`] where a length reaches beyond what holds it,
    /// [`MeshError::Unsupported`] for another version, [`MeshError::Missing`] without JSON.
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, MeshError> {
        if !bytes.starts_with(MAGIC) {
            let json = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            return Ok(Self { json, binary: None, n_trailing_bytes: 0 });
        }
        let found = bytes.len() as u64;
        let truncated =
            |expected| MeshError::Truncated { place: Place::Byte(0), what: "GLB file", expected, found };
        let (Some(version), Some(length)) = (number_at(bytes, 4), number_at(bytes, 8)) else {
            return Err(truncated(HEADER_BYTES as u64));
        };
        if version != 2 {
            return Err(MeshError::Unsupported {
                place: Place::Byte(4),
                feature: format!("GLB version {version}"),
            });
        }
        let stated = usize::try_from(length).unwrap_or(usize::MAX);
        if stated < HEADER_BYTES || stated > bytes.len() {
            return Err(truncated(u64::from(length).max(HEADER_BYTES as u64 + 8)));
        }
        let mut rest = &bytes[HEADER_BYTES..stated];
        let (mut json, mut binary) = (None, None);
        while !rest.is_empty() {
            let at = stated - rest.len();
            let (kind, chunk, next) = split_chunk(rest).ok_or(MeshError::Truncated {
                place: Place::byte(at),
                what: "GLB chunk",
                expected: 8 + number_at(rest, 0).map_or(0, u64::from),
                found: rest.len() as u64,
            })?;
            match kind {
                JSON_CHUNK if json.is_none() => json = Some(chunk),
                BINARY_CHUNK if binary.is_none() => binary = Some(chunk),
                _ => {}
            }
            rest = next;
        }
        let json = json.ok_or(MeshError::Missing { place: Place::File, what: "JSON chunk" })?;
        Ok(Self { json, binary, n_trailing_bytes: (bytes.len() - stated) as u64 })
    }
}

/// The type, contents and rest after the chunk at the beginning.
fn split_chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let length = usize::try_from(number_at(bytes, 0)?).ok()?;
    let contents = bytes.get(8..)?;
    Some((&bytes[4..8], contents.get(..length)?, &contents[length..]))
}

fn number_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(length: u32, chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend(length.to_le_bytes());
        for (kind, contents) in chunks {
            bytes.extend(u32::try_from(contents.len()).unwrap().to_le_bytes());
            bytes.extend(*kind);
            bytes.extend(*contents);
        }
        bytes
    }

    #[test]
    fn chunks_are_found_and_unknown_ones_passed() {
        let bytes = file(12 + 3 * 8 + 12, &[(b"JSON", b"{}  "), (b"ABCD", b"1234"), (b"BIN\0", b"5678")]);
        let container = Container::open(&bytes).unwrap();
        assert_eq!((container.json, container.binary), (&b"{}  "[..], Some(&b"5678"[..])));
    }

    #[test]
    fn lengths_are_checked() {
        for length in [0, 11, 24, u32::MAX] {
            let error = Container::open(&file(length, &[(b"JSON", b"{}")])).err().unwrap();
            assert!(matches!(error, MeshError::Truncated { what: "GLB file", .. }), "{length}: {error}");
        }
        assert!(matches!(Container::open(&file(12, &[])).err().unwrap(), MeshError::Missing { .. }));
        let mut bytes = file(22, &[(b"JSON", b"{}")]);
        bytes[12] = 3;
        let error = Container::open(&bytes).err().unwrap();
        assert!(
            matches!(error, MeshError::Truncated { what: "GLB chunk", expected: 11, found: 10, .. }),
            "{error}"
        );
        bytes[12] = 2;
        bytes.push(7);
        assert_eq!(Container::open(&bytes).unwrap().n_trailing_bytes, 1);
        bytes[4] = 1;
        assert!(matches!(Container::open(&bytes).err().unwrap(), MeshError::Unsupported { .. }));
    }
}
