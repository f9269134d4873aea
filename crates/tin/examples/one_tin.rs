//! Times one TIN over a whole raster: `one_tin FILE COLUMNS ROWS MAX_ERROR_M [RUNS]`.
//!
//! FILE holds COLUMNS × ROWS heights in metres, 32-bit little-endian floats, row by row from the north.
//! Prints triangles, vertices and the seconds of the fastest run, to compare with other triangulators.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{env, error::Error, fs, time::Instant};

use corniche_geom::HeightGrid;
use corniche_tin::{TinSpec, height_quantum_m, triangulate};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [file, columns, rows, max_error_m, runs @ ..] = arguments.as_slice() else {
        return Err("usage: one_tin FILE COLUMNS ROWS MAX_ERROR_M [RUNS]".into());
    };
    let (columns, rows): (usize, usize) = (columns.parse()?, rows.parse()?);
    let max_error_m: f64 = max_error_m.parse()?;
    let runs: usize = runs.first().map_or(Ok(1), |text| text.parse())?;
    let bytes = fs::read(file)?;
    if bytes.len() != columns * rows * 4 {
        return Err(format!("{file} has {} bytes, not {columns} × {rows} × 4", bytes.len()).into());
    }
    let values: Vec<f32> =
        bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    // The halo is gap: nothing lies beyond the raster.
    let heights = HeightGrid::from_fn(columns + 2, rows + 2, |column, row| {
        let inside = (1..=columns).contains(&column) && (1..=rows).contains(&row);
        if inside { values[(row - 1) * columns + column - 1] } else { f32::NAN }
    });
    let spec = TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) };
    let mut seconds = f64::INFINITY;
    let mut tin = triangulate(&heights, spec)?;
    for _ in 0..runs {
        let start = Instant::now();
        tin = triangulate(&heights, spec)?;
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    println!(
        "{} triangles, {} vertices, {seconds:.3} s",
        tin.triangles().len(),
        tin.vertices().len()
    );
    Ok(())
}
