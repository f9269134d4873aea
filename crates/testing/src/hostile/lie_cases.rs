//! Valid bytes with impossible coordinates: code whose work depends on the coordinates, and not on
//! the bytes, never ends.

use corniche_drape::SvLine;
use corniche_geom::{GridFrame, LatticePoint, NodeIndex, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{PayloadContext, SvRoad, TilePayload, encode};
use serde_json::{Value, json};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{PackageParts, metadata},
};
use crate::{package, pmtiles::gzip};

/// The valid package with other values in its manifest.
fn with_values(values: &[(&str, Value)]) -> Vec<u8> {
    PackageParts { metadata: manifest(values), ..PackageParts::good() }.assemble()
}

fn manifest(values: &[(&str, Value)]) -> Vec<u8> {
    let mut metadata = metadata();
    for (pointer, value) in values {
        *metadata.pointer_mut(&format!("/corniche{pointer}")).unwrap() = value.clone();
    }
    gzip(metadata.to_string().as_bytes())
}

/// A package of tile 0/0/0, with roads for shadow volumes through these points.
fn sv_roads(lines: impl IntoIterator<Item = Vec<LatticePoint>>) -> Vec<u8> {
    sv_roads_on(package::payload(TileId::ROOT), lines)
}

/// A tile with the largest number of triangles.
fn full_tile() -> TilePayload {
    let mut tile = package::payload(TileId::ROOT);
    if let Some(terrain) = &mut tile.terrain {
        terrain.tin = package::full_tin();
        terrain.normals = vec![[0, 0]; terrain.tin.vertices().len()];
    }
    tile.roads_geo.clear();
    tile
}

fn sv_roads_on(
    mut tile: TilePayload,
    lines: impl IntoIterator<Item = Vec<LatticePoint>>,
) -> Vec<u8> {
    let class = FunctionalRoadClass::new(3).unwrap();
    let road = |(part, points): (u32, Vec<LatticePoint>)| {
        let line = SvLine { ground_range_m: vec![[0.25, 90.0]; points.len() - 1], points };
        SvRoad { way_id: 7, part, class, line }
    };
    tile.roads_sv = (0..).zip(lines).map(road).collect();
    let bytes = encode(&tile, &package::context()).unwrap().bytes;
    PackageParts { metadata: manifest(&[]), ..PackageParts::of_tiles(&[bytes]) }.assemble()
}

/// A package whose grid is as far from zero as grids may be, in a CRS with such short degrees that
/// it goes around the earth many times.
fn around_the_earth(crs: &str) -> Vec<u8> {
    let corner = NodeIndex { i: (1 << 32) - 2048, j: 1024 };
    let values = [("/crs_wkt", json!(crs)), ("/metres_per_unit", json!([1e-6, 1e-6]))];
    on_grid(corner, package::MAX_LEVEL, &values)
}

/// The ground of the valid package on another grid, which is completely covered by data.
fn on_grid(corner: NodeIndex, max_level: u8, values: &[(&str, Value)]) -> Vec<u8> {
    let cell = package::frame().cell();
    let frame = GridFrame::new([0.5, 0.25], cell, corner, max_level).unwrap();
    let levels: Vec<_> = (0..=max_level).map(|level| package::level(&frame, level)).collect();
    let bounds = serde_json::to_value(frame.tile_bounds(TileId::ROOT)).unwrap();
    let of_grid = [
        ("/frame", serde_json::to_value(frame).unwrap()),
        ("/data_bounds", bounds.clone()),
        ("/coordinates/bounds", bounds),
        ("/levels", serde_json::to_value(levels).unwrap()),
    ];
    let values = [values, &of_grid].concat();
    let context = PayloadContext { frame, ..package::context() };
    let tile = |id| {
        let mut tile = package::payload(id);
        tile.roads_geo.clear();
        tile.roads_sv.clear();
        encode(&tile, &context).unwrap().bytes
    };
    let tiles: Vec<Vec<u8>> = package::ids().into_iter().map(tile).collect();
    PackageParts { metadata: manifest(&values), ..PackageParts::of_tiles(&tiles) }.assemble()
}

/// A text with control characters: it clears the screen, returns to the beginning of the line and
/// reverses the following text; it is also not valid in XML 1.0. Its second line imitates a line of
/// Corniche.
pub const COMMANDING: &str =
    "a\u{1b}[2J\u{9b}31m\rb\u{7}\u{8}\u{202e}c\u{2066}<&>\u{fffe}\"'\ncorniche: forged";

