//! Draping pieces gives the same result as draping whole roads, tile by tile.

use std::collections::BTreeMap;

use corniche_drape::Neighbours;
use corniche_geom::{Bounds, CoordinateTable, GridFrame, HeightGrid, NodeIndex, TILE_CELLS};
use corniche_roads::{ClassFilter, FrcTable, MetNodes, RoadAttributes};
use corniche_spec::RoadSettings;
use corniche_testing::FlatProjection;
use corniche_tileset::{GeoRoad, RoadRecord, SvRoad};
use corniche_tin::{Placement, Surface, TinSpec};
use proptest::{collection::vec, prelude::*};

use super::*;
use crate::roads::{
    lay::{ClassSums, DrapedRoads, RoadFate, TileToLayOn, lost_pieces},
    pieces::TilePieces,
};

/// A package's frame and settings.
#[derive(Debug, Clone)]
struct World {
    levels: Levels,
    table: CoordinateTable,
    projection: FlatProjection,
    data_bounds: LatticeBounds,
    /// Nodes without a height, out of the nine by nine nodes of each tile.
    gaps: Vec<(usize, usize)>,
}

impl World {
    fn lengths(&self) -> TrueLengths<'_> {
        TrueLengths::new(*self.levels.frame(), &self.table, &self.projection)
    }

    fn tiles(&self) -> impl Iterator<Item = TileId> {
        self.levels.numbers().flat_map(|z| {
            let side = 1_u32 << z;
            (0..side * side).map(move |index| TileId::new(z, index % side, index / side).unwrap())
        })
    }

    /// The ground of a tile: eight by eight cells with voids.
    fn surface(&self, id: TileId) -> Surface {
        let heights = HeightGrid::from_fn(11, 11, |column, row| {
            let is_gap = self.gaps.contains(&((column + id.x() as usize) % 11, row));
            if is_gap { f32::NAN } else { (column * 7 % 5 + row * 3 % 4) as f32 }
        });
        let spec = TinSpec { max_error_m: 1.0, quantum_m: 1.0 / 32.0 };
        let tin = corniche_tin::triangulate(&heights, spec).unwrap();
        let bounds = self.levels.frame().tile_lattice_bounds(id);
        let corner = LatticePoint::new(bounds.min.u, bounds.max.v);
        let node_steps = [bounds.max.u - bounds.min.u, bounds.max.v - bounds.min.v]
            .map(|side| side / (TILE_CELLS / 32));
        Surface::new(&tin, Placement { corner, node_steps, quantum_m: spec.quantum_m })
    }

    fn owned(&self, id: TileId) -> OwnedBorders {
        let there = |east, south| id.neighbour(east, south).is_some();
        OwnedBorders::among(Neighbours { east: there(1, 0), south: there(0, 1) }).where_ground(
            |column, row| {
                let here = |index: i64| (index.div_euclid(32) + 1) as usize;
                !self.gaps.contains(&(here(column), here(row)))
            },
        )
    }
}

/// The draped roads of a tile.
#[derive(Debug, Default, PartialEq)]
struct OnTile {
    geo: Vec<GeoRoad>,
    sv: Vec<SvRoad>,
    attributes: BTreeMap<i64, RoadRecord>,
    fates: Vec<(u32, RoadFate)>,
    classes: BTreeMap<u8, ClassSums>,
    lost: Vec<(u32, RoadFate)>,
}

