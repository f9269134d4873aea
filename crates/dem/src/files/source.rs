//! One elevation file: its metadata, and its samples in metres.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use corniche_geom::{GeoTransform, wgs84::SEMI_MAJOR_M};
use corniche_gis::{
    Crs, FileUse, Georeference, HeightOperation, RasterError, VerticalCrs, names_up_to, open_raster,
};
use gdal::errors::GdalError;
use gdal::raster::{ColorInterpretation, RasterBand};
use gdal::{Dataset, Metadata};

use crate::files::stored_values::{OpenOptions, StoredValues};
use crate::{OpenDemError, ReadHeightsError};

/// The largest number of bands that a message names.
const MOST_BANDS_NAMED: usize = 12;

/// An elevation file, described but not held open.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) path: PathBuf,
    pub(crate) columns: i64,
    pub(crate) rows: i64,
    /// The map from pixels to the CRS.
    pub(crate) crs_from_pixel: GeoTransform,
    pub(crate) crs: Crs,
    /// The vertical CRS of heights, from the file or from `--dem-vertical-crs`.
    pub(crate) vertical: Option<VerticalCrs>,
    /// Whether the band or the vertical CRS gives the unit of heights.
    pub(crate) has_height_unit: bool,
    /// The number of the band with the heights.
    pub(crate) band: usize,
    /// How stored values become metres, before the conversion to the vertical CRS and the shift.
    pub(crate) values: StoredValues,
    /// Whether samples are stored in whole rows rather than in tiles.
    pub(crate) is_striped: bool,
    /// The number of the band in which 0 means that there is no sample.
    alpha_band: Option<usize>,
    /// The operation to the requested vertical CRS, if it is another one.
    pub(crate) to_target: Option<HeightOperation>,
    pub(crate) shift_m: f64,
}

impl Source {
    pub(crate) fn open(path: &Path, options: &OpenOptions) -> Result<Self, OpenDemError> {
        let dataset = open_raster(path, FileUse::Dem)?;
        if dataset.raster_count() == 0 {
            return Err(no_band(path, &dataset));
        }
        let number = band_number(path, &dataset, options.band)?;
        let band =
            dataset.rasterband(number).map_err(|source| RasterError::unreadable(path, source))?;
        let (columns, rows) = dataset.raster_size();
        let Georeference { crs_from_pixel, crs, vertical } =
            Georeference::from_dataset(path, &dataset, options.dem_crs.as_deref())?;
        let given = || {
            let text = options.dem_vertical_crs.as_deref();
            text.map(|text| VerticalCrs::from_text("--dem-vertical-crs", text)).transpose()
        };
        let vertical = if vertical.is_some() { vertical } else { given()? };
        Ok(Self {
            path: path.to_path_buf(),
            columns: columns as i64,
            rows: rows as i64,
            crs_from_pixel,
            crs,
            band: number,
            has_height_unit: vertical.is_some()
                || options.vertical_unit.is_some()
                || !band.unit().trim().is_empty(),
            values: StoredValues::from_band(path, (number, &band), vertical.as_ref(), options)?,
            vertical,
            is_striped: band.block_size().0 == columns,
            alpha_band: alpha_band(&dataset),
            to_target: None,
            shift_m: 0.0,
        })
    }

    /// The samples of a rectangle of pixels in metres, row by row; NaN for voids.
    pub(crate) fn read(
        &self,
        dataset: &Dataset,
        [column, row]: [usize; 2],
        [columns, rows]: [usize; 2],
        heights_m: &mut Vec<f64>,
    ) -> Result<(), ReadHeightsError> {
        self.read_stored(dataset, [column, row], [columns, rows], heights_m)?;
        self.values.convert(heights_m);
        if let Some(operation) = &self.to_target {
            self.carry(operation, [column, row], columns, heights_m)?;
        }
        if self.shift_m != 0.0 {
            for height_m in heights_m.iter_mut() {
                *height_m += self.shift_m;
            }
        }
        Ok(())
    }

