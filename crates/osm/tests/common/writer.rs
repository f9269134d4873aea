//! A writer of extracts that makes whatever it is told to, right or wrong.

use std::{io::Write, path::PathBuf};

use flate2::{Compression, write::ZlibEncoder};

pub(crate) fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value > 127 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// A field that holds a number.
pub(crate) fn number(field: u64, value: i64) -> Vec<u8> {
    [varint(field << 3), varint(value.cast_unsigned())].concat()
}

/// A field that holds bytes: a text, a message, packed numbers.
pub(crate) fn field(number: u64, content: &[u8]) -> Vec<u8> {
    [varint(number << 3 | 2), varint(content.len() as u64), content.to_vec()].concat()
}

pub(crate) fn zigzag(value: i64) -> Vec<u8> {
    varint(((value << 1) ^ (value >> 63)).cast_unsigned())
}

/// Zigzag numbers as they are.
pub(crate) fn zigzags(values: &[i64]) -> Vec<u8> {
    values.iter().flat_map(|&value| zigzag(value)).collect()
}

/// Differences of neighbours as zigzag numbers; they may wrap.
pub(crate) fn deltas(values: &[i64]) -> Vec<u8> {
    let mut previous = 0_i64;
    let step = |&value: &i64| value.wrapping_sub(std::mem::replace(&mut previous, value));
    zigzags(&values.iter().map(step).collect::<Vec<_>>())
}

fn packed(values: &[u64]) -> Vec<u8> {
    values.iter().flat_map(|&value| varint(value)).collect()
}

/// A frame with its blob header and blob, whatever that is.
pub(crate) fn frame(kind: &[u8], blob: &[u8]) -> Vec<u8> {
    frame_with([field(1, kind), number(3, blob.len() as i64)].concat(), blob)
}

pub(crate) fn frame_with(header: Vec<u8>, blob: &[u8]) -> Vec<u8> {
    [(header.len() as u32).to_be_bytes().to_vec(), header, blob.to_vec()].concat()
}

/// A raw blob.
pub(crate) fn raw(kind: &[u8], block: &[u8]) -> Vec<u8> {
    frame(kind, &field(1, block))
}

pub(crate) fn zlib(content: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

/// A packed blob.
pub(crate) fn packed_blob(kind: &[u8], block: &[u8]) -> Vec<u8> {
    frame(kind, &[number(2, block.len() as i64), field(3, &zlib(block))].concat())
}

/// The header blob of a file that asks for these features.
pub(crate) fn header(features: &[&str]) -> Vec<u8> {
    let block: Vec<u8> = features.iter().flat_map(|name| field(4, name.as_bytes())).collect();
    raw(b"OSMHeader", &block)
}

/// The usual header.
pub(crate) fn plain_header() -> Vec<u8> {
    header(&["OsmSchema-V0.6", "DenseNodes"])
}

/// A file of the usual header and one raw block.
pub(crate) fn file(block: &Block) -> Vec<u8> {
    [plain_header(), raw(b"OSMData", &block.bytes())].concat()
}

/// A block in the making. Places are in units of its granularity, 1e-7 degrees unless told otherwise.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) texts: Vec<Vec<u8>>,
    pub(crate) groups: Vec<Vec<u8>>,
    /// Further fields: granularity, offsets.
    pub(crate) frame: Vec<u8>,
}

impl Block {
    pub(crate) fn new() -> Self {
        Self { texts: vec![Vec::new()], groups: Vec::new(), frame: Vec::new() }
    }

    /// Nodes 1, 2, 3, … in a row to the east, 1e-5 degrees apart, at latitude 47 and longitude 9.
    pub(crate) fn with_row_of_nodes(count: i64) -> Self {
        let mut block = Self::new();
        let nodes: Vec<_> =
            (1..=count).map(|id| (id, 470_000_000, 90_000_000 + 100 * id)).collect();
        block.dense(&nodes);
        block
    }

    pub(crate) fn text(&mut self, text: &[u8]) -> u64 {
        let found = self.texts.iter().position(|own| own == text);
        let index = found.unwrap_or_else(|| {
            self.texts.push(text.to_vec());
            self.texts.len() - 1
        });
        index as u64
    }

    /// A group of dense nodes: id, latitude, longitude.
    pub(crate) fn dense(&mut self, nodes: &[(i64, i64, i64)]) {
        let column =
            |of: fn(&(i64, i64, i64)) -> i64| deltas(&nodes.iter().map(of).collect::<Vec<_>>());
        let dense = [
            field(1, &column(|node| node.0)),
            field(8, &column(|node| node.1)),
            field(9, &column(|node| node.2)),
        ];
        self.groups.push(field(2, &dense.concat()));
    }

    /// A group of plain nodes.
    pub(crate) fn plain(&mut self, nodes: &[(i64, i64, i64)]) {
        let node = |&(id, lat, lon): &(i64, i64, i64)| {
            let key = |number: u8| vec![number << 3];
            field(1, &[key(1), zigzag(id), key(8), zigzag(lat), key(9), zigzag(lon)].concat())
        };
        self.groups.push(nodes.iter().flat_map(node).collect());
    }

    /// The message of a way.
    pub(crate) fn way_message(
        &mut self,
        id: i64,
        tags: &[(&str, &str)],
        node_ids: &[i64],
    ) -> Vec<u8> {
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

    /// A way in a group of its own.
    pub(crate) fn way(&mut self, id: i64, tags: &[(&str, &str)], node_ids: &[i64]) {
        let message = self.way_message(id, tags, node_ids);
        self.groups.push(field(3, &message));
    }

    pub(crate) fn track(&mut self, id: i64, node_ids: &[i64]) {
        self.way(id, &[("highway", "track")], node_ids);
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let texts: Vec<u8> = self.texts.iter().flat_map(|text| field(1, text)).collect();
        let groups: Vec<u8> = self.groups.iter().flat_map(|group| field(2, group)).collect();
        [field(1, &texts), groups, self.frame.clone()].concat()
    }
}

/// The bytes as a file, which goes when the folder does.
pub(crate) fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}
