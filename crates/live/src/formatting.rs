//! Numbers, choices and errors as text for people.

use std::error::Error;

use corniche_viewer::{RoadMethod, flight::WorkingCrs};

/// A length on the ground: "350 m", "12.5 km".
#[must_use]
pub fn length(m: f64) -> String {
    if m.abs() >= 10_000.0 {
        format!("{:.1} km", m / 1000.0)
    } else if m.abs() >= 10.0 {
        format!("{m:.0} m")
    } else {
        format!("{m:.1} m")
    }
}

/// The name of a method.
#[must_use]
pub fn method(method: RoadMethod) -> &'static str {
    match method {
        RoadMethod::Geometry => "GEO",
        RoadMethod::ShadowVolumes => "SV",
        RoadMethod::None => "none",
    }
}

/// Bytes in MiB.
#[must_use]
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Coordinates of the CRS, to a decimetre: "EPSG:32632  539512.3  5221456.8".
#[must_use]
pub fn coordinates(working: WorkingCrs<'_>, at_m: [f64; 2]) -> String {
    let [x, y] = [0, 1].map(|axis: usize| {
        let unit_m = working.metres_per_unit[axis];
        // The unit is a degree: six digits.
        let digits = if unit_m.abs() > 1000.0 { 6 } else { 1 };
        format!("{:.digits$}", at_m[axis] / unit_m)
    });
    format!("{}  {x}  {y}", working.crs)
}

/// A position in degrees: "47.14012° N, 9.52201° E".
#[must_use]
pub fn position([lon_deg, lat_deg]: [f64; 2]) -> String {
    let side = |value: f64, positive, negative| if value < 0.0 { negative } else { positive };
    // In a package that crosses the antimeridian, longitudes continue beyond 180.
    let lon_deg = (lon_deg + 180.0).rem_euclid(360.0) - 180.0;
    format!(
        "{:.5}° {}, {:.5}° {}",
        lat_deg.abs(),
        side(lat_deg, 'N', 'S'),
        lon_deg.abs(),
        side(lon_deg, 'E', 'W')
    )
}

/// A heading as on a compass: 0 to 359 whole degrees.
#[must_use]
pub fn heading(heading_deg: f64) -> String {
    // Adding 0.0 turns −0.0 into 0.0.
    format!("{:03.0}°", heading_deg.round().rem_euclid(360.0) + 0.0)
}

/// An error and its causes, on one line.
#[must_use]
pub fn with_causes(error: &dyn Error) -> String {
    let causes = std::iter::successors(error.source(), |cause| (*cause).source());
    causes.fold(error.to_string(), |said, cause| format!("{said}: {cause}"))
}

#[cfg(test)]
#[path = "formatting_tests.rs"]
mod tests;
