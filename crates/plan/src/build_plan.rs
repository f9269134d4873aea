//! Everything that determines the result of a build, as one value that can be stored.

use std::path::PathBuf;

use corniche_geom::{Bounds, Cell, GridFrame, NodeIndex, TileId};
use corniche_gis::RegionPolygons;
use corniche_layers::{LayerForm, LayerTable};
use corniche_roads::{FrcTable, FrcTableError};
use corniche_spec::{
    PhotoChoice, PhotoSettings, PlanSettings, data_tiles::DataTiles, hex::hex,
    inputs::PlannedInput, levels::Levels, manifest_texts, settings_record,
};
use corniche_tileset::{DatumOperationRecord, PhotoRecord, SettingsRecord};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::Opened;
use crate::{
    PlanError,
    error::{PLAN_VERSION, PlanFileError},
};

/// Everything that a worker needs to build its part of a package. A plan does not say how the
/// worker runs: it has neither threads, nor memory, nor the folder of results.
///
/// Two plans with the same [hash](Self::hash) give the same artifacts, so a store is bound to this
/// hash.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BuildPlan {
    /// Version of this record.
    pub(crate) plan_version: u32,
    /// Program and version.
    pub generator: String,
    /// Releases of GDAL and PROJ, on which the last bits of heights depend.
    pub(crate) libraries: String,
    /// The files, in order of precedence.
    pub inputs: Vec<PlannedInput>,
    /// Settings as a package records them; `max_error_m` is given or derived from the cell.
    pub settings: SettingsRecord,
    /// The complete FRC (functional road class) table.
    pub(crate) frc_table: FrcTableRecord,
    /// The complete tables of the layers, the lowest layer first; omitted without layers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) layers: Vec<LayerForm>,
    /// Attribution given by the user, without that of the inputs.
    pub attribution: Vec<String>,
    /// The grid that results from inputs and settings.
    pub grid: PlannedGrid,
    /// The values that result for each level, root first.
    pub levels: Vec<PlannedLevel>,
}

/// An FRC table as it is stored.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrcTableRecord {
    /// Name of the table.
    pub name: String,
    /// Least important class that is on.
    pub least_class: u8,
    /// Each `highway` value, sorted, with its class; `None`: not a road.
    pub(crate) values: Vec<(String, Option<u8>)>,
}

/// The grid of nodes, the working CRS and the treatment of heights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedGrid {
    /// Nodes, tiles and levels.
    pub frame: GridFrame,
    /// South-westernmost node at which there can be data.
    pub south_west: NodeIndex,
    /// North-easternmost node at which there can be data.
    pub north_east: NodeIndex,
    /// Working CRS: "EPSG:…" if it has a code, otherwise its name.
    pub crs: String,
    /// Working CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres per unit of the CRS's coordinates, east and north.
    pub metres_per_unit: [f64; 2],
    /// Working metres per true metre, at the centre.
    pub(crate) point_scale: f64,
    /// Rectangle of the nodes at which there can be data, working metres.
    pub data_bounds: Bounds,
    /// Rectangle around the files, WGS84 degrees.
    pub(crate) wgs84_bounds: Bounds,
    /// Whether nodes are the DEM's samples.
    pub(crate) nodes_are_samples: bool,
    /// How nodes relate to samples, in words.
    pub resampling: String,
    /// The vertical datum to which heights refer.
    pub(crate) vertical_datum: String,
    /// How the files' heights are treated, in words.
    pub vertical_treatment: String,
    /// How positions are transformed from one datum to another.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub datum_operations: Vec<DatumOperationRecord>,
    /// The height step, metres.
    pub quantum_m: f64,
}

