//! A made-up net of roads for an elevation raster that has none, as an extract: for measuring, not for maps.
//!
//! ```sh
//! cargo run -p corniche-pipeline --example synthetic_roads -- DEM OUT.osm.pbf
//! ```
//!
//! Sixty roads, each from a random place in a random direction, wind over the raster with a node every eight cells. The
//! net depends on the raster's size and place alone: the same raster gives the same bytes. All ways carry
//! `note=synthetic`.
#![allow(clippy::print_stderr, reason = "a program to run by hand")]

use std::{error::Error, fs, process::ExitCode};

use gdal::{
    Dataset,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
};

/// Their values of `highway`, in turn.
const KINDS: [&str; 5] = ["secondary", "tertiary", "unclassified", "residential", "track"];
const ROADS: usize = 60;
const POINTS: usize = 60;
/// From one node to the next.
const STEP_CELLS: f64 = 8.0;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [dem, out] = args.as_slice() else {
        eprintln!("usage: synthetic_roads DEM OUT.osm.pbf");
        return ExitCode::from(2);
    };
    match lines_on(dem).and_then(|lines| Ok(fs::write(out, extract(&lines))?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: no synthetic roads on {dem}: {error}");
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
    let mut random = Random(9);
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

/// A line within a raster of this size, in cells; it turns back into it where it would leave.
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

/// splitmix64 (Steele, Lea & Flood 2014, *Fast Splittable Pseudorandom Number Generators*).
struct Random(u64);

impl Random {
    /// From 0 to below 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The lines as PBF: plain nodes, nothing packed away.
fn extract(lines: &[Vec<[f64; 2]>]) -> Vec<u8> {
    let (mut nodes, mut ways) = (Vec::new(), Vec::new());
    let mut next_id = 1_i64;
    for (way, line) in lines.iter().enumerate() {
        let mut refs = Vec::new();
        for (index, [lon_deg, lat_deg]) in line.iter().enumerate() {
            let mut node = Vec::new();
            number(&mut node, 1, zigzag(next_id));
            number(&mut node, 8, zigzag((lat_deg * 1e7).round() as i64));
            number(&mut node, 9, zigzag((lon_deg * 1e7).round() as i64));
            bytes(&mut nodes, 1, &node);
            // The first as it is, then differences.
            varint(&mut refs, zigzag(if index == 0 { next_id } else { 1 }));
            next_id += 1;
        }
        let mut record = Vec::new();
        number(&mut record, 1, way as u64 + 1);
        // Strings 1 and 2 are `highway` and `note`, 3 is `synthetic`; then come the kinds.
        bytes(&mut record, 2, &[1, 2]);
        bytes(&mut record, 3, &[4 + (way % KINDS.len()) as u8, 3]);
        bytes(&mut record, 8, &refs);
        bytes(&mut ways, 3, &record);
    }
    let mut strings = Vec::new();
    for text in ["", "highway", "note", "synthetic"].into_iter().chain(KINDS) {
        bytes(&mut strings, 1, text.as_bytes());
    }
    let mut header = Vec::new();
    bytes(&mut header, 4, b"OsmSchema-V0.6");
    let mut file = blob("OSMHeader", &header);
    for group in [nodes, ways] {
        let mut block = Vec::new();
        bytes(&mut block, 1, &strings);
        bytes(&mut block, 2, &group);
        file.extend(blob("OSMData", &block));
    }
    file
}

/// A block with its frame: its header's length, its header, the block as it is.
fn blob(kind: &str, block: &[u8]) -> Vec<u8> {
    let (mut body, mut header) = (Vec::new(), Vec::new());
    bytes(&mut body, 1, block);
    bytes(&mut header, 1, kind.as_bytes());
    number(&mut header, 3, body.len() as u64);
    let mut file = (header.len() as u32).to_be_bytes().to_vec();
    file.extend(header);
    file.extend(body);
    file
}

/// A field that holds bytes, in the wire format of protocol buffers.
fn bytes(out: &mut Vec<u8>, field: u64, value: &[u8]) {
    varint(out, field << 3 | 2);
    varint(out, value.len() as u64);
    out.extend(value);
}

/// A field that holds a number.
fn number(out: &mut Vec<u8>, field: u64, value: u64) {
    varint(out, field << 3);
    varint(out, value);
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn zigzag(value: i64) -> u64 {
    (value << 1 ^ value >> 63) as u64
}
