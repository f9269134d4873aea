//! Cuts lines at the bounds and at the antimeridian, and polygons at the antimeridian.

use corniche_areas::{OutlineWay, Polygon, Ring, assemble, split_polygon, unroll_rings};
use corniche_geom::{LatticePoint, Seam};

use crate::{
    bounds::DegreeBounds,
    piece::{Vertex, WayPiece},
    plane,
};

/// Clips a piece to the bounds, if there are any; see [`cut_line_at_bounds`].
pub(crate) fn cut_at_bounds(
    piece: WayPiece,
    bounds: Option<&DegreeBounds>,
    wgs84: &dyn Fn([f64; 2]) -> [f64; 2],
) -> Vec<WayPiece> {
    let Some(bounds) = bounds else { return vec![piece] };
    let cut = (0..).zip(cut_line_at_bounds(&piece.vertices, bounds, wgs84));
    cut.map(|(cut, CutLine { vertices, has_end })| piece.part(cut, vertices, has_end)).collect()
}

/// A part of a line inside the bounds.
pub(crate) struct CutLine {
    /// At least two vertices.
    pub(crate) vertices: Vec<Vertex>,
    /// Whether the first vertex is the line's own first one, and whether the last is its last.
    has_end: [bool; 2],
}

/// Clips a line to the bounds. `wgs84` gives the longitude and latitude of a point of the lattice.
///
/// A new end is on the line, where it crosses a side of the rectangle; it is not a source point.
pub(crate) fn cut_line_at_bounds(
    vertices: &[Vertex],
    bounds: &DegreeBounds,
    wgs84: &dyn Fn([f64; 2]) -> [f64; 2],
) -> Vec<CutLine> {
    let mut cuts: Vec<CutLine> = Vec::new();
    // Whether the previous segment ended inside.
    let mut goes_on = false;
    let mut before: Option<[f64; 2]> = None;
    for (at, pair) in vertices.array_windows::<2>().enumerate() {
        let from = before.unwrap_or_else(|| wgs84(pair[0].at));
        let to = wgs84(pair[1].at);
        before = Some(to);
        let mut parts = Vec::new();
        let ends = [(pair[0].at, from), (pair[1].at, to)];
        shares_inside(bounds, wgs84, ends, [0.0, 1.0], &mut parts);
        for &[first, last] in &parts {
            let [start, end] = [first, last].map(|share| between(pair[0], pair[1], share));
            match cuts.last_mut().filter(|_| goes_on && first <= 0.0) {
                Some(cut) => cut.vertices.push(end),
                None => cuts.push(CutLine {
                    vertices: vec![start, end],
                    has_end: [at == 0 && first <= 0.0, false],
                }),
            }
            goes_on = last >= 1.0;
            if let Some(cut) = cuts.last_mut() {
                cut.has_end[1] = at + 2 == vertices.len() && goes_on;
            }
        }
        goes_on &= !parts.is_empty();
    }
    cuts
}

/// A line counts as straight in degrees if its middle is at most this far off, degrees: a
/// centimetre.
pub(crate) const STRAIGHT_DEG: f64 = 1e-7;

/// The shortest share to which bent segments are halved. A segment of ten kilometres is then
/// straight to a millimetre, and the work is bounded.
const LEAST_SHARE: f64 = 1.0 / 64.0;

/// Returns the shares of a segment that are inside. The ends are points of the lattice with their
/// degrees; `of` is the part of the segment between them. If the projection bends that part in
/// degrees, its halves are checked separately.
fn shares_inside(
    bounds: &DegreeBounds,
    wgs84: &dyn Fn([f64; 2]) -> [f64; 2],
    [(from, from_deg), (to, to_deg)]: [([f64; 2], [f64; 2]); 2],
    of: [f64; 2],
    parts: &mut Vec<[f64; 2]>,
) {
    let middle = plane::middle(from, to);
    let middle_deg = wgs84(middle);
    let [start, length] = [of[0], of[1] - of[0]];
    let first = bounds.relative(from_deg);
    let [east, north] = plane::middle(first, bounds.relative_after(to_deg, first));
    let [is_east, is_north] = bounds.relative_after(middle_deg, first);
    let is_bent = (is_east - east).hypot(is_north - north) > STRAIGHT_DEG;
    if is_bent && length > LEAST_SHARE {
        let half = start + length / 2.0;
        for (ends, of) in [
            ([(from, from_deg), (middle, middle_deg)], [start, half]),
            ([(middle, middle_deg), (to, to_deg)], [half, of[1]]),
        ] {
            shares_inside(bounds, wgs84, ends, of, parts);
        }
        return;
    }
    for [first, last] in bounds.inside(from_deg, to_deg) {
        let [first, last] = [first, last].map(|share| start + length * share);
        match parts.last_mut().filter(|part| part[1] >= first) {
            Some(part) => part[1] = last,
            None => parts.push([first, last]),
        }
    }
}

