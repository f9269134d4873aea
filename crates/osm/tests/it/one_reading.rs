//! All layers are read at once: each is the same as alone, and no blob of a sorted extract is
//! unpacked more often than for roads alone.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{cell::Cell, fs, io::Cursor, path::Path};

use crate::common::{
    CountedBlobs, Gathered, POOL, gather, request, roads::read_roads_from, to_lattice,
};
use corniche_areas::{Area, AreaTable};
use corniche_osm::{
    AreaSummary, ClassedLine, ExtractDefect, ExtractSummary, LayerSink, Layers, LineSummary,
    ReadOsmError, ReadRequest, read_extract, read_extract_from,
};
use corniche_presets::{area_preset, parse_area_table};
use corniche_roads::Road;
use corniche_testing::MemoryScratch;
use corniche_testing::{
    pbf::{BlockBuilder, plain_header, raw},
    real_data, sample,
};
use proptest::prelude::*;

/// All layers of an extract, and the defects of each.
#[derive(Debug, Default, PartialEq)]
struct All {
    areas: (Vec<Area>, Option<AreaSummary>),
    boundaries: (Vec<ClassedLine>, Option<LineSummary>),
    roads: (Vec<Road>, Option<ExtractSummary>),
    defects: Vec<ExtractDefect>,
}

#[derive(Clone, Copy, PartialEq)]
struct Which {
    areas: bool,
    boundaries: bool,
    roads: bool,
}

const ALL: Which = Which { areas: true, boundaries: true, roads: true };
const NONE: Which = Which { areas: false, boundaries: false, roads: false };

fn table() -> AreaTable {
    parse_area_table(area_preset("default").unwrap()).unwrap()
}

