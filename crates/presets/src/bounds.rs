//! The bounds of what is converted, as text and as a setting.

use serde::{Deserialize, Deserializer};

/// What of the inputs is converted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BoundsChoice {
    /// What lies between west, south, east and north, WGS84 degrees; across ±180° where the west is larger than the east.
    Degrees([f64; 4]),
    /// The box in the extract's header, with a margin.
    Osm,
}

/// What to write.
const ADVICE: &str = "write west,south,east,north in degrees, like 9.4,47.0,9.7,47.3, or osm";

/// Reads the four numbers of `W,S,E,N`; `None` where they are not four numbers.
fn parse_degrees(text: &str) -> Option<[f64; 4]> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

impl BoundsChoice {
    /// Reads `W,S,E,N` or `osm`.
    ///
    /// # Errors
    /// When it is neither, or no rectangle on earth.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim() == "osm" {
            return Ok(Self::Osm);
        }
        parse_degrees(text).map_or_else(|| Err(ADVICE.to_owned()), Self::of)
    }

    fn of(bounds_deg: [f64; 4]) -> Result<Self, String> {
        let [west, south, east, north] = bounds_deg;
        let is_longitude = |deg: &f64| (-180.0..=180.0).contains(deg);
        if ![west, east].iter().all(is_longitude) {
            return Err(format!("longitudes lie between -180 and 180 degrees; {ADVICE}"));
        }
        if !(-90.0..=90.0).contains(&south) || !(-90.0..=90.0).contains(&north) || south >= north {
            return Err(format!(
                "the south must be less than the north, both between -90 and 90 degrees; {ADVICE}"
            ));
        }
        if west > east && west - east < 180.0 {
            return Err(format!(
                "the west is larger than the east, which means across 180 degrees of longitude: all but {:.5} degrees of the earth; \
                 if the two are exchanged, give {east},{south},{west},{north}",
                west - east
            ));
        }
        if west.to_bits() == east.to_bits() {
            return Err(format!("the west and the east are the same; {ADVICE}"));
        }
        Ok(Self::Degrees(bounds_deg))
    }
}

impl From<BoundsChoice> for Option<[f64; 4]> {
    /// The degrees; `None` where the extract has yet to tell them.
    fn from(choice: BoundsChoice) -> Self {
        match choice {
            BoundsChoice::Degrees(bounds_deg) => Some(bounds_deg),
            BoundsChoice::Osm => None,
        }
    }
}

impl<'de> Deserialize<'de> for BoundsChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "expected [west, south, east, north] or \"osm\"")]
        enum Written {
            Degrees([f64; 4]),
            Text(String),
        }
        let read = match Written::deserialize(deserializer)? {
            Written::Degrees(bounds_deg) => Self::of(bounds_deg),
            Written::Text(text) => Self::parse(&text),
        };
        read.map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod tests;
