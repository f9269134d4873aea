//! A sealed part of a store that lies in object storage.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_store::{PartFile, StoreError};

use crate::{BlockCache, Bucket, Found};

/// A sealed part that is an object.
#[derive(Debug)]
pub(crate) struct ObjectPart {
    bucket: Bucket,
    found: Found,
    /// Its address, where others have a path.
    path: PathBuf,
    blocks: Arc<BlockCache>,
    number: u64,
}

impl ObjectPart {
    pub(crate) fn new(bucket: Bucket, found: Found, blocks: Arc<BlockCache>) -> Self {
        let path = bucket.address(&found.key).to_string().into();
        let number = blocks.new_file();
        Self { bucket, found, path, blocks, number }
    }

    /// Fails where bytes are asked for that it does not have: someone replaced it, or its list is wrong.
    fn check_inside(&self, length: usize, offset: u64) -> Result<(), StoreError> {
        if offset.checked_add(length as u64).is_some_and(|end| end <= self.found.length) {
            return Ok(());
        }
        let what = format!("bytes beyond its {} are wanted", self.found.length);
        Err(StoreError::Damaged { path: self.path.clone(), what })
    }
}

impl PartFile for ObjectPart {
    fn path(&self) -> &Path {
        &self.path
    }

    fn length(&self) -> Result<u64, StoreError> {
        Ok(self.found.length)
    }

    fn read_exact_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.check_inside(bytes.len(), offset)?;
        let Found { key, length, etag } = &self.found;
        let fetch = |range| self.bucket.read(key, etag.as_deref(), range);
        Ok(self.blocks.read((self.number, *length), bytes, offset, fetch)?)
    }

    fn read_alone_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.check_inside(bytes.len(), offset)?;
        let Found { key, etag, .. } = &self.found;
        let range = offset..offset + bytes.len() as u64;
        bytes.copy_from_slice(&self.bucket.read(key, etag.as_deref(), range)?);
        Ok(())
    }
}
