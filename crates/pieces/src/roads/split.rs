//! Splits a road into the pieces that the tiles of all levels need.

use std::{borrow::Cow, sync::Arc};

use corniche_drape::{ClippedPart, OwnedBorders};
use corniche_geom::{LatticeBounds, LatticePoint, LatticeRegion, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, Road, RoadAttributes, Structure};
use corniche_spec::{levels::Levels, true_lengths::TrueLengths};

use super::{near_spans::NearRoad, pieces::RoadPiece, totals::RoadLength};
use crate::layers::{
    fixed_points::road_of_part,
    segment_run::{LevelPart, SegmentRun, alongs_um},
};

/// The settings and data that splitting needs.
pub(crate) struct RoadSplitting<'a> {
    pub levels: &'a Levels,
    pub lengths: &'a TrueLengths<'a>,
    /// The union of the finest tiles that the data's rectangle touches. Tiles outside it need no
    /// roads.
    pub data_bounds: LatticeBounds,
    /// The data's rectangle, which contains all nodes at which there can be data.
    pub node_bounds: LatticeBounds,
    /// The requested bounds. Tiles on their edge also get roads from outside, which are drawn
    /// outside their ground.
    pub clip: Option<LatticeBounds>,
    /// The requested polygon: roads are clipped to its outline.
    pub polygon: Option<&'a LatticeRegion>,
    /// Whether bridges and tunnels become spans: then pieces store their position along their road,
    /// and their nodes.
    pub spans: bool,
}

/// A road that has been split.
pub(crate) struct SplitRoad {
    pub length: RoadLength,
    pub class: FunctionalRoadClass,
    pub bounds: Option<LatticeBounds>,
    /// The pieces with their tiles, on all levels.
    pub pieces: Vec<(TileId, RoadPiece)>,
    /// The road as spans may need it, if spans are requested.
    pub near: Option<NearRoad>,
}

