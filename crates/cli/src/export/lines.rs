//! What exports of lines with heights begin with: the package, its inputs, and the file to write.

use std::path::{Path, PathBuf};

use corniche_export::{Coordinates, VectorFormat};
use corniche_network::Network;
use corniche_pipeline::RecordedElevation;
use corniche_tileset::FilePackage;

use super::{coordinates, format};
use crate::{
    args::{ExtractArgs, RecordedArgs, ThreadsArg, VectorArgs},
    failure::Failure,
    named_output::NamedOutput,
    output::existing_of,
    packages, recorded,
};

/// What a command line of an export of lines says.
pub(super) struct LinesArgs<'a> {
    pub(super) from: &'a RecordedArgs,
    pub(super) extract: &'a ExtractArgs,
    pub(super) vector: &'a VectorArgs,
    pub(super) cpu: &'a ThreadsArg,
    /// How to name the package.
    pub(super) usage: &'a str,
}

/// An export of lines whose inputs are open.
pub(super) struct LinesExport {
    pub(super) format: VectorFormat,
    pub(super) coordinates: Coordinates,
    pub(super) package: FilePackage,
    pub(super) output: NamedOutput,
    pub(super) elevation: Option<RecordedElevation>,
    pub(super) network: Option<Network>,
}

impl LinesExport {
    /// Opens the inputs and begins the file, whose layer is called `layer`. An unusable place is reported before any work is done.
    pub(super) fn begin(args: &LinesArgs<'_>, layer: &str) -> Result<Self, Failure> {
        let LinesArgs { from, extract, vector, cpu, usage } = args;
        let format = format(vector.format, &vector.file.output)?;
        let coordinates = coordinates(vector)?;
        let (place, [dem, osm]) = from.files(&extract.osm, usage)?;
        let package = packages::open_with_datum(&place, &vector.datum)?;
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
