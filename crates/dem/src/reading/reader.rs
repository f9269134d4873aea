//! The reader of windows of heights; each thread has its own.

use corniche_geom::{HeightGrid, NodeWindow};

use crate::mosaics::mosaic::{Mosaic, SampleRect};
use crate::mosaics::open_files::OpenFiles;
use crate::plan::grid_plan::Method;
use crate::plan::kernel::{Alignment, Kernel, KernelBuffers, SampleRectangle};
use crate::reading::fill_voids;
use crate::reading::window_parts::{WindowPart, WindowTarget, intersection};
use crate::{Dem, GridPlan, ReadHeightsError};

/// The number of samples in memory for one window; larger windows are read in parts. 32 MB.
pub(crate) const MOST_SAMPLES: usize = 1 << 22;

/// The heights of a window of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct DemWindow {
    /// The heights, metres.
    pub heights: HeightGrid,
    /// The number of void nodes that were filled from their surroundings.
    pub filled: u64,
    /// For each node, row by row from the north, whether it was filled; empty if none was.
    pub is_filled: Vec<bool>,
}

/// A window of nodes, and which of them are needed; an empty list means all.
struct WantedWindow {
    part: NodeWindow,
    is_wanted: Vec<bool>,
}

/// Reads windows of heights. Each thread has its own, because it keeps files open and reuses its
/// buffers.
pub struct HeightReader<'a> {
    pub(crate) dem: &'a Dem,
    pub(crate) plan: &'a GridPlan,
    pub(crate) files: OpenFiles,
    pub(crate) samples: Vec<f64>,
    pub(crate) scratch: KernelBuffers,
}

impl Dem {
    /// A reader of windows, for one thread at a time. It opens files when it needs them.
    #[must_use]
    pub fn reader<'a>(&'a self, plan: &'a GridPlan) -> HeightReader<'a> {
        HeightReader {
            dem: self,
            plan,
            files: OpenFiles::default(),
            samples: Vec::new(),
            scratch: KernelBuffers::default(),
        }
    }
}

