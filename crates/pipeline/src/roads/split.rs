//! Splits a road into the pieces that the tiles of all levels need.

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, Road};

use super::{
    lengths::{TrueLengths, pieces_um},
    pieces::{RoadPiece, Run},
    reach::for_each_tile_near,
    totals::RoadLength,
};
use crate::levels::Levels;

/// What splitting needs.
pub(crate) struct Splitting<'a> {
    pub(crate) levels: &'a Levels,
    pub(crate) lengths: &'a TrueLengths<'a>,
    /// The finest tiles on which the data's rectangle lies, all together. Tiles beside it need no roads.
    pub(crate) data_bounds: LatticeBounds,
    /// The bounds that were asked for. Tiles on their edge get roads from outside, too: for what is drawn beside their ground.
    pub(crate) clip: Option<LatticeBounds>,
}

/// A road, split.
pub(crate) struct SplitRoad {
    pub(crate) length: RoadLength,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) bounds: Option<LatticeBounds>,
    /// By level and tile.
    pub(crate) pieces: Vec<(TileId, RoadPiece)>,
}

impl Splitting<'_> {
    /// The pieces of a road for every level that shows its class, and its true lengths.
    pub(crate) fn split(&self, road: &Road) -> SplitRoad {
        let segments_um = self.lengths.segments_um(&road.line);
        let length_um: u64 = segments_um.iter().sum();
        let length_in = |bounds: &LatticeBounds| -> u64 {
            corniche_drape::clip_parts(&road.line, bounds, OwnedBorders::ALL)
                .iter()
                .flat_map(|part| pieces_um(&road.line, part, &segments_um))
                .map(|[from, to]| to - from)
                .sum()
        };
        let clip = self.clip.as_ref();
        let asked_um = clip.map_or(length_um, length_in);
        let inside_um =
            length_in(&clip.map_or(self.data_bounds, |clip| clip.intersection(&self.data_bounds)));
        // Cuts are rounded to whole micrometres.
        let outside_um = asked_um.saturating_sub(inside_um);
        let bounds = LatticeBounds::of(road.line.points());
        let mut pieces = Vec::new();
        for level in self.levels.numbers() {
            if self.levels.shows(level, road.class) && self.is_near(bounds, level) {
                self.split_level(road, level, &segments_um, &mut pieces);
            }
        }
        SplitRoad {
            length: RoadLength {
                way_id: road.way_id,
                length_um,
                outside_um,
                beyond_um: length_um - inside_um - outside_um,
            },
            class: road.class,
            bounds,
            pieces,
        }
    }

    /// The pieces of one level. `segments_um` are the true lengths of the source line's segments.
    fn split_level(
        &self,
        road: &Road,
        level: u8,
        segments_um: &[u64],
        pieces: &mut Vec<(TileId, RoadPiece)>,
    ) {
        let levels = self.levels;
        let line = corniche_roads::simplify(road, levels.simplify_tolerance_steps(level));
        // On the finest level the line is the source line, not simplified.
        let is_finest = level == levels.frame().max_level();
        let segments_um = if is_finest { segments_um } else { &[] };
        let mut near = Vec::new();
        for (index, pair) in line.points().windows(2).enumerate() {
            for_each_tile_near([pair[0], pair[1]], level, levels, |id| {
                if self.is_data(id) {
                    near.push((id, index));
                }
            });
        }
        near.sort_unstable();
        let source = PointsByTile::of(&road.line, level, levels);
        let simplified = PointsByTile::of(&line, level, levels);
        for of_tile in near.chunk_by(|(one, _), (other, _)| one == other) {
            let id = of_tile[0].0;
            let runs = of_tile.chunk_by(|(_, one), (_, other)| one + 1 == *other);
            let piece = RoadPiece {
                way_id: road.way_id,
                class: road.class,
                attributes: road.attributes.clone(),
                source_points: source.count(id),
                simplified_points: simplified.count(id),
                runs: runs
                    .filter_map(|run| run_of(&line, [run[0].1, run[run.len() - 1].1], segments_um))
                    .collect(),
            };
            pieces.push((id, piece));
        }
    }

    /// Whether a road in this rectangle can meet a tile of a level, margin included. Most roads of an extract that is far larger
    /// than the data do not.
    fn is_near(&self, bounds: Option<LatticeBounds>, level: u8) -> bool {
        // A step of rounding, as where tiles are looked for.
        let reach = self.levels.margin_steps(level) + 1;
        let root = self.levels.frame().tile_lattice_bounds(TileId::ROOT).expanded(reach);
        bounds.is_some_and(|bounds| bounds.intersects(&root))
    }

    /// Whether a tile can have ground: it shares more than a border with the data's tiles.
    fn is_data(&self, id: TileId) -> bool {
        let (tile, data) = (self.levels.frame().tile_lattice_bounds(id), &self.data_bounds);
        tile.min.u < data.max.u
            && data.min.u < tile.max.u
            && tile.min.v < data.max.v
            && data.min.v < tile.max.v
    }
}

/// The run from segment `first` to segment `last`, both included.
fn run_of(line: &Polyline, [first, last]: [usize; 2], segments_um: &[u64]) -> Option<Run> {
    let line = Polyline::new(line.points()[first..=last + 1].to_vec()).ok()?;
    let segments_um = segments_um.get(first..=last).unwrap_or_default().to_vec();
    Some(Run { line, segments_um })
}

/// How many of a line's points belong to each tile of a level: each point belongs to one tile at most.
struct PointsByTile {
    /// Column and row of each point's tile, ascending.
    tiles: Vec<[i64; 2]>,
}

impl PointsByTile {
    fn of(line: &Polyline, level: u8, levels: &Levels) -> Self {
        let frame = levels.frame();
        let last = (1_i64 << level) - 1;
        let outer = frame.tile_lattice_bounds(TileId::ROOT);
        // The root's own east and south border belong to its last tiles.
        let tile = |&point: &LatticePoint| {
            frame.tile_column_row(level, point).map(|index| index.min(last))
        };
        let inside = line.points().iter().filter(|&&point| outer.contains(point));
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
