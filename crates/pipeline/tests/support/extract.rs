//! Small extracts, written as PBF by hand: plain nodes, ways with one tag, nothing packed.

use std::{fs, path::Path};

use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};

use super::{EPSG, Raster};

/// A straight road from one (column, row) of a raster to another, fractions allowed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightRoad {
    pub(crate) from: [f64; 2],
    pub(crate) to: [f64; 2],
}

/// Writes roads as an extract; the first has way id 1.
pub(crate) fn write(path: &Path, raster: &Raster, roads: &[StraightRoad]) {
    let line = |road: &StraightRoad| [road.from, road.to].map(|at| to_degrees(raster, at)).to_vec();
    write_lines(path, &roads.iter().map(line).collect::<Vec<_>>());
}

/// Writes roads, given by longitude and latitude, as an extract; the first has way id 1. Coordinates are rounded to 1e-7
/// degrees.
pub(crate) fn write_lines(path: &Path, lines_deg: &[Vec<[f64; 2]>]) {
    let (mut nodes, mut ways) = (Vec::new(), Vec::new());
    let mut last = 0_i64;
    for (way, line) in (1_i64..).zip(lines_deg) {
        let mut refs = Vec::new();
        for (index, [lon_deg, lat_deg]) in line.iter().enumerate() {
            last += 1;
            let mut node = Vec::new();
            number(&mut node, 1, zigzag(last));
            number(&mut node, 8, zigzag((lat_deg * 1e7).round() as i64));
            number(&mut node, 9, zigzag((lon_deg * 1e7).round() as i64));
            bytes(&mut nodes, 1, &node);
            varint(&mut refs, zigzag(if index == 0 { last } else { 1 }));
        }
        let mut record = Vec::new();
        number(&mut record, 1, way as u64);
        // highway=primary: strings 1 and 2 of the table.
        bytes(&mut record, 2, &[1]);
        bytes(&mut record, 3, &[2]);
        bytes(&mut record, 8, &refs);
        bytes(&mut ways, 3, &record);
    }
    let mut strings = Vec::new();
    for text in ["", "highway", "primary"] {
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
    fs::write(path, file).unwrap();
}

/// Longitude and latitude of a (column, row) of a raster.
fn to_degrees(raster: &Raster, at: [f64; 2]) -> [f64; 2] {
    utm_to_degrees(&[raster.position_m(at)])[0]
}

/// Longitude and latitude of positions in the rasters' CRS.
pub(crate) fn utm_to_degrees(positions_m: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let reference = |epsg| {
        let mut reference = SpatialRef::from_epsg(epsg).unwrap();
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        reference
    };
    let transform = CoordTransform::new(&reference(EPSG), &reference(4326)).unwrap();
    let mut x: Vec<f64> = positions_m.iter().map(|at| at[0]).collect();
    let mut y: Vec<f64> = positions_m.iter().map(|at| at[1]).collect();
    transform.transform_coords(&mut x, &mut y, &mut []).unwrap();
    x.into_iter().zip(y).map(|(lon_deg, lat_deg)| [lon_deg, lat_deg]).collect()
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
