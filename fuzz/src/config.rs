use corniche_presets::{Config, class_filter, parse_frc_table};

/// A settings file and an FRC table of these bytes are read or refused; what is read keeps its own promises.
///
/// # Panics
/// When a promise is broken.
pub fn config(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Config::parse(text) {
        Ok(config) => {
            if let Some(cells) = &config.roads.class_max_cell
                && let Ok(filter) = class_filter(cells)
            {
                // A filter is monotonic: the coarsest cell never grows from a class to the next.
                let cells = filter.class_max_cell_m().map(|cell_m| cell_m.unwrap_or(f64::INFINITY));
                assert!(cells.is_sorted_by(|a, b| a >= b), "{cells:?}");
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    match parse_frc_table(text) {
        Ok(table) => {
            let again = corniche_roads::Classified::NotARoad(corniche_roads::NotARoad::NoHighway);
            assert_eq!(table.classify(&[]), again, "no tag, no road");
            assert!(!table.name().is_empty() && !table.canonical_text().is_empty());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
