//! Measures how many TIN edges per second real roads are draped across on real tiles, level by
//! level, and the time of extruding them. The tiles are files with the output of
//! `corniche tile PACKAGE Z/X/Y --json`, one file per tile:
//! `CORNICHE_TILES=FOLDER cargo bench -p corniche-drape --bench real_tiles`.

#![expect(
    missing_docs,
    reason = "criterion's macros create public functions without documentation"
)]

use std::{collections::BTreeMap, fs, hint::black_box, path::Path};

use corniche_drape::{DrapedLine, DrapedVertex, clip_closed, drape, extrude, positions};
use corniche_geom::{LatticeBounds, LatticePoint, Polyline};
use corniche_tin::{Placement, Surface, Tin, TinVertex};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use serde_json::Value;

/// Heights of any package are whole steps of this size.
const QUANTUM_M: f64 = 1.0 / 1024.0;

/// A tile with roads.
struct Tile {
    surface: Surface,
    /// The level's lines in plan within the tile.
    lines: Vec<Polyline>,
    /// The level's lines in plan within the tile and its margin, for shadow volumes.
    sv_lines: Vec<Polyline>,
    margin_steps: i64,
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

fn rows(list: &Value) -> impl Iterator<Item = Vec<f64>> {
    list.as_array().into_iter().flatten().map(numbers)
}

/// Reads a tile from its JSON; the tile's corner is the origin of the lattice.
fn tile(json: &Value) -> Tile {
    let cell_m = json["cell_m"].as_f64().expect("a cell");
    let bounds_m = numbers(&json["bounds"]);
    let (west_m, north_m) = (bounds_m[0], bounds_m[3]);
    let node_steps = 1_i64 << (cell_m / 0.001).log2().ceil() as u32;
    let vertex = |at: Vec<f64>| TinVertex {
        row: ((north_m - at[1]) / cell_m).round() as u16,
        column: ((at[0] - west_m) / cell_m).round() as u16,
        height_q: (at[2] / QUANTUM_M).round() as i32,
    };
    let corners = |at: Vec<f64>| [at[0] as u32, at[1] as u32, at[2] as u32];
    let triangles: Vec<[u32; 3]> = rows(&json["tin"]["triangles"]).map(corners).collect();
    let vertices = rows(&json["tin"]["vertices"]).map(vertex).collect();
    let tin = Tin::new(vertices, &triangles).expect("a stored TIN");
    let placement = Placement {
        corner: LatticePoint::new(0, 0),
        node_steps: [node_steps; 2],
        quantum_m: QUANTUM_M,
    };
    let steps = |metres: f64| (metres / cell_m * node_steps as f64).round() as i64;
    let sv_lines: Vec<Polyline> = json["roads_sv"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|road| {
            rows(&road["line"])
                .map(|at| LatticePoint::new(steps(at[0] - west_m), steps(at[1] - north_m)))
        })
        .filter_map(|points| Polyline::new(points.collect()).ok())
        .collect();
    let side = 256 * node_steps;
    let bounds =
        LatticeBounds { min: LatticePoint::new(0, -side), max: LatticePoint::new(side, 0) };
    let lines = sv_lines.iter().flat_map(|line| clip_closed(line, &bounds)).collect();
    // The margin is that of the pipeline: eight cells, at least 40 m.
    let margin_steps = steps((8.0 * cell_m).max(40.0));
    Tile { surface: Surface::new(&tin, placement), lines, sv_lines, margin_steps }
}

/// Straight lines from the west to the east of a tile: nearly all of their vertices are crossings.
fn straight_lines(surface: &Surface) -> Vec<Polyline> {
    let Some(LatticeBounds { min, max }) = LatticeBounds::around(surface.points()) else {
        return Vec::new();
    };
    let at = |part: i64| min.v + (max.v - min.v) * part / 256;
    let ends =
        |n: i64| vec![LatticePoint::new(min.u, at(n)), LatticePoint::new(max.u, at(n * 97 % 256))];
    (0..256).filter_map(|n| Polyline::new(ends(n)).ok()).collect()
}

/// The tiles with roads in a folder, by level.
fn tiles(folder: &Path) -> BTreeMap<u8, Vec<Tile>> {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let mut levels: BTreeMap<u8, Vec<Tile>> = BTreeMap::new();
    for path in paths {
        let json: Value = serde_json::from_slice(&fs::read(path).expect("a file")).expect("JSON");
        let level = json["id"].as_str().and_then(|id| id.split('/').next()?.parse().ok());
        let tile = tile(&json);
        if !tile.lines.is_empty() {
            levels.entry(level.expect("an id")).or_default().push(tile);
        }
    }
    levels
}

fn bench(c: &mut Criterion) {
    let Some(folder) = std::env::var_os("CORNICHE_TILES") else {
        corniche_testing::skip("set CORNICHE_TILES to a folder of tiles as JSON");
        return;
    };
    for (level, tiles) in tiles(Path::new(&folder)) {
        let lay = |tile: &Tile| -> Vec<DrapedLine> {
            tile.lines.iter().flat_map(|line| drape(line, &tile.surface).lines).collect()
        };
        let laid: Vec<Vec<DrapedLine>> = tiles.iter().map(lay).collect();
        let vertices = || laid.iter().flatten().flat_map(|line| &line.vertices);
        let is_crossing = |vertex: &&DrapedVertex| !matches!(vertex, DrapedVertex::Source { .. });
        let (crossings, all) = (vertices().filter(is_crossing).count(), vertices().count());
        let sv_lines = || tiles.iter().flat_map(|tile| &tile.sv_lines);
        let segments: usize = sv_lines().map(|line| line.points().len() - 1).sum();

        let mut group = c.benchmark_group(format!("level {level}, {} tiles", tiles.len()));
        for (what, count) in [("crossings", crossings), ("vertices", all)] {
            group.throughput(Throughput::Elements(count as u64));
            group.bench_function(BenchmarkId::new("drape", format!("{count} {what}")), |b| {
                b.iter(|| {
                    for tile in &tiles {
                        for line in &tile.lines {
                            black_box(drape(black_box(line), &tile.surface));
                        }
                    }
                });
            });
        }
        let straight: Vec<Vec<Polyline>> =
            tiles.iter().map(|tile| straight_lines(&tile.surface)).collect();
        let count = |(tile, lines): (&Tile, &Vec<Polyline>)| -> usize {
            lines
                .iter()
                .flat_map(|line| drape(line, &tile.surface).lines)
                .map(|line| line.vertices.iter().filter(is_crossing).count())
                .sum()
        };
        let crossings: usize = tiles.iter().zip(&straight).map(count).sum();
        group.throughput(Throughput::Elements(crossings as u64));
        group.bench_function(
            BenchmarkId::new("drape, straight across", format!("{crossings} crossings")),
            |b| {
                b.iter(|| {
                    for (tile, lines) in tiles.iter().zip(&straight) {
                        for line in lines {
                            black_box(drape(black_box(line), &tile.surface));
                        }
                    }
                });
            },
        );
        group.throughput(Throughput::Elements(all as u64));
        group.bench_function(BenchmarkId::new("positions", format!("{all} vertices")), |b| {
            b.iter(|| {
                for (tile, lines) in tiles.iter().zip(&laid) {
                    for line in lines {
                        black_box(positions(black_box(line), &tile.surface).expect("a laid line"));
                    }
                }
            });
        });
        group.throughput(Throughput::Elements(segments as u64));
        group.bench_function(BenchmarkId::new("extrude", format!("{segments} segments")), |b| {
            b.iter(|| {
                for tile in &tiles {
                    for line in &tile.sv_lines {
                        black_box(extrude(black_box(line), &tile.surface, tile.margin_steps));
                    }
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
