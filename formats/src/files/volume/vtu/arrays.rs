//! The data arrays of a VTU file, in any of their encodings.

use std::cell::Cell;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use roxmltree::Node;

use super::compression::Compressor;
use crate::ScalarType;
use crate::files::error::{MeshError, Place, quoted_name};
use crate::files::volume::scalars::{NumberType, Numbers, push_text};

/// How the file as a whole encodes its arrays.
pub(super) struct Encoding<'a> {
    pub is_big_endian: bool,
    /// Bytes of each length in the header of an array.
    pub header_bytes: usize,
    pub compressor: Option<Compressor>,
    /// The appended data, from behind the underscore on.
    pub appended: &'a [u8],
    /// Whether the appended data are in base64.
    pub is_appended_base64: bool,
    /// Bytes of the appended data that no array has used yet. Arrays of sound files do not overlap.
    /// Without this limit a small file could declare a thousand arrays over the same bytes.
    pub n_unused: Cell<usize>,
}

impl Encoding<'_> {
    /// The numbers of a `DataArray`.
    pub(super) fn numbers(&self, array: Node<'_, '_>) -> Result<Numbers, MeshError> {
        let element = element_of(array)?;
        let text = || array.text().unwrap_or("");
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => from_text(element, text()),
            "binary" => {
                let text: String = text().split_ascii_whitespace().collect();
                self.read_base64(element, text.as_bytes()).map(|(numbers, _)| numbers)
            }
            "appended" => {
                let offset = array.attribute("offset").and_then(|offset| offset.parse::<usize>().ok());
                let rest = offset.and_then(|offset| self.appended.get(offset..));
                let rest = rest.ok_or_else(|| cut_short("the offset of an array", self.appended.len()))?;
                let (numbers, n_used) = if self.is_appended_base64 {
                    self.read_base64(element, rest)?
                } else {
                    self.read_raw(element, rest)?
                };
                self.use_up(n_used)?;
                Ok(numbers)
            }
            other => Err(unsupported(format!("data format {}", quoted_name(other)))),
        }
    }

    /// Subtracts `n_bytes` from the appended data that no array has used.
    fn use_up(&self, n_bytes: usize) -> Result<(), MeshError> {
        let n_unused = self.n_unused.get();
        let rest = n_unused.checked_sub(n_bytes).ok_or(MeshError::CountTooLarge {
            place: Place::Part("appended data"),
            what: "bytes of arrays that overlap",
            count: n_bytes as u64,
            limit: n_unused as u64,
        })?;
        self.n_unused.set(rest);
        Ok(())
    }

    /// Reads raw bytes: a length or a table of compressed blocks, then the data. Also returns the
    /// number of bytes used.
    fn read_raw(&self, element: Element, bytes: &[u8]) -> Result<(Numbers, usize), MeshError> {
        if let Some(compressor) = self.compressor {
            let blocks = self.blocks(bytes)?;
            let head_bytes = blocks.header_bytes(self.header_bytes);
            let data = decompress(compressor, &blocks, &bytes[head_bytes..])?;
            return Ok((self.whole_numbers(element, &data)?, head_bytes + blocks.compressed_bytes()));
        }
        let length = self.length(bytes, 0)?;
        let data = bytes.get(self.header_bytes..).and_then(|data| data.get(..length));
        let data = data.ok_or_else(|| cut_short("an array", bytes.len()))?;
        Ok((self.whole_numbers(element, data)?, self.header_bytes + length))
    }

    /// Reads base64, in which a table of compressed blocks is encoded by itself and a plain length
    /// together with the data. Also returns the number of characters used.
    fn read_base64(&self, element: Element, text: &[u8]) -> Result<(Numbers, usize), MeshError> {
        let Some(compressor) = self.compressor else {
            // Another array may begin behind the padding of this one.
            let head = decode(text.get(..padded(self.header_bytes)).unwrap_or(text))?;
            let n_bytes = self.length(&head, 0)?.saturating_add(self.header_bytes);
            let text = text.get(..padded(n_bytes)).ok_or_else(|| cut_short("an array", text.len()))?;
            let (numbers, _) = self.read_raw(element, &decode(text)?)?;
            return Ok((numbers, text.len()));
        };
        let start = decode(text.get(..padded(self.header_bytes)).unwrap_or(text))?;
        let n_blocks = self.length(&start, 0)?;
        let table_bytes = n_blocks.saturating_add(3).saturating_mul(self.header_bytes);
        let table_text = padded(table_bytes);
        let table = text.get(..table_text).ok_or_else(|| cut_short("a table of blocks", text.len()))?;
        let blocks = self.blocks(&decode(table)?)?;
        let data_text = padded(blocks.compressed_bytes());
        let data = text.get(table_text..).and_then(|data| data.get(..data_text));
        let data = decode(data.ok_or_else(|| cut_short("compressed data", text.len()))?)?;
        let data = decompress(compressor, &blocks, &data)?;
        Ok((self.whole_numbers(element, &data)?, table_text + data_text))
    }

    fn whole_numbers(&self, element: Element, bytes: &[u8]) -> Result<Numbers, MeshError> {
        let Element::Number(number) = element else {
            let bits = bytes.iter().flat_map(|byte| (0..8).rev().map(move |bit| byte >> bit & 1));
            return Ok(Numbers { number: element.number(), bytes: bits.collect() });
        };
        if !bytes.len().is_multiple_of(number.size_bytes()) {
            return Err(cut_short("the last number of an array", bytes.len()));
        }
        Ok(Numbers::from_bytes(number, bytes, self.is_big_endian))
    }

    /// Length number `index` of a header.
    fn length(&self, bytes: &[u8], index: usize) -> Result<usize, MeshError> {
        let start = index * self.header_bytes;
        let bytes = bytes.get(start..start + self.header_bytes);
        let bytes = bytes.ok_or_else(|| cut_short("a length", start))?;
        let mut wide = [0; 8];
        if self.is_big_endian {
            wide[8 - bytes.len()..].copy_from_slice(bytes);
            wide.reverse();
        } else {
            wide[..bytes.len()].copy_from_slice(bytes);
        }
        let length = u64::from_le_bytes(wide);
        usize::try_from(length).map_err(|_| cut_short("an array", bytes.len()))
    }

    /// Reads the table before compressed data: the number of blocks, the length of each, the length
    /// of the last, and the compressed lengths.
    fn blocks(&self, bytes: &[u8]) -> Result<Blocks, MeshError> {
        let [n_blocks, block_bytes, last_bytes] =
            [self.length(bytes, 0)?, self.length(bytes, 1)?, self.length(bytes, 2)?];
        if n_blocks > bytes.len() / self.header_bytes {
            return Err(cut_short("a table of blocks", bytes.len()));
        }
        let compressed: Result<Vec<usize>, _> = (0..n_blocks).map(|i| self.length(bytes, 3 + i)).collect();
        let last_bytes = if last_bytes == 0 { block_bytes } else { last_bytes };
        Ok(Blocks { block_bytes, last_bytes, compressed: compressed? })
    }
}

