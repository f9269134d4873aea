//! The operation of PROJ that transforms positions from one datum to another, its accuracy, and a
//! better one if grids are missing.

use std::cmp::Ordering;

use corniche_geom::{Bounds, DatumOperationRecord, Seam};

use crate::CrsError;
use crate::crs::horizontal::{Crs, GridCrs};
use crate::crs::operation::CrsOperation;
use crate::crs::proj_operations::{ListedOperations, ProjOperation, operations};

/// How positions are transformed from one datum to another.
#[derive(Debug, Clone, PartialEq)]
pub struct DatumOperation {
    /// The record of the operation in packages.
    pub record: DatumOperationRecord,
    /// Whether the user must allow the operation: a ballpark operation between datums, unless both
    /// are datums of satellite positioning, which agree within metres and share the ellipsoid of
    /// WGS84 or GRS80.
    pub must_be_allowed: bool,
    /// A more accurate operation that PROJ knows and cannot use, because its grids are not
    /// installed.
    pub better: Option<BetterOperation>,
}

/// An operation that PROJ cannot use.
#[derive(Debug, Clone, PartialEq)]
pub struct BetterOperation {
    /// PROJ's name for the operation.
    pub name: String,
    /// The accuracy in metres.
    pub accuracy_m: f64,
    /// The required grid files that are missing.
    pub grids: Vec<String>,
}

impl DatumOperation {
    /// A warning for the user before a build: a better operation exists, or the accuracy is
    /// unknown.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let DatumOperationRecord { from, to, operation, accuracy_m, ballpark: _ } = &self.record;
        let accuracy = self.record.accuracy_text();
        let begin = format!(
            "positions are transformed from {from} to {to} by PROJ's {operation:?}, {accuracy}"
        );
        match &self.better {
            Some(BetterOperation { name, accuracy_m, grids }) => Some(format!(
                "{begin}; {name:?}, accurate to {accuracy_m} m, needs a grid that is not installed: {} (projsync, in the Debian package \
                 proj-bin, installs grids)",
                grids.join(", ")
            )),
            None if accuracy_m.is_none() => Some(format!(
                "{begin}: ground and roads may be offset from each other; if the true coordinate system is another, assign it \
                 (gdal_edit.py -a_srs EPSG:n; for vectors ogr2ogr -a_srs)"
            )),
            None => None,
        }
    }

    /// The operations from a package's working CRS to WGS84, over the rectangle of the data in
    /// working metres; `area_deg` is the rectangle for which PROJ chooses.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn to_wgs84(
        working: &GridCrs,
        data: Bounds,
        area_deg: Bounds,
    ) -> Result<Vec<Self>, CrsError> {
        let operation = CrsOperation::out_of_working(working, &Crs::wgs84()?, Some(area_deg));
        let [middle_x, middle_y] = data.center();
        let mut places = vec![[middle_x, middle_y]];
        for x in [data.min_x, middle_x, data.max_x] {
            places.extend([data.min_y, middle_y, data.max_y].map(|y| [x, y]));
        }
        operation.apply(&mut places)?;
        Ok(Self::used(&operation, &places))
    }

    /// The operations between two datums that are used at some positions (degrees), each once; the
    /// first position comes first. Empty if the datum stays the same.
    #[must_use]
    pub fn used(operation: &CrsOperation, places_deg: &[[f64; 2]]) -> Vec<Self> {
        let systems = [&operation.from, &operation.to].map(|crs| &*crs.wkt);
        let usable = operations(systems, operation.area_deg, ListedOperations::Usable);
        // Ballpark operations are used only if there is no other; see `CrsOperation`.
        let is_true = |found: &&ProjOperation| !found.is_ballpark;
        let mut candidates: Vec<&ProjOperation> = usable.iter().filter(is_true).collect();
        if candidates.is_empty() {
            candidates = usable.iter().collect();
        }
        let changes_datum = |found: &&ProjOperation| {
            !found.name.is_empty() && (found.accuracy_m != Some(0.0) || found.is_ballpark)
        };
        if !candidates.iter().any(changes_datum) {
            return Vec::new();
        }
        let known = operations(systems, operation.area_deg, ListedOperations::Known);
        let mut all: Vec<Self> = Vec::new();
        for &place in places_deg.iter().filter(|place| place[0].is_finite()) {
            let Some(found) = taken_at(place, &candidates).filter(changes_datum) else { continue };
            if !all.iter().any(|other| other.record.operation == found.name) {
                all.push(Self {
                    record: DatumOperationRecord {
                        from: operation.from.label.clone(),
                        to: operation.to.label.clone(),
                        operation: found.name.clone(),
                        accuracy_m: found.accuracy_m,
                        ballpark: found.is_ballpark,
                    },
                    must_be_allowed: found.is_ballpark
                        && !(operation.from.is_on_wgs84_ellipsoid()
                            && operation.to.is_on_wgs84_ellipsoid()),
                    better: better_than(found, place, &known),
                });
            }
        }
        all
    }

    /// The error for an input named `whose` that needs this operation.
    #[must_use]
    pub fn refusal(&self, whose: String) -> CrsError {
        let between = Box::new(
            [&self.record.from, &self.record.to, &self.record.operation].map(Clone::clone),
        );
        CrsError::Ballpark { whose, between }
    }
}

