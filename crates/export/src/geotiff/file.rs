//! A raster file while it is written.

use std::path::{Path, PathBuf};

use corniche_store::LackOfRoom;
use flate2::Crc;
use gdal::{
    Dataset, DatasetOptions, Driver, DriverManager, GdalOpenFlags, Metadata as _,
    errors::GdalError,
    raster::{Buffer, GdalType, RasterCreationOptions},
    spatial_ref::{AxisMappingStrategy, SpatialRef},
};

use super::grid::{BLOCK, RasterSize};
use crate::{
    error::GdalFileError,
    gdal_writing::{self, GdalSettings, plain_text},
};

const DRIVER: &str = "GTiff";
/// GDAL's settings while a file is written and read back: all metadata are in the file itself, and
/// GDAL treats pixels that are points as points.
const SETTINGS: [(&str, &str); 3] = [
    ("GDAL_PAM_ENABLED", "NO"),
    ("GTIFF_POINT_GEO_IGNORE", "NO"),
    ("GTIFF_REPORT_COMPD_CS", "YES"),
];
/// Creation options of every raster. All TIFF readers support DEFLATE.
const OPTIONS: [&str; 8] = [
    "TILED=YES",
    "BLOCKXSIZE=256",
    "BLOCKYSIZE=256",
    "COMPRESS=DEFLATE",
    "BIGTIFF=IF_SAFER",
    // Readers of version 1.0 ignore the vertical CRS.
    "GEOTIFF_VERSION=1.1",
    // The same bytes, whatever the environment sets.
    "NUM_THREADS=1",
    "SPARSE_OK=FALSE",
];

/// The kind of a raster's pixels.
pub(crate) struct PixelKind {
    /// Creation options in addition to [`OPTIONS`].
    options: &'static [&'static str],
    /// Whether a pixel represents its area or the point in its middle, in GDAL's words.
    area_or_point: &'static str,
    /// The value that means no data.
    no_data: Option<f64>,
}

/// Heights at points. The floating-point predictor makes the file small. Bands are stored one after
/// the other, so a program that reads heights need not read errors. NaN cannot be mistaken for a
/// height.
pub(crate) const HEIGHTS: PixelKind = PixelKind {
    options: &["PREDICTOR=3", "INTERLEAVE=BAND"],
    area_or_point: "Point",
    no_data: Some(f64::NAN),
};

/// Red, green and blue of areas. The predictor stores differences of neighbours.
pub(crate) const COLORS: PixelKind = PixelKind {
    options: &["PREDICTOR=2", "INTERLEAVE=PIXEL", "PHOTOMETRIC=RGB"],
    area_or_point: "Area",
    no_data: None,
};

/// The type of a pixel.
pub(crate) trait Pixel: GdalType + bytemuck::Pod + Send {}

impl<T: GdalType + bytemuck::Pod + Send> Pixel for T {}

/// The metadata of a raster.
pub(crate) struct RasterFacts {
    pub(crate) pixels: &'static PixelKind,
    /// The CRS as WKT2.
    pub(crate) crs: String,
    pub(crate) crs_from_pixel: [f64; 6],
    /// The description of each band.
    pub(crate) descriptions: Vec<String>,
    pub(crate) metadata: Vec<(&'static str, String)>,
}

/// A raster file that is written block by block, row by row from the north.
pub(crate) struct RasterFile<T> {
    path: PathBuf,
    dataset: Dataset,
    crs: SpatialRef,
    size: RasterSize,
    /// The checksum of each written block, band by band.
    written: Vec<Vec<u32>>,
    numbers: std::marker::PhantomData<T>,
    _settings: GdalSettings,
}

impl<T: Pixel> RasterFile<T> {
    /// Creates a file. Nothing may exist at `path`.
    pub(crate) fn create(
        path: &Path,
        size: RasterSize,
        facts: &RasterFacts,
    ) -> Result<Self, GdalFileError> {
        let settings = GdalSettings::set(&SETTINGS);
        let no_driver = |_| GdalFileError::NoDriver { driver: DRIVER };
        let driver = DriverManager::get_driver_by_name(DRIVER).map_err(no_driver)?;
        let (dataset, crs) = create::<T>(path, size, facts, &driver)
            .map_err(|error| GdalFileError::write(path, error))?;
        Ok(Self {
            path: path.to_path_buf(),
            dataset,
            crs,
            size,
            written: vec![Vec::new(); facts.descriptions.len()],
            numbers: std::marker::PhantomData,
            _settings: settings,
        })
    }

