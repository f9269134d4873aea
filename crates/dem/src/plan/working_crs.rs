//! The choice of the working CRS, and how its coordinates become working metres.

use corniche_geom::{Bounds, ScaleRecord};
use corniche_gis::{
    Crs, CrsError, CrsOperation, GridCrs, LocalScale, SCALES, crs_from_text, scales,
};
use gdal::errors::GdalError;
use gdal::spatial_ref::SpatialRef;

use crate::mosaics::mosaic::{Mosaic, rounded};
use crate::{Dem, GridError};

/// The DEM's own CRS is the working CRS if lengths are then true within this, all over the data:
/// nodes that are exactly samples are worth more than 3 % of a width.
const OWN_TOLERANCE: f64 = 0.03;
/// A projection this true to scale, along x and y and all over the data, keeps its unit; UTM is
/// chosen if it is this true in all directions.
const TRUE_TOLERANCE: f64 = 0.01;
/// UTM is defined between these latitudes.
const UTM_LATITUDES_DEG: [f64; 2] = [-80.0, 84.0];
/// Significant digits of a factor that depends on PROJ's scale: enough for a tenth of a millimetre
/// in a hundred kilometres, few enough that versions of PROJ agree.
const FACTOR_DIGITS: usize = 9;

/// The standard latitude: the latitude at which lengths are true.
#[derive(Debug, Clone, Copy)]
struct StandardLatitude {
    deg: f64,
    /// Whether the user gave the latitude; otherwise it follows from the data.
    is_given: bool,
}

/// A CRS with factors, around the middle of the data.
fn around_data(crs: Crs, metres_per_unit: [f64; 2], dem: &Dem) -> Result<GridCrs, CrsError> {
    let own = &dem.mosaics[0];
    let middle = if crs.is_same(&own.crs) {
        own.middle()[0]
    } else {
        // The longitudes of files all around the earth begin and end at the same place, which is
        // not opposite the mean of their positions.
        let [lon, lat] = dem.center_deg;
        let is_ring = dem.mosaics.iter().any(Mosaic::is_ring);
        let lon = if is_ring { dem.wgs84_bounds.center()[0] } else { lon };
        let mut middle = [[lon, lat]];
        CrsOperation::new(&Crs::wgs84()?, &crs, Some(dem.wgs84_bounds)).apply(&mut middle)?;
        middle[0][0]
    };
    Ok(GridCrs { crs, metres_per_unit, middle, is_scaled: false })
}

/// A CRS with the factors that make lengths true at the standard latitude; `None` if this latitude
/// is outside the CRS.
///
/// Whether a projection is true to scale without factors is tested all over the data; with a given
/// latitude, only at this latitude and the middle longitude, so that packages of adjoining regions
/// fit.
fn with_true_lengths(
    dem: &Dem,
    crs: &Crs,
    latitude: StandardLatitude,
) -> Result<Option<GridCrs>, CrsError> {
    let scaled = |factors: [f64; 2]| {
        let plain = around_data(crs.clone(), factors, dem)?;
        Ok(Some(GridCrs { is_scaled: true, ..plain }))
    };
    if let Some(factors) = crs.metres_per_turn_unit(latitude.deg)? {
        return scaled(factors);
    }
    let unit = crs.signs().map(|sign| sign * crs.unit_m);
    let plain = around_data(crs.clone(), unit, dem)?;
    let is_true = |scale: &Option<LocalScale>| {
        let is_near = |along: &f64| (along - 1.0).abs() <= TRUE_TOLERANCE;
        scale.is_some_and(|scale| scale.along.iter().all(is_near))
    };
    let [lon, _] = dem.wgs84_bounds.center();
    let scale = scale_at(&plain, dem, [lon, latitude.deg])?;
    let is_plain = if latitude.is_given {
        is_true(&scale)
    } else {
        rim_scales(&plain, dem)?.iter().all(is_true)
    };
    if is_plain {
        return Ok(Some(plain));
    }
    let is_usable = |scale: &LocalScale| scale.along.iter().all(|at| SCALES.contains(at));
    let Some(scale) = scale.filter(is_usable) else { return Ok(None) };
    scaled([0, 1].map(|axis| rounded(unit[axis] / scale.along[axis], FACTOR_DIGITS)))
}

