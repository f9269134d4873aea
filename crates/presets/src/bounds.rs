//! The bounds of the converted region, as text and as a setting.

use serde::{Deserialize, Deserializer};

/// The region of the inputs that is converted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BoundsChoice {
    /// The region between west, south, east and north, WGS84 degrees; across ±180° if west > east.
    Degrees([f64; 4]),
    /// The bounding box in the extract's header, with a margin.
    Osm,
}

/// The advice at the end of an error.
const ADVICE: &str = "write west,south,east,north in degrees, like 9.4,47.0,9.7,47.3, or osm";

/// Parses the four numbers of `W,S,E,N`; `None` if they are not four numbers.
fn parse_degrees(text: &str) -> Option<[f64; 4]> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

impl BoundsChoice {
    /// Parses `W,S,E,N` or `osm`.
    ///
    /// # Errors
    /// When it is neither, or not a rectangle on the earth.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim() == "osm" {
            return Ok(Self::Osm);
        }
        parse_degrees(text).map_or_else(|| Err(ADVICE.to_owned()), Self::from_degrees)
    }

    fn from_degrees(bounds_deg: [f64; 4]) -> Result<Self, String> {
        let [west, south, east, north] = bounds_deg;
        let is_longitude = |deg: &f64| (-180.0..=180.0).contains(deg);
        if ![west, east].iter().all(is_longitude) {
            return Err(format!("longitudes must be between -180 and 180 degrees; {ADVICE}"));
        }
        if !(-90.0..=90.0).contains(&south) || !(-90.0..=90.0).contains(&north) || south >= north {
            return Err(format!(
                "south must be less than north, and both between -90 and 90 degrees; {ADVICE}"
            ));
        }
        if west > east && west - east < 180.0 {
            return Err(format!(
                "west is greater than east, which means a region across 180 degrees of longitude: all but {:.5} degrees of the earth; \
                 if the two are swapped, use {east},{south},{west},{north}",
                west - east
            ));
        }
        if west.to_bits() == east.to_bits() {
            return Err(format!("west and east are equal; {ADVICE}"));
        }
        Ok(Self::Degrees(bounds_deg))
    }
}

impl From<BoundsChoice> for Option<[f64; 4]> {
    /// The degrees; `None` if they must be read from the extract.
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
        enum WrittenBounds {
            Degrees([f64; 4]),
            Text(String),
        }
        let read = match WrittenBounds::deserialize(deserializer)? {
            WrittenBounds::Degrees(bounds_deg) => Self::from_degrees(bounds_deg),
            WrittenBounds::Text(text) => Self::parse(&text),
        };
        read.map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
#[path = "bounds_tests.rs"]
mod tests;
