//! Arguments of several commands. A command that needs a more specific help text sets it with
//! `mut_arg`.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::{Args, ValueHint};
use corniche_export::{DegreeBounds, RoadQuery};
use corniche_presets::{BoundsChoice, Classes, parse_bytes};
use corniche_remote::PackagePlace;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::Manifest;
use corniche_viewer::stream::StreamBudget;

use super::values::{package_among, package_place};
use crate::{failure::Result, presets};

// The package to read.
#[derive(Debug, Args)]
pub(crate) struct PackageArg {
    /// The package: a file, or a URL (https://…)
    #[arg(value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub package: PackagePlace,
}

// The package to read, with the DEM that it was built from.
#[derive(Debug, Args)]
pub(crate) struct RecordedArgs {
    /// The package: a file, or a URL (https://…)
    #[arg(required_unless_present = "dem", value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    package: Option<PackagePlace>,
    /// The DEM the package was built from (same files, same order): heights are read from it
    #[arg(long, value_name = "FILE", num_args = 1..)]
    dem: Vec<PathBuf>,
    /// With --dem: the polygon that the package was clipped to
    #[arg(long, value_name = "FILE", requires = "dem")]
    pub polygon: Option<PathBuf>,
}

impl RecordedArgs {
    /// The package, its elevation files, and other files. `--dem` consumes all words that follow
    /// it, including a package, which its name identifies.
    ///
    /// # Errors
    /// When no package is named, or the package is ambiguous.
    pub(crate) fn files(
        &self,
        others: &[PathBuf],
        usage: &str,
    ) -> Result<(PackagePlace, [Vec<PathBuf>; 2])> {
        package_among(self.package.as_ref(), [&self.dem, others], usage)
    }
}

// The extracts that a package was built from.
#[derive(Debug, Args)]
pub(crate) struct ExtractArgs {
    /// With --dem: the extracts the package was built from: grades are computed from junction to
    /// junction, and bridges and tunnels get their own heights
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub osm: Vec<PathBuf>,
    /// With --osm: the FRC table (functional road classes) the package was built with [default: the
    /// preset of the recorded name]
    #[arg(long, value_name = "NAME|FILE", requires = "osm")]
    pub frc_table: Option<String>,
}

// The file that an export writes.
#[derive(Debug, Args)]
pub(crate) struct FileArgs {
    /// The file to write; its extension selects the format: .gpkg, .fgb, .geojson or .csv
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Overwrite the file if it exists, once the new one is complete; for a link, overwrite the
    /// file it points to
    #[arg(short = 'O', long)]
    pub overwrite: bool,
}

// The folder that an export writes.
#[derive(Debug, Args)]
pub(crate) struct FolderArgs {
    /// The folder to write: tileset.json and its content files
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// Overwrite an earlier export in the folder, once the new one is complete
    #[arg(short = 'O', long)]
    pub overwrite: bool,
}

// A level of a package.
#[derive(Debug, Args)]
pub(crate) struct LevelArg {
    /// The level to use [default: the finest]
    #[arg(long, value_name = "Z")]
    pub level: Option<u8>,
}

// A region of a package.
#[derive(Debug, Args)]
pub(crate) struct BoundsArg {
    /// Clip roads to a bounding box in WGS84 degrees; one with west > east crosses 180°
    #[arg(long, value_name = "W,S,E,N", allow_hyphen_values = true, value_parser = parse_bounds)]
    pub bounds: Option<DegreeBounds>,
}

// The vertical CRS of a package that does not record one.
#[derive(Debug, Args)]
pub(crate) struct DatumArg {
    /// Vertical CRS of a package that does not record one, for the conversion of heights to the
    /// ellipsoid
    #[arg(long, value_name = "EPSG:N")]
    pub dem_vertical_crs: Option<String>,
}

// A selection of road classes.
#[derive(Debug, Args)]
pub(crate) struct ClassesArg {
    /// Functional road classes (FRC) to use, such as 0-4,7 or motorway,trunk
    #[arg(long, value_name = "LIST", default_value = "0-8", value_parser = Classes::parse)]
    classes: Classes,
}

impl ClassesArg {
    /// The classes of a package.
    ///
    /// # Errors
    /// When the package has no class of a name.
    pub(crate) fn of_package(&self, manifest: &Manifest) -> Result<Vec<FunctionalRoadClass>> {
        let table = presets::recorded_table(manifest);
        let classes = self.classes.classes(table.as_ref(), &presets::class_labels(manifest));
        classes.map_err(|error| presets::refuse("--classes", &error))
    }
}

// A selection of roads by number or name.
#[derive(Debug, Args)]
pub(crate) struct RoadArg {
    /// Only roads with this number (OSM's ref), such as "CG 2"; spaces, hyphens and case are
    /// ignored
    #[arg(long = "ref", value_name = "NUMBER", value_parser = parse_road)]
    reference: Option<String>,
    /// Only roads with this name (OSM's name); spaces, hyphens and case are ignored
    #[arg(long, value_name = "NAME", value_parser = parse_road)]
    name: Option<String>,
}

impl RoadArg {
    /// The query for the given number and name.
    pub(crate) fn query(&self) -> Option<RoadQuery> {
        let query = RoadQuery { reference: self.reference.clone(), name: self.name.clone() };
        (query != RoadQuery::default()).then_some(query)
    }
}

// The use of the processor.
#[derive(Debug, Args)]
pub(crate) struct ThreadsArg {
    /// Number of worker threads [default: one per processor]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
}

// The use of the GPU when drawing frame by frame.
#[derive(Debug, Args)]
pub(crate) struct GpuArgs {
    /// GPU memory for tiles, such as 512M or 4G (M is 2^20 bytes)
    #[arg(long, value_name = "BYTES", default_value = "512M", value_parser = parse_bytes)]
    gpu_memory: u64,
    /// Upload limit per frame, such as 4M (2^22 bytes); at least one whole tile is always uploaded
    #[arg(long, value_name = "BYTES", default_value = "4M", value_parser = parse_bytes)]
    upload_per_frame: u64,
}

impl GpuArgs {
    /// The limits of the viewer, with eight tiles decoded at once.
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
        Err("it contains neither letters nor digits".to_owned())
    }
}

fn parse_bounds(text: &str) -> Result<DegreeBounds, String> {
    let advice = "write west,south,east,north in degrees, like 9.47,47.04,9.64,47.28";
    match BoundsChoice::parse(text)? {
        BoundsChoice::Degrees(degrees) => {
            DegreeBounds::new(degrees).ok_or_else(|| advice.to_owned())
        }
        BoundsChoice::Osm => {
            Err(format!("a package does not record the extract's bounding box; {advice}"))
        }
    }
}

#[cfg(test)]
#[path = "shared_tests.rs"]
mod tests;
