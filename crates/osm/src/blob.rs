//! One blob: parsed, unpacked within its limit, and passed to the decoder.
//!
//! The decoder could read blobs itself. However, if a compressed block is truncated or too large,
//! the decoder uses the first part without an error.

use std::io::Read;

use osmpbf::BlobReader;
use zlib_rs::{Inflate, InflateFlush, Status};

use crate::wire::{self, WireError, push_varint};

/// A blob header must be smaller than this.
///
/// Both limits come from the OSM wiki, *PBF Format*, "File format".
pub(crate) const MAX_BLOB_HEADER_BYTES: u64 = 64 << 10;
/// A blob may be at most this large. Unpacked, it must be smaller than this.
pub(crate) const MAX_BLOB_BYTES: u64 = 32 << 20;

/// The reason why a blob is rejected.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum BlobRefusal {
    Damaged(String),
    /// The blob is compressed with this method, which is not supported.
    Compression(&'static str),
}

impl From<WireError> for BlobRefusal {
    fn from(reason: WireError) -> Self {
        Self::Damaged(reason.to_owned())
    }
}

/// The contents of a blob header.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct BlobHeader {
    pub(crate) kind: String,
    pub(crate) blob_bytes: u64,
}

impl BlobHeader {
    /// Parses the message `BlobHeader` (`fileformat.proto`).
    pub(crate) fn parse(message: &[u8]) -> Result<Self, BlobRefusal> {
        let (mut kind, mut size) = (None, None);
        for field in wire::fields(message) {
            let field = field?;
            match field.number {
                1 => kind = Some(field.value.bytes()?),
                3 => size = Some(field.value.varint()?.cast_signed()),
                _ => {}
            }
        }
        let kind = kind.ok_or("the blob header has no type")?;
        let kind =
            str::from_utf8(kind).map_err(|_| "the type in the blob header is not valid UTF-8")?;
        let size = size.ok_or("the blob header has no size")?;
        match u64::try_from(size) {
            Ok(blob_bytes) if blob_bytes <= MAX_BLOB_BYTES => {
                Ok(Self { kind: kind.to_owned(), blob_bytes })
            }
            _ => Err(BlobRefusal::Damaged(format!("the blob claims to be {size} bytes long"))),
        }
    }
}

/// Unpacks the block in a blob (message `Blob`). The block must be smaller than `limit_bytes`.
pub(crate) fn unpack(blob: &[u8], limit_bytes: u64) -> Result<Vec<u8>, BlobRefusal> {
    let (mut data, mut promised) = (None, None);
    for field in wire::fields(blob) {
        let field = field?;
        match field.number {
            1 | 3..=7 => {
                let earlier = data.replace((field.number, field.value.bytes()?));
                if earlier.is_some() {
                    return Err(BlobRefusal::Damaged("the blob contains its data twice".into()));
                }
            }
            2 => promised = Some(field.value.varint()?.cast_signed()),
            _ => {}
        }
    }
    let (method, data) = data.ok_or("the blob contains no data")?;
    let too_large = |size: i64| {
        let reason =
            format!("the unpacked blob is {size} bytes long; the limit is {}", limit_bytes - 1);
        Err(BlobRefusal::Damaged(reason))
    };
    let limit = limit_bytes.cast_signed();
    if let Some(promised) = promised.filter(|promised| !(0..limit).contains(promised)) {
        return too_large(promised);
    }
    let block = match method {
        1 if data.len() as u64 >= limit_bytes => return too_large(data.len() as i64),
        1 => data.to_vec(),
        3 => inflate(data, promised.unwrap_or(limit - 1) as usize)?,
        4 => return Err(BlobRefusal::Compression("LZMA")),
        5 => return Err(BlobRefusal::Compression("bzip2")),
        6 => return Err(BlobRefusal::Compression("LZ4")),
        _ => return Err(BlobRefusal::Compression("zstd")),
    };
    match promised {
        Some(promised) if promised != block.len() as i64 => Err(BlobRefusal::Damaged(format!(
            "the blob promises {promised} bytes but unpacks to {}",
            block.len()
        ))),
        _ => Ok(block),
    }
}

/// Unpacks a complete zlib stream of at most `most_bytes`. Its checksum must be right, and nothing
/// may follow it.
fn inflate(packed: &[u8], most_bytes: usize) -> Result<Vec<u8>, BlobRefusal> {
    /// Deflate unpacks one byte to at most 1032 bytes (zlib, *Technical Details*), so a buffer of
    /// this size always suffices.
    const MOST_GROWTH: usize = 1032;
    /// The largest window of a zlib stream: 2^15 bytes.
    const LARGEST_WINDOW: u8 = 15;
    let damaged = |reason: &str| Err(BlobRefusal::Damaged(reason.to_owned()));
    // One byte more than allowed, so that a stream that is too long is noticed.
    let room = most_bytes.min(packed.len().saturating_mul(MOST_GROWTH)) + 1;
    let mut block = vec![0; room];
    let mut stream = Inflate::new(true, LARGEST_WINDOW);
    loop {
        let before = (stream.total_in(), stream.total_out());
        let (rest, room) = (&packed[before.0 as usize..], &mut block[before.1 as usize..]);
        let status = stream.decompress(rest, room, InflateFlush::Finish);
        let unpacked = stream.total_out() as usize;
        match status {
            Ok(Status::StreamEnd) if stream.total_in() < packed.len() as u64 => {
                return damaged("the compressed data continues after its end");
            }
            Ok(Status::StreamEnd) if unpacked <= most_bytes => {
                block.truncate(unpacked);
                return Ok(block);
            }
            Ok(_) if unpacked > most_bytes => {
                return damaged(&format!("the blob unpacks to more than {most_bytes} bytes"));
            }
            Ok(_) if (stream.total_in(), stream.total_out()) == before => {
                return damaged("the compressed data is truncated");
            }
            Ok(_) => {}
            Err(_) => {
                return damaged(
                    "the compressed data is not a valid zlib stream, or its checksum is wrong",
                );
            }
        }
    }
}

/// Passes a block to the decoder as a raw blob.
pub(crate) fn decoder_blob(kind: &str, block: &[u8]) -> Result<osmpbf::Blob, osmpbf::Error> {
    let mut raw = vec![0x0a];
    push_varint(&mut raw, block.len() as u64);
    let mut header = vec![0x0a, kind.len() as u8];
    header.extend_from_slice(kind.as_bytes());
    header.push(0x18);
    push_varint(&mut header, (raw.len() + block.len()) as u64);
    let mut start = (header.len() as u32).to_be_bytes().to_vec();
    start.append(&mut header);
    start.append(&mut raw);
    let no_blob = || std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into();
    BlobReader::new(start.chain(block)).next().unwrap_or_else(|| Err(no_blob()))
}

#[cfg(test)]
#[path = "blob_tests.rs"]
mod tests;
