//! Helpers of this crate's tests: the default table, a plain projection, a reader that gathers
//! everything.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

pub(crate) mod made;
pub(crate) mod outlined;
pub(crate) mod roads;

use std::{
    cell::Cell,
    collections::{BTreeMap, BTreeSet},
    fs,
    io::{self, Cursor, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
    sync::LazyLock,
};

use corniche_geom::LatticePoint;
use corniche_osm::{
    ExtractDefect, ExtractSummary, KeptKinds, LayerSink, ReadOsmError, ReadRequest, ShareStore,
    ToLattice, read_kept_roads,
};
use corniche_presets::parse_frc_table;
use corniche_roads::{FrcTable, Road};
use corniche_store::{MemoryStore, ScratchSpace};
use corniche_testing::MemoryScratch;
use rayon::ThreadPool;
use roads::{check_summary, is_loss_of_way, read_roads, read_roads_from};

/// Returns the preset `config/frc/default.toml`.
pub(crate) fn default_table() -> FrcTable {
    parse_frc_table(corniche_presets::frc_preset("default").unwrap()).unwrap()
}

/// Returns a store for the results of shares.
pub(crate) fn kept(store: &MemoryStore) -> ShareStore<'_> {
    let kinds = KeptKinds {
        ways: 10,
        located: 11,
        defects: 12,
        ways_records: 13,
        places: 14,
        nodes_records: 15,
    };
    ShareStore { store, kinds }
}

/// Converts positions to a lattice of 1e-7 degrees, so that every point shows the coordinates of
/// its node.
pub(crate) fn to_lattice(positions_deg: &[[f64; 2]]) -> Vec<Option<LatticePoint>> {
    let round = |deg: f64| (deg * 1e7).round() as i64;
    positions_deg
        .iter()
        .map(|&[lon, lat]| Some(LatticePoint::new(round(lon), round(lat))))
        .collect()
}

/// The whole result of reading an extract.
#[derive(Debug, PartialEq)]
pub(crate) struct Extract {
    pub(crate) roads: Vec<Road>,
    pub(crate) defects: Vec<ExtractDefect>,
    pub(crate) summary: ExtractSummary,
}

impl Extract {
    /// Returns how often each reason occurs.
    pub(crate) fn reasons(&self) -> BTreeMap<&'static str, usize> {
        let mut reasons = BTreeMap::new();
        for defect in &self.defects {
            *reasons.entry(defect.reason()).or_default() += 1;
        }
        reasons
    }

    pub(crate) fn check_invariants(&self) {
        check_summary(&self.summary);
        assert_eq!(self.summary.roads, self.roads.len() as u64);
        assert!(self.roads.is_sorted_by_key(|road| road.way_id));
        for road in &self.roads {
            let last = road.line.points().len() as u32 - 1;
            assert!(road.fixed.is_sorted_by(|a, b| a < b), "way {}", road.way_id);
            assert_eq!((road.fixed.first(), road.fixed.last()), (Some(&0), Some(&last)));
        }
        // Every lost way has exactly one defect that says so, and no way is both lost and a road,
        // unless its id is used twice.
        let lost = |defect: &&ExtractDefect| is_loss_of_way(defect);
        let left_out = self.summary.left_out;
        let expected =
            left_out.unknown + left_out.area + left_out.duplicate + left_out.without_line;
        assert_eq!(self.defects.iter().filter(lost).count() as u64, expected);
        let ids: BTreeSet<i64> = self.roads.iter().map(|road| road.way_id).collect();
        assert_eq!(self.summary.road_ways, ids.len() as u64);
        for defect in self.defects.iter().filter(lost) {
            if matches!(
                defect,
                ExtractDefect::TooFewNodes { .. }
                    | ExtractDefect::NoLine { .. }
                    | ExtractDefect::ToAndFro { .. }
            ) {
                assert!(!ids.contains(&defect.object().1), "{defect:?}");
            }
        }
    }
}

pub(crate) fn read_with(
    path: &Path,
    threads: usize,
    place: &ToLattice<'_>,
) -> Result<Extract, ReadOsmError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    read_in(path, &pool, place)
}

fn read_in(path: &Path, pool: &ThreadPool, place: &ToLattice<'_>) -> Result<Extract, ReadOsmError> {
    let scratch = MemoryScratch::default();
    let request = request(path, pool, place, &scratch);
    gather(|sink, on_defect| read_roads(&request, sink, on_defect, &|| false))
}

