//! The vertical CRS of a package, found by its recorded name, and the conversion of heights to the
//! ellipsoid of WGS84.

use std::ops::RangeInclusive;

use corniche_geom::Bounds;

use crate::crs::height_operation::HeightOperation;
use crate::crs::horizontal::Crs;
use crate::crs::recorded::{ProjectedCrs, RecordedCrs};
use crate::crs::vertical::VerticalCrs;
use crate::crs::wkt::quoted;
use crate::{CrsError, library_error};

/// WGS84 in three dimensions.
const WGS84_3D: &str = "EPSG:4979";
/// Systems with ellipsoidal heights that are used by elevation models, by their codes in the EPSG
/// registry.
const ELLIPSOIDAL: [u16; 8] = [4979, 4937, 6319, 4939, 7843, 4959, 4955, 9989];
/// The ranges of codes of vertical systems in the EPSG registry. Codes of other systems in these
/// ranges are skipped.
const VERTICAL: [RangeInclusive<u16>; 12] = [
    5701..=5799,
    3855..=3900,
    5597..=5621,
    5193..=5336,
    5829..=5874,
    6130..=6187,
    6357..=6360,
    6638..=6695,
    7651..=7707,
    7832..=7979,
    8357..=8378,
    9245..=9303,
];

/// The vertical reference of a package's heights, if the recorded name leads to a vertical CRS.
#[derive(Debug, Clone)]
pub struct RecordedHeights {
    horizontal: Crs,
    metres_per_unit: [f64; 2],
    vertical: VerticalCrs,
    /// `None` if heights are ellipsoidal heights of WGS84 already.
    to_wgs84: Option<HeightOperation>,
}

impl RecordedHeights {
    /// Finds the vertical CRS with the recorded name `datum`. Searches the systems in `named`
    /// ("EPSG:n" or WKT: those given when the package was built), then those of the EPSG registry.
    /// `None` if none has this name: the datum is unknown, was shifted, or is not registered.
    ///
    /// # Errors
    /// When PROJ does not know WGS84.
    pub fn find(
        crs: &RecordedCrs,
        datum: &str,
        named: &[&str],
        wgs84_bounds: Bounds,
    ) -> Result<Option<Self>, CrsError> {
        library_error::quiet();
        let is_meant = |found: &VerticalCrs| found.label() == datum;
        let given = named.iter().filter_map(|text| known(text));
        let ellipsoidal = ELLIPSOIDAL.into_iter().filter_map(of_code);
        let vertical = VERTICAL.into_iter().flatten().filter_map(of_code);
        let Some(vertical) = given.chain(ellipsoidal).chain(vertical).find(is_meant) else {
            return Ok(None);
        };
        let working = crs.working();
        let wgs84 = VerticalCrs::from_text("the built-in", WGS84_3D)?;
        let to_wgs84 = (!vertical.is_same_datum(&wgs84))
            .then(|| HeightOperation::new(&working.crs, [&vertical, &wgs84], wgs84_bounds));
        Ok(Some(Self {
            horizontal: working.crs.clone(),
            metres_per_unit: working.metres_per_unit,
            vertical,
            to_wgs84,
        }))
    }

    /// The name that packages record for heights in metres upwards of the vertical CRS `text`;
    /// `None` for one in other units or with depths.
    ///
    /// # Errors
    /// When PROJ knows no such vertical CRS.
    pub fn datum_in_metres(text: &str) -> Result<Option<String>, CrsError> {
        library_error::quiet();
        let vertical = VerticalCrs::from_text("--dem-vertical-crs", text)?;
        Ok(vertical.is_plain().then(|| vertical.label()))
    }

    /// The WKT2 of the package's CRS together with its heights in metres upwards: a compound CRS,
    /// or one with three axes. `None` for ellipsoidal heights of another system than the horizontal
    /// one, which WKT cannot express.
    #[must_use]
    pub fn wkt(&self) -> Option<String> {
        let Self { horizontal, vertical, .. } = self;
        if vertical.is_ellipsoidal {
            let is_its_own = !horizontal.is_projected()
                && quoted(&horizontal.wkt).is_some_and(|name| quoted(&vertical.wkt) == Some(name));
            return is_its_own.then(|| vertical.wkt.to_string());
        }
        Some(self.compound(&horizontal.wkt))
    }

    /// The same for another projected CRS; `None` for ellipsoidal heights, which WKT cannot express
    /// there.
    #[must_use]
    pub fn wkt_with(&self, crs: &ProjectedCrs) -> Option<String> {
        (!self.vertical.is_ellipsoidal).then(|| self.compound(crs.wkt()))
    }

    fn compound(&self, horizontal: &str) -> String {
        let registered = registered_in_metres(&self.vertical);
        let upwards = registered.unwrap_or_else(|| self.vertical.metres_upwards_wkt());
        let name = |wkt| quoted(wkt).unwrap_or("unnamed");
        let both = format!("{} + {}", name(horizontal), name(&upwards));
        format!("COMPOUNDCRS[\"{both}\",{horizontal},{upwards}]")
    }

    /// Replaces heights in metres, at positions in working metres, by heights above the ellipsoid
    /// of WGS84; NaN if there is none. A geoid grid that is not installed is never replaced by an
    /// approximation.
    ///
    /// # Errors
    /// When PROJ has no exact operation.
    pub fn to_wgs84_m(
        &self,
        positions_m: &[[f64; 2]],
        heights_m: &mut [f64],
    ) -> Result<(), CrsError> {
        let Some(operation) = &self.to_wgs84 else { return Ok(()) };
        let [unit_x, unit_y] = self.metres_per_unit;
        let place = |&[x, y]: &[f64; 2]| {
            let x = x / unit_x;
            // Beyond the antimeridian, longitudes continue; grids end there.
            let turns = self.horizontal.turn_angle().map_or(0.0, |turn| turn * (x / turn).round());
            [x - turns, y / unit_y]
        };
        let m_per_value = self.vertical.m_per_value();
        for height in heights_m.iter_mut() {
            *height /= m_per_value;
        }
        operation.carry(positions_m.iter().map(place).collect(), heights_m)
    }
}

fn known(text: &str) -> Option<VerticalCrs> {
    VerticalCrs::from_text("the package's", text).ok()
}

fn of_code(code: u16) -> Option<VerticalCrs> {
    known(&format!("EPSG:{code}"))
}

/// The registered system of the same datum in metres upwards, for one in feet or downwards: formats
/// that name systems by codes, such as `GeoTIFF`, cannot express one without a code. `None` if the
/// system itself is in metres upwards, or there is no other.
fn registered_in_metres(vertical: &VerticalCrs) -> Option<String> {
    let datum = vertical.datum.as_ref().filter(|_| !vertical.is_plain())?;
    let is_meant = |found: &VerticalCrs| found.is_plain() && found.datum.as_ref() == Some(datum);
    let found = VERTICAL.into_iter().flatten().filter_map(of_code).find(is_meant)?;
    Some(found.wkt.to_string())
}

#[cfg(test)]
#[path = "recorded_heights_tests.rs"]
mod tests;
