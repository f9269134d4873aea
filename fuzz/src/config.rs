//! TOML texts of any bytes are read or rejected: settings files, tables of roads and of layers,
//! styles.

use corniche_presets::{Config, class_filter, parse_frc_table, parse_layer_table};
use corniche_styles::parse_style;

/// Reads or rejects these bytes as a settings file, and as a table of roads or of a layer; whatever
/// is read is valid.
///
/// # Panics
/// When a reader breaks a promise.
pub fn settings(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Config::parse(text) {
        Ok(config) => {
            if let Some(cells) = &config.roads.class_max_cell
                && let Ok(filter) = class_filter(cells)
            {
                // A filter is monotonic: the coarsest cell never grows from one class to the next.
                let cells = filter.class_max_cell_m().map(|cell_m| cell_m.unwrap_or(f64::INFINITY));
                assert!(cells.is_sorted_by(|a, b| a >= b), "{cells:?}");
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    match parse_frc_table(text) {
        Ok(table) => {
            let again = corniche_roads::Classified::NotARoad(corniche_roads::NotARoad::NoHighway);
            assert_eq!(table.classify(&[]), again, "a way without tags is not a road");
            assert!(!table.name().is_empty() && !table.canonical_text().is_empty());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    match parse_layer_table(text) {
        Ok(table) => {
            assert_eq!(table.classify(&[]), None, "an object without tags has no class");
            assert!(!table.id().is_empty() && !table.classes().is_empty());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Reads or rejects these bytes as a style; a style has no number that a shader cannot use.
///
/// # Panics
/// When a reader breaks a promise.
pub fn styles(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match parse_style(text) {
        Ok(style) => {
            // The shaders divide by these values.
            assert!(style.width_scaling.threshold_m >= 1.0 && style.haze_reach > 0.0);
            let stops = style.tint.stops_m([0.0, 100.0], 47.0);
            assert!(stops.is_sorted_by(|(a, _), (b, _)| a < b), "{stops:?}");
            if let Some(lane_m) = style.own_widths.and_then(|widths| widths.lane_m) {
                assert!((1.0..=10.0).contains(&lane_m), "{lane_m}");
            }
            for road in style.roads {
                assert!(road.width_m > 0.0 && road.min_width_px > 0.0, "{road:?}");
                assert!(road.width_m.is_finite() && road.min_width_px.is_finite(), "{road:?}");
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
