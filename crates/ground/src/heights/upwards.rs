//! Derives the artifacts of coarse tiles from their children, level by level upwards.

use corniche_geom::TileId;
use corniche_spec::{BuildObserver, artifacts::ArtifactKind, data_tiles::DataTiles};
use corniche_store::Artifacts;
use corniche_work::workers;

use crate::GroundError;

/// Creates the missing artifacts of a `kind` for the tiles above the finest level, beneath and at
/// `scope`. `make` creates and stores the artifact of a tile from those of its children, which are
/// in the store.
///
/// # Errors
/// See [`GroundError`].
pub fn make_missing(
    (store, data): (&dyn Artifacts, &DataTiles),
    (observer, threads): (&dyn BuildObserver, usize),
    kind: ArtifactKind,
    scope: TileId,
    make: impl Fn(TileId) -> Result<(), GroundError> + Sync,
) -> Result<(), GroundError> {
    for level in (scope.z()..data.level()).rev() {
        let mut ids = data.above(level).within(scope);
        ids.retain(|&id| !store.has(kind.of_tile(id)));
        workers::in_order_unless_cancelled(
            observer,
            threads,
            &ids,
            || Ok::<_, GroundError>(()),
            |(), &id| make(id),
            |_, ()| Ok(()),
        )?;
    }
    Ok(())
}
