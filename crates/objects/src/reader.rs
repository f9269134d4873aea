//! Reads an object like a file, and fails if the object changes meanwhile.

use std::io::{self, Read, Seek, SeekFrom};

use bytes::Bytes;

use crate::{Bucket, ObjectError, ObjectInfo};

/// The number of bytes per request.
const BLOCK_BYTES: u64 = 4 << 20;

/// An object that is read like a file. Reading fails if the object changes meanwhile.
#[derive(Debug)]
pub struct ObjectReader {
    bucket: Bucket,
    found: ObjectInfo,
    position: u64,
    /// The last block, with its offset.
    block: (u64, Bytes),
}

impl ObjectReader {
    /// Opens the object of this key, which must exist and have this `ETag` if one is given.
    ///
    /// # Errors
    /// [`ObjectError::Missing`]; [`ObjectError::Changed`]; see [`ObjectError`].
    pub fn open(bucket: Bucket, key: &str, etag: Option<&str>) -> Result<Self, ObjectError> {
        let found = bucket.find(key)?.ok_or_else(|| bucket.missing(key))?;
        if etag.is_some() && found.etag.is_some() && etag != found.etag.as_deref() {
            return Err(ObjectError::Changed { name: bucket.address(key).to_string() });
        }
        Ok(Self { bucket, found, position: 0, block: (0, Bytes::new()) })
    }
}

impl Read for ObjectReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let ObjectInfo { key, length, etag } = &self.found;
        if buffer.is_empty() || self.position >= *length {
            return Ok(0);
        }
        let (from, block) = &self.block;
        let is_inside = self.position >= *from && self.position < from + block.len() as u64;
        if !is_inside {
            let end = length.min(&(self.position + BLOCK_BYTES)).to_owned();
            let block = self.bucket.read(key, etag.as_deref(), self.position..end)?;
            self.block = (self.position, block);
        }
        let (from, block) = &self.block;
        let inside = &block[(self.position - from) as usize..];
        let count = inside.len().min(buffer.len());
        buffer[..count].copy_from_slice(&inside[..count]);
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for ObjectReader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let before = || io::Error::new(io::ErrorKind::InvalidInput, "a position before the start");
        self.position = match to {
            SeekFrom::Start(position) => position,
            SeekFrom::Current(by) => self.position.checked_add_signed(by).ok_or_else(before)?,
            SeekFrom::End(by) => self.found.length.checked_add_signed(by).ok_or_else(before)?,
        };
        Ok(self.position)
    }
}
