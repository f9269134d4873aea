//! Horizontal coordinate systems, stored as text because the objects of PROJ belong to one thread,
//! and systems with factors to working metres.

use std::sync::Arc;

use corniche_geom::{Bounds, Seam, wgs84};
use gdal::errors::GdalError;
use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};

use crate::crs::cylindrical;
use crate::crs::wkt::{bound_system, children, keyword, wkt2};
use crate::{CrsError, library_error};

/// A horizontal coordinate system, stored as text: PROJ's objects belong to one thread.
#[derive(Debug, Clone)]
pub struct Crs {
    /// WKT2, if the system can be written so.
    pub wkt: Arc<str>,
    /// "EPSG:…" if the system has a code, else its name.
    pub label: String,
    /// Whether the label is a code.
    has_code: bool,
    /// Period of the first coordinate: its range in a full turn around the earth. `None` for
    /// projections that are not cylindrical.
    pub turn: Option<f64>,
    is_projected: bool,
    /// Metres per unit of the coordinates; 1 for a geographic system.
    pub unit_m: f64,
}

impl Crs {
    /// The system of a GDAL object.
    ///
    /// # Errors
    /// When the system cannot be written as WKT.
    pub fn from_spatial_ref(reference: &SpatialRef) -> Result<Self, CrsError> {
        let name = reference.name().unwrap_or_else(|| "unnamed".to_owned());
        let wkt = wkt2(reference)
            .map_err(|source| CrsError::Wkt { name: name.clone(), source: source.into() })?;
        let projected = reference.is_projected();
        let turn = if projected {
            cylindrical::turn_of(reference, &wkt)
        } else {
            Some(std::f64::consts::TAU / reference.angular_units())
        };
        let code = reference.authority();
        Ok(Self {
            wkt: wkt.into(),
            has_code: code.is_ok(),
            label: code.unwrap_or(name),
            turn,
            is_projected: projected,
            unit_m: if projected { reference.linear_units() } else { 1.0 },
        })
    }

    /// Longitude and latitude of WGS84.
    ///
    /// # Errors
    /// When PROJ finds no database.
    pub fn wgs84() -> Result<Self, CrsError> {
        let reference = SpatialRef::from_epsg(4326)
            .map_err(|source| CrsError::NoProjTables { source: source.into() })?;
        Self::from_spatial_ref(&reference)
    }

    /// The same system with another definition and another label, such as that of a system with
    /// heights.
    pub(crate) fn renamed(&self, wkt: Arc<str>, label: String) -> Self {
        Self { wkt, label, has_code: false, ..self.clone() }
    }

    /// The text that distinguishes this system from all others: its code, or without one its
    /// definition, because names such as "unknown" are common.
    pub(crate) fn identity(&self) -> &str {
        if self.has_code { &self.label } else { &self.wkt }
    }

    /// PROJ's object for this thread, in traditional axis order: x or longitude first.
    pub(crate) fn spatial_ref(&self) -> Result<SpatialRef, GdalError> {
        // PROJ wrote the text itself. If PROJ cannot read it, the end of the text shows whether it
        // is complete.
        let mut reference = SpatialRef::from_wkt(&self.wkt).map_err(|error| {
            let why = library_error::last_words().unwrap_or_else(|| error.to_string());
            let last = self.wkt.char_indices().nth_back(59).map_or(0, |(at, _)| at);
            let end = &self.wkt[last..];
            let bytes = self.wkt.len();
            GdalError::BadArgument(format!(
                "{why}, in a definition of {bytes} bytes that ends with {end}"
            ))
        })?;
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        Ok(reference)
    }

    /// Whether the ellipsoid is that of WGS84, or GRS80, which differs by a tenth of a millimetre.
    /// Datums on it were made for satellite positioning.
    pub(crate) fn is_on_wgs84_ellipsoid(&self) -> bool {
        const AXES_M: [f64; 2] = [6_378_137.0, 6_356_752.314];
        const SAME_M: f64 = 0.01;
        let axes_m = || {
            let reference = self.spatial_ref()?;
            Ok::<_, GdalError>([reference.semi_major()?, reference.semi_minor()?])
        };
        axes_m().is_ok_and(|axes_m| (0..2).all(|k| (axes_m[k] - AXES_M[k]).abs() <= SAME_M))
    }