impl RoadSplitting<'_> {
    /// The pieces of a road for every level that shows its class, and its true lengths.
    pub(crate) fn split(&self, ordinal: u32, road: &Road) -> SplitRoad {
        let is_span = self.spans && road.attributes.structure != Structure::Ground;
        let segments_um = if is_span {
            // A deck must be the same with and without bounds, so the coordinate table, whose
            // extent depends on the bounds, is not used.
            self.lengths.projected_segments_um(&road.line)
        } else {
            self.lengths.segments_um(&road.line)
        };
        let length_um: u64 = segments_um.iter().sum();
        let mut near =
            self.spans.then(|| NearRoad::from_road(road, Some(ordinal), &segments_um, false));
        let parts = self.parts(road, segments_um);
        let length_in = |bounds: &LatticeBounds| -> u64 {
            parts.iter().map(|part| part.length_in_um(bounds, self.lengths)).sum()
        };
        let clip = self.clip.as_ref();
        let all_um = || parts.iter().flat_map(|part| &part.segments_um).sum();
        let asked_um: u64 = clip.map_or_else(all_um, length_in);
        let inside_um =
            length_in(&clip.map_or(self.data_bounds, |clip| clip.intersection(&self.data_bounds)));
        // Cuts are rounded to whole micrometres.
        let outside_um = asked_um.saturating_sub(inside_um);
        let nodes = &self.node_bounds;
        let bounds = LatticeBounds::around(road.line.points());
        let padding_um = if bounds.is_some_and(|own| own.intersection(nodes) == own) {
            0
        } else {
            let on_nodes_um = length_in(&clip.map_or(*nodes, |clip| clip.intersection(nodes)));
            inside_um.saturating_sub(on_nodes_um)
        };
        if let Some(near) = &mut near {
            near.is_reached = inside_um > 0;
        }
        let attributes = Arc::new(road.attributes.clone());
        let mut pieces = Vec::new();
        for level in self.levels.numbers() {
            if self.levels.shows(level, road.class) {
                self.split_level(&parts, &attributes, level, &mut pieces);
            }
        }
        SplitRoad {
            near,
            length: RoadLength {
                way_id: road.way_id,
                structure: road.attributes.structure,
                length_um,
                outside_um,
                padding_um,
                beyond_um: length_um - inside_um - outside_um,
            },
            class: road.class,
            bounds,
            pieces,
        }
    }

    /// Whether a road reaches the data and the requested region.
    pub(crate) fn reaches(&self, road: &Road) -> bool {
        let data = self.clip.map_or(self.data_bounds, |clip| clip.intersection(&self.data_bounds));
        let is_inside = |line: &Polyline| {
            !corniche_drape::clip_parts(line, &data, OwnedBorders::ALL).is_empty()
        };
        match self.polygon {
            None => is_inside(&road.line),
            Some(region) => corniche_drape::clip_region(&road.line, region)
                .iter()
                .any(|part| is_inside(&part.line)),
        }
    }

    /// The parts of a road inside the polygon; without a polygon, the road. `segments_um` are the
    /// true lengths of the road's segments.
    fn parts<'r>(&self, road: &'r Road, segments_um: Vec<u64>) -> Vec<RoadPart<'r>> {
        let Some(region) = self.polygon else {
            return vec![RoadPart { road: Cow::Borrowed(road), segments_um, from_um: 0 }];
        };
        let parts = corniche_drape::clip_region(&road.line, region);
        if parts.first().is_some_and(|part| part.line == road.line) {
            return vec![RoadPart { road: Cow::Borrowed(road), segments_um, from_um: 0 }];
        }
        parts
            .into_iter()
            .map(|part| RoadPart::cut(road, part, &segments_um, self.lengths))
            .collect()
    }

    /// Returns the pieces on one level.
    fn split_level(
        &self,
        parts: &[RoadPart<'_>],
        attributes: &Arc<RoadAttributes>,
        level: u8,
        pieces: &mut Vec<(TileId, RoadPiece)>,
    ) {
        let levels = self.levels;
        let lines: Vec<LevelLine> = parts
            .iter()
            .filter(|part| self.is_near(LatticeBounds::around(part.road.line.points()), level))
            .map(|part| LevelLine::new(part, level, levels, self.spans))
            .collect();
        let mut near = Vec::new();
        for (of, line) in lines.iter().enumerate() {
            let runs = line.part.runs(level, levels, |id| self.is_data(id)).into_iter();
            near.extend(runs.map(|(id, run)| (id, of, run)));
        }
        near.sort_unstable();
        for of_tile in near.chunk_by(|(one, ..), (other, ..)| one == other) {
            let id = of_tile[0].0;
            let road = &parts[0].road;
            pieces.push((
                id,
                RoadPiece {
                    way_id: road.way_id,
                    class: road.class,
                    attributes: Arc::clone(attributes),
                    source_points: lines.iter().map(|line| line.source.count(id)).sum(),
                    simplified_points: lines.iter().map(|line| line.simplified.count(id)).sum(),
                    runs: of_tile.iter().filter_map(|&(_, of, run)| lines[of].run(run)).collect(),
                },
            ));
        }
    }

    /// Whether a road in this rectangle may touch a tile of a level, margin included. If the
    /// extract is far larger than the data, most roads do not.
    fn is_near(&self, bounds: Option<LatticeBounds>, level: u8) -> bool {
        // One step of rounding is added, as in the search for tiles.
        let reach = self.levels.margin_steps(level) + 1;
        let root = self.levels.frame().tile_lattice_bounds(TileId::ROOT).expanded(reach);
        bounds.is_some_and(|bounds| bounds.intersects(&root))
    }

    /// Whether a tile can have ground: it overlaps the data's tiles by more than a border.
    fn is_data(&self, id: TileId) -> bool {
        let tile = self.levels.frame().tile_lattice_bounds(id);
        let LatticeBounds { min, max } = tile.intersection(&self.data_bounds);
        min.u < max.u && min.v < max.v
    }
}

/// A part of a road inside the requested polygon, or the whole road.
struct RoadPart<'r> {
    road: Cow<'r, Road>,
    /// True lengths of the part's segments.
    segments_um: Vec<u64>,
    /// Distance of its start along the road, micrometres.
    from_um: u64,
}

