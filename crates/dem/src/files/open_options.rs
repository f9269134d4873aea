//! Options that say how to understand an elevation file where it does not say so itself.

/// How an elevation file is to be understood where it does not say so itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenOptions {
    /// Band with the heights, from 1 on, of the files that have several. `None` refuses those.
    pub band: Option<u32>,
    /// CRS, "EPSG:n" or WKT, of the files that name none. A file that names one keeps it.
    pub dem_crs: Option<String>,
    /// The unit of heights, whatever bands and vertical CRSs say of it; `None` takes theirs, and refuses a band's that is not known.
    pub vertical_unit: Option<String>,
    /// Stored values that mean "no height", besides the one that the file declares.
    pub nodata: Vec<f64>,
    /// Vertical CRS, "EPSG:n" or WKT, of the files that name none; with its unit and direction. A file that names
    /// one keeps it.
    pub dem_vertical_crs: Option<String>,
    /// The vertical CRS that heights are wanted in, "EPSG:n" or WKT; `None` leaves them as they are.
    ///
    /// PROJ takes the best operation for which it has the grids; approximations without any are not allowed. Where
    /// the grid of the best is not installed but that of a lesser one is, an older model of the geoid say, PROJ takes
    /// the lesser one and does not tell. It is not asked for the best alone, which GDAL can do since 3.8 only (PROJ
    /// since 9.2 has an environment variable for it, `PROJ_ONLY_BEST_DEFAULT`). Instead [`crate::GridPlan::vertical`]
    /// records the offset found at the centre, to the millimetre: runs with grids that differ there read differently.
    pub vertical_crs: Option<String>,
    /// Added to every height, after all else, metres.
    pub vertical_shift_m: f64,
}
