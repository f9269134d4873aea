use std::sync::Arc;

use gdal::config;
use gdal::errors::GdalError;
use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};

use crate::DemError;

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

/// What a coordinate system says about heights.
#[derive(Debug, Clone, Default)]
pub(crate) struct VerticalCrs {
    /// Its name.
    pub(crate) datum: Option<String>,
    /// Metres to a unit of height.
    pub(crate) unit_m: Option<f64>,
}

impl Crs {
    pub(crate) fn from_spatial_ref(reference: &SpatialRef) -> Result<Self, DemError> {
        let name = reference.name().unwrap_or_else(|| "unnamed".to_owned());
        let wkt = wkt2(reference)
            .map_err(|source| DemError::Wkt { name: name.clone(), source: Box::new(source) })?;
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
    ) -> Result<(Self, VerticalCrs), DemError> {
        let reference = SpatialRef::from_definition(text).map_err(|source| DemError::CrsText {
            option,
            text: text.to_owned(),
            source: Box::new(source),
        })?;
        match Self::horizontal(&reference)? {
            Some(found) => Ok(found),
            None => Err(DemError::CrsText {
                option,
                text: text.to_owned(),
                source: Box::new(GdalError::BadArgument(
                    "neither projected nor geographic".to_owned(),
                )),
            }),
        }
    }

    /// The horizontal part of a system and what it says about heights; `None` when it is neither projected nor
    /// geographic.
    pub(crate) fn horizontal(
        reference: &SpatialRef,
    ) -> Result<Option<(Self, VerticalCrs)>, DemError> {
        let mut reference = reference.clone();
        let mut vertical = VerticalCrs::default();
        if reference.is_compound() {
            let name = reference.name().unwrap_or_default();
            let wkt = wkt2(&reference)
                .map_err(|source| DemError::Wkt { name: name.clone(), source: Box::new(source) })?;
            let parts = children(&wkt);
            if let Some(text) = parts.iter().find(|part| part.starts_with("VERT")) {
                vertical.datum = quoted(text).map(str::to_owned);
                vertical.unit_m = length_unit(text);
            }
            // The heights' own system must not take part: it would ask PROJ for geoid grids.
            let horizontal = ["PROJ", "GEOG", "GEOD", "BOUNDCRS"];
            let Some(text) =
                parts.iter().find(|part| horizontal.iter().any(|word| part.starts_with(word)))
            else {
                return Ok(None);
            };
            reference = SpatialRef::from_wkt(text)
                .map_err(|source| DemError::Wkt { name, source: Box::new(source) })?;
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
            source: Box::new(source),
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

fn wkt2(reference: &SpatialRef) -> Result<String, GdalError> {
    const FORMAT: &str = "OSR_WKT_FORMAT";
    config::set_thread_local_config_option(FORMAT, "WKT2_2018")?;
    let wkt = reference.to_wkt();
    config::clear_thread_local_config_option(FORMAT)?;
    wkt
}

/// First quoted text of a WKT node: its name.
fn quoted(wkt: &str) -> Option<&str> {
    wkt.split('"').nth(1)
}

/// Metres to the unit of length named in a WKT node.
fn length_unit(wkt: &str) -> Option<f64> {
    let start = wkt.find("LENGTHUNIT[").or_else(|| wkt.find("UNIT["))?;
    let fields = &wkt[start..];
    let number = fields.split('"').nth(2)?.trim_start_matches(',');
    number.split([',', ']']).next()?.trim().parse().ok()
}

/// The nodes and values directly inside the outermost brackets of a WKT text.
fn children(wkt: &str) -> Vec<String> {
    let Some(open) = wkt.find('[') else { return Vec::new() };
    let mut parts = vec![String::new()];
    let (mut depth, mut in_quotes) = (0, false);
    for letter in wkt[open + 1..].chars() {
        match letter {
            '"' => in_quotes = !in_quotes,
            '[' if !in_quotes => depth += 1,
            ']' if !in_quotes && depth == 0 => break,
            ']' if !in_quotes => depth -= 1,
            ',' if !in_quotes && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(part) = parts.last_mut() {
            part.push(letter);
        }
    }
    parts.iter().map(|part| part.trim().to_owned()).skip(1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wkt_is_taken_apart_at_its_own_commas() {
        let wkt = r#"PROJCS["a, b",GEOGCS["x [y]",1,2],UNIT["m",1]]"#;
        assert_eq!(children(wkt), [r#"GEOGCS["x [y]",1,2]"#, r#"UNIT["m",1]"#]);
        assert_eq!(quoted(wkt), Some("a, b"));
    }

    #[test]
    fn a_compound_system_is_split_into_plan_and_height() {
        let (crs, vertical) = Crs::from_text("--dem-crs", "EPSG:32633+6360").unwrap();
        assert_eq!(crs.label, "EPSG:32633");
        assert_eq!(vertical.datum.as_deref(), Some("NAVD88 height (ftUS)"));
        assert!((vertical.unit_m.unwrap() - 1200.0 / 3937.0).abs() < 1e-12);
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
