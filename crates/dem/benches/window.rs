//! Measures how fast windows of heights are read, for each way in which nodes come from samples.
#![expect(missing_docs, reason = "criterion's macros make public items")]
#![expect(clippy::unwrap_used, reason = "a bench has nobody to tell")]

use std::hint::black_box;
use std::path::PathBuf;

use corniche_dem::{Dem, OpenOptions, PlanOptions};
use corniche_geom::{NodeIndex, NodeWindow};
use corniche_testing::Raster;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Samples along each side of the raster, and nodes along each side of the window.
const SAMPLES: usize = 3000;
const NODES: usize = 1024;

/// A rolling ground of 30 m samples in UTM, or of 0.0003° in degrees, optionally with a void in
/// every `void_every` samples.
fn ground(folder: &std::path::Path, epsg: u32, void_every: usize) -> PathBuf {
    let path = folder.join(format!("{epsg}-{void_every}.tif"));
    let (west, north, step) =
        if epsg == 4326 { (8.5, 47.5, 0.0003) } else { (450_000.0, 5_250_000.0, 30.0) };
    let raster = Raster::new(epsg, [SAMPLES; 2], [west, step, 0.0, north, 0.0, -step]);
    let height = |k: usize| {
        let (c, r) = ((k % SAMPLES) as f32, (k / SAMPLES) as f32);
        if k % void_every == void_every - 1 {
            f32::NAN
        } else {
            900.0 + 300.0 * (c / 90.0).sin() * (r / 70.0).cos()
        }
    };
    raster.write_values(&path, (0..SAMPLES * SAMPLES).map(height).collect());
    path
}

/// A grid with square cells; positions in degrees are transformed to UTM.
fn options(cell_m: f64) -> PlanOptions {
    PlanOptions {
        crs: Some("utm".to_owned()),
        cell: Some(cell_m.into()),
        fill_voids: 32,
        ..PlanOptions::default()
    }
}

fn window(c: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    let mut group = c.benchmark_group("dem::Reader::window");
    group.throughput(Throughput::Elements((NODES * NODES) as u64)).sample_size(20);
    let never = usize::MAX;
    for (name, epsg, cell_m, void_every) in [
        ("aligned", 32632, 30.0, never),
        ("aligned, voids filled", 32632, 30.0, 1000),
        ("bilinear", 4326, 25.0, never),
        ("bilinear, voids filled", 4326, 25.0, 1000),
        ("average", 4326, 60.0, never),
    ] {
        let file = ground(folder.path(), epsg, void_every);
        let dem = Dem::open(&[file], &OpenOptions::default()).unwrap();
        let plan = dem.plan(&options(cell_m)).unwrap();
        let middle = |low: i64, high: i64| i64::midpoint(low, high);
        let corner = NodeIndex {
            i: middle(plan.south_west.i, plan.north_east.i) - NODES as i64 / 2,
            j: middle(plan.south_west.j, plan.north_east.j) + NODES as i64 / 2,
        };
        let window = NodeWindow { corner, stride: 1, columns: NODES, rows: NODES };
        let mut reader = dem.reader(&plan);
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter(|| reader.window(black_box(window)).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, window);
criterion_main!(benches);
