//! Rasters with known heights.

use std::path::{Path, PathBuf};

use corniche_dem::{Dem, DemError, GridPlan, HeightReader, OpenOptions, PlanOptions, SampleBlock};
use corniche_geom::{NodeWindow, Projection};
pub(crate) use corniche_testing::Raster;
use corniche_testing::raster_creation_options;
use gdal::{Dataset, DriverManager};

/// A plane in UTM 32N that rises 1 m in 10 m eastwards and 1 m in 5 m northwards.
pub(crate) fn plane([x, y]: [f64; 2]) -> f64 {
    500.0 + (x - 500_000.0) / 10.0 + (y - 5_200_000.0) / 5.0
}

/// One hundredth of a 10 m cell on that plane, and what f32 rounds away.
pub(crate) const HUNDREDTH_M: f64 = 0.1 * 0.224 + 1e-4;
/// Geotransform of the tests' rasters in UTM 32N: cells of 10 m.
pub(crate) const UTM: [f64; 6] = [500_003.0, 10.0, 0.0, 5_200_507.0, 0.0, -10.0];

/// A folder for the files of a test.
pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// The raster in another format, written by GDAL; `None`, with a printed line, if this GDAL cannot
/// write the format.
pub(crate) fn converted(
    path: &Path,
    driver: &str,
    name: &str,
    options: &[&str],
) -> Option<PathBuf> {
    let Ok(driver) = DriverManager::get_driver_by_name(driver) else {
        corniche_testing::skip(&format!("this GDAL has no driver {driver}"));
        return None;
    };
    let target = path.with_file_name(name);
    let dataset = Dataset::open(path).unwrap();
    dataset
        .create_copy(&driver, &target, &raster_creation_options(options))
        .unwrap()
        .close()
        .unwrap();
    Some(target)
}

/// The coordinates of which heights are a function.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Space {
    /// x, y of the working CRS.
    Working,
    /// Longitude, latitude of WGS84; longitudes from −180 to 180.
    Degrees,
}

/// Opens files and compares every node that has a height with `truth`; returns the number of nodes
/// with a height.
pub(crate) fn check_heights(
    name: &str,
    files: &[PathBuf],
    options: &OpenOptions,
    (space, tolerance_m): (Space, f64),
    truth: impl Fn([f64; 2]) -> f64,
) -> usize {
    let dem = Dem::open(files, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let plan = plan(&dem);
    let projection = dem.projection(&plan).unwrap();
    check(&mut dem.reader(&plan), &plan, tolerance_m, |mut at| {
        if let Space::Degrees = space {
            projection.wgs84_from_working(std::slice::from_mut(&mut at)).unwrap();
        }
        truth(at)
    })
}

/// Asserts that files are rejected when opened or read, with the file's name and all of `words`,
/// and without a raw error of a library.
pub(crate) fn check_refused(files: &[PathBuf], options: &OpenOptions, words: &[&str]) {
    let read = || -> Result<(), DemError> {
        let dem = Dem::open(files, options)?;
        let plan = dem.plan(&self::options())?;
        dem.reader(&plan).window(all(&plan))?;
        Ok(())
    };
    let error = read().expect_err(&format!("{files:?} was read"));
    check_words(&error, words);
}

/// Asserts that the message has all of `words`, and that neither it nor its causes are in the
/// jargon of a library.
pub(crate) fn check_words(error: &(impl std::error::Error + 'static), words: &[&str]) {
    let text = error.to_string();
    for word in words {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
    let mut whole = text;
    let mut cause = std::error::Error::source(error);
    while let Some(next) = cause {
        whole = format!("{whole}: {next}");
        cause = next.source();
    }
    for raw in ["CPL error", "OGR method", "GDAL method", "OgrError", "BadArgument"] {
        assert!(!whole.contains(raw), "{raw:?} is in: {whole}");
    }
}

pub(crate) fn open(files: &[PathBuf]) -> Dem {
    Dem::open(files, &OpenOptions::default()).unwrap()
}

pub(crate) fn plan(dem: &Dem) -> GridPlan {
    dem.plan(&options()).unwrap()
}

pub(crate) fn options() -> PlanOptions {
    PlanOptions::default()
}

/// Options for tests of resampling: a geographic DEM is transformed to UTM.
pub(crate) fn in_utm() -> PlanOptions {
    PlanOptions { crs: Some("utm".to_owned()), ..options() }
}

/// Metres per degree of longitude and of latitude on WGS84, by the usual series; an oracle that
/// shares nothing with the closed formula under test.
///
/// Source: National Geospatial-Intelligence Agency, *Length of a Degree of Latitude and Longitude*.
pub(crate) fn degree_m(latitude_deg: f64) -> [f64; 2] {
    let cos = |times: f64| (times * latitude_deg).to_radians().cos();
    [
        111_412.84 * cos(1.0) - 93.5 * cos(3.0) + 0.118 * cos(5.0),
        111_132.92 - 559.82 * cos(2.0) + 1.175 * cos(4.0) - 0.0023 * cos(6.0),
    ]
}

/// Asserts that both numbers agree to a relative tolerance.
pub(crate) fn check_near(found: [f64; 2], expected: [f64; 2], share: f64) {
    for axis in 0..2 {
        let off = (found[axis] / expected[axis] - 1.0).abs();
        assert!(off <= share, "{found:?}, not {expected:?}: {off:e} off");
    }
}

/// The window of all nodes at which data can lie.
pub(crate) fn all(plan: &GridPlan) -> NodeWindow {
    NodeWindow {
        corner: corniche_geom::NodeIndex { i: plan.south_west.i, j: plan.north_east.j },
        stride: 1,
        columns: (plan.north_east.i - plan.south_west.i + 1) as usize,
        rows: (plan.north_east.j - plan.south_west.j + 1) as usize,
    }
}

/// All samples that have a height, area by area.
pub(crate) fn sample_blocks(dem: &Dem, plan: &GridPlan) -> Vec<SampleBlock> {
    let mut reader = dem.reader(plan);
    dem.sample_ranges(plan).unwrap().iter().map(|range| reader.samples(range).unwrap()).collect()
}

/// Compares every node with `truth` at its position; returns the number of nodes with a height.
pub(crate) fn check(
    reader: &mut HeightReader<'_>,
    plan: &GridPlan,
    tolerance_m: f64,
    truth: impl Fn([f64; 2]) -> f64,
) -> usize {
    let window = all(plan);
    let heights = reader.window(window).unwrap().heights;
    let mut count = 0;
    for row in 0..window.rows {
        for column in 0..window.columns {
            let Some(height_m) = heights.height(column, row) else { continue };
            let node = window.node(column, row);
            let at = [plan.frame.x_m(node.i), plan.frame.y_m(node.j)];
            let truth_m = truth(at);
            assert!(
                (f64::from(height_m) - truth_m).abs() <= tolerance_m,
                "{height_m} at {at:?}, not {truth_m}"
            );
            count += 1;
        }
    }
    count
}
