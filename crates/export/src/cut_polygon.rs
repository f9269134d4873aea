//! Clips areas to a rectangle of longitudes and latitudes, whose sides are bent in the package's
//! projection.

use std::collections::BTreeMap;

use corniche_areas::{Polygon, cut_out};
use corniche_geom::{LatticeBounds, LatticePoint};

use crate::{
    bounds::DegreeBounds,
    cut::{STEPS, STRAIGHT_DEG, polygons_of},
    places::Places,
    plane::{self, distance, nearest_point},
};

/// A polygon as rings of positions in working metres, the outer one first.
pub(crate) type Rings = Vec<Vec<[f64; 2]>>;

/// A corner: its position in working metres, and in degrees relative to the bounds (see
/// [`DegreeBounds::relative`]).
#[derive(Clone, Copy)]
struct Corner {
    at_m: [f64; 2],
    at_deg: [f64; 2],
    /// Whether the corner was added between two corners of the polygon.
    is_between: bool,
}

/// The rings of a polygon of the package.
pub(crate) fn rings_of(polygon: &Polygon, places: &Places<'_>) -> Rings {
    let frame = &places.manifest.frame;
    let position = |point: &LatticePoint| frame.position_m(*point);
    polygon.rings().map(|ring| ring.points().iter().map(position).collect()).collect()
}

/// Clips a polygon to the bounds. Returns `None` if that is impossible, for example around a pole.
///
/// The polygon is clipped on a lattice of degrees, where the rectangle's sides are straight. Its
/// own lines must be straight there as well, so lines that the projection bends get intermediate
/// points, which are removed again afterwards. New corners are on the sides of the rectangle. If
/// features have the package's coordinates, a side gets as many corners as it needs to follow its
/// bend.
pub(crate) fn cut_polygon_at_bounds(
    polygon: &Polygon,
    bounds: &DegreeBounds,
    places: &Places<'_>,
) -> Option<Vec<Rings>> {
    let cutting = Cutting { bounds, places };
    let whole = rings_of(polygon, places);
    let mut first = None;
    let corners = whole.iter().map(|ring| cutting.corners(ring, &mut first));
    let rings = corners.collect::<Option<Vec<Vec<Corner>>>>()?;
    // The working metres of each corner; `None` for intermediate points.
    let mut known: BTreeMap<LatticePoint, Option<[f64; 2]>> = BTreeMap::new();
    let mut on_lattice: Vec<Vec<LatticePoint>> = Vec::with_capacity(rings.len());
    for ring in &rings {
        let mut points = Vec::with_capacity(ring.len());
        for Corner { at_m, at_deg, is_between } in ring {
            let point = lattice_point(*at_deg);
            if !is_between || !known.contains_key(&point) {
                known.insert(point, (!is_between).then_some(*at_m));
            }
            points.push(point);
        }
        on_lattice.push(points);
    }
    let limits = bounds.limits().into_iter().map(lattice_limits);
    let is_inside = |limits: &LatticeBounds| {
        let is_in = |point: &LatticePoint| limits.contains(*point);
        on_lattice.iter().flatten().all(is_in)
    };
    if limits.clone().any(|limits| is_inside(&limits)) {
        return Some(vec![whole]);
    }
    let polygons = polygons_of(&on_lattice)?;
    let mut cut = Vec::new();
    for limits in limits {
        for polygon in cut_out(&polygons, &limits).ok()? {
            let rings = polygon.rings().map(|ring| cutting.ring(ring.segments(), &limits, &known));
            cut.push(rings.collect::<Option<Rings>>()?);
        }
    }
    Some(cut)
}

struct Cutting<'a> {
    bounds: &'a DegreeBounds,
    places: &'a Places<'a>,
}

