//! The tiles of a build whose terrain comes from a package: each tile in one task, from the package's payload to its own.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use corniche_drape::OwnedBorders;
use corniche_geom::TileId;
use corniche_ground::terrain::{
    border_cells::{BorderCells, CellsAround},
    recorded::RecordedTerrain,
};
use corniche_spec::artifacts::Kind;
use corniche_tileset::{Terrain, pmtiles_order};
use corniche_work::{Stage, workers};

use crate::{
    BuildError,
    context::Context,
    tile::{encode, mesh::Meshed, record::TileDeviation},
};

/// What an entry of [`Borders`] takes.
const ENTRY_BYTES: u64 = 256;

/// Makes the tiles beneath and at `scope` that are not there yet.
pub(crate) fn make(
    context: &Context<'_>,
    terrain: &RecordedTerrain,
    scope: TileId,
) -> Result<(), BuildError> {
    let borders = Borders::new(context, terrain);
    let finest = context.frame().max_level();
    make_all(context, &borders, Stage::Tiles, context.data().in_order_within(scope))?;
    let mut coarse = terrain.package().tile_ids()?;
    coarse.retain(|id| (scope.z()..finest).contains(&id.z()) && id.ancestor(scope.z()) == scope);
    make_all(context, &borders, Stage::CoarseTiles, coarse)
}

fn make_all(
    context: &Context<'_>,
    borders: &Borders<'_>,
    stage: Stage,
    mut ids: Vec<TileId>,
) -> Result<(), BuildError> {
    let Context { store, observer, .. } = *context;
    let all = ids.len();
    ids.retain(|&id| !store.has(Kind::Record.of_tile(id)));
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    workers::make_missing(
        observer,
        stage,
        context.threads(),
        (&ids, all),
        || Ok(()),
        |(), &id| make_tile(context, borders, id),
    )
}

fn make_tile(context: &Context<'_>, borders: &Borders<'_>, id: TileId) -> Result<(), BuildError> {
    let owned = || borders.owned(id);
    let record = match borders.ground(id)? {
        Some((bytes, terrain)) => {
            let relief =
                context.has_relief(id).then(|| borders.terrain.relief(id, &bytes)).transpose()?;
            let deviation = TileDeviation {
                geometric_error_m: terrain.geometric_error_m,
                // The package does not say it: the manifest takes the figures that are made of it from the package's own.
                deviation_m: 0.0,
                height_range_m: terrain.height_range_m,
                uncovered_nodes: terrain.uncovered_nodes,
            };
            let meshed = Meshed { tin: terrain.tin, normals: terrain.normals };
            let tile = (meshed, relief);
            encode::with_ground(context, id, tile, deviation, Some(&bytes), owned)?
        }
        None => encode::without_ground(context, id, owned)?,
    };
    Ok(record.put(context.store, id)?)
}

/// The grounds of a package, and which cells along the borders of its tiles have ground.
struct Borders<'a> {
    context: &'a Context<'a>,
    terrain: &'a RecordedTerrain,
    /// The border cells of the tiles seen last; `None` for tiles without ground.
    kept: Mutex<BTreeMap<TileId, Option<BorderCells>>>,
    most: usize,
}

impl<'a> Borders<'a> {
    fn new(context: &'a Context<'a>, terrain: &'a RecordedTerrain) -> Self {
        let most = context.memory().grounds / ENTRY_BYTES;
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        Self { context, terrain, kept: Mutex::default(), most }
    }

    /// The payload of a tile, and its ground decoded; `None` where it has none.
    fn ground(&self, id: TileId) -> Result<Option<(Vec<u8>, Terrain)>, BuildError> {
        let ground = self.terrain.ground(id)?;
        let cells = ground.as_ref().map(|(_, ground)| BorderCells::of(&ground.tin));
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        // Tiles come along a Hilbert curve: what is needed again is found again soon.
        if kept.len() >= self.most {
            kept.clear();
        }
        kept.insert(id, cells);
        Ok(ground)
    }

    /// The cells of a tile; `None` where it has no ground.
    fn cells(&self, id: TileId) -> Result<Option<BorderCells>, BuildError> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner).get(&id).copied();
        match kept {
            Some(cells) => Ok(cells),
            // Outside the lock: two threads may read the same tile, which is less than making all others wait.
            None => Ok(self.ground(id)?.map(|(_, ground)| BorderCells::of(&ground.tin))),
        }
    }

    /// What a tile owns of its borders, by the ground on both sides of them.
    fn owned(&self, id: TileId) -> Result<OwnedBorders, BuildError> {
        let beside = |east, south| match id.neighbour(east, south) {
            Some(other) => Ok::<_, BuildError>(self.cells(other)?.unwrap_or_default()),
            None => Ok(BorderCells::default()),
        };
        let around = CellsAround {
            own: self.cells(id)?.unwrap_or_default(),
            north: beside(0, -1)?,
            east: beside(1, 0)?,
            south: beside(0, 1)?,
            west: beside(-1, 0)?,
        };
        let has_ground = |other| Ok(self.cells(other)?.is_some());
        Ok(around.owned(encode::neighbours(self.context, id, has_ground)?))
    }
}
