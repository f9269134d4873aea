//! The outline of the elevation files, if they do not fill a rectangle.
//!
//! ```text
//!   ●──●──●┄┄●──●──●      ●  samples of three files of one grid
//!   │  │  │  │  │  │         ground lies in cells of which all four corners are samples,
//!   ●──●──●┄┄●──●──●      ┄  also between files that lie side by side
//!   ┊  ┊  ┊
//!   ●──●──●
//! ```

use std::cell::Cell;

use corniche_areas::{OutlineError, Polygon, intersection};
use corniche_dem::{Dem, Footprint, GridPlan};
use corniche_geom::{LatticeBounds, LatticePoint, Projection};
use corniche_gis::CrsError;

use crate::extent::AreaExtent;
use crate::extent::ExtentOutline;
use crate::extent::Imaging;

/// Returns the outline of all elevation files, clipped to the rectangle of the plan's nodes.
/// Returns `None` if the files fill this rectangle, or if they reach beyond the area that the
/// working CRS can show. Samples without a height count as data.
///
/// # Errors
/// See [`CrsError`].
pub fn data_outline(
    dem: &Dem,
    plan: &GridPlan,
    projection: &(dyn Projection + Sync),
) -> Result<Option<ExtentOutline>, CrsError> {
    let frame = &plan.frame;
    let imaging = Imaging { frame, seam: projection.seam() };
    let nodes = frame.lattice_bounds([plan.south_west, plan.north_east]);
    let mut outline = ExtentOutline::new();
    for footprint in dem.footprints(plan) {
        let Ok(cells) = cells(&footprint.rects) else { return Ok(None) };
        for polygon in cells {
            let rings = polygon.rings().map(|ring| image(&imaging, &footprint, ring.points()));
            let Some(rings) = rings.collect::<Result<Option<Vec<_>>, _>>()? else {
                return Ok(None);
            };
            outline.push(rings);
        }
    }
    let mut extent = AreaExtent::of_rectangle(imaging.on_map(nodes));
    let is_cut = extent.cut(&outline, AreaExtent::rounded_steps(frame)).unwrap_or(false);
    Ok(is_cut.then(|| extent.outline()))
}

fn image(
    imaging: &Imaging<'_>,
    footprint: &Footprint<'_>,
    ring: &[LatticePoint],
) -> Result<Option<Vec<LatticePoint>>, CrsError> {
    let corners: Vec<[f64; 2]> = ring.iter().map(|corner| corner.in_steps()).collect();
    let failed = Cell::new(None);
    let image = imaging.image(&corners, &|places| {
        footprint.to_working_m(places).map_err(|error| failed.set(Some(error))).ok()
    });
    failed.into_inner().map_or(Ok(image), Err)
}

/// The cells whose four corners are all samples of one of the rectangles, united; coordinates are
/// column and row.
fn cells(rects: &[[[i64; 2]; 2]]) -> Result<Vec<Polygon>, OutlineError> {
    let rectangle = |[min, max]: [[i64; 2]; 2]| {
        let [min, max] = [min, max].map(|[column, row]| LatticePoint::new(column, row));
        LatticeBounds { min, max }
    };
    if let [only] = rects {
        return Ok(Vec::from_iter(Polygon::rectangle(rectangle(*only))));
    }
    // Each sample is replaced by the cell south-east of it. After a shift by one cell along both
    // axes, what remains has all its corners.
    let squares: Vec<Polygon> = rects
        .iter()
        .filter_map(|&[min, max]| Polygon::rectangle(rectangle([min, max.map(|end| end + 1)])))
        .collect();
    let whole = squares.iter().flat_map(|square| square.outer().points()).copied();
    let Some(around) = LatticeBounds::around(&whole.collect::<Vec<_>>()) else {
        return Ok(Vec::new());
    };
    let mut left = Vec::from_iter(Polygon::rectangle(around));
    for moved in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let rings: Vec<Vec<LatticePoint>> = squares
            .iter()
            .map(|square| {
                let points = square.outer().points().iter();
                points.map(|at| LatticePoint::new(at.u - moved[0], at.v - moved[1])).collect()
            })
            .collect();
        left = intersection(&left, rings.iter().map(Vec::as_slice), 1)?;
    }
    Ok(left)
}

#[cfg(test)]
#[path = "data_outline_tests.rs"]
mod tests;
