//! All layers are read at once: each is the same as alone, and no blob of a sorted extract is
//! unpacked more often than for roads alone.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{cell::Cell, fs, io::Cursor, path::Path};

use crate::common::{
    CountedBlobs, Gathered, POOL, gather, outlined::built_in, request, roads::read_roads_from,
    to_lattice,
};
use corniche_osm::{
    AreaSummary, ExtractDefect, ExtractSummary, LayerArea, LayerLine, LayerPoint, LayerReceiver,
    LayerSink, Layers, LineSummary, PointSummary, ReadOsmError, ReadRequest, read_extract,
    read_extract_from,
};
use corniche_presets::parse_layer_table;
use corniche_roads::Road;
use corniche_testing::MemoryScratch;
use corniche_testing::{
    pbf::{BlockBuilder, TaggedNode, plain_header, raw},
    real_data, sample,
};
use proptest::prelude::*;

/// All layers of an extract, and the defects of each.
#[derive(Debug, Default, PartialEq)]
struct All {
    areas: (Vec<LayerArea>, Option<AreaSummary>),
    boundaries: (Vec<LayerLine>, Option<LineSummary>),
    points: (Vec<LayerPoint>, Option<PointSummary>),
    roads: (Vec<Road>, Option<ExtractSummary>),
    defects: Vec<ExtractDefect>,
}

#[derive(Clone, Copy, PartialEq)]
struct Which {
    /// Areas, boundaries, points.
    layers: [bool; 3],
    roads: bool,
}

const ALL: Which = Which { layers: [true; 3], roads: true };
const NONE: Which = Which { layers: [false; 3], roads: false };

/// Trees and shops of real extracts; springs and lakes of generated ones.
const POINTS: &str = r#"
id = "places"
geometry = "point"
attributes = { name = "text" }
[[class]]
id = "water"
tags = { natural = ["spring", "water"] }
[[class]]
id = "place"
tags = [{ natural = "tree" }, { shop = true }, { place = true }]
"#;

fn with_layers(
    which: Which,
    read: impl FnOnce(Layers<'_>, &mut dyn FnMut(ExtractDefect)) -> Result<(), ReadOsmError>,
) -> Result<All, String> {
    let tables = ["areas", "boundaries"].map(built_in);
    let places = parse_layer_table(POINTS).unwrap();
    let (mut areas, mut boundaries) = (Gathered::default(), Gathered::default());
    let (mut points, mut roads) = (Gathered::default(), Gathered::default());
    let mut defects = Vec::new();
    let all = [
        (&tables[0], LayerReceiver::Areas(&mut areas)),
        (&tables[1], LayerReceiver::Lines(&mut boundaries)),
        (&places, LayerReceiver::Points(&mut points)),
    ];
    let wanted = all.into_iter().zip(which.layers).filter(|(_, is_wanted)| *is_wanted);
    let layers = Layers {
        layers: wanted.map(|(layer, _)| layer).collect(),
        roads: which.roads.then_some(&mut roads as &mut dyn LayerSink<_, _>),
    };
    read(layers, &mut |defect| defects.push(defect)).map_err(|error| error.to_string())?;
    Ok(All {
        areas: (areas.objects, areas.summary),
        boundaries: (boundaries.objects, boundaries.summary),
        points: (points.objects, points.summary),
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
    let areas = read(Which { layers: [true, false, false], ..NONE })?;
    let boundaries = read(Which { layers: [false, true, false], ..NONE })?;
    let points = read(Which { layers: [false, false, true], ..NONE })?;
    let roads = read(Which { roads: true, ..NONE })?;
    let defects = [areas.defects, boundaries.defects, points.defects, roads.defects].concat();
    let (areas, boundaries) = (areas.areas, boundaries.boundaries);
    Ok(All { areas, boundaries, points: points.points, roads: roads.roads, defects })
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
        for which in [
            ALL,
            Which { layers: [true, false, false], ..NONE },
            Which { layers: [false, true, false], ..NONE },
            Which { layers: [false, false, true], ..NONE },
        ] {
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
            Kind::Nodes => {
                let tagged = |(id, at)| TaggedNode {
                    id,
                    at,
                    tags: if id % 5 == 0 { &[("natural", "spring")] } else { &[] },
                };
                let corners = [
                    (node, [north, east]),
                    (node + 1, [north, east + 5000]),
                    (node + 2, [north + 5000, east + 5000]),
                    (node + 3, [north + 5000, east]),
                ];
                block.tagged(&corners.map(tagged), square % 4 > 0);
            }
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
    assert_eq!(expected.points.0.len(), 4 * 96 / 5 + 96 / 3);
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
        assert_eq!(found.points, whole.points);
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
