//! The vertical CRS of all heights: the requested one, or the one on which the files agree.

use std::path::Path;

use corniche_geom::Bounds;
use corniche_gis::{
    Crs, CrsError, CrsOperation, HeightOperation, LibraryError, VerticalCrs, forget, grid_names,
};

use crate::HeightDatumError;
use crate::files::source::Source;
use crate::files::stored_values::OpenOptions;

/// The largest shift that is accepted: the deepest trench and the highest mountain differ by only
/// 20 km.
const MAX_SHIFT_M: f64 = 100_000.0;

/// The vertical reference of a DEM's heights.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeightReference {
    /// The vertical CRS or its datum, if files or options name one.
    pub(crate) datum: Option<String>,
    /// The conversion of the files' heights, in words.
    pub(crate) conversion: String,
}

/// The operation that converts a file's heights from one vertical CRS to another, and its offset,
/// in words.
///
/// PROJ must know a true operation: its "ballpark" operations, which leave heights unchanged if a
/// grid is missing, are not allowed.
fn height_operation(
    source: &Source,
    [from, to]: [&VerticalCrs; 2],
    area_deg: Bounds,
    center_deg: [f64; 2],
) -> Result<(HeightOperation, String), HeightDatumError> {
    for vertical in [from, to] {
        // PROJ skips a missing grid that is marked in this way, and leaves heights unchanged.
        if let Some(grids) = vertical.grids().filter(|grids| grids.contains('@')) {
            return Err(HeightDatumError::OptionalGeoidGrid { grids });
        }
    }
    let found = HeightOperation::new(&source.crs, [from, to], area_deg);
    let mut center = [center_deg];
    CrsOperation::new(&Crs::wgs84()?, &source.crs, Some(area_deg)).apply(&mut center)?;
    // A missing grid causes an error when the operation is created, or all images are missing.
    forget();
    let points: Vec<[f64; 2]> = center.into_iter().chain(probes(source)).collect();
    let mut offsets_m = vec![0.0; points.len()];
    match found.carry(points.clone(), &mut offsets_m) {
        Err(CrsError::Transform { source: reason, .. }) => {
            return Err(no_operation(source, [from, to], Some(reason)));
        }
        Err(other) => return Err(other.into()),
        Ok(()) => {}
    }
    if offsets_m[1..].iter().all(|offset_m| offset_m.is_nan()) {
        return Err(no_operation(source, [from, to], None));
    }
    let at = offsets_m.iter().position(|offset_m| !offset_m.is_nan()).unwrap_or_default();
    // Rounded to whole millimetres; adding 0.0 turns −0.0 into 0.0.
    let offset_m = (offsets_m[at] * to.m_per_value() * 1000.0).round() / 1000.0 + 0.0;
    let place = match (at, points[at]) {
        (0, _) => "the centre".to_owned(),
        (_, [x, y]) => format!("{x}, {y} in {}", source.crs.label),
    };
    Ok((found, format!("{offset_m:+.3} m at {place}")))
}

/// Positions all over a file, its middle first.
fn probes(source: &Source) -> impl Iterator<Item = [f64; 2]> {
    const ALONG_A_SIDE: usize = 5;
    const COUNT: usize = ALONG_A_SIDE * ALONG_A_SIDE;
    let [columns, rows] = [source.columns as f64, source.rows as f64];
    let part = |k: usize, size: f64| (k as f64 + 0.5) / ALONG_A_SIDE as f64 * size;
    let order = std::iter::once(COUNT / 2).chain((0..COUNT).filter(|&k| k != COUNT / 2));
    order.map(move |k| {
        let pixel = [part(k % ALONG_A_SIDE, columns), part(k / ALONG_A_SIDE, rows)];
        source.crs_from_pixel.crs_from_pixel(pixel)
    })
}

/// The error for heights that PROJ cannot convert. PROJ does not say what is missing; only a grid
/// that is named as a file can be searched for.
fn no_operation(
    source: &Source,
    systems: [&VerticalCrs; 2],
    reason: Option<Box<LibraryError>>,
) -> HeightDatumError {
    let path = source.path.clone();
    let [from, to] = systems.map(|vertical| vertical.name.clone());
    let named = systems.iter().filter_map(|vertical| vertical.grids());
    let grids = named.reduce(|a, b| if a == b { a } else { format!("{a},{b}") });
    let is_gone = |grid: &&str| {
        let file = Path::new(grid);
        file.is_absolute() && !file.starts_with("/vsi") && !file.exists()
    };
    let gone: Vec<&str> = grids.iter().flat_map(|all| all.split(',')).filter(is_gone).collect();
    if !gone.is_empty() {
        return HeightDatumError::NoGeoidGrid { path, from, to, grids: gone.join(", ") };
    }
    let grids = grids.map_or("PROJ does not name it".to_owned(), |all| all.replace(',', ", "));
    HeightDatumError::VerticalOperation { path, from, to, grids, source: reason }
}