/// The values with which the tiles of a level are built.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedLevel {
    /// The level.
    pub level: u8,
    /// Cell of the level, metres.
    pub cell_m: Cell,
    /// Tolerance of the level's TINs against its own raster, metres.
    pub max_error_m: f64,
    /// Least important class that the level shows; `None`: no road.
    pub least_class: Option<u8>,
    /// Tolerance of the simplification of the level's roads, metres; 0 keeps every point.
    pub(crate) simplify_tolerance_m: f64,
    /// Distance that SV lines (of roads drawn by shadow volumes) reach beyond a tile, metres.
    pub(crate) width_margin_m: f64,
}

impl BuildPlan {
    /// Opens the files and plans the grid; no height is read.
    ///
    /// # Errors
    /// When a file cannot be used, the files do not form a grid, or a setting does not match them.
    pub fn make(settings: &PlanSettings) -> Result<Self, PlanError> {
        Self::from_settings(settings, &Opened::new(settings)?)
    }

    /// Creates the plan for inputs that are open.
    ///
    /// # Errors
    /// See [`PlanError`].
    pub fn from_settings(settings: &PlanSettings, opened: &Opened) -> Result<Self, PlanError> {
        let grid = &opened.grid;
        let PlanSettings { roads, layers, attribution, generator, .. } = settings;
        Ok(Self {
            plan_version: PLAN_VERSION,
            generator: generator.clone(),
            libraries: grid.libraries.clone(),
            inputs: opened.inputs.planned()?,
            settings: settings_record::record_settings(
                settings,
                opened.max_error_m,
                opened.photo.record(),
            ),
            frc_table: FrcTableRecord::from_table(&roads.table),
            layers: layers.iter().map(|table| table.form().clone()).collect(),
            attribution: attribution.clone(),
            grid: PlannedGrid {
                frame: grid.frame,
                south_west: grid.south_west,
                north_east: grid.north_east,
                crs: grid.crs.clone(),
                crs_wkt: grid.crs_wkt.clone(),
                metres_per_unit: grid.metres_per_unit,
                point_scale: grid.point_scale,
                data_bounds: grid.data_bounds,
                wgs84_bounds: grid.wgs84_bounds,
                nodes_are_samples: grid.nodes_are_samples(),
                resampling: grid.resampling_text.clone(),
                vertical_datum: manifest_texts::datum(grid).to_owned(),
                vertical_treatment: grid.vertical.clone(),
                datum_operations: manifest_texts::datum_operations(&grid.datum_operations),
                quantum_m: opened.levels.quantum_m(),
            },
            levels: planned_levels(&opened.levels),
        })
    }

    /// The tiles of a level in which there can be data, in package order: the subtrees into which a
    /// build can be split. Empty below the finest level.
    #[must_use]
    pub fn subtrees(&self, level: u8) -> Vec<TileId> {
        let PlannedGrid { frame, south_west, north_east, .. } = &self.grid;
        if level > frame.max_level() {
            return Vec::new();
        }
        DataTiles::between(frame, *south_west, *north_east)
            .above(level)
            .in_order_within(TileId::ROOT)
    }

