//! The common start of exports of lines with heights: opens the package and its inputs, and
//! begins the output file.

use std::path::{Path, PathBuf};

use corniche_export::{FeatureCoordinates, VectorFormat, check_lines_request};
use corniche_network::Network;
use corniche_tileset::FilePackage;
use corniche_verify::RecordedElevation;

use super::vector_files::coordinates;
use crate::{
    args::{ThreadsArg, VECTOR_FORMATS, VectorArgs, word_of},
    failure::Result,
    names::format_of,
    output::{existing_of, named::NamedOutput},
    packages, recorded,
};

/// An export of lines whose inputs are open.
pub(crate) struct LinesExport {
    pub format: VectorFormat,
    pub coordinates: FeatureCoordinates,
    pub package: FilePackage,
    pub output: NamedOutput,
    pub elevation: Option<RecordedElevation>,
    pub network: Option<Network>,
}

impl LinesExport {
    /// Opens the inputs and begins the file, whose layer is called `layer`; `usage` shows how to
    /// write the package. Unwritable targets and impossible requests are reported before any work
    /// is done.
    pub(crate) fn begin(
        vector: &VectorArgs,
        level: Option<u8>,
        cpu: &ThreadsArg,
        (layer, usage): (&str, &str),
    ) -> Result<Self> {
        let VectorArgs { from, extract, .. } = vector;
        let format = format_of(vector.format, &vector.file.output, &VECTOR_FORMATS)?;
        let coordinates = coordinates(vector.crs, vector.heights.is_some(), format)?;
        let (place, [dem, osm]) = from.files(&extract.osm, usage)?;
        let package = packages::open_with_datum(&place, &vector.datum)?;
        check_lines_request(&package, level, (format, coordinates))?;
        let files = dem.iter().chain(&osm).map(PathBuf::as_path);
        let inputs: Vec<&Path> = [place.name()].into_iter().chain(files).collect();
        let name = format!("{layer}.{}", word_of(&VECTOR_FORMATS, &format));
        let existing = existing_of(vector.file.overwrite);
        let output = NamedOutput::create(&vector.file.output, existing, name, &inputs)?;
        let elevation = recorded::elevation(from, &dem, &package)?;
        let network = recorded::network(extract, &osm, (cpu, &package))?;
        Ok(Self { format, coordinates, package, output, elevation, network })
    }
}
