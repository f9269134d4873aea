//! What heights are measured from, and how they are carried to another vertical CRS.

use std::path::Path;
use std::sync::Arc;

use corniche_geom::{Bounds, GeoTransform};
use gdal::spatial_ref::SpatialRef;

use crate::crs::{Crs, wkt2};
use crate::library;
use crate::operation::Operation;
use crate::source::Source;
use crate::wkt::{child, children, keyword, length_unit_m, quoted};
use crate::{DemError, LibraryError, OpenOptions};

/// Farther than this nothing is shifted: the deepest trench and the highest mountain lie 20 km apart.
const MAX_SHIFT_M: f64 = 100_000.0;

/// A vertical CRS, or the third axis of a three-dimensional one; kept as text: PROJ's objects belong to one thread.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct VerticalCrs {
    /// Its name, with the ellipsoid's system for ellipsoidal heights.
    pub(crate) name: String,
    /// What it is measured from; the same for metres and feet, heights and depths.
    datum: String,
    /// WKT2 of the vertical node, or of the whole three-dimensional system.
    wkt: Arc<str>,
    /// Metres to a unit of height.
    pub(crate) unit_m: f64,
    /// Its values grow downwards: depths.
    pub(crate) is_down: bool,
    is_ellipsoidal: bool,
}

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

impl VerticalCrs {
    /// The vertical part of a coordinate system in WKT2; `None` when it has none.
    pub(crate) fn of_wkt(wkt: &str) -> Option<Self> {
        match keyword(wkt) {
            "COMPOUNDCRS" => children(wkt).iter().find_map(|part| Self::gravity_related(part)),
            "GEOGCRS" | "GEODCRS" | "GEOGRAPHICCRS" | "GEODETICCRS" | "PROJCRS"
            | "PROJECTEDCRS" => Self::ellipsoidal(wkt),
            _ => Self::gravity_related(wkt),
        }
    }

    /// A `VERTCRS`, or a `BOUNDCRS` that binds one to a geoid grid.
    fn gravity_related(wkt: &str) -> Option<Self> {
        let is_bound = keyword(wkt) == "BOUNDCRS";
        let inner = if is_bound {
            children(&child(wkt, &["SOURCECRS"])?).into_iter().next()?
        } else {
            wkt.to_owned()
        };
        if !["VERTCRS", "VERTICALCRS"].contains(&keyword(&inner)) {
            return None;
        }
        let base = child(&inner, &["VDATUM", "VERTICALDATUM", "VRF", "ENSEMBLE"])
            .or_else(|| child(&inner, &["BASEVERTCRS"]));
        let datum = base.as_deref().and_then(quoted).unwrap_or_default().to_owned();
        let own_name = quoted(&inner)?.to_owned();
        // Two systems bound to different grids differ, whatever they are called.
        let (name, datum) = match grids_of(wkt).filter(|_| is_bound) {
            Some(grids) => {
                let name = format!("height above the geoid of {}", file_names(&grids));
                (name, format!("{datum} by {grids}"))
            }
            None => (own_name, datum),
        };
        let axis = child(&inner, &["AXIS"])?;
        Some(Self {
            name,
            datum,
            unit_m: length_unit_m(&axis).or_else(|| length_unit_m(&inner))?,
            is_down: children(&axis).first().is_some_and(|way| way == "down"),
            wkt: wkt.into(),
            is_ellipsoidal: false,
        })
    }

    /// The third axis of a geographic or projected system.
    fn ellipsoidal(wkt: &str) -> Option<Self> {
        let axes: Vec<String> =
            children(wkt).into_iter().filter(|part| keyword(part) == "AXIS").collect();
        // The third axis of a geocentric system points to the pole.
        let up = axes.get(2).filter(|axis| {
            children(axis).first().is_some_and(|way| ["up", "down"].contains(&way.as_str()))
        })?;
        let name = format!("ellipsoidal height ({})", quoted(wkt)?);
        Some(Self {
            datum: name.clone(),
            name,
            unit_m: length_unit_m(up).or_else(|| length_unit_m(wkt))?,
            is_down: children(up).first().is_some_and(|way| way == "down"),
            wkt: wkt.into(),
            is_ellipsoidal: true,
        })
    }

    /// From "EPSG:n" or WKT as `option` gave it: a vertical CRS, or one with a vertical part.
    pub(crate) fn from_text(option: &'static str, text: &str) -> Result<Self, DemError> {
        library::forget();
        let refused = |reason: Option<Box<LibraryError>>| DemError::VerticalCrsText {
            option,
            text: text.to_owned(),
            source: reason,
        };
        let reference =
            SpatialRef::from_definition(text).map_err(|error| refused(Some(error.into())))?;
        let wkt = wkt2(&reference).map_err(|error| refused(Some(error.into())))?;
        Self::of_wkt(&wkt).ok_or_else(|| refused(None))
    }

    /// Metres upwards to a value.
    pub(crate) fn m_per_value(&self) -> f64 {
        if self.is_down { -self.unit_m } else { self.unit_m }
    }

