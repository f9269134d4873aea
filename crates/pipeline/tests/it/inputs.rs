//! Unusual and unusable inputs, through the whole pipeline.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path, sync::Mutex};

use crate::support::{Options, Raster, build_files, build_raster, settings, terrain::waves};
use corniche_pipeline::{BuildError, build};
use corniche_plan::PlanError;
use corniche_spec::BuildObserver;
use corniche_spec::inputs::InputError;
use corniche_tileset::FilePackage;
use corniche_verify::{VerifyError, VerifySettings, verify};
use corniche_work::{Silent, Stage};

fn hills() -> Raster {
    Raster::new([300, 200], [5, 9], |column, row| 100.0 * waves(column, row))
}

/// A name that only GDAL understands: here a file inside another, as in an archive.
#[test]
fn a_raster_inside_another_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, container] = ["dem.tif", "container"].map(|name| folder.path().join(name));
    hills().write(&dem);
    let bytes = fs::read(&dem).unwrap();
    fs::write(&container, [b"padding".to_vec(), bytes.clone()].concat()).unwrap();
    let inside = format!("/vsisubfile/7_{},{}", bytes.len(), container.display());
    let built = build_files(Path::new(&inside), None, Options::plain(5.0)).unwrap();
    let plain = build_files(&dem, None, Options::plain(5.0)).unwrap();
    assert_eq!(built.tiles, plain.tiles);
    // The hash covers the bytes that GDAL delivers.
    let [inside, whole] = [&built, &plain].map(|built| &built.manifest.inputs[0]);
    assert_eq!((inside.bytes, &inside.sha256), (bytes.len() as u64, &whole.sha256));
}

/// A raster is named inside its container; the container is hashed, and the package contains no
/// folder names.
#[test]
fn a_raster_of_a_container_is_read_and_its_container_hashed() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    hills().write(&dem);
    let inside = format!("GTIFF_DIR:1:{}", dem.display());
    let built = build_files(Path::new(&inside), None, Options::plain(5.0)).unwrap();
    let plain = build_files(&dem, None, Options::plain(5.0)).unwrap();
    assert_eq!(built.tiles, plain.tiles);
    let [inside, whole] = [&built, &plain].map(|built| &built.manifest.inputs[0]);
    assert_eq!((inside.name.as_str(), &inside.sha256), ("GTIFF_DIR:1:dem.tif", &whole.sha256));
}

/// Height steps of 32 bits reach neither an undeclared nodata value nor, if they are tiny, any
/// mountain.
#[test]
fn a_height_that_steps_do_not_reach_is_refused_as_bad_input() {
    for (height_m, max_error_m) in [(6e6_f32, 0.05), (-6e6, 0.05), (600.0, 1e-5)] {
        let mut raster = hills();
        raster.heights_m[150 * 300 + 100] = height_m;
        // An option allows these heights; otherwise the samples would be rejected earlier.
        let options = Options { height_range_m: Some([-1e7, 1e7]), ..Options::plain(max_error_m) };
        let refused = build_raster(&raster, options).err().unwrap();
        assert!(refused.is_unusable_input(), "{height_m}: {refused}");
        let reason = std::error::Error::source(&refused).unwrap().to_string();
        assert!(reason.contains(&height_m.to_string()) && reason.contains("nodata"), "{reason}");
    }
}

/// If an input is replaced at any stage of the run and given its old modification time, no package
/// is written.
#[test]
fn an_input_exchanged_at_any_stage_ends_the_build() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, output] = ["dem.tif", "out.pmtiles"].map(|name| folder.path().join(name));
    for stage in [Stage::Hash, Stage::Heights, Stage::CoarseTins, Stage::Tiles, Stage::CoarseTiles]
    {
        hills().write(&dem);
        let exchange = At { stage, act: Mutex::new(Some(Box::new(|| exchange(&dem)))) };
        let refused =
            build(&settings(dem.clone(), None, output.clone(), Options::plain(5.0)), &exchange);
        let refused = refused.err().unwrap();
        assert!(
            matches!(&refused, BuildError::Input(InputError::Changed { path }) if *path == dem),
            "{stage:?}: {refused}"
        );
        assert!(!refused.is_unusable_input(), "{stage:?}: the input is not to blame");
        assert!(exchange.act.into_inner().unwrap().is_none(), "{stage:?} did not begin");
        assert!(!output.exists(), "{stage:?}");
    }
    // The changed file itself can be used.
    build(&settings(dem, None, output, Options::plain(5.0)), &Silent).unwrap();
}

