//! Lines cut: at the bounds, and at the antimeridian; polygons at the antimeridian.

use corniche_areas::{OutlineWay, Polygon, Ring, assemble, split_polygon, unroll_rings};
use corniche_geom::{LatticePoint, Seam};

use crate::{
    bounds::DegreeBounds,
    piece::{Piece, PieceKey, Vertex},
};

/// What the bounds leave of a piece. `wgs84` gives the longitude and latitude of a place on the lattice.
///
/// A new end lies on the line, where it crosses a side of the rectangle; it is no source point and nothing goes on from it.
pub(crate) fn cut_at_bounds(
    piece: &Piece,
    bounds: &DegreeBounds,
    wgs84: &dyn Fn([f64; 2]) -> [f64; 2],
) -> Vec<Piece> {
    let [first_end, last_end] = piece.goes_on;
    let last_vertex = piece.vertices.len() - 1;
    let mut cuts: Vec<Piece> = Vec::new();
    // Whether the segment before ended inside.
    let mut goes_on = false;
    let mut before: Option<[f64; 2]> = None;
    for (at, pair) in piece.vertices.windows(2).enumerate() {
        let from = before.unwrap_or_else(|| wgs84(pair[0].at));
        let to = wgs84(pair[1].at);
        before = Some(to);
        let parts = bounds.inside(from, to);
        for &[first, last] in &parts {
            let [start, end] = [first, last].map(|share| between(pair[0], pair[1], share));
            match cuts.last_mut().filter(|_| goes_on && first <= 0.0) {
                Some(cut) => cut.vertices.push(end),
                None => cuts.push(Piece {
                    key: PieceKey { cut: cuts.len() as u32, ..piece.key },
                    vertices: vec![start, end],
                    goes_on: [at == 0 && first <= 0.0 && first_end, false],
                    ..piece.clone()
                }),
            }
            goes_on = last >= 1.0;
            if let Some(cut) = cuts.last_mut() {
                cut.goes_on[1] = at + 1 == last_vertex && goes_on && last_end;
            }
        }
        goes_on &= !parts.is_empty();
    }
    cuts
}

/// The vertex at a share of the way from one to the next; at its ends these themselves.
fn between(from: Vertex, to: Vertex, share: f64) -> Vertex {
    if share <= 0.0 {
        return from;
    }
    if share >= 1.0 {
        return to;
    }
    let mix = |a: f64, b: f64| a + share * (b - a);
    Vertex {
        at: [mix(from.at[0], to.at[0]), mix(from.at[1], to.at[1])],
        z_m: mix(from.z_m, to.z_m),
        is_source: false,
    }
}

/// Places this near to 180° lie on it, degrees: the lattice has steps of up to a millimetre.
const ON_ANTIMERIDIAN_DEG: f64 = 2e-8;

/// Positions of longitude, latitude and height, as lines that do not cross the antimeridian (RFC 7946, 3.1.9), with longitudes
/// within ±180. Neighbours are less than half the earth apart; longitudes may have run on past 180. Nothing as short as a step of the lattice
/// is left beyond it.
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
        // No longer than a step of the lattice: it lies on the antimeridian as a whole.
        for place in &mut line {
            place[0] = 180.0_f64.copysign(first);
        }
        lines.push(line);
    }
    lines
}

/// Whether a line reaches farther than from one place of the lattice to the next.
fn is_long(line: &[[f64; 3]]) -> bool {
    line.iter().any(|[lon, lat, _]| {
        let [first_lon, first_lat, _] = line[0];
        let east = (lon - first_lon) * lat.to_radians().cos();
        east.hypot(lat - first_lat) > ON_ANTIMERIDIAN_DEG
    })
}

/// Steps of a degree in which polygons are cut: a tenth of a millimetre.
const STEPS: f64 = 1e9;

/// Rings of a polygon in degrees, the outer one first, as polygons that do not cross the antimeridian, with longitudes within ±180. Corners
/// that lie as near to it as `rounding_deg` lie on it, and what is no wider is left out. `None` where that is no polygon.
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
        LatticePoint::new((lon * STEPS).round() as i64, (lat * STEPS).round() as i64)
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

/// The polygons between closed lines; `None` where these are no outline.
pub(crate) fn polygons_of<R: AsRef<[LatticePoint]>>(rings: &[R]) -> Option<Vec<Polygon>> {
    let close = |ring: &R| ring.as_ref().iter().chain(ring.as_ref().first()).copied().collect();
    let closed: Vec<Vec<LatticePoint>> = rings.iter().map(close).collect();
    let ways: Vec<OutlineWay<'_>> = closed.iter().map(|points| OutlineWay { points }).collect();
    assemble(&ways).ok().map(|assembled| assembled.polygons)
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
