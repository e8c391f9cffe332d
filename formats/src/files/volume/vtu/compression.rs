//! Blocks of compressed data, by any of VTK's compressors.
//!
//! LZ4 blocks have no frame. An LZMA block is an `.xz` file of one stream with one block; its
//! container is read here, because the dictionary that it asks for has nothing to do with the size
//! of the data.
//!
//! Reference: L. Collin, "The .xz file format", version 1.2.1 (2024), sections 2 and 3.

use std::io::Read;

use flate2::Crc;
use flate2::read::ZlibDecoder;
use lzma_rust2::Lzma2Reader;

/// How blocks are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
    Lzma,
}

impl Compressor {
    /// The compressor of a VTK class.
    pub(super) fn from_class(name: &str) -> Option<Self> {
        match name {
            "vtkZLibDataCompressor" => Some(Self::Zlib),
            "vtkLZ4DataCompressor" => Some(Self::Lz4),
            "vtkLZMADataCompressor" => Some(Self::Lzma),
            _ => None,
        }
    }

    /// No compressor makes more than so many bytes of one.
    pub(super) fn max_inflation(self) -> u64 {
        match self {
            Self::Zlib => 1032,
            Self::Lz4 => 255,
            Self::Lzma => 8192,
        }
    }

    /// Appends the data of a block, at most `expected` bytes and one more, which `max_inflation`
    /// allows.
    ///
    /// # Errors
    ///
    /// What is wrong with the block.
    pub(super) fn decompress(self, block: &[u8], expected: usize, data: &mut Vec<u8>) -> Result<(), String> {
        let before = data.len();
        match self {
            Self::Zlib => {
                let mut decoder = ZlibDecoder::new(block).take(expected as u64);
                decoder.read_to_end(data).map(drop).map_err(|error| format!("zlib data: {error}"))
            }
            Self::Lz4 => {
                data.resize(before + expected, 0);
                let n = lz4_flex::block::decompress_into(block, &mut data[before..]);
                data.truncate(before + n.as_ref().unwrap_or(&0));
                n.map(drop).map_err(|error| format!("LZ4 data: {error}"))
            }
            Self::Lzma => decompress_xz(block, expected, data).map_err(|error| format!("xz data: {error}")),
        }
    }
}

/// Appends the data of an `.xz` file of one block and compares the checksum if it is a CRC32.
fn decompress_xz(bytes: &[u8], expected: usize, data: &mut Vec<u8>) -> Result<(), String> {
    const MAGIC: &[u8] = b"\xFD7zXZ\0";
    const HEADER_BYTES: usize = 12;
    const CRC32: u8 = 1;
    let block = bytes.get(HEADER_BYTES..).filter(|_| bytes.starts_with(MAGIC));
    let block = block.ok_or("its header is missing")?;
    let head = block_header(block)?;
    let mut rest = &block[head.n_bytes..];
    let before = data.len();
    // Nothing refers back over more than all of the data.
    let dictionary = head.dictionary_bytes.min(u32::try_from(expected).unwrap_or(u32::MAX)).max(1);
    let mut decoder = Lzma2Reader::new(&mut rest, dictionary, None).take(expected as u64 + 1);
    decoder.read_to_end(data).map_err(|error| error.to_string())?;
    let n_read = block.len() - rest.len();
    let stated = block.get(n_read.next_multiple_of(4)..).and_then(<[u8]>::first_chunk);
    if bytes[7] == CRC32 {
        let mut crc = Crc::new();
        crc.update(&data[before..]);
        if stated.is_none_or(|stated| u32::from_le_bytes(*stated) != crc.sum()) {
            return Err("the checksum differs".to_owned());
        }
    }
    Ok(())
}

/// What the header of a block of an `.xz` file says.
struct BlockHeader {
    n_bytes: usize,
    dictionary_bytes: u32,
}

/// Reads the header of a block that has the one filter LZMA2.
fn block_header(block: &[u8]) -> Result<BlockHeader, String> {
    const LZMA2: u64 = 0x21;
    let n_bytes = block.first().map_or(0, |&size| 4 * (usize::from(size) + 1));
    let header = block.get(..n_bytes).filter(|header| header.len() > 8).ok_or("a header is cut short")?;
    let flags = header[1];
    if flags & 0x3F != 0 {
        return Err("there are more filters than LZMA2".to_owned());
    }
    let mut fields = &header[2..];
    for has_size in [flags & 0x40 != 0, flags & 0x80 != 0] {
        if has_size {
            variable_integer(&mut fields)?;
        }
    }
    let filter = [variable_integer(&mut fields)?, variable_integer(&mut fields)?];
    let bits = fields.first().filter(|_| filter == [LZMA2, 1]).ok_or("the filter is not LZMA2")?;
    let dictionary_bytes = match bits & 0x3F {
        40.. => u32::MAX,
        bits => (2 | u32::from(bits & 1)) << (bits / 2 + 11),
    };
    Ok(BlockHeader { n_bytes, dictionary_bytes })
}

/// An integer of seven bits a byte, lowest first.
fn variable_integer(bytes: &mut &[u8]) -> Result<u64, String> {
    let mut value = 0;
    for shift in (0..63).step_by(7) {
        let (&byte, rest) = bytes.split_first().ok_or("a header is cut short")?;
        *bytes = rest;
        value |= u64::from(byte & 0x7F) << shift;
        if byte < 0x80 {
            return Ok(value);
        }
    }
    Err("a number has too many bytes".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes 0 to 99, ten times, as `xz` writes them with a CRC32.
    const XZ: &[u8] = include_bytes!("../../../../tests/samples/counted.xz");
    /// The same as an LZ4 block.
    fn lz4() -> Vec<u8> {
        [&[0xFF, 85], &counted()[..100], &[100, 0, 255, 255, 255, 111, 0x50, 95, 96, 97, 98, 99]].concat()
    }

    fn counted() -> Vec<u8> {
        (0..10).flat_map(|_| 0..100).collect()
    }

    fn decompressed(compressor: Compressor, block: &[u8], expected: usize) -> Result<Vec<u8>, String> {
        let mut data = vec![7];
        compressor.decompress(block, expected, &mut data)?;
        assert_eq!(data.remove(0), 7);
        Ok(data)
    }

    #[test]
    fn blocks_of_every_compressor_are_read() {
        assert_eq!(decompressed(Compressor::Lzma, XZ, 1000).unwrap(), counted());
        assert_eq!(decompressed(Compressor::Lz4, &lz4(), 1000).unwrap(), counted());
        // More data than there should be is an error or one byte more, which the caller sees.
        assert!(decompressed(Compressor::Lzma, XZ, 900).is_err());
        assert!(decompressed(Compressor::Lz4, &lz4(), 999).is_err());
    }

    #[test]
    fn damaged_blocks_end_in_an_error_or_the_same_data() {
        // The index and the footer behind the block are not looked at.
        let n_needed = XZ.len() - 28;
        for end in 0..n_needed {
            assert!(decompressed(Compressor::Lzma, &XZ[..end], 1000).is_err(), "{end}");
        }
        for at in 0..n_needed {
            for flipped in [1, 0x80, 0xFF] {
                let mut block = XZ.to_vec();
                block[at] ^= flipped;
                let data = decompressed(Compressor::Lzma, &block, 1000);
                // Byte 7 says which checksum there is.
                assert!(at == 7 || data.is_err() || data.unwrap() == counted(), "{at}");
                let mut block = lz4();
                if let Some(byte) = block.get_mut(at) {
                    *byte ^= flipped;
                    let _ = decompressed(Compressor::Lz4, &block, 1000);
                }
            }
        }
    }
}
