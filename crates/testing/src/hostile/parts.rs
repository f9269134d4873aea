//! The small package in pieces, so that each can be wrong by itself.

use corniche_tileset::{
    AreaCounts, AreaTableRecord, AreasRecord, InputRecord, LineCounts, LinesRecord, Manifest,
    SettingsRecord, SpanCounts, SpansRecord,
};

use crate::{
    package,
    payload::{Section, with_right_table_checksum},
    pmtiles::{self, Entry, directory, gzip},
};

/// The pieces of a file, as they are stored.
pub(crate) struct Parts {
    pub(crate) root: Vec<u8>,
    pub(crate) metadata: Vec<u8>,
    pub(crate) leaves: Vec<u8>,
    pub(crate) data: Vec<u8>,
    /// How many tiles the header counts.
    pub(crate) tiles: u64,
}

impl Parts {
    /// The sound package: four tiles, no leaf directories.
    pub(crate) fn good() -> Self {
        let tiles: Vec<Vec<u8>> = package::ids().into_iter().map(package::encoded).collect();
        Self::of_tiles(&tiles)
    }

    /// Payloads in the places of the sound package's first tiles.
    pub(crate) fn of_tiles(tiles: &[Vec<u8>]) -> Self {
        let mut entries = Vec::new();
        let (mut last, mut offset) = (0, 1);
        for (id, tile) in package::ids().into_iter().zip(tiles) {
            let order = corniche_tileset::pmtiles_order(id);
            let length = tile.len() as u64;
            entries.push(Entry { step: order - last, run: 1, length, offset });
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

    /// The file.
    pub(crate) fn assemble(&self) -> Vec<u8> {
        pmtiles::file([&self.root, &self.metadata, &self.leaves, &self.data], self.tiles)
    }

    /// The file with other bytes at a place of its header.
    pub(crate) fn with_header(&self, at: usize, bytes: &[u8]) -> Vec<u8> {
        let mut file = self.assemble();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    }
}

/// The sound package's metadata, in a system that PROJ knows and with an extract, areas, boundaries and spans, so that no command stops before it
/// has read tiles.
pub(crate) fn metadata() -> serde_json::Value {
    let (kind, name) = ("osm".to_owned(), "pass.osm.pbf".to_owned());
    let extract = InputRecord { kind, name, bytes: 1, sha256: "0".repeat(64) };
    let (table, sha256) = ("default".to_owned(), "0".repeat(64));
    let areas = AreaCounts { objects: 0, kept: vec![], lost: vec![] };
    let boundaries = LineCounts { ways: 0, kept: vec![], lost: vec![] };
    let (bridges, tunnels, crossings, reasons) = (0, 0, 0, vec![]);
    let spans = SpanCounts { bridges, tunnels, bridges_um: 0, tunnels_um: 0, crossings, reasons };
    let sound = package::manifest();
    package::metadata(&Manifest {
        crs_wkt: "EPSG:32632".to_owned(),
        inputs: vec![extract],
        areas: Some(AreasRecord { counts: areas, levels: vec![] }),
        boundaries: Some(LinesRecord { counts: boundaries, levels: vec![] }),
        spans: Some(SpansRecord { counts: spans, levels: vec![], outer_grounds: vec![] }),
        settings: SettingsRecord {
            areas: Some(AreaTableRecord { table, sha256 }),
            boundaries: true,
            spans: true,
            ..sound.settings.clone()
        },
        ..sound
    })
}

/// `count` numbers in planes of which every byte is `byte`.
pub(crate) fn planes(blob: &mut Vec<u8>, planes: u8, count: usize, byte: u8) {
    blob.push(planes);
    blob.resize(blob.len() + usize::from(planes) * count, byte);
}

/// A section as one zstd frame.
pub(crate) fn zstd_section(kind: u16, raw: &[u8]) -> Section {
    let stored = zstd::bulk::compress(raw, 3).unwrap();
    Section { kind, compression: 1, raw_length: raw.len() as u32, stored }
}

/// A payload of tile 0/0/0 with right offsets and checksums.
pub(crate) fn payload(sections: &[Section]) -> Vec<u8> {
    crate::payload::payload(corniche_geom::TileId::ROOT, sections)
}

/// A payload with other bytes at a place of its header or section table, and a checksum that fits.
pub(crate) fn resealed(mut payload: Vec<u8>, at: usize, bytes: &[u8]) -> Vec<u8> {
    payload[at..at + bytes.len()].copy_from_slice(bytes);
    with_right_table_checksum(payload)
}

/// The sections of the sound package's tile 0/0/0, decompressed by zstd's own decoder, in the order of their kinds.
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
