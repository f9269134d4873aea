use std::fs;

use corniche_geom::{Bounds, CoordinateTable, NodeIndex, TileId};
use corniche_roads::{ClassFilter, FrcTable};
use corniche_store::{Key, MemoryScratch, MemoryStore};
use corniche_testing::{FlatProjection, Random, pbf};

use super::*;
use crate::{
    Silent,
    roads::{pieces::TilePieces, totals::lengths_of_block},
};

/// Four by four tiles around 0° of a flat world.
struct World {
    settings: RoadSettings,
    levels: Levels,
    table: CoordinateTable,
    projection: FlatProjection,
}

impl World {
    fn new() -> Self {
        let corner = NodeIndex { i: -512, j: 512 };
        let frame = Frame::new([0.0; 2], 10.0, corner, 2).unwrap();
        let table = FrcTable::new("t", vec![("primary".into(), 2)], vec!["no".into()], 8).unwrap();
        let filter = ClassFilter::new([None; FunctionalRoadClass::COUNT]).unwrap();
        let settings = RoadSettings { table, filter, simplify_cells: 0.5 };
        let levels = Levels::new(frame, 2.5, &settings, 1.0);
        let projection = FlatProjection::new([111_320.0; 2]);
        let bounds = Bounds { ..frame.tile_bounds(TileId::ROOT) };
        let table = CoordinateTable::sample(&projection, bounds, 0.01).unwrap();
        Self { settings, levels, table, projection }
    }

    fn partition(
        &self,
        osm: &Path,
        store: &MemoryStore,
        threads: usize,
        memory_bytes: u64,
    ) -> Result<RoadTotals, BuildError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let frame = *self.levels.frame();
        let input = RoadInput {
            osm,
            settings: &self.settings,
            projection: &self.projection,
            levels: &self.levels,
            lengths: &TrueLengths::new(frame, &self.table, &self.projection),
            data_bounds: frame.tile_lattice_bounds(TileId::ROOT),
            pool: &pool,
            memory_bytes,
        };
        partition(&input, store, &MemoryScratch::default(), &Silent)
    }
}

/// Winding roads over the world, and ways that are no roads.
fn extract(folder: &Path, roads: usize) -> std::path::PathBuf {
    let mut random = Random::new(5);
    let mut next = || random.share() - 0.5;
    let line = |value, points: usize, next: &mut dyn FnMut() -> f64| {
        let mut at = [0.05 * next(), 0.05 * next()];
        let points_deg = (0..points).map(|_| {
            at = [at[0] + 0.004 * next(), at[1] + 0.004 * next()];
            at
        });
        pbf::Line { tags: vec![("highway", value)], points_deg: points_deg.collect() }
    };
    let mut lines: Vec<_> = (0..roads).map(|k| line("primary", 2 + k % 9, &mut next)).collect();
    lines.push(line("no", 2, &mut next));
    lines.push(line("moat", 2, &mut next));
    let path = folder.join("roads.osm.pbf");
    fs::write(&path, pbf::extract(&["highway", "primary", "no", "moat"], &lines)).unwrap();
    path
}

fn everything(store: &MemoryStore) -> Vec<(Key, Vec<u8>)> {
    let kinds = [Kind::RoadPieces, Kind::RoadLengths, Kind::RoadTotals];
    let keys = kinds
        .into_iter()
        .flat_map(|kind| store.items(kind as u8).into_iter().map(move |item| kind.item(item)));
    keys.map(|key| (key, store.get(key).unwrap().unwrap())).collect()
}

#[test]
fn neither_threads_nor_memory_matter_and_nothing_is_read_twice() {
    let folder = tempfile::tempdir().unwrap();
    let osm = extract(folder.path(), 2 * BATCH_ROADS + 5);
    let world = World::new();
    let store = MemoryStore::default();
    let totals = world.partition(&osm, &store, 1, 1 << 30).unwrap();
    for (threads, memory_bytes) in [(4, 1 << 30), (2, 1 << 16), (1, 3000)] {
        let other = MemoryStore::default();
        assert_eq!(world.partition(&osm, &other, threads, memory_bytes).unwrap(), totals);
        assert!(everything(&other) == everything(&store), "{threads} threads");
    }
    fs::remove_file(&osm).unwrap();
    assert_eq!(world.partition(&osm, &store, 1, 0).unwrap(), totals);
}

#[test]
fn pieces_lengths_and_totals_are_those_of_the_roads() {
    let folder = tempfile::tempdir().unwrap();
    let count = BATCH_ROADS as u64 + 5;
    let osm = extract(folder.path(), count as usize);
    let (world, store) = (World::new(), MemoryStore::default());
    let totals = world.partition(&osm, &store, 2, 1 << 20).unwrap();
    assert_eq!((totals.roads, totals.classes[2]), (count, (count, totals.length_um)));
    assert_eq!(totals.extract.highways_in, count + 2);
    assert_eq!(totals.extract.unknown_highways, [("moat".to_owned(), 1)]);
    let lengths = lengths_of_block(&store, 0, count).unwrap();
    assert_eq!(lengths.iter().map(|length| length.length_um).sum::<u64>(), totals.length_um);
    assert!(lengths.iter().zip(1..).all(|(length, way_id)| length.way_id == way_id));
    // Every point of every road that lies in the root is in one finest tile.
    let mut points = 0;
    for item in store.items(Kind::RoadPieces as u8) {
        let bytes = store.get(Kind::RoadPieces.item(item)).unwrap().unwrap();
        let pieces = TilePieces::from_bytes(&bytes).unwrap();
        assert!(pieces.roads.is_sorted_by(|(one, _), (other, _)| one < other));
        for (ordinal, piece) in &pieces.roads {
            assert_eq!(piece.way_id, lengths[*ordinal as usize].way_id);
            if piece.runs.iter().any(|run| !run.segments_um.is_empty()) {
                points += piece.source_points;
            }
        }
    }
    let expected: u64 = (0..count).map(|k| 2 + k % 9).sum();
    assert_eq!(points, expected);
}

#[test]
fn an_extract_without_roads_is_an_error_and_leaves_no_totals() {
    let folder = tempfile::tempdir().unwrap();
    let osm = extract(folder.path(), 0);
    let store = MemoryStore::default();
    let error = World::new().partition(&osm, &store, 1, 0).unwrap_err();
    assert!(matches!(error, BuildError::NoRoads { .. }), "{error}");
    assert!(everything(&store).is_empty());
}
