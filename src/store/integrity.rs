//! Checksums of a whole file, read from beginning to end in memory of one chunk.

use super::VerifyError;
use nephrite_formats::neph::{self, Directory, SectionKind};
use std::io::{self, Read, Seek, SeekFrom};

/// Compares every chunk of the body, and the checksums themselves, with what header and checksum
/// section say.
///
/// Memory: one chunk and 8 bytes per chunk, both no longer than the file.
pub(super) fn check_integrity(
    file: &mut (impl Read + Seek),
    directory: &Directory,
) -> Result<(), VerifyError> {
    let header = directory.header();
    let (offset, bytes) = directory.section(SectionKind::Checksums);
    file.seek(SeekFrom::Start(offset))?;
    let mut checksums = Vec::new();
    read_piece(file, bytes, &mut checksums)?;
    let found = neph::checksum(&checksums);
    if found != header.checksums_checksum {
        return Err(VerifyError::Checksums { found, expected: header.checksums_checksum });
    }

    let body = directory.body();
    file.seek(SeekFrom::Start(body.start))?;
    let mut chunk_bytes = Vec::new();
    let mut left = body.end - body.start;
    for (chunk, expected) in (0..).zip(bytemuck::pod_collect_to_vec::<u8, u64>(&checksums)) {
        let bytes = left.min(header.chunk_bytes);
        left -= bytes;
        read_piece(file, bytes, &mut chunk_bytes)?;
        let found = neph::checksum(&chunk_bytes);
        if found != expected {
            return Err(VerifyError::Chunk { chunk, found, expected });
        }
    }
    Ok(())
}

/// Reads the next `bytes` bytes; memory grows with what is there, not with what is asked for.
fn read_piece(file: &mut impl Read, bytes: u64, piece: &mut Vec<u8>) -> io::Result<()> {
    piece.clear();
    if file.take(bytes).read_to_end(piece)? as u64 == bytes {
        Ok(())
    } else {
        Err(io::Error::from(io::ErrorKind::UnexpectedEof))
    }
}
