//! Spans are solved as a whole and cut afterwards: bounds, polygons and chosen classes change no
//! height of a bridge or a tunnel, and tiles inside have the sections of the whole build, byte for
//! byte.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_geom::{LatticePoint, TileId};
use corniche_gis::RegionPolygons;
use corniche_pipeline::build;
use corniche_spec::BuildSettings;
use corniche_testing::{cases, real_data, sample};
use corniche_tileset::{FilePackage, Sections, SpanHeight, SpanRun, decode_spans};
use corniche_tin::{Placement, Surface};
use corniche_verify::{VerifyOsm, VerifySettings, verify};
use corniche_work::Silent;

use crate::support::{Options, layers::railways, settings, table};

/// A DEM with an extract.
struct Region {
    name: &'static str,
    dem: Vec<PathBuf>,
    osm: PathBuf,
    max_error_m: f64,
}

impl Region {
    /// A build with spans.
    fn settings(&self, folder: &Path, name: &str) -> BuildSettings {
        let options = Options { fill_voids: 8, ..Options::plain(self.max_error_m) };
        let (dem, osm) = (self.dem[0].clone(), Some(self.osm.clone()));
        let mut settings = settings(dem, osm, folder.join(format!("{name}.pmtiles")), options);
        settings.plan.dem.clone_from(&self.dem);
        settings.plan.roads.spans = true;
        settings.plan.layers = vec![railways()];
        "corniche tests".clone_into(&mut settings.plan.generator);
        settings
    }
}

fn built(settings: &BuildSettings) -> FilePackage {
    build(settings, &Silent).unwrap();
    FilePackage::open(&settings.output).unwrap()
}

fn within(mut settings: BuildSettings, bounds_deg: [f64; 4]) -> BuildSettings {
    settings.plan.terrain.plan.bounds_deg = Some(bounds_deg);
    settings
}

/// Asserts that all checks against the extract pass.
fn holds(package: &FilePackage, settings: &BuildSettings) {
    let plan = &settings.plan;
    let osm = VerifyOsm {
        paths: plan.osm.clone(),
        table: plan.roads.table.clone(),
        memory_bytes: 64 << 20,
    };
    let verified = VerifySettings {
        dem: plan.dem.clone(),
        photo: Vec::new(),
        osm: Some(osm),
        threads: 2,
        polygon: plan.terrain.plan.polygon.clone(),
    };
    let report = verify(package, &verified, &Silent).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}

/// The sections of a payload, by kind, as they are stored. See `FORMAT.md`, "Payload".
fn sections(payload: &[u8]) -> BTreeMap<u16, Vec<u8>> {
    let number = |at: usize| u32::from_le_bytes(payload[at..at + 4].try_into().unwrap()) as usize;
    (0..usize::from(payload[6]))
        .map(|index| 16 + 20 * index)
        .map(|at| {
            let kind = u16::from_le_bytes([payload[at], payload[at + 1]]);
            (kind, payload[number(at + 4)..number(at + 4) + number(at + 8)].to_vec())
        })
        .collect()
}

/// The finest tiles of a package by their north-western node.
fn finest(package: &FilePackage) -> BTreeMap<[i64; 2], TileId> {
    let frame = package.manifest().frame;
    let ids = package.tile_ids().unwrap().into_iter().filter(|id| id.z() == frame.max_level());
    ids.map(|id| (frame.tile_corner(id), id))
        .map(|(corner, id)| ([corner.i, corner.j], id))
        .collect()
}

fn runs(package: &FilePackage, id: TileId) -> Vec<SpanRun> {
    let manifest = package.manifest();
    let bytes = package.tile(id).unwrap().unwrap();
    decode_spans(&bytes, id, &manifest.frame, manifest.vertical.quantum_m).unwrap()
}

/// Compares the tiles inside with those of the whole package, and returns how many of them have
/// spans. `is_inside` tests nodes.
fn compare(whole: &FilePackage, part: &FilePackage, is_inside: impl Fn([i64; 2]) -> bool) -> usize {
    let all = finest(whole);
    let mut with_spans = 0;
    for (corner, id) in finest(part) {
        // Two rings of nodes around the tile are included, because slopes and their low-pass filter
        // depend on them.
        let nodes = (-2..=258).flat_map(|row| (-2..=258).map(move |column| [column, row]));
        let mut nodes = nodes.map(|[column, row]| [corner[0] + column, corner[1] - row]);
        if !nodes.all(&is_inside) {
            continue;
        }
        let [own, other] = [(part, id), (whole, all[&corner])]
            .map(|(package, id)| sections(&package.tile(id).unwrap().unwrap()));
        let differing: Vec<u16> = own
            .keys()
            .chain(other.keys())
            .copied()
            .filter(|kind| own.get(kind) != other.get(kind))
            .collect();
        assert!(differing.is_empty(), "tile {id} at {corner:?}: sections {differing:?}");
        with_spans += usize::from(own.contains_key(&13));
    }
    with_spans
}

