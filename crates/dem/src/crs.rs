use std::sync::Arc;

use gdal::config;
use gdal::errors::GdalError;
use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};

use crate::vertical::VerticalCrs;
use crate::wkt::{child, children, keyword, quoted};
use crate::{DemError, library};

/// A horizontal coordinate system, kept as text: PROJ's objects belong to one thread.
#[derive(Debug, Clone)]
pub(crate) struct Crs {
    /// WKT2 where it can be written so.
    pub(crate) wkt: Arc<str>,
    /// "EPSG:…" where it has a code, else its name.
    pub(crate) label: String,
    /// Period of the first coordinate: a full turn in the system's angular unit, `None` when projected.
    pub(crate) turn: Option<f64>,
    /// Metres to a unit of the coordinates; 1 for a geographic system.
    pub(crate) unit_m: f64,
    /// Plain spherical Mercator over ellipsoidal latitudes: its "metres" are none.
    pub(crate) is_web_mercator: bool,
}

impl Crs {
    pub(crate) fn from_spatial_ref(reference: &SpatialRef) -> Result<Self, DemError> {
        let name = reference.name().unwrap_or_else(|| "unnamed".to_owned());
        let wkt = wkt2(reference)
            .map_err(|source| DemError::Wkt { name: name.clone(), source: source.into() })?;
        let proj = reference.to_proj4().unwrap_or_default();
        let projected = reference.is_projected();
        let is_web_mercator = proj.contains("+proj=merc") && proj.contains("+b=6378137")
            || proj.contains("+proj=webmerc")
            || name.contains("Pseudo-Mercator");
        Ok(Self {
            wkt: wkt.into(),
            label: reference.authority().unwrap_or(name),
            turn: (!projected).then(|| std::f64::consts::TAU / reference.angular_units()),
            unit_m: if projected { reference.linear_units() } else { 1.0 },
            is_web_mercator,
        })
    }

    /// From "EPSG:n" or WKT, as `option` gave it.
    pub(crate) fn from_text(
        option: &'static str,
        text: &str,
    ) -> Result<(Self, Option<VerticalCrs>), DemError> {
        library::forget();
        let reference = SpatialRef::from_definition(text).map_err(|source| DemError::CrsText {
            option,
            text: text.to_owned(),
            source: source.into(),
        })?;
        let kind = || DemError::CrsKind { option, text: text.to_owned() };
        Self::horizontal(&reference)?.ok_or_else(kind)
    }

    /// The horizontal part of a system and the vertical one, if any; `None` when it is neither projected nor
    /// geographic.
    pub(crate) fn horizontal(
        reference: &SpatialRef,
    ) -> Result<Option<(Self, Option<VerticalCrs>)>, DemError> {
        let mut reference = reference.clone();
        let name = reference.name().unwrap_or_default();
        let as_wkt =
            |source: GdalError| DemError::Wkt { name: name.clone(), source: source.into() };
        let wkt = wkt2(&reference).map_err(as_wkt)?;
        let vertical = VerticalCrs::of_wkt(&wkt)?;
        if reference.is_compound() {
            // The heights' own system must not take part: it would ask PROJ for geoid grids.
            let Some(text) = children(&wkt).into_iter().find(|part| is_horizontal(part)) else {
                return Ok(None);
            };
            reference = SpatialRef::from_wkt(&text).map_err(as_wkt)?;
        }
        if !(reference.is_projected() || reference.is_geographic()) || reference.is_local() {
            return Ok(None);
        }
        Ok(Some((Self::from_spatial_ref(&reference)?, vertical)))
    }

    pub(crate) fn wgs84() -> Result<Self, DemError> {
        let reference = SpatialRef::from_epsg(4326).map_err(|source| DemError::CrsText {
            option: "the built-in",
            text: "EPSG:4326".to_owned(),
            source: source.into(),
        })?;
        Self::from_spatial_ref(&reference)
    }

    /// PROJ's object for this thread, in traditional axis order: x or longitude first.
    pub(crate) fn spatial_ref(&self) -> Result<SpatialRef, GdalError> {
        let mut reference = SpatialRef::from_wkt(&self.wkt)?;
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        Ok(reference)
    }

    pub(crate) fn is_projected(&self) -> bool {
        self.turn.is_none()
    }

