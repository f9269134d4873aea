//! Where a DEM's files lie: their outlines, densely sampled.

use corniche_geom::Bounds;

use crate::DemError;
use crate::mosaic::{Mosaic, SampleRect};
use crate::operation::Operation;
use crate::source::Source;

/// Positions along each side of a file. Between two of them a side bends by 1/4096 of its whole sagitta.
const SIDE_POSITIONS: usize = 65;
/// Positions across the inside of a file, each way: a pole may lie there.
const INNER_POSITIONS: usize = 9;

/// Positions of samples on the rim and inside of a rectangle: the rim first, all the way around.
pub(crate) fn positions(mosaic: &Mosaic, rect: &SampleRect) -> Vec<[f64; 2]> {
    let [west, north] = rect.min.map(|index| index as f64);
    let [east, south] = rect.max.map(|index| (index - 1) as f64);
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
    samples.iter().map(|&sample| mosaic.crs_from_sample.crs_from_pixel(sample)).collect()
}

/// The rectangle around a file's samples in the CRS that `operation` leads to, the bend between rim positions
/// included; empty where the CRS does not reach.
pub(crate) fn bounds(
    mosaic: &Mosaic,
    rect: &SampleRect,
    operation: &Operation,
) -> Result<Bounds, DemError> {
    let mut points = positions(mosaic, rect);
    operation.apply(&mut points)?;
    let mut bounds = Bounds::EMPTY;
    let is_point = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
    for &point in points.iter().filter(|point| is_point(point)) {
        bounds.include(point);
    }
    // How far a middle one of three lies off the chord of its neighbours is 4 times the bend in between.
    let mut bend = 0.0_f64;
    for side in points[..4 * SIDE_POSITIONS].chunks_exact(SIDE_POSITIONS) {
        for [a, b, c] in side.windows(3).filter_map(|three| <[[f64; 2]; 3]>::try_from(three).ok()) {
            let off = (b[0] - f64::midpoint(a[0], c[0])).hypot(b[1] - f64::midpoint(a[1], c[1]));
            bend = if off.is_finite() { bend.max(off) } else { bend };
        }
    }
    if !bounds.is_empty() {
        bounds = Bounds {
            min_x: bounds.min_x - bend,
            min_y: bounds.min_y - bend,
            max_x: bounds.max_x + bend,
            max_y: bounds.max_y + bend,
        };
    }
    Ok(bounds)
}

/// All files' outlines in WGS84 and the rectangle around them. Longitudes are continuous: past the antimeridian
/// they go on beyond ±180. Refuses a file of which no position is on earth.
pub(crate) fn wgs84(
    sources: &[Source],
    mosaics: &[Mosaic],
    operations: &[Operation],
) -> Result<(Vec<[f64; 2]>, Bounds), DemError> {
    let mut all = Vec::new();
    let mut bounds = Bounds::EMPTY;
    let mut first_lon = None;
    for (mosaic, operation) in mosaics.iter().zip(operations) {
        for file in &mosaic.files {
            let mut points = positions(mosaic, &file.rect);
            operation.apply(&mut points)?;
            let mut previous = first_lon;
            for point in points.iter_mut().filter(|point| point[0].is_finite()) {
                if let Some(near) = previous {
                    let turns: f64 = (point[0] - near) / 360.0;
                    point[0] -= 360.0 * turns.round();
                }
                previous = Some(point[0]);
                first_lon = first_lon.or(previous);
                bounds.include(*point);
            }
            let known = all.len();
            all.extend(points.into_iter().filter(|point| point[0].is_finite()));
            if all.len() == known {
                let path = sources[file.index].path.clone();
                return Err(DemError::Nowhere { path, crs: mosaic.crs.label.clone() });
            }
        }
    }
    Ok((all, bounds))
}
