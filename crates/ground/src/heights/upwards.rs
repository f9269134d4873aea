//! What a coarse tile has of its children, level by level upwards.

use corniche_geom::TileId;
use corniche_spec::{Observer, artifacts::Kind, data_tiles::DataTiles};
use corniche_store::Artifacts;
use corniche_work::workers;

use crate::GroundError;

/// Makes what is missing of a `kind` for the tiles above the finest level, beneath and at `scope`. `make` keeps it for a tile,
/// from what its children have, which is there.
///
/// # Errors
/// See [`GroundError`].
pub fn make_missing(
    (store, data): (&dyn Artifacts, &DataTiles),
    (observer, threads): (&dyn Observer, usize),
    kind: Kind,
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
