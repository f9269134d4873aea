//! One elevation file: what it says about itself, and its samples as metres.

use std::path::{Path, PathBuf};

use corniche_geom::GeoTransform;
use gdal::errors::GdalError;
use gdal::raster::{ColorInterpretation, RasterBand};
use gdal::{Dataset, Metadata};

use crate::crs::Crs;
use crate::heights::HeightOperation;
use crate::values::Values;
use crate::vertical::VerticalCrs;
use crate::{DemError, library};

/// Tie points make a geotransform when it misses none of them by more than this many pixels.
const TIE_POINT_PX: f64 = 0.01;

/// How an elevation file is to be understood where it does not say so itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenOptions {
    /// CRS, "EPSG:n" or WKT, of the files that name none. A file that names one keeps it.
    pub dem_crs: Option<String>,
    /// Stored values that mean "no height", besides the one that the file declares.
    pub nodata: Vec<f64>,
    /// Vertical CRS, "EPSG:n" or WKT, of the files that name none; with its unit and direction. A file that names
    /// one keeps it.
    pub dem_vertical_crs: Option<String>,
    /// The vertical CRS that heights are wanted in, "EPSG:n" or WKT; `None` leaves them as they are.
    ///
    /// PROJ takes the best operation for which it has the grids; approximations without any are not allowed. Where
    /// the grid of the best is not installed but that of a lesser one is, an older model of the geoid say, PROJ takes
    /// the lesser one and does not tell. It is not asked for the best alone, which GDAL can do since 3.8 only (PROJ
    /// since 9.2 has an environment variable for it, `PROJ_ONLY_BEST_DEFAULT`). Instead [`crate::GridPlan::vertical`]
    /// records the offset found at the centre, to the millimetre: runs with grids that differ there read differently.
    pub vertical_crs: Option<String>,
    /// Added to every height, after all else, metres.
    pub vertical_shift_m: f64,
}

/// An elevation file, described but not held open.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) columns: i64,
    pub(crate) rows: i64,
    /// Pixel to CRS.
    pub(crate) crs_from_pixel: GeoTransform,
    pub(crate) crs: Crs,
    /// What its heights are measured from, as the file or `--dem-vertical-crs` says.
    pub(crate) vertical: Option<VerticalCrs>,
    values: Values,
    /// Stored in whole rows rather than in tiles.
    pub(crate) is_striped: bool,
    /// Number of the band in which 0 means that there is no sample.
    alpha_band: Option<usize>,
    /// To the vertical CRS asked for, where that is another one.
    pub(crate) to_target: Option<HeightOperation>,
    pub(crate) shift_m: f64,
}

impl Source {
    pub(crate) fn open(path: &Path, options: &OpenOptions) -> Result<Self, DemError> {
        let dataset = open_dataset(path)?;
        let own = || path.to_path_buf();
        let broken = |source: GdalError| DemError::Open { path: own(), source: source.into() };
        if dataset.raster_count() == 0 {
            return Err(no_band(path, &dataset));
        }
        let band = dataset.rasterband(1).map_err(broken)?;
        refuse_imagery(path, &dataset, &band)?;
        let (columns, rows) = dataset.raster_size();
        let (crs_from_pixel, is_tied) = geo_transform(path, &dataset)?;
        let reference =
            if is_tied { dataset.gcp_spatial_ref() } else { dataset.spatial_ref().ok() };
        let (crs, vertical) = crs_of(path, reference, options)?;
        if crs_from_pixel.pixel_from_crs([0.0, 0.0]).is_none()
            || !crs_from_pixel.coefficients.iter().all(|value| value.is_finite())
        {
            return Err(DemError::GeoTransform {
                path: own(),
                coefficients: crs_from_pixel.coefficients,
            });
        }
        refuse_off_globe(path, &crs, &crs_from_pixel, dataset.raster_size())?;
        let given = || {
            let text = options.dem_vertical_crs.as_deref();
            text.map(|text| VerticalCrs::from_text("--dem-vertical-crs", text)).transpose()
        };
        let vertical = if vertical.is_some() { vertical } else { given()? };
        Ok(Self {
            path: own(),
            columns: columns as i64,
            rows: rows as i64,
            crs_from_pixel,
            crs,
            values: Values::of(path, &band, vertical.as_ref(), options)?,
            vertical,
            is_striped: band.block_size().0 == columns,
            alpha_band: alpha_band(&dataset),
            to_target: None,
            shift_m: 0.0,
        })
    }

