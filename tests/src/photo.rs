//! The sample `pass` with artificial photos.

#![allow(clippy::unwrap_used, reason = "what is not there ends the test")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::ColourImage;

use crate::{Ran, build_pass, corniche, manifest, sample, text};

/// The colour of [`photo`] at a longitude and latitude; `bounds_deg` are west, south, east and
/// north of the sample.
#[must_use]
pub fn colour([lon, lat]: [f64; 2], [west, south, east, north]: [f64; 4]) -> [u8; 3] {
    let (u, v) = ((lon - west) / (east - west), (lat - south) / (north - south));
    let wave = |t: f64| (127.0 + 100.0 * (t * 40.0).sin()) as u8;
    [wave(u), wave(v), wave(u + v)]
}

/// A photo over the centre of the sample `pass`, in degrees; the sample is in UTM zone 32. Its
/// colours change over several cells.
///
/// # Panics
/// When the sample cannot be built, or the photo not be written.
#[must_use]
pub fn photo(folder: &Path, west: f64, name: &str) -> PathBuf {
    let plain = manifest(&pass(folder));
    let bounds = &plain["wgs84_bounds"];
    let at = |key: &str| bounds[key].as_f64().unwrap();
    let (min_x, max_x, min_y, max_y) = (at("min_x"), at("max_x"), at("min_y"), at("max_y"));
    let (width, height) = (max_x - min_x, max_y - min_y);
    let value = |at: [f64; 2]| colour(at, [min_x, min_y, max_x, max_y]).to_vec();
    let size = 900;
    let (left, top) = (min_x + west * width, max_y - 0.21 * height);
    let step = [0.5 * width / f64::from(size), 0.55 * height / f64::from(size)];
    ColourImage {
        epsg: 4326,
        size: [size as usize; 2],
        transform: [left, step[0], 0.0, top, 0.0, -step[1]],
        value: &value,
        interpretations: &ColourImage::RGB,
    }
    .write(folder, name, |_| {})
}

/// The sample without photos, built once per folder.
///
/// # Panics
/// When the sample cannot be built.
#[must_use]
pub fn pass(folder: &Path) -> PathBuf {
    let package = folder.join("plain.pmtiles");
    if !package.exists() {
        build_pass(&package, &["--max-error", "10"]);
    }
    package
}

/// Returns a run that must have succeeded.
///
/// # Panics
/// When the run failed.
#[expect(clippy::must_use_candidate, reason = "most runs are made for what they do")]
pub fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// The inputs and settings of the sample with photos.
#[must_use]
pub fn inputs(photos: &[&Path]) -> Vec<String> {
    let dem = sample("pass/pass-dem.tif");
    of_ground(&["--dem", text(&dem), "--max-error", "10"], photos)
}

/// The same inputs with other options for the ground.
#[must_use]
pub fn of_ground(ground: &[&str], photos: &[&Path]) -> Vec<String> {
    let osm = sample("pass/pass.osm.pbf");
    let mut inputs = ground.to_vec();
    inputs.extend(["--osm", text(&osm), "--photo"]);
    inputs.extend(photos.iter().map(|photo| text(photo)));
    inputs.extend(["--photo-levels", "1", "--photo-attribution", "Photos: nobody"]);
    inputs.into_iter().map(str::to_owned).collect()
}

/// Builds a package and reads it.
///
/// # Panics
/// When the build fails.
#[must_use]
pub fn build(inputs: &[String], package: &Path, more: &[&str]) -> Vec<u8> {
    let words = ["build", "-q", "-o", text(package)].into_iter().map(str::to_owned);
    let more = more.iter().map(|&word| word.to_owned());
    succeed(corniche(words.chain(inputs.iter().cloned()).chain(more)));
    fs::read(package).unwrap()
}
