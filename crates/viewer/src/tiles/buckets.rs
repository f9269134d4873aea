use std::ops::RangeInclusive;

use super::GroundVertex;

/// Buckets along each side.
const SIDE: usize = 32;
/// A share of its extent by which a triangle reaches beyond its corners: look-ups grant each of its barycentric weights a
/// millionth, so up to two of them, and the rest is for rounding.
const SLACK: f64 = 4e-6;

/// Which triangles of a surface are near a place in plan.
///
/// ```text
///  starts     0   2   2   5 …          one more than there are buckets
///             │       │   │
///  triangles  7 9     1 7 8 …          of each bucket, ascending
/// ```
///
/// Takes 4 KiB a tile, and 4 bytes for each bucket that the box around a triangle touches: some 8 bytes a triangle where
/// they are smaller than buckets, and at most 4 KiB a triangle where they are as large as the tile.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Buckets {
    /// West and south of the surface.
    min: [f64; 2],
    /// Buckets per metre along each axis.
    per_m: [f64; 2],
    /// How far triangles may reach beyond the buckets in which their corners lie, metres.
    slack_m: f64,
    /// Where each bucket begins among `triangles`, row by row from the south; empty without triangles.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Buckets {
    /// Of triangles given by three indices each.
    pub(crate) fn new(vertices: &[GroundVertex], surface: &[u32]) -> Self {
        let boxes: Vec<[[f64; 2]; 2]> = surface
            .chunks_exact(3)
            .map(|corners| {
                let plan = corners.iter().map(|index| {
                    let [x, y, _] = vertices[*index as usize].position_in_tile;
                    [f64::from(x), f64::from(y)]
                });
                plan.fold(NO_BOX, |around, at| grown(around, [at, at]))
            })
            .collect();
        if boxes.is_empty() {
            return Self::default();
        }
        let [min, max] = boxes.iter().fold(NO_BOX, |around, of_one| grown(around, *of_one));
        let extent_m = [0, 1].map(|axis: usize| (max[axis] - min[axis]).max(f64::MIN_POSITIVE));
        let mut buckets = Self {
            min,
            per_m: extent_m.map(|side_m| SIDE as f64 / side_m),
            slack_m: extent_m[0].max(extent_m[1]) * SLACK,
            starts: vec![0; SIDE * SIDE + 1],
            triangles: Vec::new(),
        };
        let touched: Vec<[RangeInclusive<usize>; 2]> =
            boxes.iter().map(|[low, high]| buckets.ranges(*low, *high)).collect();
        // Count, then fill: a bucket's start moves to its end while it is filled, that is to the next one's start.
        let mut starts = vec![0_u32; SIDE * SIDE + 1];
        for bucket in touched.iter().flat_map(of_ranges) {
            starts[bucket + 1] += 1;
        }
        for bucket in 0..SIDE * SIDE {
            starts[bucket + 1] += starts[bucket];
        }
        buckets.starts.clone_from(&starts);
        buckets.triangles = vec![0; starts[SIDE * SIDE] as usize];
        for (triangle, ranges) in (0..).zip(&touched) {
            for bucket in of_ranges(ranges) {
                buckets.triangles[starts[bucket] as usize] = triangle;
                starts[bucket] += 1;
            }
        }
        buckets
    }

    /// The triangles that may hold a place, ascending; all that hold it are among them.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> &[u32] {
        if self.starts.is_empty() {
            return &[];
        }
        self.of(self.bucket(1, y) * SIDE + self.bucket(0, x))
    }

    /// The triangles that may be met by a level line from one place to another, column by column on the way, and for each
    /// column the share of the way at which it begins. A triangle may come several times.
    pub(crate) fn along(
        &self,
        from: [f64; 2],
        to: [f64; 2],
    ) -> impl Iterator<Item = (f64, impl Iterator<Item = u32>)> {
        let way = [0, 1].map(|axis| to[axis] - from[axis]);
        let (first, last) =
            (self.bucket(0, from[0].min(to[0])), self.bucket(0, from[0].max(to[0])));
        let columns = if self.starts.is_empty() { 0 } else { last - first + 1 };
        (0..columns).map(move |step| {
            let column = if way[0] < 0.0 { last - step } else { first + step };
            // The outermost columns hold what lies beyond them too.
            let edge_m = |column: usize| self.min[0] + column as f64 / self.per_m[0];
            let west_m =
                if column == 0 { f64::NEG_INFINITY } else { edge_m(column) - self.slack_m };
            let is_last = column == SIDE - 1;
            let east_m = if is_last { f64::INFINITY } else { edge_m(column + 1) + self.slack_m };
            let share = |x: f64| ((x - from[0]) / way[0]).clamp(0.0, 1.0);
            // A way along the column is in it from end to end.
            let (enters, leaves) = match way[0] {
                0.0 => (0.0, 1.0),
                ahead if ahead > 0.0 => (share(west_m), share(east_m)),
                _ => (share(east_m), share(west_m)),
            };
            let y = [enters, leaves].map(|share| from[1] + way[1] * share);
            let rows = self.ranges([0.0, y[0].min(y[1])], [0.0, y[0].max(y[1])])[1].clone();
            let near = rows.flat_map(move |row| self.of(row * SIDE + column).iter().copied());
            (enters, near)
        })
    }

    fn of(&self, bucket: usize) -> &[u32] {
        &self.triangles[self.starts[bucket] as usize..self.starts[bucket + 1] as usize]
    }

    /// Columns and rows of all that lies within the slack of a box.
    fn ranges(&self, low: [f64; 2], high: [f64; 2]) -> [RangeInclusive<usize>; 2] {
        [0, 1].map(|axis| {
            self.bucket(axis, low[axis] - self.slack_m)
                ..=self.bucket(axis, high[axis] + self.slack_m)
        })
    }

    /// The column or row of a place; of places outside the one next to them.
    fn bucket(&self, axis: usize, at: f64) -> usize {
        // A cast takes what is below 0, and what is no number, to 0.
        (((at - self.min[axis]) * self.per_m[axis]) as usize).min(SIDE - 1)
    }
}

/// Holds nothing.
const NO_BOX: [[f64; 2]; 2] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

fn grown([low, high]: [[f64; 2]; 2], [other_low, other_high]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [
        [0, 1].map(|axis: usize| low[axis].min(other_low[axis])),
        [0, 1].map(|axis: usize| high[axis].max(other_high[axis])),
    ]
}

/// Row by row.
fn of_ranges([columns, rows]: &[RangeInclusive<usize>; 2]) -> impl Iterator<Item = usize> {
    rows.clone().flat_map(|row| columns.clone().map(move |column| row * SIDE + column))
}

#[cfg(test)]
#[path = "buckets_tests.rs"]
mod tests;
