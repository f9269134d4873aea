//! The steepest grade with which roads of each kind are built.

/// The additional grade that a slip road may have, percent.
const LINK_MORE_PCT: f64 = 2.0;

/// Returns the steepest grade by OSM's `highway`, percent; `None` for ways that are not roads for
/// cars.
///
/// Source: limits that proved right on seven regions when bridges and grades were tested for this
/// program. They are in the order of magnitude of design guides for difficult terrain, such as
/// AASHTO, *A Policy on Geometric Design of Highways and Streets*, 2018, chapters 5 to 8. Steeper
/// roads exist: a grade above its limit is worth a check, but is not an error.
#[must_use]
pub fn grade_limit(highway: &str) -> Option<f64> {
    if let Some(of_link) = highway.strip_suffix("_link") {
        return grade_limit(of_link).map(|limit| limit + LINK_MORE_PCT);
    }
    match highway {
        "motorway" => Some(6.0),
        "trunk" => Some(7.0),
        "primary" => Some(10.0),
        "secondary" | "tertiary" => Some(12.0),
        "residential" | "unclassified" | "living_street" => Some(15.0),
        "service" => Some(20.0),
        _ => None,
    }
}
