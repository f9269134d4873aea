//! Elevation files that are described but not held open.

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
/// The US survey foot, and that of Clarke, differ from it by less.
const SAME_FOOT: f64 = 1e-3;

/// Elevation files, described but not held open: may be shared between threads.
#[derive(Debug, Clone)]
pub struct Dem {
    pub(crate) sources: Vec<Source>,
    /// Never empty.
    pub(crate) mosaics: Vec<Mosaic>,
    pub(crate) wgs84_bounds: Bounds,
    pub(crate) center_deg: [f64; 2],
    pub(crate) heights: HeightReference,
}

impl Dem {
    /// Looks into all files; reads no heights yet.
    ///
    /// Files on one grid are read as one raster, so that interpolation crosses their seams; where
    /// they overlap the first named wins, sample by sample, and a void in it falls through to the
    /// next. Files on other grids serve the nodes at which the grids named before have no data.
    ///
    /// Heights are those of the only band, or of [`OpenOptions::band`]; a mask, an alpha band or a
    /// nodata value says where there are none. With [`OpenOptions::vertical_crs`] each sample's
    /// height is carried there at the sample's own position; without, all files must agree on what
    /// their heights are measured from.
    ///
    /// # Errors
    /// When a file cannot be opened, holds no heights, lacks georeference or CRS, or lies nowhere
    /// on earth; when a single row or column of samples encloses no ground; when heights cannot be
    /// carried to the vertical CRS asked for without guessing, or files disagree on it and none is
    /// asked for.
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
        // Files all around the earth have no middle; any will do.
        let center_deg = center_deg(&points_deg).unwrap_or([0.0; 2]);
        let heights = vertical_target::resolve(&mut sources, options, wgs84_bounds, center_deg)
            .map_err(Box::new)?;
        Ok(Self { sources, mosaics, wgs84_bounds, center_deg, heights })
    }

    /// What a user should know where coordinates are in feet and nothing says what heights are in.
    #[must_use]
    pub fn unit_warning(&self) -> Option<String> {
        let is_foot = |unit_m: f64| (unit_m / FOOT_M - 1.0).abs() < SAME_FOOT;
        let is_in_question =
            |source: &&Source| !source.has_height_unit && is_foot(source.crs.unit_m);
        let found: Vec<&Source> = self.sources.iter().filter(is_in_question).collect();
        let names = found.iter().map(|source| source.path.display().to_string());
        (!found.is_empty()).then(|| {
            format!(
                "{}: coordinates are in feet, and neither a band's unit nor a vertical CRS says what heights are in; they are taken as metres. If \
                 they are feet, say so with --dem-vertical-crs, such as EPSG:6360 (NAVD88 in US survey feet) or EPSG:8228 (NAVD88 in feet)",
                first_names(names)
            )
        })
    }

    /// How each file is cut into blocks; of a virtual raster (VRT) also the files that it refers
    /// to.
    ///
    /// # Errors
    /// When a file cannot be opened any more.
    pub fn file_blocks(&self) -> Result<Vec<FileBlocks>, RasterError> {
        let blocks = |source: &Source| FileBlocks::of_file(&source.path, source.band, FileUse::Dem);
        Ok(self.sources.iter().map(blocks).collect::<Result<Vec<_>, _>>()?.concat())
    }
}
