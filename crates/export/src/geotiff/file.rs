//! A raster that is being written.

use std::path::{Path, PathBuf};

use corniche_store::LackOfRoom;
use flate2::Crc;
use gdal::{
    Dataset, DatasetOptions, DriverManager, GdalOpenFlags, Metadata as _,
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
/// GDAL's settings while a file is written and read again: all that it says is in the file itself, and pixels that are points are taken for points.
const SETTINGS: [(&str, &str); 3] = [
    ("GDAL_PAM_ENABLED", "NO"),
    ("GTIFF_POINT_GEO_IGNORE", "NO"),
    ("GTIFF_REPORT_COMPD_CS", "YES"),
];
/// Creation options of every raster. DEFLATE is what every reader of TIFF has.
const OPTIONS: [&str; 8] = [
    "TILED=YES",
    "BLOCKXSIZE=256",
    "BLOCKYSIZE=256",
    "COMPRESS=DEFLATE",
    "BIGTIFF=IF_SAFER",
    // Readers of 1.0 pass over what heights are measured from.
    "GEOTIFF_VERSION=1.1",
    // The same bytes, whatever the environment says.
    "NUM_THREADS=1",
    "SPARSE_OK=FALSE",
];

/// What the pixels of a raster are.
pub(crate) struct PixelKind {
    /// Creation options beside [`OPTIONS`].
    options: &'static [&'static str],
    /// Whether a pixel stands for its area or for the point in its middle, as GDAL says it.
    area_or_point: &'static str,
    /// The value that stands for no data.
    no_data: Option<f64>,
}

/// Heights at points. The predictor for floating-point numbers makes the file small. Bands lie one after the other, so that a program that
/// wants heights need not read errors. No height can be mistaken for NaN.
pub(crate) const HEIGHTS: PixelKind = PixelKind {
    options: &["PREDICTOR=3", "INTERLEAVE=BAND"],
    area_or_point: "Point",
    no_data: Some(f64::NAN),
};

/// Red, green and blue of areas. The predictor takes differences of neighbours.
pub(crate) const COLORS: PixelKind = PixelKind {
    options: &["PREDICTOR=2", "INTERLEAVE=PIXEL", "PHOTOMETRIC=RGB"],
    area_or_point: "Area",
    no_data: None,
};

/// What a pixel is.
pub(crate) trait Pixel: GdalType + bytemuck::Pod + Send {}

impl Pixel for u8 {}
impl Pixel for f32 {}
impl Pixel for f64 {}

/// A height.
pub(crate) trait Number: Pixel {
    fn of(value: f64) -> Self;
}

impl Number for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

/// What a raster says of itself.
pub(crate) struct RasterFacts {
    pub(crate) pixels: &'static PixelKind,
    /// The CRS as WKT2.
    pub(crate) crs: String,
    pub(crate) crs_from_pixel: [f64; 6],
    /// The description of each band.
    pub(crate) descriptions: Vec<String>,
    pub(crate) metadata: Vec<(&'static str, String)>,
}

/// A raster that is being written, block by block, row by row from the north.
pub(crate) struct RasterFile<T> {
    path: PathBuf,
    dataset: Dataset,
    crs: SpatialRef,
    size: RasterSize,
    /// The checksum of each block that was written, band by band.
    written: Vec<Vec<u32>>,
    numbers: std::marker::PhantomData<T>,
    _settings: GdalSettings,
}

impl<T: Pixel> RasterFile<T> {
    /// Begins a file. Nothing may be at `path`.
    pub(crate) fn create(
        path: &Path,
        size: RasterSize,
        facts: &RasterFacts,
    ) -> Result<Self, GdalFileError> {
        let settings = GdalSettings::set(&SETTINGS);
        let created =
            create::<T>(path, size, facts).map_err(|error| GdalFileError::write(path, error))?;
        let (dataset, crs) = created.ok_or(GdalFileError::NoDriver { driver: DRIVER })?;
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

    /// Ends the file and reads all of it again: GDAL does not report everything that fails when a file is closed. Tells whether the file names the same CRS.
    pub(crate) fn finish(self) -> Result<bool, GdalFileError> {
        let Self { path, dataset, crs, size, written, .. } = self;
        gdal_writing::close(dataset, &path)?;
        let again = read_again::<T>(&path, size, &written, &crs);
        // A file that is cut off may not even be opened.
        if let Ok(Some(is_same_crs)) = again {
            Ok(is_same_crs)
        } else {
            let room = LackOfRoom::at(&path);
            Err(GdalFileError::RasterNotWhole { path, room })
        }
    }
}

/// The file, and its CRS; `None` without the driver.
fn create<T: Pixel>(
    path: &Path,
    size: RasterSize,
    facts: &RasterFacts,
) -> Result<Option<(Dataset, SpatialRef)>, GdalError> {
    let Ok(driver) = DriverManager::get_driver_by_name(DRIVER) else { return Ok(None) };
    let options: RasterCreationOptions =
        OPTIONS.iter().chain(facts.pixels.options).copied().collect();
    let mut dataset = driver.create_with_band_type_with_options::<T, _>(
        path,
        size.columns,
        size.rows,
        facts.descriptions.len(),
        &options,
    )?;
    // Before the georeference, whose keys depend on it.
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
    Ok(Some((dataset, crs)))
}

/// Whether all blocks are there as they were written (`None` if not), and then whether the file names the same CRS.
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

/// The checksum of what a block has of the raster: what is beyond it, GDAL chooses itself.
fn checksum<T: Pixel>(block: &[T], size: RasterSize, place: [usize; 2]) -> u32 {
    let (mut crc, [columns, rows]) = (Crc::new(), size.block_size(place));
    for row in block.chunks(BLOCK).take(rows) {
        crc.update(bytemuck::cast_slice(&row[..columns]));
    }
    crc.sum()
}
