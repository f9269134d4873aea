//! Georeferenced colour images, written as GeoTIFF for tests.

use std::path::{Path, PathBuf};

use gdal::{
    Dataset, DriverManager,
    raster::{Buffer, ColorInterpretation},
    spatial_ref::SpatialRef,
};

/// A `GeoTIFF` of bytes in several bands, which GDAL writes.
pub struct ColourImage<'a> {
    /// EPSG code of the CRS; 0 for none.
    pub epsg: u32,
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// The geotransform in GDAL's order, for the corner of the first pixel.
    pub transform: [f64; 6],
    /// Returns one value per band for the CRS position of a pixel's centre.
    pub value: &'a dyn Fn([f64; 2]) -> Vec<u8>,
    /// The colour interpretation of each band.
    pub interpretations: &'a [ColorInterpretation],
}

impl ColourImage<'_> {
    /// Red, green and blue.
    pub const RGB: [ColorInterpretation; 3] = [
        ColorInterpretation::RedBand,
        ColorInterpretation::GreenBand,
        ColorInterpretation::BlueBand,
    ];

    /// Writes the image; `tag` may change the dataset before its values are written.
    pub fn write(&self, folder: &Path, name: &str, tag: impl Fn(&mut Dataset)) -> PathBuf {
        let path = folder.join(name);
        let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
        let [columns, rows] = self.size;
        let bands = self.interpretations.len();
        let mut dataset =
            driver.create_with_band_type::<u8, _>(&path, columns, rows, bands).unwrap();
        dataset.set_geo_transform(&self.transform).unwrap();
        if self.epsg != 0 {
            dataset.set_spatial_ref(&SpatialRef::from_epsg(self.epsg).unwrap()).unwrap();
        }
        for (index, interpretation) in self.interpretations.iter().enumerate() {
            let mut band = dataset.rasterband(index + 1).unwrap();
            let number = interpretation.c_int();
            let own = ColorInterpretation::from_c_int(number).unwrap();
            band.set_color_interpretation(own).unwrap();
        }
        tag(&mut dataset);
        let g = self.transform;
        let mut values = vec![Vec::new(); bands];
        for row in 0..rows {
            for column in 0..columns {
                let (c, r) = (column as f64 + 0.5, row as f64 + 0.5);
                let at = [g[0] + g[1] * c + g[2] * r, g[3] + g[4] * c + g[5] * r];
                for (band, value) in values.iter_mut().zip((self.value)(at)) {
                    band.push(value);
                }
            }
        }
        for (index, values) in values.into_iter().enumerate() {
            let mut band = dataset.rasterband(index + 1).unwrap();
            band.write((0, 0), (columns, rows), &mut Buffer::new((columns, rows), values)).unwrap();
        }
        path
    }
}