    /// The samples of a rectangle of pixels as metres, row by row, NaN where there is none.
    pub(crate) fn read(
        &self,
        dataset: &Dataset,
        [column, row]: [usize; 2],
        [columns, rows]: [usize; 2],
        heights_m: &mut Vec<f64>,
    ) -> Result<(), DemError> {
        self.read_stored(dataset, [column, row], [columns, rows], heights_m)?;
        self.values.convert(heights_m);
        if let Some(operation) = &self.to_target {
            operation.apply(&self.path, &self.crs_from_pixel, [column, row], columns, heights_m)?;
        }
        if self.shift_m != 0.0 {
            for height_m in heights_m.iter_mut() {
                *height_m += self.shift_m;
            }
        }
        Ok(())
    }

    /// Stored values to metres, in place; NaN where there is no height. Without the vertical CRS and the shift asked for.
    pub(crate) fn convert(&self, values: &mut [f64]) {
        self.values.convert(values);
    }

    /// A stored value as `--nodata` takes it.
    pub(crate) fn stored_text(&self, value: f64) -> String {
        self.values.stored_text(value)
    }

    /// The values of a rectangle of pixels as they are stored, row by row, NaN where a mask says that there is none.
    pub(crate) fn read_stored(
        &self,
        dataset: &Dataset,
        [column, row]: [usize; 2],
        [columns, rows]: [usize; 2],
        values: &mut Vec<f64>,
    ) -> Result<(), DemError> {
        let (start, size) = ((column as isize, row as isize), (columns, rows));
        let mut read = || -> Result<(), GdalError> {
            values.resize(columns * rows, 0.0);
            let band = dataset.rasterband(1)?;
            band.read_into_slice(start, size, size, values, None)?;
            if self.values.has_mask {
                let mask = band.open_mask_band()?.read_as::<u8>(start, size, size, None)?;
                masked(values, mask.data().iter().map(|&valid| valid == 0));
            }
            if let Some(alpha) = self.alpha_band {
                let alpha = dataset.rasterband(alpha)?.read_as::<f64>(start, size, size, None)?;
                masked(values, alpha.data().iter().map(|&opacity| opacity == 0.0));
            }
            Ok(())
        };
        let path = || self.path.clone();
        read().map_err(|source| DemError::Read {
            path: path(),
            column,
            row,
            columns,
            rows,
            source: source.into(),
        })
    }
}

/// Takes away values.
fn masked(values: &mut [f64], is_void: impl Iterator<Item = bool>) {
    for (value, _) in values.iter_mut().zip(is_void).filter(|(_, is_void)| *is_void) {
        *value = f64::NAN;
    }
}

fn alpha_band(dataset: &Dataset) -> Option<usize> {
    (2..=dataset.raster_count()).find(|&index| {
        dataset
            .rasterband(index)
            .is_ok_and(|band| band.color_interpretation() == ColorInterpretation::AlphaBand)
    })
}

/// Opens a file, with an error that says which of the usual things went wrong.
pub(crate) fn open_dataset(path: &Path) -> Result<Dataset, DemError> {
    let own = || path.to_path_buf();
    if path.to_str().is_none() {
        return Err(DemError::NotUtf8 { path: own() });
    }
    if path.starts_with("/vsistdin") {
        return Err(DemError::Stream { path: own(), found: "standard input" });
    }
    // GDAL's virtual files and subdatasets ("/vsizip/…", "NETCDF:…") are no names of files.
    let is_virtual =
        path.to_str().is_some_and(|text| text.starts_with("/vsi") || text.contains(':'));
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() && found.len() == 0 => {
            return Err(DemError::Empty { path: own() });
        }
        Ok(found) if !found.is_file() && !found.is_dir() => {
            return Err(DemError::Stream { path: own(), found: "a pipe or a device" });
        }
        Err(source) if !is_virtual => return Err(DemError::Missing { path: own(), source }),
        // Some formats are folders; GDAL says below whether this is one of them.
        Ok(_) | Err(_) => {}
    }
    library::forget();
    Dataset::open(path).map_err(|source| {
        if path.is_dir() {
            DemError::NotAFile { path: own() }
        } else {
            DemError::Open { path: own(), source: source.into() }
        }
    })
}

