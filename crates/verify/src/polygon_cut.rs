//! Whether areas and lines with classes end at the polygon that the package was cut with.
//!
//! The build cuts outlines with a library that splits them at their crossings. Here nothing is cut: points are asked on which side of the polygon
//! they lie, and how far from its outline.

use std::f64::consts::TAU;

use corniche_areas::ClassedLayer;
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion, TileId, cross};
use corniche_spec::Observer;
use corniche_tileset::{AreaRecord, FilePackage, decode_areas, decode_lines};

use super::{
    checks::{CheckId, Findings},
    each_tile::each_tile,
    error::VerifyError,
    geo_against_sv::distance,
    lines::LineChecks,
};

/// How far something may reach beyond the polygon on coarse levels, in cells of the level. Points lie on a lattice of at most a quarter of a cell, on
/// which the polygon's outline is put, too, and lines are simplified by a quarter.
const BEYOND_CELLS: f64 = 0.75;
/// The same on the finest level, metres: its lattice has at most 0.1 m.
const BEYOND_FINEST_M: f64 = 0.3;
/// Where the lattice of the package is coarser than that, so many of its steps.
const BEYOND_STEPS: f64 = 3.0;

/// Looks at the areas and lines of all tiles. `region` is the polygon.
pub(crate) fn verify(
    package: &FilePackage,
    region: &LatticeRegion,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let frame = &package.manifest().frame;
    let look_at = |id: TileId| {
        let mut findings = Findings::default();
        // Tiles that cannot be read are told elsewhere.
        let Some(payload) = package.tile(id).ok().flatten() else { return Ok(findings) };
        let cut = Cut { region, beyond: beyond_steps(frame, id.z()) };
        for area in decode_areas(&payload, id, frame).unwrap_or_default() {
            findings.look(CheckId::AreaPolygon, cut.holds_area(&area), || {
                format!("{} {} of tile {id} lies beyond it", area.class, area.object)
            });
        }
        for layer in ClassedLayer::ALL {
            for line in decode_lines(&payload, id, layer).unwrap_or_default() {
                let check = LineChecks::of(layer).polygon;
                findings.look(check, cut.holds_line(&line.points), || {
                    format!("{} way {} of tile {id} lies beyond it", line.class, line.way_id)
                });
            }
        }
        Ok(findings)
    };
    each_tile(package, threads, observer, look_at, |_, found| findings.merge(found))
}

/// How far something on a level may reach beyond the polygon, lattice steps.
fn beyond_steps(frame: &GridFrame, level: u8) -> f64 {
    let beyond_m = if level == frame.max_level() {
        BEYOND_FINEST_M
    } else {
        BEYOND_CELLS * frame.level_cell(level).shorter_m()
    };
    (beyond_m / frame.lattice_step_m()).max(BEYOND_STEPS)
}

/// A polygon, and how far something may reach beyond it, lattice steps.
struct Cut<'a> {
    region: &'a LatticeRegion,
    beyond: f64,
}

