//! `export 3dtiles`: decoded by an independent reader, transformed back by PROJ and compared with
//! the package.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod bridges;
mod checks;
mod glb;
mod photos;
mod relief;
mod tiles;
mod vectors;

use std::{collections::BTreeMap, fs, path::PathBuf};

use checks::{Findings, check_borders, check_heights, check_roads, check_watertight};
use corniche_testing::Raster;
use e2e::{copy_pass, corniche, ground::Region, text};
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use tempfile::TempDir;
use tiles::Tiles;

/// The sample, with heights above EGM96, whose grid comes with PROJ.
fn pass() -> Region {
    Region {
        crs: "EPSG:32632+5773".to_owned(),
        metres_per_unit: [1.0; 2],
        dem: e2e::sample("pass/pass-dem.tif"),
    }
}

/// The sample with heights above the geoid of EGM96.
fn built(folder: &TempDir) -> PathBuf {
    let package = folder.path().join("pass.pmtiles");
    copy_pass(
        &package,
        &["--dem-vertical-crs", "EPSG:5773", "--relief", "off", "--structures", "ground"],
    );
    package
}

fn export(package: &std::path::Path, name: &str, more: &[&str]) -> PathBuf {
    let folder = package.with_file_name(name);
    let words = ["export", "3dtiles", text(package), "-o", text(&folder), "--compress", "none"];
    let ran = corniche([&words[..], more].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    folder
}

/// Everywhere on the ground, on every level, the tiles are within a centimetre of the package; they
/// are equal at borders, closed, and have roads at the right positions.
#[test]
fn tiles_are_the_package_s_ground_with_its_roads() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let tiles = Tiles::read(&export(&package, "cut", &[]), &package);
    let found = check_heights(&tiles, &pass(), 1000);
    assert!(found.points > 100_000, "{found:?}");
    assert!(found.largest_m <= 0.01 && found.off_ground == 0, "{found:?}");
    check_borders(&tiles, &pass()).unwrap();
    check_watertight(&tiles, &pass()).unwrap();
    check_roads(&tiles, &pass()).unwrap();
    tiles.check_tree().unwrap();
    tiles.check_against_dem(&pass()).unwrap();
}

/// The same checks on real elevation and roads, in degrees and with voids. SRTM's heights are above
/// EGM96; those of the others are treated as such.
#[test]
#[ignore = "slow: exports of two regions"]
fn real_regions_are_the_package_s_ground_with_its_roads() {
    let regions = [
        ("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2021-10-28.osm.pbf"),
        ("portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf"),
    ];
    for (dem, osm) in e2e::some_of(regions, [2, 2, 1]) {
        let [Some(dem), Some(osm)] = [dem, osm].map(corniche_testing::real_data) else { return };
        let folder = TempDir::new().unwrap();
        let package = folder.path().join("region.pmtiles");
        let ground = ["--structures", "ground", "--relief", "off"];
        let options = [&["--dem-vertical-crs", "EPSG:5773"][..], &ground].concat();
        e2e::build_from([&dem, &osm], &package, &options);
        let manifest = e2e::manifest(&package);
        let metres_per_unit = [0, 1].map(|k| manifest["metres_per_unit"][k].as_f64().unwrap());
        let crs = format!("{}+5773", manifest["crs"].as_str().unwrap());
        let region = Region { crs, metres_per_unit, dem: dem.clone() };
        let tiles = Tiles::read(&export(&package, "cut", &[]), &package);
        let found = check_heights(&tiles, &region, 100_000 / tiles.tiles.len());
        println!("{dem:?}: {found:?}");
        assert!(found.points > 200_000, "{found:?}");
        assert!(found.largest_m <= 0.01 && found.off_ground == 0, "{dem:?} {found:?}");
        check_borders(&tiles, &region).unwrap();
        check_watertight(&tiles, &region).unwrap();
        check_roads(&tiles, &region).unwrap();
        tiles.check_tree().unwrap();
        tiles.check_against_dem(&region).unwrap();
    }
}