/// Positions on bridges and in tunnels of a package, WGS84 degrees: the middle of each run of its
/// finest tiles.
fn middles(package: &FilePackage) -> Vec<[f64; 2]> {
    let manifest = package.manifest();
    let middle = |run: SpanRun| {
        let [from, to] = [run.points[0].at, run.points[run.points.len() - 1].at];
        let at = LatticePoint::new(i64::midpoint(from.u, to.u), i64::midpoint(from.v, to.v));
        manifest.coordinates.wgs84_from_working(manifest.frame.position_m(at))
    };
    finest(package).into_values().flat_map(|id| runs(package, id)).map(middle).collect()
}

/// Four bounds, each with another side through a position; the other sides are `size` degrees away.
fn bounds_through([lon, lat]: [f64; 2], side: usize, [width, height]: [f64; 2]) -> [f64; 4] {
    let [w, h] = [width / 2.0, height / 2.0];
    match side % 4 {
        0 => [lon, lat - h, lon + width, lat + h],
        1 => [lon - w, lat, lon + w, lat + height],
        2 => [lon - width, lat - h, lon, lat + h],
        _ => [lon - w, lat - height, lon + w, lat],
    }
}

/// Four quadrilaterals, slightly rotated: the middle of one side is at the position.
fn askew([west, south, east, north]: [f64; 4]) -> [[f64; 2]; 4] {
    let [a, b] = [(east - west) * 0.06, (north - south) * 0.06];
    [[west + a, south + b], [east - a, south - b], [east + a, north - b], [west - a, north + b]]
}

