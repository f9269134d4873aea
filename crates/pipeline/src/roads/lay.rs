//! Roads laid on the tiles of a level, and the sums over what was laid.

use std::collections::BTreeMap;

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, TileId};
use corniche_roads::Road;
use corniche_tileset::{GeoRoad, RoadRecord, SvRoad, Terrain, TilePayload};
use corniche_tin::Surface;

use super::lengths::{TrueLengths, gaps_um, pieces_um};
use crate::levels::Levels;

/// Sums over the roads of a class on a level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct ClassSums {
    /// Points of the source lines that lie in tiles with ground.
    pub(crate) source_vertices: u64,
    /// The same of the level's simplified lines.
    pub(crate) simplified_vertices: u64,
    pub(crate) geo_vertices: u64,
    pub(crate) sv_vertices: u64,
    pub(crate) geo_stored_bytes: u64,
    pub(crate) sv_stored_bytes: u64,
}

/// What became of a road at the finest level.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct RoadFate {
    /// True length that lies on a TIN, micrometres.
    pub(crate) kept_um: u64,
    /// True length on the data's tiles, but where there is no ground, micrometres.
    pub(crate) void_um: u64,
}

/// Sums over all roads that were laid.
pub(crate) struct LaidSums {
    /// By level and class.
    pub(crate) classes: BTreeMap<(u8, u8), ClassSums>,
    /// Per road, by ordinal.
    pub(crate) fates: Vec<RoadFate>,
}

impl LaidSums {
    /// Empty sums for `count` roads.
    pub(crate) fn of_roads(count: usize) -> Self {
        Self { classes: BTreeMap::new(), fates: vec![RoadFate::default(); count] }
    }

    /// Adds what became of roads in one tile.
    pub(crate) fn add_fates(&mut self, fates: &[(u32, RoadFate)]) {
        for &(ordinal, fate) in fates {
            let road = &mut self.fates[ordinal as usize];
            road.kept_um += fate.kept_um;
            road.void_um += fate.void_um;
        }
    }
}

/// A tile on which roads are laid.
pub(crate) struct TileToLayOn<'a> {
    pub(crate) id: TileId,
    pub(crate) surface: &'a Surface,
    /// Which of its borders belong to the tile.
    pub(crate) owned: OwnedBorders,
}

/// What becomes of a road on a finest tile without ground.
pub(crate) fn lost_road(
    road: &Road,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
    lengths: &TrueLengths<'_>,
) -> RoadFate {
    let segments_um = lengths.segments_um(&road.line);
    let void_um = corniche_drape::clip_parts(&road.line, bounds, owned)
        .iter()
        .flat_map(|part| pieces_um(&road.line, part, &segments_um))
        .map(|[from, to]| to - from)
        .sum();
    RoadFate { kept_um: 0, void_um }
}

/// The roads of one tile as they are laid.
#[derive(Default)]
pub(crate) struct Laid {
    pub(crate) geo: Vec<GeoRoad>,
    pub(crate) sv: Vec<SvRoad>,
    pub(crate) attributes: BTreeMap<i64, RoadRecord>,
    pub(crate) fates: Vec<(u32, RoadFate)>,
    pub(crate) classes: BTreeMap<u8, ClassSums>,
    /// Next part number of each way, GEO and SV.
    parts: BTreeMap<i64, [u32; 2]>,
}

impl Laid {
    pub(crate) fn lay(
        &mut self,
        road: &Road,
        ordinal: u32,
        on: &TileToLayOn<'_>,
        levels: &Levels,
        lengths: &TrueLengths<'_>,
    ) {
        let &TileToLayOn { id, surface, owned } = on;
        let frame = levels.frame();
        let bounds = frame.tile_lattice_bounds(id);
        let simplified = corniche_roads::simplify(road, levels.simplify_tolerance_steps(id.z()));
        let mut fate = RoadFate::default();
        let sums = self.classes.entry(road.class.number()).or_default();
        sums.source_vertices += points_of_tile(&road.line, id, levels);
        sums.simplified_vertices += points_of_tile(&simplified, id, levels);
        let parts = self.parts.entry(road.way_id).or_default();
        let mut laid = 0;
        // On the finest level the line is the source line, not simplified.
        let is_finest = id.z() == frame.max_level();
        let segments_um = if is_finest { lengths.segments_um(&simplified) } else { Vec::new() };
        for part in corniche_drape::clip_parts(&simplified, &bounds, owned) {
            let draped = corniche_drape::drape(&part.line, surface);
            if is_finest {
                let pieces: Vec<[u64; 2]> = pieces_um(&simplified, &part, &segments_um).collect();
                let void_um = gaps_um(&pieces, &draped.gaps);
                fate.void_um += void_um;
                fate.kept_um += pieces.iter().map(|[from, to]| to - from).sum::<u64>() - void_um;
            }
            for line in draped.lines {
                self.geo.push(GeoRoad {
                    way_id: road.way_id,
                    part: parts[0],
                    class: road.class,
                    line,
                });
                parts[0] += 1;
                laid += 1;
            }
        }
        let margin = levels.margin_steps(id.z());
        for part in corniche_drape::clip_closed(&simplified, &bounds.expanded(margin)) {
            for line in corniche_drape::extrude(&part, surface, margin) {
                self.sv.push(SvRoad {
                    way_id: road.way_id,
                    part: parts[1],
                    class: road.class,
                    line,
                });
                parts[1] += 1;
                laid += 1;
            }
        }
        if laid > 0 {
            self.attributes.entry(road.way_id).or_insert_with(|| RoadRecord {
                way_id: road.way_id,
                attributes: road.attributes.clone(),
            });
        }
        if fate != RoadFate::default() {
            self.fates.push((ordinal, fate));
        }
    }

    /// Puts roads into the order in which a payload has them.
    pub(crate) fn sort(&mut self) {
        self.geo.sort_by_key(|road| (road.class, road.way_id, road.part));
        self.sv.sort_by_key(|road| (road.class, road.way_id, road.part));
    }

    pub(crate) fn into_payload(mut self, id: TileId, terrain: Terrain) -> TilePayload {
        self.sort();
        TilePayload {
            id,
            terrain: Some(terrain),
            roads_geo: self.geo,
            roads_sv: self.sv,
            attributes: self.attributes.into_values().collect(),
        }
    }
}

/// How many of a line's points belong to a tile: each point belongs to one tile of a level.
fn points_of_tile(line: &corniche_geom::Polyline, id: TileId, levels: &Levels) -> u64 {
    let last = (1_i64 << id.z()) - 1;
    let own = [i64::from(id.x()), i64::from(id.y())];
    let outer = levels.frame().tile_lattice_bounds(TileId::ROOT);
    let is_own = |&&point: &&corniche_geom::LatticePoint| {
        // The root's own east and south border belong to its last tiles.
        let at = levels.frame().tile_column_row(id.z(), point);
        outer.contains(point) && at.map(|index| index.min(last)) == own
    };
    line.points().iter().filter(is_own).count() as u64
}
