//! Artifacts of the shares (chunks) of an extract in the store, and errors of reading the extract.

use corniche_osm::{KeptError, KeptKinds, ReadOsmError, ShareStore};
use corniche_spec::artifacts::ArtifactKind;
use corniche_store::Artifacts;

use crate::ExtractError;

/// The artifacts of an extract's shares in the store.
pub fn kept_in(store: &dyn Artifacts) -> ShareStore<'_> {
    let kinds = KeptKinds {
        ways: ArtifactKind::Ways as u8,
        located: ArtifactKind::Located as u8,
        defects: ArtifactKind::WayDefects as u8,
        ways_records: ArtifactKind::WaysShare as u8,
        places: ArtifactKind::Places as u8,
        nodes_records: ArtifactKind::NodesShare as u8,
    };
    ShareStore { store, kinds }
}

/// The error of a build whose extract could not be read.
#[must_use]
pub fn not_read(error: ReadOsmError) -> ExtractError {
    match error {
        // The disk is the cause, not the extract.
        ReadOsmError::Scratch { source, .. } => ExtractError::Storage(source),
        ReadOsmError::Kept { source: KeptError::Store(error), .. } => error.into(),
        error => ExtractError::Osm(error),
    }
}