/// The checks detect drawing errors.
#[test]
fn wrong_drawings_are_seen() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let right = Tiles::read(&export(&package, "cut", &["--roads", "none"]), &package);
    let with_crs = |crs: &str| Region { crs: crs.to_owned(), ..pass() };
    let is_wrong = |found: &Findings| found.largest_m > 0.01 || found.off_ground > 0;
    let found = check_heights(&right, &pass(), 50);
    assert!(!is_wrong(&found), "{found:?}");
    let mut flipped = right.clone();
    flipped.for_each_vertex(|_, at| at[1] = -at[1]);
    assert!(is_wrong(&check_heights(&flipped, &pass(), 50)), "y flipped");
    assert!(is_wrong(&check_heights(&right, &with_crs("EPSG:4979"), 0)), "another CRS");
    // Above the ellipsoid: the CRS without the geoid.
    let without_geoid = check_heights(&right, &with_crs("EPSG:32632+4979"), 0);
    assert!((45.0..55.0).contains(&without_geoid.largest_m), "{without_geoid:?}");
    let mut straight = right.clone();
    straight.by_one_matrix_a_tile(&pass());
    assert!(is_wrong(&check_heights(&straight, &pass(), 50)), "one matrix a tile");
    let mut halved = right.clone();
    halved.halve_errors();
    assert!(halved.check_against_dem(&pass()).is_err(), "errors halved");
    let mut torn = right.clone();
    torn.for_each_vertex(|vertex, at| {
        if vertex == 7 {
            at[2] += 0.002;
        }
    });
    assert!(
        check_watertight(&torn, &pass()).is_err() || check_borders(&torn, &pass()).is_err(),
        "torn"
    );
}

/// On flat ground of 32 km a tile has two triangles. If their edges were not divided, it would be
/// some 40 m below the earth's surface, which its heights show.
#[test]
fn flat_ground_follows_the_earth() {
    let folder = TempDir::new().unwrap();
    let cell_m = 500.0;
    let raster = Raster::new(32632, [65, 65], [560_000.0, cell_m, 0.0, 5_230_000.0, 0.0, -cell_m]);
    let dem = raster.write(folder.path(), "flat.tif", |_| 400.0_f32);
    let package = folder.path().join("flat.pmtiles");
    let words = ["build", "--dem", text(&dem), "-o", text(&package), "--relief", "off"];
    let ran = corniche(words.iter().chain(&["--dem-vertical-crs", "EPSG:5773"]));
    assert_eq!(ran.code, 0, "{}", ran.err);
    let region = Region { dem, ..pass() };
    let right = Tiles::read(&export(&package, "flat", &[]), &package);
    assert!(right.tiles.iter().all(|tile| tile.ground.triangles.len() < 10), "not flat");
    let found = check_heights(&right, &region, 20_000);
    assert!(found.largest_m <= 0.01 && found.off_ground == 0, "{found:?}");
    let mut undivided = right.clone();
    undivided.undivide(&region);
    // The corners are still right; only the points between them show the error.
    let corners = check_heights(&undivided, &region, 0);
    assert!(corners.largest_m <= 0.01, "{corners:?}");
    let found = check_heights(&undivided, &region, 20_000);
    let side_m = 64.0 * cell_m;
    let sag_m = 2.0 * side_m * side_m / (8.0 * 6_370_000.0);
    assert!((0.7 * sag_m..=1.1 * sag_m).contains(&found.largest_m), "{found:?}, not {sag_m}");
}

/// No edge is longer than the limit for division.
#[test]
fn long_edges_are_divided() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let tiles = Tiles::read(&export(&package, "none", &["--roads", "none"]), &package);
    let longest = tiles.longest_edge_m();
    assert!((200.0..=451.0).contains(&longest), "{longest}");
}

/// The bytes are the same for any number of threads, and roads follow the options.
#[test]
fn options_do_what_they_say() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let contents = |folder: &PathBuf| -> BTreeMap<String, Vec<u8>> {
        tiles::files_of(folder)
            .into_iter()
            .filter(|(name, _)| tiles::has_ending(name, "glb") || tiles::has_ending(name, "json"))
            .map(|(name, path)| (name, fs::read(path).unwrap()))
            .collect()
    };
    let one = contents(&export(&package, "one", &["--threads", "1"]));
    assert_eq!(one, contents(&export(&package, "four", &["--threads", "4"])));
    let parts = |name: &str, more: &[&str]| {
        let tiles = Tiles::read(&export(&package, name, more), &package);
        tiles.part_names()
    };
    let all = parts("all", &[]);
    assert!(all.contains("skirt") && all.contains("terrain") && all.contains("roads FRC 0"));
    let few = parts("few", &["--skirts", "none", "--roads", "none"]);
    assert_eq!(few.into_iter().collect::<Vec<_>>(), ["terrain"]);
    let classes = parts("classes", &["--classes", "0-1", "--roads", "line"]);
    assert!(classes.contains("roads FRC 0") && !classes.contains("roads FRC 3"));
    let coarse = Tiles::read(&export(&package, "coarse", &["--finest-level", "1"]), &package);
    assert!(coarse.levels().eq(0..=1));
    let compressed = folder.path().join("compressed");
    let words = ["export", "3dtiles", text(&package), "-o", text(&compressed)];
    assert_eq!(corniche(words).code, 0);
    let bytes =
        |contents: &BTreeMap<String, Vec<u8>>| contents.values().map(Vec::len).sum::<usize>();
    let sizes = [bytes(&contents(&compressed)), bytes(&one)];
    assert!(sizes[0] * 4 < sizes[1] * 3, "{sizes:?}");
}

