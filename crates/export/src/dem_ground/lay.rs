//! Lines are laid on the ground of the elevation files.
//!
//! ```text
//!   ┌──────┬──────┬──────┐      ●  a point of the line
//!   │   ●╌╌┼╌x╌╌╌╌┼──●   │      │  the line crosses from cell to cell: a vertex
//!   └──────┴──────┴──────┘      x  the middle of what lies in a cell: a vertex
//! ```
//!
//! Along a straight line the bilinear surface of a cell is a parabola, which a vertex in its middle follows nearly. How far the line is from the
//! surface of the files' own samples is measured, since nodes need not be samples.

use crate::{dem_ground::DemNodes, error::ElevationError, piece::Vertex};

/// Crossings that are nearer to each other than this, lattice steps, are one: a node of the grid.
const SAME_PLACE_STEPS: f64 = 1e-3;

/// A line on the ground of the elevation files, without a gap.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DemLine {
    /// Two at least.
    pub(crate) vertices: Vec<Vertex>,
    /// How far the line is from the surface of the files' own samples, at most, metres; `None` where nothing of it lies on that.
    pub(crate) tolerance_m: Option<f64>,
    /// Whether its first vertex is that of the whole line, and its last the last.
    pub(crate) has_end: [bool; 2],
    /// Whether a deck carries it instead.
    pub(crate) on_deck: bool,
}

impl DemLine {
    fn from(first: Vertex, is_first: bool) -> Self {
        let has_end = [is_first, false];
        Self { vertices: vec![first], tolerance_m: None, has_end, on_deck: false }
    }
}

/// Lays a line on the ground: of its vertices, those that are source points, and its ends, tell where it runs. Where there is no ground it has a gap.
pub(crate) fn lay(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
) -> Result<Vec<DemLine>, ElevationError> {
    let last = line.len().saturating_sub(1);
    let is_kept =
        |(index, vertex): &(usize, &Vertex)| vertex.is_source || *index == 0 || *index == last;
    let points: Vec<Vertex> =
        line.iter().enumerate().filter(is_kept).map(|(_, vertex)| *vertex).collect();
    let mut laid = Laid::default();
    for (number, pair) in points.array_windows::<2>().enumerate() {
        let [from, to] = *pair;
        let places = places_between(from.at, to.at, nodes.steps);
        let mut before = laid.begin(nodes, from, number == 0)?;
        let ends = places.len() - 1;
        for (index, [middle, end]) in places.iter().enumerate() {
            let is_end = index == ends;
            let middle_m = nodes.height_m(*middle)?;
            let end_m = nodes.height_m(*end)?;
            if let (Some(_), Some(middle_m), Some(end_m)) = (before, middle_m, end_m) {
                let inner = Vertex { at: *middle, z_m: middle_m, is_source: false };
                let is_source = is_end && to.is_source;
                laid.go_on(inner, Vertex { at: *end, z_m: end_m, is_source });
            } else {
                let is_source = is_end && to.is_source;
                laid.interrupt(end_m.map(|z_m| Vertex { at: *end, z_m, is_source }));
            }
            before = end_m;
        }
    }
    let reaches_end =
        laid.is_open && laid.lines.last().is_some_and(|line| line.vertices.len() >= 2);
    laid.lines.retain(|line| line.vertices.len() >= 2);
    if let Some(line) = laid.lines.last_mut().filter(|_| reaches_end) {
        line.has_end[1] = true;
    }
    for line in &mut laid.lines {
        line.tolerance_m = nodes.farthest_m(&line.vertices)?;
    }
    Ok(laid.lines)
}

#[derive(Default)]
struct Laid {
    lines: Vec<DemLine>,
    /// Whether the last line goes on.
    is_open: bool,
}

impl Laid {
    /// A segment begins at a point. Returns the height there.
    fn begin(
        &mut self,
        nodes: &mut DemNodes<'_>,
        from: Vertex,
        is_first: bool,
    ) -> Result<Option<f64>, ElevationError> {
        let height_m = nodes.height_m(from.at)?;
        if let Some(z_m) = height_m.filter(|_| !self.is_open) {
            self.lines.push(DemLine::from(Vertex { z_m, ..from }, is_first));
        }
        self.is_open = height_m.is_some();
        Ok(height_m)
    }

    fn go_on(&mut self, middle: Vertex, end: Vertex) {
        if let Some(line) = self.lines.last_mut() {
            line.vertices.extend([middle, end]);
        }
    }

    /// There is no ground somewhere before a place, which begins a new line if it has ground itself.
    fn interrupt(&mut self, next: Option<Vertex>) {
        self.is_open = next.is_some();
        self.lines.extend(next.map(|vertex| DemLine::from(vertex, false)));
    }
}

/// How far a line on a package's triangles is from the ground of the elevation files, at most, over the whole line, metres; `None` where no part of
/// it lies on such ground.
pub(crate) fn off_dem_m(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
) -> Result<Option<f64>, ElevationError> {
    let mut divided: Vec<Vertex> = line.first().copied().into_iter().collect();
    for [from, to] in line.array_windows::<2>() {
        let run = [to.at[0] - from.at[0], to.at[1] - from.at[1]];
        let axis = usize::from(run[1].abs() > run[0].abs());
        let on_line = |at: [f64; 2]| {
            let share = (at[axis] - from.at[axis]) / run[axis];
            let share = if share.is_finite() { share } else { 0.0 };
            Vertex { at, z_m: from.z_m + share * (to.z_m - from.z_m), is_source: false }
        };
        divided.extend(
            places_between(from.at, to.at, nodes.steps).into_flattened().into_iter().map(on_line),
        );
    }
    nodes.farthest_m(&divided)
}

/// What lies between two places, cell by cell: the middle and the end of each part. The last end is the second place. The places are the same in both
/// directions.
pub(crate) fn places_between(from: [f64; 2], to: [f64; 2], steps: [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let is_turned = from > to;
    let [low, high] = if is_turned { [to, from] } else { [from, to] };
    let mut places = vec![low];
    places.extend(crossings(low, high, steps));
    places.push(high);
    if is_turned {
        places.reverse();
    }
    let middle = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|axis| f64::midpoint(a[axis], b[axis]));
    places.array_windows().map(|&[a, b]| [middle(a, b), b]).collect()
}

/// Where a segment crosses lines of the grid, in its direction; not its ends.
fn crossings(from: [f64; 2], to: [f64; 2], steps: [f64; 2]) -> Vec<[f64; 2]> {
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for axis in 0..2 {
        let other = 1 - axis;
        let [low, high] = [from[axis].min(to[axis]), from[axis].max(to[axis])];
        let run = to[axis] - from[axis];
        let mut line = (low / steps[axis]).floor() + 1.0;
        while line * steps[axis] < high {
            let share = (line * steps[axis] - from[axis]) / run;
            let mut at = [0.0; 2];
            at[axis] = line * steps[axis];
            at[other] = from[other] + share * (to[other] - from[other]);
            found.push((share, at));
            line += 1.0;
        }
    }
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut places: Vec<[f64; 2]> = Vec::with_capacity(found.len());
    for (_, at) in found {
        match places.last_mut() {
            Some(last)
                if (last[0] - at[0]).abs() < SAME_PLACE_STEPS
                    && (last[1] - at[1]).abs() < SAME_PLACE_STEPS =>
            {
                // Both lie on lines of the grid, so this is a node.
                *last = [0, 1].map(|axis| (at[axis] / steps[axis]).round() * steps[axis]);
            }
            _ => places.push(at),
        }
    }
    places
}

#[cfg(test)]
#[path = "lay_tests.rs"]
mod tests;