/// The oracle: a whole road is simplified, clipped and draped on a tile, as if no other tile
/// existed.
fn lay_whole(on: &mut OnTile, road: &Road, ordinal: u32, world: &World, id: TileId) {
    let (levels, lengths, owned) = (&world.levels, world.lengths(), world.owned(id));
    let surface = world.surface(id);
    let bounds = levels.frame().tile_lattice_bounds(id);
    let line =
        corniche_roads::simplify(&road.line, &road.fixed, levels.simplify_tolerance_steps(id.z()));
    let is_finest = id.z() == levels.frame().max_level();
    let segments_um = if is_finest { lengths.segments_um(&line) } else { Vec::new() };
    let (mut fate, mut lost) = (RoadFate::default(), RoadFate::default());
    let before = on.geo.len() + on.sv.len();
    let next_part = |parts: &mut dyn Iterator<Item = i64>| {
        parts.filter(|&way_id| way_id == road.way_id).count() as u32
    };
    for part in corniche_drape::clip_parts(&line, &bounds, owned) {
        let draped = corniche_drape::drape(&part.line, &surface);
        if is_finest {
            let lengths = world.lengths();
            let pieces: Vec<[u64; 2]> = lengths.pieces_um(&line, &part, &segments_um).collect();
            let all_um: u64 = pieces.iter().map(|[from, to]| to - from).sum();
            let void_um = lengths.gaps_um(&part, &pieces, &draped.gaps);
            fate.void_um += void_um;
            fate.kept_um += all_um - void_um;
            lost.void_um += all_um;
        }
        for line in draped.lines {
            let part = next_part(&mut on.geo.iter().map(|road| road.way_id));
            on.geo.push(GeoRoad { way_id: road.way_id, part, class: road.class, line });
        }
    }
    let margin = levels.margin_steps(id.z());
    for part in corniche_drape::clip_closed(&line, &bounds.expanded(margin)) {
        for line in corniche_drape::extrude(&part, &surface, margin) {
            let part = next_part(&mut on.sv.iter().map(|road| road.way_id));
            on.sv.push(SvRoad { way_id: road.way_id, part, class: road.class, line });
        }
    }
    if on.geo.len() + on.sv.len() > before {
        let (way_id, attributes) = (road.way_id, road.attributes.clone());
        on.attributes.entry(way_id).or_insert(RoadRecord { way_id, attributes });
    }
    on.fates.extend((fate != RoadFate::default()).then_some((ordinal, fate)));
    on.lost.extend((lost != RoadFate::default()).then_some((ordinal, lost)));
}

/// The number of a line's points in a tile: the oracle for counts.
fn points_in(line: &Polyline, id: TileId, levels: &Levels) -> u64 {
    let bounds = levels.frame().tile_lattice_bounds(id);
    let root = levels.frame().tile_lattice_bounds(TileId::ROOT);
    let is_in = |point: &&LatticePoint| {
        let in_u = point.u >= bounds.min.u
            && (point.u < bounds.max.u || point.u == bounds.max.u && point.u == root.max.u);
        let in_v = point.v <= bounds.max.v
            && (point.v > bounds.min.v || point.v == bounds.min.v && point.v == root.min.v);
        in_u && in_v
    };
    line.points().iter().filter(is_in).count() as u64
}

fn worlds() -> impl Strategy<Value = World> {
    let cell = prop_oneof![Just([30.0, 30.0]), Just([1.0, 1.0]), Just([20.0, 30.0])];
    let gaps = vec((1..10_usize, 1..10_usize), 0..6);
    (cell, 0..=2_u8, 0..=2_i64, gaps, 0.0..4.0_f64, any::<bool>()).prop_map(
        |(cell, max_level, corner, gaps, simplify_cells, is_all)| {
            let cell = corniche_geom::Cell::from(cell).fitted();
            let corner = NodeIndex { i: -corner * TILE_CELLS, j: corner * 2 * TILE_CELLS };
            let frame = GridFrame::new([5e5, 5e6], cell, corner, max_level).unwrap();
            let settings = RoadSettings {
                table: FrcTable::new("t", vec![("primary".into(), 0)], Vec::new(), 8).unwrap(),
                filter: ClassFilter::new([None; FunctionalRoadClass::COUNT]).unwrap(),
                simplify_cells,
                spans: false,
            };
            let levels = Levels::new(frame, cell.shorter_m(), &settings, 1.0);
            // Lengths inside and outside the table differ, so that the test shows which of them was
            // used.
            let Bounds { min_x, min_y, max_x, max_y } = frame.tile_bounds(TileId::ROOT);
            let half = [f64::midpoint(min_x, max_x), f64::midpoint(min_y, max_y)];
            let tabulated = Bounds { min_x, min_y, max_x: half[0], max_y: half[1] };
            let of_table = FlatProjection::new([1e5, 1.3e5]);
            let table = CoordinateTable::sample(&of_table, tabulated, 0.01).unwrap();
            let first = TileId::new(max_level, 0, 0).unwrap();
            let data = if is_all { TileId::ROOT } else { first };
            let data_bounds = frame.tile_lattice_bounds(data);
            let projection = FlatProjection::new([1.1e5, 1.2e5]);
            World { levels, table, projection, data_bounds, gaps }
        },
    )
}

