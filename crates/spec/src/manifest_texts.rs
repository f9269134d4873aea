//! Texts and records that every manifest has: the build writes them, and `verify` compares them.

use corniche_dem::GridPlan;
use corniche_geom::LatticePoint;
use corniche_gis::{DatumOperation, libraries};
use corniche_tileset::{DatumOperationRecord, Manifest, VerticalRecord};

use crate::extent::ExtentOutline;

/// How tiles are numbered.
pub const TILING: &str = "local quadtree in the working CRS: z from the root, x from the west, y from the \
                                 north; not the web's tile scheme";

/// Unit of heights.
pub const HEIGHT_UNIT: &str = "metre";

/// The outline of the elevation files.
#[must_use]
pub fn outline(outline: &ExtentOutline) -> Vec<Vec<Vec<[i64; 2]>>> {
    let ring = |ring: &Vec<LatticePoint>| ring.iter().map(|at| [at.u, at.v]).collect();
    outline.iter().map(|rings| rings.iter().map(ring).collect()).collect()
}

/// The transformations between datums, as packages record them.
#[must_use]
pub fn datum_operations(found: &[DatumOperation]) -> Vec<DatumOperationRecord> {
    found.iter().map(|found| found.record.clone()).collect()
}

/// Describes an operation between datums in words.
#[must_use]
pub fn operation_words(found: &DatumOperationRecord) -> String {
    let DatumOperationRecord { from, to, operation, accuracy_m, ballpark: _ } = found;
    let accuracy = accuracy_m.map_or("unknown accuracy".to_owned(), |m| format!("{m} m"));
    format!("{operation:?} from {from} to {to} ({accuracy})")
}

/// The message for operations between datums that differ from the recorded ones.
#[must_use]
pub fn other_operations(said: &[DatumOperationRecord], found: &[DatumOperationRecord]) -> String {
    let list = |all: &[DatumOperationRecord]| match all {
        [] => "none".to_owned(),
        all => all.iter().map(operation_words).collect::<Vec<_>>().join("; "),
    };
    format!(
        "between geodetic datums, the package records {}; PROJ now uses {}: one of its grids may have been installed or removed since the build, so \
         build the package again",
        list(said),
        list(found)
    )
}

/// Whether a package records operations between datums that this program can compare with its own,
/// because its PROJ has the same registry. Older packages record none, and may have the same
/// `generator`.
#[must_use]
pub fn has_comparable_operations(manifest: &Manifest) -> bool {
    !manifest.datum_operations.is_empty() && manifest.generator.ends_with(&libraries())
}

/// The operations between datums that a package records.
#[must_use]
pub fn recorded_datum_operations(manifest: &Manifest) -> Vec<DatumOperation> {
    let operation = |found: &DatumOperationRecord| DatumOperation {
        record: found.clone(),
        // The build was allowed to use it, and the better operation is not recorded.
        must_be_allowed: false,
        better: None,
    };
    manifest.datum_operations.iter().map(operation).collect()
}

/// The vertical datum to which heights refer.
#[must_use]
pub fn datum(plan: &GridPlan) -> &str {
    plan.vertical_datum.as_deref().unwrap_or(VerticalRecord::UNKNOWN_DATUM)
}