    /// The settings with which the build can be planned again, with the paths of the plan.
    ///
    /// # Errors
    /// When the plan was edited by hand and is invalid, or its polygon cannot be read.
    pub fn settings(&self) -> Result<PlanSettings, PlanFileError> {
        let paths = |kind: &'static str| {
            let of_kind = self.inputs.iter().filter(move |input| input.kind == kind);
            of_kind.map(|input| PathBuf::from(&input.path))
        };
        let table = self.frc_table.table()?;
        let table = match &self.settings.classes {
            Some(classes) => table.with_classes(classes)?,
            None => table,
        };
        let tells_labels = self.settings.class_labels.is_some();
        let table = if tells_labels { table.with_recorded_labels() } else { table };
        let mut terrain = settings_record::terrain(&self.settings);
        terrain.plan.polygon =
            paths("polygon").next().map(|path| RegionPolygons::read(&path)).transpose()?;
        let photos: Vec<PathBuf> = paths("photo").collect();
        Ok(PlanSettings {
            photo: match self.settings.photo {
                None => PhotoChoice::Off,
                Some(_) if photos.is_empty() => PhotoChoice::OfTerrain,
                Some(PhotoRecord { levels, quality }) => {
                    let levels = Some(levels);
                    PhotoChoice::Files(PhotoSettings { files: photos, levels, quality })
                }
            },
            dem: paths("dem").collect(),
            terrain_of: paths("terrain").next(),
            osm: paths("osm").collect(),
            terrain,
            layers: self.layers.iter().cloned().map(LayerTable::new).collect::<Result<_, _>>()?,
            roads: settings_record::roads(&self.settings, table).ok_or(PlanFileError::Filter)?,
            attribution: self.attribution.clone(),
            generator: self.generator.clone(),
        })
    }

    /// Fails if `again`, created from this plan's own settings on this machine by this program, is
    /// another plan.
    ///
    /// # Errors
    /// [`PlanFileError::Differs`], which names the differences.
    pub fn check_same(&self, again: &Self) -> Result<(), PlanFileError> {
        let differences = again.differences(self);
        if differences.is_empty() { Ok(()) } else { Err(PlanFileError::Differs { differences }) }
    }

    /// The plan as indented text; equal plans give equal texts.
    ///
    /// # Errors
    /// When a number is not finite.
    pub fn to_json(&self) -> Result<String, PlanFileError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Reads a text written by [`BuildPlan::to_json`].
    ///
    /// # Errors
    /// When the text is not a plan, or is a plan of another version.
    pub fn from_json(text: &str) -> Result<Self, PlanFileError> {
        /// The fields that all versions have.
        #[derive(Deserialize)]
        struct Version {
            plan_version: u32,
        }
        let Version { plan_version: found } = serde_json::from_str(text)?;
        if found != PLAN_VERSION {
            return Err(PlanFileError::Version { found });
        }
        Ok(serde_json::from_str(text)?)
    }

    /// SHA-256 of the plan's JSON without spaces. Fields are in the order of their declaration.
    ///
    /// Sizes and times of the inputs are included: they bind a store to the files as they are. They
    /// are never written to a package.
    #[must_use]
    pub fn digest(&self) -> [u8; 32] {
        // A record of numbers and texts can always be written as JSON; if it cannot, its debug form
        // is just as unique.
        let json = serde_json::to_string(self).unwrap_or_else(|_| format!("{self:?}"));
        Sha256::digest(json).into()
    }

    /// The digest as lower-case hexadecimal.
    #[must_use]
    pub fn hash(&self) -> String {
        hex(&self.digest())
    }
}

impl FrcTableRecord {
    fn from_table(table: &FrcTable) -> Self {
        Self {
            name: table.name().to_owned(),
            least_class: table.own_least_class().number(),
            values: table
                .values()
                .map(|(value, class)| {
                    (value.to_owned(), class.map(corniche_roads::FunctionalRoadClass::number))
                })
                .collect(),
        }
    }

    fn table(&self) -> Result<FrcTable, FrcTableError> {
        let mut classes = Vec::new();
        let mut not_roads = Vec::new();
        for (value, class) in &self.values {
            match class {
                Some(class) => classes.push((value.clone(), *class)),
                None => not_roads.push(value.clone()),
            }
        }
        FrcTable::new(self.name.clone(), classes, not_roads, self.least_class)
    }
}

fn planned_levels(levels: &Levels) -> Vec<PlannedLevel> {
    let planned = |level| PlannedLevel {
        level,
        cell_m: levels.frame().level_cell(level),
        max_error_m: levels.max_error_m(level),
        least_class: levels.least_class(level).map(corniche_roads::FunctionalRoadClass::number),
        simplify_tolerance_m: levels.simplify_tolerance_m(level),
        width_margin_m: levels.margin_m(level),
    };
    levels.numbers().map(planned).collect()
}
