//! The heights of nodes from samples: nodes are samples, or lie between samples; then heights are
//! bilinear, or area averages if a cell contains several samples.

use corniche_geom::NodeIndex;

use crate::mosaics::mosaic::SampleRect;

/// A position this close to a sample, in samples, is on the sample: the rounding error of
/// transformations.
const ON_SAMPLE: f64 = 1e-6;
/// The cell width, in samples, from which heights are averaged.
const AVERAGE_FROM: f64 = 2.0;
/// A node has a height if samples of at least this weight have heights.
const LEAST_WEIGHT: f64 = 0.5;
/// Samples with a smaller variance than this, in samples squared, do not determine a plane.
const LEAST_SPREAD: f64 = 1e-3;

/// Sample (column, row) = (`way[0]` · (`every` · i − `first[0]`), `way[1]` · (`every` · j −
/// `first[1]`)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Alignment {
    /// Index of sample (0, 0), counted in samples from node (0, 0).
    pub(crate) first: [i64; 2],
    pub(crate) way: [i64; 2],
    pub(crate) every: i64,
}

impl Alignment {
    /// The samples under the nodes between two nodes.
    pub(crate) fn samples(&self, nodes: [NodeIndex; 2]) -> SampleRect {
        let [a, b] = nodes.map(|node| self.sample(node));
        let min = [0, 1].map(|axis| a[axis].min(b[axis]));
        SampleRect { min, max: [0, 1].map(|axis| a[axis].max(b[axis]) + 1) }
    }

    /// The south-western and the north-eastern node on samples of a rectangle. Rounded inwards: the
    /// outermost samples can lie between two nodes.
    pub(crate) fn nodes(&self, samples: &SampleRect) -> [NodeIndex; 2] {
        let ends = |axis: usize| {
            let at = |index: i64| self.first[axis] + self.way[axis] * index;
            let (a, b) = (at(samples.min[axis]), at(samples.max[axis] - 1));
            (-(-a.min(b)).div_euclid(self.every), a.max(b).div_euclid(self.every))
        };
        let ((west, east), (south, north)) = (ends(0), ends(1));
        [NodeIndex { i: west, j: south }, NodeIndex { i: east, j: north }]
    }

    /// The sample under a node.
    pub(crate) fn sample(&self, node: NodeIndex) -> [i64; 2] {
        [
            self.way[0] * (self.every * node.i - self.first[0]),
            self.way[1] * (self.every * node.j - self.first[1]),
        ]
    }
}

/// How heights at nodes come from samples.
///
/// Each axis is treated separately: below two samples per cell, linear between the two nearest
/// samples; from two on, the mean of this linear interpolant over the cell's width. Both reproduce
/// planes exactly.
///
/// A linear node without all its samples of positive weight is void. An averaged node is void if
/// less than half of the weight has data; if some samples are missing, the height of the
/// best-fitting plane through the others (weighted least squares) at the node replaces the mean,
/// which would be the mean at another position.
#[derive(Debug, Clone)]
pub(crate) struct Kernel {
    /// The width of the average in samples, columns and rows; 0 is linear.
    width: [f64; 2],
}

/// Weights of consecutive samples along one axis.
#[derive(Debug, Default)]
struct AxisWeights {
    first: i64,
    weights: Vec<f64>,
}

/// Buffers that a reader keeps between nodes.
#[derive(Debug, Default)]
pub(crate) struct KernelBuffers {
    columns: AxisWeights,
    rows: AxisWeights,
}

/// The samples of a rectangle, row by row; NaN for voids.
pub(crate) struct SampleRectangle<'a> {
    pub(crate) rect: SampleRect,
    pub(crate) heights_m: &'a [f64],
}

impl SampleRectangle<'_> {
    fn height_m(&self, column: i64, row: i64) -> f64 {
        let SampleRect { min, max } = self.rect;
        let is_inside = column >= min[0] && column < max[0] && row >= min[1] && row < max[1];
        if is_inside {
            self.heights_m
                [(row - min[1]) as usize * self.rect.columns() + (column - min[0]) as usize]
        } else {
            f64::NAN
        }
    }
}

impl Kernel {
    /// The kernel for cells that are `samples_per_node` samples wide, along columns and rows.
    pub(crate) fn new(samples_per_node: [f64; 2]) -> Self {
        Self {
            width: samples_per_node.map(|width| if width >= AVERAGE_FROM { width } else { 0.0 }),
        }
    }

    pub(crate) fn is_average(&self) -> bool {
        self.width.iter().any(|&width| width > 0.0)
    }

    /// The number of samples on either side on which a node's height can depend, columns and rows.
    pub(crate) fn reach(&self) -> [i64; 2] {
        self.width.map(|width| (width / 2.0).ceil() as i64 + 1)
    }

    /// The height at a position among the samples; NaN in a void.
    pub(crate) fn height_m(
        &self,
        samples: &SampleRectangle<'_>,
        at: [f64; 2],
        scratch: &mut KernelBuffers,
    ) -> f64 {
        if self.is_average() { self.average(samples, at, scratch) } else { bilinear(samples, at) }
    }

