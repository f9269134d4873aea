//! Long lists in the store, block by block: one block of them is in memory.

use corniche_spec::artifacts::{self, ArtifactError, Kind};
use corniche_store::Artifacts;
use serde::{Serialize, de::DeserializeOwned};

/// Keeps a list in blocks of a size, which are the artifacts of a kind.
pub(crate) struct BlockWriter<'a, T> {
    store: &'a dyn Artifacts,
    kind: Kind,
    size: usize,
    blocks: u64,
    block: Vec<T>,
}

impl<'a, T: Serialize> BlockWriter<'a, T> {
    pub(crate) fn new(store: &'a dyn Artifacts, kind: Kind, size: usize) -> Self {
        Self { store, kind, size, blocks: 0, block: Vec::new() }
    }

    pub(crate) fn push(&mut self, next: T) -> Result<(), ArtifactError> {
        self.block.push(next);
        if self.block.len() == self.size { self.put() } else { Ok(()) }
    }

    /// Ends the list with the last block, if it has something.
    pub(crate) fn finish(mut self) -> Result<(), ArtifactError> {
        if self.block.is_empty() { Ok(()) } else { self.put() }
    }

    /// Ends the list with a block that has less than the others, perhaps nothing: it says that all are there.
    pub(crate) fn finish_with_mark(mut self) -> Result<(), ArtifactError> {
        self.put()
    }

    fn put(&mut self) -> Result<(), ArtifactError> {
        artifacts::put(self.store, self.kind.item(self.blocks), &self.block)?;
        self.blocks += 1;
        self.block.clear();
        Ok(())
    }
}

/// A block of a list, which must be there.
pub(crate) fn block<T: DeserializeOwned>(
    store: &dyn Artifacts,
    kind: Kind,
    number: u64,
) -> Result<Vec<T>, ArtifactError> {
    let key = kind.item(number);
    artifacts::get(store, key)?.ok_or_else(|| artifacts::damaged(key, &"it is missing"))
}

/// Hands out all blocks of a list that was ended with a mark.
pub(crate) fn for_each_block<T: DeserializeOwned, E: From<ArtifactError>>(
    store: &dyn Artifacts,
    kind: Kind,
    size: usize,
    mut take: impl FnMut(Vec<T>) -> Result<(), E>,
) -> Result<(), E> {
    for number in 0.. {
        let block = block(store, kind, number)?;
        let is_last = block.len() < size;
        take(block)?;
        if is_last {
            break;
        }
    }
    Ok(())
}
