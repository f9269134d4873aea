//! Measures how well a package's ground can be shaded: from the reliefs of its tiles, and from the
//! normals at its triangles' corners.
//!
//! ```sh
//! cargo run --release -p corniche-pipeline --example relief_shading -- PACKAGE DEM…
//! ```
//!
//! For each level it prints the bytes of a relief, the milliseconds to decode one, and, at all
//! nodes with ground, how the shading (light from the north-west, 45° high, 0 to 255) compares with
//! that of the level's own raster. The raster's shading is what `gdaldem hillshade` computes, apart
//! from the shape of the filter. Two figures are compared: the root mean square of the difference
//! in grey levels, and the local contrast, which is the median over blocks of 8 × 8 nodes of the
//! standard deviation within the block. On the finest level the raster is the DEM at full
//! resolution. The DEM must be read with the settings that the package records; this example
//! applies only those of the grid.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program to run by hand")]

use std::{error::Error, path::PathBuf, process::ExitCode, time::Instant};

use corniche_dem::{Dem, OpenOptions, PlanOptions};
use corniche_geom::{HeightGrid, LatticePoint, NodeIndex, NodeWindow, TILE_NODES, barycentric};
use corniche_tileset::{FilePackage, Sections, TileTerrain, decode, payload_sizes};
use corniche_tin::{Placement, Surface, decode_normal};

fn main() -> ExitCode {
    let args: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [package, dem @ ..] = args.as_slice() else {
        eprintln!("usage: relief_shading PACKAGE DEM…");
        return ExitCode::from(2);
    };
    match run(package, dem) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}: {error}", package.display());
            ExitCode::FAILURE
        }
    }
}

/// Grey levels at the nodes of a tile; NaN at nodes without one.
type Greys = Vec<f64>;

/// Sums over the tiles of a level.
#[derive(Default)]
struct Level {
    tiles: u32,
    most_bytes: u64,
    bytes: u64,
    decode_s: f64,
    /// Sum and number of squared differences: of the relief, of the triangles.
    squares: [(f64, u64); 2],
    /// Contrasts of blocks: of the raster, the relief, the triangles.
    contrasts: [Vec<f64>; 3],
}

fn run(path: &std::path::Path, files: &[PathBuf]) -> Result<(), Box<dyn Error>> {
    let package = FilePackage::open(path)?;
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let settings = &manifest.settings;
    let dem = Dem::open(
        files,
        &OpenOptions { nodata: settings.nodata.clone(), ..OpenOptions::default() },
    )?;
    let plan = dem.plan(&PlanOptions {
        crs: settings.crs.clone(),
        cell: settings.cell_m,
        cell_every: settings.cell_every,
        scale_latitude_deg: settings.scale_latitude_deg,
        fill_voids: settings.fill_voids,
        ..PlanOptions::default()
    })?;
    if plan.frame != *frame {
        return Err("the grid of the elevation files differs from the package's grid".into());
    }
    let mut reader = dem.reader(&plan);
    let mut levels: Vec<Level> = (0..=frame.max_level()).map(|_| Level::default()).collect();
    for id in package.tile_ids()? {
        let Some(bytes) = package.tile(id)? else { continue };
        let quantum_m = manifest.vertical.quantum_m;
        let read = |sections| decode(&bytes, id, frame, quantum_m, sections);
        let begun = Instant::now();
        let relief = read(Sections::RELIEF)?.relief;
        let decode_s = begun.elapsed().as_secs_f64();
        let (Some(relief), Some(terrain)) = (relief, read(Sections::TERRAIN)?.terrain) else {
            continue;
        };
        let window = frame.tile_window(id);
        let NodeIndex { i, j } = window.corner;
        // The raster of a level has every `stride`-th node of the finest one.
        let (side, stride) = (TILE_NODES + 2, window.stride as usize);
        let all = (side - 1) * stride + 1;
        let corner = NodeIndex { i: i - window.stride, j: j + window.stride };
        let wide = NodeWindow { corner, stride: 1, columns: all, rows: all };
        let finest = reader.window(wide)?.heights;
        let raster = HeightGrid::from_fn(side, side, |column, row| {
            finest.height(column * stride, row * stride).unwrap_or(f32::NAN)
        });
        let cell = frame.level_cell(id.z());
        let slopes = |heights: &HeightGrid, halo: usize| -> Greys {
            nodes()
                .map(|[column, row]| {
                    let at = [column + halo, row + halo];
                    if heights.has_height(at[0], at[1]) {
                        grey(corniche_tin::gradient(heights, at, cell))
                    } else {
                        f64::NAN
                    }
                })
                .collect()
        };
        let exact = slopes(&raster, 1);
        let of_relief = slopes(relief.heights(), 0);
        let of_triangles = of_triangles(&terrain, Placement::of_tile(frame, id, quantum_m));
        let level = &mut levels[usize::from(id.z())];
        let stored = payload_sizes(&bytes, id)?.relief.stored;
        level.tiles += 1;
        level.bytes += stored;
        level.most_bytes = level.most_bytes.max(stored);
        level.decode_s += decode_s;
        for (k, greys) in [&of_relief, &of_triangles].into_iter().enumerate() {
            for (exact, grey) in exact.iter().zip(greys) {
                if !exact.is_nan() && !grey.is_nan() {
                    level.squares[k].0 += (exact - grey).powi(2);
                    level.squares[k].1 += 1;
                }
            }
        }
        for (contrasts, greys) in
            level.contrasts.iter_mut().zip([&exact, &of_relief, &of_triangles])
        {
            contrasts.extend(block_contrasts(greys));
        }
    }
    println!(
        "| level | tiles | bytes a tile | most | decode ms | RMS relief | RMS triangles | contrast raster | relief | triangles |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (number, level) in levels.iter_mut().enumerate().filter(|(_, level)| level.tiles > 0) {
        let [relief, triangles] =
            level.squares.map(|(sum, count)| (sum / count.max(1) as f64).sqrt());
        let [a, b, c] = level.contrasts.each_mut().map(|contrasts| median(contrasts));
        println!(
            "| {number} | {} | {} | {} | {:.1} | {relief:.2} | {triangles:.2} | {a:.2} | {b:.2} | {c:.2} |",
            level.tiles,
            level.bytes / u64::from(level.tiles),
            level.most_bytes,
            1e3 * level.decode_s / f64::from(level.tiles),
        );
    }
    Ok(())
}

