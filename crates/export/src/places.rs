//! The positions of vertices, in the requested coordinates.

use corniche_geom::{LatticePoint, Projection as _, known_line_length_m};
use corniche_gis::{CrsError, DemProjection, ProjectedCrs, RecordedCrs, RecordedHeights};
use corniche_layers::OsmObject;
use corniche_tileset::Manifest;

use crate::{
    cut::{cut_at_antimeridian, cut_polygon_at_antimeridian},
    error::CoordinatesError,
    measures::distances_m,
    piece::Vertex,
};

/// The coordinates of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeatureCoordinates {
    /// Coordinates of the package's CRS, with the package's heights: exactly those of the tiles.
    Package,
    /// Longitude, latitude and height above the ellipsoid of WGS84 (EPSG:4979).
    Wgs84,
    /// Longitude and latitude of WGS84, with the package's heights as they are.
    Wgs84WithPackageHeights,
    /// Coordinates of a projected CRS of the EPSG registry, given by its code, with the package's
    /// heights as they are.
    Epsg(u32),
}

/// Transforms places on the lattice to the coordinates of features.
pub(crate) struct Places<'a> {
    pub(crate) manifest: &'a Manifest,
    target: Target,
    /// The projection beyond the package's table of longitudes and latitudes: if the package was
    /// cut, the network extends beyond it.
    beyond: Option<Box<DemProjection>>,
    /// The CRS of features, as WKT2 or as a code.
    pub(crate) wkt: String,
    /// What the heights of features refer to, in words.
    pub(crate) heights: String,
}

enum Target {
    /// The package's CRS.
    Package,
    /// WGS84; heights are transformed to the ellipsoid if `heights` is present.
    Wgs84 { projection: Box<DemProjection>, heights: Option<Box<RecordedHeights>> },
    /// Another projected CRS.
    Projected(Box<ProjectedCrs>),
}

/// Returns the CRS that a package records.
pub(crate) fn crs_of(manifest: &Manifest) -> Result<RecordedCrs, CoordinatesError> {
    let Manifest { crs_wkt, metres_per_unit, .. } = manifest;
    Ok(RecordedCrs::new(crs_wkt, *metres_per_unit, manifest.whole_data_bounds())?)
}

impl<'a> Places<'a> {
    pub(crate) fn new(
        manifest: &'a Manifest,
        coordinates: FeatureCoordinates,
    ) -> Result<Self, CoordinatesError> {
        let Manifest { data_bounds, vertical, settings, .. } = manifest;
        let crs = crs_of(manifest)?;
        let area = manifest.wgs84_bounds;
        let datum = &vertical.datum;
        let given = [&settings.vertical_crs, &settings.dem_vertical_crs];
        let given: Vec<&str> = given.into_iter().flatten().map(String::as_str).collect();
        let known = RecordedHeights::find(&crs, datum, &given, area)?;
        let of_package = if known.is_some() {
            format!("{datum}, metres")
        } else {
            format!("metres, datum of the package: {datum}")
        };
        let wgs84 = |heights: Option<RecordedHeights>| -> Result<Target, CrsError> {
            let projection = Box::new(crs.projection(area)?);
            Ok(Target::Wgs84 { projection, heights: heights.map(Box::new) })
        };
        let (target, wkt, heights) = match coordinates {
            FeatureCoordinates::Package => {
                let both = known.as_ref().and_then(RecordedHeights::wkt);
                (Target::Package, both.unwrap_or_else(|| crs.wkt().to_owned()), of_package)
            }
            FeatureCoordinates::Wgs84 => {
                let heights =
                    known.ok_or_else(|| CoordinatesError::UnknownDatum { datum: datum.clone() })?;
                // A missing grid is reported before anything is read.
                let mut height_m = [f64::midpoint(vertical.range_m[0], vertical.range_m[1])];
                let failed = CoordinatesError::of_heights(datum);
                heights.to_wgs84_m(&[data_bounds.center()], &mut height_m).map_err(failed)?;
                let above = "above the ellipsoid of WGS84, metres".to_owned();
                (wgs84(Some(heights))?, "EPSG:4979".to_owned(), above)
            }
            FeatureCoordinates::Wgs84WithPackageHeights => {
                (wgs84(None)?, "EPSG:4326".to_owned(), of_package)
            }
            FeatureCoordinates::Epsg(code) => {
                let to = crs.projected(&format!("EPSG:{code}"), area).map_err(other_crs)?;
                let both = known.as_ref().and_then(|known| known.wkt_with(&to));
                let wkt = both.unwrap_or_else(|| to.wkt().to_owned());
                (Target::Projected(Box::new(to)), wkt, of_package)
            }
        };
        let beyond = manifest.clip.as_ref().map(|_| crs.projection(manifest.area_deg()));
        let beyond = beyond.transpose()?.map(Box::new);
        Ok(Self { manifest, target, beyond, wkt, heights })
    }