    fn average(
        &self,
        samples: &SampleRectangle<'_>,
        at: [f64; 2],
        scratch: &mut KernelBuffers,
    ) -> f64 {
        scratch.columns.compute(at[0], self.width[0]);
        scratch.rows.compute(at[1], self.width[1]);
        let (columns, rows) = (&scratch.columns, &scratch.rows);
        let (mut weight, mut sum, mut is_whole) = (0.0, 0.0, true);
        for (row, row_weight) in (rows.first..).zip(&rows.weights) {
            for (column, column_weight) in (columns.first..).zip(&columns.weights) {
                let height_m = samples.height_m(column, row);
                if height_m.is_nan() {
                    is_whole = false;
                } else {
                    weight += row_weight * column_weight;
                    sum += row_weight * column_weight * height_m;
                }
            }
        }
        if is_whole {
            sum
        } else if weight >= LEAST_WEIGHT {
            plane_fit(samples, at, columns, rows)
        } else {
            f64::NAN
        }
    }
}

fn bilinear(samples: &SampleRectangle<'_>, at: [f64; 2]) -> f64 {
    let [(column, t), (row, s)] = at.map(split);
    // A sample of weight 0 must not be used: it may be void or outside.
    let along = |row: i64| {
        let from = samples.height_m(column, row);
        if t == 0.0 { from } else { from * (1.0 - t) + samples.height_m(column + 1, row) * t }
    };
    if s == 0.0 { along(row) } else { along(row) * (1.0 - s) + along(row + 1) * s }
}

/// The sample at or before a position and the fraction beyond it.
fn split(at: f64) -> (i64, f64) {
    let nearest = at.round();
    if (at - nearest).abs() <= ON_SAMPLE {
        (nearest as i64, 0.0)
    } else {
        (at.floor() as i64, at - at.floor())
    }
}

impl AxisWeights {
    fn compute(&mut self, at: f64, width: f64) {
        self.weights.clear();
        if width == 0.0 {
            let (first, t) = split(at);
            self.first = first;
            self.weights.push(1.0 - t);
            if t > 0.0 {
                self.weights.push(t);
            }
            return;
        }
        let (from, to) = (at - width / 2.0, at + width / 2.0);
        // A sample counts only when the interval of the average overlaps its hat function by more
        // than rounding.
        self.first = (from + ON_SAMPLE).floor() as i64;
        let last = (to - ON_SAMPLE).ceil() as i64;
        for sample in self.first..=last {
            let sample = sample as f64;
            self.weights.push((hat_integral(to - sample) - hat_integral(from - sample)) / width);
        }
    }
}

/// The integral from −1 to `x` of the hat function, which is 1 at 0 and falls to 0 at ±1: the
/// weight of a sample in the linear interpolant.
fn hat_integral(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    if x <= 0.0 { (1.0 + x).powi(2) / 2.0 } else { 1.0 - (1.0 - x).powi(2) / 2.0 }
}

/// The height at `at` of the plane that best fits the samples with data, by weight.
fn plane_fit(
    samples: &SampleRectangle<'_>,
    at: [f64; 2],
    columns: &AxisWeights,
    rows: &AxisWeights,
) -> f64 {
    // Sums of w, w·x, w·y, w·xx, w·xy, w·yy, w·h, w·xh, w·yh about the node.
    let mut sums = [0.0_f64; 9];
    for (row, row_weight) in (rows.first..).zip(&rows.weights) {
        for (column, column_weight) in (columns.first..).zip(&columns.weights) {
            let height_m = samples.height_m(column, row);
            if height_m.is_nan() {
                continue;
            }
            let weight = row_weight * column_weight;
            let (x, y) = (column as f64 - at[0], row as f64 - at[1]);
            let terms = [1.0, x, y, x * x, x * y, y * y, height_m, x * height_m, y * height_m];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += weight * term;
            }
        }
    }
    let [w, x, y, xx, xy, yy, h, xh, yh] = sums;
    let (mean_x, mean_y, mean_h) = (x / w, y / w, h / w);
    let (cxx, cxy, cyy) =
        (xx / w - mean_x * mean_x, xy / w - mean_x * mean_y, yy / w - mean_y * mean_y);
    let (cxh, cyh) = (xh / w - mean_x * mean_h, yh / w - mean_y * mean_h);
    let determinant = cxx * cyy - cxy * cxy;
    // Samples on one line do not determine the slope of a plane; their spread across the line is
    // only rounding.
    if cxx.min(cyy) < LEAST_SPREAD
        || determinant <= LEAST_SPREAD * cxx * cyy
        || determinant.is_nan()
    {
        return f64::NAN;
    }
    let slope_x = (cxh * cyy - cyh * cxy) / determinant;
    let slope_y = (cyh * cxx - cxh * cxy) / determinant;
    mean_h - slope_x * mean_x - slope_y * mean_y
}

#[cfg(test)]
#[path = "kernel_tests.rs"]
mod tests;
