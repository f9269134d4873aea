//! The conversion of stored values to heights in metres, and the options that describe files
//! without metadata.

use std::path::Path;

use corniche_gis::{RasterError, VerticalCrs, has_own_mask};
use gdal::Metadata;
use gdal::raster::{GdalDataType, RasterBand};

use crate::OpenDemError;

/// Values beyond this are not heights: programs write ±3.4e38, 1e20 and similar values for voids,
/// and the centre of the earth is only 6 400 km from sea level.
const NO_HEIGHT_M: f64 = 1e7;
/// The void value of 16-bit SRTM files, even if it is not declared.
const SRTM_VOID: f64 = -32768.0;
/// Units of a band and of its vertical CRS within this relative difference are equal: "ft" is often
/// written for survey feet.
const SAME_UNIT: f64 = 1e-5;

/// How to read an elevation file whose metadata are incomplete.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenOptions {
    /// The band with the heights, counted from 1, of files that have several. `None` rejects such
    /// files.
    pub band: Option<u32>,
    /// The CRS, "EPSG:n" or WKT, of files that name none. A file that names one keeps it.
    pub dem_crs: Option<String>,
    /// The unit of heights, regardless of bands and vertical CRSs; `None` uses their unit, and
    /// rejects an unknown unit of a band.
    pub vertical_unit: Option<String>,
    /// Stored values that mean "no height", besides the one that the file declares.
    pub nodata: Vec<f64>,
    /// The vertical CRS, "EPSG:n" or WKT, of files that name none, with its unit and direction. A
    /// file that names one keeps it.
    pub dem_vertical_crs: Option<String>,
    /// The target vertical CRS of heights, "EPSG:n" or WKT; `None` leaves heights unchanged.
    ///
    /// PROJ uses the best operation for which it has the grids; approximations without grids are
    /// not allowed. If the grid of the best operation is not installed but that of a worse one is,
    /// such as an older geoid model, PROJ uses the worse one without a message. The build does not
    /// request only the best operation, which GDAL supports since 3.8 (PROJ since 9.2 has an
    /// environment variable for this, `PROJ_ONLY_BEST_DEFAULT`). Instead,
    /// [`crate::GridPlan::vertical`] records the offset at the centre, to the millimetre: its text
    /// differs between runs whose grids differ there.
    pub vertical_crs: Option<String>,
    /// Metres that are added to every height at the end.
    pub vertical_shift_m: f64,
}

/// How stored values become heights.
#[derive(Debug, Clone)]
pub(crate) struct StoredValues {
    nodata: Vec<f64>,
    /// Whether values are stored as 32-bit floats, so that sentinels are compared in this
    /// precision.
    is_f32: bool,
    /// Whether bytes are signed, which GDAL returns as unsigned.
    is_signed_byte: bool,
    scale: f64,
    offset: f64,
    /// Metres upwards per unit; negative for depths.
    unit_m: f64,
    /// Whether GDAL has a mask that goes beyond the sentinels.
    pub(crate) has_mask: bool,
}

