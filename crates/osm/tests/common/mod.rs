//! What the tests of this crate share: the default table, a plain projection, a reader that gathers everything.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap and says what it skips"
)]

pub(crate) mod writer;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    io::Cursor,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use corniche_geom::LatticePoint;
use corniche_osm::{
    Defect, ExtractSummary, Place, ReadOsmError, ReadRequest, read_roads, read_roads_from,
};
use corniche_roads::{FrcTable, Road};
use rayon::ThreadPool;
use serde::Deserialize;

#[derive(Deserialize)]
struct Preset {
    name: String,
    least_class: u8,
    not_roads: Vec<String>,
    classes: BTreeMap<String, u8>,
}

/// The preset `config/frc/default.toml`.
pub(crate) fn default_table() -> FrcTable {
    let text =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/frc/default.toml"));
    let preset: Preset = toml::from_str(&text.unwrap()).unwrap();
    let classes = preset.classes.into_iter().collect();
    FrcTable::new(preset.name, classes, preset.not_roads, preset.least_class).unwrap()
}

/// A lattice of 1e-7 degrees, so that every coordinate of the data can be told from its point.
pub(crate) fn to_lattice(positions_deg: &[[f64; 2]]) -> Vec<Option<LatticePoint>> {
    let round = |deg: f64| (deg * 1e7).round() as i64;
    positions_deg
        .iter()
        .map(|&[lon, lat]| Some(LatticePoint::new(round(lon), round(lat))))
        .collect()
}

/// All that came out of an extract.
#[derive(Debug, PartialEq)]
pub(crate) struct Extract {
    pub(crate) roads: Vec<Road>,
    pub(crate) defects: Vec<Defect>,
    pub(crate) summary: ExtractSummary,
}

impl Extract {
    /// How often each reason occurs.
    pub(crate) fn reasons(&self) -> BTreeMap<&'static str, usize> {
        let mut reasons = BTreeMap::new();
        for defect in &self.defects {
            *reasons.entry(defect.reason()).or_default() += 1;
        }
        reasons
    }

    pub(crate) fn check_invariants(&self) {
        self.summary.check_invariants();
        assert_eq!(self.summary.roads, self.roads.len() as u64);
        assert!(self.roads.is_sorted_by_key(|road| road.way_id));
        for road in &self.roads {
            let last = road.line.points().len() as u32 - 1;
            assert!(road.fixed.is_sorted_by(|a, b| a < b), "way {}", road.way_id);
            assert_eq!((road.fixed.first(), road.fixed.last()), (Some(&0), Some(&last)));
        }
        // Every way that was lost stands in exactly one defect that says so, and no way is both lost and a road, unless its
        // id is used twice.
        let lost = |defect: &&Defect| defect.is_loss_of_way();
        let left_out = self.summary.left_out;
        let expected =
            left_out.unknown + left_out.area + left_out.duplicate + left_out.without_line;
        assert_eq!(self.defects.iter().filter(lost).count() as u64, expected);
        let ids: BTreeSet<i64> = self.roads.iter().map(|road| road.way_id).collect();
        assert_eq!(self.summary.road_ways, ids.len() as u64);
        for defect in self.defects.iter().filter(lost) {
            if matches!(defect, Defect::TooFewNodes { .. } | Defect::NoLine { .. }) {
                assert!(!ids.contains(&defect.object().1), "{defect:?}");
            }
        }
    }
}

pub(crate) fn read_with(
    path: &Path,
    threads: usize,
    place: &Place<'_>,
) -> Result<Extract, ReadOsmError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    read_in(path, &pool, place)
}

fn read_in(path: &Path, pool: &ThreadPool, place: &Place<'_>) -> Result<Extract, ReadOsmError> {
    let request = ReadRequest { path, table: &TABLE, place, pool };
    gather(|sink, on_defect| read_roads(&request, sink, on_defect, &|| false))
}

static POOL: LazyLock<ThreadPool> =
    LazyLock::new(|| rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap());
static TABLE: LazyLock<FrcTable> = LazyLock::new(default_table);

/// Reads with two threads, always the same.
pub(crate) fn read(path: &Path) -> Result<Extract, ReadOsmError> {
    read_in(path, &POOL, &to_lattice)
}

/// Reads from memory; `made.osm.pbf` is the name in messages.
pub(crate) fn read_bytes(bytes: &[u8]) -> Result<Extract, ReadOsmError> {
    read_bytes_in(&POOL, bytes)
}

/// The same with other threads.
pub(crate) fn read_bytes_in(pool: &ThreadPool, bytes: &[u8]) -> Result<Extract, ReadOsmError> {
    let path = Path::new("made.osm.pbf");
    let request = ReadRequest { path, table: &TABLE, place: &to_lattice, pool };
    gather(|sink, on_defect| {
        read_roads_from(Cursor::new(bytes), &request, sink, on_defect, &|| false)
    })
}

fn gather(
    read: impl FnOnce(
        &mut dyn FnMut(Road),
        &mut dyn FnMut(Defect),
    ) -> Result<ExtractSummary, ReadOsmError>,
) -> Result<Extract, ReadOsmError> {
    let (mut roads, mut defects) = (Vec::new(), Vec::new());
    let summary = read(&mut |road| roads.push(road), &mut |defect| defects.push(defect))?;
    let extract = Extract { roads, defects, summary };
    extract.check_invariants();
    Ok(extract)
}

pub(crate) fn fixture(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures")).join(name)
}

/// A file of the developers' data set; `None`, with a line that says so, where it is not at hand.
pub(crate) fn shared_data(name: &str) -> Option<PathBuf> {
    let default = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let path = std::env::var_os("CORNICHE_DATA").map_or_else(default, PathBuf::from).join(name);
    if path.exists() {
        Some(path)
    } else {
        println!("skipped: {name} is not there; set CORNICHE_DATA to the data set");
        None
    }
}
