//! Times triangulation of real grids, for `scripts/bench-tin`.
//!
//! `time_triangulate FILE SIDE` reads square grids of SIDE × SIDE nodes, halo included, one after
//! another: 32-bit floats, little-endian, row by row from the north, NaN in gaps. For every
//! tolerance on a line of standard input it triangulates all of them and prints one line: CPU time
//! in seconds, vertices, triangles.

use std::io::{BufRead, Write};

use corniche_geom::HeightGrid;
use corniche_tin::{TinSpec, height_quantum_m, triangulate};
use rustix::time::{ClockId, clock_gettime};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, side] = &arguments[..] else {
        return Err("usage: time_triangulate FILE SIDE".into());
    };
    let side: usize = side.parse()?;
    let bytes = std::fs::read(file)?;
    let grids: Vec<HeightGrid> = bytes
        .chunks_exact(4 * side * side)
        .map(|grid| {
            let heights =
                grid.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            HeightGrid::new(side, side, heights.collect())
        })
        .collect();
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        let max_error_m: f64 = line?.trim().parse()?;
        let spec = TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) };
        let (mut vertices, mut triangles) = (0, 0);
        let before_s = cpu_s();
        for grid in &grids {
            let tin = triangulate(grid, spec)?;
            vertices += tin.vertices().len();
            triangles += tin.triangles().len();
        }
        let spent_s = cpu_s() - before_s;
        writeln!(out, "{spent_s:.6} {vertices} {triangles}")?;
        out.flush()?;
    }
    Ok(())
}

/// The CPU time of this process so far, in seconds.
fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