/// The scale at a position.
fn scale_at(
    working: &GridCrs,
    dem: &Dem,
    place_deg: [f64; 2],
) -> Result<Option<LocalScale>, CrsError> {
    Ok(scales_at(working, dem, &Crs::wgs84()?, vec![place_deg])?[0])
}

fn scales_at(
    working: &GridCrs,
    dem: &Dem,
    crs: &Crs,
    mut places: Vec<[f64; 2]>,
) -> Result<Vec<Option<LocalScale>>, CrsError> {
    let area_deg = Some(dem.wgs84_bounds);
    CrsOperation::into_working(crs, working, area_deg).apply(&mut places)?;
    scales(&CrsOperation::out_of_working(working, &Crs::wgs84()?, area_deg), &places)
}

/// The scales at the corners, middles of sides and centre of every file; `None` for a position
/// outside the CRS.
fn rim_scales(working: &GridCrs, dem: &Dem) -> Result<Vec<Option<LocalScale>>, CrsError> {
    let mut all = Vec::new();
    for mosaic in &dem.mosaics {
        all.extend(scales_at(working, dem, &mosaic.crs, rim_of(mosaic))?);
    }
    Ok(all)
}

/// Whether lengths are true within `tolerance` in every direction, all over the data.
fn is_true_within(working: &GridCrs, dem: &Dem, tolerance: f64) -> Result<bool, CrsError> {
    let is_true =
        |scale: &Option<LocalScale>| scale.is_some_and(|scale| scale.deviation <= tolerance);
    Ok(rim_scales(working, dem)?.iter().all(is_true))
}

/// The scale of lengths.
pub(crate) fn scale(working: &GridCrs, dem: &Dem) -> Result<ScaleRecord, GridError> {
    let outside = || GridError::OutsideCrs { crs: working.crs.label.clone() };
    // The middle of the rectangle, because the standard latitude is taken there; the mean of all
    // positions may be far from any data.
    let center = match scale_at(working, dem, dem.wgs84_bounds.center())? {
        Some(center) => center,
        None => scale_at(working, dem, dem.center_deg)?.ok_or_else(outside)?,
    };
    // Corners outside the area of the CRS (which the user may have chosen) are omitted.
    let mut scale =
        ScaleRecord { center: center.along, least: center.along, largest: center.along };
    for LocalScale { along, .. } in rim_scales(working, dem)?.into_iter().flatten() {
        let merge = |known: [f64; 2], pick: fn(f64, f64) -> f64| {
            [pick(known[0], along[0]), pick(known[1], along[1])]
        };
        scale.least = merge(scale.least, f64::min);
        scale.largest = merge(scale.largest, f64::max);
    }
    let recorded = |along: [f64; 2]| along.map(|at| at.clamp(*SCALES.start(), *SCALES.end()));
    Ok(ScaleRecord {
        center: recorded(scale.center),
        least: recorded(scale.least),
        largest: recorded(scale.largest),
    })
}

/// Chooses the working CRS; see [`Dem::plan`].
pub(crate) fn choose(
    dem: &Dem,
    asked: Option<&str>,
    scale_latitude_deg: Option<f64>,
) -> Result<GridCrs, GridError> {
    let latitude = match scale_latitude_deg {
        Some(given) if (-89.0..=89.0).contains(&given) => {
            StandardLatitude { deg: given, is_given: true }
        }
        Some(given) => return Err(GridError::ScaleLatitude { latitude_deg: given }),
        None => StandardLatitude { deg: standard_latitude_deg(dem.wgs84_bounds), is_given: false },
    };
    let own = || with_true_lengths(dem, &dem.mosaics[0].crs, latitude);
    let word = asked.map(str::to_ascii_lowercase);
    match word.as_deref() {
        None => {}
        Some("dem") => {
            let crs = || dem.mosaics[0].crs.label.clone();
            return match own()? {
                Some(own) if is_right_handed(&own, dem)? => Ok(own),
                _ => Err(GridError::OwnCrs { crs: crs() }),
            };
        }
        Some("utm") => {
            if let Some(latitude_deg) = scale_latitude_deg {
                return Err(GridError::ScaleLatitudeUtm { latitude_deg });
            }
            let bounds = dem.wgs84_bounds;
            return utm(dem)?.ok_or(GridError::NoUtm { south: bounds.min_y, north: bounds.max_y });
        }
        Some(_) => {
            let text = asked.unwrap_or_default();
            let (crs, _) = crs_from_text("--crs", text).map_err(|error| match error {
                CrsError::Text { text, source, .. } => GridError::WorkingCrsText { text, source },
                other => other.into(),
            })?;
            let refuse = || GridError::WorkingCrs { text: text.to_owned() };
            if !crs.is_projected() && !crs.is_same(&dem.mosaics[0].crs) {
                return Err(refuse());
            }
            let outside = || GridError::OutsideCrs { crs: crs.label.clone() };
            let working = with_true_lengths(dem, &crs, latitude)?.ok_or_else(outside)?;
            return if is_right_handed(&working, dem)? { Ok(working) } else { Err(refuse()) };
        }
    }
    if let Some(own) = own()?
        && is_true_within(&own, dem, OWN_TOLERANCE)?
    {
        return Ok(own);
    }
    if let Some(utm) = utm(dem)?
        && is_true_within(&utm, dem, TRUE_TOLERANCE)?
    {
        return Ok(utm);
    }
    Ok(equal_area(dem)?)
}

