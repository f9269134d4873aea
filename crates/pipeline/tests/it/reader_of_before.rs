//! A frozen reader that knows no sections of spans finds the roads of bridges and tunnels on the
//! ground.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, path::Path};

use corniche_pipeline::build;
use corniche_roads::Structure;
use corniche_tileset::{FilePackage, Sections};
use corniche_work::Silent;

use crate::support::{
    Options,
    parts::{MAX_ERROR_M, sample},
    settings,
};

/// The last kind of section that the frozen reader knows.
const LAST_KIND: u16 = 11;
/// The kind of the spans section, which the frozen reader does not know.
const SPANS: u16 = 13;

/// The stored bytes of a tile's sections of known kinds, and all kinds in its table. This follows
/// the table of section 3 of version 2 of the format, and must never be changed.
fn sections(payload: &[u8]) -> (BTreeMap<u16, &[u8]>, Vec<u16>) {
    let half = |at: usize| u16::from_le_bytes(payload[at..at + 2].try_into().unwrap());
    let word = |at: usize| u32::from_le_bytes(payload[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&payload[..4], half(4)), (&b"CRNT"[..], 2));
    let mut known = BTreeMap::new();
    let mut kinds = Vec::new();
    for index in 0..usize::from(payload[6]) {
        let entry = 16 + 20 * index;
        let (kind, offset, length) = (half(entry), word(entry + 4), word(entry + 8));
        kinds.push(kind);
        if (1..=LAST_KIND).contains(&kind) {
            known.insert(kind, &payload[offset..offset + length]);
        }
    }
    (known, kinds)
}

fn package(folder: &Path, name: &str, spans: bool) -> FilePackage {
    let path = folder.join(name);
    let options = Options { fill_voids: 32, ..Options::plain(MAX_ERROR_M) };
    let (dem, osm) = (sample("pass-dem.tif"), sample("pass.osm.pbf"));
    let mut settings = settings(dem, Some(osm), path.clone(), options);
    settings.plan.roads.spans = spans;
    build(&settings, &Silent).unwrap();
    FilePackage::open(&path).unwrap()
}

#[test]
fn readers_of_before_find_bridges_and_tunnels_where_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let [spans, ground] = [("spans.pmtiles", true), ("ground.pmtiles", false)]
        .map(|(name, is_with)| package(folder.path(), name, is_with));
    assert_eq!(spans.tile_ids().unwrap(), ground.tile_ids().unwrap());
    let (mut tiles_with_spans, mut lines_of_structures) = (0, 0);
    for id in spans.tile_ids().unwrap() {
        let [with, without] = [&spans, &ground].map(|package| package.tile(id).unwrap().unwrap());
        let (found, kinds) = sections(&with);
        assert_eq!(found, sections(&without).0, "tile {id}");
        if !kinds.contains(&SPANS) {
            continue;
        }
        tiles_with_spans += 1;
        let payload = ground.payload(id, Sections::ALL).unwrap().unwrap();
        let structures = payload
            .attributes
            .iter()
            .filter(|record| record.attributes.structure != Structure::Ground);
        let ways: Vec<i64> = structures.map(|record| record.way_id).collect();
        lines_of_structures +=
            payload.roads_geo.iter().filter(|road| ways.contains(&road.way_id)).count();
    }
    assert!(tiles_with_spans > 0 && lines_of_structures >= tiles_with_spans);
}
