//! Reads lines from all layers of a vector file and transforms them to WGS84.

use std::{collections::HashSet, path::Path};

use corniche_geom::MOST_TILE_STEPS;
use corniche_gis::{
    CrsError, FileDatums, FileUse, ToWgs84, for_each_feature, forget, open_vectors,
};
use gdal::vector::{
    Feature, Geometry, Layer, LayerAccess, OGRwkbGeometryType, geometry_type_flatten,
};

use crate::OverlayError;

/// The work for a point of a line that crosses little ground (like a walker's track), in steps.
const STEPS_OF_POINT: u64 = 64;

/// The most points that the lines of a file may have, a million: as many as one tile can show,
/// since all may be on one tile.
pub const MOST_POINTS: usize = (MOST_TILE_STEPS / STEPS_OF_POINT) as usize;

/// A line of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorLine {
    /// The feature's `name`, if it has one.
    pub name: Option<String>,
    /// Longitude and latitude of each point, degrees of WGS84. NaN if a point cannot be
    /// transformed.
    pub positions_deg: Vec<[f64; 2]>,
}

/// The lines of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VectorLines {
    /// All lines, and the outlines of all polygons, ring by ring, in the order of the file.
    pub lines: Vec<VectorLine>,
    /// The number of other features, such as points.
    pub others: u64,
    /// The numbers of lines in routes, and of lines in tracks, in a GPX file that has both.
    pub routes_and_tracks: Option<[usize; 2]>,
    /// The operations by which positions were transformed to the datum of WGS84.
    pub datums: FileDatums,
}

impl VectorLines {
    /// Returns notices about properties of the file that the user may not expect: whole sentences
    /// without a full stop.
    #[must_use]
    pub fn notices(&self) -> Vec<String> {
        let mut notices = Vec::new();
        if self.others > 0 {
            notices.push(format!(
                "{} features are neither lines nor polygons and are skipped",
                self.others
            ));
        }
        if let Some([routes, tracks]) = self.routes_and_tracks {
            notices.push(format!(
                "it has routes ({routes}) and tracks ({tracks}), and both are read; programs often save one line as both, and the line then counts \
                 twice; keep only the tracks with ogr2ogr NEW.gpx OLD.gpx tracks"
            ));
        }
        let repeated = self.repeated();
        if repeated > 0 {
            notices
                .push(format!("{repeated} of its lines repeat an earlier line, and count again"));
        }
        notices
    }

    /// Counts the lines that have the positions of an earlier one, in the same or the reverse
    /// order.
    fn repeated(&self) -> usize {
        let mut known = HashSet::new();
        self.lines.iter().filter(|line| !known.insert(line.bits())).count()
    }
}

impl VectorLine {
    /// Returns the bits of the line's positions, the same for both directions.
    fn bits(&self) -> Vec<[u64; 2]> {
        let bits: Vec<_> = self.positions_deg.iter().map(|at| at.map(f64::to_bits)).collect();
        let back = bits.iter().rev().copied().collect();
        bits.min(back)
    }
}

/// Reads the lines of all layers of a vector file, each in its own coordinate system. With
/// `allow_ballpark`, PROJ's ballpark transformations (no datum shift) to WGS84 are allowed if PROJ
/// has no other.
///
/// # Errors
/// When GDAL cannot read the file or a part of it, when it has no line, or when a layer has no
/// coordinate system, or one with an unknown datum.
pub fn read(path: &Path, allow_ballpark: bool) -> Result<VectorLines, OverlayError> {
    let own = || path.to_path_buf();
    let dataset = open_vectors(path, FileUse::Lines)?;
    let is_gpx = dataset.driver().short_name() == "GPX";
    let mut reading = Reading { path, found: VectorLines::default(), points: 0, allow_ballpark };
    let [mut routes, mut tracks] = [0; 2];
    for mut layer in dataset.layers() {
        let name = layer.name();
        // GDAL repeats the points of GPX tracks and routes in separate layers.
        if is_gpx && ["track_points", "route_points"].contains(&name.as_str()) {
            continue;
        }
        let before = reading.found.lines.len();
        reading.layer(&mut layer)?;
        match name.as_str() {
            "routes" => routes += reading.found.lines.len() - before,
            "tracks" => tracks += reading.found.lines.len() - before,
            _ => {}
        }
    }
    let mut found = reading.found;
    if is_gpx && routes > 0 && tracks > 0 {
        found.routes_and_tracks = Some([routes, tracks]);
    }
    if found.lines.is_empty() {
        return Err(OverlayError::NoLines { path: own(), others: found.others });
    }
    Ok(found)
}