/// Whether y is to the left of x in the middle of the data.
fn is_right_handed(working: &GridCrs, dem: &Dem) -> Result<bool, CrsError> {
    let scale = scale_at(working, dem, dem.center_deg)?;
    Ok(scale.is_some_and(|scale| scale.deviation.is_finite()))
}

/// The latitude at which lengths are true: the middle of the data, rounded to 10⁻⁶ degrees and then
/// to the nearest half degree (ties towards the equator), so that small changes of the extent do
/// not change the grid.
fn standard_latitude_deg(bounds: Bounds) -> f64 {
    let middle = (bounds.center()[1] * 1e6).round() / 1e6;
    let halves = middle.abs() * 2.0;
    // Fractions up to a half are rounded down, so a tie is rounded down.
    let rounded = if halves.fract() > 0.5 { halves.ceil() } else { halves.floor() };
    (rounded / 2.0).copysign(middle) + 0.0
}

/// The UTM zone of the data's centre; `None` where UTM is not defined.
fn utm(dem: &Dem) -> Result<Option<GridCrs>, CrsError> {
    let bounds = dem.wgs84_bounds;
    if bounds.min_y < UTM_LATITUDES_DEG[0] || bounds.max_y > UTM_LATITUDES_DEG[1] {
        return Ok(None);
    }
    let [lon, lat] = dem.center_deg;
    let zone = (((lon + 180.0) / 6.0).floor() as u32).min(59) + 1;
    let code = if lat < 0.0 { 32700 } else { 32600 } + zone;
    let (crs, _) = crs_from_text("the chosen", &format!("EPSG:{code}"))?;
    Ok(Some(around_data(crs, [1.0; 2], dem)?))
}

/// Lambert azimuthal equal-area about the data's centre, rounded to whole degrees so that small
/// changes of the extent do not change the grid.
fn equal_area(dem: &Dem) -> Result<GridCrs, CrsError> {
    let [lon, lat] = dem.center_deg.map(f64::round);
    let text = format!(
        "+proj=laea +lat_0={lat} +lon_0={lon} +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"
    );
    let reference = SpatialRef::from_proj4(&text).map_err(|source: GdalError| CrsError::Text {
        option: "the chosen",
        text,
        source: source.into(),
    })?;
    let mut crs = Crs::from_spatial_ref(&reference)?;
    crs.label = format!("Lambert azimuthal equal-area about {lat}, {lon}");
    around_data(crs, [1.0; 2], dem)
}

/// The CRS positions of the corners, the middles of the sides and the centre of every file.
fn rim_of(mosaic: &Mosaic) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for file in &mosaic.files {
        let ends = |axis: usize| {
            let (low, high) = (file.rect.min[axis] as f64, (file.rect.max[axis] - 1) as f64);
            [low, f64::midpoint(low, high), high]
        };
        for column in ends(0) {
            points.extend(ends(1).map(|row| mosaic.crs_from_sample.crs_from_pixel([column, row])));
        }
    }
    points
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "half degrees are exact")]
#[path = "working_crs_tests.rs"]
mod tests;