/// A coordinate: a position within the root, and a border with a distance from it.
type PointSeed = (u8, f64, i64, i64);

fn places() -> impl Strategy<Value = PointSeed> {
    (0..12_u8, -0.4..1.4_f64, 0..=4_i64, -1..=1_i64)
}

/// Roads with points anywhere: on borders of tiles and of margins, a step away from them, and far
/// away; some are rings.
fn roads() -> impl Strategy<Value = Vec<Vec<(PointSeed, PointSeed)>>> {
    vec(vec((places(), places()), 2..14), 1..4)
}

impl World {
    fn coordinate(&self, (kind, share, border, step): PointSeed, ends: [i64; 2]) -> i64 {
        let [min, max] = ends;
        let level = self.levels.frame().max_level().min(kind % 3);
        let margin = self.levels.margin_steps(level);
        let border = min + (max - min) / 4 * border;
        match kind {
            0..=4 => min + ((max - min) as f64 * share) as i64,
            5 => border,
            6 | 7 => border + margin,
            8 => border - margin,
            9 => border + margin + step,
            10 => border - margin + step,
            _ => {
                if share < 1.2 {
                    border + step
                } else {
                    max << 20
                }
            }
        }
    }

    fn road(&self, ordinal: u32, points: &[(PointSeed, PointSeed)]) -> Road {
        let root = self.levels.frame().tile_lattice_bounds(TileId::ROOT);
        let at = |&(u, v): &(PointSeed, PointSeed)| {
            let u = self.coordinate(u, [root.min.u, root.max.u]);
            LatticePoint::new(u, self.coordinate(v, [root.min.v, root.max.v]))
        };
        let mut line: Vec<LatticePoint> = points.iter().map(at).collect();
        if ordinal % 3 == 1 {
            line.push(line[0]);
        }
        line.push(LatticePoint::new(line[line.len() - 1].u + 7, line[0].v));
        line.push(LatticePoint::new(line[line.len() - 1].u + 1, line[0].v + 1));
        let line = Polyline::new(line).unwrap();
        let last = line.points().len() as u32 - 1;
        Road {
            // Two of the roads belong to one way.
            way_id: [40, 41, 41][ordinal as usize % 3],
            class: FunctionalRoadClass::new(ordinal as u8 % 9).unwrap(),
            attributes: RoadAttributes { name: format!("{ordinal}"), ..RoadAttributes::default() },
            line,
            fixed: vec![0, last / 2, last],
            node_ids: Vec::new(),
            same_places: Vec::new(),
            met: MetNodes::default(),
        }
    }
}

