//! Railways take part in bridges and tunnels like roads: each knows what it crosses, with or
//! without a layer of railways, whose lines then have runs.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use corniche_geom::TileId;
use corniche_pipeline::build;
use corniche_roads::Structure;
use corniche_spec::BuildSettings;
use corniche_testing::pbf::{PbfWay, network};
use corniche_tileset::{FilePackage, SpanHeight, SpanRun};
use corniche_verify::{VerifyOsm, VerifySettings, verify};
use corniche_work::Silent;

use crate::support::{
    CELL_M, Options, Raster, extract::utm_to_degrees, layers::railways, settings, table,
};

/// Flat ground at 100 m with a hill of 40 m in its north, over four tiles.
fn ground() -> Raster {
    Raster::new([400, 400], [10, 10], |column, row| {
        let off = (column - 300) as f32 / 40.0;
        if row < 120 { 100.0 + 40.0 * (1.0 - off * off).max(0.0) } else { 100.0 }
    })
}

/// Roads 1 to 4 and railways 10 to 16: a road bridge over a railway, a railway bridge over a road,
/// and a railway tunnel through the hill.
fn write_extract(path: &Path, raster: &Raster) {
    type Line = (i64, &'static [(&'static str, &'static str)], &'static [i64]);
    let nodes: Vec<(i64, [f64; 2])> = vec![
        (1, [100.0, 160.0]),
        (2, [100.0, 190.0]),
        (3, [100.0, 210.0]),
        (4, [100.0, 240.0]),
        (5, [20.0, 200.0]),
        (6, [380.0, 200.0]),
        (7, [20.0, 300.0]),
        (8, [190.0, 300.0]),
        (9, [210.0, 300.0]),
        (10, [380.0, 300.0]),
        (11, [200.0, 270.0]),
        (12, [200.0, 340.0]),
        (13, [20.0, 60.0]),
        (14, [250.0, 60.0]),
        (15, [350.0, 60.0]),
        (16, [390.0, 60.0]),
    ];
    let lines: [Line; 11] = [
        (1, &[("highway", "primary")], &[1, 2]),
        (2, &[("highway", "primary"), ("bridge", "yes"), ("layer", "1")], &[2, 3]),
        (3, &[("highway", "primary")], &[3, 4]),
        (4, &[("highway", "residential")], &[11, 12]),
        (10, &[("railway", "rail"), ("usage", "main")], &[5, 6]),
        (11, &[("railway", "rail")], &[7, 8]),
        (12, &[("railway", "rail"), ("bridge", "viaduct"), ("layer", "1")], &[8, 9]),
        (13, &[("railway", "rail")], &[9, 10]),
        (14, &[("railway", "narrow_gauge")], &[13, 14]),
        (15, &[("railway", "narrow_gauge"), ("tunnel", "yes")], &[14, 15]),
        (16, &[("railway", "narrow_gauge")], &[15, 16]),
    ];
    let positions: Vec<[f64; 2]> = nodes.iter().map(|(_, at)| raster.position_m(*at)).collect();
    let ids = nodes.iter().map(|(id, _)| *id);
    let nodes: Vec<(i64, [f64; 2])> = ids.zip(utm_to_degrees(&positions)).collect();
    let way = |&(id, tags, node_ids): &Line| PbfWay {
        id,
        tags: tags.to_vec(),
        node_ids: node_ids.to_vec(),
    };
    fs::write(path, network(&[], &nodes, &lines.iter().map(way).collect::<Vec<_>>())).unwrap();
}

/// A package of these ways, with or without the layer.
fn built(folder: &Path, has_layer: bool) -> (BuildSettings, FilePackage) {
    let raster = ground();
    let [dem, osm] = ["dem.tif", "ways.osm.pbf"].map(|name| folder.join(name));
    raster.write(&dem);
    write_extract(&osm, &raster);
    let output = folder.join(format!("{has_layer}.pmtiles"));
    let mut settings = settings(dem, Some(osm), output, Options::plain(0.5));
    settings.plan.roads.spans = true;
    settings.plan.layers = if has_layer { vec![railways()] } else { Vec::new() };
    build(&settings, &Silent).unwrap();
    let package = FilePackage::open(&settings.output).unwrap();
    (settings, package)
}

/// The runs of all tiles.
fn runs(package: &FilePackage) -> Vec<(TileId, SpanRun)> {
    let of_tile = |id| {
        let bytes = package.tile(id).unwrap().unwrap();
        let runs = package.manifest().decode_spans(&bytes, id).unwrap();
        runs.into_iter().map(move |run| (id, run))
    };
    package.tile_ids().unwrap().into_iter().flat_map(of_tile).collect()
}