/// The operation that GDAL uses at a position: the most accurate of those whose area contains the
/// position, the first of equals; without one, the first that needs no grid.
fn taken_at<'a>(place_deg: [f64; 2], all: &[&'a ProjOperation]) -> Option<&'a ProjOperation> {
    let mut best: Option<&ProjOperation> = None;
    for &other in all.iter().filter(|other| holds(other.area_deg, place_deg)) {
        let is_better = best.is_none_or(|best| match (other.accuracy_m, best.accuracy_m) {
            (Some(own), Some(known)) => own < known,
            _ => false,
        });
        if is_better {
            best = Some(other);
        }
    }
    best.or_else(|| all.iter().copied().find(|other| !other.has_grids))
}

/// The operation with the smallest area around a position that only lacks its grids and is more
/// accurate than another one. The areas of whole countries are rectangles that reach far into their
/// neighbours.
fn better_than(
    used: &ProjOperation,
    place_deg: [f64; 2],
    known: &[ProjOperation],
) -> Option<BetterOperation> {
    let is_better = |&(accuracy_m, _): &(f64, &ProjOperation)| {
        used.is_ballpark || used.accuracy_m.is_none_or(|used_m| accuracy_m < used_m)
    };
    let order = |(accuracy_m, other): &(f64, &ProjOperation)| (size(other.area_deg), *accuracy_m);
    known
        .iter()
        .filter(|other| !other.missing_grids.is_empty() && !other.is_ballpark)
        .filter(|other| holds(other.area_deg, place_deg))
        .filter_map(|other| Some((other.accuracy_m?, other)))
        .filter(is_better)
        .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(Ordering::Equal))
        .map(|(accuracy_m, other)| BetterOperation {
            name: other.name.clone(),
            accuracy_m,
            grids: other.missing_grids.clone(),
        })
}

/// The size of an area in square degrees.
fn size(area_deg: Option<[f64; 4]>) -> f64 {
    let [west, south, east, north] = area_deg.unwrap_or([-180.0, -90.0, 180.0, 90.0]);
    let width = if west <= east { east - west } else { east - west + 360.0 };
    width * (north - south)
}

/// Whether an area contains a position; an unknown area contains all.
fn holds(area_deg: Option<[f64; 4]>, [lon, lat]: [f64; 2]) -> bool {
    let Some([west, south, east, north]) = area_deg else { return true };
    let lon = Seam::of_degrees().image_from_west(lon);
    let is_between =
        if west <= east { (west..=east).contains(&lon) } else { lon >= west || lon <= east };
    is_between && (south..=north).contains(&lat)
}

#[cfg(test)]
#[path = "datum_operation_tests.rs"]
mod tests;
