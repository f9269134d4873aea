//! Polygons with holes, read from a vector file, to which elevation data are clipped.

use std::{
    fmt,
    path::{Path, PathBuf},
    sync::Arc,
};

use gdal::vector::{Geometry, Layer, LayerAccess, OGRwkbGeometryType, geometry_type_flatten};

use crate::crs::horizontal::Crs;
use crate::files::vector_files::{for_each_feature, open_vectors};
use crate::{FileUse, PolygonError, library_error};

/// The largest number of corners: far more than any administrative border has; the limit bounds
/// memory.
const MOST_CORNERS: usize = 4_000_000;

/// The corners of a ring, in the file's CRS; the first is not repeated at the end.
pub(crate) type FileRing = Vec<[f64; 2]>;

/// Merged polygons with holes, to which elevation data are clipped. Copies share their corners.
#[derive(Clone)]
pub struct RegionPolygons {
    content: Arc<Content>,
}

struct Content {
    path: PathBuf,
    parts: Vec<PolygonRings>,
    bytes: Vec<u8>,
}

/// One polygon: its outer ring first, then its holes.
pub(crate) struct PolygonRings {
    pub(crate) crs: Crs,
    pub(crate) rings: Vec<FileRing>,
}

impl RegionPolygons {
    /// Reads a vector file: all polygons of all its layers, each layer in its own coordinate
    /// system. Edges are straight in that system.
    ///
    /// # Errors
    /// When GDAL cannot read the file, the file has no polygon or other geometries, names no
    /// coordinate system, or a polygon crosses itself.
    pub fn read(path: &Path) -> Result<Self, PolygonError> {
        let own = || path.to_path_buf();
        let dataset = open_vectors(path, FileUse::Polygon)?;
        let mut reading = Reading { path, parts: Vec::new(), features: 0, corners: 0 };
        for mut layer in dataset.layers() {
            reading.read_layer(&mut layer)?;
        }
        let Reading { parts, .. } = reading;
        if parts.is_empty() {
            return Err(PolygonError::Empty { path: own() });
        }
        let bytes = canonical_bytes(&parts);
        Ok(Self { content: Arc::new(Content { path: own(), parts, bytes }) })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.content.path
    }

    /// The polygons as bytes that depend only on coordinate system and corners: neither on the
    /// file's format nor on the order of features.
    #[must_use]
    pub fn canonical_bytes(&self) -> &[u8] {
        &self.content.bytes
    }

    /// The coordinate systems of its parts.
    pub fn systems(&self) -> impl Iterator<Item = &Crs> {
        self.parts().iter().map(|part| &part.crs)
    }

    pub(crate) fn parts(&self) -> &[PolygonRings] {
        &self.content.parts
    }
}

/// Equal polygons enclose the same area, regardless of their files' names.
impl PartialEq for RegionPolygons {
    fn eq(&self, other: &Self) -> bool {
        self.content.bytes == other.content.bytes
    }
}

impl fmt::Debug for RegionPolygons {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Polygon").field("path", &self.content.path).finish_non_exhaustive()
    }
}

/// A file that is being read.
struct Reading<'a> {
    path: &'a Path,
    parts: Vec<PolygonRings>,
    features: u64,
    corners: usize,
}