/// Returns a request with memory for everything.
pub(crate) fn request<'a>(
    path: &'a Path,
    pool: &'a ThreadPool,
    place: &'a ToLattice<'a>,
    scratch: &'a dyn ScratchSpace,
) -> ReadRequest<'a> {
    let (table, memory_bytes) = (&*TABLE, 1 << 30);
    ReadRequest {
        path,
        others: &[],
        table,
        place,
        ring_area_m2: &corniche_geom::wgs84::area_m2,
        seam: None,
        square_steps: i64::MAX,
        node_ids: false,
        pool,
        memory_bytes,
        scratch,
        on_progress: None,
    }
}

pub(crate) static POOL: LazyLock<ThreadPool> =
    LazyLock::new(|| rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap());
static TABLE: LazyLock<FrcTable> = LazyLock::new(default_table);

/// Reads with two threads, which all tests share.
pub(crate) fn read(path: &Path) -> Result<Extract, ReadOsmError> {
    read_in(path, &POOL, &to_lattice)
}

/// Reads from memory; `made.osm.pbf` is the name in messages.
pub(crate) fn read_bytes(bytes: &[u8]) -> Result<Extract, ReadOsmError> {
    read_bytes_in(&POOL, bytes)
}

/// Reads from memory with other threads.
pub(crate) fn read_bytes_in(pool: &ThreadPool, bytes: &[u8]) -> Result<Extract, ReadOsmError> {
    let scratch = MemoryScratch::default();
    let request = request(Path::new("made.osm.pbf"), pool, &to_lattice, &scratch);
    gather(|sink, on_defect| {
        read_roads_from(Cursor::new(bytes), &request, sink, on_defect, &|| false)
    })
}

/// Reads from memory with a memory limit for ways and nodes.
pub(crate) fn read_bytes_within(
    memory_bytes: u64,
    scratch: &dyn ScratchSpace,
    bytes: &[u8],
) -> Result<Extract, ReadOsmError> {
    let path = Path::new("made.osm.pbf");
    let request = ReadRequest { memory_bytes, ..request(path, &POOL, &to_lattice, scratch) };
    gather(|sink, on_defect| {
        read_roads_from(Cursor::new(bytes), &request, sink, on_defect, &|| false)
    })
}

pub(crate) fn gather(
    read: impl FnOnce(
        &mut dyn FnMut(Road),
        &mut dyn FnMut(ExtractDefect),
    ) -> Result<ExtractSummary, ReadOsmError>,
) -> Result<Extract, ReadOsmError> {
    let (mut roads, mut defects) = (Vec::new(), Vec::new());
    let summary = read(&mut |road| roads.push(road), &mut |defect| defects.push(defect))?;
    let extract = Extract { roads, defects, summary };
    extract.check_invariants();
    Ok(extract)
}

/// A layer's objects and their counts, as they are delivered.
pub(crate) struct Gathered<T, S> {
    pub(crate) objects: Vec<T>,
    pub(crate) summary: Option<S>,
}

impl<T, S> Default for Gathered<T, S> {
    fn default() -> Self {
        Self { objects: Vec::new(), summary: None }
    }
}

impl<T, S> LayerSink<T, S> for Gathered<T, S> {
    fn take(&mut self, object: T) {
        self.objects.push(object);
    }

    fn end(&mut self, summary: S) {
        assert!(self.summary.replace(summary).is_none(), "a layer ends once");
    }
}

/// Gathers roads from the stored results of shares.
pub(crate) fn gather_kept(
    request: &ReadRequest<'_>,
    of: u16,
    store: &MemoryStore,
) -> Result<Extract, ReadOsmError> {
    let mut roads = Gathered::default();
    let mut defects = Vec::new();
    let on_defect = &mut |defect| defects.push(defect);
    read_kept_roads(request, of, kept(store), &mut roads, on_defect, &|| false)?;
    let Gathered { objects: roads, summary } = roads;
    let extract = Extract { roads, defects, summary: summary.unwrap() };
    extract.check_invariants();
    Ok(extract)
}

/// A file that counts how often its blobs are read.
pub(crate) struct CountedBlobs<'a> {
    source: Cursor<&'a [u8]>,
    blobs: &'a Cell<u64>,
}

impl<'a> CountedBlobs<'a> {
    pub(crate) fn new(bytes: &'a [u8], blobs: &'a Cell<u64>) -> Self {
        Self { source: Cursor::new(bytes), blobs }
    }
}

impl Read for CountedBlobs<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.source.read(buffer)
    }
}

impl Seek for CountedBlobs<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        // To read a blob, the reader seeks to it from the start; the listing of blobs only
        // continues from the current position.
        if matches!(to, SeekFrom::Start(offset) if offset > 0) {
            self.blobs.set(self.blobs.get() + 1);
        }
        self.source.seek(to)
    }
}

pub(crate) fn fixture(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures")).join(name)
}

/// Writes the bytes to a file, which is deleted together with the folder.
pub(crate) fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}