impl HeightReader<'_> {
    /// The heights of a window of stride 1, voids filled. Nodes outside the data, the plan's bounds
    /// or its polygon are gaps.
    ///
    /// A node has the same bits in any window.
    ///
    /// # Errors
    /// When the stride is not 1 or a file cannot be read.
    pub fn window(&mut self, window: NodeWindow) -> Result<DemWindow, ReadHeightsError> {
        if window.stride != 1 {
            return Err(ReadHeightsError::Stride { stride: window.stride });
        }
        if self.plan.clip.is_none() {
            return self.filled_window(window);
        }
        // Nodes outside the bounds are gaps. Voids inside are also filled from data outside, so
        // that nodes have the same heights as without bounds.
        let mut heights_m = vec![f32::NAN; window.columns * window.rows];
        let (mut filled, mut is_filled) = (0, Vec::new());
        let within = intersection(&window, [self.plan.south_west, self.plan.north_east]);
        if let Some(WantedWindow { part, is_wanted }) = within.and_then(|part| self.wanted(part)) {
            let found = self.filled_window(part)?;
            let target = WindowTarget::new(&window, &part);
            if !found.is_filled.is_empty() {
                is_filled = vec![false; heights_m.len()];
            }
            for row in 0..part.rows {
                let (from, to) = (row * part.columns, target.at(0, row));
                heights_m[to..to + part.columns]
                    .copy_from_slice(&found.heights.raw()[from..from + part.columns]);
                if !is_filled.is_empty() {
                    is_filled[to..to + part.columns]
                        .copy_from_slice(&found.is_filled[from..from + part.columns]);
                }
            }
            filled = found.filled;
            for (from, _) in is_wanted.iter().enumerate().filter(|(_, is_wanted)| !**is_wanted) {
                let to = target.at(from % part.columns, from / part.columns);
                heights_m[to] = f32::NAN;
                if is_filled.get_mut(to).is_some_and(std::mem::take) {
                    filled -= 1;
                }
            }
        }
        let heights = HeightGrid::new(window.columns, window.rows, heights_m);
        Ok(DemWindow { heights, filled, is_filled })
    }

    /// The nodes of a window that the plan's polygon keeps, and the smallest window around them;
    /// `None` if it keeps none.
    fn wanted(&self, window: NodeWindow) -> Option<WantedWindow> {
        let Some(region) = &self.plan.polygon else {
            return Some(WantedWindow { part: window, is_wanted: Vec::new() });
        };
        let frame = &self.plan.frame;
        let is_wanted = region.nodes(frame.node_steps(frame.max_level()), &window);
        let places = || (0..is_wanted.len()).filter(|&at| is_wanted[at]);
        let (top, bottom) = (places().min()? / window.columns, places().max()? / window.columns);
        let columns = || places().map(|at| at % window.columns);
        let (left, right) = (columns().min()?, columns().max()?);
        let part = NodeWindow {
            corner: window.node(left, top),
            stride: window.stride,
            columns: right - left + 1,
            rows: bottom - top + 1,
        };
        let rows = is_wanted.chunks(window.columns).skip(top).take(part.rows);
        let is_wanted = rows.flat_map(|row| row[left..=right].iter().copied()).collect();
        Some(WantedWindow { part, is_wanted })
    }

    /// The heights of a window, regardless of bounds.
    fn filled_window(&mut self, window: NodeWindow) -> Result<DemWindow, ReadHeightsError> {
        let mut heights_m = self.nodes(window)?;
        let mut is_filled = Vec::new();
        let mut filled = 0;
        let reach = self.plan.fill_voids as usize;
        // The halo is read only if there are voids: other nodes do not depend on it.
        if reach > 0 && heights_m.iter().any(|height_m| height_m.is_nan()) {
            let wide = self.with_halo(window, &heights_m, reach)?;
            let columns = window.columns + 2 * reach;
            for (at, height_m) in fill_voids::fill(&wide, columns, reach, self.plan.frame.cell()) {
                let inner = (at / columns - reach) * window.columns + at % columns - reach;
                heights_m[inner] = height_m;
                is_filled.resize(heights_m.len(), false);
                is_filled[inner] = true;
                filled += 1;
            }
        }
        Ok(DemWindow {
            heights: HeightGrid::new(window.columns, window.rows, heights_m),
            filled,
            is_filled,
        })
    }

    /// The heights of a window widened by `reach` nodes on every side, of which the inside is
    /// known.
    fn with_halo(
        &mut self,
        window: NodeWindow,
        inside_m: &[f32],
        reach: usize,
    ) -> Result<Vec<f32>, ReadHeightsError> {
        let wide = window.with_halo(reach);
        let mut heights_m = vec![f32::NAN; wide.columns * wide.rows];
        let mut put = |[left, top]: [usize; 2], columns: usize, part_m: &[f32]| {
            for (row, line) in part_m.chunks_exact(columns).enumerate() {
                let at = (top + row) * wide.columns + left;
                heights_m[at..at + columns].copy_from_slice(line);
            }
        };
        put([reach, reach], window.columns, inside_m);
        // North and south over the whole width, west and east between them.
        let (right, bottom) = (reach + window.columns, reach + window.rows);
        for ([left, top], columns, rows) in [
            ([0, 0], wide.columns, reach),
            ([0, bottom], wide.columns, reach),
            ([0, reach], reach, window.rows),
            ([right, reach], reach, window.rows),
        ] {
            let strip = NodeWindow { corner: wide.node(left, top), stride: 1, columns, rows };
            put([left, top], columns, &self.nodes(strip)?);
        }
        Ok(heights_m)
    }

    /// The heights of nodes from the mosaics, with voids not filled (NaN), row by row from the
    /// north.
    fn nodes(&mut self, window: NodeWindow) -> Result<Vec<f32>, ReadHeightsError> {
        let (dem, plan) = (self.dem, self.plan);
        let mut heights_m = vec![f32::NAN; window.columns * window.rows];
        for (role, mosaic) in plan.roles.0.iter().zip(&dem.mosaics) {
            let Some(part) = intersection(&window, role.nodes) else {
                continue;
            };
            let target = WindowTarget::new(&window, &part);
            match &role.method {
                Method::Aligned(alignment) => {
                    self.copy(mosaic, *alignment, &part, &target, &mut heights_m)?;
                }
                Method::Resampled(positions, kernel) => {
                    let at = positions.positions_in(&plan.frame, &part)?;
                    let all =
                        WindowPart { column: 0, row: 0, columns: part.columns, rows: part.rows };
                    self.interpolate(mosaic, kernel, &at, &all, &target, &mut heights_m)?;
                }
            }
        }
        Ok(heights_m)
    }

    /// The heights of nodes that are samples.
    fn copy(
        &mut self,
        mosaic: &Mosaic,
        alignment: Alignment,
        part: &NodeWindow,
        target: &WindowTarget,
        heights_m: &mut [f32],
    ) -> Result<(), ReadHeightsError> {
        // Reads bands of rows, so that a window of any size needs bounded memory.
        let every = alignment.every as usize;
        let band = (MOST_SAMPLES / (part.columns * every * every)).max(1);
        for top in (0..part.rows).step_by(band) {
            let rows = band.min(part.rows - top);
            let ends = [part.node(0, top), part.node(part.columns - 1, top + rows - 1)];
            let rect = alignment.samples(ends);
            self.files.read(&self.dem.sources, mosaic, &rect, &mut self.samples)?;
            let width = rect.columns();
            for row in 0..rows {
                let [_, line] = alignment.sample(part.node(0, top + row));
                let from = (line - rect.min[1]) as usize * width;
                let line = &self.samples[from..from + width];
                for column in 0..part.columns {
                    let at = column * every;
                    let found_m = line[if alignment.way[0] > 0 { at } else { width - 1 - at }];
                    let height_m = &mut heights_m[target.at(column, top + row)];
                    if height_m.is_nan() {
                        *height_m = found_m as f32;
                    }
                }
            }
        }
        Ok(())
    }

    /// The heights of nodes between samples: the nodes of `part`, whose positions among the samples
    /// are in `at`.
    fn interpolate(
        &mut self,
        mosaic: &Mosaic,
        kernel: &Kernel,
        at: &[[f64; 2]],
        part: &WindowPart,
        target: &WindowTarget,
        heights_m: &mut [f32],
    ) -> Result<(), ReadHeightsError> {
        let open = part.nodes().filter(|&(c, r)| heights_m[target.at(c, r)].is_nan());
        let Some(rect) =
            around(open.map(|(c, r)| at[r * target.columns + c]), kernel, &mosaic.reachable())
        else {
            return Ok(());
        };
        if rect.columns() * rect.rows() > MOST_SAMPLES && part.columns * part.rows > 1 {
            for half in part.halves() {
                self.interpolate(mosaic, kernel, at, &half, target, heights_m)?;
            }
            return Ok(());
        }
        self.files.read(&self.dem.sources, mosaic, &rect, &mut self.samples)?;
        let samples = SampleRectangle { rect, heights_m: &self.samples };
        for (column, row) in part.nodes() {
            let position = at[row * target.columns + column];
            let height_m = &mut heights_m[target.at(column, row)];
            if height_m.is_nan() && position[0].is_finite() {
                *height_m = kernel.height_m(&samples, position, &mut self.scratch) as f32;
            }
        }
        Ok(())
    }
}

/// The samples on which heights at some positions can depend; `None` if there are none.
pub(crate) fn around(
    positions: impl Iterator<Item = [f64; 2]>,
    kernel: &Kernel,
    extent: &SampleRect,
) -> Option<SampleRect> {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for position in positions {
        // NaN leaves both unchanged.
        for axis in 0..2 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    if !(low[0] <= high[0] && low[1] <= high[1]) {
        return None;
    }
    let reach = kernel.reach();
    let bound = |value: f64| value.clamp(-1e15, 1e15) as i64;
    let rect = SampleRect {
        min: [0, 1].map(|axis| bound(low[axis].floor()) - reach[axis]),
        max: [0, 1].map(|axis| bound(high[axis].ceil()) + reach[axis] + 1),
    };
    let rect = rect.intersection(extent);
    (!rect.is_empty()).then_some(rect)
}
