//! Creates the seeds of the fuzz targets `package` (`corpus/package`) and `layers`, and some of
//! `payload`; the targets read them to their end. `CORNICHE_WRITE_SEEDS=1` rewrites them. Those of `osm` are
//! created by `crates/osm/tests/it/seeds.rs`.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs, path::Path};

use corniche_fuzz::layer_coding;
use corniche_geom::{HeightGrid, LatticePoint, TileId};
use corniche_layers::{AttributeValue, LayerGeometry, OsmObject};
use corniche_testing::{
    package::{context, encoded, encoded_with_spans, ids, manifest, metadata},
    pmtiles::{RawDirectoryEntry, directory, file, gzip},
};
use corniche_tileset::{
    AreaPolygon, LayerObject, LayerShape, LayerSlot, MemorySource, PHOTO_BORDER, Package, Photo,
    Relief, Sections, TilePayload, decode, encode, encode_layer, encode_photo, pmtiles_order,
};

/// A root directory, a leaf directory and tiles, in the form that the target splits.
fn parts(root: &[u8], leaf: &[u8], tiles: &[Vec<u8>]) -> Vec<u8> {
    let lengths = [root.len() as u16, leaf.len() as u16].map(u16::to_le_bytes).concat();
    [&[2], &lengths[..], root, leaf, &tiles.concat()].concat()
}

/// The first tiles of the small package, in a separate directory.
fn tiles(count: usize) -> (Vec<u8>, Vec<Vec<u8>>) {
    let tiles: Vec<Vec<u8>> = ids().into_iter().take(count).map(encoded).collect();
    let (mut last, mut offset) = (0, 1);
    let mut entries = Vec::new();
    for (id, tile) in ids().into_iter().zip(&tiles) {
        let (order, length) = (pmtiles_order(id), tile.len() as u64);
        entries.push(RawDirectoryEntry { step: order - last, run: 1, length, offset });
        (last, offset) = (order, offset + length);
    }
    (directory(&entries), tiles)
}

fn seeds() -> BTreeMap<&'static str, Vec<u8>> {
    let (four, four_tiles) = tiles(4);
    let (one, one_tile) = tiles(1);
    let to_leaf = RawDirectoryEntry { step: 0, run: 0, length: gzip(&one).len() as u64, offset: 1 };
    let text = metadata(&manifest()).to_string();
    let whole = file([&gzip(&four), &gzip(text.as_bytes()), &[], &four_tiles.concat()], 4);
    BTreeMap::from([
        ("whole", [&[0], &whole[..]].concat()),
        ("four-tiles", parts(&four, &[], &four_tiles)),
        ("one-tile", parts(&one, &[], &one_tile)),
        ("leaf", parts(&directory(&[to_leaf]), &one, &one_tile)),
        ("metadata-small", [&[1], text.as_bytes()].concat()),
        ("metadata-other-version", b"\x01{\"corniche\":{\"format_version\":7}}".to_vec()),
    ])
}

/// A photo of one colour with a hole, in the form of the target `payload`: a list of sections that
/// contains only the photo.
fn photo() -> Vec<u8> {
    let side = 256 + 2 * PHOTO_BORDER;
    let texel = |at: usize| if at % side < 24 { [0; 4] } else { [90, 120, 60, 255] };
    let rgba = (0..side * side).flat_map(texel).collect();
    let section = encode_photo(TileId::ROOT, &Photo { levels: 0, rgba }, 5).unwrap().unwrap();
    let length = (section.bytes().len() as u16).to_le_bytes();
    [&[0, 7], &length[..], section.bytes()].concat()
}

/// A payload with only a relief, in the form of the target `payload`: rough ground, a plane and a
/// void.
fn relief_seed() -> Vec<u8> {
    let heights = HeightGrid::from_fn(259, 259, |column, row| {
        if column > 200 && row > 180 {
            return f32::NAN;
        }
        300.0 + if column < 40 { (column * row % 97) as f32 } else { row as f32 }
    });
    let context = context();
    let id = TileId::ROOT.children().nth(1).unwrap();
    let cell = context.frame.level_cell(id.z());
    let relief = Some(Relief::of_heights(&heights, &heights, cell, context.quantum_m).unwrap());
    let tile = TilePayload {
        id,
        terrain: None,
        relief,
        roads_geo: vec![],
        roads_sv: vec![],
        attributes: vec![],
    };
    [&[1], &encode(&tile, &context).unwrap().bytes[..]].concat()
}

/// A payload with ground and roads, in the form of the target `payload`.
fn whole_payload() -> Vec<u8> {
    [&[1], &encoded(TileId::ROOT.children().nth(1).unwrap())[..]].concat()
}

/// A payload that also has spans.
fn payload_with_spans() -> Vec<u8> {
    [&[1], &encoded_with_spans(TileId::ROOT.children().nth(1).unwrap())[..]].concat()
}

