//! Rasters of photos: of each tile, one texel for each cell of its level. A photo of a coarse tile is made of its children's.

use corniche_geom::{TILE_CELLS, TileId};
use corniche_photo::Texels;
use corniche_spec::{
    artifacts::{ArtifactError, Kind, damaged},
    data_tiles::DataTiles,
};
use corniche_store::Artifacts;
use corniche_tileset::PHOTO_BORDER;

use crate::GroundError;

/// Texels along a side of a raster.
pub const SIDE: usize = TILE_CELLS as usize;

/// Keeps a tile's raster. Without any photo it has no bytes, but it is there: what is not there was not made.
///
/// # Errors
/// See [`GroundError`].
pub fn put(store: &dyn Artifacts, id: TileId, raster: &Texels) -> Result<(), GroundError> {
    let bytes = if raster.is_empty() { &[][..] } else { raster.rgba() };
    Ok(store.put(Kind::PhotoRaster.of_tile(id), bytes)?)
}

/// The raster of a finest tile, of its texels with the border that tiles have, so many levels finer than its cells.
#[must_use]
pub fn of_texels(texels: &Texels, levels: u8) -> Texels {
    let own = texels.part([PHOTO_BORDER; 2], [SIDE << levels; 2]);
    (0..levels).fold(own, |finer, _| finer.halved())
}

/// The error for what was not made of a tile's photo.
#[must_use]
pub fn missing(id: TileId) -> ArtifactError {
    ArtifactError::Missing { what: format!("the photo of tile {id}"), step: "heights" }
}

/// A tile's raster; `None` where it has no photo, and beside the data.
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
    let key = Kind::PhotoRaster.of_tile(id);
    let bytes = store.get(key)?.ok_or_else(|| missing(id))?;
    if bytes.is_empty() {
        return Ok(None);
    }
    match Texels::new(SIDE, SIDE, bytes) {
        Some(texels) => Ok(Some(texels)),
        None => Err(damaged(key, &"it is no photo").into()),
    }
}

/// The texels of a tile above the finest level, twice as fine as its cells: those of its children, and `border` more on every side,
/// of theirs. `None` where none of them has a photo.
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
    // Children of the tile and those around, by their distance from its first.
    let around = if border == 0 { 0..=1 } else { -1..=2 };
    for south in around.clone() {
        for east in around.clone() {
            let at = |first: u32, by: i64| u32::try_from(2 * i64::from(first) + by).ok();
            let (Some(x), Some(y)) = (at(id.x(), east), at(id.y(), south)) else { continue };
            let Ok(child) = TileId::new(id.z() + 1, x, y) else { continue };
            let Some(raster) = get(store, data, child)? else { continue };
            // Which part of a child lies in the square, and where.
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

/// Makes a tile's raster from those of its children.
///
/// # Errors
/// See [`GroundError`].
pub fn put_from_children(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
) -> Result<(), GroundError> {
    match of_children(store, data, id, 0)? {
        Some(texels) => put(store, id, &texels.halved()),
        None => put(store, id, &Texels::empty(0, 0)),
    }
}
