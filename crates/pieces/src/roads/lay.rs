//! Drapes roads on the tiles of a level, and sums up the results.

use std::collections::BTreeMap;

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, TileId};
use corniche_roads::Structure;
use corniche_spec::{levels::Levels, true_lengths::TrueLengths};
use corniche_tileset::{GeoRoad, RoadRecord, RunOwner, SvRoad, TilePayload, TileTerrain};
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use super::{
    ground_lines::{SpanGroundLine, lines_of},
    pieces::{RoadPiece, TilePieces},
};
use crate::layers::{
    segment_run::SegmentRun,
    span_pieces::{CarriedLine, SpanLineOf},
};

/// Sums over the roads of a class on a level.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassSums {
    /// Points of the source lines in tiles with ground.
    pub source_vertices: u64,
    /// Points of the level's simplified lines in tiles with ground.
    pub simplified_vertices: u64,
    /// Vertices of GEO lines (roads drawn as geometry on the TIN).
    pub geo_vertices: u64,
    /// Vertices of SV lines (simplified, for roads drawn by shadow volumes).
    pub sv_vertices: u64,
    /// Bytes of the section GEO in the payload.
    pub geo_stored_bytes: u64,
    /// Bytes of the section SV in the payload.
    pub sv_stored_bytes: u64,
}

impl ClassSums {
    /// Adds the sums over other roads. The result does not depend on order or grouping.
    pub fn merge(&mut self, other: &Self) {
        // Without `..`, a new field cannot be forgotten.
        let Self {
            source_vertices,
            simplified_vertices,
            geo_vertices,
            sv_vertices,
            geo_stored_bytes,
            sv_stored_bytes,
        } = other;
        self.source_vertices += source_vertices;
        self.simplified_vertices += simplified_vertices;
        self.geo_vertices += geo_vertices;
        self.sv_vertices += sv_vertices;
        self.geo_stored_bytes += geo_stored_bytes;
        self.sv_stored_bytes += sv_stored_bytes;
    }
}

/// What became of a road, or of a part of it, on the finest level.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct RoadFate {
    /// True length on a TIN, micrometres.
    pub(crate) kept_um: u64,
    /// True length on the data's tiles without ground, micrometres.
    pub(crate) void_um: u64,
}

impl RoadFate {
    /// Adds the fates of other parts. The result does not depend on order or grouping.
    pub fn merge(&mut self, other: &Self) {
        let Self { kept_um, void_um } = other;
        self.kept_um += kept_um;
        self.void_um += void_um;
    }
}

/// A tile on which roads are draped.
pub struct TileToLayOn<'a> {
    /// The tile.
    pub id: TileId,
    /// Its TIN, on the lattice.
    pub surface: &'a Surface,
    /// Which of its borders belong to the tile.
    pub owned: OwnedBorders,
    /// The requested bounds: on the finest level, roads end there.
    pub clip: Option<LatticeBounds>,
    /// Whether bridges and tunnels become spans.
    pub spans: bool,
    /// Measures roads.
    pub lengths: &'a TrueLengths<'a>,
}

/// The fates of a tile's roads if it is a finest tile without ground.
#[must_use]
pub fn lost_pieces(
    pieces: &TilePieces,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
    clip: Option<LatticeBounds>,
    lengths: &TrueLengths<'_>,
) -> Vec<(u32, RoadFate)> {
    let within = clip.unwrap_or(*bounds);
    let lost = |run: &SegmentRun| -> u64 {
        let parts = corniche_drape::clip_parts_within(&run.line, bounds, owned, &within);
        lengths.parts_um(&run.line, &parts, &run.segments_um)
    };
    let mut fates = Vec::new();
    for (ordinal, piece) in &pieces.roads {
        let fate = RoadFate { kept_um: 0, void_um: piece.runs.iter().map(lost).sum() };
        if fate != RoadFate::default() {
            fates.push((*ordinal, fate));
        }
    }
    fates
}

/// The draped roads of one tile.
#[derive(Default)]
pub struct DrapedRoads {
    /// Roads on the ground.
    pub geo: Vec<GeoRoad>,
    /// Roads for shadow volumes.
    pub sv: Vec<SvRoad>,
    /// The record of each way.
    pub attributes: BTreeMap<i64, RoadRecord>,
    /// The fate of each road's pieces, by the road's number.
    pub fates: Vec<(u32, RoadFate)>,
    /// Sums by class.
    pub classes: BTreeMap<u8, ClassSums>,
    /// The ground beneath bridges and tunnels, if they become spans.
    pub ground_lines: Vec<SpanGroundLine>,
    /// Next part number of each way, GEO and SV.
    parts: BTreeMap<i64, [u32; 2]>,
}

