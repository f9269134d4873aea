//! Neither threads nor memory change the pieces of roads, and nothing is read twice.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, atomic::AtomicU64},
};

use corniche_geom::{Bounds, CoordinateTable, GridFrame, NodeIndex, TileId};
use corniche_roads::{ClassFilter, FrcTable, FunctionalRoadClass};
use corniche_store::{ArtifactKey, MemoryStore, StoreError};
use corniche_testing::{FlatProjection, MemoryScratch, Random, pbf};

use super::*;
use crate::{
    layers::layer_writer::BATCH_OBJECTS,
    roads::{pieces::TilePieces, totals::lengths_of_block},
};

/// Records the reported defects.
#[derive(Default)]
struct Listener(Mutex<Vec<Defect>>);

impl corniche_work::Observer for Listener {}

impl BuildObserver for Listener {
    fn defect(&self, defect: &Defect) {
        self.0.lock().unwrap().push(defect.clone());
    }
}

/// A store that accepts a number of artifacts and no more.
struct FullStore<'a> {
    store: &'a MemoryStore,
    room: AtomicU64,
}

impl Artifacts for FullStore<'_> {
    fn put(&self, key: ArtifactKey, bytes: &[u8]) -> Result<(), StoreError> {
        let has_room = |room: u64| room.checked_sub(1);
        match self.room.fetch_update(Ordering::Relaxed, Ordering::Relaxed, has_room) {
            Ok(_) => self.store.put(key, bytes),
            Err(_) => Err(StoreError::ReadOnly { path: "full".into() }),
        }
    }

    fn get(&self, key: ArtifactKey) -> Result<Option<Vec<u8>>, StoreError> {
        self.store.get(key)
    }

    fn has(&self, key: ArtifactKey) -> bool {
        self.store.has(key)
    }

    fn items(&self, kind: u8) -> Vec<u64> {
        self.store.items(kind)
    }
}

/// Four by four tiles around 0° on a flat map.
struct World {
    settings: RoadSettings,
    levels: Levels,
    table: CoordinateTable,
    projection: FlatProjection,
}

impl World {
    fn new() -> Self {
        let corner = NodeIndex { i: -512, j: 512 };
        let frame = GridFrame::new([0.0; 2], 10.0, corner, 2).unwrap();
        let table = FrcTable::new("t", vec![("primary".into(), 2)], vec!["no".into()], 8).unwrap();
        let filter = ClassFilter::new([None; FunctionalRoadClass::COUNT]).unwrap();
        let settings = RoadSettings { table, filter, simplify_cells: 0.5, spans: false };
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
    ) -> Result<RoadTotals, ExtractError> {
        self.partition_told(osm, store, threads, memory_bytes).1
    }

    /// Partitions, and returns the defects that were reported to the observer.
    fn partition_told(
        &self,
        osm: &Path,
        store: &dyn Artifacts,
        threads: usize,
        memory_bytes: u64,
    ) -> (Vec<Defect>, Result<RoadTotals, ExtractError>) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let frame = *self.levels.frame();
        let input = ExtractInput {
            data: DataTiles::between(
                &frame,
                NodeIndex { i: -512, j: -512 },
                NodeIndex { i: 511, j: 511 },
            ),
            osm: &[osm.to_path_buf()],
            settings: &self.settings,
            layers: &[],
            projection: &self.projection,
            levels: &self.levels,
            lengths: &TrueLengths::new(frame, &self.table, &self.projection),
            node_bounds: frame.tile_lattice_bounds(TileId::ROOT),
            polygon: None,
            clip: None,
            bounds_deg: None,
            outline: None,
            area_deg: Bounds { min_x: -0.05, min_y: -0.05, max_x: 0.05, max_y: 0.05 },
            pool: &pool,
            memory_bytes,
        };
        let listener = Listener::default();
        let totals = partition(&input, store, &MemoryScratch::default(), &listener);
        (listener.0.into_inner().unwrap(), totals)
    }
}

/// Winding roads all over the map, and ways that are not roads.
fn extract(folder: &Path, roads: usize) -> PathBuf {
    extract_with_moats(folder, roads, 1)
}

