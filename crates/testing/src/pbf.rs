//! A writer of OpenStreetMap extracts (PBF) that writes any input, valid or invalid.
//!
//! Source: OpenStreetMap's `fileformat.proto` and `osmformat.proto`, and the wire format of
//! Protocol Buffers.

use std::io::Write as _;

use flate2::{Compression, write::ZlibEncoder};

/// Encodes a number with seven bits per byte, the lowest first.
#[must_use]
pub fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value > 127 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// Encodes a field with a number.
#[must_use]
pub fn number(field: u64, value: i64) -> Vec<u8> {
    [varint(field << 3), varint(value.cast_unsigned())].concat()
}

/// Encodes a field with bytes: a text, a message, packed numbers.
#[must_use]
pub fn field(number: u64, content: &[u8]) -> Vec<u8> {
    [varint(number << 3 | 2), varint(content.len() as u64), content.to_vec()].concat()
}

/// Encodes a signed number like Protocol Buffers: the sign is the lowest bit.
#[must_use]
pub fn zigzag(value: i64) -> Vec<u8> {
    varint(((value << 1) ^ (value >> 63)).cast_unsigned())
}

/// Encodes zigzag numbers without differences.
#[must_use]
pub fn zigzags(values: &[i64]) -> Vec<u8> {
    values.iter().flat_map(|&value| zigzag(value)).collect()
}

/// Encodes differences of neighbours as zigzag numbers; they may wrap.
#[must_use]
pub fn deltas(values: &[i64]) -> Vec<u8> {
    let mut previous = 0_i64;
    let step = |&value: &i64| value.wrapping_sub(std::mem::replace(&mut previous, value));
    zigzags(&values.iter().map(step).collect::<Vec<_>>())
}

fn packed(values: &[u64]) -> Vec<u8> {
    values.iter().flat_map(|&value| varint(value)).collect()
}

/// Returns a frame: the blob header for a blob of this kind, then the blob, whatever its content.
#[must_use]
pub fn frame(kind: &[u8], blob: &[u8]) -> Vec<u8> {
    frame_with([field(1, kind), number(3, blob.len() as i64)].concat(), blob)
}

/// Returns a frame with this blob header.
#[must_use]
pub fn frame_with(header: Vec<u8>, blob: &[u8]) -> Vec<u8> {
    [(header.len() as u32).to_be_bytes().to_vec(), header, blob.to_vec()].concat()
}

/// Returns a frame with an uncompressed blob.
#[must_use]
pub fn raw(kind: &[u8], block: &[u8]) -> Vec<u8> {
    frame(kind, &field(1, block))
}

/// Compresses bytes with zlib.
#[must_use]
pub fn zlib(content: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

/// Returns a frame with a blob that is compressed with zlib.
#[must_use]
pub fn packed_blob(kind: &[u8], block: &[u8]) -> Vec<u8> {
    frame(kind, &[number(2, block.len() as i64), field(3, &zlib(block))].concat())
}

/// Returns the header blob of a file that requires these features.
#[must_use]
pub fn header(features: &[&str]) -> Vec<u8> {
    let block: Vec<u8> = features.iter().flat_map(|name| field(4, name.as_bytes())).collect();
    raw(b"OSMHeader", &block)
}

/// Returns the usual header.
#[must_use]
pub fn plain_header() -> Vec<u8> {
    header(&["OsmSchema-V0.6", "DenseNodes"])
}

/// Returns a file of the usual header and one raw block.
#[must_use]
pub fn file(block: &BlockBuilder) -> Vec<u8> {
    [plain_header(), raw(b"OSMData", &block.bytes())].concat()
}

/// A way to write: its tags, and its points as longitude and latitude.
#[derive(Debug, Clone)]
#[expect(missing_docs, reason = "the doc comment of the type describes both fields")]
pub struct WayToWrite<'a> {
    pub tags: Vec<(&'a str, &'a str)>,
    pub points_deg: Vec<[f64; 2]>,
}

