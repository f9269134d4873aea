//! How far the heights of a level may be from the elevation data, in words, as the package has it stored.

use corniche_tileset::Manifest;

/// A whole sentence; `None` where the package has no such level. The stored bound holds at the nodes of the finest grid. Where these are no
/// samples, samples may be farther off, and the largest distance that was measured counts.
pub(crate) fn height_bound(manifest: &Manifest, level: u8) -> Option<String> {
    let record = manifest.levels.get(usize::from(level))?;
    let bound_m = record.geometric_error_m.max(record.sample_error.max_m);
    // Never less than it is, but not a centimetre more for rounding.
    let bound_m = (bound_m * 100.0 - 1e-6).ceil() / 100.0;
    Some(format!("Heights are within {bound_m} m of the elevation data, at its samples."))
}

/// The same of lines on the elevation files themselves, and on decks.
pub(crate) fn dem_heights(tolerance_m: f64, has_decks: bool) -> String {
    let tolerance_m = (tolerance_m * 1000.0 - 1e-6).ceil() / 1000.0;
    let decks = if has_decks { " Those of bridges and tunnels are estimates." } else { "" };
    format!(
        "Heights are those of the elevation data, within {tolerance_m} m between vertices.{decks}"
    )
}
