//! How many TIN edges a second real roads are laid across on real tiles, level by level, and what extruding them costs:
//! `CORNICHE_PACKAGE=FILE.pmtiles cargo bench -p corniche-drape --bench real_tiles`.

#![expect(missing_docs, reason = "criterion's macros make public functions without")]
#![expect(clippy::print_stderr, reason = "says why nothing is timed")]

use std::{collections::BTreeMap, hint::black_box, path::Path};

use corniche_drape::{DrapedLine, DrapedVertex, drape, extrude, positions};
use corniche_geom::Polyline;
use corniche_tileset::{FilePackage, Sections};
use corniche_tin::{Placement, Surface};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// A tile with roads.
struct Tile {
    surface: Surface,
    /// Its centre-lines before they were laid.
    centre_lines: Vec<Polyline>,
    /// Its plan lines for shadow volumes.
    sv_lines: Vec<Polyline>,
    margin_steps: i64,
}

/// The source points of a laid line, those beyond its ends included.
fn source(line: &DrapedLine) -> Option<Polyline> {
    let own = line.vertices.iter().filter_map(|vertex| match *vertex {
        DrapedVertex::Source { point, .. } => Some(point),
        _ => None,
    });
    Polyline::new(line.lead_in.into_iter().chain(own).chain(line.lead_out).collect()).ok()
}

fn tiles(package: &Path) -> BTreeMap<u8, Vec<Tile>> {
    let package = FilePackage::open(package).expect("a package");
    let manifest = package.manifest();
    let mut levels: BTreeMap<u8, Vec<Tile>> = BTreeMap::new();
    for id in package.tile_ids().expect("a directory") {
        let payload = package.payload(id, Sections::ALL).expect("a good tile").expect("a tile");
        let Some(terrain) = payload.terrain.filter(|_| !payload.roads_geo.is_empty()) else {
            continue;
        };
        let placement = Placement::of_tile(&manifest.frame, id, manifest.vertical.quantum_m);
        let level = manifest.levels.iter().find(|level| level.level == id.z()).expect("its level");
        levels.entry(id.z()).or_default().push(Tile {
            surface: Surface::new(&terrain.tin, placement),
            centre_lines: payload.roads_geo.iter().filter_map(|road| source(&road.line)).collect(),
            sv_lines: payload
                .roads_sv
                .into_iter()
                .filter_map(|road| Polyline::new(road.line.points).ok())
                .collect(),
            margin_steps: (level.width_margin_m / manifest.frame.lattice_step_m()) as i64,
        });
    }
    levels
}

fn bench(c: &mut Criterion) {
    let Some(package) = std::env::var_os("CORNICHE_PACKAGE") else {
        eprintln!("skipped: set CORNICHE_PACKAGE to a package with roads");
        return;
    };
    for (level, tiles) in tiles(Path::new(&package)) {
        let laid = |tile: &Tile| {
            tile.centre_lines
                .iter()
                .flat_map(|line| drape(line, &tile.surface).lines)
                .collect::<Vec<_>>()
        };
        let vertices: Vec<DrapedVertex> =
            tiles.iter().flat_map(laid).flat_map(|line| line.vertices).collect();
        let crossings =
            vertices.iter().filter(|vertex| !matches!(vertex, DrapedVertex::Source { .. })).count();
        let name = |count: usize| format!("{} tiles, {count}", tiles.len());
        let mut group = c.benchmark_group(format!("level {level}"));
        for (what, count) in [("crossings", crossings), ("vertices", vertices.len())] {
            group.throughput(Throughput::Elements(count as u64));
            group.bench_function(BenchmarkId::new(format!("drape, {what}"), name(count)), |b| {
                b.iter(|| {
                    for tile in &tiles {
                        tile.centre_lines
                            .iter()
                            .for_each(|line| drop(black_box(drape(line, &tile.surface))));
                    }
                });
            });
        }
        let lines: Vec<Vec<DrapedLine>> = tiles.iter().map(laid).collect();
        group.bench_function(BenchmarkId::new("positions, vertices", name(vertices.len())), |b| {
            b.iter(|| {
                for (tile, lines) in tiles.iter().zip(&lines) {
                    lines.iter().for_each(|line| drop(black_box(positions(line, &tile.surface))));
                }
            });
        });
        let segments: usize =
            tiles.iter().flat_map(|tile| &tile.sv_lines).map(|line| line.points().len() - 1).sum();
        group.throughput(Throughput::Elements(segments as u64));
        group.bench_function(BenchmarkId::new("extrude, segments", name(segments)), |b| {
            b.iter(|| {
                for tile in &tiles {
                    tile.sv_lines.iter().for_each(|line| {
                        drop(black_box(extrude(line, &tile.surface, tile.margin_steps)))
                    });
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
