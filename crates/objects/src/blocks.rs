//! A cache of blocks: what is read in small pieces comes in large ones.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use bytes::Bytes;

/// Which block of which object.
type BlockId = (u64, u64);
/// The bytes of a block, once they are there. Who fetches them holds the lock, so that nobody fetches them twice.
type Filling = Arc<Mutex<Option<Bytes>>>;

/// Blocks of objects, those that were used last, within a limit of memory. What is being fetched comes on top: one block for each thread.
#[derive(Debug)]
pub struct BlockCache {
    block_bytes: u64,
    limit_bytes: u64,
    kept: Mutex<Kept>,
}

#[derive(Debug, Default)]
struct Kept {
    /// The blocks, with the time of last use and the bytes that are counted for it.
    blocks: HashMap<BlockId, (u64, u64, Filling)>,
    bytes: u64,
    clock: u64,
    next_object: u64,
}

/// Blocks are no larger: an answer takes longer then, and more of it is never looked at.
const LARGEST_BLOCK_BYTES: u64 = 4 << 20;
/// Blocks are no smaller: each request costs as much as some hundred kilobytes.
const SMALLEST_BLOCK_BYTES: u64 = 256 << 10;
/// So many blocks fit, if they need not be smaller than the smallest for that.
const BLOCKS: u64 = 16;

impl BlockCache {
    /// A cache that takes at most `limit_bytes`, in blocks of 256 KiB to 4 MiB.
    #[must_use]
    pub fn new(limit_bytes: u64) -> Self {
        let block_bytes = (limit_bytes / BLOCKS).clamp(SMALLEST_BLOCK_BYTES, LARGEST_BLOCK_BYTES);
        Self { block_bytes, limit_bytes, kept: Mutex::default() }
    }

    /// Bytes of a block. The last one of an object may have fewer.
    pub(crate) fn block_bytes(&self) -> u64 {
        self.block_bytes
    }

    /// A number for an object, by which its blocks are told from those of others.
    pub(crate) fn new_object(&self) -> u64 {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.next_object += 1;
        kept.next_object
    }

    /// A block: from the cache, else from `fetch`.
    pub(crate) fn get<E>(
        &self,
        id: BlockId,
        fetch: impl FnOnce() -> Result<Bytes, E>,
    ) -> Result<Bytes, E> {
        let filling = {
            let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.clock += 1;
            let now = kept.clock;
            let (used, _, filling) = kept.blocks.entry(id).or_default();
            *used = now;
            Arc::clone(filling)
        };
        let mut bytes = filling.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bytes) = &*bytes {
            return Ok(bytes.clone());
        }
        let fetched = fetch()?;
        *bytes = Some(fetched.clone());
        drop(bytes);
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).count(
            id,
            fetched.len() as u64,
            self.limit_bytes,
        );
        Ok(fetched)
    }
}

impl Kept {
    /// Counts a block that was fetched, and gives up those that were used longest ago.
    fn count(&mut self, id: BlockId, bytes: u64, limit_bytes: u64) {
        if let Some((_, counted, _)) = self.blocks.get_mut(&id) {
            self.bytes += bytes - *counted;
            *counted = bytes;
        }
        while self.bytes > limit_bytes {
            let others =
                self.blocks.iter().filter(|&(&other, (_, bytes, _))| other != id && *bytes > 0);
            let oldest = others.min_by_key(|(_, (used, ..))| *used).map(|(&other, _)| other);
            let Some((_, bytes, _)) = oldest.and_then(|oldest| self.blocks.remove(&oldest)) else {
                return;
            };
            self.bytes -= bytes;
        }
    }
}

#[cfg(test)]
#[path = "blocks_tests.rs"]
mod tests;