/// Runs an action once, when a stage starts.
struct At<'a> {
    stage: Stage,
    act: Mutex<Option<Box<dyn FnOnce() + Send + 'a>>>,
}

impl corniche_work::Observer for At<'_> {
    fn begin(&self, stage: Stage, _: Option<u64>) {
        let act = if stage == self.stage { self.act.lock().unwrap().take() } else { None };
        if let Some(act) = act {
            act();
        }
    }
}

impl BuildObserver for At<'_> {}

/// Replaces a raster by one with other heights, the same length and the same modification time.
fn exchange(path: &Path) {
    let time = fs::metadata(path).unwrap().modified().unwrap();
    let other = path.with_extension("other.tif");
    Raster::new([300, 200], [5, 9], |column, row| 90.0 * waves(column, row)).write(&other);
    assert_eq!(fs::metadata(&other).unwrap().len(), fs::metadata(path).unwrap().len());
    fs::File::options().write(true).open(&other).unwrap().set_modified(time).unwrap();
    fs::rename(&other, path).unwrap();
}

/// A repeated value far beyond all others is found with any number of threads, and is reported with
/// its exact count.
#[test]
fn a_value_that_no_height_has_is_refused_before_anything_is_made_of_it() {
    let mut raster = hills();
    for k in 0..41 {
        raster.heights_m[1000 + 7 * k] = -32_767.0;
    }
    let refusal = |threads, height_range_m| {
        let options = Options { threads, height_range_m, ..Options::plain(5.0) };
        build_raster(&raster, options).err().map(|refused| {
            assert!(refused.is_unusable_input(), "{refused}");
            let text = refused.to_string();
            // The name of the folder differs in each run.
            text.split_once("hold").map_or(text.clone(), |(_, rest)| rest.to_owned())
        })
    };
    let expected = refusal(1, None).unwrap();
    assert!(expected.contains("--nodata -32767"), "{expected}");
    for threads in [2, 3, 8] {
        assert_eq!(refusal(threads, None).as_ref(), Some(&expected));
    }
    assert_eq!(refusal(2, Some([-40_000.0, 9000.0])), None);
}

#[test]
fn a_tolerance_beyond_what_numbers_hold_is_refused_as_such() {
    for max_error_m in [1.1e9, 1e308, 0.9e-9, 5e-324, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = build_raster(&hills(), Options::plain(max_error_m)).err().unwrap();
        assert!(
            matches!(refused, BuildError::Plan(PlanError::MaxError { .. })),
            "{max_error_m}: {refused}"
        );
    }
    // The largest tolerance that is accepted: a tile has its corners, and a few more vertices where
    // the data end in it.
    let built = build_raster(&hills(), Options::plain(1e9)).unwrap();
    assert!(built.grounds().all(|(_, ground)| (4..=9).contains(&ground.tin.vertices().len())));
    // The smallest: level ground needs no more.
    let level = Raster::new([300, 200], [5, 9], |_, _| 0.0);
    let built = build_raster(&level, Options::plain(1e-9)).unwrap();
    assert!(built.grounds().all(|(_, ground)| ground.geometric_error_m == 0.0));
}

/// The inputs given to `verify` must not change during the run either.
#[test]
fn a_raster_exchanged_while_it_is_verified_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, output] = ["dem.tif", "out.pmtiles"].map(|name| folder.path().join(name));
    hills().write(&dem);
    build(&settings(dem.clone(), None, output.clone(), Options::plain(5.0)), &Silent).unwrap();
    let package = FilePackage::open(&output).unwrap();
    let request = VerifySettings {
        dem: vec![dem.clone()],
        photo: Vec::new(),
        osm: None,
        threads: 2,
        polygon: None,
    };
    assert!(verify(&package, &request, &Silent).unwrap().holds());
    for stage in [Stage::Hash, Stage::Deviations] {
        let change = At { stage, act: Mutex::new(Some(Box::new(|| exchange(&dem)))) };
        let refused = verify(&package, &request, &change).err().unwrap();
        assert!(matches!(&refused, VerifyError::Changed { path } if *path == dem), "{refused}");
        hills().write(&dem);
    }
}
