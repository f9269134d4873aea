//! Arguments that several commands have. Where the help of one says more of it, it does so by `mut_arg`.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::{Args, ValueHint};
use corniche_export::{DegreeBounds, RoadQuery};
use corniche_presets::{BoundsChoice, Classes, parse_bytes};
use corniche_remote::PackagePlace;
use corniche_viewer::stream::StreamBudget;

use super::values::{package_among, package_place};
use crate::failure::Failure;

// The package that is read.
#[derive(Debug, Args)]
pub(crate) struct PackageArg {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) package: PackagePlace,
}

// The package that is read, with the elevation files that it was made from.
#[derive(Debug, Args)]
pub(crate) struct RecordedArgs {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(required_unless_present = "dem", value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    package: Option<PackagePlace>,
    /// The elevation rasters the package was made from, in the same order: heights are theirs
    #[arg(long, value_name = "FILE", num_args = 1..)]
    dem: Vec<PathBuf>,
    /// With --dem: the polygon that the package was cut with
    #[arg(long, value_name = "FILE", requires = "dem")]
    pub(crate) polygon: Option<PathBuf>,
}

impl RecordedArgs {
    /// The package, its elevation rasters, and other files. `--dem` takes all that follows it, as others do, also a package, which is told from other
    /// files by its name.
    ///
    /// # Errors
    /// When no package is named, or several may be meant.
    pub(crate) fn files(
        &self,
        others: &[PathBuf],
        usage: &str,
    ) -> Result<(PackagePlace, [Vec<PathBuf>; 2]), Failure> {
        package_among(self.package.as_ref(), [&self.dem, others], usage)
    }
}

// The extracts that a package was made from.
#[derive(Debug, Args)]
pub(crate) struct ExtractArgs {
    /// With --dem: the extracts the package was made from: grades are those of lines from junction to junction, bridges and tunnels get their own heights
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) osm: Vec<PathBuf>,
    /// With --osm: the FRC table it was made with [default: the preset of the recorded name]
    #[arg(long, value_name = "NAME|FILE", requires = "osm")]
    pub(crate) frc_table: Option<String>,
}

// The file that an export writes.
#[derive(Debug, Args)]
pub(crate) struct FileArgs {
    /// The file to write; its ending is its format: .gpkg, .fgb, .geojson or .csv
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Replace the file if it exists, once the new one is complete; if it is a link, replace the file it leads to
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
}

// The folder that an export writes.
#[derive(Debug, Args)]
pub(crate) struct FolderArgs {
    /// The folder to write: tileset.json and what it names
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,
    /// Replace the folder, once the new one is complete, if it is an earlier export
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
}

// One level of a package.
#[derive(Debug, Args)]
pub(crate) struct LevelArg {
    /// The level that is taken [default: the finest]
    #[arg(long, value_name = "Z")]
    pub(crate) level: Option<u8>,
}

// A part of a package.
#[derive(Debug, Args)]
pub(crate) struct BoundsArg {
    /// Cut roads at a rectangle of WGS84 degrees; a west beyond the east crosses 180°
    #[arg(long, value_name = "W,S,E,N", allow_hyphen_values = true, value_parser = parse_bounds)]
    pub(crate) bounds: Option<DegreeBounds>,
}

// What heights are measured from, of a package that does not know it.
#[derive(Debug, Args)]
pub(crate) struct DatumArg {
    /// Vertical CRS of a package that knows none, from which heights are carried to the ellipsoid
    #[arg(long, value_name = "EPSG:N")]
    pub(crate) dem_vertical_crs: Option<String>,
}

// Some classes of roads.
#[derive(Debug, Args)]
pub(crate) struct ClassesArg {
    /// Functional road classes that are taken, such as 0-4,7
    #[arg(long, value_name = "LIST", default_value = "0-8", value_parser = parse_classes)]
    pub(crate) classes: Classes,
}

// Roads by what is written on signs.
#[derive(Debug, Args)]
pub(crate) struct RoadArg {
    /// Only roads with this number (OSM's ref), such as "CG 2"; spaces, hyphens and case do not matter
    #[arg(long = "ref", value_name = "NUMBER", value_parser = parse_road)]
    reference: Option<String>,
    /// Only roads with this name (OSM's name); spaces, hyphens and case do not matter
    #[arg(long, value_name = "NAME", value_parser = parse_road)]
    name: Option<String>,
}

impl RoadArg {
    /// The road that is named.
    pub(crate) fn query(&self) -> Option<RoadQuery> {
        let query = RoadQuery { reference: self.reference.clone(), name: self.name.clone() };
        (query != RoadQuery::default()).then_some(query)
    }
}

// What a command may use of the processor.
#[derive(Debug, Args)]
pub(crate) struct ThreadsArg {
    /// Worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

// What drawing frame by frame may use of the graphics card.
#[derive(Debug, Args)]
pub(crate) struct GpuArgs {
    /// Memory for tiles on the graphics card, such as 512M or 4G
    #[arg(long, value_name = "BYTES", default_value = "512M", value_parser = parse_bytes)]
    gpu_memory: u64,
    /// Most bytes to upload to the graphics card in one frame; at least one whole tile is uploaded
    #[arg(long, value_name = "BYTES", default_value = "4M", value_parser = parse_bytes)]
    upload_per_frame: u64,
}

impl GpuArgs {
    /// What the viewer may use, with eight tiles decoded at once.
    pub(crate) fn budget(&self) -> StreamBudget {
        StreamBudget {
            tiles_in_flight: 8,
            upload_bytes_per_frame: self.upload_per_frame,
            gpu_bytes: self.gpu_memory,
        }
    }
}

fn parse_road(text: &str) -> Result<String, String> {
    if text.chars().any(char::is_alphanumeric) {
        Ok(text.to_owned())
    } else {
        Err("it has neither letters nor digits".to_owned())
    }
}

fn parse_classes(text: &str) -> Result<Classes, String> {
    Classes::parse(text).map_err(|_| "write classes from 0 to 8 like 0-4,7".to_owned())
}

fn parse_bounds(text: &str) -> Result<DegreeBounds, String> {
    let advice = "write west,south,east,north in degrees, like 9.47,47.04,9.64,47.28";
    match BoundsChoice::parse(text)? {
        BoundsChoice::Degrees(degrees) => {
            DegreeBounds::new(degrees).ok_or_else(|| advice.to_owned())
        }
        BoundsChoice::Osm => Err(format!("a package does not know the extract's box; {advice}")),
    }
}

#[cfg(test)]
#[path = "shared_tests.rs"]
mod tests;
