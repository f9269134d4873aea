//! A region of the lattice with any outline, with fast tests of whether points are inside.

use crate::index_lists::IndexLists;
use crate::node::NodeWindow;
use crate::{LatticeBounds, LatticePoint, cross};

/// The approximate number of edges per band.
const EDGES_PER_BAND: usize = 4;
/// The largest number of bands. The lists of all bands together are at most eight times as long as
/// the list of the edges.
const MOST_BANDS: usize = 1 << 16;
const MOST_ENTRIES_PER_EDGE: usize = 8;

/// A region of the lattice with any outline: polygons with holes, which may overlap. The outline
/// belongs to the region.
///
/// ```text
///   ┌───────────────┐  band 3     a polygon winds once around its interior; a hole undoes that.
///   │    ┌────┐     │  band 2     Edges are listed by bands of rows, so that a question about a row
///   │    └────┘     │  band 1     only tests the edges that cross it.
///   └───────────────┘  band 0
/// ```
///
/// A point is inside if at least one polygon contains it, and not in a hole: the region is the
/// union of the polygons. All tests are exact.
///
/// Source: D. Sunday 2021, *Practical Geometry Algorithms*, "Winding number".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LatticeRegion {
    /// Open rings, outer ones counter-clockwise, holes clockwise.
    rings: Vec<Vec<LatticePoint>>,
    edges: Vec<Edge>,
    bounds: LatticeBounds,
    /// Number of rows of lattice points per band.
    band_steps: i64,
    bands: IndexLists,
}

/// An edge of an outline, directed upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Edge {
    low: LatticePoint,
    high: LatticePoint,
    /// The contribution of the edge to the winding number of points to its right: 1 or −1.
    winding: i32,
}

impl LatticeRegion {
    /// Creates a region from polygons, each given as its outer ring and its holes. Rings may be
    /// closed or open, in either direction; rings that enclose nothing on the lattice are dropped.
    /// `None` if nothing is left.
    #[must_use]
    pub fn new(polygons: &[Vec<Vec<LatticePoint>>]) -> Option<Self> {
        let (mut edges, mut rings) = (Vec::new(), Vec::new());
        for polygon in polygons {
            for (index, ring) in polygon.iter().enumerate() {
                let area = doubled_area(ring);
                if area == 0 && index == 0 {
                    break;
                }
                // Outer rings wind counter-clockwise, holes clockwise, whatever the direction of
                // the input.
                let is_turned = (area > 0) != (index == 0);
                edges.extend(ring_edges(ring).filter_map(|edge| Edge::new(edge, is_turned)));
                let mut own = ring.clone();
                own.dedup();
                own.pop_if(|last| ring.first() == Some(last) && ring.len() > 1);
                if is_turned {
                    own.reverse();
                }
                rings.push(own);
            }
        }
        let corners: Vec<LatticePoint> =
            edges.iter().flat_map(|edge| [edge.low, edge.high]).collect();
        let bounds = LatticeBounds::around(&corners)?;
        let rows = bounds.max.v - bounds.min.v + 1;
        let mut count = (edges.len() / EDGES_PER_BAND).clamp(1, MOST_BANDS);
        let band_steps = loop {
            let band_steps = (rows + count as i64 - 1) / count as i64;
            let bands = |edge: &Edge| ((edge.high.v - edge.low.v) / band_steps) as usize;
            let entries: usize = edges.iter().map(|edge| bands(edge) + 1).sum();
            if count == 1 || entries <= MOST_ENTRIES_PER_EDGE * edges.len() {
                break band_steps;
            }
            count /= 2;
        };
        let band = |v: i64| ((v - bounds.min.v) / band_steps) as usize;
        let bands = IndexLists::new(band(bounds.max.v) + 1, edges.len(), |index| {
            band(edges[index].low.v)..=band(edges[index].high.v)
        });
        Some(Self { rings, edges, bounds, band_steps, bands })
    }

    /// The smallest rectangle around the region.
    #[must_use]
    pub fn bounds(&self) -> LatticeBounds {
        self.bounds
    }

