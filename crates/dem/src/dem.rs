//! Elevation files, described but not held open.

use std::path::PathBuf;

use corniche_geom::Bounds;
use corniche_gis::{
    Crs, CrsOperation, FileBlocks, FileUse, RasterError, center_deg, first_names, quiet,
};

use crate::OpenDemError;
use crate::files::source::Source;
use crate::files::stored_values::OpenOptions;
use crate::mosaics::data_extent;
use crate::mosaics::mosaic::{self, Mosaic};
use crate::mosaics::vertical_target::{self, HeightReference};

/// The international foot.
const FOOT_M: f64 = 0.3048;
/// The relative tolerance for other feet: the US survey foot, and that of Clarke, differ by less.
const SAME_FOOT: f64 = 1e-3;

/// Elevation files, described but not held open; can be shared between threads.
#[derive(Debug, Clone)]
pub struct Dem {
    pub(crate) sources: Vec<Source>,
    /// The mosaics; never empty.
    pub(crate) mosaics: Vec<Mosaic>,
    pub(crate) wgs84_bounds: Bounds,
    pub(crate) center_deg: [f64; 2],
    pub(crate) heights: HeightReference,
}

impl Dem {
    /// Inspects all files; reads no heights yet.
    ///
    /// Files on one grid are read as one raster, so that interpolation crosses their seams. Where
    /// they overlap, the first named has precedence, sample by sample, and its voids are taken from
    /// the next. Files on other grids are used for nodes where the earlier grids have no data.
    ///
    /// Heights are those of the only band, or of [`OpenOptions::band`]; a mask, an alpha band or a
    /// nodata value marks voids. With [`OpenOptions::vertical_crs`] each sample's height is
    /// converted to this CRS at the sample's own position; without it, all files must have the same
    /// vertical CRS.
    ///
    /// # Errors
    /// When a file cannot be opened, has no heights, lacks a georeference or CRS, or lies nowhere
    /// on earth; when a single row or column of samples encloses no ground; when heights cannot be
    /// converted to the requested vertical CRS without guessing, or files disagree on the vertical
    /// CRS and none is requested.
    pub fn open(files: &[PathBuf], options: &OpenOptions) -> Result<Self, OpenDemError> {
        quiet();
        if files.is_empty() {
            return Err(OpenDemError::NoFiles);
        }
        let mut sources: Vec<Source> =
            files.iter().map(|path| Source::open(path, options)).collect::<Result<_, _>>()?;
        let mosaics = mosaic::group(&sources);
        mosaic::refuse_lines(&sources, &mosaics)?;
        let wgs84 = Crs::wgs84()?;
        let to_wgs84: Vec<CrsOperation> =
            mosaics.iter().map(|mosaic| CrsOperation::new(&mosaic.crs, &wgs84, None)).collect();
        let (points_deg, wgs84_bounds) = data_extent::wgs84(&sources, &mosaics, &to_wgs84)?;
        // Files all around the earth have no middle; any position is suitable.
        let center_deg = center_deg(&points_deg).unwrap_or([0.0; 2]);
        let heights = vertical_target::resolve(&mut sources, options, wgs84_bounds, center_deg)
            .map_err(Box::new)?;
        Ok(Self { sources, mosaics, wgs84_bounds, center_deg, heights })
    }

    /// A warning if coordinates are in feet and nothing gives the unit of heights.
    #[must_use]
    pub fn unit_warning(&self) -> Option<String> {
        let is_foot = |unit_m: f64| (unit_m / FOOT_M - 1.0).abs() < SAME_FOOT;
        let is_in_question =
            |source: &&Source| !source.has_height_unit && is_foot(source.crs.unit_m);
        let found: Vec<&Source> = self.sources.iter().filter(is_in_question).collect();
        let names = found.iter().map(|source| format!("{:?}", source.path));
        (!found.is_empty()).then(|| {
            format!(
                "{}: coordinates are in feet, and neither the unit of a band nor a vertical CRS gives the unit of heights; heights are read as metres. If \
                 they are in feet, pass --dem-vertical-crs, such as EPSG:6360 (NAVD88 in US survey feet) or EPSG:8228 (NAVD88 in feet)",
                first_names(names)
            )
        })
    }

    /// The blocks of each file; for a virtual raster (VRT) also those of the files that it refers
    /// to.
    ///
    /// # Errors
    /// When a file can no longer be opened.
    pub fn file_blocks(&self) -> Result<Vec<FileBlocks>, RasterError> {
        let blocks = |source: &Source| FileBlocks::of_file(&source.path, source.band, FileUse::Dem);
        Ok(self.sources.iter().map(blocks).collect::<Result<Vec<_>, _>>()?.concat())
    }
}
