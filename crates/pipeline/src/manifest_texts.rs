//! Texts and records that every manifest has: written by the build, compared by `verify`.

use corniche_dem::{Clip, GridPlan};
use corniche_tileset::{ClipRecord, VerticalRecord};

/// How tiles are numbered.
pub(crate) const TILING: &str = "local quadtree in the working CRS: z from the root, x from the west, y from the \
                                 north; not the web's tile scheme";

/// Unit of heights.
pub(crate) const HEIGHT_UNIT: &str = "metre";

/// The part of the elevation files that the package is of.
pub(crate) fn clip(plan: &GridPlan) -> Option<ClipRecord> {
    plan.clip.map(|Clip { nodes, whole_data_bounds, whole_wgs84_bounds }| ClipRecord {
        nodes,
        whole_data_bounds,
        whole_wgs84_bounds,
    })
}

/// What heights are measured from.
pub(crate) fn datum(plan: &GridPlan) -> &str {
    plan.vertical_datum.as_deref().unwrap_or(VerticalRecord::UNKNOWN_DATUM)
}