/// Returns ways as a file of two blocks: the nodes, then the ways. Every point is a node of its
/// own. Ids of nodes and of ways count from 1. Coordinates are rounded to 1e-7 degrees. `texts`
/// come first in the blocks' table of texts.
#[must_use]
pub fn extract(texts: &[&str], lines: &[WayToWrite<'_>]) -> Vec<u8> {
    let (mut nodes, mut ways) = (Vec::new(), Vec::new());
    for (id, line) in (1..).zip(lines) {
        let first = nodes.len() as i64 + 1;
        nodes.extend((first..).zip(line.points_deg.iter().copied()));
        let node_ids = (first..=nodes.len() as i64).collect();
        ways.push(PbfWay { id, tags: line.tags.clone(), node_ids });
    }
    network(texts, &nodes, &ways)
}

/// A way to write: its id, its tags and the ids of its nodes.
#[derive(Debug, Clone)]
#[expect(missing_docs, reason = "the doc comment of the type describes all fields")]
pub struct PbfWay<'a> {
    pub id: i64,
    pub tags: Vec<(&'a str, &'a str)>,
    pub node_ids: Vec<i64>,
}

/// Returns nodes, with their longitudes and latitudes, and ways through them, as a file of two
/// blocks; otherwise like [`extract`].
#[must_use]
pub fn network(texts: &[&str], nodes: &[(i64, [f64; 2])], ways: &[PbfWay<'_>]) -> Vec<u8> {
    let mut block = BlockBuilder::new();
    for text in texts {
        block.text(text.as_bytes());
    }
    let round = |deg: f64| (deg * 1e7).round() as i64;
    let nodes: Vec<(i64, i64, i64)> =
        nodes.iter().map(|&(id, [lon, lat])| (id, round(lat), round(lon))).collect();
    let mut messages = Vec::new();
    for way in ways {
        messages.extend(field(3, &block.way_message(way.id, &way.tags, &way.node_ids)));
    }
    let mut block_of_nodes = block.clone();
    block_of_nodes.plain(&nodes);
    block.groups.push(messages);
    let data = [block_of_nodes, block].map(|block| raw(b"OSMData", &block.bytes()));
    [header(&["OsmSchema-V0.6"]), data.concat()].concat()
}

/// A node with tags.
#[derive(Debug, Clone, Copy)]
pub struct TaggedNode<'a> {
    /// The id.
    pub id: i64,
    /// Latitude and longitude.
    pub at: [i64; 2],
    /// Keys and values.
    pub tags: &'a [(&'a str, &'a str)],
}

/// A block that grows. Positions are in units of its granularity: 1e-7 degrees unless `frame` sets
/// another.
#[derive(Debug, Clone, Default)]
pub struct BlockBuilder {
    /// The table of texts; text 0 is empty, as the format requires.
    pub texts: Vec<Vec<u8>>,
    /// Groups of primitives, encoded.
    pub groups: Vec<Vec<u8>>,
    /// Further fields: granularity, offsets.
    pub frame: Vec<u8>,
}

impl BlockBuilder {
    /// Begins a block without nodes and ways.
    #[must_use]
    pub fn new() -> Self {
        Self { texts: vec![Vec::new()], groups: Vec::new(), frame: Vec::new() }
    }

    /// Begins a block with nodes 1, 2, 3, … in a row to the east, 1e-5 degrees apart, at latitude
    /// 47 and longitude 9.
    #[must_use]
    pub fn with_row_of_nodes(count: i64) -> Self {
        let mut block = Self::new();
        let nodes: Vec<_> =
            (1..=count).map(|id| (id, 470_000_000, 90_000_000 + 100 * id)).collect();
        block.dense(&nodes);
        block
    }

    /// Returns the index of a text in the table of texts, and adds the text if it is missing.
    pub fn text(&mut self, text: &[u8]) -> u64 {
        let found = self.texts.iter().position(|own| own == text);
        let index = found.unwrap_or_else(|| {
            self.texts.push(text.to_vec());
            self.texts.len() - 1
        });
        index as u64
    }

    /// Adds a group of dense nodes: id, latitude, longitude.
    pub fn dense(&mut self, nodes: &[(i64, i64, i64)]) {
        let column =
            |of: fn(&(i64, i64, i64)) -> i64| deltas(&nodes.iter().map(of).collect::<Vec<_>>());
        let dense = [
            field(1, &column(|node| node.0)),
            field(8, &column(|node| node.1)),
            field(9, &column(|node| node.2)),
        ];
        self.groups.push(field(2, &dense.concat()));
    }

