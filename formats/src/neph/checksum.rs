//! Checksums: XXH3, 64 bits, over the head as a whole and over the body in chunks.

use super::Header;
use xxhash_rust::xxh3::{Xxh3Default, xxh3_64};

/// Checksum of one piece of the file.
pub fn checksum(bytes: &[u8]) -> u64 {
    xxh3_64(bytes)
}

/// Checksum of a header, its own checksum field taken as zero, and the directory that follows it.
pub fn head_checksum(header: &Header, directory: &[u8]) -> u64 {
    let mut hasher = Xxh3Default::new();
    hasher.update(bytemuck::bytes_of(&Header { head_checksum: 0, ..*header }));
    hasher.update(directory);
    hasher.digest()
}

/// Hashes a stream that comes in pieces of any length, and gives one checksum per chunk.
pub struct ChunkHasher {
    hasher: Xxh3Default,
    chunk_bytes: u64,
    filled_bytes: u64,
    checksums: Vec<u64>,
}

impl ChunkHasher {
    /// A hasher for chunks of `chunk_bytes`, at least 1.
    pub fn new(chunk_bytes: u64) -> Self {
        Self {
            hasher: Xxh3Default::new(),
            chunk_bytes: chunk_bytes.max(1),
            filled_bytes: 0,
            checksums: Vec::new(),
        }
    }

    /// Takes the next piece of the stream.
    pub fn update(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let space = self.chunk_bytes - self.filled_bytes;
            let taken = usize::try_from(space).map_or(bytes.len(), |space| space.min(bytes.len()));
            let (head, tail) = bytes.split_at(taken);
            self.hasher.update(head);
            self.filled_bytes += taken as u64;
            if self.filled_bytes == self.chunk_bytes {
                self.close_chunk();
            }
            bytes = tail;
        }
    }

    /// Checksums of all chunks, the last one possibly short.
    pub fn finish(mut self) -> Vec<u64> {
        if self.filled_bytes > 0 {
            self.close_chunk();
        }
        self.checksums
    }

    fn close_chunk(&mut self) {
        self.checksums.push(self.hasher.digest());
        self.hasher.reset();
        self.filled_bytes = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_any_length_give_the_checksums_of_the_chunks() {
        let bytes: Vec<u8> = (0..1000u32).map(|i| (i * 7 % 251) as u8).collect();
        let expected: Vec<u64> = bytes.chunks(64).map(checksum).collect();
        for piece in [1, 3, 63, 64, 65, 128, 1000] {
            let mut hasher = ChunkHasher::new(64);
            bytes.chunks(piece).for_each(|part| hasher.update(part));
            assert_eq!(hasher.finish(), expected, "pieces of {piece}");
        }
        assert!(ChunkHasher::new(64).finish().is_empty());
    }
}
