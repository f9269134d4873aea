//! How far the heights of a level may be from the elevation data, in words, as the package has it stored.

use corniche_tileset::Manifest;

/// How far a level is from the elevation data at its samples, at most, metres. The stored bound holds at the nodes of the finest grid. Where these
/// are no samples, samples may be farther off, and the largest distance that was measured counts.
pub(crate) fn sample_bound_m(manifest: &Manifest, level: u8) -> f64 {
    let record = manifest.levels.get(usize::from(level));
    record.map_or(0.0, |record| record.geometric_error_m.max(record.sample_error.max_m))
}

/// The same as a whole sentence; `None` where the package has no such level.
pub(crate) fn height_bound(manifest: &Manifest, level: u8) -> Option<String> {
    let _known = manifest.levels.get(usize::from(level))?;
    // Never less than it is, but not a centimetre more for rounding.
    let bound_m = (sample_bound_m(manifest, level) * 100.0 - 1e-6).ceil() / 100.0;
    Some(format!("Heights are within {bound_m} m of the elevation data, at its samples."))
}

/// The same of lines on the elevation files themselves, and on decks.
pub(crate) fn dem_heights(tolerance_m: f64, has_decks: bool) -> String {
    let tolerance_m = (tolerance_m * 1000.0 - 1e-6).ceil() / 1000.0;
    let decks = if has_decks { " Those of bridges and tunnels are estimates." } else { "" };
    format!("Heights are within {tolerance_m} m of the elevation data, over the whole line.{decks}")
}