impl DrapedRoads {
    /// Drapes all roads of a tile.
    #[must_use]
    pub fn of_tile(pieces: &TilePieces, on: &TileToLayOn<'_>, levels: &Levels) -> Self {
        let mut laid = Self::default();
        for (ordinal, piece) in &pieces.roads {
            laid.lay(*ordinal, piece, on, levels);
        }
        for (of, run) in &pieces.of_layers {
            // The tile has the line itself in plan. Both tiles have a line on their border.
            let bounds = levels.frame().tile_lattice_bounds(on.id);
            for part in corniche_drape::clip_parts(&run.line, &bounds, OwnedBorders::ALL) {
                let draped = corniche_drape::drape(&part.line, on.surface);
                let measured = (on.surface, on.lengths);
                laid.ground_lines.extend(lines_of(*of, (run, &part), &draped, measured));
            }
        }
        laid
    }

    fn lay(&mut self, ordinal: u32, road: &RoadPiece, on: &TileToLayOn<'_>, levels: &Levels) {
        let sums = self.classes.entry(road.class.number()).or_default();
        sums.source_vertices += road.source_points;
        sums.simplified_vertices += road.simplified_points;
        let before = self.geo.len() + self.sv.len();
        let fate = self.lay_geo((ordinal, road), on, levels);
        self.lay_sv(road, on, levels);
        if self.geo.len() + self.sv.len() > before {
            self.attributes.entry(road.way_id).or_insert_with(|| RoadRecord {
                way_id: road.way_id,
                attributes: (*road.attributes).clone(),
            });
        }
        if fate != RoadFate::default() {
            self.fates.push((ordinal, fate));
        }
    }

    fn lay_geo(
        &mut self,
        (ordinal, road): (u32, &RoadPiece),
        on: &TileToLayOn<'_>,
        levels: &Levels,
    ) -> RoadFate {
        let &TileToLayOn { id, surface, owned, clip, spans, lengths } = on;
        let structure = road.attributes.structure;
        let of = SpanLineOf {
            line: CarriedLine::Road(ordinal),
            way_id: road.way_id,
            owner: RunOwner::Road(road.class),
            structure,
        };
        let bounds = levels.frame().tile_lattice_bounds(id);
        let is_finest = id.z() == levels.frame().max_level();
        // On coarser levels the ground ends before the bounds, and so do the roads.
        let within = clip.filter(|_| is_finest).unwrap_or(bounds);
        let [next_part, _] = self.parts.entry(road.way_id).or_default();
        let mut fate = RoadFate::default();
        for run in &road.runs {
            for part in corniche_drape::clip_parts_within(&run.line, &bounds, owned, &within) {
                let draped = corniche_drape::drape(&part.line, surface);
                if is_finest {
                    let pieces: Vec<[u64; 2]> =
                        lengths.pieces_um(&run.line, &part, &run.segments_um).collect();
                    let void_um = lengths.gaps_um(&part, &pieces, &draped.gaps);
                    let all_um: u64 = pieces.iter().map(|[from, to]| to - from).sum();
                    fate.merge(&RoadFate { kept_um: all_um - void_um, void_um });
                }
                if spans && structure != Structure::Ground {
                    let measured = (surface, lengths);
                    self.ground_lines.extend(lines_of(of, (run, &part), &draped, measured));
                }
                for line in draped.lines {
                    let (way_id, class, part) = (road.way_id, road.class, *next_part);
                    self.geo.push(GeoRoad { way_id, part, class, line });
                    *next_part += 1;
                }
            }
        }
        fate
    }

    fn lay_sv(&mut self, road: &RoadPiece, on: &TileToLayOn<'_>, levels: &Levels) {
        let margin = levels.margin_steps(on.id.z());
        let bounds = levels.frame().tile_lattice_bounds(on.id).expanded(margin);
        let [_, next_part] = self.parts.entry(road.way_id).or_default();
        for run in &road.runs {
            for part in corniche_drape::clip_closed(&run.line, &bounds) {
                for line in corniche_drape::extrude(&part, on.surface, margin) {
                    let (way_id, class, part) = (road.way_id, road.class, *next_part);
                    self.sv.push(SvRoad { way_id, part, class, line });
                    *next_part += 1;
                }
            }
        }
    }

    /// Sorts the roads into the order of a payload.
    pub fn sort(&mut self) {
        self.geo.sort_by_key(|road| (road.class, road.way_id, road.part));
        self.sv.sort_by_key(|road| (road.class, road.way_id, road.part));
    }

    /// The payload of the tile, with its ground.
    #[must_use]
    pub fn into_payload(mut self, id: TileId, terrain: TileTerrain) -> TilePayload {
        self.sort();
        TilePayload {
            id,
            terrain: Some(terrain),
            relief: None,
            roads_geo: self.geo,
            roads_sv: self.sv,
            attributes: self.attributes.into_values().collect(),
        }
    }
}