/// Decides on the vertical CRS of the heights, and prepares the files for it.
pub(crate) fn resolve(
    sources: &mut [Source],
    options: &OpenOptions,
    area_deg: Bounds,
    center_deg: [f64; 2],
) -> Result<HeightReference, HeightDatumError> {
    let shift_m = options.vertical_shift_m;
    if shift_m.is_nan() || shift_m.abs() > MAX_SHIFT_M {
        return Err(HeightDatumError::VerticalShift { shift_m, limit_m: MAX_SHIFT_M });
    }
    let target = options.vertical_crs.as_deref();
    let target = target.map(|text| VerticalCrs::from_text("--vertical-crs", text)).transpose()?;
    let mut heights = match &target {
        Some(target) => carry(sources, target, area_deg, center_deg)?,
        None => agree(sources)?,
    };
    if shift_m != 0.0 {
        heights.conversion = format!("{}, then {shift_m:+} m", heights.conversion);
        heights.datum = heights.datum.map(|datum| format!("{datum}, shifted by {shift_m:+} m"));
        for source in sources.iter_mut() {
            source.shift_m = shift_m;
        }
    }
    Ok(heights)
}

/// Converts all files to one vertical CRS.
fn carry(
    sources: &mut [Source],
    target: &VerticalCrs,
    area_deg: Bounds,
    center_deg: [f64; 2],
) -> Result<HeightReference, HeightDatumError> {
    // The conversions, and the offset in the first file with each.
    let mut texts: Vec<[String; 2]> = Vec::new();
    for source in sources.iter_mut() {
        let Some(own) = source.vertical.clone() else {
            let to = target.name.clone();
            return Err(HeightDatumError::NoVerticalCrs { path: source.path.clone(), to });
        };
        let text = if own.is_same_datum(target) {
            // Unit and direction are handled where stored values become metres.
            [target.label(), "as in the files".to_owned()]
        } else {
            // PROJ treats all unknown datums as one, and would leave the heights unchanged.
            if let Some(unnamed) =
                [&own, target].into_iter().find(|vertical| vertical.datum.is_none())
            {
                return Err(HeightDatumError::NoVerticalDatum {
                    path: source.path.clone(),
                    from: own.name.clone(),
                    to: target.name.clone(),
                    unnamed: unnamed.name.clone(),
                });
            }
            let (operation, offset) =
                height_operation(source, [&own, target], area_deg, center_deg)?;
            source.to_target = Some(operation);
            let grids: Vec<String> = [&own, target]
                .iter()
                .filter_map(|vertical| vertical.grids())
                .map(|grids| grid_names(&grids))
                .collect();
            let through = if grids.is_empty() {
                String::new()
            } else {
                format!(" through {}", grids.join(" and "))
            };
            [format!("{} carried to {}{through} by PROJ", own.name, target.label()), offset]
        };
        if !texts.iter().any(|[done, _]| *done == text[0]) {
            texts.push(text);
        }
    }
    let words: Vec<String> = texts.iter().map(|text| text.join(", ")).collect();
    Ok(HeightReference { datum: Some(target.label()), conversion: words.join("; ") })
}

/// Keeps heights unchanged, if all files agree on their vertical CRS.
fn agree(sources: &[Source]) -> Result<HeightReference, HeightDatumError> {
    let Some(first) = sources.first() else { return Ok(HeightReference::default()) };
    let is_other = |source: &&Source| match (&first.vertical, &source.vertical) {
        (Some(own), Some(other)) => !own.is_same_datum(other),
        (own, other) => own.is_some() != other.is_some(),
    };
    if let Some(other) = sources.iter().find(is_other) {
        let say = |source: &Source| match &source.vertical {
            Some(vertical) if vertical.datum.is_none() => {
                format!("in {}, which names no datum", vertical.name)
            }
            Some(vertical) => format!("in {}", vertical.name),
            None => "in no named vertical CRS".to_owned(),
        };
        return Err(HeightDatumError::MixedVertical {
            first: first.path.clone(),
            first_says: say(first),
            other: other.path.clone(),
            other_says: say(other),
        });
    }
    let is_down = |source: &Source| source.vertical.as_ref().is_some_and(|own| own.is_down);
    let words = if sources.iter().any(is_down) {
        "as in the files, depths turned into heights"
    } else {
        "as in the files"
    };
    // Heights in metres and in feet from one datum are the same once they are in metres.
    let names: Vec<&VerticalCrs> =
        sources.iter().filter_map(|source| source.vertical.as_ref()).collect();
    let datum = names.first().map(|own| {
        let is_one_name = names.iter().all(|other| other.name == own.name);
        own.datum.clone().filter(|_| !is_one_name).unwrap_or_else(|| own.label())
    });
    Ok(HeightReference { datum, conversion: words.to_owned() })
}
