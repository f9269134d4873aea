//! Cylindrical projections, in which x is proportional to the longitude: x repeats after a turn
//! around the earth, like degrees.

use std::cell::RefCell;
use std::collections::HashMap;

use gdal::errors::GdalError;
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};

/// Methods of projections that may be cylindrical, by parts of their names; other methods are not
/// tested.
const NAMED: [&str; 5] = ["mercator", "cylindrical", "plate carr", "miller", "gall"];
/// Parts of the names of methods that match [`NAMED`] but are not cylindrical in the normal aspect.
const TURNED: [&str; 4] = ["transverse", "oblique", "hotine", "laborde"];
/// The number of longitudes that are tested in a full turn.
const PLACES: usize = 12;
/// The tolerance for equal steps of x, relative to a twelfth of a turn.
const EVEN: f64 = 1e-9;

thread_local! {
    static KNOWN: RefCell<HashMap<String, Option<f64>>> = RefCell::new(HashMap::new());
}

/// The range of x in a turn around the earth, in the system's unit; `None` for projections that are
/// not cylindrical.
pub(crate) fn turn_of(reference: &SpatialRef, wkt: &str) -> Option<f64> {
    if !is_named(wkt) {
        return None;
    }
    if let Some(known) = KNOWN.with_borrow(|known| known.get(wkt).copied()) {
        return known;
    }
    // A projection that PROJ cannot compute is treated as not cylindrical.
    let found = measured(reference).unwrap_or_default();
    KNOWN.with_borrow_mut(|known| known.insert(wkt.to_owned(), found));
    found
}

/// Whether a method in the WKT has a name of such projections.
fn is_named(wkt: &str) -> bool {
    ["METHOD[\"", "PROJECTION[\""].iter().flat_map(|keyword| wkt.split(keyword).skip(1)).any(
        |rest| {
            let name = rest.split('"').next().unwrap_or_default().to_lowercase();
            let has = |part: &&str| name.contains(part);
            NAMED.iter().any(&has) && !TURNED.iter().any(has)
        },
    )
}

/// Transforms positions at two latitudes, each a twelfth of a turn from the previous one.
fn measured(reference: &SpatialRef) -> Result<Option<f64>, GdalError> {
    let mut to = reference.clone();
    to.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let mut from = reference.geog_cs()?;
    from.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let around = std::f64::consts::TAU / from.angular_units();
    let transform = CoordTransform::new(&from, &to)?;
    // No position lies at ±180°, or at the longitude at which the map of most systems begins.
    let lon = |place: usize| around * ((place as f64 + 0.4) / PLACES as f64 - 0.5);
    let mut x: Vec<f64> = [0, 1].iter().flat_map(|_| (0..PLACES).map(lon)).collect();
    let mut y: Vec<f64> =
        [0.0, around / 9.0].iter().flat_map(|&lat| (0..PLACES).map(move |_| lat)).collect();
    transform.transform_coords(&mut x, &mut y, &mut [])?;
    let mut steps: Vec<f64> = x[..PLACES].windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    // One of the steps may cross the end of the map.
    let step = steps[PLACES / 2];
    let is = |value: f64, wanted: f64| (value - wanted).abs() <= EVEN * step.abs();
    let turn = PLACES as f64 * step;
    let is_even = steps.iter().all(|&own| is(own, step) || is(own, step - turn));
    let (low, high) = x.split_at(PLACES);
    let is_upright = low.iter().zip(high).all(|(&low, &high)| is(low, high));
    let is_level = y[PLACES..].iter().all(|&own| is(own, y[PLACES]));
    Ok((is_even && is_upright && is_level && turn != 0.0).then_some(turn.abs()))
}

#[cfg(test)]
#[path = "cylindrical_tests.rs"]
mod tests;
