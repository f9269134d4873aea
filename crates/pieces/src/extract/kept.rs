//! What shares of an extract keep in the store, and why an extract could not be read.

use corniche_osm::{Kept, KeptError, KeptKinds, ReadOsmError};
use corniche_spec::artifacts::Kind;
use corniche_store::Artifacts;

use crate::ExtractError;

/// Where shares of the extract are kept.
pub fn kept_in(store: &dyn Artifacts) -> Kept<'_> {
    let kinds = KeptKinds {
        ways: Kind::Ways as u8,
        located: Kind::Located as u8,
        defects: Kind::WayDefects as u8,
        ways_records: Kind::WaysShare as u8,
        places: Kind::Places as u8,
        nodes_records: Kind::NodesShare as u8,
    };
    Kept { store, kinds }
}

/// The error of a build whose extract could not be read.
#[must_use]
pub fn not_read(error: ReadOsmError) -> ExtractError {
    match error {
        // The disk is at fault, not the extract.
        ReadOsmError::Scratch { source, .. } => ExtractError::Storage(source),
        ReadOsmError::Kept { source: KeptError::Store(error), .. } => error.into(),
        error => ExtractError::Osm(error),
    }
}
