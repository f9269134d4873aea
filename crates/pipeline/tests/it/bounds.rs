//! A build with bounds gives the same result as the whole build there: finest tiles inside the
//! bounds have the same sections, byte for byte; ground and roads end at the bounds, and everything
//! outside is counted.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    sync::Mutex,
};

use crate::support::{
    Options, Raster,
    extract::{self, StraightRoad, utm_to_degrees},
    settings, table,
    terrain::{rough_with_voids, waves},
};
use corniche_drape::DrapedVertex;
use corniche_geom::{LatticeBounds, TileId};
use corniche_pipeline::build;
use corniche_plan::{BuildPlan, plan};
use corniche_spec::{BuildObserver, BuildSettings, Defect, Loss};
use corniche_tileset::{FilePackage, Manifest, Sections};
use corniche_verify::{CheckId, VerifyOsm, VerifySettings, verify};
use corniche_work::Silent;

/// Records the losses of roads that a build reports.
#[derive(Default)]
struct Lost(Mutex<Vec<Loss>>);

impl corniche_work::Observer for Lost {}

impl BuildObserver for Lost {
    fn defect(&self, defect: &Defect) {
        if let Defect::LostRoad { loss, .. } = defect {
            self.0.lock().unwrap().push(*loss);
        }
    }
}

/// A raster of four by four tiles with voids, and roads all over it and outside.
struct Files {
    folder: tempfile::TempDir,
    raster: Raster,
}