proptest! {
    /// Draped pieces of roads equal draped whole roads: lines, their order and numbers, lengths,
    /// attributes and counts. A tile without a piece of a road has no part of it.
    #[test]
    fn pieces_are_laid_as_whole_roads_are(world in worlds(), roads in roads()) {
        let roads: Vec<Road> =
            (0..).zip(&roads).map(|(ordinal, points)| world.road(ordinal, points)).collect();
        let lengths = world.lengths();
        let splitting =
            RoadSplitting { levels: &world.levels, lengths: &lengths, data_bounds: world.data_bounds, node_bounds: world.data_bounds, clip: None, polygon: None, spans: false };
        let mut by_tile: BTreeMap<TileId, TilePieces> = BTreeMap::new();
        for (ordinal, road) in (0..).zip(&roads) {
            for (id, piece) in splitting.split(0, road).pieces {
                by_tile.entry(id).or_default().roads.push((ordinal, piece));
            }
        }
        let data = world.data_bounds;
        let is_within = |id: TileId| {
            let tile = world.levels.frame().tile_lattice_bounds(id);
            tile.min.u >= data.min.u && tile.min.v >= data.min.v && tile.max.u <= data.max.u && tile.max.v <= data.max.v
        };
        for id in world.tiles() {
            let pieces = by_tile.remove(&id).unwrap_or_default();
            if pieces.roads.is_empty() && !is_within(id) && id != TileId::ROOT {
                continue;
            }
            let (surface, owned) = (world.surface(id), world.owned(id));
            let laid = DrapedRoads::of_tile(&pieces, &TileToLayOn { id, surface: &surface, owned, clip: None, spans: false, lengths: &lengths }, &world.levels);
            let bounds = world.levels.frame().tile_lattice_bounds(id);
            let is_finest = id.z() == world.levels.frame().max_level();
            let found = OnTile {
                geo: laid.geo,
                sv: laid.sv,
                attributes: laid.attributes,
                fates: laid.fates,
                classes: laid.classes,
                lost: if is_finest { lost_pieces(&pieces, &bounds, owned, None, &lengths) } else { Vec::new() },
            };
            let mut wanted = OnTile::default();
            for (ordinal, road) in (0..).zip(&roads) {
                lay_whole(&mut wanted, road, ordinal, &world, id);
                if pieces.roads.iter().any(|&(other, _)| other == ordinal) {
                    let tolerance_steps = world.levels.simplify_tolerance_steps(id.z());
                    let line = corniche_roads::simplify(&road.line, &road.fixed, tolerance_steps);
                    let sums = wanted.classes.entry(road.class.number()).or_default();
                    sums.source_vertices += points_in(&road.line, id, &world.levels);
                    sums.simplified_vertices += points_in(&line, id, &world.levels);
                }
            }
            prop_assert_eq!(&found, &wanted, "tile {}", id);
        }
        prop_assert!(by_tile.is_empty(), "pieces of no tile");
    }
}

/// A level of 32 by 32 tiles.
struct Large {
    levels: Levels,
    table: CoordinateTable,
    projection: FlatProjection,
}

impl Large {
    fn new() -> Self {
        let frame = GridFrame::new([0.0; 2], 10.0, NodeIndex { i: 0, j: 0 }, 5).unwrap();
        let settings = RoadSettings {
            table: FrcTable::new("t", vec![("primary".into(), 0)], Vec::new(), 8).unwrap(),
            filter: ClassFilter::new([None; FunctionalRoadClass::COUNT]).unwrap(),
            simplify_cells: 0.5,
            spans: false,
        };
        let projection = FlatProjection::new([1e5; 2]);
        let bounds = frame.tile_bounds(TileId::ROOT);
        let table = CoordinateTable::sample(&projection, bounds, 0.01).unwrap();
        Self { levels: Levels::new(frame, 2.5, &settings, 1.0), table, projection }
    }

    fn lengths(&self) -> TrueLengths<'_> {
        TrueLengths::new(*self.levels.frame(), &self.table, &self.projection)
    }

    /// A road through these points, split for the data's rectangle.
    fn split(&self, points: Vec<LatticePoint>, data_bounds: LatticeBounds) -> SplitRoad {
        self.split_around(points, data_bounds, data_bounds)
    }

    /// Splits where the data's rectangle is `node_bounds`, and its tiles are those of
    /// `data_bounds`.
    fn split_around(
        &self,
        points: Vec<LatticePoint>,
        data_bounds: LatticeBounds,
        node_bounds: LatticeBounds,
    ) -> SplitRoad {
        let last = points.len() as u32 - 1;
        let road = Road {
            way_id: 1,
            class: FunctionalRoadClass::new(0).unwrap(),
            attributes: RoadAttributes::default(),
            line: Polyline::new(points).unwrap(),
            fixed: vec![0, last],
            node_ids: Vec::new(),
            same_places: Vec::new(),
            met: MetNodes::default(),
        };
        let lengths = self.lengths();
        RoadSplitting {
            levels: &self.levels,
            lengths: &lengths,
            data_bounds,
            node_bounds,
            clip: None,
            polygon: None,
            spans: false,
        }
        .split(0, &road)
    }
}

