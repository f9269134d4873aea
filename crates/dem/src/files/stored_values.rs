//! From stored values to heights in metres, and the options that say how to understand a file where
//! it does not say so itself.

use std::path::Path;

use corniche_gis::{RasterError, VerticalCrs, has_own_mask};
use gdal::Metadata;
use gdal::raster::{GdalDataType, RasterBand};

use crate::OpenDemError;

/// Values beyond this are not heights: programs write ±3.4e38, 1e20 and the like for "nothing
/// here", and the centre of the earth is only 6 400 km from sea level.
const NO_HEIGHT_M: f64 = 1e7;
/// The value for "nothing here" in the 16-bit files of SRTM, also where they do not declare it.
const SRTM_VOID: f64 = -32768.0;
/// Units of a band and of its vertical CRS are the same within this: "ft" is often written for
/// survey feet.
const SAME_UNIT: f64 = 1e-5;

/// How an elevation file is to be understood where it does not say so itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenOptions {
    /// Band with the heights, from 1 on, of the files that have several. `None` refuses those.
    pub band: Option<u32>,
    /// CRS, "EPSG:n" or WKT, of the files that name none. A file that names one keeps it.
    pub dem_crs: Option<String>,
    /// The unit of heights, whatever bands and vertical CRSs say of it; `None` takes theirs, and
    /// refuses a band's that is not known.
    pub vertical_unit: Option<String>,
    /// Stored values that mean "no height", besides the one that the file declares.
    pub nodata: Vec<f64>,
    /// Vertical CRS, "EPSG:n" or WKT, of the files that name none; with its unit and direction. A
    /// file that names one keeps it.
    pub dem_vertical_crs: Option<String>,
    /// The vertical CRS that heights are wanted in, "EPSG:n" or WKT; `None` leaves them as they
    /// are.
    ///
    /// PROJ takes the best operation for which it has the grids; approximations without any are not
    /// allowed. Where the grid of the best is not installed but that of a lesser one is, an older
    /// model of the geoid say, PROJ takes the lesser one and does not tell. It is not asked for the
    /// best alone, which GDAL can do since 3.8 only (PROJ since 9.2 has an environment variable for
    /// it, `PROJ_ONLY_BEST_DEFAULT`). Instead [`crate::GridPlan::vertical`] records the offset
    /// found at the centre, to the millimetre: runs with grids that differ there read differently.
    pub vertical_crs: Option<String>,
    /// Added to every height, after all else, metres.
    pub vertical_shift_m: f64,
}

/// How stored values become heights.
#[derive(Debug, Clone)]
pub(crate) struct StoredValues {
    nodata: Vec<f64>,
    /// Stored as 32-bit floats, so that sentinels are compared in that precision.
    is_f32: bool,
    /// Bytes with a sign, which GDAL hands out without one.
    is_signed_byte: bool,
    scale: f64,
    offset: f64,
    /// Metres upwards to a unit; negative for depths.
    unit_m: f64,
    /// GDAL gives a mask that says more than the sentinels.
    pub(crate) has_mask: bool,
}

impl StoredValues {
    pub(crate) fn of(
        path: &Path,
        (number, band): (usize, &RasterBand<'_>),
        vertical: Option<&VerticalCrs>,
        options: &OpenOptions,
    ) -> Result<Self, OpenDemError> {
        let kind = band.band_type();
        // Complex numbers of all kinds are among the unknown here.
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
            // Of the band's nodata and of some alpha bands GDAL makes masks too; looking ourselves
            // is exact, and covers all types.
            has_mask,
        })
    }

    /// A stored value as text, with no more digits than the file has: the user may give it as the
    /// value for "no data".
    pub(crate) fn stored_text(&self, value: f64) -> String {
        match value {
            value if self.is_signed_byte && value > 127.0 => (value - 256.0).to_string(),
            value if self.is_f32 => (value as f32).to_string(),
            value => value.to_string(),
        }
    }

    /// Metres between heights whose stored values are neighbouring whole numbers.
    pub(crate) fn m_per_whole(&self) -> f64 {
        (self.scale * self.unit_m).abs()
    }

    /// Stored values to metres, in place; what is no height becomes NaN.
    #[expect(clippy::float_cmp, reason = "a sentinel is one value, not a neighbourhood")]
    pub(crate) fn convert(&self, values: &mut [f64]) {
        for value in values {
            if self.is_signed_byte && *value > 127.0 {
                *value -= 256.0;
            }
            let is_sentinel = self.nodata.iter().any(|&sentinel| {
                // A 32-bit file holds its sentinel rounded to 32 bits; its tag has all digits.
                *value == sentinel || self.is_f32 && *value == f64::from(sentinel as f32)
            });
            let height_m = (*value * self.scale + self.offset) * self.unit_m;
            let is_height = !is_sentinel && height_m.abs() <= NO_HEIGHT_M;
            *value = if is_height { height_m } else { f64::NAN };
        }
    }
}

/// The value that the file declares to mean nothing.
fn declared(band: &RasterBand<'_>, kind: GdalDataType) -> Option<f64> {
    match kind {
        // GDAL keeps these apart, as not all of them are floating-point numbers; neither are the
        // samples read.
        GdalDataType::Int64 => band.no_data_value_i64().map(|value| value as f64),
        GdalDataType::UInt64 => band.no_data_value_u64().map(|value| value as f64),
        _ => band.no_data_value(),
    }
}

/// Metres upwards to a value: by the unit that is given, by the band's, by the vertical CRS, or
/// metres where none of them says.
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

/// Metres to a unit of length as raster bands name it.
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
