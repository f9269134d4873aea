//! Stores long lists block by block, so that memory holds one block.

use corniche_spec::artifacts::{self, ArtifactError, ArtifactKind};
use corniche_store::Artifacts;
use serde::{Serialize, de::DeserializeOwned};

/// Stores a list in blocks of a fixed size, as artifacts of one kind.
pub(crate) struct ListBlockWriter<'a, T> {
    store: &'a dyn Artifacts,
    kind: ArtifactKind,
    size: usize,
    blocks: u64,
    block: Vec<T>,
}

impl<'a, T: Serialize> ListBlockWriter<'a, T> {
    pub(crate) fn new(store: &'a dyn Artifacts, kind: ArtifactKind, size: usize) -> Self {
        Self { store, kind, size, blocks: 0, block: Vec::new() }
    }

    pub(crate) fn push(&mut self, next: T) -> Result<(), ArtifactError> {
        self.block.push(next);
        if self.block.len() == self.size { self.put() } else { Ok(()) }
    }

    /// Ends the list with the last block, unless that block is empty.
    pub(crate) fn finish(mut self) -> Result<(), ArtifactError> {
        if self.block.is_empty() { Ok(()) } else { self.put() }
    }

    /// Ends the list with a block that is not full, and may be empty: it marks the list as
    /// complete.
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

/// Reads a block of a list; a missing block is an error.
pub(crate) fn block<T: DeserializeOwned>(
    store: &dyn Artifacts,
    kind: ArtifactKind,
    number: u64,
) -> Result<Vec<T>, ArtifactError> {
    let key = kind.item(number);
    artifacts::get(store, key)?.ok_or_else(|| artifacts::damaged(key, &"it is missing"))
}

/// Passes on all blocks of a list that was ended with a mark.
pub(crate) fn for_each_block<T: DeserializeOwned, E: From<ArtifactError>>(
    store: &dyn Artifacts,
    kind: ArtifactKind,
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
