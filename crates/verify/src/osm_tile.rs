//! Clips and drapes one tile's roads again, and compares them with those of the package.

use std::collections::BTreeMap;

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::TileId;
use corniche_pieces::roads::{
    ground_lines::SpanGroundLine,
    lay::{self, ClassSums, DrapedRoads, RoadFate, TileToLayOn},
    pieces::TilePieces,
};
use corniche_roads::RoadAttributes;
use corniche_spec::{levels::Levels, true_lengths::TrueLengths};
use corniche_tileset::TilePayload;

use super::{
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    derived_records::clip_of,
};

/// The inputs for draping roads again.
pub(crate) struct Laying<'a> {
    pub tiles: &'a DecodedTiles<'a>,
    pub levels: &'a Levels,
    /// The first and the last of the finest tiles of the data.
    pub data: [TileId; 2],
    /// Whether the package has spans.
    pub spans: bool,
    pub lengths: &'a TrueLengths<'a>,
}

/// The findings of a worker in one tile.
pub(crate) struct OsmTileFindings {
    pub findings: Findings,
    pub fates: Vec<(u32, RoadFate)>,
    /// Sums by class, for a tile with ground.
    pub classes: BTreeMap<u8, ClassSums>,
    /// The ground beneath bridges and tunnels.
    pub ground_lines: Vec<SpanGroundLine>,
}

pub(crate) fn look_at(laying: &Laying<'_>, id: TileId, pieces: &TilePieces) -> OsmTileFindings {
    let mut found = OsmTileFindings {
        findings: Findings::default(),
        fates: Vec::new(),
        classes: BTreeMap::new(),
        ground_lines: Vec::new(),
    };
    let manifest = laying.tiles.package.manifest();
    let frame = &manifest.frame;
    let tile = laying.tiles.tile_at(id);
    let payload = tile.payload();
    let terrain = payload.and_then(|payload| payload.terrain.as_ref());
    let (Some(payload), Some(terrain)) = (payload, terrain) else {
        if id.z() == frame.max_level() {
            let owned = laying.owned_borders(id, !pieces.roads.is_empty());
            found.fates = lay::lost_pieces(
                pieces,
                &frame.tile_lattice_bounds(id),
                owned,
                clip_of(manifest),
                laying.lengths,
            );
        }
        return found;
    };
    let surface = manifest.surface(id, &terrain.tin);
    let owned = laying.owned_borders(id, !pieces.roads.is_empty());
    let (clip, spans, lengths) = (clip_of(manifest), laying.spans, laying.lengths);
    let on = TileToLayOn { id, surface: &surface, owned, clip, spans, lengths };
    let mut laid = DrapedRoads::of_tile(pieces, &on, laying.levels);
    laid.sort();
    compare(payload, &laid, &mut found.findings);
    (found.fates, found.classes) = (laid.fates, laid.classes);
    found.ground_lines = laid.ground_lines;
    found
}

fn compare(payload: &TilePayload, laid: &DrapedRoads, findings: &mut Findings) {
    let id = payload.id;
    let geo = |geo: &[corniche_tileset::GeoRoad]| -> Vec<_> {
        geo.iter().map(|road| ((road.class, road.way_id, road.part), road.line.clone())).collect()
    };
    let sv = |sv: &[corniche_tileset::SvRoad]| -> Vec<_> {
        sv.iter()
            .map(|road| ((road.class, road.way_id, road.part), road.line.points.clone()))
            .collect()
    };
    let (said, wanted) = (geo(&payload.roads_geo), geo(&laid.geo));
    each(CheckId::OsmGeo, id, &said, &wanted, findings);
    let (said, wanted) = (sv(&payload.roads_sv), sv(&laid.sv));
    each(CheckId::OsmSv, id, &said, &wanted, findings);
    let wanted: BTreeMap<i64, &RoadAttributes> =
        laid.attributes.values().map(|record| (record.way_id, &record.attributes)).collect();
    // Older packages keep no spaces around texts.
    let is_same =
        |found: &RoadAttributes, own: &RoadAttributes| found == own || found.trimmed() == *own;
    let said: Vec<_> = payload
        .attributes
        .iter()
        .map(|record| {
            let found = wanted.get(&record.way_id).copied();
            let same = found.filter(|found| is_same(found, &record.attributes));
            (record.way_id, same.unwrap_or(&record.attributes))
        })
        .collect();
    let wanted: Vec<_> = wanted.into_iter().collect();
    each(CheckId::OsmAttributes, id, &said, &wanted, findings);
}

/// Compares two lists, item by item, by their keys.
fn each<K: Ord + Copy + std::fmt::Debug, V: PartialEq>(
    check: CheckId,
    id: TileId,
    said: &[(K, V)],
    wanted: &[(K, V)],
    findings: &mut Findings,
) {
    let said_by: BTreeMap<K, &V> = said.iter().map(|(key, value)| (*key, value)).collect();
    for (key, value) in wanted {
        let own = said_by.get(key);
        findings.look(check, own == Some(&value), || match own {
            Some(_) => format!("{key:?} in tile {id} differs from the extract"),
            None => format!("{key:?} of the extract is not in tile {id}"),
        });
    }
    let wanted_by: BTreeMap<K, &V> = wanted.iter().map(|(key, value)| (*key, value)).collect();
    for (key, _) in said.iter().filter(|(key, _)| !wanted_by.contains_key(key)) {
        findings.look(check, false, || format!("{key:?} in tile {id} is not in the extract"));
    }
}

impl Laying<'_> {
    /// The parts of its borders that a tile owns, by the cells on both sides that TINs cover: these
    /// are exactly the cells with ground.
    fn owned_borders(&self, id: TileId, has_roads: bool) -> OwnedBorders {
        if !has_roads {
            return OwnedBorders::ALL;
        }
        let [first, last] = self.data;
        let around =
            [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)].map(|(dx, dy)| id.neighbour(dx, dy));
        let grounds = around.map(|other| {
            let other = other.filter(|&other| self.tiles.tile_at(other).terrain().is_some())?;
            Some((other, self.tiles.ground(other)))
        });
        let ground_of = |other: Option<TileId>| {
            let found = grounds.iter().flatten().find(|(id, _)| Some(*id) == other);
            found.map(|(_, ground)| ground)
        };
        let is_asked = |other: Option<TileId>| {
            other.is_some_and(|other| {
                ground_of(Some(other)).is_some()
                    || (other.z() == first.z()
                        && (first.x()..=last.x()).contains(&other.x())
                        && (first.y()..=last.y()).contains(&other.y()))
            })
        };
        let neighbours = Neighbours { east: is_asked(around[1]), south: is_asked(around[2]) };
        OwnedBorders::among(neighbours).where_ground(|column, row| {
            let cells = corniche_geom::TILE_CELLS;
            let (dx, dy) = (column.div_euclid(cells), row.div_euclid(cells));
            let other = id.neighbour(dx as i32, dy as i32);
            let at = [column.rem_euclid(cells), row.rem_euclid(cells)];
            ground_of(other)
                .is_some_and(|ground| ground.height_m(at.map(|index| index as f64 + 0.5)).is_some())
        })
    }
}