impl Reading<'_> {
    fn read_layer(&mut self, layer: &mut Layer<'_>) -> Result<(), PolygonError> {
        let path = self.path;
        let own = || path.to_path_buf();
        let crs = layer.spatial_ref().as_ref().map(Crs::from_spatial_ref).transpose();
        let crs =
            crs.map_err(|error| PolygonError::Crs { path: own(), reason: error.to_string() })?;
        for_each_feature(layer, (path, FileUse::Polygon), |feature| {
            self.features += 1;
            let Some(geometry) = feature.geometry().filter(|geometry| !geometry.is_empty()) else {
                return Ok(());
            };
            let crs = crs.as_ref().ok_or_else(|| PolygonError::NoCrs { path: own() })?;
            self.take(geometry, crs)
        })
    }

    /// Splits a geometry into polygons.
    fn take(&mut self, geometry: &Geometry, crs: &Crs) -> Result<(), PolygonError> {
        match geometry_type_flatten(geometry.geometry_type()) {
            OGRwkbGeometryType::wkbPolygon => self.take_polygon(geometry, crs),
            OGRwkbGeometryType::wkbMultiPolygon => {
                let mut polygons = 0..geometry.geometry_count();
                polygons.try_for_each(|index| self.check_closed(&geometry.get_geometry(index)))?;
                self.check_valid(geometry)?;
                let mut polygons = 0..geometry.geometry_count();
                polygons.try_for_each(|index| self.take_rings(&geometry.get_geometry(index), crs))
            }
            OGRwkbGeometryType::wkbGeometryCollection => {
                let mut members = 0..geometry.geometry_count();
                members.try_for_each(|index| self.take(&geometry.get_geometry(index), crs))
            }
            _ => Err(PolygonError::OtherGeometry {
                path: self.path.to_path_buf(),
                feature: self.features,
                found: geometry.geometry_name(),
            }),
        }
    }

    fn take_polygon(&mut self, polygon: &Geometry, crs: &Crs) -> Result<(), PolygonError> {
        self.check_closed(polygon)?;
        self.check_valid(polygon)?;
        self.take_rings(polygon, crs)
    }

    /// Fails if a polygon crosses itself, or is invalid for another reason.
    fn check_valid(&self, geometry: &Geometry) -> Result<(), PolygonError> {
        library_error::forget();
        if geometry.is_valid() {
            return Ok(());
        }
        let reason = library_error::last_words().unwrap_or_else(|| "it crosses itself".to_owned());
        let (path, feature) = (self.path.to_path_buf(), self.features);
        Err(PolygonError::Invalid { path, feature, reason })
    }

    /// Fails if a ring of a polygon is not closed: the message of GEOS for this case is not
    /// helpful.
    fn check_closed(&self, polygon: &Geometry) -> Result<(), PolygonError> {
        for index in 0..polygon.geometry_count() {
            let mut points = Vec::new();
            polygon.get_geometry(index).get_points(&mut points);
            if let (Some(&(x, y, _)), Some(&(end_x, end_y, _))) = (points.first(), points.last())
                && (x, y) != (end_x, end_y)
            {
                let (first, last) = ([x, y], [end_x, end_y]);
                let (path, feature) = (self.path.to_path_buf(), self.features);
                return Err(PolygonError::OpenRing { path, feature, first, last });
            }
        }
        Ok(())
    }

    fn take_rings(&mut self, polygon: &Geometry, crs: &Crs) -> Result<(), PolygonError> {
        let (path, feature) = (|| self.path.to_path_buf(), self.features);
        let mut rings = Vec::new();
        let mut corners = self.corners;
        for index in 0..polygon.geometry_count() {
            let mut points = Vec::new();
            polygon.get_geometry(index).get_points(&mut points);
            corners += points.len();
            if corners > MOST_CORNERS {
                return Err(PolygonError::TooManyCorners { path: path(), limit: MOST_CORNERS });
            }
            // Adding 0.0 turns −0.0 into 0.0, which is the same position.
            let mut ring: FileRing = points.iter().map(|&(x, y, _)| [x + 0.0, y + 0.0]).collect();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            if !ring.iter().flatten().all(|value| value.is_finite()) {
                let reason = "a corner is no finite number".to_owned();
                return Err(PolygonError::Invalid { path: path(), feature, reason });
            }
            let is_wide = |turn: f64, a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() > turn / 2.0;
            let next = ring.iter().cycle().skip(1);
            if let Some(turn) = crs.turn
                && ring.iter().zip(next).any(|(&from, &to)| is_wide(turn, from, to))
            {
                return Err(PolygonError::HalfTheEarth { path: path(), feature });
            }
            rings.push(in_normal_order(ring));
        }
        self.corners = corners;
        if rings.first().is_some_and(|outer| outer.len() >= 3) {
            self.parts.push(PolygonRings { crs: crs.clone(), rings });
        }
        Ok(())
    }
}

/// The same ring starting at its smallest corner, towards the smaller of its neighbours: formats
/// differ in direction and starting point of rings.
fn in_normal_order(mut ring: FileRing) -> FileRing {
    let order = |a: &[f64; 2], b: &[f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    let least = (0..ring.len()).min_by(|&a, &b| order(&ring[a], &ring[b]));
    ring.rotate_left(least.unwrap_or_default());
    if let [_, next, .., last] = ring.as_slice()
        && order(last, next).is_lt()
    {
        ring[1..].reverse();
    }
    ring
}

/// The parts, sorted by their bytes.
fn canonical_bytes(parts: &[PolygonRings]) -> Vec<u8> {
    let of_part = |part: &PolygonRings| {
        let mut bytes = Vec::new();
        let mut push = |number: usize| bytes.extend((number as u64).to_le_bytes());
        let crs = part.crs.identity();
        push(crs.len());
        push(part.rings.len());
        part.rings.iter().for_each(|ring| push(ring.len()));
        bytes.extend(crs.as_bytes());
        let coordinates = part.rings.iter().flatten().flatten();
        bytes.extend(coordinates.flat_map(|value| value.to_le_bytes()));
        bytes
    };
    let mut all: Vec<Vec<u8>> = parts.iter().map(of_part).collect();
    all.sort_unstable();
    all.concat()
}
