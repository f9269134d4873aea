//! The small package in pieces, so that each piece can be invalid by itself.

use corniche_layers::LayerGeometry;
use corniche_tileset::{
    InputRecord, LayerCounts, LayerRecord, Manifest, SettingsRecord, SpanCounts, SpansRecord,
};

use crate::{
    package,
    payload::{RawSection, with_right_table_checksum},
    pmtiles::{self, RawDirectoryEntry, directory, gzip},
};

/// The pieces of a file as they are stored.
pub(crate) struct PackageParts {
    pub(crate) root: Vec<u8>,
    pub(crate) metadata: Vec<u8>,
    pub(crate) leaves: Vec<u8>,
    pub(crate) data: Vec<u8>,
    /// The number of tiles in the header.
    pub(crate) tiles: u64,
}

impl PackageParts {
    /// Returns the valid package: four tiles, no leaf directories.
    pub(crate) fn good() -> Self {
        let tiles: Vec<Vec<u8>> = package::ids().into_iter().map(package::encoded).collect();
        Self::of_tiles(&tiles)
    }

    /// Replaces the payloads of the valid package's first tiles.
    pub(crate) fn of_tiles(tiles: &[Vec<u8>]) -> Self {
        let mut entries = Vec::new();
        let (mut last, mut offset) = (0, 1);
        for (id, tile) in package::ids().into_iter().zip(tiles) {
            let order = corniche_tileset::pmtiles_order(id);
            let length = tile.len() as u64;
            entries.push(RawDirectoryEntry { step: order - last, run: 1, length, offset });
            (last, offset) = (order, offset + length);
        }
        Self {
            root: gzip(&directory(&entries)),
            metadata: gzip(metadata().to_string().as_bytes()),
            leaves: Vec::new(),
            tiles: tiles.len() as u64,
            data: tiles.concat(),
        }
    }

    /// Assembles the file.
    pub(crate) fn assemble(&self) -> Vec<u8> {
        pmtiles::file([&self.root, &self.metadata, &self.leaves, &self.data], self.tiles)
    }

    /// Assembles the file with other bytes at an offset of its header.
    pub(crate) fn with_header(&self, at: usize, bytes: &[u8]) -> Vec<u8> {
        let mut file = self.assemble();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    }
}

/// The valid package's metadata, in a CRS that PROJ knows and with an extract, layers of each
/// geometry and spans, so that no command ends before it has read tiles.
pub(crate) fn metadata() -> serde_json::Value {
    let (kind, name) = ("osm".to_owned(), "pass.osm.pbf".to_owned());
    let extract = InputRecord { kind, name, bytes: 1, sha256: "0".repeat(64) };
    let spans = SpanCounts {
        bridges: 0,
        tunnels: 0,
        bridges_um: 0,
        tunnels_um: 0,
        railway_bridges: 0,
        railway_tunnels: 0,
        crossings: Vec::new(),
        reasons: Vec::new(),
    };
    let sound = package::manifest();
    package::metadata(&Manifest {
        crs_wkt: "EPSG:32632".to_owned(),
        inputs: vec![extract],
        layers: LayerGeometry::ALL.iter().map(|&geometry| layer(geometry)).collect(),
        spans: Some(SpansRecord { counts: spans, levels: vec![], outer_grounds: vec![] }),
        settings: SettingsRecord { spans: true, ..sound.settings.clone() },
        ..sound
    })
}

/// A layer of a geometry with attributes of all kinds and without objects; its id is the name of
/// the geometry.
fn layer(geometry: LayerGeometry) -> LayerRecord {
    let table = serde_json::json!({
        "id": geometry.name(),
        "geometry": geometry,
        "attributes": { "ele": { "number": "m" }, "name": "names", "ref": "text", "seamark": "yes-no" },
        "class": [{ "id": "one", "tags": { "natural": true } }],
    });
    let counts = LayerCounts { objects: 0, kept: vec![], lost: vec![], unread_values: vec![] };
    LayerRecord { table: serde_json::from_value(table).unwrap(), counts, levels: vec![] }
}

/// Appends `count` numbers in planes in which every byte is `byte`.
pub(crate) fn planes(blob: &mut Vec<u8>, planes: u8, count: usize, byte: u8) {
    blob.push(planes);
    blob.resize(blob.len() + usize::from(planes) * count, byte);
}

/// Returns a column of `count` numbers of `width` bytes, which are all the same.
pub(crate) fn column(width: u8, count: usize, byte: u8) -> Vec<u8> {
    let mut column = Vec::new();
    planes(&mut column, width, count, byte);
    column
}

/// Returns a column of these numbers.
pub(crate) fn numbers(values: &[u64]) -> Vec<u8> {
    let all = values.iter().fold(0, |all, value| all | value);
    let width = (64 - all.leading_zeros()).div_ceil(8);
    let plane = |plane| values.iter().map(move |value| (value >> (8 * plane)) as u8);
    std::iter::once(width as u8).chain((0..width).flat_map(plane)).collect()
}

/// Returns a section, compressed if it is long: short ones do not become smaller.
pub(crate) fn section_of(kind: u16, raw: &[u8]) -> RawSection {
    if raw.len() < 1000 { RawSection::plain(kind, raw.to_vec()) } else { zstd_section(kind, raw) }
}

/// Returns a section as one zstd frame.
pub(crate) fn zstd_section(kind: u16, raw: &[u8]) -> RawSection {
    let stored = zstd::bulk::compress(raw, 3).unwrap();
    RawSection { kind, compression: 1, raw_length: raw.len() as u32, stored }
}

/// Returns a payload of tile 0/0/0 with correct offsets and checksums.
pub(crate) fn payload(sections: &[RawSection]) -> Vec<u8> {
    crate::payload::payload(corniche_geom::TileId::ROOT, sections)
}

/// Returns a payload with other bytes at an offset of its header or section table, and a matching
/// checksum.
pub(crate) fn resealed(mut payload: Vec<u8>, at: usize, bytes: &[u8]) -> Vec<u8> {
    payload[at..at + bytes.len()].copy_from_slice(bytes);
    with_right_table_checksum(payload)
}

/// The sections of the valid package's tile 0/0/0, decompressed by zstd's own decoder, in the order
/// of their kinds.
pub(crate) fn raw_sections() -> Vec<Vec<u8>> {
    let bytes = package::encoded("0/0/0".parse().unwrap());
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    (0..usize::from(bytes[6]))
        .map(|entry| {
            let at = 16 + 20 * entry;
            let stored = &bytes[number(at + 4)..number(at + 4) + number(at + 8)];
            match bytes[at + 2] {
                0 => stored.to_vec(),
                _ => zstd::bulk::decompress(stored, number(at + 12)).unwrap(),
            }
        })
        .collect()
}
