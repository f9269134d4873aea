//! The names of what the lines of a package bound, which packages do not store.

use corniche_areas::{ClassedLayer, LineNames};
use corniche_osm::{ClassedLine, LayerSink, Layers, LineSummary};
use corniche_spec::Observer;
use corniche_tileset::FilePackage;

use super::{error::VerifyError, read_again::read_again, verify_settings::VerifyOsm};

/// Reads the extracts that a package was made from again, for the names of what the ways of a layer bound: of relations, and of closed ways.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or they are not those of the build.
pub fn line_names(
    package: &FilePackage,
    layer: ClassedLayer,
    extract: &VerifyOsm,
    threads: usize,
    observer: &dyn Observer,
) -> Result<LineNames, VerifyError> {
    let mut names = LineNames::default();
    let mut on_name = |way_id, class, name: &str| {
        names.entry(way_id).or_default().entry(class).or_default().insert(name.to_owned());
    };
    let mut lines = Unneeded;
    let layers = Layers {
        lines: vec![(layer, &mut lines)],
        line_names: Some(&mut on_name),
        ..Layers::default()
    };
    read_again(package, (extract, layers), threads, observer)?;
    Ok(names)
}

/// The package has the lines.
struct Unneeded;

impl LayerSink<ClassedLine, LineSummary> for Unneeded {
    fn take(&mut self, _: ClassedLine) {}

    fn end(&mut self, _: LineSummary) {}
}
