//! Blocks are decoded as an independent decoder does.

use corniche_testing::pbf::{
    BlockBuilder as Made, TaggedNode, deltas, field, number, varint, zigzags,
};
use osmpbf::PrimitiveBlock;
use proptest::prelude::*;

use super::*;
use crate::{audit::audit, blobs::decode};

/// Returns the id, longitude and latitude in nanodegrees, and version of each node.
fn nodes_of(block: &AuditedBlock<'_>) -> Vec<(i64, i64, i64, i32)> {
    let mut nodes = Vec::new();
    let _ = block.try_each_node(Some, |_, node| {
        nodes.push((node.id, node.lon_nano_deg, node.lat_nano_deg, node.version));
        ControlFlow::Continue(())
    });
    nodes
}

fn decoded(message: &[u8]) -> PrimitiveBlock {
    audit(message, u64::MAX).unwrap();
    decode(message).unwrap()
}

/// Keys and values.
type Tags = Vec<(String, String)>;

type MadeWay = (i64, Vec<i64>, Vec<(usize, usize)>);

const TEXTS: [&str; 4] = ["highway", "track", "name", "Ä"];

fn made_block() -> impl Strategy<Value = Made> {
    let node = (-9_i64..99, -900_000_i64..900_000, -900_000_i64..900_000);
    let nodes = || prop::collection::vec(node.clone(), 0..20);
    let refs = prop::collection::vec(-5_i64..500, 0..9);
    let tags = prop::collection::vec((0..TEXTS.len(), 0..TEXTS.len()), 0..4);
    let ways = prop::collection::vec((-3_i64..99, refs, tags), 0..9);
    (nodes(), nodes(), ways).prop_map(|(dense, plain, ways): (_, _, Vec<MadeWay>)| {
        let mut block = Made::new();
        block.dense(&dense);
        block.plain(&plain);
        for (id, refs, tags) in ways {
            let tags: Vec<_> =
                tags.into_iter().map(|(key, value)| (TEXTS[key], TEXTS[value])).collect();
            block.way(id, &tags, &refs);
        }
        block
    })
}

