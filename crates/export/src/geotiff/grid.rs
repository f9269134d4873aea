//! The pixels of a raster, in blocks, and the nodes that they are.

use corniche_dem::nodes_within;
use corniche_geom::{NodeIndex, NodeWindow};
use corniche_gis::RecordedCrs;
use corniche_tileset::{FilePackage, Manifest};

use crate::{
    bounds::DegreeBounds,
    error::{CoordinatesError, RasterError, SelectionError},
};

/// Pixels along each side of a block.
pub(crate) const BLOCK: usize = 256;

/// How many pixels a raster has. They are written in blocks.
#[derive(Clone, Copy)]
pub(crate) struct RasterSize {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl RasterSize {
    /// Blocks from left to right and from the top down.
    pub(crate) fn blocks(self) -> [usize; 2] {
        [self.columns, self.rows].map(|pixels| pixels.div_ceil(BLOCK))
    }

    /// Column and row of a block by its number, row by row.
    pub(crate) fn place(self, number: usize) -> [usize; 2] {
        let [columns, _] = self.blocks();
        [number % columns, number / columns]
    }

    /// Columns and rows of a block, of which those on the right and at the bottom may be smaller.
    pub(crate) fn block_size(self, [column, row]: [usize; 2]) -> [usize; 2] {
        [BLOCK.min(self.columns - column * BLOCK), BLOCK.min(self.rows - row * BLOCK)]
    }
}

/// A rectangle of finest nodes.
#[derive(Clone, Copy)]
pub(crate) struct RasterGrid {
    /// North-western node.
    corner: NodeIndex,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl RasterGrid {
    /// The nodes of the data, or those of them in the bounds.
    pub(crate) fn of(
        package: &FilePackage,
        bounds: Option<&DegreeBounds>,
    ) -> Result<Self, RasterError> {
        let manifest = package.manifest();
        let [mut low, mut high] = manifest.data_nodes();
        if let Some(bounds) = bounds {
            let Manifest { crs_wkt, metres_per_unit, frame, .. } = manifest;
            let whole = manifest.whole_data_bounds();
            let crs = RecordedCrs::new(crs_wkt, *metres_per_unit, whole)
                .map_err(CoordinatesError::from)?;
            let asked = nodes_within(
                bounds.degrees(),
                crs.working(),
                manifest.area_deg(),
                frame.origin_m(),
                frame.cell(),
            );
            let [from, to] = asked.map_err(CoordinatesError::from)?;
            low = NodeIndex { i: low.i.max(from.i), j: low.j.max(from.j) };
            high = NodeIndex { i: high.i.min(to.i), j: high.j.min(to.j) };
        }
        let side = |low: i64, high: i64| usize::try_from(high - low + 1).ok().filter(|n| *n > 0);
        match (side(low.i, high.i), side(low.j, high.j)) {
            (Some(columns), Some(rows)) => {
                Ok(Self { corner: NodeIndex { i: low.i, j: high.j }, columns, rows })
            }
            _ => Err(SelectionError::no_ground(package).into()),
        }
    }

    /// Its nodes as pixels.
    pub(crate) fn size(&self) -> RasterSize {
        RasterSize { columns: self.columns, rows: self.rows }
    }

    /// The nodes of a block, of which those in the east and in the south may be smaller.
    pub(crate) fn window(&self, place: [usize; 2]) -> NodeWindow {
        let from = place.map(|blocks| blocks * BLOCK);
        let [columns, rows] = self.size().block_size(place);
        NodeWindow {
            corner: NodeIndex {
                i: self.corner.i + from[0] as i64,
                j: self.corner.j - from[1] as i64,
            },
            stride: 1,
            columns,
            rows,
        }
    }

    /// The map from pixels to the package's CRS, as GDAL has it: about the corners of pixels, whose middles are nodes.
    pub(crate) fn crs_from_pixel(&self, manifest: &Manifest) -> [f64; 6] {
        let Manifest { frame, metres_per_unit: [unit_x, unit_y], .. } = manifest;
        let (east, north) = (frame.cell().east_m / unit_x, frame.cell().north_m / unit_y);
        let x = frame.x_m(self.corner.i) / unit_x;
        let y = frame.y_m(self.corner.j) / unit_y;
        [x - east / 2.0, east, 0.0, y + north / 2.0, 0.0, -north]
    }
}

#[cfg(test)]
#[path = "grid_tests.rs"]
mod tests;
