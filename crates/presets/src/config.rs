//! The options of a build: each is declared once, for the command line and for settings files.

use std::{collections::BTreeMap, num::NonZeroUsize, path::PathBuf};

use clap::Args;
use corniche_areas::ClassedLayer;
use serde::{Deserialize, Deserializer};

use crate::{
    BoundsChoice, Classes, PhotoOptions, PresetError, ReliefChoice,
    error::bounded,
    files::{InputFiles, OutputFiles},
    values::{parse_cell, parse_range},
};

/// A settings file: the options of the command line, by section. The defaults of options that are left out are decided
/// elsewhere.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// `[inputs]`
    pub inputs: InputFiles,
    /// `[output]`
    pub output: OutputFiles,
    /// `[terrain]`
    pub terrain: TerrainOptions,
    /// `[roads]`
    pub roads: RoadOptions,
    /// `[areas]`
    pub areas: AreaOptions,
    /// `[photo]`
    pub photo: PhotoOptions,
    /// `[resources]`
    pub resources: ResourceOptions,
}

impl Config {
    /// Reads a settings file's text. Unknown sections and names are refused.
    ///
    /// # Errors
    /// When it is no TOML, or holds what is no setting.
    pub fn parse(text: &str) -> Result<Self, PresetError> {
        Ok(toml::from_str(bounded(text)?)?)
    }
}

// How the ground is made: the section `[terrain]`.
#[derive(Debug, Clone, PartialEq, Default, Args, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[command(next_help_heading = "Terrain")]
#[expect(missing_docs, reason = "clap would take it for the description of the command")]
pub struct TerrainOptions {
    /// Working CRS: dem (the first raster's own, so that nodes are its samples), utm, or any projected one
    /// [default: dem where lengths are then true within 3 %, else utm]
    #[arg(long, value_name = "dem|utm|EPSG:N|WKT")]
    pub crs: Option<String>,
    /// Band with the heights, from 1 on, of rasters with several [default: the only one]
    #[arg(long, value_name = "N")]
    pub dem_band: Option<u32>,
    /// Take one datum for another where PROJ knows nothing between them, which can put roads 100 m and more beside the ground
    #[arg(long)]
    pub allow_ballpark: bool,
    /// CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    pub dem_crs: Option<String>,
    /// Vertical CRS of rasters that name none
    #[arg(long, value_name = "EPSG:N")]
    pub dem_vertical_crs: Option<String>,
    /// Vertical CRS to convert heights to, with PROJ and its geoid grids [default: that of the files]
    #[arg(long, value_name = "EPSG:N")]
    pub vertical_crs: Option<String>,
    /// Added to every height, in metres [default: 0]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub vertical_shift: Option<f64>,
    /// Unit of the heights of all rasters, whatever they say of it: metre, foot, us-foot, decimetre or centimetre
    /// [default: that of their bands or vertical CRS, else metre]
    #[arg(long, value_name = "UNIT")]
    pub vertical_unit: Option<String>,
    /// Value that means "no data", as stored in the files, besides the one they declare; may be given several times
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_many")]
    pub nodata: Vec<f64>,
    /// Heights that samples may have, in metres, before --vertical-shift; every value in this range counts as a height
    /// [default: -12000,9000, and neither a usual value for "no data" nor a repeated one 1000 m beyond all others]
    #[arg(long, value_name = "LOW,HIGH", value_parser = parse_range, allow_hyphen_values = true)]
    pub height_range: Option<[f64; 2]>,
    /// Latitude, in degrees, at which lengths are true in a CRS that is not true to scale, such as degrees; packages of
    /// adjoining regions fit when it is the same [default: the middle of the DEM, to half a degree]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub scale_latitude: Option<f64>,
    /// Spacing of the finest level, in metres: of a square, or of a rectangle, east and north; heights are interpolated
    /// [default: the DEM's own]
    #[arg(long, value_name = "METRES|EAST,NORTH", value_parser = parse_cell, allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_two")]
    pub cell: Option<[f64; 2]>,
    /// Take every K-th sample of the DEM along both axes as a node of the finest level, without interpolation
    #[arg(long, value_name = "K", conflicts_with = "cell")]
    pub cell_every: Option<u32>,
    /// Largest vertical error of the finest level, in metres [default: a 16th of the cell; 0.25 for cells of 1 to 4 m]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub max_error: Option<f64>,
    /// Fill voids that have data within this many cells in each of eight directions [default: 32]
    #[arg(long, value_name = "CELLS")]
    pub fill_voids: Option<u32>,
    /// Levels that store their rasters, compressed for shading: off, finest or full, which is all of them. The triangles stay within
    /// --max-error of heights; the relief shows what lies between them [default: full]
    #[arg(long, value_enum, value_name = "off|finest|full", hide_possible_values = true)]
    pub relief: Option<ReliefChoice>,
    /// Convert only what lies within these bounds: west, south, east and north in WGS84 degrees, across 180° where the west is larger than
    /// the east; or osm: where the extract is, by its header, and a hundredth more on every side. Ground and roads end at the bounds,
    /// rounded outwards to whole cells; the grid is that of the whole DEM
    #[arg(long, value_name = "W,S,E,N|osm", value_parser = BoundsChoice::parse, allow_hyphen_values = true)]
    pub bounds: Option<BoundsChoice>,
    /// Credits, which the command line has beside the inputs.
    #[arg(skip)]
    pub attribution: Vec<String>,
}