/// The same extract with `moats` additional ways of an unknown kind.
fn extract_with_moats(folder: &Path, roads: usize, moats: usize) -> PathBuf {
    let mut random = Random::new(5);
    let mut next = || random.share() - 0.5;
    let line = |value, points: usize, next: &mut dyn FnMut() -> f64| {
        let mut at = [0.05 * next(), 0.05 * next()];
        let points_deg = (0..points).map(|_| {
            at = [at[0] + 0.004 * next(), at[1] + 0.004 * next()];
            at
        });
        pbf::WayToWrite { tags: vec![("highway", value)], points_deg: points_deg.collect() }
    };
    let mut lines: Vec<_> = (0..roads).map(|k| line("primary", 2 + k % 9, &mut next)).collect();
    lines.push(line("no", 2, &mut next));
    lines.extend((0..moats).map(|_| line("moat", 2, &mut next)));
    let path = folder.join("roads.osm.pbf");
    fs::write(&path, pbf::extract(&["highway", "primary", "no", "moat"], &lines)).unwrap();
    path
}

fn everything(store: &MemoryStore) -> Vec<(ArtifactKey, Vec<u8>)> {
    let kinds = [
        ArtifactKind::RoadPieces,
        ArtifactKind::RoadLengths,
        ArtifactKind::Defects,
        ArtifactKind::RoadTotals,
    ];
    let keys = kinds
        .into_iter()
        .flat_map(|kind| store.items(kind as u8).into_iter().map(move |item| kind.item(item)));
    keys.map(|key| (key, store.get(key).unwrap().unwrap())).collect()
}

#[test]
fn neither_threads_nor_memory_matter_and_nothing_is_read_twice() {
    let folder = tempfile::tempdir().unwrap();
    let osm = extract(folder.path(), 2 * BATCH_OBJECTS + 5);
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
    let count = BATCH_OBJECTS as u64 + 5;
    let osm = extract(folder.path(), count as usize);
    let (world, store) = (World::new(), MemoryStore::default());
    let totals = world.partition(&osm, &store, 2, 1 << 20).unwrap();
    assert_eq!((totals.roads, totals.classes[2]), (count, (count, totals.length_um)));
    assert_eq!(totals.extract.highways_in, count + 2);
    assert_eq!(totals.extract.unknown_highways, [("moat".to_owned(), 1)]);
    let lengths = lengths_of_block(&store, 0, count).unwrap();
    assert_eq!(lengths.iter().map(|length| length.length_um).sum::<u64>(), totals.length_um);
    assert!(lengths.iter().zip(1..).all(|(length, way_id)| length.way_id == way_id));
    // Every point of every road in the root is in exactly one finest tile.
    let mut points = 0;
    for item in store.items(ArtifactKind::RoadPieces as u8) {
        let bytes = store.get(ArtifactKind::RoadPieces.item(item)).unwrap().unwrap();
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
    assert!(matches!(error, ExtractError::NoRoads { .. }), "{error}");
    assert!(everything(&store).is_empty());
}

/// Compares the defects of a run that reads the extract, a run that need not read it, and a run
/// that resumes a step interrupted anywhere.
#[test]
fn every_run_tells_of_the_same_defects_in_the_same_order() {
    let folder = tempfile::tempdir().unwrap();
    // There are enough unknown ways for three blocks of defects; some of the roads cross
    // themselves.
    let osm = extract_with_moats(folder.path(), 60, 9000);
    let (world, unbroken) = (World::new(), MemoryStore::default());
    let (wanted, totals) = world.partition_told(&osm, &unbroken, 1, 1 << 20);
    let totals = totals.unwrap();
    assert_eq!(totals.defects.values().sum::<u64>(), wanted.len() as u64);
    assert_eq!(totals.defects["unknown highway value"], 9000);
    assert!(totals.defects.len() > 1, "{:?}", totals.defects);
    assert_eq!(unbroken.items(ArtifactKind::Defects as u8), [0, 1, 2]);
    let mut room = 0;
    loop {
        let store = MemoryStore::default();
        let full = FullStore { store: &store, room: room.into() };
        let broken = world.partition_told(&osm, &full, 2, 1 << 20).1;
        assert_eq!(broken.is_err(), room < everything(&unbroken).len() as u64, "{room}");
        let (told, again) = world.partition_told(&osm, &store, 2, 1 << 20);
        assert!(told == wanted, "after {room} artifacts");
        assert_eq!(again.unwrap(), totals);
        assert!(everything(&store) == everything(&unbroken), "after {room} artifacts");
        if broken.is_ok() {
            break;
        }
        room += 1;
    }
    fs::remove_file(&osm).unwrap();
    let (told, again) = world.partition_told(&osm, &unbroken, 1, 0);
    assert!(told == wanted, "nothing is read");
    assert_eq!(again.unwrap(), totals);
}
