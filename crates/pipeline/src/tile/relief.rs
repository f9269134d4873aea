//! The raster of a tile's level to its relief section.

use corniche_geom::{HeightGrid, TileId};
use corniche_tileset::{EncodeError, Relief};

use crate::{BuildError, context::Context};

/// The relief of a tile, if tiles of its level have one. `with_halo` has one node of halo on every side.
pub(crate) fn of_tile(
    context: &Context<'_>,
    id: TileId,
    with_halo: &HeightGrid,
) -> Result<Option<Relief>, BuildError> {
    if !context.has_relief(id) {
        return Ok(None);
    }
    let levels = context.levels;
    let cell = levels.frame().level_cell(id.z());
    let relief = Relief::of_heights(with_halo, cell, levels.quantum_m())
        .map_err(|what| EncodeError::Unencodable { tile: id, section: "relief section", what })?;
    Ok(Some(relief))
}
