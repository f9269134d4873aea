//! The boundaries of tiles: decoded, and compared with what the manifest says of them.

use corniche_geom::{LatticeBounds, TileId};
use corniche_tileset::{
    BoundaryCounts, BoundaryLevelRecord, BoundaryRecord, FilePackage, decode_boundaries,
    payload_sizes,
};

use super::{
    checks::{CheckId, Findings},
    error::VerifyError,
    layer_sums::{Counts, OfTile, check_totals, look_at_layer},
};
use crate::Observer;

pub(crate) fn verify(
    package: &FilePackage,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let is_counted = manifest.boundaries.is_some();
    findings.look(CheckId::BoundarySums, is_counted == manifest.settings.boundaries, || {
        "boundaries are counted and were not asked for, or the other way round".to_owned()
    });
    let levels = manifest.boundaries.iter().flat_map(|boundaries| &boundaries.levels);
    let level =
        |&BoundaryLevelRecord { level, tiles, parts, points, bytes }: &BoundaryLevelRecord| {
            (level, Counts { tiles, parts, points, bytes })
        };
    let recorded = (CheckId::BoundarySums, levels.map(level).collect());
    let look_at = |id| look_at(package, id);
    look_at_layer((package, threads), look_at, recorded, findings, observer)?;
    if let Some(boundaries) = &manifest.boundaries {
        let BoundaryCounts { ways, kept, lost } = &boundaries.counts;
        let kept = kept.iter().map(|kept| kept.ways);
        check_totals(CheckId::BoundarySums, "ways", (*ways, kept, lost), findings);
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let Ok(boundaries) = decode_boundaries(&payload, id) else { return found };
    let margin_m = manifest.levels.get(usize::from(id.z())).map_or(0.0, |of| of.width_margin_m);
    // Two steps for rounding.
    let margin = (margin_m / manifest.frame.lattice_step_m()).ceil() as i64 + 2;
    let around = manifest.frame.tile_lattice_bounds(id).expanded(margin);
    for boundary in &boundaries {
        found.findings.look(CheckId::BoundaryPlaces, is_near(boundary, &around), || {
            format!("way {} on tile {id}", boundary.way_id)
        });
    }
    let order = |of: &BoundaryRecord| (of.class, of.way_id);
    let is_sorted = boundaries.is_sorted_by_key(order);
    found.findings.look(CheckId::BoundaryOrder, is_sorted, || format!("tile {id}"));
    let points = boundaries.iter().map(|boundary| boundary.points.len() as u64).sum();
    let bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.boundaries.stored);
    found.counts = Counts { tiles: 1, parts: boundaries.len() as u64, points, bytes };
    found
}

/// Whether the rectangle of each segment touches these bounds.
fn is_near(boundary: &BoundaryRecord, around: &LatticeBounds) -> bool {
    boundary
        .points
        .array_windows::<2>()
        .all(|pair| LatticeBounds::of(pair).is_some_and(|segment| segment.intersects(around)))
}
