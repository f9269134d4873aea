//! The GeoJSON file of the lines and areas that a user draws: reads, changes and writes it.

use std::{fs, io::Read as _, path::Path};

use corniche_gis::{FileUse, VectorError};
use geo::{LineString, Winding as _};
use serde_json::{Map, Value, json};

use crate::{OverlayError, read::MOST_POINTS};

/// The largest file that is read: far more than a user draws.
const MOST_BYTES: u64 = 256 << 20;

/// A file of lines and areas that a user draws, as GeoJSON (RFC 7946). Other features and all
/// properties are preserved.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LineFile {
    /// The members of the collection, without its features.
    members: Map<String, Value>,
    features: Vec<Value>,
}

/// The shape of a line's points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum LineShape {
    /// A line.
    #[default]
    Line,
    /// The outline of an area without holes; the last point is followed by the first.
    Area,
}

/// A line to save.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedLine {
    /// The number of the feature of the file from which it comes.
    pub feature: Option<usize>,
    /// The shape of its points.
    pub shape: LineShape,
    /// Longitude and latitude, WGS84.
    pub points_deg: Vec<[f64; 2]>,
    /// The height of each point above the ellipsoid, metres; `None` if they are unknown.
    pub heights_m: Option<Vec<f64>>,
}

impl LineFile {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read or is not valid GeoJSON.
    pub fn read(path: &Path) -> Result<Self, OverlayError> {
        let failed = |source| OverlayError::Read { path: path.to_path_buf(), source };
        if !fs::metadata(path).map_err(failed)?.is_file() {
            let (kind, path) = (FileUse::Lines, path.to_path_buf());
            return Err(VectorError::Stream { kind, path }.into());
        }
        let mut text = String::new();
        let file = fs::File::open(path).map_err(failed)?;
        file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(failed)?;
        if text.len() as u64 > MOST_BYTES {
            return Err(OverlayError::TooLarge { path: path.to_path_buf(), limit: MOST_BYTES });
        }
        let file = Self::parse(&text)
            .map_err(|reason| OverlayError::GeoJson { path: path.to_path_buf(), reason })?;
        if file.lines().iter().map(|(_, _, points)| points.len()).sum::<usize>() > MOST_POINTS {
            let (path, limit) = (path.to_path_buf(), MOST_POINTS);
            return Err(OverlayError::TooManyPoints { path, limit });
        }
        Ok(file)
    }

    fn parse(text: &str) -> Result<Self, String> {
        // RFC 8259, section 8.1: a reader may ignore a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let whole: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let Value::Object(mut members) = whole else {
            return Err("its top level is not a JSON object".to_owned());
        };
        if let Some(crs) = members.get("crs").filter(|crs| !crs.is_null()) {
            let name = crs.pointer("/properties/name").and_then(Value::as_str).unwrap_or("");
            if !(name.ends_with("CRS84") || name.ends_with("EPSG::4326") || name == "EPSG:4326") {
                return Err(format!(
                    "its CRS is {name:?}; transform its coordinates to longitude and latitude of WGS84 (ogr2ogr -t_srs EPSG:4326)"
                ));
            }
        }
        match members.get("type").and_then(Value::as_str) {
            Some("FeatureCollection") => match members.remove("features") {
                Some(Value::Array(features)) => Ok(Self { members, features }),
                _ => Err("its FeatureCollection has no features".to_owned()),
            },
            Some("Feature") => {
                Ok(Self { features: vec![Value::Object(members)], ..Self::default() })
            }
            Some(_) if members.contains_key("coordinates") => {
                let feature = json!({"type": "Feature", "properties": {}, "geometry": members});
                Ok(Self { features: vec![feature], ..Self::default() })
            }
            _ => Err("it has no features".to_owned()),
        }
    }

    /// Returns all features that are one line, or one area without holes: their numbers, and
    /// longitude and latitude of each point.
    #[must_use]
    pub fn lines(&self) -> Vec<(usize, LineShape, Vec<[f64; 2]>)> {
        let features = self.features.iter().enumerate();
        let line =
            |(number, feature)| line_of(feature).map(|(shape, points)| (number, shape, points));
        features.filter_map(line).collect()
    }

    /// The number of other features.
    #[must_use]
    pub fn others(&self) -> usize {
        self.features.iter().filter(|feature| line_of(feature).is_none()).count()
    }

    /// Returns the text of this file with its lines replaced by the given ones. A line with
    /// unchanged points is unchanged, heights included. An area of two points becomes a line. Lines
    /// of one point are dropped.
    #[must_use]
    pub fn text_with(&self, lines: &[SavedLine]) -> String {
        let known = |number: usize| lines.iter().find(|line| line.feature == Some(number));
        let old = self.features.iter().enumerate().filter_map(|(number, feature)| {
            match (line_of(feature), known(number)) {
                (None, _) => Some(feature.clone()),
                (Some((shape, points)), Some(line))
                    if (shape, &points) == (line.shape, &line.points_deg) =>
                {
                    Some(feature.clone())
                }
                (Some(_), Some(line)) => changed(feature, line),
                (Some(_), None) => None,
            }
        });
        let new = lines.iter().filter(|line| line.feature.is_none()).filter_map(|line| {
            changed(&json!({"type": "Feature", "properties": {}, "geometry": null}), line)
        });
        let features: Vec<String> = old.chain(new).map(|feature| feature.to_string()).collect();
        let mut members: Vec<String> = vec![r#""type":"FeatureCollection""#.to_owned()];
        let others =
            self.members.iter().filter(|(name, _)| !["type", "bbox"].contains(&name.as_str()));
        members
            .extend(others.map(|(name, value)| format!("{}:{value}", Value::from(name.as_str()))));
        // One line per feature, which is readable for people and version control.
        format!("{{{},\"features\":[\n{}\n]}}\n", members.join(","), features.join(",\n"))
    }
}

