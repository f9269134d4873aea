//! The georeference of a file: its geotransform and its CRS.

use std::path::Path;

use corniche_geom::GeoTransform;
use gdal::Dataset;
use gdal::spatial_ref::SpatialRef;

use crate::RasterError;
use crate::crs::crs_text::{self, CrsParts};
use crate::crs::horizontal::Crs;
use crate::crs::vertical::VerticalCrs;

/// Tie points define a geotransform if it misses none of them by more than this many pixels.
const TIE_POINT_PX: f64 = 0.01;

/// The georeference of a raster.
#[derive(Debug, Clone)]
pub struct Georeference {
    /// The map from pixel corners, regardless of `PixelIsArea` or `PixelIsPoint`: GDAL converts
    /// both.
    pub crs_from_pixel: GeoTransform,
    /// Its CRS.
    pub crs: Crs,
    /// The vertical CRS of heights, if the file's CRS has one.
    pub vertical: Option<VerticalCrs>,
}

impl Georeference {
    /// Reads the file's geotransform, or derives one from its tie points; `crs_text` is the CRS of
    /// a file that names none.
    ///
    /// # Errors
    /// When the file lacks a georeference or CRS, or its coordinates are off the globe.
    pub fn from_dataset(
        path: &Path,
        dataset: &Dataset,
        crs_text: Option<&str>,
    ) -> Result<Self, RasterError> {
        let (crs_from_pixel, is_tied) = geo_transform(path, dataset)?;
        let reference =
            if is_tied { dataset.gcp_spatial_ref() } else { dataset.spatial_ref().ok() };
        let (crs, vertical) = crs_of(path, reference, crs_text)?;
        let coefficients = crs_from_pixel.coefficients;
        let is_usable = coefficients.iter().all(|value| value.is_finite())
            && crs_from_pixel.pixel_from_crs([0.0, 0.0]).is_some();
        if !is_usable {
            return Err(RasterError::GeoTransform { path: path.to_path_buf(), coefficients });
        }
        refuse_off_globe(path, &crs, &crs_from_pixel, dataset.raster_size())?;
        Ok(Self { crs_from_pixel, crs, vertical })
    }
}

/// The geotransform, or the one that tie points define; `true` for the latter. GDAL refers both to
/// pixel *corners*.
fn geo_transform(path: &Path, dataset: &Dataset) -> Result<(GeoTransform, bool), RasterError> {
    if let Ok(coefficients) = dataset.geo_transform() {
        return Ok((GeoTransform { coefficients }, false));
    }
    let ties: Vec<[f64; 4]> =
        dataset.gcps().iter().map(|tie| [tie.pixel(), tie.line(), tie.x(), tie.y()]).collect();
    match affine_through(&ties) {
        Some(transform) => Ok((transform, true)),
        None => Err(RasterError::NoGeoTransform { path: path.to_path_buf() }),
    }
}

/// The affine map that best fits `[column, row, x, y]` tuples; `None` unless it fits all of them.
fn affine_through(ties: &[[f64; 4]]) -> Option<GeoTransform> {
    if ties.len() < 3 {
        return None;
    }
    let mean = |axis: usize| ties.iter().map(|tie| tie[axis]).sum::<f64>() / ties.len() as f64;
    let center = [mean(0), mean(1), mean(2), mean(3)];
    // Normal equations of the two planes x(column, row), y(column, row) about the centre.
    let sum = |a: usize, b: usize| {
        ties.iter().map(|t| (t[a] - center[a]) * (t[b] - center[b])).sum::<f64>()
    };
    let (cc, cr, rr) = (sum(0, 0), sum(0, 1), sum(1, 1));
    let determinant = cc * rr - cr * cr;
    if determinant.abs() <= 1e-9 * cc * rr {
        return None;
    }
    let slopes = |axis: usize| {
        let (c, r) = (sum(0, axis), sum(1, axis));
        [(c * rr - r * cr) / determinant, (r * cc - c * cr) / determinant]
    };
    let (x, y) = (slopes(2), slopes(3));
    let coefficients = [
        center[2] - x[0] * center[0] - x[1] * center[1],
        x[0],
        x[1],
        center[3] - y[0] * center[0] - y[1] * center[1],
        y[0],
        y[1],
    ];
    let transform = GeoTransform { coefficients };
    let fits = ties.iter().all(|tie| {
        transform
            .pixel_from_crs([tie[2], tie[3]])
            .is_some_and(|at| (at[0] - tie[0]).hypot(at[1] - tie[1]) <= TIE_POINT_PX)
    });
    fits.then_some(transform)
}

/// Rejects coordinates that cannot be degrees: metres in a file with a geographic CRS, or swapped
/// axes.
fn refuse_off_globe(
    path: &Path,
    crs: &Crs,
    crs_from_pixel: &GeoTransform,
    (columns, rows): (usize, usize),
) -> Result<(), RasterError> {
    let Some(turn) = crs.turn_angle() else { return Ok(()) };
    let (right, bottom) = (columns as f64 - 0.5, rows as f64 - 0.5);
    let corners = [[0.5, 0.5], [right, 0.5], [0.5, bottom], [right, bottom]];
    let step = crs_from_pixel.coefficients;
    // Some real files have one sample beyond a pole.
    let most = [1.5 * turn, turn / 4.0 + step[4].hypot(step[5])];
    let is_off = |at: &[f64; 2]| (0..2).any(|axis| at[axis].abs() > most[axis] * (1.0 + 1e-9));
    match corners.map(|corner| crs_from_pixel.crs_from_pixel(corner)).into_iter().find(is_off) {
        Some([x, y]) => {
            let crs = crs.label.clone();
            Err(RasterError::OffGlobe { path: path.to_path_buf(), x, y, crs })
        }
        None => Ok(()),
    }
}

fn crs_of(
    path: &Path,
    reference: Option<SpatialRef>,
    crs_text: Option<&str>,
) -> Result<CrsParts, RasterError> {
    let own = || path.to_path_buf();
    let named = reference.filter(|reference| !reference.is_local());
    let horizontal = named.as_ref().map(crs_text::parts_of).transpose()?.flatten();
    match (horizontal, crs_text, named) {
        (Some(found), _, _) => Ok(found),
        (None, Some(text), _) => Ok(crs_text::crs_from_text("--dem-crs", text)?),
        (None, None, Some(unusable)) => {
            Err(RasterError::UnusableCrs { path: own(), name: unusable.name().unwrap_or_default() })
        }
        (None, None, None) => Err(RasterError::NoCrs { path: own() }),
    }
}

#[cfg(test)]
#[path = "georeference_tests.rs"]
mod tests;