/// The valid package with these texts in all fields that programs print.
#[must_use]
pub fn commanding_texts() -> Vec<u8> {
    let text = || json!(COMMANDING);
    with_values(&[
        ("/attribution", json!([COMMANDING, COMMANDING])),
        ("/generator", text()),
        ("/crs", text()),
        ("/vertical/datum", text()),
        ("/vertical/treatment", text()),
        ("/resampling", text()),
        ("/settings/frc_table", text()),
        ("/inputs/0/name", text()),
        ("/counts/defects", json!([[COMMANDING, 3]])),
        ("/counts/unknown_highways", json!([[COMMANDING, 3]])),
    ])
}

pub(crate) fn all() -> Vec<Case> {
    let bounds = package::frame().tile_lattice_bounds(TileId::ROOT);
    let from = LatticePoint::new(bounds.min.u + 5000, bounds.min.v + 5000);
    let far = |steps: i64| LatticePoint::new(from.u + steps, from.v + steps / 3);
    let read = |name, bytes| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib: 64 };
    let back = (0..50).map(|k| if k % 2 == 0 { far(-(1 << 40)) } else { far(1 << 40) });
    let across = |segments: i64| {
        (0..segments).map(move |k| if k % 2 == 0 { from } else { bounds.max }).collect()
    };
    let bounds_at = |x: f64| json!({ "min_x": x, "min_y": 0, "max_x": 2.0 * x, "max_y": 1000 });
    let mut table = metadata()["corniche"]["coordinates"].clone();
    table["bounds"] = bounds_at(1e17);
    // Tables that are valid by themselves, but spread small data over the globe.
    let spread = |factor: f64, offset: f64| {
        let mut table = metadata()["corniche"]["coordinates"].clone();
        let Some(samples) = table["samples_deg"].as_array_mut() else { return table };
        let first: Vec<f64> = (0..2).filter_map(|axis| samples[0][axis].as_f64()).collect();
        for sample in samples {
            for axis in 0..2 {
                let off = sample[axis].as_f64().unwrap_or_default() - first[axis];
                sample[axis] = json!((first[axis] + offset + factor * off).clamp(-89.0, 170.0));
            }
        }
        table
    };
    let lie = |name, pointer, value: Value, reason| {
        refused(name, with_values(&[(pointer, value)]), reason)
    };
    vec![
        read("no lie", with_values(&[])),
        read("texts that command a terminal", commanding_texts()),
        read("a segment of 2^40 steps", sv_roads([vec![from, far(1 << 40)]])),
        read("fifty segments of 2^41 steps", sv_roads([back.collect()])),
        read(
            "four hundred segments over a hundred thousand triangles",
            sv_roads_on(full_tile(), [across(400)]),
        ),
        read(
            "a hundred thousand segments over a hundred thousand triangles",
            sv_roads_on(full_tile(), [across(100_000)]),
        ),
        read("a raster of 2^40 nodes", on_grid(package::frame().root_corner(), 12, &[])),
        read("degrees of a micrometre", around_the_earth("EPSG:4326")),
        read("degrees of a micrometre in another datum", around_the_earth("EPSG:4230")),
        read("a table over half the globe", with_values(&[("/coordinates", spread(1e5, 0.0))])),
        read("a table of a hundred degrees", with_values(&[("/coordinates", spread(3e3, 0.0))])),
        read("a table of other degrees", with_values(&[("/coordinates", spread(-400.0, 20.0))])),
        read("a table of one place", with_values(&[("/coordinates", spread(0.0, 0.0))])),
        read("a table that is turned around", with_values(&[("/coordinates", spread(-1.0, 0.0))])),
        lie("data at 10^17 m", "/data_bounds", bounds_at(1e17), "data_bounds"),
        lie("data beside the grid", "/data_bounds", bounds_at(1e9), "data_bounds"),
        lie("an origin of 10^17 m", "/frame/origin_m/0", json!(1e17), "frame.origin_m"),
        lie("a table at 10^17 m", "/coordinates", table, "coordinates.bounds"),
        lie("a margin of 10^17 m", "/levels/0/width_margin_m", json!(1e17), "width_margin_m"),
        lie(
            "longitudes of 10^17 degrees",
            "/coordinates/samples_deg/0/0",
            json!(1e17),
            "samples_deg",
        ),
    ]
}