    /// Adds a group of plain nodes: id, latitude, longitude.
    pub fn plain(&mut self, nodes: &[(i64, i64, i64)]) {
        let node = |&(id, lat, lon): &(i64, i64, i64)| {
            let key = |number: u8| vec![number << 3];
            field(1, &[key(1), zigzag(id), key(8), zigzag(lat), key(9), zigzag(lon)].concat())
        };
        self.groups.push(nodes.iter().flat_map(node).collect());
    }

    /// Adds groups of nodes with tags: one of dense nodes if `is_dense`, otherwise one of plain
    /// nodes.
    pub fn tagged(&mut self, nodes: &[TaggedNode<'_>], is_dense: bool) {
        let mut tags_of = |node: &TaggedNode<'_>| -> Vec<[u64; 2]> {
            let tags = node.tags.iter();
            tags.map(|(key, value)| [key, value].map(|text| self.text(text.as_bytes()))).collect()
        };
        let tags: Vec<Vec<[u64; 2]>> = nodes.iter().map(&mut tags_of).collect();
        let mut group = Vec::new();
        if is_dense {
            let column =
                |of: fn(&TaggedNode<'_>) -> i64| deltas(&nodes.iter().map(of).collect::<Vec<_>>());
            let of_node = |tags: &Vec<[u64; 2]>| [&tags.concat()[..], &[0]].concat();
            let dense = [
                field(1, &column(|node| node.id)),
                field(8, &column(|node| node.at[0])),
                field(9, &column(|node| node.at[1])),
                field(10, &packed(&tags.iter().flat_map(of_node).collect::<Vec<_>>())),
            ];
            group = field(2, &dense.concat());
        } else {
            let key = |number: u8| vec![number << 3];
            for (node, tags) in nodes.iter().zip(&tags) {
                let [keys, values] =
                    [0, 1].map(|part| tags.iter().map(|tag| tag[part]).collect::<Vec<_>>());
                let fields = [
                    [key(1), zigzag(node.id)].concat(),
                    field(2, &packed(&keys)),
                    field(3, &packed(&values)),
                    [key(8), zigzag(node.at[0]), key(9), zigzag(node.at[1])].concat(),
                ];
                group.extend(field(1, &fields.concat()));
            }
        }
        self.groups.push(group);
    }

    /// Returns the message of a way.
    pub fn way_message(&mut self, id: i64, tags: &[(&str, &str)], node_ids: &[i64]) -> Vec<u8> {
        let keys: Vec<u64> = tags.iter().map(|(key, _)| self.text(key.as_bytes())).collect();
        let values: Vec<u64> = tags.iter().map(|(_, value)| self.text(value.as_bytes())).collect();
        [
            number(1, id),
            field(2, &packed(&keys)),
            field(3, &packed(&values)),
            field(8, &deltas(node_ids)),
        ]
        .concat()
    }

    /// Adds a way in a group of its own.
    pub fn way(&mut self, id: i64, tags: &[(&str, &str)], node_ids: &[i64]) {
        let message = self.way_message(id, tags, node_ids);
        self.groups.push(field(3, &message));
    }

    /// Adds a relation of ways with these roles, in a group of its own.
    pub fn relation(&mut self, id: i64, tags: &[(&str, &str)], members: &[(i64, &str)]) {
        let keys: Vec<u64> = tags.iter().map(|(key, _)| self.text(key.as_bytes())).collect();
        let values: Vec<u64> = tags.iter().map(|(_, value)| self.text(value.as_bytes())).collect();
        let roles: Vec<u64> = members.iter().map(|(_, role)| self.text(role.as_bytes())).collect();
        let way_ids: Vec<i64> = members.iter().map(|&(id, _)| id).collect();
        let message = [
            number(1, id),
            field(2, &packed(&keys)),
            field(3, &packed(&values)),
            field(8, &packed(&roles)),
            field(9, &deltas(&way_ids)),
            field(10, &packed(&vec![1; members.len()])),
        ];
        self.groups.push(field(4, &message.concat()));
    }

    /// Adds a way with the tag `highway=track`.
    pub fn track(&mut self, id: i64, node_ids: &[i64]) {
        self.way(id, &[("highway", "track")], node_ids);
    }

    /// Returns the encoded block.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let texts: Vec<u8> = self.texts.iter().flat_map(|text| field(1, text)).collect();
        let groups: Vec<u8> = self.groups.iter().flat_map(|group| field(2, group)).collect();
        [field(1, &texts), groups, self.frame.clone()].concat()
    }
}
