//! True areas of polygons whose sides are straight in the working CRS.

use corniche_geom::{GridFrame, LatticePoint, Projection, ring_area_m2};

/// True area inside a ring on the lattice, square metres; negative for a clockwise one.
pub fn lattice_ring_m2(
    ring: &[LatticePoint],
    frame: &GridFrame,
    projection: &dyn Projection,
) -> f64 {
    let corners_m: Vec<[f64; 2]> = ring.iter().map(|&corner| frame.position_m(corner)).collect();
    let mut corners_deg = corners_m.clone();
    match projection.wgs84_from_working(&mut corners_deg) {
        Ok(()) => {
            let side = |side: [usize; 2]| side.map(|corner| corners_m[corner]);
            ring_area_m2(&corners_deg, &side, &|at| degrees(projection, at))
        }
        // Positions that were projected from degrees can be projected back.
        Err(_) => 0.0,
    }
}

/// True area inside a ring of longitudes and latitudes, square metres; negative for a clockwise
/// one.
pub fn degrees_ring_m2(ring_deg: &[[f64; 2]], projection: &dyn Projection) -> f64 {
    let side = |side: [usize; 2]| {
        let mut ends_m = side.map(|corner| ring_deg[corner]);
        if projection.working_from_wgs84(&mut ends_m).is_err() {
            return [[f64::NAN; 2]; 2];
        }
        if let Some(seam_m) = projection.seam() {
            seam_m.around(ends_m[0][0]).unroll(&mut ends_m);
        }
        ends_m
    };
    ring_area_m2(ring_deg, &side, &|at| degrees(projection, at))
}

/// Longitude and latitude of a position; NaN if it has none.
pub(crate) fn degrees(projection: &dyn Projection, at: [f64; 2]) -> [f64; 2] {
    let mut places = [at];
    match projection.wgs84_from_working(&mut places) {
        Ok(()) => places[0],
        Err(_) => [f64::NAN; 2],
    }
}
