//! Keeps the defects of the extract, so that a run that does not read it again can tell them all the same.

use std::collections::BTreeMap;

use corniche_spec::{
    Defect, Observer,
    artifacts::{self, Kind},
};
use corniche_store::Artifacts;

use crate::ExtractError;

/// Defects of a block of [`Kind::Defects`]. The last block has fewer, perhaps none: it says that all are there.
const BLOCK_DEFECTS: usize = 4096;

/// Tells an observer of defects as they come, counts them, and keeps them block by block.
pub(crate) struct DefectsWriter<'a> {
    store: &'a dyn Artifacts,
    observer: &'a dyn Observer,
    blocks: u64,
    block: Vec<Defect>,
    by_name: BTreeMap<String, u64>,
    /// Who finds defects cannot fail; the first failure is kept, and no block after it.
    failed: Option<ExtractError>,
}

impl<'a> DefectsWriter<'a> {
    pub(crate) fn new(store: &'a dyn Artifacts, observer: &'a dyn Observer) -> Self {
        let (block, by_name) = (Vec::new(), BTreeMap::new());
        Self { store, observer, blocks: 0, block, by_name, failed: None }
    }

    /// Takes the next defect.
    pub(crate) fn push(&mut self, defect: Defect) {
        *self.by_name.entry(defect.name()).or_default() += 1;
        self.observer.defect(&defect);
        self.block.push(defect);
        if self.block.len() == BLOCK_DEFECTS {
            self.put_block();
        }
    }

    /// Keeps the last block; returns how many defects of each name there are.
    pub(crate) fn finish(mut self) -> Result<BTreeMap<String, u64>, ExtractError> {
        self.put_block();
        self.failed.map_or(Ok(self.by_name), Err)
    }

    fn put_block(&mut self) {
        if self.failed.is_none() {
            let key = Kind::Defects.item(self.blocks);
            self.failed = artifacts::put(self.store, key, &self.block).err().map(Into::into);
        }
        self.blocks += 1;
        self.block.clear();
    }
}

/// Tells an observer of all defects of the extract, in the order in which they were found; one block of them is in memory.
/// The step that reads the roads must be done.
///
/// # Errors
/// See [`ExtractError`].
pub fn replay_defects(store: &dyn Artifacts, observer: &dyn Observer) -> Result<(), ExtractError> {
    for block in 0.. {
        observer.check()?;
        let key = Kind::Defects.item(block);
        let defects: Option<Vec<Defect>> = artifacts::get(store, key)?;
        let defects = defects.ok_or_else(|| artifacts::damaged(key, &"it is missing"))?;
        for defect in &defects {
            observer.defect(defect);
        }
        if defects.len() < BLOCK_DEFECTS {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "defects_tests.rs"]
mod tests;
