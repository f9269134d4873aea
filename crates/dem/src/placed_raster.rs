//! Any raster with its place on the earth, such as a photo, and the way from its pixels to working metres and back.

use std::path::{Path, PathBuf};

use corniche_geom::{GeoTransform, Seam};
use gdal::Dataset;

use crate::crs::horizontal::Crs;
use crate::crs::operation::Operation;
use crate::files::file_blocks::{self, FileBlocks};
use crate::files::georeference::{crs_of, geo_transform, refuse_off_globe};
use crate::files::open::open_dataset;
use crate::{DemError, FileDatums, GridPlan, OpenOptions, library_error};

/// Where any raster lies, also one without heights, such as an image; described but not held open.
#[derive(Debug, Clone)]
pub struct PlacedRaster {
    path: PathBuf,
    size: [usize; 2],
    /// The map from pixel corners, whether the file says `PixelIsArea` or `PixelIsPoint`: GDAL sees to that.
    crs_from_pixel: GeoTransform,
    crs: Crs,
}

impl PlacedRaster {
    /// Opens a raster and reads where it lies: by its geotransform, or by tie points that agree on one.
    ///
    /// # Errors
    /// When the file cannot be opened, or lacks georeference or CRS.
    pub fn open(path: &Path) -> Result<(Self, Dataset), DemError> {
        library_error::quiet();
        let dataset = open_dataset(path)?;
        let (crs_from_pixel, is_tied) = geo_transform(path, &dataset)?;
        let reference =
            if is_tied { dataset.gcp_spatial_ref() } else { dataset.spatial_ref().ok() };
        let (crs, _) = crs_of(path, reference, &OpenOptions::default())?;
        let coefficients = crs_from_pixel.coefficients;
        let is_usable = coefficients.iter().all(|value| value.is_finite())
            && crs_from_pixel.pixel_from_crs([0.0, 0.0]).is_some();
        if !is_usable {
            return Err(DemError::GeoTransform { path: path.to_path_buf(), coefficients });
        }
        let (columns, rows) = dataset.raster_size();
        refuse_off_globe(path, &crs, &crs_from_pixel, (columns, rows))?;
        let placed = Self { path: path.to_path_buf(), size: [columns, rows], crs_from_pixel, crs };
        Ok((placed, dataset))
    }

    /// Opens it again.
    ///
    /// # Errors
    /// When it cannot be opened any more.
    pub fn dataset(&self) -> Result<Dataset, DemError> {
        open_dataset(&self.path)
    }

    /// How the file is cut into blocks; of a virtual raster (VRT) also the files that it refers to.
    ///
    /// # Errors
    /// When it cannot be opened any more.
    pub fn blocks(&self) -> Result<Vec<FileBlocks>, DemError> {
        file_blocks::of_file(&self.path, 1)
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Relates its pixels to a package's grid.
    #[must_use]
    pub fn on(&self, grid: &GridPlan) -> RasterOnGrid {
        let area_deg = Some(grid.area_deg());
        let [columns, rows] = self.size.map(|pixels| pixels as f64);
        let [middle, _] = self.crs_from_pixel.crs_from_pixel([columns / 2.0, rows / 2.0]);
        RasterOnGrid {
            crs_from_working: Operation::out_of_working(&grid.working, &self.crs, area_deg)
                .around(self.crs.turn.map(|turn| Seam::new(middle, turn))),
            working_from_crs: Operation::into_working(&self.crs, &grid.working, area_deg),
            crs_from_pixel: self.crs_from_pixel,
        }
    }
}

impl GridPlan {
    /// How rasters such as photos come to the datum of the grid.
    pub fn datums_of_rasters<'a>(
        &self,
        rasters: impl Iterator<Item = &'a PlacedRaster>,
    ) -> FileDatums {
        self.datums_of(rasters.map(|raster| (&raster.crs, raster.path())))
    }
}

/// The pixels of a raster and the working metres of a package, through PROJ. Goes to any thread.
///
/// Pixel positions are continuous: 0, 0 is the outer corner of the first pixel, its centre is at 0.5, 0.5.
#[derive(Debug, Clone)]
pub struct RasterOnGrid {
    crs_from_working: Operation,
    working_from_crs: Operation,
    crs_from_pixel: GeoTransform,
}

impl RasterOnGrid {
    /// Replaces positions in working metres by pixel positions; NaN where there is none.
    ///
    /// # Errors
    /// When PROJ knows no transformation between the two systems.
    pub fn pixels_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), DemError> {
        self.crs_from_working.apply(points)?;
        for point in points {
            *point = self.crs_from_pixel.pixel_from_crs(*point).unwrap_or([f64::NAN; 2]);
        }
        Ok(())
    }

    /// Replaces pixel positions by positions in working metres; NaN where there is none.
    ///
    /// # Errors
    /// As [`RasterOnGrid::pixels_from_working`].
    pub fn working_from_pixels(&self, points: &mut [[f64; 2]]) -> Result<(), DemError> {
        for point in points.iter_mut() {
            *point = self.crs_from_pixel.crs_from_pixel(*point);
        }
        self.working_from_crs.apply(points)
    }
}