/// Packages within bounds and polygons that cut spans have the tiles of the whole package wherever
/// the tiles are inside.
fn cut_spans_are_whole(region: &Region, tiles_wide: f64) {
    let folder = tempfile::tempdir().unwrap();
    let whole = built(&region.settings(folder.path(), "whole"));
    let manifest = whole.manifest();
    let root = manifest.wgs84_bounds;
    let [columns, rows] = {
        let [low, high] = manifest.data_nodes();
        [high.i - low.i, high.j - low.j].map(|cells| cells as f64 / 256.0)
    };
    let size = [root.width() / columns * tiles_wide, root.height() / rows * tiles_wide];
    let middles = middles(&whole);
    let count = cases(2, 2, 10);
    let mut with_spans = [0; 2];
    for number in 0..count {
        let place = middles[number * middles.len() / count];
        let bounds = bounds_through(place, number, size);
        let settings = within(region.settings(folder.path(), "bounds"), bounds);
        let part = built(&settings);
        let [low, high] = part.manifest().clip.unwrap().nodes;
        let [first, last] = manifest.data_nodes();
        let is_within = |[i, j]: [i64; 2]| {
            let is_data = (first.i..=last.i).contains(&i) && (first.j..=last.j).contains(&j);
            !is_data || ((low.i..=high.i).contains(&i) && (low.j..=high.j).contains(&j))
        };
        with_spans[0] += compare(&whole, &part, is_within);
        if number == 0 {
            holds(&part, &settings);
        }
        fs::remove_file(&settings.output).unwrap();

        let corners = askew(bounds);
        let ring: Vec<String> = corners
            .iter()
            .chain([&corners[0]])
            .map(|[lon, lat]| format!("[{lon},{lat}]"))
            .collect();
        let path = folder.path().join("polygon.geojson");
        let text = format!(r#"{{"type":"Polygon","coordinates":[[{}]]}}"#, ring.join(","));
        fs::write(&path, text).unwrap();
        let mut settings = region.settings(folder.path(), "polygon");
        settings.plan.terrain.plan.polygon = Some(RegionPolygons::read(&path).unwrap());
        let part = built(&settings);
        let frame = part.manifest().frame;
        let is_within = |[i, j]: [i64; 2]| {
            let is_data = (first.i..=last.i).contains(&i) && (first.j..=last.j).contains(&j);
            // A tile is inside a convex polygon if its border is; one cell of margin allows for
            // edges that are curved.
            let room = 1.0 / 2000.0;
            let [lon, lat] = manifest.coordinates.wgs84_from_working([frame.x_m(i), frame.y_m(j)]);
            let is_left = |k: usize| {
                let [a, b] = [corners[k], corners[(k + 1) % 4]];
                let run = [b[0] - a[0], b[1] - a[1]];
                run[0] * (lat - a[1]) - run[1] * (lon - a[0]) > room * run[0].hypot(run[1])
            };
            !is_data || (0..4).all(is_left)
        };
        with_spans[1] += compare(&whole, &part, is_within);
        if number == 0 {
            holds(&part, &settings);
        }
        fs::remove_file(&settings.output).unwrap();
    }
    assert!(with_spans.iter().all(|&tiles| tiles > 0), "{}: {with_spans:?}", region.name);
}

#[test]
fn spans_of_the_pass_are_whole_within_bounds() {
    let [dem, osm] = ["pass/pass-dem.tif", "pass/pass.osm.pbf"].map(sample);
    let region = Region { name: "pass", dem: vec![dem], osm, max_error_m: 10.0 };
    cut_spans_are_whole(&region, 3.3);
}

#[test]
fn spans_of_portland_are_whole_within_bounds() {
    let files = ["portland-ned.tif", "portland-central-filtered.osm.pbf"]
        .map(|name| real_data(&format!("portland/{name}")));
    let [Some(dem), Some(osm)] = files else { return };
    let region = Region { name: "portland", dem: vec![dem], osm, max_error_m: 2.0 };
    cut_spans_are_whole(&region, 2.4);
}

#[test]
fn spans_of_liechtenstein_are_whole_within_bounds() {
    let files = ["N47E009.hgt", "N47E010.hgt", "liechtenstein-2021-10-28.osm.pbf"]
        .map(|name| real_data(&format!("liechtenstein/{name}")));
    let [Some(west), Some(east), Some(osm)] = files else { return };
    let region = Region { name: "liechtenstein", dem: vec![west, east], osm, max_error_m: 20.0 };
    cut_spans_are_whole(&region, 2.4);
}

/// The heights of a way's bridge or tunnel at positions along the east axis of the package's CRS,
/// from the runs of finest tiles.
fn decks_at(package: &FilePackage, way_id: i64, easts: &[f64]) -> Vec<Option<f64>> {
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let east = |point: LatticePoint| frame.position_m(point)[0] / manifest.metres_per_unit[0];
    let mut decks = vec![None; easts.len()];
    for id in finest(package).into_values() {
        let payload = package.payload(id, Sections::TERRAIN).unwrap().unwrap();
        let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
        let surface = Surface::new(&payload.terrain.unwrap().tin, placement);
        for run in runs(package, id).into_iter().filter(|run| run.way_id == way_id) {
            let height_m = |at: LatticePoint, height: SpanHeight| match height {
                SpanHeight::Steps(steps) => steps as f64 * manifest.vertical.quantum_m,
                SpanHeight::Ground { triangle } => surface.height_at_point_m(triangle, at),
            };
            for [from, to] in run.points.array_windows() {
                let ends =
                    [from, to].map(|point| (east(point.at), height_m(point.at, point.height)));
                let [(a, a_m), (b, b_m)] = ends;
                for (&at, deck) in easts.iter().zip(&mut decks) {
                    let share = (at - a) / (b - a);
                    // The lattice has steps of a millimetre or less.
                    if (-1e-3..=1.001).contains(&share) {
                        *deck = Some(a_m + share * (b_m - a_m));
                    }
                }
            }
        }
    }
    decks
}

/// The largest distance of the cases' ground, and therefore of the decks, from the closed forms,
/// metres.
const CASE_ERROR_M: f64 = 0.05;
/// The expected values are given to a hundredth.
const ROUNDED_M: f64 = 0.01;

fn case(folder: &str, dem: &str, osm: &str) -> Option<Region> {
    let file = |name: &str| real_data(&format!("cases/{folder}/{name}"));
    let (dem, osm) = (file(dem)?, file(osm)?);
    Some(Region { name: "case", dem: vec![dem], osm, max_error_m: CASE_ERROR_M })
}

fn assert_near(found: &[Option<f64>], wanted: &[f64], what: &str) {
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(
            found.is_some_and(|found| (found - wanted).abs() < CASE_ERROR_M + ROUNDED_M),
            "{what}: {found:?}, {wanted}"
        );
    }
}

