//! Measures the distance of lines from the surface of the DEM's own samples.

use std::sync::Arc;

use corniche_geom::along;
use corniche_gis::CrsOperation;
use corniche_work::Recent;

use crate::mosaics::mosaic::{Mosaic, SampleRect};
use crate::mosaics::open_files::OpenFiles;
use crate::{Dem, GridPlan, ReadHeightsError};

/// Samples along each side of a block.
const BLOCK_SAMPLES: i64 = 64;
/// The size of the cache of blocks in bytes, for about 512 blocks.
const KEPT_BYTES: u64 = 17 << 20;

/// The heights of the samples of a block, row by row.
type CachedSamples = Arc<Vec<f64>>;
/// The index of a mosaic, and a block of its samples.
type BlockKey = (usize, [i64; 2]);
/// A stretch of a segment: its two ends as fractions of the segment.
type Stretch = [f64; 2];

/// The surface of the DEM's samples, as in the files: bilinear between four samples of one grid.
/// Where grids overlap, the first named one that has all four counts. The surface does not depend
/// on the grid of a package.
pub struct SampleSurface<'a> {
    dem: &'a Dem,
    /// For each mosaic, the operation from working metres to its CRS.
    crs_from_working: Vec<CrsOperation>,
    files: OpenFiles,
    kept: Recent<BlockKey, Vec<f64>>,
    /// The most recently used block.
    last: Option<(BlockKey, CachedSamples)>,
}

/// A half of a straight part of a line: from one position among a mosaic's samples to another, and
/// the largest distance between the line and the chord, in samples.
#[derive(Clone, Copy)]
struct Half {
    from: [f64; 2],
    to: [f64; 2],
    bow: [f64; 2],
}

impl Dem {
    /// The surface of the DEM's samples, for lines in the working metres of a plan.
    #[must_use]
    pub fn sample_surface<'a>(&'a self, plan: &GridPlan) -> SampleSurface<'a> {
        let operation = |mosaic: &Mosaic| mosaic.crs_from_working(&plan.working, self.wgs84_bounds);
        SampleSurface {
            dem: self,
            crs_from_working: self.mosaics.iter().map(operation).collect(),
            files: OpenFiles::default(),
            kept: Recent::new(KEPT_BYTES),
            last: None,
        }
    }
}

