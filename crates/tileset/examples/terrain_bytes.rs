//! Prints where the bytes of the ground are, and how fast they are written and read: one line per
//! package.
//!
//! ```sh
//! cargo run --release -p corniche-tileset --features write --example terrain_bytes -- A.pmtiles B.pmtiles
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{env, error::Error, path::Path, time::Instant};

use corniche_tileset::{FilePackage, PayloadContext, Sections, decode, encode, payload_sizes};

/// Each tile is written and read this many times; the fastest run counts.
const TIMES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "| package | tiles | vertices | triangles | bytes | bytes a triangle | bits a vertex | encode, µs a vertex | decode, µs a vertex |"
    );
    for file in env::args().skip(1) {
        let package = FilePackage::open(Path::new(&file))?;
        let context = PayloadContext::from_manifest(package.manifest());
        let PayloadContext { frame, quantum_m, .. } = context;
        let (mut tiles, mut vertices, mut triangles, mut bytes) = (0, 0, 0, 0);
        let mut seconds = [0.0; 2];
        for id in package.tile_ids()? {
            let Some(payload) = package.tile(id)? else { continue };
            let tile = decode(&payload, id, &frame, quantum_m, Sections::TERRAIN)?;
            let Some(ground) = &tile.terrain else { continue };
            tiles += 1;
            vertices += ground.tin.vertices().len();
            triangles += ground.tin.triangles().len();
            bytes += payload_sizes(&payload, id)?.terrain.stored;
            let mut fastest = [f64::INFINITY; 2];
            for _ in 0..TIMES {
                let begin = Instant::now();
                let encoded = encode(&tile, &context)?;
                let middle = Instant::now();
                decode(&encoded.bytes, id, &frame, quantum_m, Sections::TERRAIN)?;
                let end = Instant::now();
                for (least, took) in fastest.iter_mut().zip([middle - begin, end - middle]) {
                    *least = least.min(took.as_secs_f64());
                }
            }
            seconds = [seconds[0] + fastest[0], seconds[1] + fastest[1]];
        }
        let vertices = f64::from(u32::try_from(vertices)?);
        let name = Path::new(&file).file_stem().unwrap_or_default().to_string_lossy();
        print!("| {name} | {tiles} | {vertices} | {triangles} | {bytes} |");
        print!(" {:.3} |", bytes as f64 / f64::from(u32::try_from(triangles)?));
        print!(" {:.2} |", 8.0 * bytes as f64 / vertices);
        for sum in seconds {
            print!(" {:.3} |", 1e6 * sum / vertices);
        }
        println!();
    }
    Ok(())
}
