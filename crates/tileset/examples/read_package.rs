//! Reads a package without GDAL: prints its tiles, the longest named road of the largest tile with
//! heights, and the ground at the middle of that tile.
//!
//! ```sh
//! cargo run -p corniche-tileset --example read_package -- out.pmtiles
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{env, error::Error, path::Path};

use corniche_drape::positions;
use corniche_tileset::{FilePackage, Sections};
use corniche_tin::{Placement, Surface};

fn main() -> Result<(), Box<dyn Error>> {
    let file = env::args().nth(1).ok_or("usage: read_package PACKAGE.pmtiles")?;
    let package = FilePackage::open(Path::new(&file))?;
    let manifest = package.manifest();
    let frame = &manifest.frame;
    println!("{} in {}, heights: {}", file, manifest.crs, manifest.vertical.datum);
    let ids = package.tile_ids()?;
    for level in &manifest.levels {
        let tiles = ids.iter().filter(|id| id.z() == level.level).count();
        println!("level {}: {tiles} tiles, at most {} m off", level.level, level.max_error_m);
    }

    // A finest tile contains every road at full detail. The tile with the most bytes is probably
    // the most interesting one.
    let mut largest = None;
    for &id in ids.iter().filter(|id| id.z() == frame.max_level()) {
        let bytes = package.tile(id)?.map_or(0, |bytes| bytes.len());
        largest = largest.max(Some((bytes, id)));
    }
    let Some((_, id)) = largest else { return Ok(()) };
    let Some(tile) = package.payload(id, Sections::ALL)? else { return Ok(()) };
    let Some(terrain) = &tile.terrain else { return Ok(()) };
    println!(
        "tile {id}: {} triangles, {} lines",
        terrain.tin.triangles().len(),
        tile.roads_geo.len()
    );

    // The tile's triangles on the lattice, on which ground and roads have integer coordinates.
    let quantum_m = manifest.vertical.quantum_m;
    let surface = Surface::new(&terrain.tin, Placement::of_tile(frame, id, quantum_m));
    let lines = tile.roads_geo.iter().filter_map(|road| {
        let named = tile.attributes.iter().find(|record| record.way_id == road.way_id)?;
        (!named.attributes.name.is_empty()).then_some((road, &named.attributes.name))
    });
    if let Some((road, name)) = lines.max_by_key(|(road, _)| road.line.vertices.len()) {
        println!("{name} (way {}):", road.way_id);
        for [u, v, height_m] in positions(&road.line, &surface)? {
            // The position is in working metres; divided by metres_per_unit it is in coordinates of
            // the CRS.
            let [x_m, y_m] = frame.position_of_fraction_m([u, v]);
            let [unit_x, unit_y] = manifest.metres_per_unit;
            println!("  {:.6} {:.6} {height_m:.2} m", x_m / unit_x, y_m / unit_y);
        }
    }

    let bounds = frame.tile_bounds(id);
    let middle_m =
        [f64::midpoint(bounds.min_x, bounds.max_x), f64::midpoint(bounds.min_y, bounds.max_y)];
    let ground = frame.snap(middle_m).and_then(|point| Some((surface.locate(point)?, point)));
    match ground {
        Some((triangle, point)) => {
            println!("ground at its middle: {:.2} m", surface.height_at_point_m(triangle, point));
        }
        None => println!("there is no ground at its middle"),
    }
    Ok(())
}
