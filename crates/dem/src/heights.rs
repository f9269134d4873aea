//! How heights are carried to another vertical CRS.

use std::path::Path;

use corniche_geom::{Bounds, GeoTransform};

use crate::crs::Crs;
use crate::library;
use crate::operation::Operation;
use crate::source::Source;
use crate::vertical::{VerticalCrs, file_names};
use crate::{DemError, LibraryError, OpenOptions};

/// Farther than this nothing is shifted: the deepest trench and the highest mountain lie 20 km apart.
const MAX_SHIFT_M: f64 = 100_000.0;

/// Carries heights of one file to the vertical CRS asked for, sample by sample.
#[derive(Debug, Clone)]
pub(crate) struct HeightOperation {
    /// From the file's horizontal system to that of the ellipsoidal heights, when that is another one.
    place: Option<Operation>,
    operation: Operation,
    /// Value in the source system for a metre upwards.
    values_per_m: f64,
    /// Metres upwards for a value in the target system.
    m_per_value: f64,
    target: String,
}

/// What the heights of a DEM are, once all is done.
#[derive(Debug, Clone, Default)]
pub(crate) struct Heights {
    pub(crate) datum: Option<String>,
    pub(crate) words: String,
}

impl HeightOperation {
    /// Between two systems over one horizontal system; and the offset it gives, in words.
    ///
    /// PROJ must know a true operation: its "ballpark" ones, which leave heights as they are where a grid is
    /// missing, are not allowed.
    fn new(
        source: &Source,
        [from, to]: [&VerticalCrs; 2],
        area_deg: Bounds,
        center_deg: [f64; 2],
    ) -> Result<(Self, String), DemError> {
        for vertical in [from, to] {
            // PROJ skips a grid marked so when it is missing, and leaves heights as they are.
            if let Some(grids) = vertical.grids().filter(|grids| grids.contains('@')) {
                return Err(DemError::OptionalGeoidGrid { grids });
            }
        }
        let place = (from.is_ellipsoidal && from.wkt != source.crs.wkt)
            .then(|| Operation::new(&source.crs, &from.with(&source.crs), Some(area_deg)));
        let operation = Operation::exact(&from.with(&source.crs), &to.with(&source.crs), area_deg);
        let found = Self {
            place,
            operation,
            values_per_m: 1.0 / from.m_per_value(),
            m_per_value: to.m_per_value(),
            target: to.name.clone(),
        };
        let mut center = [center_deg];
        Operation::new(&Crs::wgs84()?, &source.crs, Some(area_deg)).apply(&mut center)?;
        // A missing grid shows when the operation is made, or in that nothing has an image.
        library::forget();
        let points: Vec<[f64; 2]> = center.into_iter().chain(probes(source)).collect();
        let mut offsets_m = vec![0.0; points.len()];
        match found.carry(points.clone(), &mut offsets_m) {
            Err(DemError::Transform { source: reason, .. }) => {
                return Err(no_operation(source, [from, to], Some(reason)));
            }
            Err(other) => return Err(other),
            Ok(()) => {}
        }
        if offsets_m[1..].iter().all(|offset_m| offset_m.is_nan()) {
            return Err(no_operation(source, [from, to], None));
        }
        let at = offsets_m.iter().position(|offset_m| !offset_m.is_nan()).unwrap_or_default();
        // Whole millimetres; adding 0 makes zero of a negative zero.
        let offset_m = (offsets_m[at] * to.m_per_value() * 1000.0).round() / 1000.0 + 0.0;
        let place = match (at, points[at]) {
            (0, _) => "the centre".to_owned(),
            (_, [x, y]) => format!("{x}, {y} in {}", source.crs.label),
        };
        Ok((found, format!("{offset_m:+.3} m at {place}")))
    }

    /// Values of the source system, at positions in the file's horizontal one, to those of the target.
    fn carry(&self, mut points: Vec<[f64; 2]>, values: &mut [f64]) -> Result<(), DemError> {
        if let Some(place) = &self.place {
            place.apply(&mut points)?;
        }
        self.operation.apply_heights(&points, values)
    }