impl StoredValues {
    pub(crate) fn from_band(
        path: &Path,
        (number, band): (usize, &RasterBand<'_>),
        vertical: Option<&VerticalCrs>,
        options: &OpenOptions,
    ) -> Result<Self, OpenDemError> {
        let kind = band.band_type();
        // Complex numbers of all kinds are among the unknown types here.
        if kind == GdalDataType::Unknown {
            return Err(OpenDemError::SampleType { path: path.to_path_buf(), band: number });
        }
        let mut nodata: Vec<f64> =
            declared(band, kind).into_iter().chain(options.nodata.iter().copied()).collect();
        if kind == GdalDataType::Int16 {
            nodata.push(SRTM_VOID);
        }
        let (scale, offset) = (band.scale().unwrap_or(1.0), band.offset().unwrap_or(0.0));
        if !(scale.is_finite() && offset.is_finite()) || scale == 0.0 {
            let path = path.to_path_buf();
            return Err(OpenDemError::Scale { path, band: number, scale, offset });
        }
        let has_mask =
            has_own_mask(band).map_err(|source| RasterError::unreadable(path, source))?;
        let pixel_type = band.metadata_item("PIXELTYPE", "IMAGE_STRUCTURE");
        Ok(Self {
            nodata,
            is_f32: kind == GdalDataType::Float32,
            is_signed_byte: pixel_type.as_deref() == Some("SIGNEDBYTE"),
            scale,
            offset,
            unit_m: m_per_value(path, &band.unit(), vertical, options.vertical_unit.as_deref())?,
            // GDAL also derives masks from the band's nodata value and from some alpha bands; the
            // own comparison is exact, and covers all types.
            has_mask,
        })
    }

    /// A stored value as text, with no more digits than in the file: the user may pass it as the
    /// value for "no data".
    pub(crate) fn stored_text(&self, value: f64) -> String {
        match value {
            value if self.is_signed_byte && value > 127.0 => (value - 256.0).to_string(),
            value if self.is_f32 => (value as f32).to_string(),
            value => value.to_string(),
        }
    }

    /// The difference in metres between heights whose stored values are consecutive whole numbers.
    pub(crate) fn m_per_whole(&self) -> f64 {
        (self.scale * self.unit_m).abs()
    }

    /// Converts stored values to metres, in place; values that are not heights become NaN.
    #[expect(clippy::float_cmp, reason = "a sentinel is one value, not a neighbourhood")]
    pub(crate) fn convert(&self, values: &mut [f64]) {
        for value in values {
            if self.is_signed_byte && *value > 127.0 {
                *value -= 256.0;
            }
            let is_sentinel = self.nodata.iter().any(|&sentinel| {
                // A 32-bit file stores its sentinel rounded to 32 bits; its tag has all digits.
                *value == sentinel || self.is_f32 && *value == f64::from(sentinel as f32)
            });
            let height_m = (*value * self.scale + self.offset) * self.unit_m;
            let is_height = !is_sentinel && height_m.abs() <= NO_HEIGHT_M;
            *value = if is_height { height_m } else { f64::NAN };
        }
    }
}

/// The nodata value that the file declares.
fn declared(band: &RasterBand<'_>, kind: GdalDataType) -> Option<f64> {
    match kind {
        // GDAL has separate functions for 64-bit integers, because not all of them fit into
        // floating-point numbers, in which the samples are read.
        GdalDataType::Int64 => band.no_data_value_i64().map(|value| value as f64),
        GdalDataType::UInt64 => band.no_data_value_u64().map(|value| value as f64),
        _ => band.no_data_value(),
    }
}

/// Metres upwards per unit of a value: from the given unit, the band's unit, the vertical CRS, or
/// metres by default.
fn m_per_value(
    path: &Path,
    band_unit: &str,
    vertical: Option<&VerticalCrs>,
    given: Option<&str>,
) -> Result<f64, OpenDemError> {
    if let Some(given) = given {
        let metres = unit_m(given.trim());
        let metres = metres.ok_or_else(|| OpenDemError::UnitName { text: given.to_owned() })?;
        return Ok(vertical.map_or(metres, |vertical| metres.copysign(vertical.m_per_value())));
    }
    let named = match band_unit.trim() {
        "" => None,
        unit => Some(unit_m(unit).ok_or_else(|| OpenDemError::Unit {
            path: path.to_path_buf(),
            unit: unit.to_owned(),
        })?),
    };
    let Some(vertical) = vertical else { return Ok(named.unwrap_or(1.0)) };
    if named.is_some_and(|unit_m| (unit_m / vertical.unit_m - 1.0).abs() > SAME_UNIT) {
        return Err(OpenDemError::UnitsDisagree {
            path: path.to_path_buf(),
            unit: band_unit.trim().to_owned(),
            vertical: vertical.name.clone(),
            vertical_unit_m: vertical.unit_m,
        });
    }
    Ok(vertical.m_per_value())
}

/// Metres per unit of length, as raster bands name the unit.
fn unit_m(name: &str) -> Option<f64> {
    Some(match name.to_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => 1.0,
        "km" | "kilometre" | "kilometer" => 1000.0,
        "dm" | "decimetre" | "decimeter" => 0.1,
        "cm" | "centimetre" | "centimeter" | "centimetres" | "centimeters" => 0.01,
        "mm" | "millimetre" | "millimeter" => 0.001,
        "ft" | "foot" | "feet" | "international foot" | "international feet" => 0.3048,
        "us-ft" | "us-foot" | "us ft" | "us_ft" | "ftus" | "us survey foot" | "us survey feet"
        | "us foot" | "us feet" | "foot_us" | "sft" | "survey foot" | "us_survey_foot" => {
            1200.0 / 3937.0
        }
        _ => return None,
    })
}

#[cfg(test)]
#[path = "stored_values_tests.rs"]
mod tests;
