//! The raster of a tile's level to its relief section.

use corniche_geom::{HeightGrid, TileId};
use corniche_tileset::{EncodeError, Relief};

use super::low_pass::low_passed;
use crate::{BuildError, context::Context};

/// The relief of a tile, if tiles of its level have one. `with_two` has two nodes of halo on every side; `step_m` is the step between
/// heights that the DEM can tell apart.
pub(crate) fn of_tile(
    context: &Context<'_>,
    id: TileId,
    with_two: &HeightGrid,
    step_m: f64,
) -> Result<Option<Relief>, BuildError> {
    if !context.has_relief(id) {
        return Ok(None);
    }
    let levels = context.levels;
    let cell = levels.frame().level_cell(id.z());
    let shown = low_passed(with_two, step_m);
    let relief = Relief::of_heights(&with_two.inner(1), &shown, cell, levels.quantum_m())
        .map_err(|what| EncodeError::Unencodable { tile: id, section: "relief section", what })?;
    Ok(Some(relief))
}