proptest! {
    /// An independent decoder is the oracle for tags of nodes, too.
    #[test]
    fn tagged_nodes_are_those_that_the_decoder_finds(
        nodes in prop::collection::vec(
            (-9_i64..99, prop::collection::vec((0..TEXTS.len(), 0..TEXTS.len()), 0..3)),
            0..20,
        ),
        wanted in 0..TEXTS.len(),
        dense_first in any::<bool>(),
    ) {
        let tags: Vec<Vec<(&str, &str)>> = nodes
            .iter()
            .map(|(_, tags)| tags.iter().map(|&(key, value)| (TEXTS[key], TEXTS[value])).collect())
            .collect();
        let nodes: Vec<TaggedNode<'_>> = nodes
            .iter()
            .zip(&tags)
            .map(|(&(id, _), tags)| TaggedNode { id, at: [10 * id, -7 * id], tags })
            .collect();
        let (first, second) = nodes.split_at(nodes.len() / 2);
        let mut made = Made::new();
        made.tagged(first, dense_first);
        made.tagged(second, !dense_first);
        let bytes = made.bytes();
        let decoded = decoded(&bytes);
        let [mut dense, mut plain]: [Vec<(i64, i64, i64, Tags)>; 2] = Default::default();
        let owned = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
        for group in decoded.groups() {
            dense.extend(group.dense_nodes().map(|node| {
                (node.id(), node.nano_lon(), node.nano_lat(), node.tags().map(owned).collect())
            }));
            plain.extend(group.nodes().map(|node| {
                (node.id(), node.nano_lon(), node.nano_lat(), node.tags().map(owned).collect())
            }));
        }
        let mut expected = [dense, plain].concat();
        expected.retain(|(.., tags)| tags.iter().any(|(key, _)| key == TEXTS[wanted]));
        let block = AuditedBlock::new(&bytes);
        let texts = block.texts();
        let mut found = Vec::new();
        let text = |at: usize| String::from_utf8(texts[at].to_vec()).unwrap();
        let taken: Result<(), &str> = block.try_each_tagged(
            |key| texts[key] == TEXTS[wanted].as_bytes(),
            |node, pairs| {
                let tags = pairs.iter().map(|&[key, value]| (text(key), text(value))).collect();
                found.push((node.id, node.lon_nano_deg, node.lat_nano_deg, tags));
                Ok(())
            },
        );
        prop_assert_eq!(taken, Ok(()));
        prop_assert_eq!(found, expected);
    }

    /// An independent decoder is the oracle.
    #[test]
    fn nodes_and_ways_are_those_that_the_decoder_finds(made in made_block()) {
        let bytes = made.bytes();
        let (block, decoded) = (AuditedBlock::new(&bytes), decoded(&bytes));
        let mut expected = Vec::new();
        for group in decoded.groups() {
            expected.extend(group.dense_nodes().map(|node| (node.id(), node.nano_lon(), node.nano_lat(), 0)));
            expected.extend(group.nodes().map(|node| (node.id(), node.nano_lon(), node.nano_lat(), 0)));
        }
        prop_assert_eq!(nodes_of(&block), expected);
        prop_assert_eq!(block.nodes_count() as usize, nodes_of(&block).len());
        let texts = block.texts();
        let text = |index: usize| str::from_utf8(texts[index]).unwrap();
        let ways: Vec<_> = block.ways().map(|way| {
            let tags = way.pairs().map(|[key, value]| (text(key), text(value)));
            (way.id, way.refs().collect::<Vec<_>>(), tags.collect::<Vec<_>>())
        }).collect();
        let of_decoder = decoded.groups().flat_map(|group| group.ways().collect::<Vec<_>>());
        let of_decoder: Vec<_> = of_decoder.collect();
        let expected: Vec<_> = of_decoder.iter().map(|way| {
            (way.id(), way.refs().collect::<Vec<_>>(), way.tags().collect::<Vec<_>>())
        }).collect();
        prop_assert_eq!(&ways, &expected);
        let has_ways = !ways.is_empty();
        prop_assert_eq!(block.has_others_than_nodes(), has_ways);
    }
}

/// Numbers that are packed, single, or in parts are the same.
#[test]
fn numbers_in_several_parts_are_joined() {
    let whole = field(8, &deltas(&[5, 300, 7]));
    let steps = [5_i64, 295, -293].map(|step| zigzags(&[step]));
    let alone = steps.each_ref().map(|step| [varint(8 << 3), step.clone()].concat()).concat();
    let parts = [field(8, &steps[0]), field(8, &steps[1..].concat())].concat();
    for refs in [whole, alone, parts] {
        let mut made = Made::new();
        made.groups = vec![field(3, &[number(1, 7), refs].concat())];
        let bytes = made.bytes();
        let block = AuditedBlock::new(&bytes);
        let refs: Vec<_> = block.ways().flat_map(|way| way.refs().collect::<Vec<_>>()).collect();
        assert_eq!(refs, [5, 300, 7]);
    }
}

/// Coordinates are steps from an offset, and versions do not require times.
#[test]
fn places_follow_granularity_and_offset() {
    let nodes = [
        field(1, &deltas(&[1, 2])),
        field(5, &field(1, &[3, 4])),
        field(8, &deltas(&[10, 20])),
        field(9, &deltas(&[-1, 1])),
    ];
    let mut made = Made::new();
    made.groups = vec![field(2, &nodes.concat())];
    let bytes = [made.bytes(), number(17, 1000), number(19, 7), number(20, -7)].concat();
    audit(&bytes, u64::MAX).unwrap();
    let block = AuditedBlock::new(&bytes);
    assert_eq!(nodes_of(&block), [(1, -1007, 10_007, 3), (2, 993, 20_007, 4)]);
}