    /// The horizontal system and this one, together.
    fn with(&self, horizontal: &Crs) -> Crs {
        if self.is_ellipsoidal {
            return Crs {
                wkt: Arc::clone(&self.wkt),
                label: self.name.clone(),
                ..horizontal.clone()
            };
        }
        let wkt = format!("COMPOUNDCRS[\"DEM\",{},{}]", horizontal.wkt, self.wkt);
        Crs { wkt: wkt.into(), label: self.name.clone(), ..horizontal.clone() }
    }

    /// Geoid grids that PROJ would use for it, if it says so.
    fn grids(&self) -> Option<String> {
        grids_of(&self.wkt).or_else(|| {
            let proj = SpatialRef::from_wkt(&self.wkt).ok()?.to_proj4().ok()?;
            let (_, rest) = proj.split_once("+geoidgrids=")?;
            rest.split_whitespace().next().map(str::to_owned)
        })
    }

    /// What heights in metres upwards are to be called.
    fn label(&self) -> String {
        #[expect(clippy::float_cmp, reason = "a metre is exactly one")]
        let is_plain = self.unit_m == 1.0 && !self.is_down;
        if is_plain || self.datum.is_empty() { self.name.clone() } else { self.datum.clone() }
    }
}

/// Grids named in WKT itself.
fn grids_of(wkt: &str) -> Option<String> {
    let start = wkt.find("PARAMETERFILE[")?;
    children(&wkt[start..]).first().and_then(|file| quoted(file)).map(str::to_owned)
}

/// Grids without their folders, which say nothing of what they hold.
fn file_names(grids: &str) -> String {
    let name = |path: &str| {
        Path::new(path)
            .file_name()
            .map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
    };
    grids.split(',').map(name).collect::<Vec<_>>().join(", ")
}

impl HeightOperation {
    /// Between two systems over one horizontal system.
    ///
    /// PROJ must know a true operation: its "ballpark" ones, which leave heights as they are where a grid is
    /// missing, are not allowed.
    fn new(
        source: &Source,
        [from, to]: [&VerticalCrs; 2],
        area_deg: Bounds,
    ) -> Result<Self, DemError> {
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
        let missing = |reason: Option<Box<LibraryError>>| DemError::VerticalOperation {
            path: source.path.clone(),
            from: from.name.clone(),
            to: to.name.clone(),
            grids: [from, to]
                .iter()
                .filter_map(|vertical| vertical.grids())
                .reduce(|a, b| if a == b { a } else { format!("{a} and {b}") })
                .unwrap_or_else(|| "of the two datums".to_owned()),
            source: reason,
        };
        // A missing grid shows when the operation is made, or in that nothing has an image.
        library::forget();
        let [columns, rows] = [source.columns as f64, source.rows as f64];
        let part = |k: u32, size: f64| (f64::from(k) + 0.5) / 5.0 * size;
        let points: Vec<[f64; 2]> = (0..25)
            .map(|k| {
                source.crs_from_pixel.crs_from_pixel([part(k % 5, columns), part(k / 5, rows)])
            })
            .collect();
        let mut heights_m = vec![0.0; points.len()];
        match found.carry(points, &mut heights_m) {
            Err(DemError::Transform { source: reason, .. }) => Err(missing(Some(reason))),
            Err(other) => Err(other),
            Ok(()) if heights_m.iter().all(|height_m| height_m.is_nan()) => Err(missing(None)),
            Ok(()) => Ok(found),
        }
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

/// Decides what becomes of the files' heights, and prepares the files for it.
pub(crate) fn resolve(
    sources: &mut [Source],
    options: &OpenOptions,
    area_deg: Bounds,
) -> Result<Heights, DemError> {
    let shift_m = options.vertical_shift_m;
    if shift_m.is_nan() || shift_m.abs() > MAX_SHIFT_M {
        return Err(DemError::VerticalShift { shift_m, limit_m: MAX_SHIFT_M });
    }
    let target = options.vertical_crs.as_deref();
    let target = target.map(|text| VerticalCrs::from_text("--vertical-crs", text)).transpose()?;
    let mut heights = match &target {
        Some(target) => carry(sources, target, area_deg)?,
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
) -> Result<Heights, DemError> {
    let mut texts: Vec<String> = Vec::new();
    for source in sources.iter_mut() {
        let Some(own) = source.vertical.clone() else {
            let to = target.name.clone();
            return Err(DemError::NoVerticalCrs { path: source.path.clone(), to });
        };
        let text = if own.datum == target.datum {
            // Unit and direction are seen to where values become metres.
            format!("{}, as in the files", target.label())
        } else {
            let operation = HeightOperation::new(source, [&own, target], area_deg)?;
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
            format!("{} to {}{through}, by PROJ", own.name, target.label())
        };
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    Ok(Heights { datum: Some(target.label()), words: texts.join("; ") })
}

/// Heights as they are, when all files say the same of them.
fn agree(sources: &[Source]) -> Result<Heights, DemError> {
    let Some(first) = sources.first() else { return Ok(Heights::default()) };
    let datum = |source: &Source| source.vertical.as_ref().map(|vertical| vertical.datum.clone());
    if let Some(other) = sources.iter().find(|source| datum(source) != datum(first)) {
        let say = |source: &Source| match &source.vertical {
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
        if names.iter().all(|other| other.name == own.name) {
            own.label()
        } else {
            own.datum.clone()
        }
    });
    Ok(Heights { datum, words: words.to_owned() })
}
