//! Vertical coordinate systems, which define the zero of heights.

use std::path::Path;
use std::sync::Arc;

use gdal::spatial_ref::SpatialRef;

use crate::crs::horizontal::Crs;
use crate::crs::wkt::{
    bound_system, child, children, keyword, length_unit_m, points_to, quoted, wkt2,
};
use crate::{CrsError, LibraryError, library_error};

/// A vertical CRS, or the third axis of a three-dimensional one, stored as text: PROJ's objects
/// belong to one thread.
#[derive(Debug, Clone, PartialEq)]
pub struct VerticalCrs {
    /// The name, with the ellipsoid's system for ellipsoidal heights.
    pub name: String,
    /// The datum, which is the same for metres and feet, and for heights and depths. `None` if it
    /// has no name: two systems with the datum "unknown" need not have the same one.
    pub datum: Option<String>,
    /// WKT2 of the vertical node, or of the whole three-dimensional system.
    pub(crate) wkt: Arc<str>,
    /// Metres per unit of height.
    pub unit_m: f64,
    /// Whether values are depths, which grow downwards.
    pub is_down: bool,
    pub(crate) is_ellipsoidal: bool,
}

impl VerticalCrs {
    /// The vertical part of a coordinate system in WKT2; `None` if it has none.
    pub(crate) fn of_wkt(wkt: &str) -> Result<Option<Self>, CrsError> {
        match keyword(wkt) {
            "COMPOUNDCRS" => {
                let parts = children(wkt);
                let mut vertical = parts.iter().map(|part| Self::gravity_related(part));
                vertical.find_map(Result::transpose).transpose()
            }
            "GEOGCRS" | "GEODCRS" | "GEOGRAPHICCRS" | "GEODETICCRS" | "PROJCRS"
            | "PROJECTEDCRS" => Self::ellipsoidal(wkt),
            _ => Self::gravity_related(wkt),
        }
    }

    /// A `VERTCRS`, or a `BOUNDCRS` that binds one to a geoid grid.
    fn gravity_related(wkt: &str) -> Result<Option<Self>, CrsError> {
        let is_bound = keyword(wkt) == "BOUNDCRS";
        let inner = if is_bound { bound_system(wkt).unwrap_or_default() } else { wkt.to_owned() };
        if !["VERTCRS", "VERTICALCRS"].contains(&keyword(&inner)) {
            return Ok(None);
        }
        let base = child(&inner, &["VDATUM", "VERTICALDATUM", "VRF", "ENSEMBLE"])
            .or_else(|| child(&inner, &["BASEVERTCRS"]));
        let datum = base.as_deref().and_then(quoted).unwrap_or_default();
        let own_name = quoted(&inner).unwrap_or("unnamed").to_owned();
        // Two systems bound to different grids differ, whatever their names are.
        let (name, datum) = match grids_of(wkt).filter(|_| is_bound) {
            Some(grids) => {
                let name = format!("height above the geoid of {}", grid_names(&grids));
                (name, Some(format!("{datum} by {grids}")))
            }
            None => (own_name, is_named(datum).then(|| datum.to_owned())),
        };
        let axis = child(&inner, &["AXIS"]).unwrap_or_default();
        Ok(Some(Self {
            unit_m: height_unit_m(&inner, &axis, &name)?,
            name,
            datum,
            is_down: points_to(&axis, &["down"]),
            wkt: wkt.into(),
            is_ellipsoidal: false,
        }))
    }

    /// The third axis of a geographic or projected system.
    fn ellipsoidal(wkt: &str) -> Result<Option<Self>, CrsError> {
        let axes: Vec<String> =
            children(wkt).into_iter().filter(|part| keyword(part) == "AXIS").collect();
        // A geocentric system has three axes, too, and the third one points to the pole.
        let Some(up) = axes.get(2).filter(|axis| points_to(axis, &["up", "down"])) else {
            return Ok(None);
        };
        // Heights are measured from the ellipsoid, regardless of the projection.
        let base = child(wkt, &["BASEGEOGCRS", "BASEGEODCRS"]);
        let geodetic = base.as_deref().unwrap_or(wkt);
        let above = |name: &str| format!("ellipsoidal height ({name})");
        let name = above(quoted(geodetic).unwrap_or("unnamed"));
        let node = child(
            geodetic,
            &["DATUM", "ENSEMBLE", "GEODETICDATUM", "GEODETICREFERENCEFRAME", "TRF"],
        );
        // The EPSG registry calls some datums ensembles that other sources do not.
        let datum = node.as_deref().and_then(quoted).unwrap_or_default();
        let datum = datum.trim_end_matches(" ensemble");
        Ok(Some(Self {
            unit_m: height_unit_m(wkt, up, &name)?,
            datum: is_named(datum).then(|| above(datum)),
            name,
            is_down: points_to(up, &["down"]),
            wkt: wkt.into(),
            is_ellipsoidal: true,
        }))
    }