/// A bridge of 5.4 km that bounds cut has the heights of the whole bridge, and a tile inside has
/// the same bytes.
#[test]
fn a_bridge_that_bounds_cut_has_its_own_heights() {
    let Some(region) = case("bounds-cut-span", "valley.tif", "bridge.osm.pbf") else { return };
    let folder = tempfile::tempdir().unwrap();
    let whole = built(&region.settings(folder.path(), "whole"));
    let easts = [502_000.0, 503_000.0, 504_000.0, 504_500.0];
    let wanted = [539.81, 559.84, 579.88, 589.9];
    assert_near(&decks_at(&whole, 2, &easts), &wanted, "whole");
    for (name, bounds) in [
        ("cut", [8.999_343, 46.935_532, 9.091_995, 46.971_527]),
        ("half", [8.999_343, 46.935_532, 9.060_453, 46.971_527]),
        // The bridge from the other end, and the middle alone.
        ("east", [9.02, 46.935_532, 9.2, 46.971_527]),
        ("middle", [9.02, 46.935_532, 9.06, 46.971_527]),
    ] {
        let settings = within(region.settings(folder.path(), name), bounds);
        let part = built(&settings);
        let found = decks_at(&part, 2, &easts);
        let pairs = found.iter().zip(wanted).filter(|(found, _)| found.is_some());
        let (found, wanted): (Vec<Option<f64>>, Vec<f64>) = pairs.unzip();
        assert!(found.len() > 1, "{name}");
        assert_near(&found, &wanted, name);
        let [low, high] = part.manifest().clip.unwrap().nodes;
        let [first, last] = whole.manifest().data_nodes();
        let tiles = compare(&whole, &part, |[i, j]| {
            let is_data = (first.i..=last.i).contains(&i) && (first.j..=last.j).contains(&j);
            !is_data || ((low.i..=high.i).contains(&i) && (low.j..=high.j).contains(&j))
        });
        assert!(name != "cut" || tiles == 1, "{tiles} whole tiles with spans");
        holds(&part, &settings);
    }
}

/// A portal whose only roads on the ground have classes that are off carries its tunnel.
#[test]
fn classes_that_are_off_carry_spans() {
    let Some(region) = case("classes-portal", "hill.tif", "tunnel.osm.pbf") else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, classes) in [("all", 0..=7), ("main", 0..=4), ("one", 2..=2)] {
        let mut settings = region.settings(folder.path(), name);
        let classes: Vec<u8> = classes.collect();
        settings.plan.roads.table = table().with_classes(&classes).unwrap();
        let package = built(&settings);
        let runs: Vec<SpanRun> =
            finest(&package).into_values().flat_map(|id| runs(&package, id)).collect();
        let own: Vec<&SpanRun> = runs.iter().filter(|run| run.way_id == 2).collect();
        assert!(!own.is_empty(), "{name}");
        let heights_m = all_heights_m(&package, 2);
        let [low_m, high_m] =
            [f64::min, f64::max].map(|pick| heights_m.iter().copied().reduce(pick).unwrap());
        assert!(
            (low_m - 511.47).abs() < CASE_ERROR_M + ROUNDED_M
                && (high_m - 551.47).abs() < CASE_ERROR_M + ROUNDED_M,
            "{name}: {low_m} {high_m}"
        );
        holds(&package, &settings);
    }
}

/// The heights of all points of a way's runs on the finest level.
fn all_heights_m(package: &FilePackage, way_id: i64) -> Vec<f64> {
    let manifest = package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let mut heights_m = Vec::new();
    for id in finest(package).into_values() {
        let payload = package.payload(id, Sections::TERRAIN).unwrap().unwrap();
        let placement = Placement::of_tile(&manifest.frame, id, quantum_m);
        let surface = Surface::new(&payload.terrain.unwrap().tin, placement);
        for run in runs(package, id).iter().filter(|run| run.way_id == way_id) {
            heights_m.extend(run.points.iter().map(|point| match point.height {
                SpanHeight::Steps(steps) => steps as f64 * quantum_m,
                SpanHeight::Ground { triangle } => surface.height_at_point_m(triangle, point.at),
            }));
        }
    }
    heights_m
}
