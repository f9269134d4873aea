//! The boundaries of the extract, split again, against those of the package, tile by tile.

use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::{BoundaryRecord, FilePackage, decode_boundaries};

use super::{
    checks::{CheckId, Findings},
    each_tile::{compare_in_order, each_tile},
    error::VerifyError,
};
use crate::{
    Observer,
    boundaries::{sections::TileBoundaries, totals::BoundaryTotals},
};

/// Compares the boundaries of each tile, and their counts, with those that the store has now.
pub(crate) fn compare(
    package: &FilePackage,
    store: &dyn Artifacts,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    each_tile(
        package,
        threads,
        observer,
        |id| look_at(package, id, store),
        |_, found| findings.merge(found),
    )?;
    let found = BoundaryTotals::get(store)?.map(|totals| totals.counts());
    let recorded = package.manifest().boundaries.as_ref().map(|of| of.counts.clone());
    findings.look(CheckId::OsmBoundaryCounts, found == recorded, || {
        format!("{recorded:?} are recorded, {found:?} are in the extract")
    });
    Ok(())
}

fn look_at(
    package: &FilePackage,
    id: TileId,
    store: &dyn Artifacts,
) -> Result<Findings, VerifyError> {
    let mut findings = Findings::default();
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return Ok(findings) };
    let Ok(recorded) = decode_boundaries(&payload, id) else { return Ok(findings) };
    let expected = match TileBoundaries::get(store, id)? {
        Some(boundaries) => boundaries.into_section().decode(id).unwrap_or_default(),
        None => Vec::new(),
    };
    compare_in_order(CheckId::OsmBoundaries, id, [&recorded, &expected], name, &mut findings);
    Ok(findings)
}

fn name(boundary: &BoundaryRecord) -> String {
    format!("{} way {} with {} points", boundary.class, boundary.way_id, boundary.points.len())
}
