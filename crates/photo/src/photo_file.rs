//! A photo file and its place on the grid of a package, and all photos of a build.

use std::path::Path;

use corniche_dem::GridPlan;
use corniche_geom::Bounds;
use corniche_gis::{FileUse, PlacedRaster, RasterOnGrid, stored_text};

use crate::bands::Bands;
use crate::{PhotoError, TexelGrid};

/// A photo file, described but not held open.
#[derive(Debug, Clone)]
pub(crate) struct PhotoFile {
    pub(crate) raster: PlacedRaster,
    pub(crate) bands: Bands,
    /// The copyright in its metadata, such as GeoTIFF's tag Copyright.
    pub(crate) credit: Option<String>,
}

/// A photo on a package's grid.
#[derive(Debug, Clone)]
pub(crate) struct PlacedPhoto {
    pub(crate) file: PhotoFile,
    pub(crate) on_grid: RasterOnGrid,
    /// Rectangle around its border, working metres.
    pub(crate) bounds: Bounds,
    /// The side of a pixel in the middle, working metres: of a square of the same area.
    pub(crate) pixel_m: f64,
}

/// Points along each side of a photo from which its rectangle is computed.
const SIDE_POINTS: usize = 33;

impl PhotoFile {
    pub(crate) fn open(path: &Path) -> Result<Self, PhotoError> {
        let (raster, dataset) = PlacedRaster::open(path, FileUse::Photo)?;
        if dataset.raster_count() == 0 {
            return Err(PhotoError::NoBand { path: path.to_path_buf() });
        }
        let bands = Bands::from_dataset(path, &dataset)?;
        let credit = stored_text(&dataset, "TIFFTAG_COPYRIGHT");
        let credit = credit.map(|text| text.trim().to_owned()).filter(|text| !text.is_empty());
        Ok(Self { raster, bands, credit })
    }

    pub(crate) fn on(&self, grid: &GridPlan) -> Result<PlacedPhoto, PhotoError> {
        let on_grid = self.raster.on(&grid.working, grid.area_deg());
        let nowhere = || PhotoError::Nowhere { path: self.raster.path().to_path_buf() };
        let [columns, rows] = self.raster.size().map(|pixels| pixels as f64);
        let shares = (0..SIDE_POINTS).map(|k| k as f64 / (SIDE_POINTS - 1) as f64);
        let mut border: Vec<[f64; 2]> = shares
            .flat_map(|t| [[t, 0.0], [t, 1.0], [0.0, t], [1.0, t]])
            .map(|[c, r]| [c * columns, r * rows])
            .collect();
        on_grid.working_from_pixels(&mut border)?;
        let bounds = Bounds::around(&border);
        if bounds.is_empty() {
            return Err(nowhere());
        }
        let (c, r) = (columns / 2.0, rows / 2.0);
        let mut corners = [[c, r], [c + 1.0, r], [c, r + 1.0]];
        on_grid.working_from_pixels(&mut corners)?;
        let [from, east, south] = corners;
        let side = |to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
        let (a, b) = (side(east), side(south));
        let pixel_m = (a[0] * b[1] - a[1] * b[0]).abs().sqrt();
        if !(pixel_m.is_finite() && pixel_m > 0.0) {
            return Err(nowhere());
        }
        Ok(PlacedPhoto { file: self.clone(), on_grid, bounds, pixel_m })
    }
}

/// Photos on a package's grid. Threads can share it.
#[derive(Debug, Clone)]
pub struct PhotoGrid {
    pub(crate) photos: Vec<PlacedPhoto>,
    pub(crate) texels: TexelGrid,
}

impl PhotoGrid {
    /// The texels of the finest level.
    #[must_use]
    pub fn texels(&self) -> &TexelGrid {
        &self.texels
    }

    /// Whether a photo may overlap a rectangle, working metres.
    #[must_use]
    pub fn touches(&self, bounds: &Bounds) -> bool {
        self.photos.iter().any(|photo| overlap(&photo.bounds, bounds))
    }

    /// Area of the rectangles around the photos, square metres of the grid; overlaps count twice.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.photos.iter().map(|photo| photo.bounds.width() * photo.bounds.height()).sum()
    }
}

pub(crate) fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min_x < b.max_x && b.min_x < a.max_x && a.min_y < b.max_y && b.min_y < a.max_y
}
