//! The meaning of the bands of a photo.

use std::path::Path;

use corniche_gis::{FileUse, RasterError, forget, has_own_mask};
use gdal::Dataset;
use gdal::errors::GdalError;
use gdal::raster::{ColorInterpretation, GdalDataType};

use crate::PhotoError;
use crate::filter::Pixels;

/// The bands of red, green, blue and opacity.
#[derive(Debug, Clone)]
pub(crate) struct Bands {
    colour: Colour,
    /// The number of the alpha band.
    alpha: Option<usize>,
    /// Whether the file has a mask for missing data.
    has_mask: bool,
    /// The nodata value of each colour band: pixels in which all bands have it are missing.
    nodata: Option<Vec<u8>>,
}

#[derive(Debug, Clone)]
enum Colour {
    /// Numbers of the bands.
    Rgb([usize; 3]),
    Grey(usize),
    /// Band 1, with the colour of each value.
    Palette(Box<[[u8; 4]; 256]>),
}

/// A band as the file describes it.
struct FoundBand {
    /// Its number, from 1.
    number: usize,
    interpretation: ColorInterpretation,
    data_type: GdalDataType,
    /// Its nodata value, if a byte can have it.
    nodata: Option<u8>,
}

impl Bands {
    pub(crate) fn from_dataset(path: &Path, dataset: &Dataset) -> Result<Self, PhotoError> {
        let broken = |source: GdalError| opening(path, source);
        let count = dataset.raster_count();
        let mut found = Vec::with_capacity(count);
        for number in 1..=count {
            let band = dataset.rasterband(number).map_err(broken)?;
            found.push(FoundBand {
                number,
                interpretation: band.color_interpretation(),
                data_type: band.band_type(),
                nodata: band
                    .no_data_value()
                    .filter(|value| (0.0..=255.0).contains(value) && value.fract() == 0.0)
                    .map(|value| value as u8),
            });
        }
        let alpha = found
            .iter()
            .find(|band| band.interpretation == ColorInterpretation::AlphaBand)
            .map(|band| band.number);
        let colour = Self::colour(path, dataset, &found, alpha)?;
        for number in colour.bands().into_iter().chain(alpha) {
            let kind = found[number - 1].data_type;
            if kind != GdalDataType::UInt8 {
                let kind = kind.name();
                return Err(PhotoError::SampleType { path: path.to_path_buf(), kind });
            }
        }
        let first = dataset.rasterband(colour.bands()[0]).map_err(broken)?;
        let has_mask = has_own_mask(&first).map_err(broken)?;
        let nodata = colour.bands().into_iter().map(|number| found[number - 1].nodata).collect();
        Ok(Self { colour, alpha, has_mask, nodata })
    }

    fn colour(
        path: &Path,
        dataset: &Dataset,
        bands: &[FoundBand],
        alpha: Option<usize>,
    ) -> Result<Colour, PhotoError> {
        use ColorInterpretation as C;
        let own = || path.to_path_buf();
        let with = |wanted: C| {
            bands.iter().find(|band| band.interpretation == wanted).map(|band| band.number)
        };
        if with(C::PaletteIndex) == Some(1) {
            let band = dataset.rasterband(1).map_err(|source| opening(path, source))?;
            let table = band.color_table().ok_or_else(|| PhotoError::NoPalette { path: own() })?;
            let mut colours = Box::new([[0; 4]; 256]);
            for (index, colour) in colours.iter_mut().enumerate().take(table.entry_count()) {
                if let Some(entry) = table.entry_as_rgb(index) {
                    *colour =
                        [entry.r, entry.g, entry.b, entry.a].map(|part| part.clamp(0, 255) as u8);
                }
            }
            return Ok(Colour::Palette(colours));
        }
        if let (Some(red), Some(green), Some(blue)) =
            (with(C::RedBand), with(C::GreenBand), with(C::BlueBand))
        {
            return Ok(Colour::Rgb([red, green, blue]));
        }
        let colours: Vec<usize> = bands
            .iter()
            .filter(|band| {
                Some(band.number) != alpha
                    && matches!(band.interpretation, C::Undefined | C::GrayIndex)
            })
            .map(|band| band.number)
            .collect();
        match colours[..] {
            // Files without colour interpretation have the bands in this order.
            [red, green, blue, ..] => Ok(Colour::Rgb([red, green, blue])),
            [grey, ..] => Ok(Colour::Grey(grey)),
            [] => {
                let names: Vec<String> =
                    bands.iter().map(|band| band.interpretation.name().to_lowercase()).collect();
                let interpretations = names.join(", ");
                Err(PhotoError::Bands { path: own(), bands: bands.len(), interpretations })
            }
        }
    }

    /// The pixels of a rectangle.
    pub(crate) fn read(
        &self,
        path: &Path,
        dataset: &Dataset,
        [column, row]: [usize; 2],
        [columns, rows]: [usize; 2],
    ) -> Result<Pixels, RasterError> {
        let (start, size) = ((column as isize, row as isize), (columns, rows));
        let mut values = vec![0_u8; columns * rows];
        let mut rgba = vec![[0, 0, 0, 255]; columns * rows];
        let mut read = || -> Result<(), GdalError> {
            let numbers = self.colour.bands();
            let mut is_none = vec![self.nodata.is_some(); columns * rows];
            for (place, &number) in numbers.iter().enumerate() {
                let band = dataset.rasterband(number)?;
                band.read_into_slice(start, size, size, &mut values, None)?;
                for (pixel, &value) in rgba.iter_mut().zip(&values) {
                    match &self.colour {
                        Colour::Rgb(_) => pixel[place] = value,
                        Colour::Grey(_) => pixel[..3].fill(value),
                        Colour::Palette(colours) => *pixel = colours[usize::from(value)],
                    }
                }
                if let Some(nodata) = &self.nodata {
                    for (is_none, &value) in is_none.iter_mut().zip(&values) {
                        *is_none &= value == nodata[place];
                    }
                }
            }
            if let Some(alpha) = self.alpha {
                let band = dataset.rasterband(alpha)?;
                band.read_into_slice(start, size, size, &mut values, None)?;
                rgba.iter_mut().zip(&values).for_each(|(pixel, &value)| pixel[3] = value);
            }
            if self.has_mask {
                let band = dataset.rasterband(numbers[0])?;
                let mask = band.open_mask_band()?;
                mask.read_into_slice(start, size, size, &mut values, None)?;
                for (pixel, _) in rgba.iter_mut().zip(&values).filter(|(_, value)| **value == 0) {
                    pixel[3] = 0;
                }
            }
            for (pixel, _) in rgba.iter_mut().zip(&is_none).filter(|(_, is_none)| **is_none) {
                pixel[3] = 0;
            }
            Ok(())
        };
        forget();
        read().map_err(|source| RasterError::Read {
            kind: FileUse::Photo,
            path: path.to_path_buf(),
            start: [column, row],
            size: [columns, rows],
            source: source.into(),
        })?;
        Ok(Pixels { start: [column as i64, row as i64], columns, rows, rgba })
    }
}

impl Colour {
    fn bands(&self) -> Vec<usize> {
        match self {
            Self::Rgb(bands) => bands.to_vec(),
            Self::Grey(band) => vec![*band],
            Self::Palette(_) => vec![1],
        }
    }
}

fn opening(path: &Path, source: GdalError) -> PhotoError {
    RasterError::unreadable(path, source).into()
}
