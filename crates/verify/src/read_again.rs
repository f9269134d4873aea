//! The extracts that a package was made from, read again for what it does not store, such as the names of what its lines bound.

use corniche_areas::{ClassedLayer, LineNames};
use corniche_osm::{ClassedLine, LayerSink, Layers, LineSummary, read_extract};
use corniche_pieces::extract::{placed_reading::PlacedReading, reading_pool};
use corniche_spec::{
    Observer,
    inputs::{Inputs, OtherInputs},
};
use corniche_tileset::FilePackage;
use corniche_work::Stage;

use super::{
    checks::Findings, error::VerifyError, georeference, osm, temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};

/// Hands out layers of the extracts, with points on the package's lattice; roads come with the ids of their nodes.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or they are not those of the build.
pub(crate) fn read_again(
    package: &FilePackage,
    (extract, layers): (&VerifyOsm, Layers<'_>),
    threads: usize,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let others = OtherInputs { osm: &extract.paths, polygon: None, photo: &[] };
    let inputs = Inputs::find(&[], others)?;
    let read = read(package, (extract, layers), (&inputs, threads), observer);
    VerifyError::unless_changed(&inputs, read)
}

fn read(
    package: &FilePackage,
    (extract, layers): (&VerifyOsm, Layers<'_>),
    (inputs, threads): (&Inputs, usize),
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let mut findings = Findings::default();
    let paths = osm::check_inputs(manifest, extract, inputs, &mut findings, observer)?;
    let crs = georeference::recorded(manifest)?;
    let projection = crs.projection(manifest.area_deg())?;
    let work = TemporaryStore::new(observer)?;
    let scratch = work.scratch()?;
    let pool = reading_pool(threads)?;
    let reading = PlacedReading {
        osm: &paths,
        table: &osm::chosen(&extract.table, manifest),
        frame: &manifest.frame,
        projection: &projection,
        node_ids: true,
        pool: &pool,
        memory_bytes: extract.memory_bytes,
    };
    observer.begin(Stage::Extract, None);
    let on_progress = |done, total| observer.reached(Stage::Extract, done, total);
    let should_stop = || observer.is_cancelled();
    reading.read(&scratch, (observer, &on_progress), |request| {
        // What is wrong with the extract was told when the package was built.
        read_extract(request, layers, &mut |_| {}, &should_stop)
    })?;
    observer.end(Stage::Extract);
    Ok(())
}

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
