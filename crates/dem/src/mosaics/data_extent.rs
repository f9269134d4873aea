//! The extent of a DEM's files, from positions along their sides and inside them.

use corniche_geom::{Bounds, Seam};
use corniche_gis::{CrsError, CrsOperation};

use crate::OpenDemError;
use crate::files::source::Source;
use crate::mosaics::mosaic::{Mosaic, SampleRect};

/// The number of positions along each side of a file. Between two of them a side bends by 1/4096 of
/// its whole sagitta.
const SIDE_POSITIONS: usize = 65;
/// The number of positions across the inside of a file, each way: a pole may be there.
const INNER_POSITIONS: usize = 9;

/// The positions of samples on the rim and inside of a rectangle: the rim first, all the way
/// around.
pub(crate) fn positions(mosaic: &Mosaic, rect: &SampleRect) -> Vec<[f64; 2]> {
    let north_west = rect.min.map(|index| index as f64);
    let south_east = rect.max.map(|index| (index - 1) as f64);
    let samples = rim_and_inside(north_west, south_east);
    samples.iter().map(|&sample| mosaic.crs_from_sample.crs_from_pixel(sample)).collect()
}

/// Points on the rim and inside of a rectangle between two corners: the rim first, all the way
/// around.
pub(crate) fn rim_and_inside([west, north]: [f64; 2], [east, south]: [f64; 2]) -> Vec<[f64; 2]> {
    let corners = [[west, north], [east, north], [east, south], [west, south]];
    let between = |from: f64, to: f64, t: f64| from + (to - from) * t;
    let mut samples = Vec::new();
    for side in 0..4 {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        for k in 0..SIDE_POSITIONS {
            let t = k as f64 / (SIDE_POSITIONS - 1) as f64;
            samples.push([between(from[0], to[0], t), between(from[1], to[1], t)]);
        }
    }
    for r in 1..=INNER_POSITIONS {
        for c in 1..=INNER_POSITIONS {
            let part = |k: usize| k as f64 / (INNER_POSITIONS + 1) as f64;
            samples.push([between(west, east, part(c)), between(north, south, part(r))]);
        }
    }
    samples
}

/// The rectangle around a file's samples in the target CRS of `operation`, including the bend
/// between rim positions; empty outside the CRS.
pub(crate) fn bounds(
    mosaic: &Mosaic,
    rect: &SampleRect,
    operation: &CrsOperation,
) -> Result<Bounds, CrsError> {
    let mut points = positions(mosaic, rect);
    operation.apply(&mut points)?;
    Ok(with_bend(&points))
}

/// The rectangle around images of [`rim_and_inside`], including the bend between rim positions;
/// empty without images.
pub(crate) fn with_bend(points: &[[f64; 2]]) -> Bounds {
    let mut bounds = Bounds::around(points);
    // The distance of a position from the straight line between its two neighbours is 4 times the
    // bend between two positions.
    let mut bend = 0.0_f64;
    for side in points[..4 * SIDE_POSITIONS].chunks_exact(SIDE_POSITIONS) {
        for [a, b, c] in side.windows(3).filter_map(|three| <[[f64; 2]; 3]>::try_from(three).ok()) {
            let off = (b[0] - f64::midpoint(a[0], c[0])).hypot(b[1] - f64::midpoint(a[1], c[1]));
            bend = if off.is_finite() { bend.max(off) } else { bend };
        }
    }
    if !bounds.is_empty() {
        bounds = bounds.expanded([bend; 2]);
    }
    bounds
}

/// The positions on the rim and inside of all files in WGS84, and the rectangle around them.
/// Longitudes are continuous: across the antimeridian they continue beyond ±180. Rejects a file
/// without any position on earth.
/// position is on earth.
pub(crate) fn wgs84(
    sources: &[Source],
    mosaics: &[Mosaic],
    operations: &[CrsOperation],
) -> Result<(Vec<[f64; 2]>, Bounds), OpenDemError> {
    let mut all = Vec::new();
    let mut bounds = Bounds::EMPTY;
    for (mosaic, operation) in mosaics.iter().zip(operations) {
        // Degrees of one grid are continuous already: they are moved by the same turns.
        let degrees =
            mosaic.crs.turn_angle().map(|turn| (360.0 / turn, mosaic.middle()[0] * 360.0 / turn));
        let of_mosaic = degrees.map(|(_, middle_deg)| turns_beside(middle_deg, bounds));
        for file in &mosaic.files {
            let own = positions(mosaic, &file.rect);
            let mut points = own.clone();
            operation.apply(&mut points)?;
            if let Some((to_degrees, _)) = degrees {
                for (point, own) in points.iter_mut().zip(&own) {
                    point[0] = Seam::of_degrees().around(own[0] * to_degrees).image(point[0]);
                }
            } else {
                unwrap(&mut points, Seam::of_degrees());
            }
            points.retain(|point| point[0].is_finite() && point[1].is_finite());
            if points.is_empty() {
                let path = sources[file.index].path.clone();
                return Err(OpenDemError::Nowhere { path, crs: mosaic.crs.label.clone() });
            }
            let turns = of_mosaic
                .unwrap_or_else(|| turns_beside(Bounds::around(&points).center()[0], bounds));
            for point in &mut points {
                point[0] -= 360.0 * turns;
                bounds.include(*point);
            }
            all.extend(points);
        }
    }
    if mosaics.iter().any(Mosaic::is_ring) {
        bounds.max_x = bounds.max_x.max(bounds.min_x + 360.0);
    }
    let away = turns_beyond(bounds);
    for point in &mut all {
        point[0] -= 360.0 * away;
    }
    Ok((all, moved_back(bounds, away)))
}

/// The number of full turns by which a rectangle in degrees lies beyond ±180; none if a part of it
/// lies within.
pub(crate) fn turns_beyond(bounds: Bounds) -> f64 {
    let is_beyond = bounds.min_x >= 180.0 || bounds.max_x <= -180.0;
    if is_beyond { Seam::of_degrees().turns(bounds.center()[0]) } else { 0.0 }
}

/// A rectangle in degrees, moved by full turns to the west.
pub(crate) fn moved_back(bounds: Bounds, turns: f64) -> Bounds {
    let away = 360.0 * turns;
    Bounds { min_x: bounds.min_x - away, max_x: bounds.max_x - away, ..bounds }
}

/// Makes the longitudes of images of [`rim_and_inside`] continuous. Along the rim each longitude is
/// moved next to the previous one, which is near. Inside, each is moved next to the middle of the
/// rim: neighbours in the list can be as far apart as the rectangle is wide.
pub(crate) fn unwrap(points: &mut [[f64; 2]], seam: Seam) {
    let (rim, inside) = points.split_at_mut(4 * SIDE_POSITIONS);
    let is_somewhere = |point: &&mut [f64; 2]| point[0].is_finite();
    let first = rim.iter().find(|point| point[0].is_finite()).map(|point| point[0]);
    if let Some(first) = first {
        seam.around(first).unroll(rim);
    }
    // If no position of the rim is on earth, the first inner position is used.
    let mut near = first.map(|_| Bounds::around(&*rim).center()[0]);
    for point in inside.iter_mut().filter(is_somewhere) {
        point[0] = seam.around(*near.get_or_insert(point[0])).image(point[0]);
    }
}

/// The number of full turns between a longitude and the middle of a rectangle; none from half a
/// turn, and none from an empty rectangle.
fn turns_beside(lon_deg: f64, bounds: Bounds) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    Seam::of_degrees().around(bounds.center()[0]).turns(lon_deg)
}
