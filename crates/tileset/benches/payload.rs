//! Times what a viewer does with every tile, and what a build does at its end: reading and writing
//! the sections of a tile.

#![expect(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::{hint::black_box, path::Path};

use corniche_geom::TileId;
use corniche_tileset::{FilePackage, PayloadContext, Sections, decode, encode};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Packages of this repository: in metres, and in degrees, where roads are range-coded.
const PACKAGES: [&str; 2] = ["version-2.pmtiles", "version-2-degrees.pmtiles"];

/// A package and the payloads of its tiles.
fn package(name: &str) -> (FilePackage, Vec<(TileId, Vec<u8>)>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    let package = FilePackage::open(&path).expect("a package of this repository");
    let ids = package.tile_ids().expect("a sound package");
    let tiles = ids.into_iter().map(|id| {
        let payload = package.tile(id).expect("a sound package").expect("a tile that is listed");
        (id, payload)
    });
    let tiles = tiles.collect();
    (package, tiles)
}

fn reading(c: &mut Criterion) {
    let mut group = c.benchmark_group("tileset::decode");
    for name in PACKAGES {
        let (package, tiles) = package(name);
        let (frame, quantum_m) = (package.manifest().frame, package.manifest().vertical.quantum_m);
        let sections = [
            ("terrain", Sections::TERRAIN),
            ("GEO roads and terrain", Sections::ROADS_GEO),
            ("SV roads", Sections::ROADS_SV),
            ("relief", Sections::RELIEF),
        ];
        group.throughput(Throughput::Elements(tiles.len() as u64));
        for (section, wanted) in sections {
            group.bench_function(BenchmarkId::new(section, name), |b| {
                b.iter(|| {
                    for (id, payload) in &tiles {
                        black_box(decode(payload, *id, &frame, quantum_m, wanted))
                            .expect("a sound tile");
                    }
                });
            });
        }
    }
    group.finish();
}

fn writing(c: &mut Criterion) {
    let mut group = c.benchmark_group("tileset::encode");
    group.sample_size(10);
    for name in PACKAGES {
        let (package, tiles) = package(name);
        let context = PayloadContext::from_manifest(package.manifest());
        let PayloadContext { frame, quantum_m, .. } = context;
        let decoded = tiles.iter().map(|(id, payload)| {
            decode(payload, *id, &frame, quantum_m, Sections::ALL).expect("a sound tile")
        });
        let decoded: Vec<_> = decoded.collect();
        group.throughput(Throughput::Elements(tiles.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                for tile in &decoded {
                    black_box(encode(tile, &context)).expect("a sound tile");
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, reading, writing);
criterion_main!(benches);
