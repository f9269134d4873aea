//! The pixels of a raster, in blocks, and the nodes of the package that they represent.

use corniche_dem::nodes_within;
use corniche_geom::{NodeIndex, NodeWindow};
use corniche_tileset::{FilePackage, Manifest};

use crate::{
    bounds::DegreeBounds,
    error::{CoordinatesError, RasterError, SelectionError},
    places::crs_of,
};

/// Pixels along each side of a block.
pub(crate) const BLOCK: usize = 256;

/// The size of a raster in pixels, which are written in blocks.
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

    /// Column and row of a block, given by its number, row by row.
    pub(crate) fn place(self, number: usize) -> [usize; 2] {
        let [columns, _] = self.blocks();
        [number % columns, number / columns]
    }

    /// Columns and rows of a block; blocks on the right and at the bottom may be smaller.
    pub(crate) fn block_size(self, [column, row]: [usize; 2]) -> [usize; 2] {
        [BLOCK.min(self.columns - column * BLOCK), BLOCK.min(self.rows - row * BLOCK)]
    }
}

/// A rectangle of finest nodes.
#[derive(Clone, Copy)]
pub(crate) struct RasterGrid {
    /// North-western node.
    corner: NodeIndex,
    pub(crate) size: RasterSize,
}

impl RasterGrid {
    /// Returns the nodes of the data, or those inside the bounds.
    pub(crate) fn covering(
        package: &FilePackage,
        bounds: Option<&DegreeBounds>,
    ) -> Result<Self, RasterError> {
        let manifest = package.manifest();
        let [mut low, mut high] = manifest.data_nodes();
        if let Some(bounds) = bounds {
            let asked = nodes_within(
                bounds.degrees(),
                crs_of(manifest)?.working(),
                manifest.area_deg(),
                manifest.frame.origin_m(),
                manifest.frame.cell(),
            );
            let [from, to] = asked.map_err(CoordinatesError::from)?;
            low = NodeIndex { i: low.i.max(from.i), j: low.j.max(from.j) };
            high = NodeIndex { i: high.i.min(to.i), j: high.j.min(to.j) };
        }
        let side = |low: i64, high: i64| usize::try_from(high - low + 1).ok().filter(|n| *n > 0);
        match (side(low.i, high.i), side(low.j, high.j)) {
            (Some(columns), Some(rows)) => {
                let corner = NodeIndex { i: low.i, j: high.j };
                Ok(Self { corner, size: RasterSize { columns, rows } })
            }
            _ => Err(SelectionError::no_ground(package).into()),
        }
    }

    /// The nodes of a block; blocks in the east and in the south may be smaller.
    pub(crate) fn window(&self, place: [usize; 2]) -> NodeWindow {
        let from = place.map(|blocks| blocks * BLOCK);
        let [columns, rows] = self.size.block_size(place);
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

    /// The transformation from pixels to the package's CRS, in GDAL's form: it refers to the
    /// corners of pixels, whose middles are nodes.
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