    /// Longitude and latitude of a place on the lattice, without PROJ: accurate to the centimetre,
    /// and smooth.
    pub(crate) fn wgs84(&self, at: [f64; 2]) -> [f64; 2] {
        let Manifest { frame, coordinates, .. } = self.manifest;
        coordinates.wgs84_from_working(frame.position_of_fraction_m(at))
    }

    /// True distance in plan between two places on the lattice, measured in the same way as in a
    /// build.
    pub(crate) fn distance_m(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let frame = &self.manifest.frame;
        let ends_m = [from, to].map(|at| frame.position_of_fraction_m(at));
        let degrees = |at_m| self.degrees(at_m);
        known_line_length_m(ends_m, ends_m.map(degrees), &degrees)
    }

    /// Returns a function for the true distance in plan between two places on the lattice.
    pub(crate) fn metric(&self) -> impl Fn([f64; 2], [f64; 2]) -> f64 + '_ {
        |from, to| self.distance_m(from, to)
    }

    /// Returns the distance of each point along a line on the lattice.
    pub(crate) fn distances_m(&self, points: impl Iterator<Item = LatticePoint>) -> Vec<f64> {
        distances_m(points.map(LatticePoint::in_steps), &self.metric())
    }

    /// The true length in plan of a line on the lattice.
    pub(crate) fn length_m(&self, points: impl Iterator<Item = LatticePoint>) -> f64 {
        self.distances_m(points).last().copied().unwrap_or_default()
    }

    /// Longitude and latitude of a place in working metres, also beyond the package's table.
    fn degrees(&self, at_m: [f64; 2]) -> [f64; 2] {
        let coordinates = &self.manifest.coordinates;
        if let Some(projection) = &self.beyond
            && !coordinates.bounds().contains(at_m)
        {
            let mut position = [at_m];
            if projection.wgs84_from_working(&mut position).is_ok() && are_finite(&position) {
                return position[0];
            }
        }
        coordinates.wgs84_from_working(at_m)
    }

    /// Replaces positions in working metres by longitude and latitude, and heights by the requested
    /// ones.
    pub(crate) fn to_wgs84(
        &self,
        plan: &mut [[f64; 2]],
        heights_m: &mut [f64],
    ) -> Result<(), CoordinatesError> {
        self.to_wanted_heights(plan, heights_m)?;
        self.to_wgs84_plan(plan)?;
        self.all_have_heights(plan, heights_m)
    }

    /// Replaces heights of the package, at positions in working metres, by the requested ones; NaN
    /// if there is none.
    pub(crate) fn to_wanted_heights(
        &self,
        positions_m: &[[f64; 2]],
        heights_m: &mut [f64],
    ) -> Result<(), CoordinatesError> {
        let Target::Wgs84 { heights: Some(heights), .. } = &self.target else { return Ok(()) };
        let failed = CoordinatesError::of_heights(&self.manifest.vertical.datum);
        heights.to_wgs84_m(positions_m, heights_m).map_err(failed)
    }

    /// Fails at the first place (longitude and latitude) without a height.
    pub(crate) fn all_have_heights(
        &self,
        places_deg: &[[f64; 2]],
        heights_m: &[f64],
    ) -> Result<(), CoordinatesError> {
        let mut all = places_deg.iter().zip(heights_m);
        all.find(|(_, height_m)| !height_m.is_finite()).map_or(Ok(()), |(&[lon, lat], _)| {
            let datum = self.manifest.vertical.datum.clone();
            Err(CoordinatesError::NoHeightHere { datum, lon, lat })
        })
    }

    /// Replaces longitudes and latitudes by positions in working metres; NaN if there is none.
    pub(crate) fn working_from_wgs84(
        &self,
        places: &mut [[f64; 2]],
    ) -> Result<(), CoordinatesError> {
        if let Target::Wgs84 { projection, .. } = &self.target {
            return Ok(projection.working_from_wgs84(places)?);
        }
        for place in places {
            let known = self.manifest.coordinates.working_from_wgs84(*place);
            *place = known.unwrap_or([f64::NAN; 2]);
        }
        Ok(())
    }

    /// Replaces positions in working metres by longitude and latitude.
    pub(crate) fn to_wgs84_plan(&self, plan: &mut [[f64; 2]]) -> Result<(), CoordinatesError> {
        if let Target::Wgs84 { projection, .. } = &self.target {
            projection.wgs84_from_working(plan)?;
        } else {
            for position in plan.iter_mut() {
                *position = self.manifest.coordinates.wgs84_from_working(*position);
            }
        }
        are_finite(plan).then_some(()).ok_or(CoordinatesError::NoGroundPosition)
    }

    /// Transforms positions of an object from working metres to the features' coordinates.
    pub(crate) fn carry_plan(
        &self,
        object: OsmObject,
        mut plan: Vec<[f64; 2]>,
    ) -> Result<Vec<[f64; 2]>, CoordinatesError> {
        match &self.target {
            Target::Package => {
                let [unit_x, unit_y] = self.manifest.metres_per_unit;
                for [x, y] in &mut plan {
                    (*x, *y) = (*x / unit_x, *y / unit_y);
                }
            }
            Target::Wgs84 { projection, .. } => {
                projection.wgs84_from_working(&mut plan)?;
            }
            Target::Projected(to) => {
                to.from_working(&mut plan).map_err(other_crs)?;
            }
        }
        if are_finite(&plan) { Ok(plan) } else { Err(CoordinatesError::NoPosition { object }) }
    }

    /// Splits the transformed rings of a polygon, the outer one first: into one polygon, or into
    /// several if it crosses the antimeridian in degrees. Its corners were rounded by up to
    /// `rounding_m`.
    pub(crate) fn cut_polygon(
        &self,
        object: OsmObject,
        rings: Vec<Vec<[f64; 2]>>,
        rounding_m: f64,
    ) -> Result<Vec<Vec<Vec<[f64; 2]>>>, CoordinatesError> {
        if !self.are_degrees() {
            return Ok(vec![rings]);
        }
        // The smallest number of metres in a degree of longitude or latitude at the equator.
        let rounding_deg = rounding_m / 110_000.0;
        cut_polygon_at_antimeridian(rings, rounding_deg)
            .ok_or(CoordinatesError::AcrossAntimeridian { object })
    }

    /// Transforms a line of an object to the features' coordinates: one line, or several if it
    /// crosses the antimeridian in degrees.
    pub(crate) fn carry(
        &self,
        object: OsmObject,
        vertices: &[Vertex],
    ) -> Result<Vec<Vec<[f64; 3]>>, CoordinatesError> {
        let frame = &self.manifest.frame;
        let plan: Vec<[f64; 2]> =
            vertices.iter().map(|vertex| frame.position_of_fraction_m(vertex.at)).collect();
        let mut heights_m: Vec<f64> = vertices.iter().map(|vertex| vertex.z_m).collect();
        self.to_wanted_heights(&plan, &mut heights_m)?;
        let plan = self.carry_plan(object, plan)?;
        let line = plan.iter().zip(&heights_m).map(|(&[x, y], &z)| [x, y, z]).collect();
        if !self.are_degrees() {
            return Ok(vec![line]);
        }
        self.all_have_heights(&plan, &heights_m)?;
        Ok(cut_at_antimeridian(line))
    }

    /// Whether lines that are straight in the features' coordinates are straight in degrees.
    pub(crate) fn are_degrees(&self) -> bool {
        matches!(self.target, Target::Wgs84 { .. })
    }
}

fn other_crs(source: CrsError) -> CoordinatesError {
    CoordinatesError::OtherCrs(Box::new(source))
}

/// Whether all positions have coordinates.
fn are_finite(positions: &[[f64; 2]]) -> bool {
    positions.iter().flatten().all(|coordinate| coordinate.is_finite())
}