    /// The outlines as open lines, whose last point is joined to the first: counter-clockwise
    /// around the interior, clockwise around holes. Points with a positive winding number are
    /// inside.
    pub fn rings(&self) -> impl Iterator<Item = &[LatticePoint]> {
        self.rings.iter().map(Vec::as_slice)
    }

    /// The edges of outlines that may share a point with a rectangle, in a fixed order, each of
    /// them once.
    pub fn edges_near(
        &self,
        near: &LatticeBounds,
    ) -> impl Iterator<Item = [LatticePoint; 2]> + use<'_> {
        let (west, east) = (near.min.u, near.max.u);
        self.edges_between(near.min.v, near.max.v)
            .filter(move |edge| {
                edge.low.u.min(edge.high.u) <= east && edge.low.u.max(edge.high.u) >= west
            })
            .map(|edge| [edge.low, edge.high])
    }

    /// Whether a point is inside or on an outline.
    #[must_use]
    pub fn contains(&self, point: LatticePoint) -> bool {
        self.contains_half([2 * point.u, 2 * point.v])
    }

    /// Whether a point in half steps of the lattice, `[2 * u, 2 * v]`, is inside or on an outline.
    #[must_use]
    pub fn contains_half(&self, [u2, v2]: [i64; 2]) -> bool {
        let point = LatticePoint::new(u2, v2);
        let row = v2.div_euclid(2);
        let mut winding = 0;
        for edge in self.edges_between(row, row + 1) {
            let (low, high) = (twice(edge.low), twice(edge.high));
            if v2 < low.v || v2 > high.v {
                continue;
            }
            let side = cross(low, high, point);
            let is_between = (low.u.min(high.u)..=low.u.max(high.u)).contains(&u2);
            if side == 0 && is_between {
                return true;
            }
            // If two edges meet at this height, only one of them counts.
            if side < 0 && v2 < high.v {
                winding += edge.winding;
            }
        }
        winding > 0
    }

    /// Which nodes of a window of stride 1 are corners of cells that share more than a point of
    /// their border with the region. `steps` are lattice steps per cell, east and north. Nodes are
    /// in rows from the north.
    ///
    /// So the ground between these nodes covers the region, and extends less than a cell beyond it.
    /// Whether a node counts does not depend on the window.
    #[must_use]
    pub fn nodes(&self, steps: [i64; 2], window: &NodeWindow) -> Vec<bool> {
        let mut inside = Vec::with_capacity(window.columns * window.rows);
        let columns = window.columns + 1;
        let cells = |j: i64| self.cells([window.corner.i - 1, j], columns, steps);
        let mut north = cells(window.corner.j);
        for row in 0..window.rows {
            let south = cells(window.corner.j - row as i64 - 1);
            let is_corner = |column: usize| {
                north[column] || north[column + 1] || south[column] || south[column + 1]
            };
            inside.extend((0..window.columns).map(is_corner));
            north = south;
        }
        inside
    }

    /// Which cells of a row share more than their border with the region: `columns` cells from the
    /// one whose south-west node is `first`.
    fn cells(&self, first: [i64; 2], columns: usize, [east, north]: [i64; 2]) -> Vec<bool> {
        let mut inside = vec![false; columns];
        let [south_v, north_v] = [first[1] * north, (first[1] + 1) * north];
        // The winding numbers of the centres, as differences along the row.
        let mut winding = vec![0; columns + 1];
        for edge in self.edges_between(south_v, north_v) {
            for column in edge.cells_met([south_v, north_v], east, first[0], columns) {
                inside[column] = true;
            }
            if let Some(column) = edge.first_centre_east(south_v + north_v, east) {
                let column = (column - i128::from(first[0])).clamp(0, columns as i128);
                winding[column as usize] += edge.winding;
            }
        }
        let mut sum = 0;
        for (cell, difference) in inside.iter_mut().zip(winding) {
            sum += difference;
            // A cell that no outline enters is inside or outside as a whole.
            *cell |= sum > 0;
        }
        inside
    }

    /// The edges that may have a point between two rows, both included; each of them once.
    fn edges_between(&self, from_v: i64, to_v: i64) -> impl Iterator<Item = &Edge> {
        let band = |v: i64| {
            let v = v.clamp(self.bounds.min.v, self.bounds.max.v);
            ((v - self.bounds.min.v) / self.band_steps) as usize
        };
        let meets = to_v >= self.bounds.min.v && from_v <= self.bounds.max.v;
        let bands = if meets { band(from_v)..band(to_v) + 1 } else { 0..0 };
        let first = bands.start;
        bands.flat_map(move |own| {
            let edges = self.bands.list(own).iter().map(|&index| &self.edges[index as usize]);
            // An edge in several of these bands counts in the first of them.
            edges.filter(move |edge| own == first || band(edge.low.v) == own)
        })
    }
}

