//! Writes an image from above as a GeoTIFF.

use std::path::Path;

use image::RgbaImage;

use super::{
    file::{COLORS, RasterFacts, RasterFile},
    grid::{BLOCK, RasterSize},
    place_of_picture::PlaceOfPicture,
};
use crate::error::GdalFileError;

/// The bands of an image.
const BANDS: [&str; 3] = ["red", "green", "blue"];

/// The metadata of an image's file, in addition to the georeference.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PictureFacts {
    /// The contents of the image.
    pub description: String,
    /// Program and version that created it.
    pub software: String,
    /// The attribution that must be displayed with it.
    pub attribution: String,
    /// Pixels per inch in print, if known.
    pub dots_per_inch: Option<f64>,
}

/// Writes an image to a new `GeoTIFF` at `path`: red, green and blue. After an error that file is
/// incomplete. Returns whether the file has exactly the package's CRS: `GeoTIFF` cannot express
/// every CRS.
///
/// # Errors
/// When something cannot be written.
pub fn export_picture(
    picture: &RgbaImage,
    place: &PlaceOfPicture,
    facts: &PictureFacts,
    path: &Path,
) -> Result<bool, GdalFileError> {
    let [columns, rows] = [picture.width(), picture.height()].map(|side| side as usize);
    let size = RasterSize { columns, rows };
    let mut file = RasterFile::<u8>::create(path, size, &raster_facts(place, facts))?;
    let [across, down] = size.blocks();
    for number in 0..across * down {
        for band in 0..BANDS.len() {
            file.push(band, block(picture, size, size.place(number), band))?;
        }
    }
    file.finish()
}

fn raster_facts(place: &PlaceOfPicture, facts: &PictureFacts) -> RasterFacts {
    let PictureFacts { description, software, attribution, dots_per_inch } = facts;
    let mut metadata = vec![
        ("TIFFTAG_IMAGEDESCRIPTION", description.clone()),
        ("TIFFTAG_SOFTWARE", software.clone()),
        ("TIFFTAG_COPYRIGHT", attribution.clone()),
    ];
    metadata.retain(|(_, text)| !text.is_empty());
    if let Some(dots) = dots_per_inch {
        metadata.push(("TIFFTAG_XRESOLUTION", dots.to_string()));
        metadata.push(("TIFFTAG_YRESOLUTION", dots.to_string()));
        // The unit 2 means inches.
        metadata.push(("TIFFTAG_RESOLUTIONUNIT", "2".to_owned()));
    }
    RasterFacts {
        pixels: &COLORS,
        crs: place.crs().to_owned(),
        crs_from_pixel: place.crs_from_pixel(),
        descriptions: BANDS.map(str::to_owned).to_vec(),
        metadata,
    }
}

/// Returns one band of a block in the form in which it is written: 256 × 256 pixels, with 0 for
/// pixels beyond the image.
fn block(picture: &RgbaImage, size: RasterSize, place: [usize; 2], band: usize) -> Vec<u8> {
    let [columns, rows] = size.block_size(place);
    let [left, top] = place.map(|blocks| blocks * BLOCK);
    let mut block = vec![0; BLOCK * BLOCK];
    for (row, line) in block.chunks_mut(BLOCK).take(rows).enumerate() {
        for (column, value) in line.iter_mut().take(columns).enumerate() {
            // Sides of images are u32, and these coordinates are within.
            *value = picture.get_pixel((left + column) as u32, (top + row) as u32).0[band];
        }
    }
    block
}

#[cfg(test)]
#[path = "write_picture_tests.rs"]
mod tests;
