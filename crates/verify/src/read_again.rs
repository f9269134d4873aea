//! Reads the extracts from which a package was built again, for data that the package does not
//! store, such as the nodes that roads share.

use corniche_osm::{Layers, read_extract};
use corniche_pieces::extract::{placed_reading::PlacedReading, reading_pool};
use corniche_spec::{
    BuildObserver,
    inputs::{InputFiles, OtherInputs},
};
use corniche_tileset::FilePackage;
use corniche_work::Stage;

use super::{
    checks::Findings,
    error::{Result, VerifyError},
    georeference, osm,
    temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};

/// Passes on layers of the extracts, with points on the package's lattice; roads come with the ids
/// of their nodes.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or the files are not those of the build.
pub(crate) fn read_again(
    package: &FilePackage,
    (extract, layers): (&VerifyOsm, Layers<'_>),
    threads: usize,
    observer: &dyn BuildObserver,
) -> Result<()> {
    let others = OtherInputs { osm: &extract.paths, polygon: None, photo: &[] };
    let inputs = InputFiles::find(&[], others)?;
    let read = read(package, (extract, layers), (&inputs, threads), observer);
    VerifyError::unless_changed(&inputs, read)
}

fn read(
    package: &FilePackage,
    (extract, layers): (&VerifyOsm, Layers<'_>),
    (inputs, threads): (&InputFiles, usize),
    observer: &dyn BuildObserver,
) -> Result<()> {
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
        // The build already reported the problems of the extract.
        read_extract(request, layers, &mut |_| {}, &should_stop)
    })?;
    observer.end(Stage::Extract);
    Ok(())
}
