//! Measures how many TIN edges per second a line is draped across, and the time of clipping and
//! extruding.

#![expect(
    missing_docs,
    reason = "criterion's macros create public functions without documentation"
)]

use std::hint::black_box;

use corniche_drape::{DrapedVertex, clip_closed, drape, extrude};
use corniche_geom::{LatticeBounds, LatticePoint, Polyline};
use corniche_tin::{Placement, Surface, Tin, TinVertex};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// A 30 m cell, so that a lattice step is less than a millimetre.
const NODE_STEPS: i64 = 1 << 15;

/// All 257² nodes of a tile, triangulated with diagonals in no pattern.
fn full_tile() -> Surface {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..257_u32 {
        for column in 0..257_u32 {
            let (x, y) = (f64::from(column) / 17.0, f64::from(row) / 23.0);
            let height_q = (1e4 * (x.sin() + y.cos())) as i32;
            vertices.push(TinVertex { row: row as u16, column: column as u16, height_q });
            if row == 256 || column == 256 {
                continue;
            }
            let (nw, sw) = (row * 257 + column, (row + 1) * 257 + column);
            if row.wrapping_mul(2_654_435_761).wrapping_add(column.wrapping_mul(40_503)) >> 7 & 1
                == 0
            {
                triangles.extend([[nw, sw, sw + 1], [nw, sw + 1, nw + 1]]);
            } else {
                triangles.extend([[nw, sw, nw + 1], [sw, sw + 1, nw + 1]]);
            }
        }
    }
    let tin = Tin::new(vertices, &triangles).expect("a regular grid is a TIN");
    let corner = LatticePoint::new(1 << 33, 1 << 33);
    Surface::new(&tin, Placement { corner, node_steps: [NODE_STEPS; 2], quantum_m: 1.0 / 64.0 })
}

/// Winding lines through the tile, with segments of about `segment_steps`.
fn roads(bounds: LatticeBounds, segment_steps: f64) -> Vec<Polyline> {
    let mut seed = 12_345_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (width, height) =
        ((bounds.max.u - bounds.min.u) as f64, (bounds.max.v - bounds.min.v) as f64);
    let mut roads = Vec::new();
    for _ in 0..200 {
        let (mut u, mut v) = (random() * width, random() * height);
        let mut heading = random() * std::f64::consts::TAU;
        let mut points = Vec::new();
        for _ in 0..200 {
            points.push(LatticePoint::new(bounds.min.u + u as i64, bounds.min.v + v as i64));
            heading += random() - 0.5;
            u = (u + heading.cos() * segment_steps).clamp(0.0, width);
            v = (v + heading.sin() * segment_steps).clamp(0.0, height);
        }
        roads.extend(Polyline::new(points).ok());
    }
    roads
}

fn bench(c: &mut Criterion) {
    let surface = full_tile();
    let bounds = LatticeBounds::around(surface.points()).expect("a full tile");
    let mut group = c.benchmark_group("drape::drape, crossings");
    for cells in [1.0, 4.0, 16.0] {
        let roads = roads(bounds, cells * NODE_STEPS as f64);
        let crossings = |road: &Polyline| {
            let lines = drape(road, &surface).lines;
            let vertices = lines.iter().flat_map(|line| &line.vertices);
            vertices.filter(|vertex| !matches!(vertex, DrapedVertex::Source { .. })).count() as u64
        };
        group.throughput(Throughput::Elements(roads.iter().map(crossings).sum()));
        group.bench_function(BenchmarkId::new("segments of cells", cells), |b| {
            b.iter(|| {
                for road in &roads {
                    black_box(drape(black_box(road), &surface));
                }
            });
        });
    }
    group.finish();

    let roads = roads(bounds, NODE_STEPS as f64);
    let segments: u64 = roads.iter().map(|road| road.points().len() as u64 - 1).sum();
    let quarter = LatticeBounds {
        min: bounds.min,
        max: LatticePoint::new(
            bounds.min.u.midpoint(bounds.max.u),
            bounds.min.v.midpoint(bounds.max.v),
        ),
    };
    let mut group = c.benchmark_group("drape, segments");
    group.throughput(Throughput::Elements(segments));
    group.bench_function("clip", |b| {
        b.iter(|| {
            for road in &roads {
                black_box(clip_closed(black_box(road), &quarter));
            }
        });
    });
    for margin_cells in [1, 4] {
        group.bench_function(BenchmarkId::new("extrude, margin in cells", margin_cells), |b| {
            let margin = margin_cells * NODE_STEPS;
            b.iter(|| {
                for road in &roads {
                    black_box(extrude(black_box(road), &surface, margin));
                }
            });
        });
    }
    group.finish();
    c.bench_function("tin::Surface::new, 131 072 triangles", |b| b.iter(full_tile));
}

criterion_group!(benches, bench);
criterion_main!(benches);
