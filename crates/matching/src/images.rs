//! Images around blocks of samples, with which roads are compared.

use corniche_dem::GridPlan;
use corniche_geom::{GridFrame, TILE_CELLS, TileId};
use corniche_photo::{LevelChoice, PhotoGrid, PhotoReader, Photos, TexelWindow};
use corniche_tileset::{FilePackage, Manifest, Relief, Sections};

use crate::{
    error::MatchError,
    response::{Grey, TexelScale},
};

/// The target of a comparison.
#[derive(Debug)]
pub enum MatchTarget<'a> {
    /// Photos, resampled to this grid of the package.
    Photos(&'a Photos, &'a GridPlan),
    /// The slope of the ground, from the relief of the finest tiles: across, roads are flatter than
    /// their embankments.
    Slope,
}

/// Texels need not be smaller than this, metres.
const FINE_M: f64 = 1.0;
/// Largest side of an image, texels.
pub(crate) const MOST_TEXELS: usize = 4096;

/// Returns the photos of a target, ready for reading.
pub(crate) fn photos_of(target: &MatchTarget<'_>) -> Result<Option<PhotoGrid>, MatchError> {
    match target {
        MatchTarget::Photos(photos, grid) => {
            Ok(Some(photos.on(grid, LevelChoice::NotCoarserThan(FINE_M))?))
        }
        MatchTarget::Slope => Ok(None),
    }
}

/// The source of images.
pub(crate) struct Images<'a> {
    package: &'a FilePackage,
    pub scale: TexelScale,
    source: Source<'a>,
}

enum Source<'a> {
    Photos {
        grid: &'a PhotoGrid,
        reader: PhotoReader<'a>,
    },
    /// The slopes, with the relief of the last tile: windows come tile by tile.
    Slope(Option<(TileId, Option<Relief>)>),
}

impl<'a> Images<'a> {
    /// Returns images of photos, or of slopes if there are none.
    pub(crate) fn new(package: &'a FilePackage, photos: Option<&'a PhotoGrid>) -> Self {
        let frame = &package.manifest().frame;
        let (source, per_cell) = match photos {
            Some(grid) => {
                let per_cell = f64::from(1_u32 << grid.texels().levels());
                (Source::Photos { grid, reader: PhotoReader::new(grid) }, per_cell)
            }
            None => (Source::Slope(None), 1.0),
        };
        let cell = frame.cell();
        let texel_m = [cell.east_m / per_cell, cell.north_m / per_cell];
        let scale = TexelScale { origin_m: frame.origin_m(), texel_m };
        Self { package, scale, source }
    }

    /// Whether there may be an image of a tile.
    pub(crate) fn has(&self, id: TileId) -> bool {
        match &self.source {
            Source::Photos { grid, .. } => grid.touches(&self.frame().tile_bounds(id)),
            Source::Slope(_) => true,
        }
    }

    /// Returns the image in a window of texels, which is in tile `id` or around a part of it; NaN
    /// where there is no data.
    pub(crate) fn window(&mut self, id: TileId, window: TexelWindow) -> Result<Grey, MatchError> {
        let first = [window.u, window.v];
        let columns = window.columns;
        let values = match &mut self.source {
            Source::Photos { reader, .. } => brightness(reader, window)?,
            Source::Slope(last) => {
                if last.as_ref().is_none_or(|(known, _)| *known != id) {
                    *last = Some((id, relief(self.package, id)?));
                }
                let relief = last.as_ref().and_then(|(_, relief)| relief.as_ref());
                slopes(self.package.manifest(), relief, id, window)
            }
        };
        Ok(Grey { first, columns, values })
    }

    fn frame(&self) -> &GridFrame {
        &self.package.manifest().frame
    }
}

/// Returns the heights of a tile; `None` if the package has no such tile.
fn relief(package: &FilePackage, id: TileId) -> Result<Option<Relief>, MatchError> {
    let Some(payload) = package.payload(id, Sections::RELIEF)? else { return Ok(None) };
    payload.relief.map_or(Err(MatchError::NoRelief), |relief| Ok(Some(relief)))
}

/// Returns the slope of each cell of a window, degrees, where the tile has heights at the cell's
/// corners. A texel is a cell.
fn slopes(
    manifest: &Manifest,
    relief: Option<&Relief>,
    id: TileId,
    window: TexelWindow,
) -> Vec<f32> {
    let mut slopes = vec![f32::NAN; window.columns * window.rows];
    let Some(relief) = relief else { return slopes };
    let corner = manifest.frame.tile_corner(id);
    let cell = manifest.frame.cell();
    let height_m = |column: i64, row: i64| {
        relief.heights().height(column as usize, row as usize).map(f64::from)
    };
    for (index, slope) in slopes.iter_mut().enumerate() {
        let column = window.u + (index % window.columns) as i64 - corner.i;
        let row = window.v + (index / window.columns) as i64 + corner.j;
        if !(0..TILE_CELLS).contains(&column) || !(0..TILE_CELLS).contains(&row) {
            continue;
        }
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let corners = corners.map(|(east, south)| height_m(column + east, row + south));
        if let [Some(nw), Some(ne), Some(sw), Some(se)] = corners {
            let east = (ne + se - nw - sw) / (2.0 * cell.east_m);
            let north = (nw + ne - sw - se) / (2.0 * cell.north_m);
            *slope = east.hypot(north).atan().to_degrees() as f32;
        }
    }
    slopes
}

/// Returns the brightness of a photo, 0 to 255 (ITU-R BT.601).
fn brightness(photos: &mut PhotoReader<'_>, window: TexelWindow) -> Result<Vec<f32>, MatchError> {
    let texels = photos.window(window)?;
    let value = |texel: &[u8]| match *texel {
        [red, green, blue, alpha] if alpha > 0 => {
            0.299 * f32::from(red) + 0.587 * f32::from(green) + 0.114 * f32::from(blue)
        }
        _ => f32::NAN,
    };
    Ok(texels.rgba().chunks_exact(4).map(value).collect())
}
