//! Lines are read from all layers of a vector file and carried to WGS84.

use std::{collections::HashMap, path::Path};

use corniche_dem::{NotOpened, PlaceLimit, failure, forget, open_vectors};
use gdal::{
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{Feature, Geometry, Layer, LayerAccess, OGRwkbGeometryType, geometry_type_flatten},
};

use crate::OverlayError;

/// Each is drawn on every tile that it comes near; the limit keeps memory and time bounded.
const MOST_POINTS: usize = 4_000_000;

/// A line of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorLine {
    /// The feature's `name`, if it has one.
    pub name: Option<String>,
    /// Longitude and latitude of each point, degrees of WGS84. NaN where a point has no such position.
    pub positions_deg: Vec<[f64; 2]>,
}

/// The lines of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VectorLines {
    /// All lines, and the outlines of all polygons, ring by ring, in the order of the file.
    pub lines: Vec<VectorLine>,
    /// Features that are neither, such as points.
    pub others: u64,
    /// Lines of routes, and lines of tracks, in a GPX file that has both.
    pub routes_and_tracks: Option<[usize; 2]>,
}

impl VectorLines {
    /// What a user may not have meant, in whole sentences without a point.
    #[must_use]
    pub fn notices(&self) -> Vec<String> {
        let mut notices = Vec::new();
        if self.others > 0 {
            notices.push(format!("{} features are neither lines nor outlines", self.others));
        }
        if let Some([routes, tracks]) = self.routes_and_tracks {
            notices.push(format!(
                "it has routes ({routes}) and tracks ({tracks}), and both are taken; programs often save one line as both, which then counts \
                 twice; keep one of them: ogr2ogr NEW.gpx OLD.gpx tracks"
            ));
        }
        let repeated = self.repeated();
        if repeated > 0 {
            notices.push(format!(
                "{repeated} of its lines are the same as one before, and count again"
            ));
        }
        notices
    }

    /// How many lines have the positions of one before them, in the same order or from end to begin.
    fn repeated(&self) -> usize {
        let mut known: HashMap<u64, Vec<usize>> = HashMap::new();
        let mut repeated = 0;
        for (number, line) in self.lines.iter().enumerate() {
            let with_same_key = known.entry(line.key()).or_default();
            if with_same_key.iter().any(|&before| self.lines[before].is_same_as(line)) {
                repeated += 1;
            } else {
                with_same_key.push(number);
            }
        }
        repeated
    }
}

impl VectorLine {
    fn bits(&self) -> impl DoubleEndedIterator<Item = [u64; 2]> {
        self.positions_deg.iter().map(|position| position.map(f64::to_bits))
    }

    /// A number that lines with the same positions have in common, whichever way they go.
    fn key(&self) -> u64 {
        let mix =
            |[lon, lat]: [u64; 2]| lon.rotate_left(32).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ lat;
        self.bits().map(mix).fold(0, u64::wrapping_add)
    }

    fn is_same_as(&self, other: &Self) -> bool {
        self.bits().eq(other.bits()) || self.bits().eq(other.bits().rev())
    }
}

/// Reads the lines of all layers of a vector file, each in its own coordinate system.
///
/// # Errors
/// When GDAL cannot read the file or a part of it, when it has no line, or a layer names no coordinate system.
pub fn read(path: &Path) -> Result<VectorLines, OverlayError> {
    let own = || path.to_path_buf();
    let dataset = open_vectors(path).map_err(|error| match error {
        NotOpened::Missing(source) => OverlayError::Missing { path: own(), source },
        NotOpened::Stream => OverlayError::Stream { path: own() },
        NotOpened::Unreadable(source) => OverlayError::Open { path: own(), source },
    })?;
    let is_gpx = dataset.driver().short_name() == "GPX";
    let mut reading = Reading { path, found: VectorLines::default(), points: 0 };
    let [mut routes, mut tracks] = [0; 2];
    for mut layer in dataset.layers() {
        let name = layer.name();
        // GDAL tells the points of tracks and routes of GPX once more, in layers of their own.
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
}

impl Reading<'_> {
    fn layer(&mut self, layer: &mut Layer<'_>) -> Result<(), OverlayError> {
        let path = || self.path.to_path_buf();
        let (name, claimed) = (layer.name(), layer.try_feature_count());
        let to_wgs84 = layer.spatial_ref().map(to_wgs84).transpose();
        let to_wgs84 = to_wgs84.map_err(|source| OverlayError::Crs {
            path: path(),
            layer: name.clone(),
            source: source.into(),
        })?;
        let mut features = 0;
        forget();
        for feature in layer.features() {
            features += 1;
            let label = label_of(&feature);
            let Some(geometry) = feature.geometry().filter(|geometry| !geometry.is_empty()) else {
                continue;
            };
            let mut parts = Vec::new();
            take(geometry, &mut parts);
            if parts.is_empty() {
                self.found.others += 1;
                continue;
            }
            let Some(to_wgs84) = &to_wgs84 else {
                return Err(OverlayError::NoCrs { path: self.path.to_path_buf(), layer: name });
            };
            for part in parts {
                self.points += part.len();
                if self.points > MOST_POINTS {
                    let (path, limit) = (self.path.to_path_buf(), MOST_POINTS);
                    return Err(OverlayError::TooManyPoints { path, limit });
                }
                let positions_deg = carried(&part, to_wgs84);
                self.found.lines.push(VectorLine { name: label.clone(), positions_deg });
            }
            // What PROJ says of single points is no failure to read the file.
            forget();
        }
        // The iterator ends where a feature cannot be read, and does not tell.
        let path = self.path.to_path_buf();
        if let Some(source) = failure() {
            return Err(OverlayError::Damaged { path, source });
        }
        match claimed {
            Some(claimed) if claimed != features => {
                Err(OverlayError::CutOff { path, layer: name, claimed, found: features })
            }
            _ => Ok(()),
        }
    }
}

/// What carries positions of a system to WGS84, and the largest of them that it may get.
type ToWgs84 = (PlaceLimit, CoordTransform);

fn to_wgs84(mut from: SpatialRef) -> Result<ToWgs84, gdal::errors::GdalError> {
    let mut to = SpatialRef::from_epsg(4326)?;
    for reference in [&mut from, &mut to] {
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    }
    Ok((PlaceLimit::of(&from), CoordTransform::new(&from, &to)?))
}

fn label_of(feature: &Feature<'_>) -> Option<String> {
    let index = feature.field_index("name").ok()?;
    feature.field_as_string(index).ok().flatten().filter(|name| !name.is_empty())
}

/// The lines and rings of a geometry, one after the other.
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

/// Longitudes and latitudes; NaN where there is none.
fn carried(points: &[[f64; 2]], (limit, to_wgs84): &ToWgs84) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = points.iter().map(|point| limit.limited(*point)).collect();
    let carry = |points: &[[f64; 2]]| -> Option<Vec<[f64; 2]>> {
        let mut x: Vec<f64> = points.iter().map(|point| point[0]).collect();
        let mut y: Vec<f64> = points.iter().map(|point| point[1]).collect();
        to_wgs84.transform_coords(&mut x, &mut y, &mut []).ok()?;
        let finite = |at: f64| if at.is_finite() { at } else { f64::NAN };
        Some(x.into_iter().zip(y).map(|(x, y)| [finite(x), finite(y)]).collect())
    };
    // Where one point fails, GDAL fails them all.
    carry(&points).unwrap_or_else(|| {
        let one = |point: &[f64; 2]| carry(&[*point]).map_or([f64::NAN; 2], |carried| carried[0]);
        points.iter().map(one).collect()
    })
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