fn with_layers(
    which: Which,
    read: impl FnOnce(Layers<'_>, &mut dyn FnMut(ExtractDefect)) -> Result<(), ReadOsmError>,
) -> Result<All, String> {
    let table = table();
    let (mut areas, mut boundaries, mut roads) =
        (Gathered::default(), Gathered::default(), Gathered::default());
    let mut defects = Vec::new();
    let layers = Layers {
        areas: which.areas.then_some((&table, &mut areas as &mut dyn LayerSink<_, _>)),
        boundaries: which.boundaries.then_some(&mut boundaries as &mut dyn LayerSink<_, _>),
        boundary_names: None,
        roads: which.roads.then_some(&mut roads as &mut dyn LayerSink<_, _>),
    };
    read(layers, &mut |defect| defects.push(defect)).map_err(|error| error.to_string())?;
    Ok(All {
        areas: (areas.objects, areas.summary),
        boundaries: (boundaries.objects, boundaries.summary),
        roads: (roads.objects, roads.summary),
        defects,
    })
}

fn read(bytes: &[u8], memory_bytes: u64, which: Which) -> Result<All, String> {
    let scratch = MemoryScratch::default();
    let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
    let request = ReadRequest { memory_bytes, ..request };
    with_layers(which, |layers, on_defect| {
        read_extract_from(Cursor::new(bytes), &request, layers, on_defect, &|| false)
    })
}

/// Reads each layer alone: together they must equal all layers read at once, with defects in the
/// order of the layers.
fn each_alone(read: impl Fn(Which) -> Result<All, String>) -> Result<All, String> {
    let areas = read(Which { areas: true, ..NONE })?;
    let boundaries = read(Which { boundaries: true, ..NONE })?;
    let roads = read(Which { roads: true, ..NONE })?;
    let defects = [areas.defects, boundaries.defects, roads.defects].concat();
    Ok(All { areas: areas.areas, boundaries: boundaries.boundaries, roads: roads.roads, defects })
}

#[test]
fn layers_of_real_extracts_are_together_what_each_is_alone() {
    let sample = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let others = [
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
        "nasty/osm/loc_on_ways.osm.pbf",
        "nasty/osm/r5-missing-nodes.osm.pbf",
    ];
    for path in others.into_iter().filter_map(real_data).chain([sample]) {
        let bytes = fs::read(&path).unwrap();
        let expected = each_alone(|which| read(&bytes, 1 << 30, which)).unwrap();
        for memory_bytes in [1 << 30, 1 << 20, 100_000] {
            let found = read(&bytes, memory_bytes, ALL).unwrap();
            assert!(found == expected, "{} in {memory_bytes} bytes", path.display());
        }
    }
}

/// Returns how often blobs of an extract are read for these layers.
fn blobs_read(bytes: &[u8], which: Which) -> u64 {
    let (blobs, scratch) = (Cell::new(0), MemoryScratch::default());
    let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
    let source = CountedBlobs::new(bytes, &blobs);
    with_layers(which, |layers, on_defect| {
        read_extract_from(source, &request, layers, on_defect, &|| false)
    })
    .unwrap();
    blobs.get()
}

/// The blobs among which the first relation is searched are an exception, as for the first way.
#[test]
fn no_blob_of_a_sorted_extract_is_unpacked_oftener_for_more_layers() {
    let real = [
        "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
        "portland/portland-central-filtered.osm.pbf",
    ];
    let real = real
        .into_iter()
        .filter_map(real_data)
        .chain([sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf")]);
    let mut extracts: Vec<Vec<u8>> = real.map(|path| fs::read(path).unwrap()).collect();
    extracts.push(made(&[Kind::Nodes, Kind::Ways, Kind::Relations], 30));
    for bytes in extracts {
        let (blobs, scratch) = (Cell::new(0), MemoryScratch::default());
        let request = request(Path::new("made.osm.pbf"), &POOL, &to_lattice, &scratch);
        let source = CountedBlobs::new(&bytes, &blobs);
        gather(|sink, on_defect| read_roads_from(source, &request, sink, on_defect, &|| false))
            .unwrap();
        let once = blobs.get();
        let sought = u64::from(once.ilog2()) + 1;
        for which in [ALL, Which { areas: true, ..NONE }, Which { boundaries: true, ..NONE }] {
            let found = blobs_read(&bytes, which);
            assert!(found <= once + sought, "{found} blobs for all layers, {once} for roads");
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Nodes,
    Ways,
    Relations,
}

/// Returns an extract of blobs of these kinds, one after the other, `blobs` of each: adjacent
/// squares, some of which consist of two ways in a relation, and some of which are roads.
fn made(kinds: &[Kind], blobs: i64) -> Vec<u8> {
    let mut bytes = plain_header();
    for &kind in kinds {
        for blob in 0..blobs {
            bytes.extend(raw(b"OSMData", &made_block(kind, blob).bytes()));
        }
    }
    bytes
}

const SQUARES: i64 = 8;

fn made_block(kind: Kind, blob: i64) -> BlockBuilder {
    let mut block = BlockBuilder::new();
    for square in blob * SQUARES..(blob + 1) * SQUARES {
        let node = 1 + 4 * square;
        let [east, north] =
            [95_000_000 + 10_000 * (square % 50), 470_000_000 + 10_000 * (square / 50)];
        match kind {
            Kind::Nodes => block.dense(&[
                (node, north, east),
                (node + 1, north, east + 5000),
                (node + 2, north + 5000, east + 5000),
                (node + 3, north + 5000, east),
            ]),
            Kind::Ways => {
                let way = 1 + 3 * square;
                block.way(way, &[("highway", "track")], &[node, node + 1, node + 2]);
                block.way(
                    way + 1,
                    &[("boundary", "administrative"), ("admin_level", "6")],
                    &[node + 2, node + 3, node],
                );
                let lake: &[(&str, &str)] = &[("natural", "water"), ("name", "See")];
                let tags = if square % 3 == 0 { lake } else { &[] };
                block.way(way + 2, tags, &[node, node + 1, node + 2, node + 3, node]);
            }
            Kind::Relations => {
                let way = 1 + 3 * square;
                let forest: &[(&str, &str)] = &[("type", "multipolygon"), ("landuse", "forest")];
                let country: &[(&str, &str)] =
                    &[("type", "boundary"), ("boundary", "administrative"), ("admin_level", "2")];
                let tags = if square % 2 == 0 { forest } else { country };
                block.relation(1 + square, tags, &[(way, "outer"), (way + 1, "outer")]);
            }
        }
    }
    block
}

#[test]
fn an_extract_in_any_order_gives_the_same() {
    use Kind::{Nodes, Relations, Ways};
    let sorted = made(&[Nodes, Ways, Relations], 12);
    let expected = each_alone(|which| read(&sorted, 1 << 30, which)).unwrap();
    assert_eq!(expected.roads.0.len(), 96);
    assert_eq!(expected.areas.0.len(), 96 / 2 + 96 / 3);
    assert_eq!(expected.boundaries.0.len(), 96 + 48);
    for order in [
        [Nodes, Ways, Relations],
        [Nodes, Relations, Ways],
        [Ways, Nodes, Relations],
        [Ways, Relations, Nodes],
        [Relations, Nodes, Ways],
        [Relations, Ways, Nodes],
    ] {
        let bytes = made(&order, 12);
        for memory_bytes in [1 << 30, 20_000, 3000, 100] {
            let found = read(&bytes, memory_bytes, ALL);
            assert!(
                found.as_ref() == Ok(&expected),
                "{order:?} in {memory_bytes} bytes: {found:?}"
            );
        }
    }
}

/// The generated extract is in two files: objects in both count once.
#[test]
fn several_extracts_give_the_same() {
    let (folder, kinds) =
        (tempfile::tempdir().unwrap(), [Kind::Nodes, Kind::Ways, Kind::Relations]);
    let paths = [0..8, 4..12].map(|range: std::ops::Range<i64>| {
        let path = folder.path().join(format!("{}.osm.pbf", range.start));
        let mut bytes = plain_header();
        for kind in kinds {
            for blob in range.clone() {
                bytes.extend(raw(b"OSMData", &made_block(kind, blob).bytes()));
            }
        }
        fs::write(&path, bytes).unwrap();
        path
    });
    let whole = read(&made(&kinds, 12), 1 << 30, ALL).unwrap();
    let [path, others @ ..] = &paths;
    for memory_bytes in [1 << 30, 3000] {
        let scratch = MemoryScratch::default();
        let request = request(path, &POOL, &to_lattice, &scratch);
        let request = ReadRequest { others, memory_bytes, ..request };
        let found = with_layers(ALL, |layers, on_defect| {
            read_extract(&request, layers, on_defect, &|| false)
        })
        .unwrap();
        assert!(found.roads.0 == whole.roads.0 && found.areas == whole.areas);
        assert_eq!(found.boundaries, whole.boundaries);
        assert_eq!(found.defects, whole.defects);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Blobs of all kinds may come in any order, and a blob may contain two kinds.
    #[test]
    fn blobs_in_any_order_give_what_each_layer_is_alone(
        blobs in Just((0..4_i64).flat_map(|blob| [Kind::Nodes, Kind::Ways, Kind::Relations].map(|kind| (kind, blob))).collect::<Vec<_>>()).prop_shuffle(),
        memory_bytes in prop::sample::select(vec![1_u64 << 30, 3000]),
    ) {
        let mut bytes = plain_header();
        for (kind, blob) in blobs {
            bytes.extend(raw(b"OSMData", &made_block(kind, blob).bytes()));
        }
        let expected = each_alone(|which| read(&bytes, 1 << 30, which));
        prop_assert_eq!(read(&bytes, memory_bytes, ALL), expected);
    }
}
