//! The bounding box in the header of an extract.

use std::path::PathBuf;

use corniche_geom::Seam;

/// The margin between an extract's box and the bounds, on each side and in degrees. Most extracts
/// contain ways that cross their box as a whole, and the ends of these ways need ground.
const MARGIN: f64 = 0.01;
const LEAST_MARGIN_DEG: f64 = 0.002;
/// The bounds are rounded to this many steps in a degree, some 10 m, so that they are readable.
const STEPS_PER_DEGREE: f64 = 1e4;

/// Why `--bounds osm` gives no bounds.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ExtractBoundsError {
    #[error(transparent)]
    Osm(#[from] corniche_osm::ReadOsmError),
    #[error(
        "--bounds osm: the header of {osm:?} has no bounding box; pass --bounds W,S,E,N (osmium fileinfo -e prints them)"
    )]
    NoBox { osm: PathBuf },
}

/// Returns the rectangle around the boxes in the headers of the extracts, with a margin: west,
/// south, east and north in WGS84 degrees. Across ±180° the west is larger than the east.
///
/// # Errors
/// When an extract cannot be read, or its header has no box.
pub fn extract_bounds(extracts: &[PathBuf]) -> Result<[f64; 4], ExtractBoundsError> {
    let mut boxes = Vec::new();
    for path in extracts {
        let found = corniche_osm::header_bounds_deg(path)?;
        boxes.push(found.ok_or_else(|| ExtractBoundsError::NoBox { osm: path.clone() })?);
    }
    Ok(with_margin(around(&boxes)))
}

/// The rectangle around all boxes; across ±180° the east is larger than 180.
pub(crate) fn around(boxes: &[[f64; 4]]) -> [f64; 4] {
    let mut all: Option<[f64; 4]> = None;
    for &[west, south, east, north] in boxes {
        let mut own = [west, south, if west > east { east + 360.0 } else { east }, north];
        if let Some([first_west, _, first_east, _]) = all {
            // The box is moved next to the others, on the shorter way around the earth.
            let seam = Seam::of_degrees().around(f64::midpoint(first_west, first_east));
            let away = seam.turn() * seam.turns(f64::midpoint(own[0], own[2]));
            (own[0], own[2]) = (own[0] - away, own[2] - away);
        }
        all = Some(all.map_or(own, |all| {
            [all[0].min(own[0]), all[1].min(own[1]), all[2].max(own[2]), all[3].max(own[3])]
        }));
    }
    all.unwrap_or_default()
}

fn with_margin([west, south, east, north]: [f64; 4]) -> [f64; 4] {
    let margin = |side_deg: f64| (side_deg * MARGIN).max(LEAST_MARGIN_DEG);
    let (aside, up) = (margin(east - west), margin(north - south));
    let low = |deg: f64| (deg * STEPS_PER_DEGREE).floor() / STEPS_PER_DEGREE;
    let high = |deg: f64| (deg * STEPS_PER_DEGREE).ceil() / STEPS_PER_DEGREE;
    let (south, north) = (low(south - up).max(-90.0), high(north + up).min(90.0));
    let (west, east) = (low(west - aside), high(east + aside));
    if east - west >= 360.0 {
        return [-180.0, south, 180.0, north];
    }
    let on_earth = |deg: f64| Seam::of_degrees().image_from_west(deg);
    let east = on_earth(east);
    // An eastern edge of 180° is the end of the earth, not its beginning.
    [on_earth(west), south, if east <= -180.0 { 180.0 } else { east }, north]
}

#[cfg(test)]
#[path = "extract_bounds_tests.rs"]
mod tests;
