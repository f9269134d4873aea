//! Writes a file without a gap between the root directory and the metadata.
//!
//! The crate pmtiles reserves the first 16 384 bytes for header and root directory, because it
//! writes them last. A package of a hundred tiles needs 2 % of them. Here everything that the crate
//! writes behind those bytes is moved towards the front:
//!
//! ```text
//! the writer's places   ├ header ┤ root ┤ zeros ............ 16384 ┤ metadata ┤ tiles …
//! places in the file    ├ header ┤ root ┤ kept ┤ metadata ┤ tiles …
//! ```

use std::io::{self, Seek, SeekFrom, Write};

use crate::package::header::{HEADER_BYTES, INITIAL_BYTES};

/// Positions in the header that hold offsets of parts behind the root directory: metadata, leaf
/// directories, data.
const OFFSETS: [usize; 3] = [24, 40, 56];

/// The largest number of bytes of a tile in the root directory, compressed or not: four numbers of
/// at most ten bytes.
const ENTRY_BYTES: usize = 40;
/// The largest number of additional bytes of a gzip frame: its head, its end, and a 2000th of
/// content that cannot be compressed.
const FRAME_BYTES: usize = 128;

/// Writes to `out` as to a file that begins with [`INITIAL_BYTES`] for header and root directory,
/// but reserves fewer bytes.
#[derive(Debug)]
pub(crate) struct CloseUp<W> {
    out: W,
    /// The position of the PMTiles writer.
    at: u64,
    /// The position in `out`.
    out_at: Option<u64>,
    /// Whether the zeros at the beginning have been passed: bytes written there now belong to
    /// header and root directory.
    is_past_zeros: bool,
    header: [u8; HEADER_BYTES],
    /// The number of bytes by which parts move towards the front.
    shift: u64,
}

impl<W: Write + Seek> CloseUp<W> {
    /// Begins a file of at most `tiles` tiles at the start of `out`.
    pub(crate) fn new(out: W, tiles: usize) -> Self {
        let root = tiles.saturating_mul(ENTRY_BYTES).saturating_add(FRAME_BYTES);
        let shift = (INITIAL_BYTES - HEADER_BYTES).saturating_sub(root) as u64;
        Self { out, at: 0, out_at: None, is_past_zeros: false, header: [0; HEADER_BYTES], shift }
    }

    /// The end of the space that is reserved for header and root directory in the file.
    fn kept(&self) -> u64 {
        INITIAL_BYTES as u64 - self.shift
    }

    /// Adds a part of the header to the parts that are there, and writes the header to the file.
    fn write_header(&mut self, part: &[u8]) -> io::Result<()> {
        let from = self.at as usize;
        self.header[from..from + part.len()].copy_from_slice(part);
        let mut header = self.header;
        for place in OFFSETS {
            let (_, rest) = header.split_at_mut(place);
            if let Some(offset) = rest.first_chunk_mut::<8>() {
                let told = u64::from_le_bytes(*offset);
                if told >= INITIAL_BYTES as u64 {
                    *offset = (told - self.shift).to_le_bytes();
                }
            }
        }
        self.go_to(0)?;
        self.out_at = None;
        self.out.write_all(&header)
    }

    fn go_to(&mut self, place: u64) -> io::Result<()> {
        if self.out_at != Some(place) {
            self.out_at = None;
            self.out.seek(SeekFrom::Start(place))?;
            self.out_at = Some(place);
        }
        Ok(())
    }

    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<usize> {
        self.go_to(place)?;
        self.out_at = None;
        let length = self.out.write(bytes)?;
        self.out_at = Some(place + length as u64);
        Ok(length)
    }
}

impl<W: Write + Seek> Write for CloseUp<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let until = |end: u64| bytes.len().min((end - self.at) as usize);
        let length = if self.at < HEADER_BYTES as u64 {
            let length = until(HEADER_BYTES as u64);
            self.write_header(&bytes[..length])?;
            length
        } else if self.at < self.kept() {
            self.write_at(self.at, &bytes[..until(self.kept())])?
        } else if self.at < INITIAL_BYTES as u64 {
            // These zeros are omitted. A root directory extends to here only if there are more
            // tiles than were announced.
            if self.is_past_zeros {
                return Err(io::Error::other("the root directory has more tiles than announced"));
            }
            until(INITIAL_BYTES as u64)
        } else {
            self.write_at(self.at - self.shift, bytes)?
        };
        self.at += length as u64;
        self.is_past_zeros |= self.at >= INITIAL_BYTES as u64;
        Ok(length)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl<W: Write + Seek> Seek for CloseUp<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
            SeekFrom::End(by) => {
                self.out_at = None;
                let end = self.out.seek(SeekFrom::End(0))? + self.shift;
                end.checked_add_signed(by)
            }
        };
        self.at = place.ok_or(io::ErrorKind::InvalidInput)?;
        Ok(self.at)
    }
}

#[cfg(test)]
#[path = "close_up_tests.rs"]
mod tests;
