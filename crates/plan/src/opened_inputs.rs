//! Opens the inputs of a build, and derives everything that is known before any height is read.

use std::path::Path;

use corniche_dem::{Dem, GridPlan};
use corniche_geom::CoordinateTable;
use corniche_gis::{DemProjection, FileDatums, RegionPolygons};
use corniche_ground::terrain::{ground::GroundSource, recorded::RecordedTerrain};
use corniche_ground::{TerrainError, photos::source::PhotoSource};
use corniche_spec::{
    PlanSettings, TerrainSettings,
    inputs::{InputFiles, OtherInputs, PlannedInput},
    levels::{Levels, most_scale},
    settings_record, usual_max_error_m,
};
use corniche_tileset::{InputKind, ReliefLevels};

use super::{coordinates::coordinates, facts::terrain_differences};
use crate::PlanError;

/// Tolerances that the finest level can have. Outside this range a package cannot hold the root's
/// tolerance or the height quantum.
const MAX_ERRORS_M: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// The open inputs, with the values that follow from them and from the settings before a height is
/// read.
pub struct Opened {
    /// All input files, in the state in which they were found.
    pub inputs: InputFiles,
    /// The source of the ground.
    pub source: GroundSource,
    /// The grid of nodes.
    pub grid: GridPlan,
    /// Tolerances and margins of levels.
    pub levels: Levels,
    /// Tolerance of the finest level, given or derived from the cell.
    pub max_error_m: f64,
    /// Longitudes and latitudes over the data.
    pub coordinates: CoordinateTable,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: DemProjection,
    /// Photos of the ground.
    pub photo: PhotoSource,
    /// Which levels have relief sections.
    pub relief: ReliefLevels,
    /// How polygons and photos are transformed to the datum of the grid.
    pub file_datums: FileDatums,
}

impl Opened {
    /// Opens the elevation files and plans the grid.
    ///
    /// # Errors
    /// When a file cannot be used, the files do not form a grid, or a setting does not match them.
    pub fn new(settings: &PlanSettings) -> Result<Self, PlanError> {
        // The state of the files is recorded before any of them is read.
        let polygon = settings.terrain.plan.polygon.as_ref().map(RegionPolygons::path);
        let others = OtherInputs { photo: settings.photo.files(), polygon, osm: &settings.osm };
        let mut inputs = match &settings.terrain_of {
            Some(package) => InputFiles::find_with_package(package, others)?,
            None => InputFiles::find(&settings.dem, others)?,
        };
        let planned = match &settings.terrain_of {
            Some(package) => Self::recorded(settings, package),
            None => Self::plan(settings),
        };
        let checked = planned.and_then(|planned| {
            let projection = planned.source.projection(&planned.grid)?;
            let mut file_datums = FileDatums::default();
            if let Some(polygon) = &settings.terrain.plan.polygon {
                let found = planned.grid.datums_of_polygon(polygon);
                file_datums.extend(found.allowed(settings.terrain.allow_ballpark)?);
            }
            Ok((planned, projection, file_datums))
        });
        // A changed input may be the cause of any other error, so it is reported instead.
        let checked = checked.map_err(|error| inputs.changed_instead_of(error));
        let (Planned { source, grid, max_error_m, coordinates }, projection, mut file_datums) =
            checked?;
        if let GroundSource::Dem(dem) = &source {
            inputs.use_only(&dem.needed_files(&grid)?);
        }
        let allow_ballpark = settings.terrain.allow_ballpark;
        let photo = PhotoSource::open(&settings.photo, allow_ballpark, &source, &grid)
            .map_err(|error| inputs.changed_instead_of(PlanError::from(error)))?;
        if let Some(photos) = photo.files() {
            file_datums.extend(photos.datums.clone());
        }
        let widest = most_scale(grid.scale.largest);
        Ok(Self {
            inputs,
            levels: Levels::new(grid.frame, max_error_m, &settings.roads, widest),
            source,
            grid,
            max_error_m,
            coordinates,
            projection,
            photo,
            relief: settings.terrain.relief,
            file_datums,
        })
    }

    /// Size of the extract; 0 without one.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn extract_bytes(&self) -> Result<u64, PlanError> {
        let planned = self.inputs.planned()?;
        let is_extract = |input: &&PlannedInput| input.kind == InputKind::Osm.name();
        Ok(planned.iter().filter(is_extract).map(|input| input.bytes).sum())
    }

    /// The tolerance of the finest level as a fraction of the cell's shorter side.
    #[must_use]
    pub fn tolerance_cells(&self) -> f64 {
        self.max_error_m / self.grid.frame.cell().shorter_m()
    }

    /// Derives the values from elevation files.
    fn plan(settings: &PlanSettings) -> Result<Planned, PlanError> {
        let terrain = &settings.terrain;
        let dem = Dem::open(&settings.dem, &terrain.open)?;
        let grid = dem.plan(&terrain.plan)?;
        if !terrain.allow_ballpark {
            dem.refuse_ballpark(&grid)?;
        }
        if !terrain.allow_fine_cell {
            dem.refuse_oversampling(&grid)?;
        }
        let max_error_m = max_error_m(terrain, &grid)?;
        // This fails for files that are too far apart for one package.
        let coordinates = coordinates(&dem, &grid)?;
        Ok(Planned { source: GroundSource::Dem(Box::new(dem)), grid, max_error_m, coordinates })
    }

    /// Derives the values from a package whose terrain is reused.
    fn recorded(settings: &PlanSettings, package: &Path) -> Result<Planned, PlanError> {
        let terrain = RecordedTerrain::open(package, &settings.generator)?;
        let manifest = terrain.manifest();
        let max_error_m = settings.terrain.max_error_m.unwrap_or(manifest.settings.max_error_m);
        let ours = settings_record::record_settings(settings, max_error_m, None);
        let differences = terrain_differences(&ours, &manifest.settings);
        if !differences.is_empty() {
            let differences = differences.join("; ");
            return Err(TerrainError::Other { path: package.to_path_buf(), differences }.into());
        }
        let quantum_m = corniche_tin::height_quantum_m(max_error_m);
        if quantum_m.to_bits() != manifest.vertical.quantum_m.to_bits() {
            return Err(terrain.damaged("its height step does not match its settings").into());
        }
        let coordinates = manifest.coordinates.clone();
        let mut grid = terrain.grid();
        if let Some(polygon) = &settings.terrain.plan.polygon {
            grid = grid.within(polygon)?;
        }
        let source = GroundSource::Package(Box::new(terrain));
        Ok(Planned { source, grid, max_error_m, coordinates })
    }
}

/// The open inputs and the derived values, without the list of files.
struct Planned {
    source: GroundSource,
    grid: GridPlan,
    max_error_m: f64,
    coordinates: CoordinateTable,
}

/// The tolerance of the finest level: given, or derived from the cell.
fn max_error_m(terrain: &TerrainSettings, grid: &GridPlan) -> Result<f64, PlanError> {
    let max_error_m = terrain.max_error_m.unwrap_or_else(|| usual_max_error_m(grid.frame.cell()));
    if MAX_ERRORS_M.contains(&max_error_m) {
        Ok(max_error_m)
    } else {
        Err(PlanError::MaxError { max_error_m })
    }
}
