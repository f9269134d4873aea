//! A build with a polygon gives the same result as one with bounds if the polygon is a rectangle
//! between nodes. Otherwise ground and roads end at the outline, everything outside is counted, and
//! verify uses the same area.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::support::{
    Options, Raster,
    extract::{self, StraightRoad, utm_to_degrees},
    settings, table,
    terrain::rough_with_voids,
};
use corniche_drape::DrapedVertex;
use corniche_gis::RegionPolygons;
use corniche_pipeline::build;
use corniche_plan::{BuildPlan, plan};
use corniche_spec::BuildSettings;
use corniche_tileset::{FilePackage, GeoRoad, Sections};
use corniche_verify::{VerifyError, VerifyOsm, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;

/// A raster of four by three tiles with voids, and roads all over it and outside.
struct Files {
    folder: tempfile::TempDir,
    raster: Raster,
}

/// Roads across the raster in all directions, and two short ones.
fn roads() -> Vec<StraightRoad> {
    let mut roads = Vec::new();
    for k in 0..30 {
        let k = f64::from(k);
        roads.push(StraightRoad { from: [k * 29.3 - 3.0, -20.0], to: [900.0 - k * 28.1, 740.0] });
        roads.push(StraightRoad { from: [-30.0, k * 23.7], to: [950.0, 13.0 + k * 22.1] });
    }
    roads.push(StraightRoad { from: [500.0, 300.0], to: [520.0, 301.0] });
    roads.push(StraightRoad { from: [10.0, 10.0], to: [14.0, 11.0] });
    roads
}

impl Files {
    fn new() -> Self {
        let raster = Raster::new([900, 700], [37, 90], rough_with_voids);
        let folder = tempfile::tempdir().unwrap();
        raster.write(&folder.path().join("dem.tif"));
        extract::write(&folder.path().join("roads.osm.pbf"), &raster, &roads());
        Self { folder, raster }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A polygon in the raster's own CRS: rings of (column, row).
    fn polygon(&self, name: &str, rings: &[&[[f64; 2]]]) -> RegionPolygons {
        let ring = |ring: &&[[f64; 2]]| ring.iter().map(|&at| self.raster.position_m(at)).collect();
        self.polygon_m(name, &rings.iter().map(ring).collect::<Vec<_>>())
    }

    /// A polygon given by coordinates.
    fn polygon_m(&self, name: &str, rings: &[Vec<[f64; 2]>]) -> RegionPolygons {
        let ring = |ring: &Vec<[f64; 2]>| {
            let corners = ring.iter().chain(&ring[..1]);
            let corners: Vec<String> = corners.map(|[x, y]| format!("[{x},{y}]")).collect();
            format!("[{}]", corners.join(","))
        };
        let rings: Vec<String> = rings.iter().map(ring).collect();
        let text = format!(
            r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::{}"}}}},"features":[{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[{}]}}}}]}}"#,
            crate::support::EPSG,
            rings.join(",")
        );
        let path = self.at(name);
        fs::write(&path, text).unwrap();
        RegionPolygons::read(&path).unwrap()
    }

    fn settings(
        &self,
        name: &str,
        max_error_m: f64,
        polygon: Option<&RegionPolygons>,
    ) -> BuildSettings {
        let osm = Some(self.at("roads.osm.pbf"));
        let options = Options { fill_voids: 8, ..Options::plain(max_error_m) };
        let mut settings = settings(self.at("dem.tif"), osm, self.at(name), options);
        settings.plan.terrain.plan.polygon = polygon.cloned();
        settings
    }

    /// Verifies a package against both inputs.
    fn verify(
        &self,
        package: &Path,
        polygon: Option<&RegionPolygons>,
    ) -> Result<VerifyReport, VerifyError> {
        let osm = VerifyOsm {
            paths: vec![self.at("roads.osm.pbf")],
            table: table(),
            memory_bytes: 64 << 20,
        };
        let settings = VerifySettings {
            dem: vec![self.at("dem.tif")],
            photo: Vec::new(),
            osm: Some(osm),
            threads: 2,
            polygon: polygon.cloned(),
        };
        verify(&FilePackage::open(package)?, &settings, &Silent)
    }

    fn check_verify(&self, package: &Path, polygon: &RegionPolygons) {
        let report = self.verify(package, Some(polygon)).unwrap();
        let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
        assert!(broken.is_empty(), "{broken:#?}");
    }
}

fn made(settings: &BuildSettings) -> FilePackage {
    build(settings, &Silent).unwrap();
    FilePackage::open(&settings.output).unwrap()
}

#[test]
fn a_rectangle_between_nodes_makes_the_tiles_of_bounds() {
    let files = Files::new();
    let corners = [[250.0, 170.0], [660.0, 580.0]].map(|at| files.raster.position_m(at));
    let [west_north, east_south] = [0, 1].map(|index| utm_to_degrees(&corners)[index]);
    let mut settings = files.settings("bounds.pmtiles", 30.0, None);
    settings.plan.terrain.plan.bounds_deg =
        Some([west_north[0], east_south[1], east_south[0], west_north[1]]);
    let with_bounds = made(&settings);
    // A polygon through the nodes to which the bounds are rounded.
    let (clip, frame) = (with_bounds.manifest().clip, with_bounds.manifest().frame);
    let [low, high] = clip.unwrap().nodes.map(|node| [frame.x_m(node.i), frame.y_m(node.j)]);
    let own =
        files.polygon_m("square.geojson", &[vec![low, [high[0], low[1]], high, [low[0], high[1]]]]);
    let with_polygon = made(&files.settings("polygon.pmtiles", 30.0, Some(&own)));
    assert_eq!(with_polygon.manifest().clip, clip);
    let [bounds, polygon] = [&with_bounds, &with_polygon].map(|package| &package.manifest().counts);
    assert_eq!(polygon.samples, bounds.samples);
    assert_eq!(polygon.roads_kept, bounds.roads_kept);
    // Cuts are rounded to micrometres in another order.
    assert!(polygon.roads_kept_um.abs_diff(bounds.roads_kept_um) < 1000);
    // Ground is the same on all levels, and roads on the ground are the same on the finest level.
    // On coarser levels and outside the ground, roads end at the outline, while with bounds they
    // end with the ground.
    let ids = with_bounds.tile_ids().unwrap();
    assert_eq!(with_polygon.tile_ids().unwrap(), ids);
    let mut roads = 0;
    for id in ids {
        let [bounds, polygon] = [&with_bounds, &with_polygon]
            .map(|package| package.payload(id, Sections::ALL).unwrap().unwrap());
        assert!(polygon.terrain == bounds.terrain, "ground of tile {id}");
        if id.z() == frame.max_level() {
            // An end on the outline is rounded to the lattice before the rest is cut by tiles. This
            // turns the line by half a step, which moves its crossing with a border at a narrow
            // angle by up to thirty steps.
            let key =
                |road: &GeoRoad| (road.class, road.way_id, road.part, road.line.vertices.len());
            let keys = |roads: &[GeoRoad]| roads.iter().map(key).collect::<Vec<_>>();
            assert_eq!(keys(&polygon.roads_geo), keys(&bounds.roads_geo), "roads of tile {id}");
            for (own, other) in polygon.roads_geo.iter().zip(&bounds.roads_geo) {
                for pair in own.line.vertices.iter().zip(&other.line.vertices) {
                    if let (
                        DrapedVertex::Source { point: a, .. },
                        DrapedVertex::Source { point: b, .. },
                    ) = pair
                    {
                        assert!(a.distance_steps(*b) < 30.0, "{a:?} {b:?} in tile {id}");
                        roads += 1;
                    }
                }
            }
        }
    }
    assert!(roads > 100, "{roads}");
    files.check_verify(&files.at("polygon.pmtiles"), &own);
}

/// Whether a point is in a triangle with a hole, in columns and rows, or at most `reach` outside
/// its outline.
fn is_in(triangle: &[[f64; 2]; 3], hole: &[[f64; 2]; 4], [x, y]: [f64; 2], reach: f64) -> bool {
    let outside = |[a, b]: [[f64; 2]; 2]| {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / length
    };
    let in_triangle = (0..3).all(|k| outside([triangle[k], triangle[(k + 1) % 3]]) >= -reach);
    let in_hole = (0..4).all(|k| outside([hole[k], hole[(k + 1) % 4]]) > reach);
    in_triangle && !in_hole
}

#[test]
fn ground_and_roads_end_at_the_outline_and_what_is_left_out_is_counted() {
    let files = Files::new();
    // Because rows count southwards, these rings have their inside on the positive side.
    let triangle = [[120.0, 60.0], [820.5, 90.25], [300.75, 640.0]];
    let hole = [[350.0, 200.0], [420.5, 210.0], [410.0, 300.5], [340.0, 280.0]];
    let own = files.polygon("triangle.geojson", &[&triangle, &hole]);
    let whole = made(&files.settings("whole.pmtiles", 30.0, None));
    let mut bytes = Vec::new();
    for threads in [1, 2, 8] {
        let mut settings = files.settings(&format!("{threads}.pmtiles"), 30.0, Some(&own));
        settings.resources.threads = threads;
        build(&settings, &Silent).unwrap();
        bytes.push(fs::read(&settings.output).unwrap());
    }
    assert!(bytes.windows(2).all(|pair| pair[0] == pair[1]), "bytes depend on threads");
    let path = files.at("1.pmtiles");
    files.check_verify(&path, &own);

    let part = FilePackage::open(&path).unwrap();
    let frame = part.manifest().frame;
    let [left, top] = [files.raster.position_m([0.0, 0.0]), files.raster.position_m([1.0, 1.0])];
    let to_raster =
        |[x, y]: [f64; 2]| [(x - left[0]) / (top[0] - left[0]), (y - left[1]) / (top[1] - left[1])];
    let (mut nodes, mut kept) = (0, 0);
    for id in part.tile_ids().unwrap() {
        let payload = part.payload(id, Sections::ALL).unwrap().unwrap();
        let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
        for vertex in payload.terrain.unwrap().tin.vertices() {
            let at = [
                frame.x_m(corner.i + i64::from(vertex.column) * stride),
                frame.y_m(corner.j - i64::from(vertex.row) * stride),
            ];
            // Corners of the cells that it enters are at most a diagonal of a cell outside.
            assert!(is_in(&triangle, &hole, to_raster(at), 1.42), "{:?}", to_raster(at));
            nodes += 1;
        }
        if id.z() < frame.max_level() {
            continue;
        }
        for road in payload.roads_geo {
            for vertex in &road.line.vertices {
                if let DrapedVertex::Source { point, .. } = vertex {
                    let at = to_raster(frame.position_m(*point));
                    assert!(is_in(&triangle, &hole, at, 1e-3), "{at:?} of way {}", road.way_id);
                    kept += 1;
                }
            }
        }
    }
    assert!(nodes > 1000 && kept > 100, "{nodes} {kept}");

    // All roads are either kept or lost, and the length lost outside the polygon is the length that
    // the polygon does not enclose.
    let counts = &part.manifest().counts;
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    assert_eq!(counts.roads_kept_um + lost_um, counts.roads_in_um);
    assert_eq!(counts.roads_in, whole.manifest().counts.roads_in);
    let beyond = counts.roads_lost.iter().find(|loss| loss.reason.contains("bounds")).unwrap();
    assert!(beyond.roads >= 1, "{beyond:?}");
    let expected = expected_inside_share(&triangle, &hole);
    let inside = (counts.roads_in_um - beyond.length_um) as f64 / counts.roads_in_um as f64;
    assert!((inside - expected).abs() < 1e-3, "{inside} of the roads' length, not {expected}");
}

/// The fraction of the roads' length that is inside, estimated from many points of each road.
fn expected_inside_share(triangle: &[[f64; 2]; 3], hole: &[[f64; 2]; 4]) -> f64 {
    let (mut all, mut inside) = (0.0, 0.0);
    for StraightRoad { from, to } in roads() {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let points = 4000;
        for k in 0..points {
            let t = (f64::from(k) + 0.5) / f64::from(points);
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * t);
            all += length;
            inside += if is_in(triangle, hole, at, 0.0) { length } else { 0.0 };
        }
    }
    inside / all
}

#[test]
fn the_polygon_is_part_of_the_plan_and_of_terrain_that_is_taken() {
    let files = Files::new();
    let own = files.polygon("a.geojson", &[&[[120.0, 60.0], [820.0, 90.0], [300.0, 640.0]]]);
    let other = files.polygon("b.geojson", &[&[[120.0, 60.0], [820.0, 91.0], [300.0, 640.0]]]);
    let planned =
        |settings: &BuildSettings| plan(&settings.plan, settings.resources, &Silent).unwrap().0;
    let with = files.settings("with.pmtiles", 30.0, Some(&own));
    let (a, b) = (planned(&with), planned(&files.settings("b.pmtiles", 30.0, Some(&other))));
    let said = a.differences(&b).join("; ");
    assert!(said.contains("a.geojson") && said.contains("b.geojson"), "{said}");
    // Workers read the polygon again, from the path in the plan, and verify that it is the same.
    let read = BuildPlan::from_json(&a.to_json().unwrap()).unwrap();
    assert_eq!(BuildPlan::make(&read.settings().unwrap()).unwrap(), a);
    fs::copy(files.at("b.geojson"), files.at("a.geojson")).unwrap();
    let changed = BuildPlan::make(&read.settings().unwrap()).unwrap();
    let said = changed.differences(&a).join("; ");
    assert!(said.contains("--polygon"), "{said}");

    let own = files.polygon("a.geojson", &[&[[120.0, 60.0], [820.0, 90.0], [300.0, 640.0]]]);
    build(&with, &Silent).unwrap();
    let bytes = fs::read(&with.output).unwrap();
    let mut again = files.settings("again.pmtiles", 30.0, Some(&own));
    again.plan.dem.clear();
    again.plan.terrain_of = Some(with.output.clone());
    build(&again, &Silent).unwrap();
    assert!(fs::read(&again.output).unwrap() == bytes, "the terrain of a package with a polygon");
    for polygon in [Some(&other), None] {
        let mut again = files.settings("refused.pmtiles", 30.0, polygon);
        again.plan.dem.clear();
        again.plan.terrain_of = Some(with.output.clone());
        let error = build(&again, &Silent).unwrap_err().to_string();
        assert!(error.contains("--polygon"), "{error}");
    }
    // Verify also rejects other polygons.
    let refused = |polygon| files.verify(&with.output, polygon).unwrap_err();
    assert!(matches!(refused(None), VerifyError::PolygonMissing { .. }));
    assert!(matches!(refused(Some(&other)), VerifyError::OtherPolygon { .. }));
    let plain = files.settings("plain.pmtiles", 60.0, None);
    build(&plain, &Silent).unwrap();
    let error = files.verify(&plain.output, Some(&own)).unwrap_err();
    assert!(matches!(error, VerifyError::NoPolygon));
}

#[test]
fn a_polygon_between_roads_or_voids_is_refused_with_what_is_wrong() {
    let files = Files::new();
    // A polygon within a cell, and without a road.
    let own = files.polygon("cell.geojson", &[&[[600.1, 333.1], [600.2, 333.1], [600.2, 333.2]]]);
    let error = build(&files.settings("cell.pmtiles", 30.0, Some(&own)), &Silent).unwrap_err();
    assert!(error.to_string().contains("--polygon"), "{error}");
}