impl Edge {
    fn new([from, to]: [LatticePoint; 2], is_turned: bool) -> Option<Self> {
        if from == to {
            return None;
        }
        let is_up = (from.v, from.u) < (to.v, to.u);
        let (low, high) = if is_up { (from, to) } else { (to, from) };
        // The interior is to the left of an outer ring, and so to the right of its edges that go
        // down.
        Some(Self { low, high, winding: if is_up == is_turned { 1 } else { -1 } })
    }

    /// The columns, counted from `first`, of the cells of a row whose interior the edge enters.
    fn cells_met(
        &self,
        [south_v, north_v]: [i64; 2],
        east: i64,
        first: i64,
        columns: usize,
    ) -> std::ops::Range<usize> {
        if self.high.v <= south_v || self.low.v >= north_v {
            return 0..0;
        }
        // The values are fractions with a common denominator.
        let (rise, ends) = if self.low.v == self.high.v {
            (1, [self.low.u, self.high.u].map(i128::from))
        } else {
            let at = |v: i64| self.u_times_rise(2 * i128::from(v)) / 2;
            (self.rise(), [at(self.low.v.max(south_v)), at(self.high.v.min(north_v))])
        };
        let (least, most) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let width = rise * i128::from(east);
        let from = least.div_euclid(width) - i128::from(first);
        // An edge that ends on a border between two cells does not enter the next one.
        let to = -(-most).div_euclid(width) - i128::from(first);
        let [from, to] = [from, to].map(|column| column.clamp(0, columns as i128) as usize);
        from..to.max(from)
    }

    /// The first cell of a row whose centre is to the east of the edge; `None` if the edge does not
    /// cross the row of centres. `v2` is twice the row of the centres.
    fn first_centre_east(&self, v2: i64, east: i64) -> Option<i128> {
        if v2 < 2 * self.low.v || v2 >= 2 * self.high.v {
            return None;
        }
        let (rise, east) = (self.rise(), i128::from(east));
        // The centre of cell i is at (2i + 1) · east / 2.
        Some((self.u_times_rise(i128::from(v2)) - east * rise).div_euclid(2 * east * rise) + 1)
    }

    fn rise(&self) -> i128 {
        i128::from(self.high.v - self.low.v)
    }

    /// Twice the u of the edge at a row, multiplied by its rise; `v2` is twice the row.
    fn u_times_rise(&self, v2: i128) -> i128 {
        let run = i128::from(self.high.u - self.low.u);
        2 * i128::from(self.low.u) * self.rise() + run * (v2 - 2 * i128::from(self.low.v))
    }
}

fn twice(point: LatticePoint) -> LatticePoint {
    LatticePoint::new(2 * point.u, 2 * point.v)
}

/// The edges of a ring, including the one from its last point to its first.
pub fn ring_edges(ring: &[LatticePoint]) -> impl Iterator<Item = [LatticePoint; 2]> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&from, &to)| [from, to])
}

/// Twice the area of a ring; positive if the ring winds counter-clockwise.
#[must_use]
pub fn doubled_area(ring: &[LatticePoint]) -> i128 {
    let Some(&first) = ring.first() else { return 0 };
    ring_edges(ring).map(|[from, to]| cross(first, from, to)).sum()
}

#[cfg(test)]
#[path = "lattice_region_tests.rs"]
mod tests;