/// A section of three objects with and without values, in the form of the target `layers`. Lines
/// and rings share points.
fn layer(geometry: LayerGeometry) -> Vec<u8> {
    let frame = context().frame;
    let corner = frame.tile_lattice_bounds(TileId::ROOT).min;
    let at = |u: i64, v: i64| {
        let [u, v] = [(corner.u, u), (corner.v, v)].map(|(from, by)| (from / 64 + 1 + by) * 64);
        LatticePoint::new(u, v)
    };
    let border: Vec<LatticePoint> = (0..9).map(|n| at(100 + n * n, 90 * n)).collect();
    let names =
        [("", "Lac"), ("de", "See"), ("fr", "Lac")].map(|(a, b)| (a.to_owned(), b.to_owned()));
    let object = |(class, number): (u8, f64)| {
        let end = at(900 * i64::from(class), 7);
        let mut points = [&border[..], &[end]].concat();
        if class == 1 {
            points.reverse();
        }
        let shape = match geometry {
            LayerGeometry::Line => LayerShape::Line(points),
            LayerGeometry::Area => LayerShape::Area(vec![AreaPolygon { rings: vec![points] }]),
            LayerGeometry::Point => LayerShape::Point(end),
        };
        let values = vec![
            Some(AttributeValue::Text("See".to_owned())),
            (class > 0).then(|| AttributeValue::Names(names.to_vec())),
            (class > 0).then_some(AttributeValue::YesNo(class > 1)),
            (class != 1).then_some(AttributeValue::Number(number)),
        ];
        LayerObject { class, object: OsmObject::Way(1 << 33), values, shape }
    };
    let objects: Vec<LayerObject> = (0..).zip([-12.0, 0.1, 1e300]).map(object).collect();
    let (slot, coding) = (LayerSlot::new(0).unwrap(), layer_coding(geometry));
    let section = encode_layer(TileId::ROOT, &frame, slot, &coding, 64, &objects).unwrap().unwrap();
    let first = LayerGeometry::ALL.iter().position(|&known| known == geometry).unwrap();
    [&[first as u8], section.bytes()].concat()
}

#[test]
fn the_seed_with_a_relief_is_as_it_is_made_here_and_is_read() {
    let bytes = relief_seed();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus/payload/relief");
    if std::env::var_os("CORNICHE_WRITE_SEEDS").is_some() {
        fs::write(&path, &bytes).unwrap();
    }
    assert!(fs::read(&path).unwrap() == bytes, "CORNICHE_WRITE_SEEDS=1 rewrites it");
    assert!(bytes.len() <= 16_384, "{} bytes", bytes.len());
    let id = TileId::ROOT.children().nth(1).unwrap();
    let context = context();
    let read = decode(&bytes[1..], id, &context.frame, context.quantum_m, Sections::ALL);
    assert!(read.unwrap().relief.is_some());
    // The last byte is not changed, because it has no information: zeros are read beyond the end.
    for at in (1..bytes.len()).step_by(bytes.len() / 12) {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        corniche_fuzz::payload(&changed);
    }
}

#[test]
fn the_seeds_of_the_fuzz_targets_are_as_they_are_made_here() {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    check(&all.join("package"), seeds());
    let of_payload =
        [("photo", photo()), ("spans", payload_with_spans()), ("whole", whole_payload())];
    check(&all.join("payload"), BTreeMap::from(of_payload));
    corniche_fuzz::payload(&payload_with_spans());
    let of_layers = LayerGeometry::ALL.iter().map(|&geometry| (geometry.name(), layer(geometry)));
    check(&all.join("layers"), of_layers.collect());
}

fn check(folder: &Path, seeds: BTreeMap<&'static str, Vec<u8>>) {
    for (name, bytes) in seeds {
        assert!(bytes.len() <= 4096, "{name}: {} bytes", bytes.len());
        let path = folder.join(name);
        if std::env::var_os("CORNICHE_WRITE_SEEDS").is_some() {
            fs::write(&path, &bytes).unwrap();
        }
        let kept = fs::read(&path).unwrap();
        assert!(kept == bytes, "{name} is out of date; CORNICHE_WRITE_SEEDS=1 rewrites it");
    }
}

/// The number of tiles of a seed that the target reads; fails if it rejects any part of the seed.
fn tiles_read(seed: &[u8]) -> usize {
    let package = corniche_fuzz::package_of(seed).expect("a seed");
    let package = pollster::block_on(Package::open(MemorySource::new(package))).unwrap();
    let ids = pollster::block_on(package.tile_ids()).unwrap();
    for id in &ids {
        assert!(pollster::block_on(package.payload(*id, Sections::ALL)).unwrap().is_some());
    }
    ids.len()
}

#[test]
fn the_target_reads_its_seeds_to_their_end() {
    let seeds = seeds();
    for (name, tiles) in
        [("whole", 4), ("four-tiles", 4), ("one-tile", 1), ("leaf", 1), ("metadata-small", 0)]
    {
        assert_eq!(tiles_read(&seeds[name]), tiles, "{name}");
    }
}