impl SampleSurface<'_> {
    /// The largest vertical distance between a line and the surface in metres, over the whole line;
    /// `None` if no surface is beneath the line.
    ///
    /// The line consists of the ends of straight parts, and the middle between each two of them: an
    /// odd number of positions in working metres, with heights.
    ///
    /// ```text
    ///   ●─────┬──m──┬──────●     ●  ends of a straight part,  m  its middle
    ///         └─ lines of the samples' grid: between two of them the distance is a parabola
    /// ```
    ///
    /// # Errors
    /// When a file cannot be read, or PROJ fails.
    pub fn largest_distance_m(
        &mut self,
        line: &[[f64; 3]],
    ) -> Result<Option<f64>, ReadHeightsError> {
        let mut places = Vec::with_capacity(self.crs_from_working.len());
        for (mosaic, operation) in self.dem.mosaics.iter().zip(&self.crs_from_working) {
            let mut at: Vec<[f64; 2]> = line.iter().map(|&[x, y, _]| [x, y]).collect();
            operation.apply_to_pixels(&mosaic.crs_from_sample, &mut at)?;
            places.push(at);
        }
        let mut most_m: Option<f64> = None;
        for index in 1..line.len() {
            let heights_m = [line[index - 1][2], line[index][2]];
            let mut open: Vec<Stretch> = vec![[0.0, 1.0]];
            for (mosaic, at) in places.iter().enumerate() {
                let half = Half::from_positions(at, index);
                let mut left = Vec::new();
                for stretch in std::mem::take(&mut open) {
                    let own_m = self.stretch_m((mosaic, half), heights_m, stretch, &mut left)?;
                    most_m = [most_m, own_m].into_iter().flatten().reduce(f64::max);
                }
                open = left;
            }
        }
        Ok(most_m)
    }

    /// The largest distance along a stretch of a segment; stretches without a surface of this
    /// mosaic beneath remain.
    fn stretch_m(
        &mut self,
        (mosaic, half): (usize, Half),
        heights_m: [f64; 2],
        [begin, end]: Stretch,
        left: &mut Vec<Stretch>,
    ) -> Result<Option<f64>, ReadHeightsError> {
        let Half { from, to, bow } = half;
        if !from.into_iter().chain(to).all(f64::is_finite) {
            left.push([begin, end]);
            return Ok(None);
        }
        let at = |share: f64| along(from, to, share);
        let mut shares = vec![begin, end];
        for axis in 0..2 {
            let [one, other] = [at(begin)[axis], at(end)[axis]];
            let (low, high) = (one.min(other), one.max(other));
            let mut grid_line = low.floor() + 1.0;
            while grid_line < high {
                let share = (grid_line - from[axis]) / (to[axis] - from[axis]);
                shares.push(share.clamp(begin, end));
                grid_line += 1.0;
            }
        }
        shares.sort_by(f64::total_cmp);
        let mut most_m: Option<f64> = None;
        for &[first, last] in shares.array_windows::<2>() {
            if last <= first {
                continue;
            }
            let cell = at(f64::midpoint(first, last)).map(f64::floor);
            let corners_m = self.corners_m(mosaic, cell.map(|index| index as i64))?;
            if corners_m.iter().any(|height_m| height_m.is_nan()) {
                left.push([first, last]);
                continue;
            }
            let off_m = |share: f64| {
                let [column, row] = at(share);
                let line_m = heights_m[0] + share * (heights_m[1] - heights_m[0]);
                line_m - bilinear_m(corners_m, [column - cell[0], row - cell[1]])
            };
            let middle = f64::midpoint(first, last);
            let [nw, ne, sw, se] = corners_m;
            let slope_m =
                [(ne - nw).abs().max((se - sw).abs()), (sw - nw).abs().max((se - ne).abs())];
            let own_m = largest_of_parabola(off_m(first), off_m(middle), off_m(last))
                + bow[0] * slope_m[0]
                + bow[1] * slope_m[1];
            most_m = Some(most_m.map_or(own_m, |most_m: f64| most_m.max(own_m)));
        }
        Ok(most_m)
    }

    /// The heights at the corners of a cell of samples: first row, then second.
    fn corners_m(
        &mut self,
        mosaic: usize,
        [column, row]: [i64; 2],
    ) -> Result<[f64; 4], ReadHeightsError> {
        let mut corners_m = [0.0; 4];
        for (corner_m, [across, along]) in
            corners_m.iter_mut().zip([[0, 0], [1, 0], [0, 1], [1, 1]])
        {
            *corner_m = self.sample_m(mosaic, [column + across, row + along])?;
        }
        Ok(corners_m)
    }

    fn sample_m(&mut self, mosaic: usize, sample: [i64; 2]) -> Result<f64, ReadHeightsError> {
        let key = (mosaic, sample.map(|index| index.div_euclid(BLOCK_SAMPLES)));
        let [column, row] = sample.map(|index| index.rem_euclid(BLOCK_SAMPLES) as usize);
        let at = row * BLOCK_SAMPLES as usize + column;
        if let Some((_, block)) = self.last.as_ref().filter(|(last, _)| *last == key) {
            return Ok(block[at]);
        }
        let Self { dem, files, kept, .. } = self;
        let read = || {
            let min = key.1.map(|number| number * BLOCK_SAMPLES);
            let rect = SampleRect { min, max: min.map(|index| index + BLOCK_SAMPLES) };
            let mut heights_m = Vec::new();
            files.read(&dem.sources, &dem.mosaics[mosaic], &rect, &mut heights_m)?;
            Ok::<_, ReadHeightsError>(heights_m)
        };
        let block = kept.get(key, read, |block| size_of_val(&block[..]) as u64)?;
        let height_m = block[at];
        self.last = Some((key, block));
        Ok(height_m)
    }
}

impl Half {
    /// The half that ends at a position of a line. Straight parts of a map bend a little among
    /// samples of another CRS: each half is off its chord by an eighth of the second difference of
    /// the whole; the tolerance is twice this.
    fn from_positions(at: &[[f64; 2]], index: usize) -> Self {
        let middle = index - (index + 1) % 2;
        let ends = [at[middle - 1], at[(middle + 1).min(at.len() - 1)]];
        let bow =
            |axis: usize| (ends[0][axis] - 2.0 * at[middle][axis] + ends[1][axis]).abs() / 4.0;
        Self { from: at[index - 1], to: at[index], bow: [bow(0), bow(1)] }
    }
}

fn bilinear_m([nw, ne, sw, se]: [f64; 4], [across, along]: [f64; 2]) -> f64 {
    let north = nw + across * (ne - nw);
    let south = sw + across * (se - sw);
    north + along * (south - north)
}

/// The largest absolute value of a parabola between two positions, from its values there and in the
/// middle: along a straight line, heights over a bilinear cell are a parabola.
#[must_use]
pub fn largest_of_parabola(from: f64, middle: f64, to: f64) -> f64 {
    let square = 2.0 * (from - 2.0 * middle + to);
    let slope = 4.0 * middle - 3.0 * from - to;
    let apex = -slope / (2.0 * square);
    let at_apex =
        if apex > 0.0 && apex < 1.0 { from + apex * (slope + apex * square) } else { from };
    [from, middle, to, at_apex].into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

#[cfg(test)]
#[path = "sample_surface_tests.rs"]
mod tests;
