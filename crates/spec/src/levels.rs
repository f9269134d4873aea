//! Tolerances, margins and shown road classes of each level.

use corniche_geom::GridFrame;
use corniche_roads::{ClassFilter, FunctionalRoadClass};
use corniche_tileset::Manifest;

use crate::{RoadSettings, settings_record};

/// The number of cells of a level up to which the half width of a road can be drawn from the
/// level's SV lines (roads drawn by shadow volumes). At a screen-space error of two pixels a cell
/// of the level is about sixteen pixels wide, so this is more than a hundred pixels.
const MARGIN_CELLS: f64 = 8.0;
/// The smallest margin, in true metres: half the width of the widest road, which matters on fine
/// levels.
const MIN_MARGIN_M: f64 = 40.0;

/// Tolerances and margins of all levels.
#[derive(Debug, Clone)]
pub struct Levels {
    frame: GridFrame,
    max_error_m: f64,
    quantum_m: f64,
    /// Least important class that the FRC (functional road class) table includes.
    least_class: FunctionalRoadClass,
    filter: ClassFilter,
    simplify_cells: f64,
    /// The largest number of working metres per true metre, along an axis, over the data.
    most_scale: f64,
}

impl Levels {
    /// Computes the values of all levels. `most_scale` is the largest number of working metres
    /// per true metre over the data.
    #[must_use]
    pub fn new(frame: GridFrame, max_error_m: f64, roads: &RoadSettings, most_scale: f64) -> Self {
        Self {
            most_scale,
            frame,
            max_error_m,
            quantum_m: corniche_tin::height_quantum_m(max_error_m),
            least_class: roads.table.least_class(),
            filter: roads.filter.clone(),
            simplify_cells: roads.simplify_cells,
        }
    }

    /// Returns the levels that a package records; `None` if its record is invalid.
    #[must_use]
    pub fn recorded(manifest: &Manifest) -> Option<Self> {
        let settings = &manifest.settings;
        Some(Self {
            frame: manifest.frame,
            max_error_m: settings.max_error_m,
            quantum_m: corniche_tin::height_quantum_m(settings.max_error_m),
            // The finest level shows every class that the table includes.
            least_class: FunctionalRoadClass::new(manifest.levels.last()?.least_class?)?,
            filter: settings_record::filter(settings)?,
            simplify_cells: settings.simplify_cells,
            most_scale: most_scale(manifest.scale.largest),
        })
    }

    /// The package's grid.
    #[must_use]
    pub fn frame(&self) -> &GridFrame {
        &self.frame
    }

    /// The height step, metres.
    #[must_use]
    pub fn quantum_m(&self) -> f64 {
        self.quantum_m
    }

    /// All levels, root first.
    #[must_use]
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = u8> + use<> {
        0..=self.frame.max_level()
    }

    /// Meshing tolerance against the level's own raster.
    #[must_use]
    pub fn max_error_m(&self, level: u8) -> f64 {
        self.max_error_m * self.frame.stride(level) as f64
    }

    /// Whether roads of `class` are shown on `level`. The finest level shows every class that was
    /// read.
    #[must_use]
    pub fn shows(&self, level: u8, class: FunctionalRoadClass) -> bool {
        self.least_class(level).is_some_and(|least| class <= least)
    }

    /// The least important class shown on `level`.
    #[must_use]
    pub fn least_class(&self, level: u8) -> Option<FunctionalRoadClass> {
        if level == self.frame.max_level() {
            Some(self.least_class)
        } else {
            self.filter
                .least_class(self.frame.level_cell(level).shorter_m())
                .map(|class| class.min(self.least_class))
        }
    }

    /// Simplification tolerance. On the finest level it is 0: every point of the source is kept.
    #[must_use]
    pub fn simplify_tolerance_m(&self, level: u8) -> f64 {
        if level == self.frame.max_level() {
            0.0
        } else {
            self.simplify_cells * self.frame.level_cell(level).shorter_m()
        }
    }

    /// Simplification tolerance in lattice steps.
    #[must_use]
    pub fn simplify_tolerance_steps(&self, level: u8) -> f64 {
        self.simplify_tolerance_m(level) / self.frame.lattice_step_m()
    }

    /// The largest number of lattice steps along an axis for a length in true metres, over the
    /// data.
    #[must_use]
    pub fn steps_of_true(&self, true_m: f64) -> f64 {
        true_m * self.most_scale / self.frame.lattice_step_m()
    }

    /// The distance that SV lines reach beyond a tile: whole cells of the finest level, by their
    /// shorter side.
    fn margin_cells(&self, level: u8) -> i64 {
        let wanted_m = (MARGIN_CELLS * self.frame.level_cell(level).shorter_m())
            .max(MIN_MARGIN_M * self.most_scale);
        (wanted_m / self.frame.cell().shorter_m()).ceil() as i64
    }

    /// The distance that SV lines reach beyond a tile, in metres.
    #[must_use]
    pub fn margin_m(&self, level: u8) -> f64 {
        self.margin_cells(level) as f64 * self.frame.cell().shorter_m()
    }

    /// The distance that SV lines reach beyond a tile, in lattice steps.
    #[must_use]
    pub fn margin_steps(&self, level: u8) -> i64 {
        let [east, north] = self.frame.node_steps(self.frame.max_level());
        self.margin_cells(level) * east.min(north)
    }
}

/// The larger of the largest scales along both axes.
#[must_use]
pub fn most_scale(largest: [f64; 2]) -> f64 {
    largest[0].max(largest[1])
}
