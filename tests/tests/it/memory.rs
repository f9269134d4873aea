//! Threads and memory change no byte, and `--memory` bounds the process.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::PathBuf;

use corniche_testing::{ColourImage, Raster};
use e2e::{Job, real_data, text};

/// A DEM of `side` × `side` samples, in tiles: hills, a plain, and a lake without heights. Around
/// the roads of the sample `pass`.
fn large_dem(folder: &std::path::Path, side: usize) -> PathBuf {
    let place = [520_000.0, 10.0, 0.0, 5_215_000.0, 0.0, -10.0];
    let raster = Raster::new(32632, [side; 2], place).nodata(-9999.0);
    let raster = raster.created(&["TILED=YES", "COMPRESS=DEFLATE"]);
    raster.write(folder, "large.tif", |[x, y]| {
        let (east, north) = ((x - 520_000.0) / 10.0, (5_215_000.0 - y) / 10.0);
        let is_lake = (east - 300.0).hypot(north - 300.0) < 90.0;
        let hills = (east * 0.021).sin() * (north * 0.017).cos() + (east * 0.003).sin();
        if is_lake { -9999.0_f32 } else { (900.0 + 150.0 * hills) as f32 }
    })
}

#[test]
fn threads_and_memory_change_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = [large_dem(folder.path(), 2600), e2e::sample("pass/pass.osm.pbf")];
    let build = |options: &[&str]| {
        let job = Job::new(options).with_inputs(inputs.clone());
        job.succeed(&["--quiet", "--max-error", "20", "--force"]);
        job.result()
    };
    let first = build(&["--threads", "1", "--memory", "256M"]);
    for options in [
        ["--threads", "1", "--memory", "4G"],
        ["--threads", "2", "--memory", "256M"],
        ["--threads", "8", "--memory", "4G"],
    ] {
        assert!(build(&options) == first, "{options:?}: other bytes");
    }
}

/// The peak resident memory of a build, bytes, as the kernel reports it while the build runs.
#[cfg(target_os = "linux")]
fn peak_bytes(job: &Job, more: &[&str]) -> u64 {
    let mut child = job.start(&[&["--quiet"], more].concat());
    let (ran, costs) = e2e::ended_with_costs(&mut child);
    assert_eq!(ran.code, 0, "{}", ran.err);
    costs.peak_bytes
}

/// 256 MiB suffice for four threads, whatever the size of the DEM: here 27 million nodes, whose
/// heights alone need 108 MB.
#[cfg(target_os = "linux")]
#[test]
fn a_build_stays_within_its_memory() {
    let folder = tempfile::tempdir().unwrap();
    let dem = large_dem(folder.path(), 5200);
    let options = ["--max-error", "20", "--threads", "4", "--memory", "256M"];
    let job = Job::new(&options).with_inputs([dem, e2e::sample("pass/pass.osm.pbf")]);
    let peak = peak_bytes(&job, &[]);
    assert!((20 << 20..=256 << 20).contains(&peak), "{} MiB", peak >> 20);
}

/// The same applies to photos: 36 million pixels of three bands, which need 108 MB.
#[cfg(target_os = "linux")]
#[test]
fn a_build_with_photos_stays_within_its_memory() {
    let folder = tempfile::tempdir().unwrap();
    let dem = large_dem(folder.path(), 3600);
    let colour =
        |[x, y]: [f64; 2]| vec![(x / 90.0) as u8, (y / 70.0) as u8, ((x + y) / 50.0) as u8];
    let photo = ColourImage {
        epsg: 32632,
        size: [6000; 2],
        transform: [521_000.0, 5.5, 0.0, 5_214_000.0, 0.0, -5.5],
        value: &colour,
        interpretations: &ColourImage::RGB,
    };
    let photo = photo.write(folder.path(), "photo.tif", |_| {});
    let options = ["--max-error", "20", "--threads", "4", "--memory", "288M"];
    let job = Job::new(&options).with_inputs([dem, e2e::sample("pass/pass.osm.pbf")]);
    let peak = peak_bytes(&job, &["--photo", text(&photo), "--photo-levels", "1"]);
    assert!((20 << 20..=288 << 20).contains(&peak), "{} MiB", peak >> 20);
    let photos = e2e::manifest(&job.package())["photos"].as_array().unwrap().len();
    assert!(photos > 2, "{photos} levels with photos");
}

/// A real extract with all its buildings: objects that are not roads need no memory either.
#[cfg(target_os = "linux")]
#[test]
fn a_build_with_a_real_extract_stays_within_its_memory() {
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let Some(osm) = real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf") else { return };
    let options = ["--threads", "4", "--memory", "256M"];
    let job = Job::new(&options).with_inputs([dem, osm]);
    let peak = peak_bytes(&job, &[]);
    assert!((20 << 20..=256 << 20).contains(&peak), "{} MiB", peak >> 20);
    assert!(text(&job.package()).ends_with("out.pmtiles") && job.package().exists());
}
