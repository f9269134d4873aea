//! Decodes the areas of tiles, and compares them with those of neighbouring tiles.

use std::collections::BTreeSet;

use corniche_areas::AreaObject;
use corniche_geom::{LatticePoint, TileId, cross};
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_tileset::{
    AreaCounts, AreaLevelRecord, AreaRecord, FilePackage, decode_areas, payload_sizes,
};
use corniche_work::Stage;

use super::{
    area_seams::{Beside, TileSeam},
    checks::{CheckId, Findings},
    derived_records::clip_of,
    each_tile::{OfTile, VerifyRun, check_totals, look_at_layer},
    error::VerifyError,
};

pub(crate) fn verify(run: &VerifyRun<'_>, findings: &mut Findings) -> Result<(), VerifyError> {
    let package = run.package;
    let manifest = package.manifest();
    let is_counted = manifest.areas.is_some();
    findings.look(CheckId::AreaSums, is_counted == manifest.settings.areas.is_some(), || {
        "areas are counted but the settings name no table of areas, or the other way round"
            .to_owned()
    });
    let levels = manifest.areas.iter().flat_map(|areas| &areas.levels);
    let level =
        |&AreaLevelRecord { level, tiles, areas: parts, points, bytes }: &AreaLevelRecord| {
            (level, SectionSums { tiles, parts, points, bytes })
        };
    let recorded = (CheckId::AreaSums, levels.map(level).collect());
    look_at_layer(run, Stage::VerifyAreas, |id| look_at(package, id), recorded, findings)?;
    if let Some(areas) = &manifest.areas {
        let AreaCounts { objects, kept, lost } = &areas.counts;
        let kept = kept.iter().map(|kept| kept.areas);
        check_totals(CheckId::AreaSums, "objects", *objects, kept, lost, findings);
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Unreadable tiles are reported by the check of tiles.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let clip = clip_of(manifest);
    let Ok(areas) = decode_areas(&payload, id, frame) else { return found };
    for area in &areas {
        found.findings.look(CheckId::AreaRings, rings_are_right(area), || {
            format!("a ring of {} in tile {id}", area.object)
        });
    }
    let points = areas.iter().flat_map(AreaRecord::rings);
    let bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.areas.stored);
    let points = points.map(|ring| ring.len() as u64).sum();
    found.counts = SectionOfTile { parts: areas.len() as u64, points, bytes };
    for beside in [Beside::East, Beside::South] {
        let Some(neighbour) = beside.neighbour(id) else { continue };
        let other = package.tile(neighbour).ok().flatten();
        // A neighbour without ground has no areas.
        let Some(other) = other.and_then(|other| decode_areas(&other, neighbour, frame).ok())
        else {
            continue;
        };
        let seam = TileSeam::new(frame, id, beside, clip);
        let [own, other] = [&areas, &other].map(|areas| seam.covered(areas));
        let all: BTreeSet<&AreaObject> = own.keys().chain(other.keys()).collect();
        for object in all {
            let covered = [&own, &other].map(|of| of.get(object).map_or(&[][..], Vec::as_slice));
            let broken = seam.broken(covered);
            found.findings.look(CheckId::AreaSeams, broken.is_empty(), || {
                let pieces = broken.len();
                format!("{object} on the border of tiles {id} and {neighbour}: {pieces} stretches are covered by one tile only")
            });
        }
    }
    found
}

/// Whether outer rings run counter-clockwise, others clockwise, and no point occurs twice in a
/// ring.
fn rings_are_right(area: &AreaRecord) -> bool {
    area.polygons.iter().all(|part| {
        part.rings.iter().enumerate().all(|(number, ring)| {
            let different: BTreeSet<&LatticePoint> = ring.iter().collect();
            let next = ring.iter().cycle().skip(1);
            let doubled_area: i128 =
                ring.iter().zip(next).map(|(&a, &b)| cross(ring[0], a, b)).sum();
            different.len() == ring.len()
                && (doubled_area > 0) == (number == 0)
                && doubled_area != 0
        })
    })
}
