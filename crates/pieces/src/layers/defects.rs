//! Keeps the defects of the extract, so that a run that does not read it again can tell them all the same.

use std::collections::BTreeMap;

use corniche_spec::{
    Defect, Observer,
    artifacts::{ArtifactError, Kind},
};
use corniche_store::Artifacts;

use super::blocks::{BlockWriter, for_each_block};
use crate::ExtractError;

/// Defects of a block of [`Kind::Defects`]. The last block has fewer, perhaps none: it says that all are there.
const BLOCK_DEFECTS: usize = 4096;

/// Tells an observer of defects as they come, counts them, and keeps them block by block.
pub(crate) struct DefectsWriter<'a> {
    observer: &'a dyn Observer,
    blocks: BlockWriter<'a, Defect>,
    by_name: BTreeMap<String, u64>,
    /// Who finds defects cannot fail; the first failure is kept, and no block after it.
    kept: Result<(), ArtifactError>,
}

impl<'a> DefectsWriter<'a> {
    pub(crate) fn new(store: &'a dyn Artifacts, observer: &'a dyn Observer) -> Self {
        let blocks = BlockWriter::new(store, Kind::Defects, BLOCK_DEFECTS);
        Self { observer, blocks, by_name: BTreeMap::new(), kept: Ok(()) }
    }

    /// Takes the next defect.
    pub(crate) fn push(&mut self, defect: Defect) {
        *self.by_name.entry(defect.name()).or_default() += 1;
        self.observer.defect(&defect);
        if self.kept.is_ok() {
            self.kept = self.blocks.push(defect);
        }
    }

    /// Keeps the last block; returns how many defects of each name there are.
    pub(crate) fn finish(self) -> Result<BTreeMap<String, u64>, ExtractError> {
        self.kept?;
        self.blocks.finish_with_mark()?;
        Ok(self.by_name)
    }
}

/// Tells an observer of all defects of the extract, in the order in which they were found; one block of them is in memory.
/// The step that reads the roads must be done.
///
/// # Errors
/// See [`ExtractError`].
pub fn replay_defects(store: &dyn Artifacts, observer: &dyn Observer) -> Result<(), ExtractError> {
    for_each_block(store, Kind::Defects, BLOCK_DEFECTS, |defects: Vec<Defect>| {
        observer.check()?;
        for defect in &defects {
            observer.defect(defect);
        }
        Ok(())
    })
}

#[cfg(test)]
#[path = "defects_tests.rs"]
mod tests;
