//! Lines of a file are placed on the lattice of a package.

use corniche_dem::RecordedCrs;
use corniche_geom::{LatticePoint, Projection as _, split_at_seam};
use corniche_tileset::Manifest;

use crate::{OverlayError, VectorLine};

/// A line on the lattice of a package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed {
    /// Which line of the file, from 0.
    pub line: usize,
    /// At least two points that follow each other.
    pub points: Vec<LatticePoint>,
}

/// Places lines on a package's lattice. A line in whose middle points have no place there, or that goes over the end of the map, comes in
/// several parts, and one without two neighbouring points that have a place is left out.
///
/// # Errors
/// When the package's coordinate system cannot be used.
pub fn place(lines: &[VectorLine], manifest: &Manifest) -> Result<Vec<Placed>, OverlayError> {
    let crs =
        RecordedCrs::new(&manifest.crs_wkt, manifest.metres_per_unit, manifest.whole_data_bounds());
    let failed = |source| OverlayError::PackageCrs(Box::new(source));
    let projection = crs.and_then(|crs| crs.projection(manifest.wgs84_bounds)).map_err(failed)?;
    let seam = projection.seam().map(|seam| seam.on_lattice(&manifest.frame));
    let mut placed = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let mut positions = line.positions_deg.clone();
        projection.working_from_wgs84(&mut positions)?;
        let points: Vec<Option<LatticePoint>> =
            positions.into_iter().map(|position_m| manifest.frame.snap(position_m)).collect();
        let runs = points
            .split(Option::is_none)
            .flat_map(|run| split_at_seam(run.iter().flatten().copied().collect(), seam))
            .filter(|points| points.len() >= 2);
        placed.extend(runs.map(|points| Placed { line: number, points }));
    }
    Ok(placed)
}