    /// Whether the coordinates are lengths.
    #[must_use]
    pub fn is_projected(&self) -> bool {
        self.is_projected
    }

    /// A full turn in the system's angular unit; `None` if the system is projected.
    #[must_use]
    pub fn turn_angle(&self) -> Option<f64> {
        self.turn.filter(|_| !self.is_projected)
    }

    /// Metres per unit of longitude and of latitude at a latitude, by the radii of curvature of the
    /// system's ellipsoid; `None` if the system is projected.
    ///
    /// # Errors
    /// When PROJ cannot read its own text.
    pub fn metres_per_turn_unit(&self, latitude_deg: f64) -> Result<Option<[f64; 2]>, CrsError> {
        let Some(turn) = self.turn_angle() else { return Ok(None) };
        let unreadable =
            |source: GdalError| CrsError::Wkt { name: self.label.clone(), source: source.into() };
        let reference = self.spatial_ref().map_err(unreadable)?;
        let major_m = reference.semi_major().map_err(unreadable)?;
        let minor_m = reference.semi_minor().map_err(unreadable)?;
        let radians = std::f64::consts::TAU / turn;
        let eccentricity_2 = 1.0 - (minor_m / major_m).powi(2);
        let [parallel_m, meridian_m] = wgs84::radii_of_m(major_m, eccentricity_2, latitude_deg);
        Ok(Some([parallel_m * radians, meridian_m * radians]))
    }

    /// The sign of each coordinate: 1, or −1 if the axis counts westwards or southwards. Both axes
    /// of a polar system run south or north: their signs are 1.
    #[must_use]
    pub fn signs(&self) -> [f64; 2] {
        let bound = bound_system(&self.wkt);
        let axes: Vec<String> = children(bound.as_deref().unwrap_or(&self.wkt))
            .into_iter()
            .filter(|part| keyword(part) == "AXIS")
            .filter_map(|axis| children(&axis).first().cloned())
            .collect();
        let has = |way: &str| axes.iter().any(|axis| axis.eq_ignore_ascii_case(way));
        let is_polar = !(has("west") || has("east"));
        let sign = |counts_back: bool| if counts_back { -1.0 } else { 1.0 };
        [sign(has("west")), sign(!is_polar && has("south"))]
    }

    /// Whether both describe the same system, regardless of the name.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        self.wkt == other.wkt
            || match (self.spatial_ref(), other.spatial_ref()) {
                (Ok(own), Ok(others)) => own == others,
                _ => false,
            }
    }
}

/// A CRS with the factors that make its coordinates working metres.
///
/// Working x = first coordinate × `metres_per_unit[0]`, y likewise. No PROJ method is used for
/// this: `eqc` is spherical in some versions of PROJ and ellipsoidal in others.
#[derive(Debug, Clone)]
pub struct GridCrs {
    /// The CRS.
    pub crs: Crs,
    /// East and north; negative for an axis that counts westwards or southwards.
    pub metres_per_unit: [f64; 2],
    /// The first coordinate in the middle of the data: where x repeats after a turn, images are
    /// those nearest to the middle, also beyond ±180°.
    pub middle: f64,
    /// Whether the factors make lengths true at the standard latitude. False if the factors are
    /// only the unit of the CRS.
    pub is_scaled: bool,
}

impl GridCrs {
    /// The same CRS around the middle of data in working metres.
    #[must_use]
    pub fn around(self, data_m: Bounds) -> Self {
        Self { middle: data_m.center()[0] / self.metres_per_unit[0], ..self }
    }

    /// The seam of the CRS around the middle of the data, in its own coordinates; `None` if x never
    /// repeats.
    #[must_use]
    pub fn seam(&self) -> Option<Seam> {
        self.crs.turn.map(|turn| Seam::new(self.middle, turn))
    }

    /// The seam in working metres.
    #[must_use]
    pub fn seam_m(&self) -> Option<Seam> {
        let metres = self.metres_per_unit[0];
        self.crs.turn.map(|turn| Seam::new(self.middle * metres, turn * metres))
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "signs are exact")]
#[path = "horizontal_tests.rs"]
mod tests;
