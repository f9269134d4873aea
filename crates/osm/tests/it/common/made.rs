//! Generates random small extracts: with positions in nodes or in ways, missing nodes, duplicates
//! and several versions.

use corniche_testing::pbf::{BlockBuilder, deltas, field, number, packed_blob, plain_header, raw};
use proptest::prelude::*;

/// A way of a random extract.
#[derive(Debug, Clone)]
struct MadeWay {
    id: i64,
    tags: Vec<(&'static str, &'static str)>,
    node_ids: Vec<i64>,
    version: i64,
    /// Latitude and longitude of each node, if the ways contain them.
    places: Option<Vec<(i64, i64)>>,
}

impl MadeExtract {
    /// Creates an extract of ways without nodes, in this order: id, `highway` value and version of
    /// each.
    pub(crate) fn of_bare_ways(ways: &[(i64, &'static str, i64)], per_block: usize) -> Self {
        let bare = |&(id, highway, version): &(i64, &'static str, i64)| {
            let tags = vec![("highway", highway)];
            MadeWay { id, tags, node_ids: Vec::new(), version, places: None }
        };
        let ways = ways.iter().map(bare).collect();
        Self { ways, nodes: Vec::new(), per_block, order: Order::AsMade, has_places: false }
    }
}

fn made_way() -> impl Strategy<Value = MadeWay> {
    let highways = vec!["track", "residential", "motorway_link", "footway", "goat_trail"];
    let more = prop::sample::subsequence(
        vec![("name", "Bé"), ("area", "yes"), ("layer", "1000"), ("tunnel", "culvert")],
        0..2,
    );
    let node_ids = prop_oneof![
        3 => (-20_i64..60, 0_i64..9).prop_map(|(first, count)| (first..first + count).collect()),
        2 => prop::collection::vec(-20_i64..60, 0..9),
    ];
    let version = prop::sample::select(vec![0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 7, 8]);
    (
        -9_i64..40,
        prop::sample::select(highways),
        more,
        node_ids,
        version,
        any::<bool>(),
        any::<u32>(),
    )
        .prop_map(|(id, highway, more, node_ids, version, has_places, salt)| {
            let tags = [vec![("highway", highway)], more].concat();
            let place = |&id: &i64| {
                let mix = (id.unsigned_abs() * 7 + u64::from(salt) % 3) as i64;
                (mix % 5, if mix % 13 == 0 { 2_000_000_000 } else { mix % 4 })
            };
            let places = has_places.then(|| node_ids.iter().map(place).collect());
            MadeWay { id, tags, node_ids, version, places }
        })
}

/// The order of a generated file.
#[derive(Debug, Clone, Copy)]
enum Order {
    Sorted,
    AsMade,
    BlobsBackwards,
}

/// A random extract.
#[derive(Debug)]
pub(crate) struct MadeExtract {
    ways: Vec<MadeWay>,
    nodes: Vec<(i64, i64, i64)>,
    per_block: usize,
    order: Order,
    has_places: bool,
}

/// Generates extracts that are sorted or not, with positions in nodes, in ways or in both, and with
/// nodes and ways that occur twice.
pub(crate) fn made_extract() -> impl Strategy<Value = MadeExtract> {
    (
        prop::collection::vec(made_way(), 0..30),
        prop::collection::vec((-20_i64..60, 0_i64..5, 0_i64..5), 0..90),
        1_usize..20,
        prop::sample::select(vec![Order::Sorted, Order::AsMade, Order::BlobsBackwards]),
        any::<bool>(),
    )
        .prop_map(|(ways, nodes, per_block, order, has_places)| MadeExtract {
            ways,
            nodes,
            per_block,
            order,
            has_places,
        })
}

impl MadeExtract {
    /// Returns the bytes of the file.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let Self { ways, nodes, per_block, order, has_places } = self;
        made_file(ways.clone(), nodes.clone(), *per_block, *order, *has_places)
    }
}

fn made_file(
    mut ways: Vec<MadeWay>,
    mut nodes: Vec<(i64, i64, i64)>,
    per_block: usize,
    order: Order,
    has_places: bool,
) -> Vec<u8> {
    if matches!(order, Order::Sorted) {
        ways.sort_by_key(|way| way.id);
        nodes.sort_by_key(|node| node.0);
    }
    let mut blobs = Vec::new();
    for some in nodes.chunks(per_block) {
        let mut block = BlockBuilder::new();
        let (dense, plain) = some.split_at(some.len() / 2);
        block.dense(dense);
        block.plain(plain);
        blobs.push(packed_blob(b"OSMData", &block.bytes()));
    }
    for some in ways.chunks(per_block) {
        let mut block = BlockBuilder::new();
        for way in some {
            let mut message = block.way_message(way.id, &way.tags, &way.node_ids);
            if way.version > 0 {
                message.extend(field(4, &number(1, way.version)));
            }
            if let Some(places) = way.places.as_ref().filter(|_| has_places) {
                let column = |of: fn(&(i64, i64)) -> i64| places.iter().map(of).collect::<Vec<_>>();
                message.extend(field(9, &deltas(&column(|place| place.0))));
                message.extend(field(10, &deltas(&column(|place| place.1))));
            }
            block.groups.push(field(3, &message));
        }
        blobs.push(raw(b"OSMData", &block.bytes()));
    }
    if matches!(order, Order::BlobsBackwards) {
        blobs.reverse();
    }
    [plain_header(), blobs.concat()].concat()
}
