//! Railways, as far as bridges and tunnels depend on them: which ways they are, and how steep they
//! are built.

use serde::{Deserialize, Serialize};

use crate::frc_table::{is_area, tag};

crate::listed! {
    /// A kind of railway that is in use.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Railway {
        /// A railway of standard or broad gauge.
        Rail = 4.0,
        /// A narrow-gauge railway.
        NarrowGauge = 7.0,
        /// A light railway, a subway or a monorail.
        Light = 6.0,
        /// A tram.
        Tram = 10.0,
        /// A rack railway or a funicular.
        Steep = 100.0,
    }

    /// Returns the steepest grade with which such railways are built, percent.
    ///
    /// Source: Eisenbahn-Bau- und Betriebsordnung (EBO, Germany), section 7, which allows 1.25 % on
    /// new main lines and 4 % on branch lines. The other limits are grades of existing railways:
    /// the Bernina line without a rack has 7 %, trams in several cities have 10 %. A railway that
    /// is steeper is worth a check, but is not an error.
    pub fn steepest_pct() -> f64;
}

impl Railway {
    /// Returns the kind of railway of a way with these `(key, value)` tags; `None` for all other
    /// ways, also for railways that are planned, being built, disused or removed, and for areas.
    ///
    /// Source: OSM wiki, *Key:railway*, *Key:rack*.
    #[must_use]
    pub fn from_tags(tags: &[(&str, &str)]) -> Option<Self> {
        let value = |key| tag(tags, key).unwrap_or_default().trim();
        let kind = match value("railway") {
            "rail" | "preserved" => Self::Rail,
            "narrow_gauge" => Self::NarrowGauge,
            "light_rail" | "subway" | "monorail" => Self::Light,
            "tram" => Self::Tram,
            "funicular" => Self::Steep,
            _ => return None,
        };
        if is_area(tags) {
            return None;
        }
        Some(if matches!(value("rack"), "" | "no") { kind } else { Self::Steep })
    }
}

#[cfg(test)]
#[path = "railway_tests.rs"]
mod tests;
