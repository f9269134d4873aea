//! Rasters of heights, written as GeoTIFF for tests.

use std::path::{Path, PathBuf};

use gdal::{
    Dataset, DriverManager,
    raster::{Buffer, GdalType, RasterCreationOptions},
    spatial_ref::SpatialRef,
};

/// A `GeoTIFF` of heights, which GDAL writes.
pub struct Raster<'a> {
    /// EPSG code of the CRS; 0 for none.
    pub epsg: u32,
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// The geotransform in GDAL's order, for the corner of the first pixel; all zeros for none.
    pub geo_transform: [f64; 6],
    /// The nodata value.
    pub nodata: Option<f64>,
    /// Creation options of GDAL's GeoTIFF driver.
    pub creation: &'a [&'a str],
    /// Number of bands; heights are in the first.
    pub bands: usize,
    /// Changes the dataset before the heights are written.
    pub tag: Box<dyn Fn(&mut Dataset) + 'a>,
}

impl<'a> Raster<'a> {
    /// Creates a raster with one band, without a nodata value, without options.
    #[must_use]
    pub fn new(epsg: u32, size: [usize; 2], geo_transform: [f64; 6]) -> Self {
        let tag = Box::new(|_: &mut Dataset| {});
        Self { epsg, size, geo_transform, nodata: None, creation: &[], bands: 1, tag }
    }

    /// Sets a function that changes the dataset before the heights are written.
    #[must_use]
    pub fn tagged(self, tag: impl Fn(&mut Dataset) + 'a) -> Self {
        Self { tag: Box::new(tag), ..self }
    }

    /// Sets creation options of GDAL's driver.
    #[must_use]
    pub fn created(self, creation: &'a [&'a str]) -> Self {
        Self { creation, ..self }
    }

    /// Sets the number of bands.
    #[must_use]
    pub fn bands(self, bands: usize) -> Self {
        Self { bands, ..self }
    }

    /// Sets the nodata value.
    #[must_use]
    pub fn nodata(self, nodata: f64) -> Self {
        Self { nodata: Some(nodata), ..self }
    }

    /// Returns the CRS position of a sample: the centre of its pixel.
    #[must_use]
    pub fn sample_at(&self, column: usize, row: usize) -> [f64; 2] {
        let g = self.geo_transform;
        let (c, r) = (column as f64 + 0.5, row as f64 + 0.5);
        [g[0] + g[1] * c + g[2] * r, g[3] + g[4] * c + g[5] * r]
    }

    /// Writes the value of a function of the CRS position of each sample.
    pub fn write<T: GdalType + Copy>(
        &self,
        folder: &Path,
        name: &str,
        value: impl Fn([f64; 2]) -> T,
    ) -> PathBuf {
        let path = folder.join(name);
        let [columns, rows] = self.size;
        let samples = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let values = samples.map(|(column, row)| value(self.sample_at(column, row))).collect();
        self.write_values(&path, values);
        path
    }

    /// Writes values row by row from the north.
    pub fn write_values<T: GdalType + Copy>(&self, path: &Path, values: Vec<T>) {
        let [columns, rows] = self.size;
        let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
        let options = raster_creation_options(self.creation);
        let mut dataset = driver
            .create_with_band_type_with_options::<T, _>(path, columns, rows, self.bands, &options)
            .unwrap();
        if self.geo_transform.iter().any(|&part| part != 0.0) {
            dataset.set_geo_transform(&self.geo_transform).unwrap();
        }
        if self.epsg != 0 {
            dataset.set_spatial_ref(&SpatialRef::from_epsg(self.epsg).unwrap()).unwrap();
        }
        (self.tag)(&mut dataset);
        let mut band = dataset.rasterband(1).unwrap();
        if self.nodata.is_some() {
            band.set_no_data_value(self.nodata).unwrap();
        }
        band.write((0, 0), self.size.into(), &mut Buffer::new(self.size.into(), values)).unwrap();
    }
}

/// Returns creation options for GDAL, each of the form `NAME=VALUE`.
#[must_use]
pub fn raster_creation_options(options: &[&str]) -> RasterCreationOptions {
    options.iter().copied().collect()
}