/// Returns the points of a feature that is one line, or one area without holes, with valid
/// positions. An area's first point is not repeated at the end.
fn line_of(feature: &Value) -> Option<(LineShape, Vec<[f64; 2]>)> {
    let geometry = feature.get("geometry")?;
    let coordinates = geometry.get("coordinates")?.as_array()?;
    let (shape, positions) = match (geometry.get("type")?.as_str()?, &coordinates[..]) {
        ("LineString", positions) => (LineShape::Line, positions),
        ("Polygon", [ring]) => (LineShape::Area, ring.as_array()?.as_slice()),
        _ => return None,
    };
    let mut points = positions.iter().map(point_of).collect::<Option<Vec<_>>>()?;
    if shape == LineShape::Area && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let least = match shape {
        LineShape::Line => 2,
        LineShape::Area => 3,
    };
    (points.len() >= least).then_some((shape, points))
}

/// Returns longitude and latitude of a position.
fn point_of(position: &Value) -> Option<[f64; 2]> {
    let part = |index: usize| position.get(index)?.as_f64().filter(|value| value.is_finite());
    Some([part(0)?, part(1)?])
}

/// Returns a feature with its line replaced; `None` if the new line has only one point.
fn changed(feature: &Value, line: &SavedLine) -> Option<Value> {
    let shape = match line.points_deg.len() {
        0 | 1 => return None,
        // A corner was removed from a triangle.
        2 => LineShape::Line,
        _ => line.shape,
    };
    // Unchanged positions keep all their members.
    let geometry = feature.get("geometry");
    let path = match geometry.and_then(|geometry| geometry.get("type")).and_then(Value::as_str) {
        Some("Polygon") => "/coordinates/0",
        _ => "/coordinates",
    };
    let old = geometry.and_then(|geometry| geometry.pointer(path)).and_then(Value::as_array);
    let old: Vec<([f64; 2], &Value)> = old
        .into_iter()
        .flatten()
        .filter_map(|position| Some((point_of(position)?, position)))
        .collect();
    let kept = |point: [f64; 2]| {
        let same = |at: [f64; 2]| at.map(f64::to_bits) == point.map(f64::to_bits);
        old.iter().find(|(at, _)| same(*at)).map(|(_, position)| (*position).clone())
    };
    let mut coordinates: Vec<Value> = line
        .points_deg
        .iter()
        .enumerate()
        .map(|(index, &point)| {
            let height_m = line.heights_m.as_ref().and_then(|heights_m| heights_m.get(index));
            let [lon, lat] = point;
            kept(point).unwrap_or_else(|| match height_m {
                // Heights are rounded to the millimetre.
                Some(height_m) => json!([lon, lat, (height_m * 1e3).round() / 1e3]),
                None => json!([lon, lat]),
            })
        })
        .collect();
    let mut feature = feature.clone();
    feature["geometry"] = match shape {
        LineShape::Line => json!({"type": "LineString", "coordinates": coordinates}),
        LineShape::Area => {
            // Outer rings are counter-clockwise (RFC 7946, section 3.1.6).
            let ring = line.points_deg.iter().chain(line.points_deg.first()).copied();
            if ring.collect::<LineString>().is_cw() {
                coordinates.reverse();
            }
            coordinates.extend(coordinates.first().cloned());
            json!({"type": "Polygon", "coordinates": [coordinates]})
        }
    };
    if let Some(members) = feature.as_object_mut() {
        members.remove("bbox");
    }
    Some(feature)
}

#[cfg(test)]
#[path = "line_file_tests.rs"]
mod tests;
