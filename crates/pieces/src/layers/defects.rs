//! Stores the defects of the extract, so that a run that does not read it again can report them all
//! the same.

use std::collections::BTreeMap;

use corniche_spec::{
    BuildObserver, Defect,
    artifacts::{ArtifactError, ArtifactKind},
};
use corniche_store::Artifacts;

use super::blocks::{ListBlockWriter, for_each_block};
use crate::ExtractError;

/// Defects in a block of [`ArtifactKind::Defects`]. The last block has fewer, possibly none: it
/// marks the list as complete.
const BLOCK_DEFECTS: usize = 4096;

/// Reports defects to an observer as they are found, counts them, and stores them block by block.
pub(crate) struct DefectsWriter<'a> {
    observer: &'a dyn BuildObserver,
    blocks: ListBlockWriter<'a, Defect>,
    by_name: BTreeMap<String, u64>,
    /// The finders of defects cannot fail; the first failure is recorded here, and no further block
    /// is stored.
    kept: Result<(), ArtifactError>,
}

impl<'a> DefectsWriter<'a> {
    pub(crate) fn new(store: &'a dyn Artifacts, observer: &'a dyn BuildObserver) -> Self {
        let blocks = ListBlockWriter::new(store, ArtifactKind::Defects, BLOCK_DEFECTS);
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

    /// Stores the last block; returns the number of defects of each name.
    pub(crate) fn finish(self) -> Result<BTreeMap<String, u64>, ExtractError> {
        self.kept?;
        self.blocks.finish_with_mark()?;
        Ok(self.by_name)
    }
}

/// Reports all defects of the extract to an observer, in the order in which they were found; memory
/// holds one block of them. The step that reads the roads must be done.
///
/// # Errors
/// See [`ExtractError`].
pub fn replay_defects(
    store: &dyn Artifacts,
    observer: &dyn BuildObserver,
) -> Result<(), ExtractError> {
    for_each_block(store, ArtifactKind::Defects, BLOCK_DEFECTS, |defects: Vec<Defect>| {
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
