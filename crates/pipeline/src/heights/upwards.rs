//! What a coarse tile has of its children, level by level upwards.

use corniche_geom::TileId;
use corniche_store::Artifacts;

use super::data_tiles::DataTiles;
use crate::{BuildError, Observer, artifacts::Kind, workers};

/// Makes what is missing of a `kind` for the tiles above the finest level, beneath and at `scope`. `make` keeps it for a tile,
/// from what its children have, which is there.
pub(crate) fn make_missing(
    (store, data): (&dyn Artifacts, &DataTiles),
    (observer, threads): (&dyn Observer, usize),
    kind: Kind,
    scope: TileId,
    make: impl Fn(TileId) -> Result<(), BuildError> + Sync,
) -> Result<(), BuildError> {
    for level in (scope.z()..data.level()).rev() {
        let mut ids = data.above(level).within(scope);
        ids.retain(|&id| !store.has(kind.of_tile(id)));
        workers::in_order_unless_cancelled(
            observer,
            threads,
            ids.len(),
            || Ok(()),
            |(), index| make(ids[index]),
            |_, ()| Ok::<_, BuildError>(()),
        )?;
    }
    Ok(())
}