// Which roads are shown on which level, and how exactly: the section `[roads]`.
#[derive(Debug, Clone, PartialEq, Default, Args, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[command(next_help_heading = "Roads")]
#[expect(missing_docs, reason = "clap would take it for the description of the command")]
pub struct RoadOptions {
    /// FRC table: a preset (default, valhalla, fraunhofer, itinero, here5) or a TOML file [default: default]
    #[arg(long, value_name = "PRESET|FILE")]
    pub frc_table: Option<String>,
    /// Functional road classes that become roads, such as 0-8 or 0,1,2; others are left out, and counted with their lengths. 0 is motorways,
    /// 7 service roads and tracks, 8 ways for people on foot, on horses or on bicycles [default: what the FRC table has on, 0-7 in the default one]
    #[arg(long, value_name = "LIST", value_parser = Classes::parse)]
    pub classes: Option<Classes>,
    /// Show every class that is on (see --classes) on every level; without it, coarse levels show important classes alone
    #[arg(long)]
    pub all_classes: bool,
    /// Tolerance of the simplification of roads on coarser levels, in cells of the level; 0 keeps every point
    /// [default: 0.25]
    #[arg(long, value_name = "CELLS")]
    pub simplify: Option<f64>,
    /// Where bridges and tunnels are: spans, above and below the ground as well as on it; or on the ground alone. Heights of spans are estimates
    /// [default: spans]
    #[arg(long, value_name = "ground|spans", value_parser = ["ground", "spans"])]
    pub structures: Option<String>,
    /// Coarsest cell, metres, at which each class is shown; a class left out is shown on every level.
    #[arg(skip)]
    pub class_max_cell: Option<BTreeMap<String, f64>>,
}

// Which areas are shown: the section `[areas]`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Args, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[command(next_help_heading = "Areas")]
#[expect(missing_docs, reason = "clap would take it for the description of the command")]
pub struct AreaOptions {
    /// Areas of the extract, such as water and forest, stored as polygons: the table of their classes, a preset (default) or a TOML file;
    /// off leaves them out [default: off]
    #[arg(id = "areas", long = "areas", value_name = "off|default|FILE")]
    #[serde(rename = "areas")]
    pub table: Option<String>,
    /// Boundaries of the extract: administrative ones of the levels 2 to 8, and those of protected areas, each shared border once; on or
    /// off [default: off]
    #[arg(long, value_name = "off|on", value_parser = ["off", "on"])]
    pub boundaries: Option<String>,
}

impl AreaOptions {
    /// What is said of a layer of lines.
    #[must_use]
    pub fn lines(&self, layer: ClassedLayer) -> Option<&str> {
        match layer {
            ClassedLayer::Boundaries => self.boundaries.as_deref(),
        }
    }

