//! What exports of lines with heights begin with: the package, its inputs, and the file to write.

use std::path::{Path, PathBuf};

use corniche_export::{Coordinates, VectorFormat, check_lines_request};
use corniche_network::Network;
use corniche_tileset::FilePackage;
use corniche_verify::RecordedElevation;

use super::vector_files::{coordinates, format};
use crate::{
    args::{ExtractArgs, RecordedArgs, ThreadsArg, VectorArgs},
    failure::Failure,
    output::{existing_of, named::NamedOutput},
    packages, recorded,
};

/// What a command line of an export of lines says.
pub(crate) struct LinesArgs<'a> {
    pub(crate) from: &'a RecordedArgs,
    pub(crate) extract: &'a ExtractArgs,
    pub(crate) vector: &'a VectorArgs,
    pub(crate) cpu: &'a ThreadsArg,
    pub(crate) level: Option<u8>,
    /// How to name the package.
    pub(crate) usage: &'a str,
}

/// An export of lines whose inputs are open.
pub(crate) struct LinesExport {
    pub(crate) format: VectorFormat,
    pub(crate) coordinates: Coordinates,
    pub(crate) package: FilePackage,
    pub(crate) output: NamedOutput,
    pub(crate) elevation: Option<RecordedElevation>,
    pub(crate) network: Option<Network>,
}

impl LinesExport {
    /// Opens the inputs and begins the file, whose layer is called `layer`. An unusable place, and what cannot be met, is reported before any work is done.
    pub(crate) fn begin(args: &LinesArgs<'_>, layer: &str) -> Result<Self, Failure> {
        let LinesArgs { from, extract, vector, cpu, level, usage } = args;
        let format = format(vector.format, &vector.file.output)?;
        let coordinates = coordinates(vector.crs, vector.heights.is_some(), format)?;
        let (place, [dem, osm]) = from.files(&extract.osm, usage)?;
        let package = packages::open_with_datum(&place, &vector.datum)?;
        check_lines_request(&package, *level, (format, coordinates))?;
        let files = dem.iter().chain(&osm).map(PathBuf::as_path);
        let inputs: Vec<&Path> = [place.name()].into_iter().chain(files).collect();
        let name = format!("{layer}.{}", format.ending());
        let existing = existing_of(vector.file.overwrite);
        let output = NamedOutput::create(&vector.file.output, existing, name, &inputs)?;
        let elevation = recorded::elevation(from, &dem, &package)?;
        let network = recorded::network(extract, &osm, (cpu, &package))?;
        Ok(Self { format, coordinates, package, output, elevation, network })
    }
}
