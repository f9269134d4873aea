//! The settings of a build: inputs, outputs and everything that determines its result.

use std::path::PathBuf;

use corniche_dem::{OpenOptions, PlanOptions};
use corniche_geom::Cell;
use corniche_layers::LayerTable;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_store::Existing;
use corniche_tileset::ReliefLevels;

/// Sets one setting to its default, if that is not the default of its type.
macro_rules! set_usual {
    ($settings:ident $name:ident $key:ident $path:tt []) => {};
    ($settings:ident $name:ident $key:ident [$($path:tt)+] [$usual:expr]) => {
        $settings.$($path)+ = $usual;
    };
}

/// The settings of a build, checked and ready to run.
#[derive(Debug, Clone)]
pub struct BuildSettings {
    /// The settings that determine the result.
    pub plan: PlanSettings,
    /// The package to write.
    pub output: PathBuf,
    /// What to do when the package exists.
    pub existing: Existing,
    /// The folder for intermediate results; `None`: the folder of the package.
    pub tmp: Option<PathBuf>,
    /// What to do with intermediate results of an earlier build of the same package.
    pub leftovers: Leftovers,
    /// Whether to start even if memory or disk space is expected to be insufficient.
    pub force: bool,
    /// The resources that the run may use.
    pub resources: Resources,
}

/// The settings that determine the result: the same for every worker that takes part in a build.
#[derive(Debug, Clone)]
pub struct PlanSettings {
    /// Elevation rasters; where they overlap, the first has precedence.
    pub dem: Vec<PathBuf>,
    /// A package whose terrain is reused; then `dem` is empty, and `terrain` has the settings that
    /// the package records.
    pub terrain_of: Option<PathBuf>,
    /// OpenStreetMap extracts, read as one. They are in the order of
    /// [`extract_names`](crate::inputs::extract_names), so that nothing depends on the order in
    /// which they were named. Without any, only terrain is planned.
    pub osm: Vec<PathBuf>,
    /// How the ground is built.
    pub terrain: TerrainSettings,
    /// How roads are built.
    pub roads: RoadSettings,
    /// The requested layers of the extracts, in the package's order: the lowest first.
    pub layers: Vec<LayerTable>,
    /// Photos of the ground.
    pub photo: PhotoChoice,
    /// Attribution in addition to that of the inputs, such as a DEM's.
    pub attribution: Vec<String>,
    /// Program and version.
    pub generator: String,
}

impl PlanSettings {
    /// The files that provide the terrain: rasters, or a package.
    #[must_use]
    pub fn terrain_files(&self) -> Vec<PathBuf> {
        self.dem.iter().chain(&self.terrain_of).cloned().collect()
    }
}

/// Which photos of the ground a package gets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PhotoChoice {
    /// The package has no photos.
    Off,
    /// The package gets the photos of the package whose terrain is reused, unchanged. It gets none
    /// if that package has none, or if no terrain is reused.
    OfTerrain,
    /// The package gets photos from files.
    Files(PhotoSettings),
}

impl PhotoChoice {
    /// The files to read.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        match self {
            Self::Off | Self::OfTerrain => &[],
            Self::Files(photos) => &photos.files,
        }
    }
}

/// How photos are read from files and encoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhotoSettings {
    /// The files; where they overlap, the first is on top.
    pub files: Vec<PathBuf>,
    /// The number of texel levels finer than the finest cell; `None`: as many as the photos have
    /// detail for, at most three.
    pub levels: Option<u8>,
    /// JPEG's quality, from 1 to 100.
    pub quality: u8,
}

/// What to do with intermediate results of an earlier build of the same package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leftovers {
    /// Name them and stop.
    Refuse,
    /// Continue from them.
    Resume,
    /// Delete them and start over.
    Discard,
}

/// How the ground is built. The default sets no option, and fills no voids.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TerrainSettings {
    /// How the elevation files are interpreted.
    pub open: OpenOptions,
    /// The grid of nodes, and how voids in it are filled.
    pub plan: PlanOptions,
    /// Lowest and highest height that samples may have, metres, in the files' own heights. `None`
    /// allows the heights that the earth's surface has, and no repeated value far beyond all
    /// others.
    pub height_range_m: Option<[f64; 2]>,
    /// Whether a cell may be far smaller than the spacing of samples. This changes no byte of a
    /// package; it only allows the build to start.
    pub allow_fine_cell: bool,
    /// Whether one datum may be treated as another if PROJ knows no transformation between them.
    /// This changes no byte of a package; it only allows the build to start.
    pub allow_ballpark: bool,
    /// Largest vertical error of the finest level; `None` uses a sixteenth of the cell, but not
    /// less than 0.25 m where cells are small.
    pub max_error_m: Option<f64>,
    /// Which levels store their rasters for shading.
    pub relief: ReliefLevels,
}

/// The default for the largest vertical error of the finest level, metres: a sixteenth of the
/// cell's shorter side. Elevation data of small cells are themselves wrong by decimetres, so the
/// default there is 0.25 m, or a quarter of the cell if that is less.
#[must_use]
pub fn usual_max_error_m(cell: Cell) -> f64 {
    let cell_m = cell.shorter_m();
    (cell_m / 16.0).max((cell_m / 4.0).min(0.25))
}

/// How roads are built.
#[derive(Debug, Clone)]
pub struct RoadSettings {
    /// `highway` value → class.
    pub table: FrcTable,
    /// On which levels each class is shown.
    pub filter: ClassFilter,
    /// Simplification tolerance, in cells of the level; 0 keeps every point. The finest level
    /// always keeps every point.
    pub simplify_cells: f64,
    /// Whether bridges and tunnels leave the ground: tiles then store their heights.
    pub spans: bool,
}

impl RoadSettings {
    /// The default settings for roads with these classes.
    #[must_use]
    pub fn from_table(table: FrcTable) -> Self {
        let filter = ClassFilter::usual();
        let mut usual = Self { table, filter, simplify_cells: 0.0, spans: false };
        corniche_settings::placed! { Roads [set_usual] usual }
        usual
    }
}

impl TerrainSettings {
    /// The settings of a run without options.
    #[must_use]
    pub fn usual() -> Self {
        let mut usual = Self::default();
        corniche_settings::placed! { Terrain [set_usual] usual }
        usual
    }
}

/// The resources that a run may use. They change no byte of a package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resources {
    /// Worker threads, at least 1.
    pub threads: usize,
    /// The most memory that the process may use, bytes.
    pub memory_bytes: u64,
}