    /// Writes the next block of a band, counted from 0.
    pub(crate) fn push(&mut self, band: usize, block: Vec<T>) -> Result<(), GdalFileError> {
        let place = self.size.place(self.written[band].len());
        self.written[band].push(checksum(&block, self.size, place));
        let write = || {
            let mut raster = self.dataset.rasterband(band + 1)?;
            raster.write_block(place.into(), &mut Buffer::new((BLOCK, BLOCK), block))
        };
        write().map_err(|error| GdalFileError::write(&self.path, error))
    }

    /// Closes the file and reads all of it back, because GDAL does not report every error of
    /// closing. Returns whether the file has the same CRS.
    pub(crate) fn finish(self) -> Result<bool, GdalFileError> {
        let Self { path, dataset, crs, size, written, .. } = self;
        gdal_writing::close(dataset, &path)?;
        let again = read_again::<T>(&path, size, &written, &crs);
        // A truncated file may not even open.
        if let Ok(Some(is_same_crs)) = again {
            Ok(is_same_crs)
        } else {
            let room = LackOfRoom::at(&path);
            Err(GdalFileError::RasterNotWhole { path, room })
        }
    }
}

/// Creates the file and its CRS; returns `None` without the driver.
fn create<T: Pixel>(
    path: &Path,
    size: RasterSize,
    facts: &RasterFacts,
    driver: &Driver,
) -> Result<(Dataset, SpatialRef), GdalError> {
    let options: RasterCreationOptions =
        OPTIONS.iter().chain(facts.pixels.options).copied().collect();
    let mut dataset = driver.create_with_band_type_with_options::<T, _>(
        path,
        size.columns,
        size.rows,
        facts.descriptions.len(),
        &options,
    )?;
    // This comes before the georeference, whose keys depend on it.
    dataset.set_metadata_item("AREA_OR_POINT", facts.pixels.area_or_point, "")?;
    let crs = gdal_writing::east_north(&facts.crs)?;
    dataset.set_spatial_ref(&crs)?;
    dataset.set_geo_transform(&facts.crs_from_pixel)?;
    for (key, value) in &facts.metadata {
        dataset.set_metadata_item(key, &plain_text(value), "")?;
    }
    for (number, description) in (1..).zip(&facts.descriptions) {
        let mut band = dataset.rasterband(number)?;
        if facts.pixels.no_data.is_some() {
            band.set_no_data_value(facts.pixels.no_data)?;
        }
        band.set_description(description)?;
    }
    Ok((dataset, crs))
}

/// Compares all blocks with what was written (`None` if they differ), and then returns whether the
/// file has the same CRS.
fn read_again<T: Pixel>(
    path: &Path,
    size: RasterSize,
    written: &[Vec<u32>],
    crs: &SpatialRef,
) -> Result<Option<bool>, GdalError> {
    let options = DatasetOptions {
        open_flags: GdalOpenFlags::GDAL_OF_RASTER,
        allowed_drivers: Some(&[DRIVER]),
        ..DatasetOptions::default()
    };
    let dataset = Dataset::open_ex(path, options)?;
    if dataset.raster_count() != written.len() {
        return Ok(None);
    }
    for (number, written) in (1..).zip(written) {
        let band = dataset.rasterband(number)?;
        for (number, known) in written.iter().enumerate() {
            let place = size.place(number);
            let block: Buffer<T> = band.read_block(place.into())?;
            if checksum(block.data(), size, place) != *known {
                return Ok(None);
            }
        }
    }
    let mut found = dataset.spatial_ref()?;
    found.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    Ok(Some(found == *crs))
}

/// Returns the checksum of the part of a block that is inside the raster. GDAL chooses the values
/// beyond it.
fn checksum<T: Pixel>(block: &[T], size: RasterSize, place: [usize; 2]) -> u32 {
    let (mut crc, [columns, rows]) = (Crc::new(), size.block_size(place));
    for row in block.chunks(BLOCK).take(rows) {
        crc.update(bytemuck::cast_slice(&row[..columns]));
    }
    crc.sum()
}