    /// Converts heights in metres to the requested vertical CRS, in place; voids (NaN) stay.
    ///
    /// Each height is converted at the position of its own sample in the whole file: the result
    /// does not depend on the rectangle that is read.
    fn carry(
        &self,
        operation: &HeightOperation,
        [column, row]: [usize; 2],
        columns: usize,
        heights_m: &mut [f64],
    ) -> Result<(), ReadHeightsError> {
        let sample = |at: usize| [column + at % columns, row + at / columns];
        let places: Vec<usize> =
            (0..heights_m.len()).filter(|&at| !heights_m[at].is_nan()).collect();
        let position = |&at: &usize| {
            self.crs_from_pixel.crs_from_pixel(sample(at).map(|index| index as f64 + 0.5))
        };
        let mut carried_m: Vec<f64> = places.iter().map(|&at| heights_m[at]).collect();
        operation.carry_m(places.iter().map(position).collect(), &mut carried_m)?;
        for (at, carried_m) in places.into_iter().zip(carried_m) {
            if carried_m.is_nan() {
                let ([column, row], to) = (sample(at), operation.target().to_owned());
                let path = self.path.clone();
                return Err(ReadHeightsError::VerticalPosition { path, column, row, to });
            }
            heights_m[at] = carried_m;
        }
        Ok(())
    }

    /// The stored values of a rectangle of pixels, row by row; NaN where a mask marks a void.
    pub(crate) fn read_stored(
        &self,
        dataset: &Dataset,
        [column, row]: [usize; 2],
        [columns, rows]: [usize; 2],
        values: &mut Vec<f64>,
    ) -> Result<(), RasterError> {
        let (start, size) = ((column as isize, row as isize), (columns, rows));
        let mut read = || -> Result<(), GdalError> {
            values.resize(columns * rows, 0.0);
            let band = dataset.rasterband(self.band)?;
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
        read().map_err(|source| RasterError::Read {
            kind: FileUse::Dem,
            path: self.path.clone(),
            start: [column, row],
            size: [columns, rows],
            source: source.into(),
        })
    }
}

/// Replaces values by NaN.
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

/// The error for a file without a raster band, which may be a container of several rasters.
fn no_band(path: &Path, dataset: &Dataset) -> OpenDemError {
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
        OpenDemError::NoBand { path }
    } else {
        OpenDemError::Subdatasets { path, names: names.join(", ") }
    }
}

impl Source {
    /// The distance between neighbouring samples, along the axis where it is larger, in metres; for
    /// degrees as at the equator.
    pub(crate) fn spacing_m(&self) -> f64 {
        let c = self.crs_from_pixel.coefficients;
        let around_m = TAU * SEMI_MAJOR_M;
        let unit_m = self.crs.turn_angle().map_or(self.crs.unit_m, |turn| around_m / turn);
        c[1].hypot(c[4]).max(c[2].hypot(c[5])) * unit_m
    }
}

/// The band with the heights: the only one besides an alpha band, or the requested one of several.
/// Without a request, a raster with several bands is rejected: which of them has heights is not
/// guessed.
fn band_number(path: &Path, dataset: &Dataset, asked: Option<u32>) -> Result<usize, OpenDemError> {
    let count = dataset.raster_count();
    if asked.is_none() {
        refuse_imagery(path, dataset)?;
    }
    let is_alpha =
        |band: &RasterBand<'_>| band.color_interpretation() == ColorInterpretation::AlphaBand;
    let bands = (1..=count).filter_map(|number| Some((number, dataset.rasterband(number).ok()?)));
    let of_values: Vec<_> = bands.filter(|(_, band)| !is_alpha(band)).collect();
    match (asked, of_values.as_slice()) {
        // No file has a band 0.
        (Some(asked), bands) if asked == 0 || bands.len() > 1 => match asked as usize {
            number if (1..=count).contains(&number) => Ok(number),
            _ => Err(OpenDemError::NoSuchBand { path: path.to_path_buf(), asked, count }),
        },
        (_, []) => Ok(1),
        (_, [(number, _)]) => Ok(*number),
        (_, [_, ..]) => {
            let names = of_values.iter().map(|(number, band)| match band.description() {
                Ok(name) if !name.trim().is_empty() => format!("{number} {name:?}"),
                _ => format!("{number} (no name, {})", band.band_type()),
            });
            Err(OpenDemError::SeveralBands {
                path: path.to_path_buf(),
                bands: names_up_to(MOST_BANDS_NAMED, names),
            })
        }
    }
}

/// Rejects images: bands of colours are not heights. A palette is no reason to reject: DEMs can
/// have one for display.
fn refuse_imagery(path: &Path, dataset: &Dataset) -> Result<(), OpenDemError> {
    use ColorInterpretation as C;
    let band = dataset.rasterband(1).map_err(|source| RasterError::unreadable(path, source))?;
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
        return Err(OpenDemError::Imagery {
            path: path.to_path_buf(),
            bands: dataset.raster_count(),
            interpretation: interpretation.name().to_lowercase(),
        });
    }
    Ok(())
}
