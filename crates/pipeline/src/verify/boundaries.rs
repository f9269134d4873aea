//! The boundaries of tiles: decoded, and compared with what the manifest says of them.

use std::collections::BTreeMap;

use corniche_geom::{LatticeBounds, TileId};
use corniche_tileset::{
    BoundaryLevelRecord, BoundaryRecord, FilePackage, decode_boundaries, payload_sizes,
};

use super::{
    checks::{CheckId, Findings},
    each_tile::each_tile,
    error::VerifyError,
};
use crate::Observer;

/// What is found in one tile.
struct Found {
    findings: Findings,
    /// Parts, points, stored bytes.
    counts: [u64; 3],
}

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
    let mut levels: BTreeMap<u8, BoundaryLevelRecord> = BTreeMap::new();
    each_tile(
        package,
        threads,
        observer,
        |id| Ok(look_at(package, id)),
        |id, found: Found| {
            findings.merge(found.findings);
            let [parts, points, bytes] = found.counts;
            if parts > 0 {
                let level = id.z();
                let none = BoundaryLevelRecord { level, tiles: 0, parts: 0, points: 0, bytes: 0 };
                let sums = levels.entry(level).or_insert(none);
                sums.tiles += 1;
                sums.parts += parts;
                sums.points += points;
                sums.bytes += bytes;
            }
        },
    )?;
    let found: Vec<BoundaryLevelRecord> = levels.into_values().collect();
    let recorded = manifest.boundaries.as_ref().map(|of| of.levels.clone()).unwrap_or_default();
    findings.look(CheckId::BoundarySums, found == recorded, || {
        format!("{found:?} in the tiles, {recorded:?} are recorded")
    });
    if let Some(boundaries) = &manifest.boundaries {
        let counts = &boundaries.counts;
        let kept: u64 = counts.kept.iter().map(|kept| kept.ways).sum();
        let lost: u64 = counts.lost.iter().map(|lost| lost.1).sum();
        findings.look(CheckId::BoundarySums, counts.ways == kept + lost, || {
            format!("{} ways, {kept} kept and {lost} lost", counts.ways)
        });
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> Found {
    let mut found = Found { findings: Findings::default(), counts: [0; 3] };
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
    found.counts = [boundaries.len() as u64, points, bytes];
    found
}

/// Whether the rectangle of each segment touches these bounds.
fn is_near(boundary: &BoundaryRecord, around: &LatticeBounds) -> bool {
    boundary
        .points
        .array_windows::<2>()
        .all(|pair| LatticeBounds::of(pair).is_some_and(|segment| segment.intersects(around)))
}