/// Returns the vertex at a share of the way between two; at shares 0 and 1, exactly these vertices.
fn between(from: Vertex, to: Vertex, share: f64) -> Vertex {
    match share {
        ..=0.0 => from,
        1.0.. => to,
        _ => from.towards(to, share),
    }
}

/// Points this near to 180° count as being on it, degrees: the lattice has steps of up to a
/// millimetre.
const ON_ANTIMERIDIAN_DEG: f64 = 2e-8;

/// Splits a line of longitudes, latitudes and heights into lines that do not cross the antimeridian
/// (RFC 7946, 3.1.9), with longitudes within ±180. Neighbours are less than half the globe apart;
/// input longitudes may exceed 180. No part beyond the antimeridian is as short as a step of the
/// lattice.
pub(crate) fn cut_at_antimeridian(mut line: Vec<[f64; 3]>) -> Vec<Vec<[f64; 3]>> {
    let seam = Seam::of_degrees();
    for place in &mut line {
        place[0] = seam.image(place[0]);
    }
    if !line.array_windows().any(|[from, to]| seam.parts(from, to)) {
        return vec![line];
    }
    let first = line[0][0];
    for [lon, lat, _] in &mut line {
        if (180.0 - lon.abs()) * lat.to_radians().cos() <= ON_ANTIMERIDIAN_DEG {
            *lon = 180.0_f64.copysign(*lon);
        }
    }
    let mut lines = seam.split(line.clone());
    lines.retain(|line| is_long(line));
    if lines.is_empty() {
        // No longer than a step of the lattice: move it onto the antimeridian as a whole.
        for place in &mut line {
            place[0] = 180.0_f64.copysign(first);
        }
        lines.push(line);
    }
    lines
}

/// Whether a line is longer than one step of the lattice.
fn is_long(line: &[[f64; 3]]) -> bool {
    line.iter().any(|[lon, lat, _]| {
        let [first_lon, first_lat, _] = line[0];
        let east = (lon - first_lon) * lat.to_radians().cos();
        east.hypot(lat - first_lat) > ON_ANTIMERIDIAN_DEG
    })
}

/// Steps to a degree of the grid in which polygons are cut: a tenth of a millimetre each.
pub(crate) const STEPS: f64 = 1e9;

/// Splits a polygon (rings in degrees, the outer one first) into polygons that do not cross the
/// antimeridian, with longitudes within ±180. Corners within `rounding_deg` of the antimeridian are
/// moved onto it, and parts no wider than that are dropped. Returns `None` if the rings do not form
/// a polygon.
pub(crate) fn cut_polygon_at_antimeridian(
    rings: Vec<Vec<[f64; 2]>>,
    rounding_deg: f64,
) -> Option<Vec<Vec<Vec<[f64; 2]>>>> {
    let degrees = Seam::of_degrees();
    let is_beyond = |ring: &Vec<[f64; 2]>| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).any(|(at, next)| at[0].abs() > 180.0 || degrees.parts(at, next))
    };
    if !rings.iter().any(is_beyond) {
        return Some(vec![rings]);
    }
    let on_lattice = |&[lon, lat]: &[f64; 2]| {
        let is_near = |end: f64| (lon - end).abs() * lat.to_radians().cos() <= rounding_deg;
        let lon = [-180.0, 180.0].into_iter().find(|&end| is_near(end)).unwrap_or(lon);
        plane::nearest_point([lon * STEPS, lat * STEPS])
    };
    let mut rings: Vec<Vec<LatticePoint>> =
        rings.iter().map(|ring| ring.iter().map(on_lattice).collect()).collect();
    let seam = Seam::new(0.0, 360.0 * STEPS);
    unroll_rings(&mut rings, seam);
    if rings[0].iter().all(|point| point.u == rings[0][0].u) {
        return Some(Vec::new());
    }
    let mut polygons = Vec::new();
    for polygon in polygons_of(&rings)? {
        polygons.extend(split_polygon(polygon, seam).ok()?);
    }
    let place = |point: &LatticePoint| [point.u, point.v].map(|steps| steps as f64 / STEPS);
    let ring = |ring: &Ring| ring.points().iter().map(place).collect();
    Some(polygons.iter().map(|polygon| polygon.rings().map(ring).collect()).collect())
}

/// Returns the polygons that closed lines bound; `None` if the lines are not valid outlines.
pub(crate) fn polygons_of<R: AsRef<[LatticePoint]>>(rings: &[R]) -> Option<Vec<Polygon>> {
    let close = |ring: &R| ring.as_ref().iter().chain(ring.as_ref().first()).copied().collect();
    let closed: Vec<Vec<LatticePoint>> = rings.iter().map(close).collect();
    let ways: Vec<OutlineWay<'_>> = closed.iter().map(|points| OutlineWay { points }).collect();
    assemble(&ways).ok().map(|assembled| assembled.polygons)
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
