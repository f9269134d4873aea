//! Areas across ±180° and across the seam of the package's map: outlines are joined there, and
//! polygons are cut.

use corniche_areas::{Polygon, Ring, split_polygon, unroll_rings};
use corniche_geom::{LatticePoint, OnSeamedMap as _, Seam};

use crate::{AreaLoss, outlines::records::degrees_of, read_request::LatticePlacement};

/// Lattice steps per degree of outlines.
const STEPS: f64 = 1e7;

/// Moves the points of an outline, in units of 1e-7 degrees, to a map whose seam it does not cross.
/// An outline that does not cross ±180° stays unchanged. So does an outline around a pole, because
/// it crosses every meridian.
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
    // The middles of the possible maps; the map that ends at Greenwich comes first.
    let maps = (0..360).map(|away| degrees.around(STEPS * f64::from(180 - away)));
    let Some(map) = maps.into_iter().find(|&map| !meets(ways, map)) else { return };
    for point in ways.iter_mut().flat_map(|way| way.iter_mut()) {
        *point = point.with_x(map.image(point.x()));
    }
}

/// Converts a polygon from units of 1e-7 degrees to the package's lattice. Returns the polygon, or
/// its parts if it crosses the seam of the map.
pub(crate) fn placed(
    polygon: &Polygon,
    placing: LatticePlacement<'_>,
) -> Result<Vec<Polygon>, AreaLoss> {
    let points = polygon.rings().flat_map(Ring::points);
    let positions_deg: Vec<[f64; 2]> = points.copied().map(degrees_of).collect();
    let placed: Option<Vec<LatticePoint>> = (placing.place)(&positions_deg).into_iter().collect();
    let mut points = placed.ok_or(AreaLoss::OutsideProjection)?.into_iter();
    // Rings are visited in the same order.
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
