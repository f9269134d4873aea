use corniche_dem::{Dem, GridPlan};
use corniche_geom::CoordinateTable;

use super::coordinates::coordinates;
use crate::{
    BuildError, PlanSettings, TerrainSettings,
    inputs::Inputs,
    levels::{Levels, most_scale},
};

/// Tolerances that the finest level can have. Outside this range a package cannot hold the root's tolerance or the height
/// quantum.
const MAX_ERRORS_M: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// The inputs, opened, and what follows from them and from the settings before a height is read.
pub(crate) struct Opened {
    pub(crate) inputs: Inputs,
    pub(crate) dem: Dem,
    pub(crate) grid: GridPlan,
    pub(crate) levels: Levels,
    /// Tolerance of the finest level, given or derived from the cell.
    pub(crate) max_error_m: f64,
    /// Longitudes and latitudes over the data.
    pub(crate) coordinates: CoordinateTable,
}

impl Opened {
    /// Opens the elevation files and plans the grid.
    ///
    /// # Errors
    /// When a file cannot be used, the files make no grid, or a setting does not fit them.
    pub(crate) fn new(settings: &PlanSettings) -> Result<Self, BuildError> {
        // The state of the files is noted before anything of them is read.
        let inputs = Inputs::find(&settings.dem, settings.osm.as_deref())?;
        match Self::plan(settings) {
            Ok(planned) => Ok(planned(inputs)),
            // A changed input may be the cause of any other error, so it is reported instead.
            Err(error) => Err(inputs.check_unchanged().err().map_or(error, BuildError::from)),
        }
    }

    /// All but the inputs.
    fn plan(settings: &PlanSettings) -> Result<impl FnOnce(Inputs) -> Self, BuildError> {
        let terrain = &settings.terrain;
        let dem = Dem::open(&settings.dem, &terrain.open)?;
        let grid = dem.plan(&terrain.plan)?;
        if !terrain.allow_fine_cell {
            dem.refuse_oversampling(&grid)?;
        }
        let max_error_m = max_error_m(terrain, &grid)?;
        let widest = most_scale(grid.scale.largest);
        let levels = Levels::new(grid.frame, max_error_m, &settings.roads, widest);
        // This fails for files that are too far apart for one package.
        let coordinates = coordinates(&dem, &grid)?;
        Ok(move |inputs| Self { inputs, dem, grid, levels, max_error_m, coordinates })
    }
}

/// The tolerance of the finest level: given, or derived from the cell.
fn max_error_m(terrain: &TerrainSettings, grid: &GridPlan) -> Result<f64, BuildError> {
    let max_error_m = terrain.max_error_m.unwrap_or(grid.frame.cell().shorter_m() / 4.0);
    if MAX_ERRORS_M.contains(&max_error_m) {
        Ok(max_error_m)
    } else {
        Err(BuildError::MaxError { max_error_m })
    }
}