struct Reading<'a> {
    path: &'a Path,
    found: VectorLines,
    points: usize,
    allow_ballpark: bool,
}

impl Reading<'_> {
    fn layer(&mut self, layer: &mut Layer<'_>) -> Result<(), OverlayError> {
        let path = self.path;
        let (own, name) = (|| path.to_path_buf(), layer.name());
        let unusable = |source: CrsError| OverlayError::Crs {
            path: own(),
            layer: name.clone(),
            source: Box::new(source),
        };
        let to_wgs84 = layer.spatial_ref().as_ref().map(ToWgs84::new).transpose();
        let to_wgs84 = to_wgs84.map_err(unusable)?;
        let before = self.found.lines.len();
        for_each_feature(layer, (path, FileUse::Lines), |feature| {
            let label = label_of(feature);
            let Some(geometry) = feature.geometry().filter(|geometry| !geometry.is_empty()) else {
                return Ok(());
            };
            let mut parts = Vec::new();
            take(geometry, &mut parts);
            if parts.is_empty() {
                self.found.others += 1;
                return Ok(());
            }
            let Some(to_wgs84) = &to_wgs84 else {
                return Err(OverlayError::NoCrs { path: own(), layer: name.clone() });
            };
            for mut part in parts {
                self.points += part.len();
                if self.points > MOST_POINTS {
                    return Err(OverlayError::TooManyPoints { path: own(), limit: MOST_POINTS });
                }
                to_wgs84.apply(&mut part).map_err(unusable)?;
                let (name, positions_deg) = (label.clone(), part);
                self.found.lines.push(VectorLine { name, positions_deg });
            }
            // An error of PROJ for single points is not a failure to read the file.
            forget();
            Ok(())
        })?;
        let Some(to_wgs84) = to_wgs84 else { return Ok(()) };
        let first = |line: &VectorLine| {
            line.positions_deg.iter().find(|position| position[0].is_finite()).copied()
        };
        let places_deg: Vec<_> = self.found.lines[before..].iter().filter_map(first).collect();
        let datums = to_wgs84.datums(path, &places_deg).allowed(self.allow_ballpark);
        self.found.datums.extend(datums.map_err(|error| OverlayError::Datum(Box::new(error)))?);
        Ok(())
    }
}

fn label_of(feature: &Feature<'_>) -> Option<String> {
    let index = feature.field_index("name").ok()?;
    feature.field_as_string(index).ok().flatten().filter(|name| !name.is_empty())
}

/// Collects the lines and rings of a geometry, one after the other.
fn take(geometry: &Geometry, parts: &mut Vec<Vec<[f64; 2]>>) {
    match geometry_type_flatten(geometry.geometry_type()) {
        OGRwkbGeometryType::wkbLineString | OGRwkbGeometryType::wkbLinearRing => {
            let mut points = Vec::new();
            geometry.get_points(&mut points);
            parts.push(points.into_iter().map(|(x, y, _)| [x, y]).collect());
        }
        OGRwkbGeometryType::wkbMultiLineString
        | OGRwkbGeometryType::wkbPolygon
        | OGRwkbGeometryType::wkbMultiPolygon
        | OGRwkbGeometryType::wkbGeometryCollection => {
            for index in 0..geometry.geometry_count() {
                take(&geometry.get_geometry(index), parts);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
