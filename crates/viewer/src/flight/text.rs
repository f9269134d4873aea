//! Reads and writes flights as text, in the coordinates of a CRS.

use corniche_geom::CoordinateTable;
use corniche_tileset::Manifest;
use serde::{Deserialize, Serialize};

use super::{Flight, FlightError, Keyframe, Pose};
use crate::camera::Orientation;

/// How x and y of a package are defined: coordinates of a CRS times factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkingCrs<'a> {
    /// Name of the CRS, as in packages.
    pub crs: &'a str,
    /// Working metres for one unit of its coordinates, east and north.
    pub metres_per_unit: [f64; 2],
}

impl<'a> WorkingCrs<'a> {
    /// The working CRS of a package.
    #[must_use]
    pub fn from_manifest(manifest: &'a Manifest) -> Self {
        Self { crs: &manifest.crs, metres_per_unit: manifest.metres_per_unit }
    }
}

impl Flight {
    /// Parses the text of a flight, as described at the top of [`flight`](crate::flight). `working`
    /// and `coordinates` belong to the package.
    ///
    /// If the text has other factors for the same CRS, its metres are converted: divided by its
    /// factors and multiplied by the package's factors.
    ///
    /// # Errors
    /// When the text is not a valid flight or has impossible values; the message names the line or
    /// the keyframe. When the flight is for a package in another CRS.
    pub fn parse(
        text: &str,
        working: WorkingCrs<'_>,
        coordinates: &CoordinateTable,
    ) -> Result<Self, FlightError> {
        let record = toml::from_str(text)
            .map_err(|error| FlightError::Syntax { message: error.to_string() })?;
        Self::of_record(&record, working, coordinates)
    }

    /// Does the same as [`Self::parse`] for a text that was parsed already.
    ///
    /// # Errors
    /// When the record has impossible values, or is for a package in another CRS.
    pub fn of_record(
        file: &FlightRecord,
        working: WorkingCrs<'_>,
        coordinates: &CoordinateTable,
    ) -> Result<Self, FlightError> {
        if let Some(flight) = file.crs.as_ref().filter(|known| *known != working.crs)
            && file.keyframe.iter().any(|record| record.x_m.is_some())
        {
            return Err(FlightError::OtherCrs {
                flight: flight.clone(),
                package: working.crs.to_owned(),
            });
        }
        let factors = file.metres_per_unit.unwrap_or(working.metres_per_unit);
        if factors.iter().any(|factor| !factor.is_normal()) {
            return Err(FlightError::Factors { factors });
        }
        // Exactly 1 if both have the same factors.
        let carry = [0, 1].map(|axis| working.metres_per_unit[axis] / factors[axis]);
        let keyframes: Result<Vec<Keyframe>, FlightError> = file
            .keyframe
            .iter()
            .zip(1..)
            .map(|(record, number)| record.place(number, carry, coordinates))
            .collect();
        Self::new(&keyframes?)
    }

    /// Formats this flight as text, in the working metres of a package: [`Self::parse`] reads back
    /// the same flight.
    ///
    /// # Errors
    /// Never for a flight that this crate created; the function that writes TOML returns a
    /// `Result`.
    pub fn to_text(&self, working: WorkingCrs<'_>) -> Result<String, FlightError> {
        toml::to_string(&self.record(working))
            .map_err(|error| FlightError::Syntax { message: error.to_string() })
    }

    /// Returns the contents of the text of this flight, in the working metres of a package.
    #[must_use]
    pub fn record(&self, working: WorkingCrs<'_>) -> FlightRecord {
        let keyframe = self.keyframes().map(|Keyframe { time_s, pose }| {
            let [x, y, height_m] = pose.eye_m;
            KeyframeRecord {
                time_s,
                lon_deg: None,
                lat_deg: None,
                x_m: Some(x),
                y_m: Some(y),
                height_m,
                heading_deg: pose.orientation.heading_deg,
                pitch_deg: pose.orientation.pitch_deg,
            }
        });
        FlightRecord {
            crs: Some(working.crs.to_owned()),
            metres_per_unit: Some(working.metres_per_unit),
            keyframe: keyframe.collect(),
        }
    }
}

/// The contents of the text of a flight, as described at the top of [`flight`](crate::flight).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightRecord {
    #[serde(skip_serializing_if = "Option::is_none")]
    crs: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    metres_per_unit: Option<[f64; 2]>,
    keyframe: Vec<KeyframeRecord>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyframeRecord {
    time_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    lon_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lat_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    x_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    y_m: Option<f64>,
    height_m: f64,
    heading_deg: f64,
    pitch_deg: f64,
}

impl KeyframeRecord {
    /// Returns the keyframe with x and y multiplied by `carry`.
    fn place(
        &self,
        number: usize,
        carry: [f64; 2],
        coordinates: &CoordinateTable,
    ) -> Result<Keyframe, FlightError> {
        let [x, y] = match (self.lon_deg, self.lat_deg, self.x_m, self.y_m) {
            (None, None, Some(x), Some(y)) => [x * carry[0], y * carry[1]],
            (Some(lon_deg), Some(lat_deg), None, None) => {
                for (name, value, most, range) in [
                    ("lon_deg", lon_deg, 360.0, "within ±360 degrees"),
                    ("lat_deg", lat_deg, 90.0, "within ±90 degrees"),
                ] {
                    // This form also rejects NaN.
                    if !(-most..=most).contains(&value) {
                        return Err(FlightError::Range { number, name, value, range });
                    }
                }
                coordinates
                    .working_from_wgs84([lon_deg, lat_deg])
                    .ok_or(FlightError::FarOutside { number, lon_deg, lat_deg })?
            }
            _ => return Err(FlightError::Place { number }),
        };
        let orientation = Orientation { heading_deg: self.heading_deg, pitch_deg: self.pitch_deg };
        Ok(Keyframe {
            time_s: self.time_s,
            pose: Pose { eye_m: [x, y, self.height_m], orientation },
        })
    }
}
