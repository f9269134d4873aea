//! Checks that the objects of layers end at the polygon to which the package was clipped.
//!
//! The build cuts outlines with a library that splits them at their crossings. This check cuts
//! nothing: for points it determines the side of the polygon and the distance from its outline.

use std::f64::consts::TAU;

use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion, TileId, cross};
use corniche_tileset::LayerShape;
use corniche_work::Stage;

use super::{
    checks::{CheckId, Findings},
    each_tile::VerifyRun,
    error::Result,
    geo_against_sv::distance,
};

/// The tolerance beyond the polygon on coarse levels, in cells of the level. Points lie on a
/// lattice of at most a quarter of a cell, to which the polygon's outline is rounded, too, and
/// lines are simplified by a quarter of a cell.
const BEYOND_CELLS: f64 = 0.75;
/// The tolerance on the finest level, in metres: the step of its lattice is at most 0.1 m.
const BEYOND_FINEST_M: f64 = 0.3;
/// The tolerance in lattice steps, if the package's lattice is coarser than that.
const BEYOND_STEPS: f64 = 3.0;

/// Checks the objects of all tiles. `region` is the polygon.
pub(crate) fn verify(
    run: &VerifyRun<'_>,
    region: &LatticeRegion,
    findings: &mut Findings,
) -> Result<()> {
    let package = run.package;
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let look_at = |id: TileId| {
        let mut findings = Findings::default();
        // Unreadable tiles are reported by the check of tiles.
        let Some(payload) = package.tile(id).ok().flatten() else { return Ok(findings) };
        let cut = Cut { region, beyond: beyond_steps(frame, id.z()) };
        for (slot, layer) in manifest.layers() {
            for object in manifest.decode_layer(&payload, id, slot).unwrap_or_default() {
                findings.look(CheckId::LayerPolygon, cut.holds_shape(&object.shape), || {
                    let (object, layer) = (object.object, &layer.table.id);
                    format!("{object} of layer {layer:?} in tile {id} reaches beyond the polygon")
                });
            }
        }
        Ok(findings)
    };
    run.each_tile(Stage::ComparePolygon, look_at, |_, found| findings.merge(found))
}

/// The tolerance beyond the polygon on a level, in lattice steps.
fn beyond_steps(frame: &GridFrame, level: u8) -> f64 {
    let beyond_m = if level == frame.max_level() {
        BEYOND_FINEST_M
    } else {
        BEYOND_CELLS * frame.level_cell(level).shorter_m()
    };
    (beyond_m / frame.lattice_step_m()).max(BEYOND_STEPS)
}

/// A polygon, and the tolerance beyond it in lattice steps.
struct Cut<'a> {
    region: &'a LatticeRegion,
    beyond: f64,
}

impl Cut<'_> {
    /// Whether an object stays within the polygon.
    fn holds_shape(&self, shape: &LayerShape) -> bool {
        match shape {
            LayerShape::Line(points) => {
                points.array_windows().all(|&[from, to]| self.holds(from, to))
            }
            LayerShape::Area(_) => self.holds_area(shape),
            LayerShape::Point(point) => self.holds(*point, *point),
        }
    }

    /// Whether an area stays within the polygon: all its outlines do, and no corner of the polygon
    /// or of its holes, with ground beyond the corner, lies deep inside the area.
    ///
    /// ```text
    ///   ┌───────── area ──┐      The outlines of an area around a hole
    ///   │    ┌──────┐     │      of the polygon lie inside the polygon;
    ///   │    │ hole │     │      a corner of the hole shows that the
    ///   │    └──────×     │      area covers the hole.
    ///   └─────────────────┘
    /// ```
    fn holds_area(&self, area: &LayerShape) -> bool {
        let outlines = || {
            let rings = area.rings();
            rings.flat_map(|ring| ring.iter().copied().zip(ring.iter().copied().cycle().skip(1)))
        };
        if !outlines().all(|(from, to)| self.holds(from, to)) {
            return false;
        }
        let points: Vec<LatticePoint> = outlines().map(|(point, _)| point).collect();
        let Some(bounds) = LatticeBounds::around(&points) else { return true };
        let deep = 4.0 * self.beyond;
        let lies_deep = |corner: LatticePoint| {
            is_within(corner, outlines())
                && outlines().all(|(from, to)| distance(at(corner), [at(from), at(to)]) > deep)
        };
        let mut corners = self.region.edges_near(&bounds).flatten();
        !corners.any(|corner| self.has_ground_beyond(corner, deep) && lies_deep(corner))
    }

    /// Whether a segment stays within the polygon: both ends do, and the middle of each stretch
    /// between crossings with the outline.
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

    /// Whether a point is in the polygon, or near enough to one of these edges of the polygon.
    fn holds_point(&self, place: [f64; 2], near: &[[LatticePoint; 2]]) -> bool {
        self.region.contains_half(place.map(|steps| (2.0 * steps).round() as i64))
            || near.iter().any(|ends| distance(place, ends.map(at)) <= self.beyond)
    }

    /// Whether the ground around a corner of the polygon, at this many steps, lies beyond the
    /// polygon by more than the tolerance. Where polygons overlap, corners lie inside.
    fn has_ground_beyond(&self, corner: LatticePoint, steps: f64) -> bool {
        let [u, v] = at(corner);
        let around = [[u - steps, v - steps], [u + steps, v + steps]];
        let near = self.edges_near(around);
        (0..16).any(|sixteenth| {
            let (sine, cosine) = (f64::from(sixteenth) * TAU / 16.0).sin_cos();
            !self.holds_point([u + steps * cosine, v + steps * sine], &near)
        })
    }

    /// The edges of the polygon that may be within the tolerance of the rectangle between two
    /// points.
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

/// Whether a point lies inside the outlines: a ray to the east crosses them an odd number of times.
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