/// Blocks of compressed data.
struct Blocks {
    block_bytes: usize,
    last_bytes: usize,
    compressed: Vec<usize>,
}

impl Blocks {
    fn header_bytes(&self, length_bytes: usize) -> usize {
        (3 + self.compressed.len()) * length_bytes
    }

    /// Compressed bytes of all blocks, as the table claims.
    fn compressed_bytes(&self) -> usize {
        self.compressed.iter().fold(0, |sum, &bytes| sum.saturating_add(bytes))
    }
}

fn decompress(compressor: Compressor, blocks: &Blocks, mut data: &[u8]) -> Result<Vec<u8>, MeshError> {
    let mut whole = Vec::new();
    for (i, &n_bytes) in blocks.compressed.iter().enumerate() {
        let is_last = i + 1 == blocks.compressed.len();
        let expected = if is_last { blocks.last_bytes } else { blocks.block_bytes };
        let block = data.get(..n_bytes).ok_or_else(|| cut_short("a compressed block", data.len()))?;
        data = &data[n_bytes..];
        if expected as u64 > (n_bytes as u64).saturating_mul(compressor.max_inflation()) {
            return Err(cut_short("a compressed block", n_bytes));
        }
        let before = whole.len();
        compressor.decompress(block, expected, &mut whole).map_err(unsupported)?;
        if whole.len() - before != expected {
            return Err(cut_short("a compressed block", whole.len() - before));
        }
    }
    Ok(whole)
}

/// What an array is made of.
#[derive(Clone, Copy)]
enum Element {
    Number(NumberType),
    /// A bit, the highest of a byte first.
    Bit,
}

impl Element {
    /// Type of the numbers that it becomes.
    fn number(self) -> NumberType {
        match self {
            Self::Number(number) => number,
            Self::Bit => NumberType::Kept(ScalarType::U8),
        }
    }
}

fn element_of(array: Node<'_, '_>) -> Result<Element, MeshError> {
    let name = array.attribute("type").unwrap_or("");
    let kept = NumberType::Kept;
    let number = match name {
        "Bit" => return Ok(Element::Bit),
        "Int8" => kept(ScalarType::I8),
        "UInt8" => kept(ScalarType::U8),
        "Int16" => kept(ScalarType::I16),
        "UInt16" => kept(ScalarType::U16),
        "Int32" => kept(ScalarType::I32),
        "UInt32" => kept(ScalarType::U32),
        "Int64" => NumberType::I64,
        "UInt64" => NumberType::U64,
        "Float32" => kept(ScalarType::F32),
        "Float64" => kept(ScalarType::F64),
        _ => return Err(unsupported(format!("data array of type {}", quoted_name(name)))),
    };
    Ok(Element::Number(number))
}

fn from_text(element: Element, text: &str) -> Result<Numbers, MeshError> {
    let number = element.number();
    let mut bytes = Vec::new();
    for word in text.split_ascii_whitespace() {
        push_text(&mut bytes, number, word.as_bytes()).ok_or_else(|| MeshError::Unexpected {
            place: Place::Part("data array"),
            expected: "a number of the array's type",
            found: crate::files::error::excerpt(word.as_bytes()),
        })?;
    }
    Ok(Numbers { number, bytes })
}

/// Characters of base64 for `n_bytes` bytes.
fn padded(n_bytes: usize) -> usize {
    n_bytes.div_ceil(3).saturating_mul(4)
}

pub(super) fn is_base64(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'/' | b'=')
}

fn decode(text: &[u8]) -> Result<Vec<u8>, MeshError> {
    STANDARD.decode(text).map_err(|error| unsupported(format!("base64: {error}")))
}

pub(super) fn unsupported(feature: String) -> MeshError {
    MeshError::Unsupported { place: Place::Part("VTU file"), feature }
}

fn cut_short(what: &'static str, found: usize) -> MeshError {
    let (place, found) = (Place::Part("data array"), found as u64);
    MeshError::Truncated { place, what, expected: found + 1, found }
}
