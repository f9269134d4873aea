//! Places the lines of a file on the lattice of a package, and transforms a package's heights to
//! the ellipsoid of WGS84.

use corniche_geom::{LatticePoint, Projection as _, split_at_seam};
use corniche_gis::{RecordedCrs, RecordedHeights};
use corniche_tileset::Manifest;

use crate::{OverlayError, VectorLine};

/// A line on the lattice of a package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LatticeLine {
    /// The number of the line in the file, from 0.
    pub line: usize,
    /// At least two consecutive points.
    pub points: Vec<LatticePoint>,
}

/// Places lines on a package's lattice. A line is split into several parts if points in its middle
/// cannot be placed there, or if it crosses the end of the map. A line without two consecutive
/// points that can be placed is skipped.
///
/// # Errors
/// When the package's coordinate system cannot be used.
pub fn place(lines: &[VectorLine], manifest: &Manifest) -> Result<Vec<LatticeLine>, OverlayError> {
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
        placed.extend(runs.map(|points| LatticeLine { line: number, points }));
    }
    Ok(placed)
}

/// Transforms heights of a package to the ellipsoid of WGS84, which GeoJSON requires (RFC 7946,
/// section 4).
pub struct EllipsoidHeights(RecordedHeights);

impl EllipsoidHeights {
    /// Returns the transformation of a package's heights; `None` if its vertical datum is unknown,
    /// or PROJ has no transformation to the ellipsoid here, for example because a grid is missing.
    ///
    /// # Errors
    /// When the package's coordinate system cannot be used.
    pub fn from_manifest(manifest: &Manifest) -> Result<Option<Self>, OverlayError> {
        let failed = |source| OverlayError::PackageCrs(Box::new(source));
        let Manifest { crs_wkt, metres_per_unit, data_bounds, vertical, settings, .. } = manifest;
        let crs = RecordedCrs::new(crs_wkt, *metres_per_unit, *data_bounds).map_err(failed)?;
        let given = [&settings.vertical_crs, &settings.dem_vertical_crs];
        let given: Vec<&str> = given.into_iter().flatten().map(String::as_str).collect();
        let found = RecordedHeights::find(&crs, &vertical.datum, &given, manifest.wgs84_bounds);
        let heights = found.map_err(failed)?.map(Self);
        let middle = [data_bounds.center()];
        Ok(heights.filter(|heights| heights.carry(&middle, &mut [vertical.range_m[0]])))
    }

    /// Replaces heights of the package at positions in its working CRS. Returns whether this is
    /// possible.
    #[must_use]
    pub fn carry(&self, positions_m: &[[f64; 2]], heights_m: &mut [f64]) -> bool {
        self.0.to_wgs84_m(positions_m, heights_m).is_ok()
            && heights_m.iter().all(|height_m| height_m.is_finite())
    }
}