/// One road from within the data through the padding of their tiles to the outside, and one in the
/// padding alone.
#[test]
fn the_padding_of_tiles_is_measured_by_itself() {
    let large = Large::new();
    let frame = large.levels.frame();
    let tile = frame.tile_lattice_bounds(TileId::new(5, 3, 3).unwrap());
    let (min, size) = (tile.min, tile.max.u - tile.min.u);
    let nodes = LatticeBounds { min, max: LatticePoint::new(min.u + size / 4, tile.max.v) };
    let at = |eighths: i64| LatticePoint::new(min.u + size / 8 * eighths, min.v + size / 2);
    let split = |from, to| large.split_around(vec![at(from), at(to)], tile, nodes).length;
    let eighth_um = large.split(vec![at(0), at(1)], tile).length.length_um;
    let close = |found: u64, eighths: u64| found.abs_diff(eighths * eighth_um) <= eighths;
    let through = split(1, 10);
    assert!(close(through.length_um, 9), "{through:?} of {eighth_um}");
    assert!(close(through.padding_um, 6) && close(through.outside_um, 2), "{through:?}");
    let beside = split(3, 7);
    assert_eq!((beside.padding_um, beside.outside_um), (beside.length_um, 0));
    let within = split(0, 2);
    assert_eq!((within.padding_um, within.outside_um), (0, 0));
}

#[test]
fn a_tile_has_only_the_segments_near_it() {
    let large = Large::new();
    let frame = large.levels.frame();
    let root = frame.tile_lattice_bounds(TileId::ROOT);
    // A zigzag from the north-west corner to the south-east one, 32 tiles away, with ten segments a
    // tile.
    let points: Vec<LatticePoint> = (0..=320)
        .map(|k| {
            let along = (root.max.u - root.min.u) / 320 * k;
            LatticePoint::new(root.min.u + along, root.max.v - along + (k % 2) * 1000)
        })
        .collect();
    let split = large.split(points.clone(), root);
    let finest: Vec<_> = split.pieces.iter().filter(|(id, _)| id.z() == 5).collect();
    assert!(finest.len() >= 32);
    for (id, piece) in finest {
        let segments: usize = piece.runs.iter().map(|run| run.segments_um.len()).sum();
        assert!((1..=14).contains(&segments), "tile {id} has {segments} segments");
    }
    // Tiles outside the data have no roads.
    let corner = TileId::new(5, 0, 0).unwrap();
    let split = large.split(points, frame.tile_lattice_bounds(corner));
    let ids: Vec<TileId> = split.pieces.iter().map(|(id, _)| *id).collect();
    assert_eq!(ids, (0..=5).map(|z| corner.ancestor(z)).collect::<Vec<_>>());
    assert!(split.length.outside_um * 33 > split.length.length_um * 31);
    assert!(split.length.outside_um < split.length.length_um);
}

/// A road that goes far away from a tile and comes back has two runs there.
#[test]
fn what_lies_far_away_between_two_visits_is_left_out() {
    let large = Large::new();
    let root = large.levels.frame().tile_lattice_bounds(TileId::ROOT);
    let tile = (root.max.u - root.min.u) / 32;
    let at = |column: i64, row: i64| {
        LatticePoint::new(root.min.u + column * tile / 2, root.max.v - row * tile / 2)
    };
    let line = [at(1, 1), at(9, 1), at(19, 1), at(19, 9), at(9, 9), at(1, 2)];
    let split = large.split(line.to_vec(), root);
    let of_corner =
        split.pieces.iter().find(|(id, _)| *id == TileId::new(5, 0, 0).unwrap()).unwrap();
    let runs: Vec<&[LatticePoint]> = of_corner.1.runs.iter().map(|run| run.line.points()).collect();
    assert_eq!(runs, [&line[..2], &line[4..]]);
    let [first, .., last] = large.lengths().segments_um(&Polyline::new(line.to_vec()).unwrap())[..]
    else {
        panic!("a line of five segments")
    };
    let lengths: Vec<u64> = of_corner.1.runs.iter().map(|run| run.segments_um[0]).collect();
    assert_eq!(lengths, [first, last]);
}
