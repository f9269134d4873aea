//! The areas of tiles: decoded, and compared with those of neighbours.

use std::collections::{BTreeMap, BTreeSet};

use corniche_areas::AreaObject;
use corniche_geom::{LatticePoint, TileId, cross};
use corniche_tileset::{AreaLevelRecord, AreaRecord, FilePackage, decode_areas, payload_sizes};

use super::{
    checks::{CheckId, Findings},
    each_tile::each_tile,
    error::VerifyError,
};
use crate::Observer;

/// What is found in one tile.
struct Found {
    findings: Findings,
    /// Areas, points, stored bytes.
    counts: [u64; 3],
}

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
    let mut levels: BTreeMap<u8, AreaLevelRecord> = BTreeMap::new();
    each_tile(
        package,
        threads,
        observer,
        |id| Ok(look_at(package, id)),
        |id, found: Found| {
            findings.merge(found.findings);
            let [areas, points, bytes] = found.counts;
            if areas > 0 {
                let level = id.z();
                let none = AreaLevelRecord { level, tiles: 0, areas: 0, points: 0, bytes: 0 };
                let sums = levels.entry(level).or_insert(none);
                sums.tiles += 1;
                sums.areas += areas;
                sums.points += points;
                sums.bytes += bytes;
            }
        },
    )?;
    let found: Vec<AreaLevelRecord> = levels.into_values().collect();
    let recorded = manifest.areas.as_ref().map(|areas| areas.levels.clone()).unwrap_or_default();
    findings.look(CheckId::AreaSums, found == recorded, || {
        format!("{found:?} in the tiles, {recorded:?} are recorded")
    });
    if let Some(areas) = &manifest.areas {
        let counts = &areas.counts;
        let kept: u64 = counts.kept.iter().map(|kept| kept.areas).sum();
        let lost: u64 = counts.lost.iter().map(|lost| lost.1).sum();
        findings.look(CheckId::AreaSums, counts.objects == kept + lost, || {
            format!("{} objects, {kept} kept and {lost} lost", counts.objects)
        });
    }
    Ok(())
}

fn look_at(package: &FilePackage, id: TileId) -> Found {
    let mut found = Found { findings: Findings::default(), counts: [0; 3] };
    // Tiles that cannot be read are told elsewhere.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let frame = &package.manifest().frame;
    let Ok(areas) = decode_areas(&payload, id, frame) else { return found };
    for area in &areas {
        found.findings.look(CheckId::AreaRings, rings_are_right(area), || {
            format!("a ring of {} on tile {id}", area.object)
        });
    }
    let points = areas.iter().flat_map(|area| &area.polygons).flat_map(|part| &part.rings);
    let bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.areas.stored);
    found.counts = [areas.len() as u64, points.map(|ring| ring.len() as u64).sum(), bytes];
    for (dx, dy) in [(1, 0), (0, 1)] {
        let Some(beside) = id.neighbour(dx, dy) else { continue };
        let other = package.tile(beside).ok().flatten();
        // A neighbour without ground has no areas.
        let Some(other) = other.and_then(|other| decode_areas(&other, beside, frame).ok()) else {
            continue;
        };
        let bounds = frame.tile_lattice_bounds(id);
        let border = if dx == 1 { Border::East(bounds.max.u) } else { Border::South(bounds.min.v) };
        let (own, other) = (on_border(&areas, border), on_border(&other, border));
        let all: BTreeSet<&AreaObject> = own.keys().chain(other.keys()).collect();
        for object in all {
            let is_same = own.get(object) == other.get(object);
            found.findings.look(CheckId::AreaSeams, is_same, || {
                format!("{object} between the tiles {id} and {beside}")
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

/// A line between two tiles.
#[derive(Debug, Clone, Copy)]
enum Border {
    East(i64),
    South(i64),
}

impl Border {
    /// Where along the border a point lies; `None` beside it.
    fn along(self, point: LatticePoint) -> Option<i64> {
        match self {
            Self::East(u) => (point.u == u).then_some(point.v),
            Self::South(v) => (point.v == v).then_some(point.u),
        }
    }
}

/// What of a border each object covers: pieces that do not touch, in order.
fn on_border(areas: &[AreaRecord], border: Border) -> BTreeMap<AreaObject, Vec<[i64; 2]>> {
    let mut pieces: BTreeMap<AreaObject, Vec<[i64; 2]>> = BTreeMap::new();
    for area in areas {
        for ring in area.polygons.iter().flat_map(|part| &part.rings) {
            let next = ring.iter().cycle().skip(1);
            for (&a, &b) in ring.iter().zip(next) {
                if let (Some(a), Some(b)) = (border.along(a), border.along(b)) {
                    pieces.entry(area.object).or_default().push([a.min(b), a.max(b)]);
                }
            }
        }
    }
    for own in pieces.values_mut() {
        own.sort_unstable();
        own.dedup_by(|later, piece| {
            let touches = later[0] <= piece[1];
            if touches {
                piece[1] = piece[1].max(later[1]);
            }
            touches
        });
    }
    pieces
}
