//! Streaming the body of a file: padding, gathering of small records, checksums.

use bytemuck::Pod;
use nephrite_formats::neph::{CHUNK_BYTES, ChunkHasher};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

/// Records gathered before they are written.
const GATHER_LEN: usize = 1 << 14;
/// Bytes of the write buffer.
const BUFFER_BYTES: usize = 1 << 18;

/// Writes the body and takes its checksums on the way.
pub(super) struct BodyWriter<W: Write> {
    stream: BufWriter<W>,
    hasher: ChunkHasher,
    /// Bytes from the start of the file.
    position: u64,
}

impl<W: Write + Seek> BodyWriter<W> {
    /// Leaves room for the head.
    pub(super) fn begin(mut stream: W, body_start: u64) -> io::Result<Self> {
        stream.seek(SeekFrom::Start(body_start))?;
        let stream = BufWriter::with_capacity(BUFFER_BYTES, stream);
        Ok(Self { stream, hasher: ChunkHasher::new(CHUNK_BYTES), position: body_start })
    }
}

impl<W: Write> BodyWriter<W> {
    pub(super) fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.position += bytes.len() as u64;
        self.stream.write_all(bytes)
    }

    pub(super) fn put_each<T: Pod>(&mut self, records: impl Iterator<Item = T>) -> io::Result<()> {
        let mut gathered = Vec::with_capacity(GATHER_LEN);
        for record in records {
            gathered.push(record);
            if gathered.len() == GATHER_LEN {
                self.put(bytemuck::cast_slice(&gathered))?;
                gathered.clear();
            }
        }
        self.put(bytemuck::cast_slice(&gathered))
    }

    /// Bytes from the start of the file that are written.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// Zeros up to `offset`, less than a section alignment away.
    pub(super) fn pad_to(&mut self, offset: u64) -> io::Result<()> {
        let zeros = [0; 64];
        let missing = usize::try_from(offset - self.position).unwrap_or(0).min(zeros.len());
        self.put(&zeros[..missing])
    }

    /// Flushes and gives the checksum of each chunk.
    pub(super) fn finish(mut self) -> io::Result<Vec<u64>> {
        self.stream.flush()?;
        Ok(self.hasher.finish())
    }
}
