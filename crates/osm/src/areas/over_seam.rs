//! Areas over ±180°, and over the seam of the package's map: outlines are joined there, and polygons cut.

use corniche_areas::{Polygon, Ring, split_polygon, unroll_rings};
use corniche_geom::{LatticePoint, OnSeamedMap as _, Seam};

use crate::{AreaLoss, outlines::records::degrees_of, read_request::Placing};

/// Steps of a degree on the lattice of outlines.
const STEPS: f64 = 1e7;

/// Moves the points of an outline, in 1e-7 degrees, onto a map whose seam it does not meet. An outline that does not go over ±180° stays; one
/// that goes around a pole meets every meridian, and stays, too.
pub(crate) fn join(ways: &mut [&mut Vec<LatticePoint>]) {
    let meets = |ways: &[&mut Vec<LatticePoint>], seam: Seam| {
        let image = |point: LatticePoint| point.with_x(seam.image(point.x()));
        let mut segments = ways.iter().flat_map(|way| way.array_windows());
        segments.any(|&[from, to]| seam.parts(&image(from), &image(to)))
    };
    let degrees = Seam::new(0.0, 360.0 * STEPS);
    if !meets(ways, degrees) {
        return;
    }
    // Middles of maps, the one that ends at Greenwich first.
    let maps = (0..360).map(|away| degrees.around(STEPS * f64::from(180 - away)));
    let Some(map) = maps.into_iter().find(|&map| !meets(ways, map)) else { return };
    for point in ways.iter_mut().flat_map(|way| way.iter_mut()) {
        *point = point.with_x(map.image(point.x()));
    }
}

/// A polygon in 1e-7 degrees on the package's lattice: the same polygon, or its parts where it lies over the seam of the map.
pub(crate) fn placed(polygon: &Polygon, placing: Placing<'_>) -> Result<Vec<Polygon>, AreaLoss> {
    let points = polygon.rings().flat_map(Ring::points);
    let positions_deg: Vec<[f64; 2]> = points.copied().map(degrees_of).collect();
    let placed: Option<Vec<LatticePoint>> = (placing.place)(&positions_deg).into_iter().collect();
    let mut points = placed.ok_or(AreaLoss::OutsideProjection)?.into_iter();
    // Rings are gone through in the same order.
    let whole = |points: &mut dyn Iterator<Item = LatticePoint>| {
        polygon.placed(|_| points.next()).ok_or(AreaLoss::OutsideProjection)
    };
    let Some(seam) = placing.seam else { return Ok(vec![whole(&mut points)?]) };
    let own = |ring: &Ring| points.by_ref().take(ring.points().len()).collect();
    let mut rings: Vec<Vec<LatticePoint>> = polygon.rings().map(own).collect();
    unroll_rings(&mut rings, seam);
    split_polygon(whole(&mut rings.into_iter().flatten())?, seam)
        .map_err(|_| AreaLoss::TooIntricate)
}
