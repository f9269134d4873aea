//! Extracts of any bytes are read or rejected, and every way is accounted for.

use std::{cell::LazyCell, collections::BTreeSet, io::Cursor, path::Path};

use corniche_geom::LatticePoint;
use corniche_osm::{ExtractDefect, ReadOsmError, ReadRequest};
use corniche_presets::parse_frc_table;
use corniche_roads::FrcTable;
use corniche_testing::MemoryScratch;
use corniche_testing::pbf::{header, raw};

use roads::{check_summary, is_loss_of_way, read_roads_from};

#[path = "../../crates/osm/tests/it/common/roads.rs"]
mod roads;

/// Reads or rejects these bytes as an extract; every way with a `highway` tag is a road or counted
/// under one reason.
///
/// Bytes that start with two zeros, as every extract does, are a file. Other bytes are one
/// uncompressed block, so that a change in them is not rejected because of a size or a checksum
/// that no longer matches.
///
/// # Panics
/// When the reader breaks a promise.
pub fn osm(data: &[u8]) {
    match data {
        [0, 0, ..] => check(data),
        block => check(&file_of(block)),
    }
}

/// A file of a header and one uncompressed block.
fn file_of(block: &[u8]) -> Vec<u8> {
    [header(&["OsmSchema-V0.6"]), raw(b"OSMData", block)].concat()
}

thread_local! {
    /// A pool that uses this thread alone, so that no thread waits for another.
    static POOL: LazyCell<rayon::ThreadPool> = const {
        LazyCell::new(|| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
            pool.expect("a thread is in one pool at most")
        })
    };
    static TABLE: LazyCell<FrcTable> = const {
        LazyCell::new(|| {
            parse_frc_table(corniche_presets::frc_preset("default").expect("the preset exists")).expect("a preset is valid")
        })
    };
}

fn check(file: &[u8]) {
    // Once with unlimited memory, once with very little: the same roads, defects and errors.
    let [large, small] = [u64::MAX, 2048].map(|memory_bytes| read(file, memory_bytes));
    assert_eq!(large, small);
}

/// The roads' ids and numbers of points, the defects, and the error or the summary in words.
type Found = (Vec<(i64, usize)>, Vec<ExtractDefect>, String);

fn read(file: &[u8], memory_bytes: u64) -> Found {
    // East of 170 degrees this projection is undefined.
    let place = |positions_deg: &[[f64; 2]]| {
        let round = |deg: f64| (deg * 1e7).round() as i64;
        let place = |&[lon, lat]: &[f64; 2]| {
            (lon < 170.0).then(|| LatticePoint::new(round(lon), round(lat)))
        };
        positions_deg.iter().map(place).collect()
    };
    let (mut roads, mut defects, mut lost, mut is_shorter) = (Vec::new(), Vec::new(), 0, false);
    let scratch = MemoryScratch::default();
    let read = POOL.with(|pool| {
        TABLE.with(|table| {
            let path = Path::new("made.osm.pbf");
            let request = ReadRequest {
                path,
                others: &[],
                table,
                place: &place,
                ring_area_m2: &|_| 0.0,
                seam: None,
                square_steps: 256_000,
                node_ids: false,
                pool,
                memory_bytes,
                scratch: &scratch,
                on_progress: None,
            };
            read_roads_from(
                Cursor::new(file),
                &request,
                &mut |road| {
                    let points = road.line.points().len();
                    is_shorter |= points < 2;
                    roads.push((road.way_id, points));
                },
                &mut |defect: ExtractDefect| {
                    lost += u64::from(is_loss_of_way(&defect));
                    assert!(!defect.reason().is_empty());
                    defects.push(defect);
                },
                &|| false,
            )
        })
    });
    let words = match read {
        Ok(summary) => {
            check_summary(&summary);
            let left_out = summary.left_out;
            assert_eq!(left_out.total() - left_out.listed - left_out.class_off, lost);
            let way_ids = || roads.iter().map(|&(way_id, _)| way_id);
            assert!(way_ids().is_sorted() && !is_shorter);
            assert_eq!(summary.roads, roads.len() as u64);
            assert_eq!(summary.road_ways, way_ids().collect::<BTreeSet<_>>().len() as u64);
            format!("{summary:?}")
        }
        Err(ReadOsmError::Place { .. } | ReadOsmError::Stopped { .. }) => {
            panic!("the run was not stopped, and every position was projected")
        }
        Err(ReadOsmError::Scratch { source, .. }) => panic!("memory does not fail: {source}"),
        Err(error) => {
            assert!(error.to_string().contains("made.osm.pbf"), "{error}");
            error.to_string()
        }
    };
    (roads, defects, words)
}