    /// Carries heights in metres, in place; voids (NaN) stay.
    ///
    /// Each by the position of its own sample, counted in the whole file: what comes out does not depend on the
    /// rectangle read.
    pub(crate) fn apply(
        &self,
        path: &Path,
        crs_from_pixel: &GeoTransform,
        [column, row]: [usize; 2],
        columns: usize,
        heights_m: &mut [f64],
    ) -> Result<(), DemError> {
        let places: Vec<usize> =
            (0..heights_m.len()).filter(|&at| !heights_m[at].is_nan()).collect();
        let points: Vec<[f64; 2]> = places
            .iter()
            .map(|at| [(column + at % columns) as f64 + 0.5, (row + at / columns) as f64 + 0.5])
            .map(|pixel| crs_from_pixel.crs_from_pixel(pixel))
            .collect();
        let mut values: Vec<f64> =
            places.iter().map(|&at| heights_m[at] * self.values_per_m).collect();
        self.carry(points, &mut values)?;
        for (&at, value) in places.iter().zip(values) {
            if value.is_nan() {
                let (column, row) = (column + at % columns, row + at / columns);
                let to = self.target.clone();
                return Err(DemError::VerticalPosition {
                    path: path.to_path_buf(),
                    column,
                    row,
                    to,
                });
            }
            heights_m[at] = value * self.m_per_value;
        }
        Ok(())
    }
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

/// Why PROJ cannot carry heights. It does not say what it lacks; only a file that is not there is certain.
fn no_operation(
    source: &Source,
    systems: [&VerticalCrs; 2],
    reason: Option<Box<LibraryError>>,
) -> DemError {
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
        return DemError::NoGeoidGrid { path, from, to, grids: gone.join(", ") };
    }
    let grids = grids.map_or("PROJ does not say which".to_owned(), |all| all.replace(',', ", "));
    DemError::VerticalOperation { path, from, to, grids, source: reason }
}

/// Decides what becomes of the files' heights, and prepares the files for it.
pub(crate) fn resolve(
    sources: &mut [Source],
    options: &OpenOptions,
    area_deg: Bounds,
    center_deg: [f64; 2],
) -> Result<Heights, DemError> {
    let shift_m = options.vertical_shift_m;
    if shift_m.is_nan() || shift_m.abs() > MAX_SHIFT_M {
        return Err(DemError::VerticalShift { shift_m, limit_m: MAX_SHIFT_M });
    }
    let target = options.vertical_crs.as_deref();
    let target = target.map(|text| VerticalCrs::from_text("--vertical-crs", text)).transpose()?;
    let mut heights = match &target {
        Some(target) => carry(sources, target, area_deg, center_deg)?,
        None => agree(sources)?,
    };
    if shift_m != 0.0 {
        heights.words = format!("{}, then {shift_m:+} m", heights.words);
        heights.datum = heights.datum.map(|datum| format!("{datum}, shifted by {shift_m:+} m"));
        for source in sources.iter_mut() {
            source.shift_m = shift_m;
        }
    }
    Ok(heights)
}

/// All files to one vertical CRS.
fn carry(
    sources: &mut [Source],
    target: &VerticalCrs,
    area_deg: Bounds,
    center_deg: [f64; 2],
) -> Result<Heights, DemError> {
    // What was done, and the offset it gave in the first file it was done to.
    let mut texts: Vec<[String; 2]> = Vec::new();
    for source in sources.iter_mut() {
        let Some(own) = source.vertical.clone() else {
            let to = target.name.clone();
            return Err(DemError::NoVerticalCrs { path: source.path.clone(), to });
        };
        let text = if own.is_same_datum(target) {
            // Unit and direction are seen to where values become metres.
            [target.label(), "as in the files".to_owned()]
        } else {
            // PROJ takes all that is unknown for one datum, and would change nothing.
            if let Some(unnamed) =
                [&own, target].into_iter().find(|vertical| vertical.datum.is_none())
            {
                return Err(DemError::NoVerticalDatum {
                    path: source.path.clone(),
                    from: own.name.clone(),
                    to: target.name.clone(),
                    unnamed: unnamed.name.clone(),
                });
            }
            let (operation, offset) =
                HeightOperation::new(source, [&own, target], area_deg, center_deg)?;
            source.to_target = Some(operation);
            let grids: Vec<String> = [&own, target]
                .iter()
                .filter_map(|vertical| vertical.grids())
                .map(|grids| file_names(&grids))
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
    Ok(Heights { datum: Some(target.label()), words: words.join("; ") })
}

/// Heights as they are, when all files say the same of them.
fn agree(sources: &[Source]) -> Result<Heights, DemError> {
    let Some(first) = sources.first() else { return Ok(Heights::default()) };
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
        return Err(DemError::MixedVertical {
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
    // Metres and feet of one datum are one thing once they are metres.
    let names: Vec<&VerticalCrs> =
        sources.iter().filter_map(|source| source.vertical.as_ref()).collect();
    let datum = names.first().map(|own| {
        let is_one_name = names.iter().all(|other| other.name == own.name);
        own.datum.clone().filter(|_| !is_one_name).unwrap_or_else(|| own.label())
    });
    Ok(Heights { datum, words: words.to_owned() })
}
