//! The settings of a build: inputs, outputs and everything that decides what is made.

use std::path::PathBuf;

use corniche_areas::{AreaTable, ClassedLayer};
use corniche_dem::{OpenOptions, PlanOptions};
use corniche_geom::Cell;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_store::Existing;
use corniche_tileset::ReliefLevels;

/// Sets one setting to its default, where that is not the default of its type.
macro_rules! set_usual {
    ($settings:ident $name:ident $key:ident $path:tt []) => {};
    ($settings:ident $name:ident $key:ident [$($path:tt)+] [$usual:expr]) => {
        $settings.$($path)+ = $usual;
    };
}

/// What to build, from what, and how: checked, ready to run.
#[derive(Debug, Clone)]
pub struct BuildSettings {
    /// What is made.
    pub plan: PlanSettings,
    /// The package to write.
    pub output: PathBuf,
    /// What to do when the package exists.
    pub existing: Existing,
    /// The folder for intermediate results; `None`: that of the package.
    pub tmp: Option<PathBuf>,
    /// What to do with intermediate results of an earlier build of the same package.
    pub leftovers: Leftovers,
    /// Whether to begin although memory or disk space are not expected to suffice.
    pub force: bool,
    /// What the run may use.
    pub resources: Resources,
}

/// The part of the settings that decides what is made: the same for every worker that takes part in a build.
#[derive(Debug, Clone)]
pub struct PlanSettings {
    /// Elevation rasters; where they overlap, the first has precedence.
    pub dem: Vec<PathBuf>,
    /// A package whose terrain is taken as it is; then `dem` is empty, and `terrain` what the package records.
    pub terrain_of: Option<PathBuf>,
    /// OpenStreetMap extracts, read as one; in the order of [`extract_names`](crate::inputs::extract_names), so that nothing depends on the order in
    /// which they were named. Without any, terrain alone is planned.
    pub osm: Vec<PathBuf>,
    /// How the ground is made.
    pub terrain: TerrainSettings,
    /// How roads are made.
    pub roads: RoadSettings,
    /// Which objects of the extracts are areas, if any are wanted.
    pub areas: Option<AreaTable>,
    /// The layers of lines of the extracts that are wanted, in their order.
    pub lines: Vec<ClassedLayer>,
    /// Photos of the ground.
    pub photo: PhotoChoice,
    /// Credits beside those that the inputs call for, such as a DEM's.
    pub attribution: Vec<String>,
    /// Program and version.
    pub generator: String,
}

impl PlanSettings {
    /// The files that the terrain comes from: rasters, or a package.
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
    /// The package has the photos of the package whose terrain is taken, as they are there; none if it has none, or if no package gives the terrain.
    OfTerrain,
    /// The package has the photos of files.
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

/// How photos are read from files and coded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhotoSettings {
    /// The files; where they overlap, the first lies on top.
    pub files: Vec<PathBuf>,
    /// How many levels of texels are finer than the finest cell; `None`: as many as the photos have detail for, at most three.
    pub levels: Option<u8>,
    /// JPEG's quality, from 1 to 100.
    pub quality: u8,
}

/// What to do with intermediate results that an earlier build of the same package left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leftovers {
    /// Name them and refuse to build.
    Refuse,
    /// Go on from them.
    Resume,
    /// Remove them and begin from nothing.
    Discard,
}

/// How the ground is made. The default asks for nothing, and fills no voids.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TerrainSettings {
    /// How the elevation files are understood.
    pub open: OpenOptions,
    /// The grid of nodes, and how voids in it are filled.
    pub plan: PlanOptions,
    /// Lowest and highest height that samples may have, metres, as the files give them. `None` allows what the earth's
    /// surface has, and no repeated value far beyond all others.
    pub height_range_m: Option<[f64; 2]>,
    /// Whether a cell may be far smaller than the spacing of samples. It changes no byte of a package: it only lets a build begin.
    pub allow_fine_cell: bool,
    /// Whether one datum may be taken for another where PROJ knows nothing between them. It changes no byte of a package: it only lets a
    /// build begin.
    pub allow_ballpark: bool,
    /// Largest vertical error of the finest level; `None` takes a sixteenth of the cell, but where cells are small not less than 0.25 m.
    pub max_error_m: Option<f64>,
    /// Which levels store their rasters for shading.
    pub relief: ReliefLevels,
}

/// The largest vertical error of the finest level where none is asked for, metres: a sixteenth of the cell's shorter side. Elevation data of
/// small cells are themselves wrong by decimetres, so there it is 0.25 m, or a quarter of the cell where that is less.
#[must_use]
pub fn usual_max_error_m(cell: Cell) -> f64 {
    let cell_m = cell.shorter_m();
    (cell_m / 16.0).max((cell_m / 4.0).min(0.25))
}

/// How roads are made.
#[derive(Debug, Clone)]
pub struct RoadSettings {
    /// `highway` value → class.
    pub table: FrcTable,
    /// On which levels each class is shown.
    pub filter: ClassFilter,
    /// Simplification tolerance, in cells of the level; 0 keeps every point. The finest level always does.
    pub simplify_cells: f64,
    /// Whether bridges and tunnels leave the ground: tiles then tell how high they are.
    pub spans: bool,
}

impl RoadSettings {
    /// The usual settings for roads with these classes.
    #[must_use]
    pub fn of(table: FrcTable) -> Self {
        let filter = ClassFilter::usual();
        let mut usual = Self { table, filter, simplify_cells: 0.0, spans: false };
        corniche_settings::placed! { Roads [set_usual] usual }
        usual
    }
}

impl TerrainSettings {
    /// The settings of whoever gives no option.
    #[must_use]
    pub fn usual() -> Self {
        let mut usual = Self::default();
        corniche_settings::placed! { Terrain [set_usual] usual }
        usual
    }
}

/// What a run may use. It changes no byte of a package.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resources {
    /// Worker threads, at least 1.
    pub threads: usize,
    /// The most memory that the process may use, bytes.
    pub memory_bytes: u64,
}
