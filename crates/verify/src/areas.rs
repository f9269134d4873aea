//! The areas of tiles: decoded, and compared with those of neighbours.

use std::collections::BTreeSet;

use corniche_areas::AreaObject;
use corniche_geom::{LatticeBounds, LatticePoint, TileId, cross};
use corniche_pieces::layers::tile_section::{SectionOfTile, SectionSums};
use corniche_spec::Observer;
use corniche_tileset::{
    AreaCounts, AreaLevelRecord, AreaRecord, FilePackage, decode_areas, payload_sizes,
};

use super::{
    area_seams::{Beside, Seam},
    checks::{CheckId, Findings},
    each_tile::{OfTile, check_totals, look_at_layer},
    error::VerifyError,
};

pub(crate) fn verify(
    package: &FilePackage,
    threads: usize,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let is_counted = manifest.areas.is_some();
    findings.look(CheckId::AreaSums, is_counted == manifest.settings.areas.is_some(), || {
        "areas are counted without a table of areas, or there is a table and they are not counted".to_owned()
    });
    let levels = manifest.areas.iter().flat_map(|areas| &areas.levels);
    let level =
        |&AreaLevelRecord { level, tiles, areas: parts, points, bytes }: &AreaLevelRecord| {
            (level, SectionSums { tiles, parts, points, bytes })
        };
    let recorded = (CheckId::AreaSums, levels.map(level).collect());
    let look_at = |id| look_at(package, id);
    look_at_layer((package, threads), look_at, recorded, findings, observer)?;
    if let Some(areas) = &manifest.areas {
        let AreaCounts { objects, kept, lost } = &areas.counts;
        let kept = kept.iter().map(|kept| kept.areas);
        check_totals(CheckId::AreaSums, "objects", (*objects, kept, lost), findings);
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let clip = manifest.clip.as_ref().map(|clip| {
        let [min, max] = clip.nodes.map(|node| frame.lattice_of_node(node));
        LatticeBounds { min, max }
    });
    let Ok(areas) = decode_areas(&payload, id, frame) else { return found };
    for area in &areas {
        found.findings.look(CheckId::AreaRings, rings_are_right(area), || {
            format!("a ring of {} on tile {id}", area.object)
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
        let seam = Seam::new(frame, id, beside, clip);
        let [own, other] = [&areas, &other].map(|areas| seam.covered(areas));
        let all: BTreeSet<&AreaObject> = own.keys().chain(other.keys()).collect();
        for object in all {
            let covered = [&own, &other].map(|of| of.get(object).map_or(&[][..], Vec::as_slice));
            let broken = seam.broken(covered);
            found.findings.look(CheckId::AreaSeams, broken.is_empty(), || {
                let pieces = broken.len();
                format!("{object} between the tiles {id} and {neighbour}: one of them alone covers {pieces} pieces of the line")
            });
        }
    }
    found
}

/// Outer rings run counter-clockwise, others clockwise, and no point of a ring comes twice.
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
