//! What exports of lines with heights begin with: the package, its inputs, and the file to write.

use std::path::{Path, PathBuf};

use corniche_export::{Coordinates, FileFormat as _, VectorFormat, check_lines_request};
use corniche_network::Network;
use corniche_tileset::FilePackage;
use corniche_verify::RecordedElevation;

use super::vector_files::{coordinates, format};
use crate::{
    args::{ThreadsArg, VectorArgs},
    failure::Failure,
    output::{existing_of, named::NamedOutput},
    packages, recorded,
};

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
    /// Opens the inputs and begins the file, whose layer is called `layer`; `usage` shows how to name the package. An unusable place, and what cannot be met, is reported before any work is done.
    pub(crate) fn begin(
        vector: &VectorArgs,
        level: Option<u8>,
        cpu: &ThreadsArg,
        (layer, usage): (&str, &str),
    ) -> Result<Self, Failure> {
        let VectorArgs { from, extract, .. } = vector;
        let format = format(vector.format, &vector.file.output)?;
        let coordinates = coordinates(vector.crs, vector.heights.is_some(), format)?;
        let (place, [dem, osm]) = from.files(&extract.osm, usage)?;
        let package = packages::open_with_datum(&place, &vector.datum)?;
        check_lines_request(&package, level, (format, coordinates))?;
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