/// `--bounds` exports the tiles that intersect the bounds, with the same bytes as in the whole
/// export, and as many as needed to cover the bounds.
#[test]
fn bounds_take_whole_tiles() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let whole = export(&package, "whole", &[]);
    let glbs = |folder: &PathBuf| -> BTreeMap<String, PathBuf> {
        let files = tiles::files_of(folder).into_iter();
        files.filter(|(name, _)| tiles::has_ending(name, "glb")).collect()
    };
    let all = glbs(&whole);
    let [west, south, east, north] = ["min_x", "min_y", "max_x", "max_y"]
        .map(|side| e2e::manifest(&package)["wgs84_bounds"][side].as_f64().unwrap());
    let at = |share: f64| [west + (east - west) * share, south + (north - south) * share];
    // A point, a part, and everything with a margin.
    for (name, shares, largest) in
        [("place", [0.3, 0.300_01], 4), ("part", [0.1, 0.4], 20), ("all", [-0.1, 1.1], 1000)]
    {
        let [[w, s], [e, n]] = shares.map(at);
        let bounds = format!("--bounds={w},{s},{e},{n}");
        let part = export(&package, name, &[&bounds]);
        let found = glbs(&part);
        assert!(!found.is_empty() && found.len() <= largest, "{name}: {}", found.len());
        assert_eq!(found.len() == all.len(), name == "all");
        for (file, path) in &found {
            assert_eq!(fs::read(path).unwrap(), fs::read(&all[file]).unwrap(), "{name}: {file}");
        }
        let read = Tiles::read(&part, &package);
        read.check_tree().unwrap();
        // Everywhere in the bounds there is ground, on each level.
        let finest = read.levels().max().unwrap();
        assert_eq!(finest + 1, e2e::manifest(&package)["levels"].as_array().unwrap().len() as u64);
        for level in 0..=finest {
            let is_held = |at: [f64; 2]| {
                let tiles =
                    read.tiles.iter().filter(|tile| tile.name.starts_with(&format!("{level}/")));
                tiles.into_iter().any(|tile| tile.ground.height(at).is_some())
            };
            for share in [0.01, 0.5, 0.99] {
                let share = (shares[0] + (shares[1] - shares[0]) * share).clamp(0.02, 0.98);
                let [lon, lat] = at(share);
                assert!(is_held(in_crs([lon, lat])), "{name}: nothing at {share} on level {level}");
            }
        }
    }
    let target = folder.path().join("none");
    let ran =
        corniche(["export", "3dtiles", text(&package), "-o", text(&target), "--bounds=0,0,1,1"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("has no ground in the requested area"), "{}", ran.err);
}

/// Transforms to the sample's CRS.
fn in_crs([lon, lat]: [f64; 2]) -> [f64; 2] {
    let of = |code: u32| {
        let mut crs = SpatialRef::from_epsg(code).unwrap();
        crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        crs
    };
    let (mut x, mut y) = ([lon], [lat]);
    CoordTransform::new(&of(4326), &of(32632))
        .unwrap()
        .transform_coords(&mut x, &mut y, &mut [])
        .unwrap();
    [x[0], y[0]]
}

/// Exports that are impossible give an error, and leave no files.
#[test]
fn what_cannot_be_exported_is_said() {
    let folder = TempDir::new().unwrap();
    let package = folder.path().join("unknown.pmtiles");
    copy_pass(&package, &["--relief", "off", "--structures", "ground"]);
    let target = folder.path().join("out");
    let refused = |more: &[&str], words: &[&str]| {
        let all = ["export", "3dtiles", text(&package), "-o", text(&target)];
        let ran = corniche([&all[..], more].concat());
        assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
        for word in words {
            assert!(ran.err.contains(word), "{}", ran.err);
        }
        assert!(!target.exists());
    };
    refused(&[], &["--heights as-is", "unknown"]);
    refused(&["--heights", "as-is", "--finest-level", "9"], &["no level 9"]);
    fs::create_dir(&target).unwrap();
    fs::write(target.join("mine.txt"), "mine").unwrap();
    let all =
        ["export", "3dtiles", text(&package), "-o", text(&target), "--heights", "as-is", "-O"];
    let ran = corniche(all);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert_eq!(fs::read(target.join("mine.txt")).unwrap(), b"mine");
}