impl Cut<'_> {
    /// Whether an area keeps to the polygon: all its outlines do, and no corner of the polygon or of its holes, with ground beyond it, lies deep
    /// in the area.
    ///
    /// ```text
    ///   ┌───────── area ──┐      The outlines of an area around a hole of the polygon lie inside; a corner of the hole tells that
    ///   │    ┌──────┐     │      the area covers it.
    ///   │    │ hole │     │
    ///   │    └──────×     │
    ///   └─────────────────┘
    /// ```
    fn holds_area(&self, area: &AreaRecord) -> bool {
        let outlines = || {
            let rings = area.rings();
            rings.flat_map(|ring| ring.iter().copied().zip(ring.iter().copied().cycle().skip(1)))
        };
        if !outlines().all(|(from, to)| self.holds(from, to)) {
            return false;
        }
        let points: Vec<LatticePoint> = outlines().map(|(point, _)| point).collect();
        let Some(bounds) = LatticeBounds::of(&points) else { return true };
        let deep = 4.0 * self.beyond;
        let lies_deep = |corner: LatticePoint| {
            is_within(corner, outlines())
                && outlines().all(|(from, to)| distance(at(corner), [at(from), at(to)]) > deep)
        };
        let mut corners = self.region.edges_near(&bounds).flatten();
        !corners.any(|corner| self.has_ground_beyond(corner, deep) && lies_deep(corner))
    }

    /// Whether a line keeps to the polygon.
    fn holds_line(&self, points: &[LatticePoint]) -> bool {
        points.array_windows().all(|&[from, to]| self.holds(from, to))
    }

    /// Whether a segment keeps to the polygon: both ends do, and the middle of each stretch between places where it crosses the outline.
    fn holds(&self, from: LatticePoint, to: LatticePoint) -> bool {
        let [start, way] = [at(from), [0, 1].map(|axis| at(to)[axis] - at(from)[axis])];
        let near = self.edges_near([start, at(to)]);
        let mut shares = vec![0.0, 0.0, 1.0, 1.0];
        for [a, b] in &near {
            let [a_side, b_side] = [a, b].map(|end| cross(from, to, *end) as f64);
            let [from_side, to_side] = [from, to].map(|end| cross(*a, *b, end) as f64);
            if (a_side < 0.0) != (b_side < 0.0) && (from_side < 0.0) != (to_side < 0.0) {
                shares.push(from_side / (from_side - to_side));
            }
        }
        shares.sort_by(f64::total_cmp);
        shares.array_windows().all(|[one, next]| {
            let share = f64::midpoint(*one, *next);
            self.holds_point([0, 1].map(|axis| start[axis] + share * way[axis]), &near)
        })
    }

    /// Whether a place is in the polygon, or near enough to one of these edges of it.
    fn holds_point(&self, place: [f64; 2], near: &[[LatticePoint; 2]]) -> bool {
        self.region.contains_half(place.map(|steps| (2.0 * steps).round() as i64))
            || near.iter().any(|ends| distance(place, ends.map(at)) <= self.beyond)
    }

    /// Whether ground so many steps from a corner of the polygon lies beyond it by more than is allowed. Where polygons overlap, corners lie inside.
    fn has_ground_beyond(&self, corner: LatticePoint, steps: f64) -> bool {
        let [u, v] = at(corner);
        let around = [[u - steps, v - steps], [u + steps, v + steps]];
        let near = self.edges_near(around);
        (0..16).any(|sixteenth| {
            let (sine, cosine) = (f64::from(sixteenth) * TAU / 16.0).sin_cos();
            !self.holds_point([u + steps * cosine, v + steps * sine], &near)
        })
    }

    /// The edges of the polygon that may be within the allowed distance of the rectangle between two places.
    fn edges_near(&self, [one, other]: [[f64; 2]; 2]) -> Vec<[LatticePoint; 2]> {
        let corner = |of: fn(f64, f64) -> f64, beyond: f64| {
            let [u, v] = [0, 1].map(|axis| (of(one[axis], other[axis]) + beyond).round() as i64);
            LatticePoint::new(u, v)
        };
        let beyond = self.beyond + 1.0;
        let near = LatticeBounds { min: corner(f64::min, -beyond), max: corner(f64::max, beyond) };
        self.region.edges_near(&near).collect()
    }
}

fn at(point: LatticePoint) -> [f64; 2] {
    [point.u as f64, point.v as f64]
}

/// Whether a point lies in what outlines are around: a ray to the east crosses them an odd number of times.
fn is_within(
    point: LatticePoint,
    outlines: impl Iterator<Item = (LatticePoint, LatticePoint)>,
) -> bool {
    let crossed = outlines.filter(|(from, to)| {
        let (low, high) = if from.v < to.v { (from, to) } else { (to, from) };
        (low.v..high.v).contains(&point.v) && cross(*low, *high, point) > 0
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
#[path = "polygon_cut_tests.rs"]
mod tests;