    /// These options; those that are not given are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { table: self.table.or(other.table), boundaries: self.boundaries.or(other.boundaries) }
    }
}

// What a build may use of the machine: the section `[resources]`.
#[derive(Debug, Clone, PartialEq, Default, Args, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[command(next_help_heading = "Resources")]
#[expect(missing_docs, reason = "clap would take it for the description of the command")]
pub struct ResourceOptions {
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// The most memory to use, such as 512M, 4G or 1T, at least 256M [default: half of the machine's, at most 4G]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<String>,
    /// Folder for intermediate results, which take far more space than the package [default: that of the package]
    #[arg(long, value_name = "FOLDER")]
    pub tmp: Option<PathBuf>,
}

/// What the first of two says, else what the second says.
trait OrElse {
    fn or_from(self, other: Self) -> Self;
}

impl<T> OrElse for Option<T> {
    fn or_from(self, other: Self) -> Self {
        self.or(other)
    }
}

impl<T> OrElse for Vec<T> {
    fn or_from(self, other: Self) -> Self {
        if self.is_empty() { other } else { self }
    }
}

impl OrElse for bool {
    fn or_from(self, other: Self) -> Self {
        self || other
    }
}

impl TerrainOptions {
    /// These options; those that are not given are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        // Two ways to give one thing: if one of them is given here, neither is taken from `other`.
        let (cell, cell_every) = match (self.cell, self.cell_every) {
            (None, None) => (other.cell, other.cell_every),
            given => given,
        };
        Self {
            crs: self.crs.or_from(other.crs),
            dem_band: self.dem_band.or_from(other.dem_band),
            allow_ballpark: self.allow_ballpark.or_from(other.allow_ballpark),
            dem_crs: self.dem_crs.or_from(other.dem_crs),
            dem_vertical_crs: self.dem_vertical_crs.or_from(other.dem_vertical_crs),
            vertical_crs: self.vertical_crs.or_from(other.vertical_crs),
            vertical_shift: self.vertical_shift.or_from(other.vertical_shift),
            vertical_unit: self.vertical_unit.or_from(other.vertical_unit),
            nodata: self.nodata.or_from(other.nodata),
            height_range: self.height_range.or_from(other.height_range),
            scale_latitude: self.scale_latitude.or_from(other.scale_latitude),
            cell,
            cell_every,
            max_error: self.max_error.or_from(other.max_error),
            fill_voids: self.fill_voids.or_from(other.fill_voids),
            relief: self.relief.or_from(other.relief),
            bounds: self.bounds.or_from(other.bounds),
            attribution: self.attribution.or_from(other.attribution),
        }
    }
}

impl RoadOptions {
    /// These options; those that are not given are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            frc_table: self.frc_table.or_from(other.frc_table),
            classes: self.classes.or_from(other.classes),
            all_classes: self.all_classes.or_from(other.all_classes),
            simplify: self.simplify.or_from(other.simplify),
            structures: self.structures.or_from(other.structures),
            class_max_cell: self.class_max_cell.or_from(other.class_max_cell),
        }
    }
}

impl ResourceOptions {
    /// These options; those that are not given are taken from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            threads: self.threads.or_from(other.threads),
            memory: self.memory.or_from(other.memory),
            tmp: self.tmp.or_from(other.tmp),
        }
    }
}

/// A list of numbers, or one alone.
fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or a list of numbers")]
    enum OneOrMany {
        One(f64),
        Many(Vec<f64>),
    }
    Ok(match OneOrMany::deserialize(deserializer)? {
        OneOrMany::One(value) => vec![value],
        OneOrMany::Many(values) => values,
    })
}

/// A cell, east and north: one number is the side of a square.
fn one_or_two<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 2]>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or two of them, [east, north]")]
    enum Sides {
        Square(f64),
        Rectangle([f64; 2]),
    }
    Ok(Some(match Sides::deserialize(deserializer)? {
        Sides::Square(side_m) => [side_m; 2],
        Sides::Rectangle(sides_m) => sides_m,
    }))
}

#[cfg(test)]
#[path = "config_tests.rs"]
mod tests;