impl Files {
    fn new() -> Self {
        let raster = Raster::new([1100, 1000], [37, 90], rough_with_voids);
        let folder = tempfile::tempdir().unwrap();
        raster.write(&folder.path().join("dem.tif"));
        let mut roads = Vec::new();
        for k in 0..40 {
            let k = f64::from(k);
            roads.push(StraightRoad {
                from: [k * 27.3 - 3.0, -20.0],
                to: [1100.0 - k * 26.1, 1040.0],
            });
            roads.push(StraightRoad { from: [-30.0, k * 25.7], to: [1150.0, 13.0 + k * 24.1] });
        }
        // Two roads: one wholly inside the bounds, one outside.
        roads.push(StraightRoad { from: [500.0, 500.0], to: [520.0, 501.0] });
        roads.push(StraightRoad { from: [10.0, 10.0], to: [14.0, 11.0] });
        extract::write(&folder.path().join("roads.osm.pbf"), &raster, &roads);
        Self { folder, raster }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Bounds around the samples from one (column, row) to another.
    fn bounds_deg(&self, [from, to]: [[f64; 2]; 2]) -> [f64; 4] {
        let corners =
            [from, [from[0], to[1]], to, [to[0], from[1]]].map(|at| self.raster.position_m(at));
        let corners = utm_to_degrees(&corners);
        let of = |axis: usize, pick: fn(f64, f64) -> f64| {
            corners.iter().map(|at| at[axis]).reduce(pick).unwrap()
        };
        [of(0, f64::min), of(1, f64::min), of(0, f64::max), of(1, f64::max)]
    }

    fn settings(
        &self,
        name: &str,
        options: Options,
        bounds_deg: Option<[f64; 4]>,
    ) -> BuildSettings {
        let osm = Some(self.at("roads.osm.pbf"));
        let mut settings = settings(self.at("dem.tif"), osm, self.at(name), options);
        settings.plan.terrain.plan.bounds_deg = bounds_deg;
        settings
    }
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

/// The finest tiles of a package by their position on the grid.
fn finest(package: &FilePackage) -> BTreeMap<[i64; 2], TileId> {
    let frame = package.manifest().frame;
    let ids = package.tile_ids().unwrap().into_iter().filter(|id| id.z() == frame.max_level());
    ids.map(|id| (frame.tile_corner(id), id))
        .map(|(corner, id)| ([corner.i, corner.j], id))
        .collect()
}

/// Compares the finest tiles inside the bounds, and returns their number.
fn compare(whole: &Path, part: &Path) -> usize {
    let [whole, part] = [whole, part].map(|path| FilePackage::open(path).unwrap());
    let (all, clip) = (finest(&whole), part.manifest().clip.unwrap());
    let frame = part.manifest().frame;
    let [low, high] = clip.nodes;
    let mut inside = 0;
    for (corner, id) in finest(&part) {
        // The ring of nodes around the tile is included, because normals and borders depend on it.
        let is_inside = corner[0] > low.i
            && corner[0] + 256 < high.i
            && corner[1] - 256 > low.j
            && corner[1] < high.j;
        let [own, other] = [(&part, id), (&whole, all[&corner])]
            .map(|(package, id)| package.tile(id).unwrap().unwrap());
        if is_inside {
            inside += 1;
            assert!(sections(&own).contains_key(&1), "tile {id} has no ground");
            assert!(sections(&own) == sections(&other), "tile {id} at {corner:?}");
        }
        // Neither ground nor roads extend beyond the bounds.
        let payload = part.payload(id, Sections::ALL).unwrap().unwrap();
        for vertex in payload.terrain.unwrap().tin.vertices() {
            let (i, j) = (corner[0] + i64::from(vertex.column), corner[1] - i64::from(vertex.row));
            assert!((low.i..=high.i).contains(&i) && (low.j..=high.j).contains(&j), "{i} {j}");
        }
        let [min, max] = clip.nodes.map(|node| frame.lattice_of_node(node));
        let bounds = LatticeBounds { min, max };
        for road in payload.roads_geo {
            for vertex in &road.line.vertices {
                if let DrapedVertex::Source { point, .. } = vertex {
                    assert!(bounds.contains(*point), "{point:?} of way {}", road.way_id);
                }
            }
        }
    }
    inside
}

/// Verifies a package against both inputs.
fn check_verify(files: &Files, package: &Path) {
    let osm = VerifyOsm {
        paths: vec![files.at("roads.osm.pbf")],
        table: table(),
        memory_bytes: 64 << 20,
    };
    let settings = VerifySettings {
        dem: vec![files.at("dem.tif")],
        photo: Vec::new(),
        osm: Some(osm),
        threads: 2,
        polygon: None,
    };
    let report = verify(&FilePackage::open(package).unwrap(), &settings, &Silent).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn finest_tiles_inside_bounds_have_the_sections_of_the_whole_build() {
    let files = Files::new();
    let own = Options { fill_voids: 8, ..Options::plain(30.0) };
    let other_crs = Options { crs: Some("EPSG:3035"), cell_m: Some(12.0), ..own };
    for (name, options) in [("own", own), ("other", other_crs)] {
        let whole = files.settings(&format!("{name}-whole.pmtiles"), options, None);
        build(&whole, &Silent).unwrap();
        let bounds_deg = files.bounds_deg([[250.0, 170.0], [860.0, 880.0]]);
        let part = files.settings(&format!("{name}-part.pmtiles"), options, Some(bounds_deg));
        let told = Lost::default();
        build(&part, &told).unwrap();
        let inside = compare(&whole.output, &part.output);
        assert!(inside >= 1, "{name}: {inside} tiles inside");
        check_verify(&files, &part.output);
        let [whole, part] =
            [whole, part].map(|settings| FilePackage::open(&settings.output).unwrap());
        assert!(part.manifest().frame.max_level() <= whole.manifest().frame.max_level());
        let [all, some] = [&whole, &part].map(|package| &package.manifest().counts);
        // Lengths come from the package's own table of coordinates, so micrometres may differ.
        assert_eq!(some.roads_in, all.roads_in);
        assert!(some.roads_in_um.abs_diff(all.roads_in_um) < all.roads_in_um / 100_000_000);
        let beyond = some.roads_lost.iter().find(|loss| loss.reason.contains("bounds")).unwrap();
        assert!(beyond.roads >= 1 && beyond.length_um > some.roads_in_um / 3, "{beyond:?}");
        assert!(!all.roads_lost.iter().any(|loss| loss.reason.contains("bounds")));
        let lost_um: u64 = some.roads_lost.iter().map(|loss| loss.length_um).sum();
        assert_eq!(some.roads_kept_um + lost_um, some.roads_in_um);
        // Roads outside the user's bounds are not defects; roads over voids still are.
        let told = told.0.into_inner().unwrap();
        assert!(told.contains(&Loss::NoGround) && !told.contains(&Loss::OutsideBounds));
        assert!(!told.contains(&Loss::OutsideData));
    }
}

#[test]
fn bounds_beyond_the_data_leave_the_package_as_it_is() {
    let files = Files::new();
    let options = Options::plain(8.0);
    let whole = files.settings("whole.pmtiles", options, None);
    let part = files.settings("part.pmtiles", options, Some([8.0, 40.0, 11.0, 60.0]));
    for settings in [&whole, &part] {
        build(settings, &Silent).unwrap();
    }
    let [whole, part] = [whole, part].map(|settings| FilePackage::open(&settings.output).unwrap());
    assert_eq!(part.manifest().counts, whole.manifest().counts);
    for id in whole.tile_ids().unwrap() {
        assert!(part.tile(id).unwrap() == whole.tile(id).unwrap(), "tile {id}");
    }
}

#[test]
fn bounds_are_part_of_the_plan_and_of_terrain_that_is_taken() {
    let files = Files::new();
    let options = Options { fill_voids: 8, ..Options::plain(8.0) };
    let bounds_deg = files.bounds_deg([[300.0, 300.0], [700.0, 800.0]]);
    let with = files.settings("with.pmtiles", options, Some(bounds_deg));
    let without = files.settings("without.pmtiles", options, None);
    let planned =
        |settings: &BuildSettings| plan(&settings.plan, settings.resources, &Silent).unwrap().0;
    let (own, other) = (planned(&with), planned(&without));
    assert_ne!(own.hash(), other.hash());
    let said = own.differences(&other).join("; ");
    assert!(said.contains("--bounds"), "{said}");
    // Workers plan again from the plan's own settings.
    let read = BuildPlan::from_json(&own.to_json().unwrap()).unwrap();
    assert_eq!(read.settings().unwrap().terrain.plan.bounds_deg, Some(bounds_deg));
    assert_eq!(BuildPlan::make(&read.settings().unwrap()).unwrap(), own);

    build(&with, &Silent).unwrap();
    let bytes = fs::read(&with.output).unwrap();
    let mut again = files.settings("again.pmtiles", options, Some(bounds_deg));
    again.plan.dem.clear();
    again.plan.terrain_of = Some(with.output.clone());
    again.plan.terrain.max_error_m = Some(8.0);
    build(&again, &Silent).unwrap();
    assert!(fs::read(&again.output).unwrap() == bytes, "the terrain of a package with bounds");
    // Bounds that differ from the package's are rejected.
    again.plan.terrain.plan.bounds_deg = Some([9.0, 47.0, 9.1, 47.1]);
    again.output = files.at("refused.pmtiles");
    let error = build(&again, &Silent).unwrap_err().to_string();
    assert!(error.contains("--bounds"), "{error}");
}

#[test]
fn verify_sees_every_change_of_what_a_package_says_of_its_part() {
    let files = Files::new();
    let bounds_deg = files.bounds_deg([[300.0, 300.0], [700.0, 800.0]]);
    let settings = files.settings("part.pmtiles", Options::plain(60.0), Some(bounds_deg));
    build(&settings, &Silent).unwrap();
    let package = FilePackage::open(&settings.output).unwrap();
    let tiles: Vec<_> = package
        .tile_ids()
        .unwrap()
        .into_iter()
        .map(|id| (id, package.tile(id).unwrap().unwrap()))
        .collect();
    let changes: [fn(&mut Manifest); 6] = [
        |manifest| manifest.clip.as_mut().unwrap().nodes[0].i -= 1,
        |manifest| manifest.clip.as_mut().unwrap().nodes[1].j += 1,
        |manifest| manifest.clip.as_mut().unwrap().whole_data_bounds.min_x += 1.0,
        |manifest| manifest.clip.as_mut().unwrap().whole_wgs84_bounds.max_y += 1e-9,
        |manifest| manifest.clip = None,
        |_| {},
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let mut manifest = package.manifest().clone();
        change(&mut manifest);
        let path = files.at(&format!("changed-{number}.pmtiles"));
        crate::support::parts::write(&path, &manifest, &tiles).unwrap();
        let request = VerifySettings {
            dem: vec![files.at("dem.tif")],
            photo: Vec::new(),
            osm: None,
            threads: 2,
            polygon: None,
        };
        let report = verify(&FilePackage::open(&path).unwrap(), &request, &Silent).unwrap();
        let is_broken =
            report.checks.iter().any(|check| check.id == CheckId::DemPlan && !check.holds());
        assert_eq!(is_broken, number < 5, "change {number}");
    }
}

#[test]
fn files_outside_the_bounds_are_not_read() {
    let files = Files::new();
    // The same samples in two files: the eastern half, and a file far in the west of it.
    let height = |column: i64, row: i64| 200.0 * waves(column, row);
    let west = Raster::new([300, 600], [0, 0], height);
    let east = Raster::new([900, 600], [300, 0], |column, row| height(column + 300, row));
    west.write(&files.at("west.tif"));
    east.write(&files.at("east.tif"));
    let corners = [[500.0, 100.0], [850.0, 500.0]].map(|at| east.position_m(at));
    let [low, high] = [utm_to_degrees(&corners)[0], utm_to_degrees(&corners)[1]];
    let bounds_deg = [low[0], high[1], high[0], low[1]];
    let made = |name: &str, bounds_deg| {
        let mut settings =
            files.settings(name, Options { fill_voids: 8, ..Options::plain(30.0) }, bounds_deg);
        settings.plan.dem = vec![files.at("east.tif"), files.at("west.tif")];
        settings.plan.osm.clear();
        build(&settings, &Silent).unwrap();
        settings.output
    };
    let (whole, part) = (made("whole.pmtiles", None), made("part.pmtiles", Some(bounds_deg)));
    let inputs = |path: &Path| FilePackage::open(path).unwrap().manifest().inputs.clone();
    let (all, some) = (inputs(&whole), inputs(&part));
    assert_eq!(some[0], all[0]);
    assert_eq!(
        (some[1].sha256.as_str(), some[1].bytes, &some[1].name),
        ("", all[1].bytes, &all[1].name)
    );
    let checked = |dem: Vec<PathBuf>| {
        verify(
            &FilePackage::open(&part).unwrap(),
            &VerifySettings { dem, photo: Vec::new(), osm: None, threads: 2, polygon: None },
            &Silent,
        )
    };
    let report = checked(vec![files.at("east.tif"), files.at("west.tif")]).unwrap();
    assert!(report.checks.iter().all(corniche_verify::Check::holds), "{:#?}", report.checks);
    // The grid needs all files, and the same files must be used.
    assert!(checked(vec![files.at("east.tif")]).is_err());
    assert!(checked(vec![files.at("west.tif"), files.at("dem.tif")]).is_err());
}