/// The inner nodes of a tile: those with a neighbour on each side.
fn nodes() -> impl Iterator<Item = [usize; 2]> {
    (1..TILE_NODES - 1).flat_map(|row| (1..TILE_NODES - 1).map(move |column| [column, row]))
}

/// Shading of ground with these slopes east and north, in metres per metre.
fn grey([east, north]: [f64; 2]) -> f64 {
    let length = (east * east + north * north + 1.0).sqrt();
    // The direction towards the light: (−1, 1, √2) / 2.
    let lit = (east - north + std::f64::consts::SQRT_2) / (2.0 * length);
    255.0 * lit.max(0.0)
}

/// Shading at the nodes from the normals at the corners of the triangles, interpolated as a GPU
/// does.
fn of_triangles(terrain: &TileTerrain, placement: Placement) -> Greys {
    let surface = Surface::new(&terrain.tin, placement);
    let corner = placement.corner;
    let [u_step, v_step] = placement.node_steps;
    nodes()
        .map(|[column, row]| {
            let point = LatticePoint::new(
                corner.u + column as i64 * u_step,
                corner.v - row as i64 * v_step,
            );
            let Some(triangle) = surface.locate(point) else { return f64::NAN };
            let corners = surface.triangles()[triangle as usize];
            let at = |index: u32| {
                let point = surface.points()[index as usize];
                [point.u as f64, point.v as f64]
            };
            let [a, b, c] = corners.map(at);
            let weights = barycentric([point.u as f64, point.v as f64], a, b, c);
            let mut normal = [0.0; 3];
            for (weight, index) in weights.into_iter().zip(corners) {
                let parts = decode_normal(terrain.normals[index as usize]);
                (0..3).for_each(|axis| normal[axis] += weight * f64::from(parts[axis]));
            }
            grey([-normal[0] / normal[2], -normal[1] / normal[2]])
        })
        .collect()
}

/// Standard deviations within blocks of 8 × 8 nodes that all have a grey.
fn block_contrasts(greys: &Greys) -> Vec<f64> {
    const BLOCK: usize = 8;
    let side = TILE_NODES - 2;
    let blocks = side / BLOCK;
    (0..blocks * blocks)
        .filter_map(|block| {
            let (left, top) = (block % blocks * BLOCK, block / blocks * BLOCK);
            let inside =
                (0..BLOCK * BLOCK).map(|k| greys[(top + k / BLOCK) * side + left + k % BLOCK]);
            let count = (BLOCK * BLOCK) as f64;
            let mean = inside.clone().sum::<f64>() / count;
            let variance = inside.map(|grey| (grey - mean).powi(2)).sum::<f64>() / count;
            (!variance.is_nan()).then(|| variance.sqrt())
        })
        .collect()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