    /// Whether its coordinates are metres; meaningful for a projected system.
    pub(crate) fn is_metric(&self) -> bool {
        (self.unit_m - 1.0).abs() < 1e-12
    }

    /// Whether both describe the same system, whatever they call it.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.wkt == other.wkt
            || match (self.spatial_ref(), other.spatial_ref()) {
                (Ok(own), Ok(others)) => own == others,
                _ => false,
            }
    }

    /// The same projection with its unit changed to metres; `None` when the text does not lend itself to it.
    ///
    /// Only false easting and northing are lengths in the unit; the caller checks the result with positions.
    pub(crate) fn in_metres(&self) -> Option<Self> {
        let reference = self.spatial_ref().ok()?;
        let wkt = reference.to_wkt().ok()?;
        let mut parts = children(&wkt);
        for part in &mut parts {
            if part.starts_with("UNIT") {
                "UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]".clone_into(part);
            } else if part.starts_with("PARAMETER[\"false_") {
                let (head, value) = part.trim_end_matches(']').rsplit_once(',')?;
                let metres = value.parse::<f64>().ok()? * self.unit_m;
                *part = format!("{head},{metres}]");
            } else if part.starts_with("AUTHORITY") || part.starts_with("EXTENSION") {
                part.clear();
            }
        }
        parts.retain(|part| !part.is_empty());
        let text = format!("PROJCS[\"{} (metres)\",{}]", quoted(&wkt)?, parts.join(","));
        let metric = SpatialRef::from_wkt(&text).ok()?;
        let found = Self::from_spatial_ref(&metric).ok()?;
        found.is_metric().then_some(found)
    }
}

/// Whether a part of a compound system says where, not how high.
fn is_horizontal(wkt: &str) -> bool {
    if keyword(wkt) == "BOUNDCRS" {
        let bound = child(wkt, &["SOURCECRS"]).map(|source| children(&source));
        return bound
            .and_then(|inner| inner.into_iter().next())
            .is_some_and(|wkt| is_horizontal(&wkt));
    }
    ["PROJ", "GEOG", "GEOD"].iter().any(|word| keyword(wkt).starts_with(word))
}

/// The definition as WKT2, on this thread alone.
pub(crate) fn wkt2(reference: &SpatialRef) -> Result<String, GdalError> {
    const FORMAT: &str = "OSR_WKT_FORMAT";
    config::set_thread_local_config_option(FORMAT, "WKT2_2018")?;
    let wkt = reference.to_wkt();
    config::clear_thread_local_config_option(FORMAT)?;
    wkt
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_compound_system_is_split_into_plan_and_height() {
        let (crs, vertical) = Crs::from_text("--dem-crs", "EPSG:32633+6360").unwrap();
        let vertical = vertical.unwrap();
        assert_eq!((crs.label.as_str(), vertical.is_down), ("EPSG:32633", false));
        assert_eq!(vertical.name, "NAVD88 height (ftUS)");
        assert_eq!(vertical.unit_m.to_bits(), (1200.0_f64 / 3937.0).to_bits());
    }

    #[test]
    fn feet_become_metres_without_moving() {
        let (feet, _) = Crs::from_text("--dem-crs", "EPSG:2272").unwrap();
        let metres = feet.in_metres().unwrap();
        assert_eq!((metres.unit_m, metres.is_projected()), (1.0, true));
        let operation = crate::operation::Operation::new(&feet, &metres, None);
        let mut points = [[2_690_000.0, 235_000.0], [1_968_500.0, 0.0]];
        let truth = points.map(|[x, y]| [x * feet.unit_m, y * feet.unit_m]);
        operation.apply(&mut points).unwrap();
        for (point, truth) in points.iter().zip(truth) {
            assert!(
                (point[0] - truth[0]).hypot(point[1] - truth[1]) < 1e-4,
                "{point:?} is not {truth:?}"
            );
        }
    }

    #[test]
    fn web_mercator_is_recognised_and_mercator_is_not() {
        assert!(Crs::from_text("--crs", "EPSG:3857").unwrap().0.is_web_mercator);
        assert!(!Crs::from_text("--crs", "EPSG:3395").unwrap().0.is_web_mercator);
    }
}
