//! Rasters of photos: each tile has one texel for each cell of its level. The photo of a coarse
//! tile is derived from its children.

use corniche_geom::{TILE_CELLS, TileId};
use corniche_photo::Texels;
use corniche_spec::{
    artifacts::{ArtifactError, ArtifactKind, damaged},
    data_tiles::DataTiles,
};
use corniche_store::Artifacts;
use corniche_tileset::PHOTO_BORDER;

use crate::GroundError;

/// Texels along a side of a raster.
pub const SIDE: usize = TILE_CELLS as usize;

/// Stores a tile's raster. A raster without any photo is stored without bytes, because a missing
/// artifact means "not computed".
///
/// # Errors
/// See [`GroundError`].
pub fn put(store: &dyn Artifacts, id: TileId, raster: &Texels) -> Result<(), GroundError> {
    let bytes = if raster.is_empty() { &[][..] } else { raster.rgba() };
    Ok(store.put(ArtifactKind::PhotoRaster.of_tile(id), bytes)?)
}

/// Computes the raster of a finest tile from its texels. The texels include the tile's border and
/// are `levels` levels finer than its cells.
#[must_use]
pub fn of_texels(texels: &Texels, levels: u8) -> Texels {
    let own = texels.part([PHOTO_BORDER; 2], [SIDE << levels; 2]);
    (0..levels).fold(own, |finer, _| finer.halved())
}

/// The error for a tile whose photo was not computed.
#[must_use]
pub fn missing(id: TileId) -> ArtifactError {
    ArtifactError::Missing { what: format!("the photo of tile {id}"), step: "heights" }
}

/// Reads a tile's raster; `None` if it has no photo or is outside the data.
///
/// # Errors
/// See [`GroundError`].
pub fn get(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
) -> Result<Option<Texels>, GroundError> {
    if !data.above(id.z()).contains(id) {
        return Ok(None);
    }
    let key = ArtifactKind::PhotoRaster.of_tile(id);
    let bytes = store.get(key)?.ok_or_else(|| missing(id))?;
    if bytes.is_empty() {
        return Ok(None);
    }
    let texels = Texels::new(SIDE, SIDE, bytes);
    Ok(Some(texels.ok_or_else(|| damaged(key, &"it is not a photo"))?))
}

/// The texels of a tile above the finest level, twice as fine as its cells. They are the texels of
/// its children, with `border` more texels on every side from the neighbours' children. `None` if
/// no child has a photo.
///
/// # Errors
/// See [`GroundError`].
pub fn of_children(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
    border: usize,
) -> Result<Option<Texels>, GroundError> {
    let side = 2 * SIDE + 2 * border;
    let mut all = Texels::empty(side, side);
    // Children of the tile and of its neighbours, by their distance from its first child.
    let around = if border == 0 { 0..=1 } else { -1..=2 };
    for south in around.clone() {
        for east in around.clone() {
            let at = |first: u32, by: i64| u32::try_from(2 * i64::from(first) + by).ok();
            let (Some(x), Some(y)) = (at(id.x(), east), at(id.y(), south)) else { continue };
            let Ok(child) = TileId::new(id.z() + 1, x, y) else { continue };
            let Some(raster) = get(store, data, child)? else { continue };
            // The part of a child inside the square, and its position there.
            let span = |by: i64| match by {
                -1 => (SIDE - border, border, 0),
                2 => (0, border, border + 2 * SIDE),
                by => (0, SIDE, border + by as usize * SIDE),
            };
            let ((left, columns, to_left), (top, rows, to_top)) = (span(east), span(south));
            all.copy(&raster, [left, top], [columns, rows], [to_left, to_top]);
        }
    }
    Ok((!all.is_empty()).then_some(all))
}

/// Creates a tile's raster from those of its children.
///
/// # Errors
/// See [`GroundError`].
pub fn put_from_children(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
) -> Result<(), GroundError> {
    let texels = of_children(store, data, id, 0)?;
    put(store, id, &texels.map_or(Texels::empty(0, 0), |texels| texels.halved()))
}
