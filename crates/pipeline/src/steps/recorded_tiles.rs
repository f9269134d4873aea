//! Builds the tiles of a build whose terrain comes from a package: each tile in one task, from the
//! package's payload to its own.

use corniche_drape::OwnedBorders;
use corniche_geom::TileId;
use corniche_ground::terrain::{
    border_cells::{BorderCells, CellsAround},
    recorded::RecordedTerrain,
};
use corniche_spec::artifacts::ArtifactKind;
use corniche_tileset::{TileTerrain, pmtiles_order};
use corniche_work::{Recent, Stage};

use crate::{
    BuildError,
    context::BuildContext,
    tile::{encode, mesh::Meshed, record::TileDeviation},
};

/// The memory for the cells of a tile.
const CELLS_BYTES: u64 = size_of::<Option<BorderCells>>() as u64;

/// Creates the missing tiles beneath and at `scope`.
pub(crate) fn make(
    context: &BuildContext<'_>,
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
    context: &BuildContext<'_>,
    borders: &Borders<'_>,
    stage: Stage,
    mut ids: Vec<TileId>,
) -> Result<(), BuildError> {
    ids.sort_unstable_by_key(|&id| pmtiles_order(id));
    let make = |(): &mut (), id| make_tile(context, borders, id);
    context.make_missing((stage, ArtifactKind::Record), ids, || Ok(()), make)
}

fn make_tile(
    context: &BuildContext<'_>,
    borders: &Borders<'_>,
    id: TileId,
) -> Result<(), BuildError> {
    let owned = || borders.owned(id);
    let record = match borders.ground(id)? {
        Some((bytes, terrain)) => {
            let relief =
                context.has_relief(id).then(|| borders.terrain.relief(id, &bytes)).transpose()?;
            let deviation = TileDeviation {
                geometric_error_m: terrain.geometric_error_m,
                // The package does not record it: the manifest takes the figures derived from it
                // from the package's own.
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

/// The grounds of a package, with the cells that have ground along the borders of its tiles.
struct Borders<'a> {
    context: &'a BuildContext<'a>,
    terrain: &'a RecordedTerrain,
    /// The border cells of the most recent tiles; `None` for tiles without ground. Tiles are
    /// visited along a Hilbert curve, so a tile that is needed again is needed soon.
    kept: Recent<TileId, Option<BorderCells>>,
}

impl<'a> Borders<'a> {
    fn new(context: &'a BuildContext<'a>, terrain: &'a RecordedTerrain) -> Self {
        Self { context, terrain, kept: Recent::new(context.memory().grounds) }
    }

    /// The payload of a tile, and its decoded ground; `None` if it has no ground.
    fn ground(&self, id: TileId) -> Result<Option<(Vec<u8>, TileTerrain)>, BuildError> {
        let ground = self.terrain.ground(id)?;
        let cells = || Ok::<_, BuildError>(cells_of(ground.as_ref()));
        self.kept.get(id, cells, |_| CELLS_BYTES)?;
        Ok(ground)
    }

    /// The border cells of a tile; `None` if it has no ground.
    fn cells(&self, id: TileId) -> Result<Option<BorderCells>, BuildError> {
        let read = || Ok::<_, BuildError>(cells_of(self.terrain.ground(id)?.as_ref()));
        Ok(*self.kept.get(id, read, |_| CELLS_BYTES)?)
    }

    /// The borders that a tile owns, derived from the ground on both sides.
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

fn cells_of(ground: Option<&(Vec<u8>, TileTerrain)>) -> Option<BorderCells> {
    ground.map(|(_, ground)| BorderCells::from_tin(&ground.tin))
}
