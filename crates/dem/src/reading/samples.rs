//! The DEM's own samples: all of them, and those that nodes use.

use corniche_geom::{GridFrame, LatticeBounds, NodeIndex, NodeWindow};
use corniche_gis::CrsError;

use crate::mosaics::mosaic::{Mosaic, SampleRect};
use crate::plan::clip::needed_samples;
use crate::plan::grid_plan::Method;
use crate::plan::kernel::{Kernel, SampleRectangle};
use crate::reading::reader::{HeightReader, MOST_SAMPLES, around};
use crate::reading::window_parts::intersection;
use crate::{Dem, GridPlan, ReadHeightsError};

/// Side of the blocks in which samples are returned.
const BLOCK_SAMPLES: i64 = 256;

/// A block of samples of one of the DEM's grids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleRange {
    /// The grid: the index of its mosaic.
    mosaic: usize,
    rect: SampleRect,
}

/// Original samples of the DEM that have a height.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampleBlock {
    /// Positions in the working CRS in metres; NaN outside the CRS.
    pub positions_m: Vec<[f64; 2]>,
    /// Heights in metres, as many as `positions_m`.
    pub heights_m: Vec<f32>,
}

impl SampleBlock {
    /// Removes the samples that do not lie between two nodes, by their positions rounded to the
    /// lattice.
    fn keep_within(&mut self, frame: &GridFrame, nodes: [NodeIndex; 2]) {
        let [min, max] = nodes.map(|node| frame.lattice_of_node(node));
        let bounds = LatticeBounds { min, max };
        let is_inside: Vec<bool> = self
            .positions_m
            .iter()
            .map(|&position_m| frame.snap(position_m).is_some_and(|point| bounds.contains(point)))
            .collect();
        self.retain(&is_inside);
    }

    /// Removes the samples for which this is false.
    fn retain(&mut self, is_kept: &[bool]) {
        let mut kept = is_kept.iter();
        self.positions_m.retain(|_| kept.next().copied().unwrap_or(false));
        let mut kept = is_kept.iter();
        self.heights_m.retain(|_| kept.next().copied().unwrap_or(false));
    }
}

impl Dem {
    /// All blocks of samples that can lie between nodes of the plan, in a fixed order: at most 256
    /// × 256 samples each, without blocks outside all files.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn sample_ranges(&self, plan: &GridPlan) -> Result<Vec<SampleRange>, CrsError> {
        let mut ranges = Vec::new();
        for (index, (mosaic, role)) in self.mosaics.iter().zip(&plan.roles.0).enumerate() {
            let needed = needed_samples(plan, mosaic, role)?;
            ranges.extend(blocks_of(mosaic, index, &needed.intersection(&mosaic.extent)));
        }
        Ok(ranges)
    }
}

/// The number of nodes around a window within which the samples of the window certainly lie.
const AROUND_NODES: usize = 2;

impl Dem {
    /// Blocks that contain every sample between the nodes of a window, and others around it: at
    /// most 256 × 256 samples each. No sample is in two blocks.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn sample_ranges_of(
        &self,
        plan: &GridPlan,
        window: NodeWindow,
    ) -> Result<Vec<SampleRange>, CrsError> {
        let wide = window.with_halo(AROUND_NODES);
        let mut ranges = Vec::new();
        for (index, (mosaic, role)) in self.mosaics.iter().zip(&plan.roles.0).enumerate() {
            let grow = |[low, high]: [NodeIndex; 2]| {
                let by = AROUND_NODES as i64;
                [
                    NodeIndex { i: low.i - by, j: low.j - by },
                    NodeIndex { i: high.i + by, j: high.j + by },
                ]
            };
            let Some(part) = intersection(&wide, grow(role.nodes)) else { continue };
            let rect = match &role.method {
                Method::Aligned(alignment) => {
                    let ends = [part.node(0, 0), part.node(part.columns - 1, part.rows - 1)];
                    Some(alignment.samples(ends).intersection(&mosaic.extent))
                }
                Method::Resampled(positions, kernel) => {
                    let at = positions.positions_in(&plan.frame, &part)?;
                    around(at.into_iter(), kernel, &mosaic.extent)
                }
            };
            let Some(rect) = rect else { continue };
            ranges.extend(blocks_of(mosaic, index, &rect));
        }
        Ok(ranges)
    }
}

