//! The paths of sample data and real data.

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_geom::HeightGrid;

use crate::skip;

/// The root of the repository.
#[must_use]
pub fn root() -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    crates.and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default()
}

/// Returns the path of a bundled sample, such as `pass/pass-dem.tif`.
#[must_use]
pub fn sample(path: &str) -> PathBuf {
    root().join("data-samples").join(path)
}

/// Returns the path of a file of the real data, which are not part of the repository: in the folder
/// that `CORNICHE_DATA` names, else in `../shared/data`. If the file does not exist, the result is
/// `None`, and the test counts as skipped.
#[must_use]
pub fn real_data(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("CORNICHE_DATA").map_or_else(
        || root().parent().map(|up| up.join("shared/data")).unwrap_or_default(),
        PathBuf::from,
    );
    let file = folder.join(path);
    if file.exists() {
        return Some(file);
    }
    eprintln!("{} is missing; set CORNICHE_DATA to a folder that contains it", file.display());
    skip(&format!("need {} that are not in the repository", kind_of(path)));
    None
}

/// Describes the kind of data of a file, for users who do not have it.
fn kind_of(path: &str) -> &'static str {
    let name = path.to_lowercase();
    let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    if name.starts_with("cases/") {
        "small cases of public bug reports"
    } else if ends(&[".pbf"]) {
        "extracts"
    } else if name.contains("rgb") || ends(&[".jpg", ".jp2"]) {
        "photos"
    } else {
        "elevation files"
    }
}

/// Reads 259 × 259 samples (a tile with a halo of one node) from an SRTM file of 1201 × 1201
/// samples, beginning at `column` and `row`; voids are NaN. Returns `None` without the data, like
/// [`real_data`].
#[must_use]
pub fn srtm_heights(path: &str, column: usize, row: usize) -> Option<HeightGrid> {
    let bytes = fs::read(real_data(path)?).ok()?;
    Some(HeightGrid::from_fn(259, 259, |c, r| {
        let at = 2 * ((row + r) * 1201 + column + c);
        let height_m = i16::from_be_bytes([bytes[at], bytes[at + 1]]);
        if height_m == i16::MIN { f32::NAN } else { f32::from(height_m) }
    }))
}

#[cfg(test)]
#[path = "data_tests.rs"]
mod tests;
