//! The outline of the elevation files, where they fill no rectangle.
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
use crate::extent::Imaging;
use crate::extent::Outline;

/// The outline of all elevation files within the rectangle of nodes that a plan is of; `None` where they fill it, and where they reach beyond what the
/// working CRS can show. Samples without a height count, too.
///
/// # Errors
/// See [`CrsError`].
pub fn data_outline(
    dem: &Dem,
    plan: &GridPlan,
    projection: &(dyn Projection + Sync),
) -> Result<Option<Outline>, CrsError> {
    let frame = &plan.frame;
    let imaging = Imaging { frame, seam: projection.seam() };
    let nodes = frame.lattice_bounds([plan.south_west, plan.north_east]);
    let mut outline = Outline::new();
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

/// The cells between samples that have all of their corners in one of the rectangles, united: column and row as coordinates.
fn cells(rects: &[[[i64; 2]; 2]]) -> Result<Vec<Polygon>, OutlineError> {
    let rectangle = |[min, max]: [[i64; 2]; 2]| {
        let [min, max] = [min, max].map(|[column, row]| LatticePoint::new(column, row));
        LatticeBounds { min, max }
    };
    if let [only] = rects {
        return Ok(Vec::from_iter(Polygon::rectangle(rectangle(*only))));
    }
    // A sample as the cell south-east of it: what is left after moving all by a cell, along both axes, has its corners.
    let squares: Vec<Polygon> = rects
        .iter()
        .filter_map(|&[min, max]| Polygon::rectangle(rectangle([min, max.map(|end| end + 1)])))
        .collect();
    let whole = squares.iter().flat_map(|square| square.outer().points()).copied();
    let Some(around) = LatticeBounds::of(&whole.collect::<Vec<_>>()) else { return Ok(Vec::new()) };
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