/// The heights of the points off the ground of a way's runs on the finest level, metres, with their
/// columns in the raster.
fn heights(package: &FilePackage, way_id: i64) -> Vec<[f64; 2]> {
    let manifest = package.manifest();
    let (frame, quantum_m) = (&manifest.frame, manifest.vertical.quantum_m);
    let own = runs(package).into_iter();
    let own = own.filter(|(id, run)| id.z() == frame.max_level() && run.way_id == way_id);
    let of_run = |(_, run): (TileId, SpanRun)| run.points;
    own.flat_map(of_run)
        .filter_map(|point| match point.height {
            SpanHeight::Steps(steps) => {
                let x_m = frame.position_m(point.at)[0];
                let first_m = ground().position_m([0.0; 2])[0];
                Some([(x_m - first_m) / CELL_M, steps as f64 * quantum_m])
            }
            SpanHeight::Ground { .. } => None,
        })
        .collect()
}

fn highest(package: &FilePackage, way_id: i64) -> f64 {
    heights(package, way_id).iter().map(|[_, height_m]| *height_m).fold(f64::MIN, f64::max)
}

#[test]
fn a_road_bridge_knows_the_railway_below_whatever_layers_are_on() {
    let folder = tempfile::tempdir().unwrap();
    let [(_, without), (settings, with)] =
        [false, true].map(|has_layer| built(folder.path(), has_layer));
    // On flat ground the deck would be on the ground, but a metre is needed over the railway.
    assert!((highest(&without, 2) - 101.0).abs() < 0.2, "{}", highest(&without, 2));
    let counts = without.manifest().spans.as_ref().unwrap().counts.clone();
    assert_eq!([counts.bridges, counts.tunnels], [1, 0]);
    assert_eq!([counts.railway_bridges, counts.railway_tunnels], [1, 1]);
    let pair = |upper: &str, lower: &str| (upper.to_owned(), lower.to_owned(), 1);
    assert_eq!(counts.crossings, [pair("railways", "roads"), pair("roads", "railways")]);
    // With the layer, roads have the same runs and the counts are the same.
    let of_roads = |package| -> Vec<_> {
        runs(package).into_iter().filter(|(_, run)| run.owner.layer().is_none()).collect()
    };
    assert!(!of_roads(&without).is_empty());
    assert_eq!(runs(&without), of_roads(&without));
    assert_eq!(of_roads(&without), of_roads(&with));
    assert_eq!(counts, with.manifest().spans.as_ref().unwrap().counts);
    holds(&with, &settings);
}

#[test]
fn lines_of_a_layer_are_on_their_bridges_and_in_their_tunnels() {
    let folder = tempfile::tempdir().unwrap();
    let (_, package) = built(folder.path(), true);
    let of_layer = runs(&package).into_iter().filter(|(_, run)| run.owner.layer().is_some());
    let of_layer: Vec<(TileId, SpanRun)> = of_layer.collect();
    // On both levels, and only ways that are bridges and tunnels.
    for level in [0, package.manifest().frame.max_level()] {
        let own = of_layer.iter().filter(|(id, _)| id.z() == level);
        let mut ways: Vec<i64> = own.map(|(_, run)| run.way_id).collect();
        ways.sort_unstable();
        ways.dedup();
        assert_eq!(ways, [12, 15], "level {level}");
    }
    let is_tunnel = |(_, run): &&(TileId, SpanRun)| run.structure == Structure::Tunnel;
    assert!(of_layer.iter().filter(is_tunnel).all(|(_, run)| run.way_id == 15));
    assert!((highest(&package, 12) - 101.0).abs() < 0.2, "{}", highest(&package, 12));
    // The tunnel is straight from portal to portal, both of which are on the hill's foot.
    for [column, height_m] in heights(&package, 15) {
        assert!((250.0..=350.0).contains(&column) && (height_m - 100.0).abs() < 0.6, "{height_m}");
    }
}

/// Asserts that all checks against the inputs pass.
fn holds(package: &FilePackage, settings: &BuildSettings) {
    let osm =
        VerifyOsm { paths: settings.plan.osm.clone(), table: table(), memory_bytes: 64 << 20 };
    let verified = VerifySettings {
        dem: settings.plan.dem.clone(),
        photo: Vec::new(),
        osm: Some(osm),
        threads: 2,
        polygon: None,
    };
    let report = verify(package, &verified, &Silent).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}