    /// Whether both have the same datum: then only unit and direction can differ.
    #[must_use]
    pub fn is_same_datum(&self, other: &Self) -> bool {
        self.wkt == other.wkt || self.datum.is_some() && self.datum == other.datum
    }

    /// The vertical CRS of "EPSG:n" or WKT as given with `option`, which may be a CRS with a
    /// vertical part.
    ///
    /// # Errors
    /// When PROJ does not know the vertical CRS, or its axis has no unit.
    pub fn from_text(option: &'static str, text: &str) -> Result<Self, CrsError> {
        library_error::forget();
        let refused = |reason: Option<Box<LibraryError>>| CrsError::VerticalText {
            option,
            text: text.to_owned(),
            source: reason,
        };
        let reference =
            SpatialRef::from_definition(text).map_err(|error| refused(Some(error.into())))?;
        let wkt = wkt2(&reference).map_err(|error| refused(Some(error.into())))?;
        Self::of_wkt(&wkt)?.ok_or_else(|| refused(None))
    }

    /// Metres upwards per unit of a value.
    #[must_use]
    pub fn m_per_value(&self) -> f64 {
        if self.is_down { -self.unit_m } else { self.unit_m }
    }

    /// Whether values are metres upwards.
    #[expect(clippy::float_cmp, reason = "a metre is exactly one")]
    pub(crate) fn is_plain(&self) -> bool {
        self.unit_m == 1.0 && !self.is_down
    }

    /// The WKT2 of a system with the same datum in metres upwards: of this system itself, if it is
    /// one.
    pub(crate) fn metres_upwards_wkt(&self) -> String {
        match &self.datum {
            Some(datum) if !self.is_plain() => format!(
                "VERTCRS[\"{datum} height\",VDATUM[\"{datum}\"],CS[vertical,1],\
                 AXIS[\"gravity-related height (H)\",up],LENGTHUNIT[\"metre\",1]]"
            ),
            _ => self.wkt.to_string(),
        }
    }

    /// The horizontal system combined with this one.
    pub(crate) fn with(&self, horizontal: &Crs) -> Crs {
        let wkt = if self.is_ellipsoidal {
            Arc::clone(&self.wkt)
        } else {
            format!("COMPOUNDCRS[\"DEM\",{},{}]", horizontal.wkt, self.wkt).into()
        };
        horizontal.renamed(wkt, self.name.clone())
    }

    /// The geoid grids that PROJ would use for the system, if PROJ names them.
    #[must_use]
    pub fn grids(&self) -> Option<String> {
        grids_of(&self.wkt).or_else(|| {
            let proj = SpatialRef::from_wkt(&self.wkt).ok()?.to_proj4().ok()?;
            let (_, rest) = proj.split_once("+geoidgrids=")?;
            rest.split_whitespace().next().map(str::to_owned)
        })
    }

    /// The name for heights of this system in metres upwards.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.datum {
            Some(datum) if !self.is_plain() => datum.clone(),
            _ => self.name.clone(),
        }
    }
}

/// Whether a datum has a name that identifies it.
fn is_named(datum: &str) -> bool {
    let words = datum.trim().to_lowercase().replace('_', " ");
    let words = words.strip_prefix("d ").unwrap_or(&words);
    let is_none = ["unknown", "unnamed", "undefined", "unspecified", "not specified"]
        .iter()
        .any(|none| words.starts_with(none));
    !is_none && !words.is_empty()
}

/// Metres per unit of an axis: its own unit, or the common unit after all axes.
///
/// Units of length in other places, such as the ellipsoid's, do not apply to heights.
fn height_unit_m(system: &str, axis: &str, name: &str) -> Result<f64, CrsError> {
    let of_all = || child(system, &["LENGTHUNIT", "UNIT"]).as_deref().and_then(length_unit_m);
    let unit_m = length_unit_m(axis).or_else(of_all);
    unit_m.ok_or_else(|| CrsError::VerticalUnit { name: name.to_owned() })
}

/// The grids named in the WKT itself.
fn grids_of(wkt: &str) -> Option<String> {
    let start = wkt.find("PARAMETERFILE[")?;
    children(&wkt[start..]).first().and_then(|file| quoted(file)).map(str::to_owned)
}

/// The names of grid files without their folders.
#[must_use]
pub fn grid_names(grids: &str) -> String {
    let name = |path: &str| {
        Path::new(path)
            .file_name()
            .map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
    };
    grids.split(',').map(name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
#[path = "vertical_tests.rs"]
mod tests;
