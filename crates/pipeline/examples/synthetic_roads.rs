//! Generates a network of synthetic roads for an elevation raster, as an extract: for measurements,
//! not for maps.
//!
//! ```sh
//! cargo run -p corniche-pipeline --example synthetic_roads -- DEM OUT.osm.pbf
//! ```
//!
//! Sixty roads, each from a random position in a random direction, wind over the raster with a node
//! every eight cells. The network depends only on the raster's size and position: the same raster
//! gives the same bytes. All ways have the tag `note=synthetic`.
#![allow(clippy::print_stderr, reason = "a program to run by hand")]

use std::{error::Error, fs, process::ExitCode};

use corniche_testing::{
    Random,
    pbf::{self, WayToWrite},
};
use gdal::{
    Dataset,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
};

/// The roads' values of `highway`, in turn.
const KINDS: [&str; 5] = ["secondary", "tertiary", "unclassified", "residential", "track"];
const ROADS: usize = 60;
const POINTS: usize = 60;
/// The distance from one node to the next.
const STEP_CELLS: f64 = 8.0;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [dem, out] = args.as_slice() else {
        eprintln!("usage: synthetic_roads DEM OUT.osm.pbf");
        return ExitCode::from(2);
    };
    match lines_on(dem).and_then(|lines| Ok(fs::write(out, extract(lines))?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: cannot write synthetic roads for {dem}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Longitudes and latitudes of the nodes of each road.
fn lines_on(dem: &str) -> Result<Vec<Vec<[f64; 2]>>, Box<dyn Error>> {
    let dataset = Dataset::open(dem)?;
    let (columns, rows) = dataset.raster_size();
    let transform = dataset.geo_transform()?;
    let traditional = |mut reference: SpatialRef| {
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        reference
    };
    let of_dem = traditional(dataset.spatial_ref()?);
    let to_degrees = CoordTransform::new(&of_dem, &traditional(SpatialRef::from_epsg(4326)?))?;
    let mut random = Random::new(9);
    let mut lines = Vec::new();
    for _ in 0..ROADS {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for [column, row] in winding([columns as f64, rows as f64], &mut random) {
            x.push(transform[0] + column * transform[1] + row * transform[2]);
            y.push(transform[3] + column * transform[4] + row * transform[5]);
        }
        to_degrees.transform_coords(&mut x, &mut y, &mut [])?;
        lines.push(x.into_iter().zip(y).map(|(lon_deg, lat_deg)| [lon_deg, lat_deg]).collect());
    }
    Ok(lines)
}

/// A line within a raster of this size, in cells; it turns back where it would leave the raster.
fn winding(size: [f64; 2], random: &mut Random) -> Vec<[f64; 2]> {
    let mut at = size.map(|side| side * (0.1 + 0.8 * random.share()));
    let mut heading = std::f64::consts::TAU * random.share();
    let mut points = vec![at];
    while points.len() < POINTS {
        heading += 0.9 * (random.share() - 0.5);
        let next = [at[0] + STEP_CELLS * heading.cos(), at[1] + STEP_CELLS * heading.sin()];
        let is_inside = [0, 1].iter().all(|&axis| (2.0..size[axis] - 2.0).contains(&next[axis]));
        if is_inside {
            at = next;
            points.push(at);
        } else {
            heading += 1.0;
        }
    }
    points
}

/// Encodes the lines as an extract: ways of all kinds in turn.
fn extract(lines: Vec<Vec<[f64; 2]>>) -> Vec<u8> {
    let texts: Vec<&str> = ["highway", "note", "synthetic"].into_iter().chain(KINDS).collect();
    let kinds = KINDS.iter().cycle();
    let ways: Vec<WayToWrite<'_>> = lines
        .into_iter()
        .zip(kinds)
        .map(|(points_deg, kind)| {
            let tags = vec![("highway", *kind), ("note", "synthetic")];
            WayToWrite { tags, points_deg }
        })
        .collect();
    pbf::extract(&texts, &ways)
}