impl RoadPart<'_> {
    /// Cuts a part out of a road whose segments have these lengths.
    fn cut(road: &Road, part: ClippedPart, segments_um: &[u64], lengths: &TrueLengths<'_>) -> Self {
        let (from_um, segments_um) = lengths.part_um(&road.line, &part, segments_um);
        Self { from_um, segments_um, road: Cow::Owned(road_of_part(road, part)) }
    }

    fn length_in_um(&self, bounds: &LatticeBounds, lengths: &TrueLengths<'_>) -> u64 {
        let line = &self.road.line;
        let parts = corniche_drape::clip_parts(line, bounds, OwnedBorders::ALL);
        lengths.parts_um(line, &parts, &self.segments_um)
    }
}

/// A part as a level shows it.
struct LevelLine {
    /// Positions along the road are known on the finest level, and of bridges and tunnels that
    /// become spans.
    part: LevelPart,
    /// Nodes of the line at which other roads may join, by the index of their point; on the finest
    /// level only.
    nodes: Vec<(usize, i64)>,
    source: PointsByTile,
    simplified: PointsByTile,
}

impl LevelLine {
    fn new(part: &RoadPart<'_>, level: u8, levels: &Levels, spans: bool) -> Self {
        let road = &part.road;
        let points = road.line.points();
        // On the finest level the line is the source line, not simplified.
        let is_finest = level == levels.frame().max_level();
        let is_span = spans && road.attributes.structure != Structure::Ground;
        let along_um = if is_finest || is_span {
            alongs_um(part.from_um, &part.segments_um)
        } else {
            Vec::new()
        };
        let tolerance_steps = levels.simplify_tolerance_steps(level);
        let kept = corniche_roads::kept_points(&road.line, &road.fixed, tolerance_steps);
        let of_level = LevelPart::new((points, &along_um), &kept, |at| at);
        let nodes = road.fixed.iter().zip(&road.node_ids);
        let nodes = nodes.filter(|_| spans && is_finest);
        Self {
            nodes: nodes.filter_map(|(&at, id)| Some((at as usize, (*id)?))).collect(),
            source: PointsByTile::new(points, level, levels),
            simplified: PointsByTile::new(&of_level.points, level, levels),
            part: of_level,
        }
    }

    /// The run from segment `first` to segment `last`, both included.
    fn run(&self, [first, last]: [usize; 2]) -> Option<SegmentRun> {
        let [from, to] =
            [first, last + 2].map(|end| self.nodes.partition_point(|(at, _)| *at < end));
        let nodes = self.nodes[from..to].iter();
        let nodes = nodes.map(|&(at, id)| ((at - first) as u32, id)).collect();
        Some(SegmentRun { nodes, ..self.part.stretch([first, last]).run()? })
    }
}

/// The number of a line's points in each tile of a level: each point belongs to at most one tile.
struct PointsByTile {
    /// Column and row of each point's tile, ascending.
    tiles: Vec<[i64; 2]>,
}

impl PointsByTile {
    fn new(points: &[LatticePoint], level: u8, levels: &Levels) -> Self {
        let frame = levels.frame();
        let last = (1_i64 << level) - 1;
        let outer = frame.tile_lattice_bounds(TileId::ROOT);
        // The root's own east and south border belong to its last tiles.
        let tile = |&point: &LatticePoint| {
            frame.tile_column_row(level, point).map(|index| index.min(last))
        };
        let inside = points.iter().filter(|&&point| outer.contains(point));
        let mut tiles: Vec<[i64; 2]> = inside.map(tile).collect();
        tiles.sort_unstable();
        Self { tiles }
    }

    fn count(&self, id: TileId) -> u64 {
        let own = [i64::from(id.x()), i64::from(id.y())];
        let before = self.tiles.partition_point(|tile| *tile < own);
        let up_to = self.tiles.partition_point(|tile| *tile <= own);
        (up_to - before) as u64
    }
}

#[cfg(test)]
#[path = "split_tests.rs"]
mod tests;
