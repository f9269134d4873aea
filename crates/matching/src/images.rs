//! What roads are compared with, as images around a block of samples.

use corniche_dem::GridPlan;
use corniche_geom::{Frame, TILE_CELLS, TileId};
use corniche_photo::{LevelChoice, PhotoGrid, PhotoReader, Photos, TexelWindow};
use corniche_tileset::{FilePackage, Sections};

use crate::{error::MatchError, grey::Grey, response::TexelScale};

/// What roads are compared with.
#[derive(Debug)]
pub enum Target<'a> {
    /// Photos, brought onto this grid of the package.
    Photos(&'a Photos, &'a GridPlan),
    /// How steep the ground is, as the relief of the finest tiles has it: roads are flatter across than their banks.
    Slope,
}

/// Texels need be no smaller than this, metres.
const FINE_M: f64 = 1.0;
/// Largest side of an image, texels.
pub(crate) const MOST_TEXELS: usize = 4096;

/// Gives images.
pub(crate) struct Images<'a> {
    package: &'a FilePackage,
    pub(crate) scale: TexelScale,
    source: Source,
    photos: Option<PhotoGrid>,
}

enum Source {
    Photos,
    Slope,
}

impl<'a> Images<'a> {
    pub(crate) fn new(package: &'a FilePackage, target: &Target<'_>) -> Result<Self, MatchError> {
        let frame = &package.manifest().frame;
        let (photos, source, per_cell) = match target {
            Target::Photos(photos, grid) => {
                let grid = photos.on(grid, LevelChoice::NotCoarserThan(FINE_M))?;
                let per_cell = f64::from(1_u32 << grid.texels().levels());
                (Some(grid), Source::Photos, per_cell)
            }
            Target::Slope => (None, Source::Slope, 1.0),
        };
        let cell = frame.cell();
        let texel_m = [cell.east_m / per_cell, cell.north_m / per_cell];
        let scale = TexelScale { origin_m: frame.origin_m(), texel_m };
        Ok(Self { package, scale, source, photos })
    }

    /// Whether there may be an image of a tile.
    pub(crate) fn has(&self, id: TileId) -> bool {
        let bounds = self.frame().tile_bounds(id);
        self.photos.as_ref().is_none_or(|photos| photos.touches(&bounds))
    }

    /// The image in a window of texels, which lies in tile `id` or around a part of it; NaN where there is none.
    pub(crate) fn window(&self, id: TileId, window: TexelWindow) -> Result<Grey, MatchError> {
        let first = [window.u, window.v];
        let columns = window.columns;
        let values = match (&self.source, &self.photos) {
            (Source::Photos, Some(photos)) => brightness(photos, window)?,
            (Source::Photos, None) => vec![f32::NAN; columns * window.rows],
            (Source::Slope, _) => self.slopes(id, window)?,
        };
        Ok(Grey { first, columns, values })
    }

    fn frame(&self) -> &Frame {
        &self.package.manifest().frame
    }

    /// The steepness of each cell of a window, degrees, as far as the tile has heights at its corners. A texel is a cell.
    fn slopes(&self, id: TileId, window: TexelWindow) -> Result<Vec<f32>, MatchError> {
        let mut slopes = vec![f32::NAN; window.columns * window.rows];
        let Some(payload) = self.package.payload(id, Sections::RELIEF)? else { return Ok(slopes) };
        let Some(relief) = &payload.relief else { return Err(MatchError::NoRelief) };
        let corner = self.frame().tile_corner(id);
        let cell = self.frame().cell();
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
        Ok(slopes)
    }
}

/// How bright a photo is, 0 to 255 (ITU-R BT.601).
fn brightness(photos: &PhotoGrid, window: TexelWindow) -> Result<Vec<f32>, MatchError> {
    let texels = PhotoReader::new(photos).window(window)?;
    let value = |texel: &[u8]| match *texel {
        [red, green, blue, alpha] if alpha > 0 => {
            0.299 * f32::from(red) + 0.587 * f32::from(green) + 0.114 * f32::from(blue)
        }
        _ => f32::NAN,
    };
    Ok(texels.rgba().chunks_exact(4).map(value).collect())
}
