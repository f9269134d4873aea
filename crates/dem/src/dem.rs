use std::path::PathBuf;
use std::sync::Once;

use corniche_geom::Bounds;

use crate::crs::Crs;
use crate::heights::{self, Heights};
use crate::mosaic::{self, Mosaic};
use crate::operation::Operation;
use crate::projection::DemProjection;
use crate::reader::Reader;
use crate::source::{OpenOptions, Source};
use crate::{DemError, GridPlan, PlanOptions, library, outline, plan, scale};

/// Elevation files, described but not held open: may be shared between threads.
#[derive(Debug, Clone)]
pub struct Dem {
    pub(crate) sources: Vec<Source>,
    /// Never empty.
    pub(crate) mosaics: Vec<Mosaic>,
    pub(crate) wgs84_bounds: Bounds,
    pub(crate) center_deg: [f64; 2],
    pub(crate) heights: Heights,
}

impl Dem {
    /// Looks into all files; reads no heights yet.
    ///
    /// Files on one grid are read as one raster, so that interpolation crosses their seams; where they overlap
    /// the first named wins, sample by sample, and a void in it falls through to the next. Files on other grids
    /// serve the nodes at which the grids named before have no data.
    ///
    /// Heights are those of the first band; a mask, an alpha band or a nodata value says where there are none.
    /// With [`OpenOptions::vertical_crs`] each sample's height is carried there at the sample's own position;
    /// without, all files must agree on what their heights are measured from.
    ///
    /// # Errors
    /// When a file cannot be opened, holds no heights, lacks georeference or CRS, or lies nowhere on earth; when a
    /// single row or column of samples encloses no ground; when heights cannot be carried to the vertical CRS asked
    /// for without guessing, or files disagree on it and none is asked for.
    pub fn open(files: &[PathBuf], options: &OpenOptions) -> Result<Self, DemError> {
        quiet();
        if files.is_empty() {
            return Err(DemError::NoFiles);
        }
        let mut sources: Vec<Source> =
            files.iter().map(|path| Source::open(path, options)).collect::<Result<_, _>>()?;
        let mosaics = mosaic::group(&sources);
        mosaic::refuse_lines(&sources, &mosaics)?;
        let wgs84 = Crs::wgs84()?;
        let to_wgs84: Vec<Operation> =
            mosaics.iter().map(|mosaic| Operation::new(&mosaic.crs, &wgs84, None)).collect();
        let (points_deg, wgs84_bounds) = outline::wgs84(&sources, &mosaics, &to_wgs84)?;
        // Files all around the earth have no middle; any will do.
        let center_deg = scale::center_deg(&points_deg).unwrap_or([0.0; 2]);
        let heights = heights::resolve(&mut sources, options, wgs84_bounds, center_deg)?;
        Ok(Self { sources, mosaics, wgs84_bounds, center_deg, heights })
    }

    /// Chooses working CRS, cell and extent.
    ///
    /// - Working CRS: `options.crs`; else the first file's own, if lengths in working metres are then true within 3 % all
    ///   over the data; else the UTM zone of the centre, if it is true to scale within 1 % all over the data and the data
    ///   lies between 80° S and 84° N; else Lambert's azimuthal equal-area about the centre.
    /// - Working metres are its coordinates times two factors. In degrees: metres per degree at the standard latitude, by
    ///   the radii of curvature of the ellipsoid. In a projection: its unit, where that is true to scale within 1 % along
    ///   both axes and all over the data; else the unit divided by the scale along each axis, at the standard latitude and
    ///   the middle longitude. Axes that count westwards or southwards are turned. The standard latitude is the middle of
    ///   the data to half a degree, or `options.scale_latitude_deg`; one that is given decides, at the middle longitude
    ///   alone, whether a projection keeps its unit.
    /// - Cell: `options.cell`; else the spacing of the first file's samples, a rectangle; where that file is in another CRS
    ///   or turned against it, a square with the shorter spacing as side (two significant digits in another CRS).
    /// - Where the cell is the spacing of the first file's samples, or a multiple by `options.cell_every`, nodes coincide
    ///   with samples; otherwise node (0, 0) is the CRS's zero. Files on other grids are resampled.
    ///
    /// # Errors
    /// When the options are not usable, the files lie outside the CRS, or the grid is too large.
    pub fn plan(&self, options: &PlanOptions) -> Result<GridPlan, DemError> {
        plan::plan(self, options)
    }

    /// A reader of windows, for one thread at a time. It opens files as it needs them.
    ///
    /// # Errors
    /// None at present; files that have gone are found out by reading.
    pub fn reader<'a>(&'a self, plan: &'a GridPlan) -> Result<Reader<'a>, DemError> {
        Ok(Reader::new(self, plan))
    }

    /// WGS84 ⇄ the plan's working CRS. May be sent to and shared between threads.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, plan: &GridPlan) -> Result<DemProjection, DemError> {
        DemProjection::new(&plan.working, plan.wgs84_bounds)
    }
}

/// Keeps GDAL and PROJ from writing to standard error: what they say comes back in errors.
pub(crate) fn quiet() {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| gdal::config::set_error_handler(|_, _, words| library::hear(words)));
}

/// Limits the memory in which GDAL keeps blocks of rasters, for all threads together; without it GDAL takes up to
/// 5 % of the machine's. To be called before the first [`Dem::open`].
///
/// # Errors
/// When GDAL refuses.
pub fn limit_block_cache(bytes: u64) -> Result<(), gdal::errors::GdalError> {
    // GDAL reads small numbers as megabytes; a megabyte is the least that is sensible anyway.
    gdal::config::set_config_option("GDAL_CACHEMAX", &bytes.max(1 << 20).to_string())
}
