//! A raster with its georeference, such as a photo, and the transformation between its pixels and
//! working metres.

use std::path::{Path, PathBuf};

use corniche_geom::{Bounds, GeoTransform, Seam};
use gdal::Dataset;

use crate::crs::horizontal::{Crs, GridCrs};
use crate::crs::operation::CrsOperation;
use crate::files::georeference::Georeference;
use crate::files::open::open_raster;
use crate::{CrsError, FileUse, RasterError, library_error};

/// The georeference of any raster, also of one without heights, such as an image; described but not
/// held open.
#[derive(Debug, Clone)]
pub struct PlacedRaster {
    path: PathBuf,
    size: [usize; 2],
    place: Georeference,
}

impl PlacedRaster {
    /// Opens a raster and reads its georeference: its geotransform, or one that tie points define.
    ///
    /// # Errors
    /// When the file cannot be opened, or lacks a georeference or CRS.
    pub fn open(path: &Path, kind: FileUse) -> Result<(Self, Dataset), RasterError> {
        library_error::quiet();
        let dataset = open_raster(path, kind)?;
        let place = Georeference::from_dataset(path, &dataset, None)?;
        let (columns, rows) = dataset.raster_size();
        Ok((Self { path: path.to_path_buf(), size: [columns, rows], place }, dataset))
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The CRS of the raster.
    #[must_use]
    pub fn crs(&self) -> &Crs {
        &self.place.crs
    }

    /// Relates the raster's pixels to working metres, for data in `area_deg`.
    #[must_use]
    pub fn on(&self, working: &GridCrs, area_deg: Bounds) -> RasterOnGrid {
        let Georeference { crs, crs_from_pixel, .. } = &self.place;
        let [columns, rows] = self.size.map(|pixels| pixels as f64);
        let [middle, _] = crs_from_pixel.crs_from_pixel([columns / 2.0, rows / 2.0]);
        RasterOnGrid {
            crs_from_working: CrsOperation::out_of_working(working, crs, Some(area_deg))
                .around(crs.turn.map(|turn| Seam::new(middle, turn))),
            working_from_crs: CrsOperation::into_working(crs, working, Some(area_deg)),
            crs_from_pixel: *crs_from_pixel,
        }
    }
}

/// The transformation between the pixels of a raster and the working metres of a package, through
/// PROJ. It can be sent to any thread.
///
/// Pixel positions are continuous: 0, 0 is the outer corner of the first pixel, its centre is at
/// 0.5, 0.5.
#[derive(Debug, Clone)]
pub struct RasterOnGrid {
    crs_from_working: CrsOperation,
    working_from_crs: CrsOperation,
    crs_from_pixel: GeoTransform,
}

impl RasterOnGrid {
    /// Replaces positions in working metres by pixel positions; NaN if there is none.
    ///
    /// # Errors
    /// When PROJ knows no transformation between the two systems.
    pub fn pixels_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        self.crs_from_working.apply_to_pixels(&self.crs_from_pixel, points)
    }

    /// Replaces pixel positions by positions in working metres; NaN if there is none.
    ///
    /// # Errors
    /// The errors of [`RasterOnGrid::pixels_from_working`].
    pub fn working_from_pixels(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        for point in points.iter_mut() {
            *point = self.crs_from_pixel.crs_from_pixel(*point);
        }
        self.working_from_crs.apply(points)
    }
}