impl Cutting<'_> {
    /// Returns the corners of a ring, with intermediate points where its lines are bent in degrees.
    /// Longitudes continue from `first`, the polygon's first corner.
    fn corners(&self, ring: &[[f64; 2]], first: &mut Option<[f64; 2]>) -> Option<Vec<Corner>> {
        let coordinates = &self.places.manifest.coordinates;
        let after = |at_m: [f64; 2], before: Option<[f64; 2]>| {
            let deg = coordinates.wgs84_from_working(at_m);
            let at_deg = match before {
                Some(before) => self.bounds.relative_after(deg, before),
                None => self.bounds.relative(deg),
            };
            Corner { at_m, at_deg, is_between: false }
        };
        let start = after(*ring.first()?, *first);
        first.get_or_insert(start.at_deg);
        let mut corners = vec![start];
        for &at_m in ring[1..].iter().chain(&ring[..1]) {
            let from = *corners.last()?;
            let to = after(at_m, Some(from.at_deg));
            let middle = |from: Corner, to: Corner| {
                let between = after(plane::middle(from.at_m, to.at_m), Some(from.at_deg));
                Some(Corner { is_between: true, ..between })
            };
            add_between([from, to], &middle, LINE_HALVINGS, &mut corners);
            corners.push(to);
        }
        let end = corners.pop()?;
        // Around a pole, a ring does not return to its first longitude.
        ((end.at_deg[0] - start.at_deg[0]).abs() < 1.0).then_some(corners)
    }

    /// Converts a ring from the lattice of degrees to working metres.
    fn ring(
        &self,
        segments: impl Iterator<Item = [LatticePoint; 2]>,
        limits: &LatticeBounds,
        known: &BTreeMap<LatticePoint, Option<[f64; 2]>>,
    ) -> Option<Vec<[f64; 2]>> {
        let sides = |point: LatticePoint| {
            let LatticeBounds { min, max } = limits;
            [point.u == min.u, point.u == max.u, point.v == min.v, point.v == max.v]
        };
        let corner = |point: LatticePoint| {
            let at_deg = [point.u, point.v].map(|steps| steps as f64 / STEPS);
            let at_m = known.get(&point).copied().flatten();
            let at_m = at_m.or_else(|| self.position_m(at_deg))?;
            Some(Corner { at_m, at_deg, is_between: false })
        };
        let middle = |from: Corner, to: Corner| {
            let at_deg = plane::middle(from.at_deg, to.at_deg);
            Some(Corner { at_m: self.position_m(at_deg)?, at_deg, is_between: true })
        };
        let mut corners = Vec::new();
        for [from, to] in segments {
            let is_on_side = sides(from).contains(&true);
            if known.get(&from) == Some(&None) && !is_on_side {
                continue;
            }
            let start = corner(from)?;
            corners.push(start);
            let is_along_side = sides(from).iter().zip(sides(to)).any(|(one, other)| *one && other);
            if is_along_side && !self.places.are_degrees() {
                add_between([start, corner(to)?], &middle, SIDE_HALVINGS, &mut corners);
            }
        }
        Some(corners.iter().map(|corner| corner.at_m).collect())
    }

    /// Returns the position of a point given in degrees from the middle of the bounds. Longitudes
    /// of a package may exceed 180.
    fn position_m(&self, [east, lat]: [f64; 2]) -> Option<[f64; 2]> {
        let manifest = self.places.manifest;
        let lon = self.bounds.middle()[0] + east;
        let data = manifest.whole_data_bounds();
        let places = [0.0, 360.0, -360.0, 720.0, -720.0]
            .map(|turn| manifest.coordinates.working_from_wgs84([lon + turn, lat]));
        let is_near = |position: &[f64; 2]| data.contains(*position);
        let mut found = places.into_iter().flatten();
        found.clone().find(is_near).or_else(|| found.next())
    }
}

/// Lines are bent if their middle is farther off than this, metres. In degrees, the limit is
/// [`STRAIGHT_DEG`].
const STRAIGHT_M: f64 = 0.01;
/// How often lines of a polygon are halved at most. A line of ten kilometres is then straight to a
/// millimetre, and the work is bounded.
const LINE_HALVINGS: u32 = 6;
/// The same limit for the sides of the rectangle, which are few and long.
const SIDE_HALVINGS: u32 = 12;

/// Adds as many corners between two as are needed for lines to be straight in both coordinate
/// systems.
fn add_between(
    [from, to]: [Corner; 2],
    middle: &dyn Fn(Corner, Corner) -> Option<Corner>,
    halvings: u32,
    corners: &mut Vec<Corner>,
) {
    let Some(between) = middle(from, to).filter(|_| halvings > 0) else { return };
    if distance(plane::middle(from.at_m, to.at_m), between.at_m) > STRAIGHT_M
        || distance(plane::middle(from.at_deg, to.at_deg), between.at_deg) > STRAIGHT_DEG
    {
        add_between([from, between], middle, halvings - 1, corners);
        corners.push(between);
        add_between([between, to], middle, halvings - 1, corners);
    }
}

fn lattice_point(deg: [f64; 2]) -> LatticePoint {
    nearest_point(deg.map(|degrees| degrees * STEPS))
}

fn lattice_limits([[west, east], [south, north]]: [[f64; 2]; 2]) -> LatticeBounds {
    // Clamp to values beyond all data; they stand for a missing side.
    let within = |degrees: f64| degrees.clamp(-2000.0, 2000.0);
    LatticeBounds {
        min: lattice_point([within(west), south]),
        max: lattice_point([within(east), north]),
    }
}
