//! Times the work of a build on every tile: triangulating it, and measuring TINs against the finest
//! raster.

#![expect(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::hint::black_box;

use corniche_geom::HeightGrid;
use corniche_testing::srtm_heights;
use corniche_tin::{
    TinSpec, TriangleBuckets, WindowPlacement, height_quantum_m, measure, normals, triangulate,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Mountains: sines over seven octaves with amplitudes that halve, in directions that do not
/// repeat.
fn mountains(nodes: usize) -> HeightGrid {
    HeightGrid::from_fn(nodes, nodes, |column, row| {
        (0_u8..7)
            .map(|octave| {
                let frequency = 0.012 * f32::from(1_u16 << octave);
                let (sin, cos) = (f32::from(octave) * 2.4).sin_cos();
                let along = (column as f32 * cos + row as f32 * sin) * frequency;
                let across = (row as f32 * cos - column as f32 * sin) * frequency;
                600.0 * 0.5_f32.powi(i32::from(octave)) * along.sin() * (across * 1.3).cos()
            })
            .sum()
    })
}

fn spec(max_error_m: f64) -> TinSpec {
    TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) }
}

fn triangulating(c: &mut Criterion) {
    let mut group = c.benchmark_group("tin::triangulate");
    group.sample_size(10);
    for nodes in [257, 1025] {
        let heights = mountains(nodes + 2);
        group.throughput(Throughput::Elements((nodes * nodes) as u64));
        for max_error_m in [2.0, 5.0, 20.0] {
            let id = BenchmarkId::new(nodes.to_string(), max_error_m);
            group.bench_function(id, |b| {
                b.iter(|| triangulate(black_box(&heights), spec(max_error_m)));
            });
        }
    }
    // A tile of the Alps with gaps; `scripts/bench-tin` compares more of them with another
    // triangulator.
    if let Some(heights) = srtm_heights("liechtenstein/N47E010.hgt", 600, 400) {
        group.throughput(Throughput::Elements(257 * 257));
        for max_error_m in [2.0, 5.0, 20.0] {
            group.bench_function(BenchmarkId::new("srtm", max_error_m), |b| {
                b.iter(|| triangulate(black_box(&heights), spec(max_error_m)));
            });
        }
    }
    group.finish();
}

fn measuring(c: &mut Criterion) {
    let mut group = c.benchmark_group("tin::measure");
    let heights = mountains(259);
    let window = heights.window(1, 1, 257, 257);
    group.throughput(Throughput::Elements(257 * 257));
    let tin = triangulate(&heights, spec(5.0)).expect("the tile is valid");
    let buckets = TriangleBuckets::new(&tin, spec(5.0).quantum_m);
    for stride in [1, 4, 64] {
        let placement =
            WindowPlacement { column: 128 * (stride - 1), row: 128 * (stride - 1), stride };
        group.bench_function(BenchmarkId::new("stride", stride), |b| {
            b.iter(|| measure(black_box(&buckets), &window, placement, |_, _, _| ()));
        });
    }
    group.bench_function("buckets", |b| b.iter(|| TriangleBuckets::new(black_box(&tin), 0.125)));
    group.bench_function("normals", |b| {
        b.iter(|| normals(black_box(&heights), &tin, 30.0.into(), 0));
    });
    group.finish();
}

criterion_group!(benches, triangulating, measuring);
criterion_main!(benches);