/// The blocks of a rectangle of samples, without blocks outside all files.
fn blocks_of(mosaic: &Mosaic, index: usize, rect: &SampleRect) -> Vec<SampleRange> {
    let mut ranges = Vec::new();
    let SampleRect { min, max } = *rect;
    for row in (min[1]..max[1]).step_by(BLOCK_SAMPLES as usize) {
        for column in (min[0]..max[0]).step_by(BLOCK_SAMPLES as usize) {
            let end = [column + BLOCK_SAMPLES, row + BLOCK_SAMPLES];
            let rect = rect.intersection(&SampleRect { min: [column, row], max: end });
            if mosaic.files.iter().any(|file| !file.rect.intersection(&rect).is_empty()) {
                ranges.push(SampleRange { mosaic: index, rect });
            }
        }
    }
    ranges
}

impl HeightReader<'_> {
    /// The samples of a range that have a height: after nodata, units and shift; where files of one
    /// grid overlap, those of the file named first. Samples outside the plan's bounds are omitted.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn samples(&mut self, range: &SampleRange) -> Result<SampleBlock, ReadHeightsError> {
        let mosaic = &self.dem.mosaics[range.mosaic];
        self.files.read(&self.dem.sources, mosaic, &range.rect, &mut self.samples)?;
        let mut block = SampleBlock::default();
        for (k, height_m) in self.samples.iter().enumerate() {
            if height_m.is_nan() {
                continue;
            }
            let (column, row) = (k % range.rect.columns(), k / range.rect.columns());
            let sample = [range.rect.min[0] + column as i64, range.rect.min[1] + row as i64];
            let at = sample.map(|index| index as f64);
            block.positions_m.push(mosaic.crs_from_sample.crs_from_pixel(at));
            block.heights_m.push(*height_m as f32);
        }
        self.plan.roles.0[range.mosaic].working_from_crs.apply(&mut block.positions_m)?;
        if let Some(corniche_geom::ClipRecord { nodes, .. }) = self.plan.clip {
            block.keep_within(&self.plan.frame, nodes);
        }
        Ok(block)
    }

    /// The samples of a range that nodes use: those that are not hidden by data of an earlier named
    /// grid.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn used_samples(&mut self, range: &SampleRange) -> Result<SampleBlock, ReadHeightsError> {
        let mut block = self.samples(range)?;
        for earlier in 0..range.mosaic {
            let is_open = self.is_open(earlier, &block.positions_m)?;
            block.retain(&is_open);
        }
        Ok(block)
    }

    /// Tells for each position, in working metres, whether a mosaic lacks samples around the
    /// position.
    fn is_open(
        &mut self,
        mosaic: usize,
        positions_m: &[[f64; 2]],
    ) -> Result<Vec<bool>, ReadHeightsError> {
        let (dem, plan) = (self.dem, self.plan);
        let mosaic = &dem.mosaics[mosaic];
        let mut at = positions_m.to_vec();
        mosaic
            .crs_from_working(&plan.working, dem.wgs84_bounds)
            .apply_to_pixels(&mosaic.crs_from_sample, &mut at)?;
        let mut is_open = vec![true; at.len()];
        self.look(mosaic, &at, &mut is_open)?;
        Ok(is_open)
    }

    /// The same for positions among a mosaic's samples, in parts of bounded memory.
    fn look(
        &mut self,
        mosaic: &Mosaic,
        at: &[[f64; 2]],
        is_open: &mut [bool],
    ) -> Result<(), ReadHeightsError> {
        let kernel = Kernel::new([0.0; 2]);
        let Some(rect) = around(at.iter().copied(), &kernel, &mosaic.reachable()) else {
            return Ok(());
        };
        if rect.columns() * rect.rows() > MOST_SAMPLES && at.len() > 1 {
            let half = at.len() / 2;
            let (first, last) = is_open.split_at_mut(half);
            self.look(mosaic, &at[..half], first)?;
            return self.look(mosaic, &at[half..], last);
        }
        self.files.read(&self.dem.sources, mosaic, &rect, &mut self.samples)?;
        let samples = SampleRectangle { rect, heights_m: &self.samples };
        for (position, is_open) in at.iter().zip(is_open).filter(|(at, _)| at[0].is_finite()) {
            *is_open = kernel.height_m(&samples, *position, &mut self.scratch).is_nan();
        }
        Ok(())
    }
}
