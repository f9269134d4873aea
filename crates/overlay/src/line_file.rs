use std::{fs, io::Read as _, path::Path};

use serde_json::{Map, Value, json};

use crate::OverlayError;

/// Far more than a person draws.
const MOST_BYTES: u64 = 256 << 20;

/// A file of lines that a person draws, as GeoJSON (RFC 7946). Features that are no lines, and all properties, are kept as they are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LineFile {
    /// What the collection has beside its features.
    members: Map<String, Value>,
    features: Vec<Value>,
}

/// A line as it is saved.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedLine {
    /// Which feature of the file it comes from.
    pub feature: Option<usize>,
    /// Longitude and latitude, WGS84.
    pub points_deg: Vec<[f64; 2]>,
    /// Of each point, above the ellipsoid, metres; `None` if they are not known.
    pub heights_m: Option<Vec<f64>>,
}

impl LineFile {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read or is no GeoJSON.
    pub fn read(path: &Path) -> Result<Self, OverlayError> {
        let failed = |source| OverlayError::Read { path: path.to_path_buf(), source };
        if !fs::metadata(path).map_err(failed)?.is_file() {
            return Err(OverlayError::Stream { path: path.to_path_buf() });
        }
        let mut text = String::new();
        let file = fs::File::open(path).map_err(failed)?;
        file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(failed)?;
        if text.len() as u64 > MOST_BYTES {
            return Err(OverlayError::TooLarge { path: path.to_path_buf(), limit: MOST_BYTES });
        }
        Self::parse(&text)
            .map_err(|reason| OverlayError::GeoJson { path: path.to_path_buf(), reason })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let whole: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let Value::Object(mut members) = whole else { return Err("it is no object".to_owned()) };
        if let Some(crs) = members.get("crs").filter(|crs| !crs.is_null()) {
            let name = crs.pointer("/properties/name").and_then(Value::as_str).unwrap_or("");
            if !(name.ends_with("CRS84") || name.ends_with("EPSG::4326") || name == "EPSG:4326") {
                return Err(format!(
                    "its coordinates are in {name:?}; they must be longitude and latitude of WGS84 (ogr2ogr -t_srs EPSG:4326)"
                ));
            }
        }
        match members.get("type").and_then(Value::as_str) {
            Some("FeatureCollection") => match members.remove("features") {
                Some(Value::Array(features)) => Ok(Self { members, features }),
                _ => Err("its collection has no features".to_owned()),
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

    /// All features that are one line each, with their numbers. Longitude and latitude of each point.
    #[must_use]
    pub fn lines(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let lines = self.features.iter().enumerate();
        lines.filter_map(|(number, feature)| Some((number, line_of(feature)?))).collect()
    }

    /// How many features are not such lines.
    #[must_use]
    pub fn others(&self) -> usize {
        self.features.iter().filter(|feature| line_of(feature).is_none()).count()
    }

    /// The text of a file with these lines in the place of those that this one has. A line whose points are as they were stays as it is,
    /// heights included. Lines with one point are left out: they are no lines.
    #[must_use]
    pub fn text_with(&self, lines: &[SavedLine]) -> String {
        let known = |number: usize| lines.iter().find(|line| line.feature == Some(number));
        let old = self.features.iter().enumerate().filter_map(|(number, feature)| {
            match (line_of(feature), known(number)) {
                (None, _) => Some(feature.clone()),
                (Some(points), Some(line)) if points == line.points_deg => Some(feature.clone()),
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
        // A line for each feature, so that people and version control can read it.
        format!("{{{},\"features\":[\n{}\n]}}\n", members.join(","), features.join(",\n"))
    }
}

/// The points of a feature that is one line with valid positions.
fn line_of(feature: &Value) -> Option<Vec<[f64; 2]>> {
    let geometry = feature.get("geometry")?;
    if geometry.get("type")?.as_str()? != "LineString" {
        return None;
    }
    let positions = geometry.get("coordinates")?.as_array()?;
    let position = |position: &Value| {
        let at = |axis: usize| position.get(axis)?.as_f64().filter(|value| value.is_finite());
        Some([at(0)?, at(1)?])
    };
    let points: Option<Vec<[f64; 2]>> = positions.iter().map(position).collect();
    points.filter(|points| points.len() >= 2)
}

/// A feature with another line; `None` if that has only one point.
fn changed(feature: &Value, line: &SavedLine) -> Option<Value> {
    if line.points_deg.len() < 2 {
        return None;
    }
    // Positions that stay keep all that was known of them.
    let old = feature.pointer("/geometry/coordinates").and_then(Value::as_array);
    let old: Vec<([f64; 2], &Value)> = old
        .into_iter()
        .flatten()
        .filter_map(|position| {
            Some(([position.get(0)?.as_f64()?, position.get(1)?.as_f64()?], position))
        })
        .collect();
    let kept = |point: [f64; 2]| {
        let same = |at: [f64; 2]| at.map(f64::to_bits) == point.map(f64::to_bits);
        old.iter().find(|(at, _)| same(*at)).map(|(_, position)| (*position).clone())
    };
    let coordinates: Vec<Value> = line
        .points_deg
        .iter()
        .enumerate()
        .map(|(index, &point)| {
            let height_m = line.heights_m.as_ref().and_then(|heights_m| heights_m.get(index));
            let [lon, lat] = point;
            kept(point).unwrap_or_else(|| match height_m {
                // Heights to the millimetre.
                Some(height_m) => json!([lon, lat, (height_m * 1e3).round() / 1e3]),
                None => json!([lon, lat]),
            })
        })
        .collect();
    let mut feature = feature.clone();
    feature["geometry"] = json!({"type": "LineString", "coordinates": coordinates});
    if let Some(members) = feature.as_object_mut() {
        members.remove("bbox");
    }
    Some(feature)
}

#[cfg(test)]
#[path = "line_file_tests.rs"]
mod tests;