/// Degrees that are none: metres under a geographic CRS, or axes changed round.
fn refuse_off_globe(
    path: &Path,
    crs: &Crs,
    crs_from_pixel: &GeoTransform,
    (columns, rows): (usize, usize),
) -> Result<(), DemError> {
    let Some(turn) = crs.turn else { return Ok(()) };
    let (right, bottom) = (columns as f64 - 0.5, rows as f64 - 0.5);
    let corners = [[0.5, 0.5], [right, 0.5], [0.5, bottom], [right, bottom]];
    let step = crs_from_pixel.coefficients;
    // A sample too many beyond a pole is found in real files.
    let most = [1.5 * turn, turn / 4.0 + step[4].hypot(step[5])];
    let is_off = |at: &[f64; 2]| (0..2).any(|axis| at[axis].abs() > most[axis] * (1.0 + 1e-9));
    match corners.map(|corner| crs_from_pixel.crs_from_pixel(corner)).into_iter().find(is_off) {
        Some([x, y]) => {
            let crs = crs.label.clone();
            Err(DemError::OffGlobe { path: path.to_path_buf(), x, y, crs })
        }
        None => Ok(()),
    }
}

/// Why a container without a band of its own is no DEM: it may hold several.
fn no_band(path: &Path, dataset: &Dataset) -> DemError {
    let names: Vec<String> = dataset
        .metadata_domain("SUBDATASETS")
        .unwrap_or_default()
        .iter()
        .filter_map(|line| line.split_once('='))
        .filter(|(key, _)| key.ends_with("_NAME"))
        .map(|(_, name)| name.to_owned())
        .collect();
    let path = path.to_path_buf();
    if names.is_empty() {
        DemError::NoBand { path }
    } else {
        DemError::Subdatasets { path, names: names.join(", ") }
    }
}

/// Colour bands are no heights. A palette alone is no reason to refuse: DEMs carry one for display.
fn refuse_imagery(path: &Path, dataset: &Dataset, band: &RasterBand<'_>) -> Result<(), DemError> {
    use ColorInterpretation as C;
    let interpretation = band.color_interpretation();
    let is_colour = matches!(
        interpretation,
        C::RedBand
            | C::GreenBand
            | C::BlueBand
            | C::AlphaBand
            | C::CyanBand
            | C::MagentaBand
            | C::YellowBand
            | C::BlackBand
    );
    if is_colour && dataset.raster_count() >= 3 {
        return Err(DemError::Imagery {
            path: path.to_path_buf(),
            bands: dataset.raster_count(),
            interpretation: interpretation.name().to_lowercase(),
        });
    }
    Ok(())
}

/// The geotransform, or the one that tie points agree upon; `true` for the latter.
///
/// GDAL refers both to pixel *corners*, whether the file says `PixelIsArea` or `PixelIsPoint`.
fn geo_transform(path: &Path, dataset: &Dataset) -> Result<(GeoTransform, bool), DemError> {
    if let Ok(coefficients) = dataset.geo_transform() {
        return Ok((GeoTransform { coefficients }, false));
    }
    let ties: Vec<[f64; 4]> =
        dataset.gcps().iter().map(|tie| [tie.pixel(), tie.line(), tie.x(), tie.y()]).collect();
    match affine_through(&ties) {
        Some(transform) => Ok((transform, true)),
        None => Err(DemError::NoGeoTransform { path: path.to_path_buf() }),
    }
}

/// The affine map that best fits `[column, row, x, y]` pairs; `None` unless it fits them all.
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

fn crs_of(
    path: &Path,
    reference: Option<gdal::spatial_ref::SpatialRef>,
    options: &OpenOptions,
) -> Result<(Crs, Option<VerticalCrs>), DemError> {
    let own = || path.to_path_buf();
    let named = reference.filter(|reference| !reference.is_local());
    let horizontal = named.as_ref().map(Crs::horizontal).transpose()?.flatten();
    match (horizontal, &options.dem_crs, named) {
        (Some(found), _, _) => Ok(found),
        (None, Some(text), _) => Crs::from_text("--dem-crs", text),
        (None, None, Some(unusable)) => {
            Err(DemError::UnusableCrs { path: own(), name: unusable.name().unwrap_or_default() })
        }
        (None, None, None) => Err(DemError::NoCrs { path: own() }),
    }
}

#[cfg(test)]
#[path = "source_tests.rs"]
mod tests;
