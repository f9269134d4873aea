//! `export quantized-mesh`: decoded by an independent reader, transformed to the package's CRS by
//! PROJ and compared with its ground.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod checks;
mod terrain;

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use checks::{
    check_borders, check_header, check_heights, check_mesh, check_normals, check_tree,
    normals_against_the_vertical,
};
use corniche_testing::{Raster, real_data};
use e2e::{
    build_from, cases, copy_pass, corniche, ground::Region, manifest, names, sample, some_of, text,
};
use serde_json::Value;
use tempfile::TempDir;
use terrain::{LAST, Name, Terrain};

/// The sample, with heights above EGM96, whose grid comes with PROJ.
fn pass() -> Region {
    Region {
        crs: "EPSG:32632+5773".to_owned(),
        metres_per_unit: [1.0; 2],
        dem: sample("pass/pass-dem.tif"),
    }
}

fn built(folder: &TempDir) -> PathBuf {
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet", "--dem-vertical-crs", "EPSG:5773", "--relief", "off"]);
    package
}

/// Exports a package to a folder next to it.
fn export(package: &Path, name: &str, options: &[&str]) -> PathBuf {
    let folder = package.with_file_name(name);
    let words = ["export", "quantized-mesh", text(package), "-o", text(&folder)];
    let ran = corniche(words.iter().chain(options));
    assert_eq!(ran.code, 0, "{}", ran.err);
    folder
}

#[expect(clippy::print_stdout, reason = "figures for whoever runs it with --nocapture")]
fn check_all(terrain: &Terrain, package: &Path, region: &Region) {
    check_tree(terrain).unwrap();
    for (name, tile) in &terrain.tiles {
        check_mesh(tile).unwrap_or_else(|error| panic!("{name:?}: {error}"));
        check_header(tile).unwrap_or_else(|error| panic!("{name:?}: {error}"));
        check_normals(tile).unwrap_or_else(|error| panic!("{name:?}: {error}"));
    }
    check_borders(terrain).unwrap();
    let turns = normals_against_the_vertical(terrain);
    assert!(turns < 0.5, "normals explain the triangles no better than the vertical: {turns}");
    let levels = check_heights(terrain, package, region);
    for (level, found) in levels.iter().enumerate().filter(|(_, found)| found.places > 0) {
        let told = &terrain.layer["corniche"]["levels"][level];
        println!("level {level}: {found:?}, told: {told}");
        found.check(told).unwrap_or_else(|error| panic!("level {level}: {error}"));
    }
    assert!(levels.iter().map(|found| found.vertices).sum::<u64>() > 1000);
    assert!(levels.iter().map(|found| found.places).sum::<u64>() > 10_000);
}

/// In both grids (in a quick run and in CI: in one): the ground of the package within each level's
/// error, closed, the same on both sides of borders.
#[test]
fn tiles_are_the_package_s_ground() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let level = cases(12, 12, 13);
    for tiling in some_of(["geographic", "web-mercator"], [2, 2, 1]) {
        let options = ["--tiling", tiling, "--max-level", &level.to_string()];
        let terrain = Terrain::read(&export(&package, tiling, &options));
        assert_eq!(terrain.levels(), level + 1);
        check_all(&terrain, &package, &pass());
    }
}

/// The same on real elevation, in degrees and with voids.
#[test]
#[ignore = "slow: two regions, all levels"]
fn real_regions_are_the_package_s_ground() {
    let regions = [
        (
            ["liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2021-10-28.osm.pbf"],
            cases("9", "9", "10"),
        ),
        (
            ["portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf"],
            cases("12", "12", "13"),
        ),
    ];
    for (files, level) in some_of(regions, [2, 2, 1]) {
        let [Some(dem), Some(osm)] = files.map(real_data) else { return };
        let folder = TempDir::new().unwrap();
        let package = folder.path().join("region.pmtiles");
        let options = ["--quiet", "--dem-vertical-crs", "EPSG:5773", "--relief", "off"];
        build_from([&dem, &osm], &package, &options);
        let manifest = manifest(&package);
        let metres_per_unit = [0, 1].map(|k| manifest["metres_per_unit"][k].as_f64().unwrap());
        let crs = format!("{}+5773", manifest["crs"].as_str().unwrap());
        let region = Region { crs, metres_per_unit, dem: dem.clone() };
        let terrain = Terrain::read(&export(&package, "terrain", &["--max-level", level]));
        check_all(&terrain, &package, &region);
    }
}

/// Coarse levels read the same tiles of the package again and again. When not all of them were
/// cached, an export of this square took eight times as long.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "slow: a square degree"]
fn a_square_degree_is_read_about_once() {
    /// Upper limit of the bytes of libraries and their data.
    const START_BYTES: u64 = 2_000_000;
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let folder = TempDir::new().unwrap();
    let package = built_of(&folder, &dem);
    let output = folder.path().join("terrain");
    let [from, to] = [&package, &output].map(|path| text(path));
    let options = ["--max-level", "9", "--heights", "as-is"];
    let command = [&["export", "quantized-mesh", from, "-o", to][..], &options].concat();
    let mut child = e2e::start(&command);
    let (ran, costs) = e2e::ended_with_costs(&mut child);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let package_bytes = fs::metadata(&package).unwrap().len();
    // Some tiles are computed in advance for the estimate of the files' size.
    let about_once = package_bytes / 2..START_BYTES + package_bytes * 2;
    assert!(about_once.contains(&costs.read_bytes), "{} of {package_bytes}", costs.read_bytes);
}

/// A change that makes a terrain, or the region that it is compared with, wrong.
type Change = fn(&mut Terrain, &mut Region);

/// The checks detect errors.
#[test]
#[ignore = "slow: an export of all levels"]
fn wrong_terrain_is_seen() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let right = export(&package, "terrain", &["--max-level", cases("10", "10", "12")]);
    let is_wrong = |terrain: &Terrain, region: &Region| {
        let levels = check_heights(terrain, &package, region);
        let told = |level: usize| &terrain.layer["corniche"]["levels"][level];
        levels
            .iter()
            .enumerate()
            .any(|(level, found)| found.places > 0 && found.check(told(level)).is_err())
    };
    assert!(!is_wrong(&Terrain::read(&right), &pass()));
    let changes: [(&str, Change); 3] = [
        ("v flipped", |terrain, _| {
            for tile in terrain.tiles.values_mut() {
                tile.uv.iter_mut().for_each(|[_, v]| *v = LAST - *v);
                tile.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
            }
        }),
        ("the geoid left out", |_, region| region.crs = "EPSG:32632".to_owned()),
        ("deviations halved", |terrain, _| {
            for level in terrain.layer["corniche"]["levels"].as_array_mut().unwrap() {
                for name in ["deviation_m", "assumed_error_m"] {
                    level[name] = (level[name].as_f64().unwrap_or_default() / 2.0).into();
                }
            }
        }),
    ];
    for (name, change) in some_of(changes, [3, 3, 1]) {
        let (mut terrain, mut region) = (Terrain::read(&right), pass());
        change(&mut terrain, &mut region);
        assert!(is_wrong(&terrain, &region), "{name}");
    }
    let mut upright = Terrain::read(&right);
    for tile in upright.tiles.values_mut() {
        tile.normals = (0..tile.uv.len()).map(|vertex| tile.up(vertex)).collect();
    }
    assert!(normals_against_the_vertical(&upright) > 0.99, "normals that stand upright");
    let mut moved = Terrain::read(&right);
    let tile = moved.tiles.values_mut().next_back().unwrap();
    let border = tile.edges[0][tile.edges[0].len() / 2];
    tile.steps[border] = tile.steps[border].wrapping_add(900);
    let beside = check_borders(&moved).is_err() || is_wrong(&moved, &pass());
    assert!(beside, "a vertex on a border moved");
    let mut open = Terrain::read(&right);
    let tile = open.tiles.values_mut().next_back().unwrap();
    tile.triangles.pop();
    assert!(check_mesh(tile).is_err(), "a triangle left out");
    let mut gone = Terrain::read(&right);
    gone.tiles.remove(&[0, 0, 0]);
    assert!(check_tree(&gone).is_err(), "a root left out");
}

/// Builds a package from a raster only.
fn built_of(folder: &TempDir, dem: &Path) -> PathBuf {
    let package = folder.path().join("raster.pmtiles");
    let ran = corniche(["build", "--dem", text(dem), "-o", text(&package), "--relief", "off"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

/// Flat ground has no error that determines a level; there are no more levels than its cells need.
#[test]
fn flat_ground_has_few_levels() {
    let folder = TempDir::new().unwrap();
    let raster = Raster::new(32632, [65, 65], [560_000.0, 500.0, 0.0, 5_230_000.0, 0.0, -500.0]);
    let dem = raster.write(folder.path(), "flat.tif", |_| 400.0_f32);
    let package = built_of(&folder, &dem);
    let terrain = Terrain::read(&export(&package, "terrain", &["--heights", "as-is"]));
    assert_eq!(terrain.levels(), 11, "tiles of 64 cells of some 300 m");
    check_tree(&terrain).unwrap();
    // Too many tiles are rejected before any are written.
    let output = folder.path().join("fine");
    let words = ["export", "quantized-mesh", text(&package), "-o", text(&output)];
    let ran = corniche(words.iter().chain(&["--heights", "as-is", "--max-level", "24"]));
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--max-level"), "{}", ran.err);
    assert!(!output.exists());
}

/// Levels, files and bytes are reported before anything is written, and the finest level is that of
/// the package's cells.
#[test]
fn what_will_be_written_is_told_and_too_much_is_refused() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let output = folder.path().join("terrain");
    let run = |options: &[&str]| {
        let words = ["export", "quantized-mesh", text(&package), "-o", text(&output), "-O"];
        corniche(words.iter().chain(options))
    };
    let ran = run(&[]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let told = ran.err.lines().find(|line| line.starts_with("terrain  ")).unwrap();
    assert!(told.contains("estimated"), "{told}");
    let between = |from: &str, to: &str| {
        let (_, rest) = told.split_once(from).unwrap();
        rest.split_once(to).unwrap().0.replace([' ', '\u{202f}', ','], "")
    };
    let terrain = Terrain::read(&output);
    assert_eq!(between("levels 0 to ", ":"), (terrain.levels() - 1).to_string(), "{told}");
    let sizes: Vec<u64> = walk(&output);
    let most: usize = between("at most ", " files").parse().unwrap();
    assert!(sizes.len() <= most && most <= 2 * sizes.len() + 8, "{} {told}", sizes.len());
    let (number, unit) = told.split_once("about ").unwrap().1.split_once(' ').unwrap();
    let unit = match unit.split_whitespace().next().unwrap() {
        "B" => 1.0,
        "kB" => 1e3,
        "MB" => 1e6,
        unit => panic!("{unit}: {told}"),
    };
    let estimate = number.parse::<f64>().unwrap() * unit;
    let found = sizes.iter().sum::<u64>() as f64;
    assert!((0.5..2.0).contains(&(estimate / found)), "{estimate} {found}");
    fs::remove_dir_all(&output).unwrap();
    for options in [&["--max-files", "5"][..], &["--max-level", "22"], &["--max-level", "24"]] {
        let begun = std::time::Instant::now();
        let ran = run(options);
        assert_eq!(ran.code, 2, "{options:?}: {}", ran.err);
        assert!(ran.err.contains("--max-level "), "{options:?}: {}", ran.err);
        assert!(!output.exists() && begun.elapsed().as_secs() < 60);
    }
    // The option in the message is the one that must be given.
    let ran = run(&["--max-files", "5"]);
    let asked = ran.err.split("--max-files ").nth(1).unwrap().split(',').next().unwrap();
    assert_eq!(run(&["--max-files", asked]).code, 0);
}

/// The sizes of all files in a folder.
fn walk(folder: &Path) -> Vec<u64> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let sizes = entries.map(|entry| match entry.metadata().unwrap() {
        metadata if metadata.is_dir() => walk(&entry.path()),
        metadata => vec![metadata.len()],
    });
    sizes.flatten().collect()
}

/// The borders of tiles follow the ground: also in steep mountains, each level is within four
/// fifths of its error at all checked points.
#[test]
fn steep_ground_is_followed_on_borders() {
    let Some(dem) = real_data("liechtenstein/N47E010.hgt") else { return };
    let folder = TempDir::new().unwrap();
    let package = folder.path().join("alps.pmtiles");
    let place = ["--bounds", "10.36,47.08,10.40,47.11", "--max-error", "1", "--relief", "off"];
    let line = ["build", "-q", "--dem", text(&dem), "-o", text(&package)];
    let ran = corniche(line.iter().chain(&place));
    assert_eq!(ran.code, 0, "{}", ran.err);
    let options = ["--heights", "as-is", "--max-level", "15"];
    let terrain = Terrain::read(&export(&package, "terrain", &options));
    check_tree(&terrain).unwrap();
    check_borders(&terrain).unwrap();
    for told in &terrain.layer["corniche"]["levels"].as_array().unwrap()[12..] {
        let [deviation_m, assumed_m] =
            ["deviation_m", "assumed_error_m"].map(|name| told[name].as_f64().unwrap());
        // Heights are rounded to a 32 767th of a tile's range.
        assert!(deviation_m <= 0.8 * assumed_m + 0.02, "{told}");
    }
}

/// A tile of the package is many times as wide as these data, and the table of coordinates ends
/// close to them.
#[test]
fn data_of_few_nodes_have_terrain() {
    for (side, cell_m) in [(2, 1.0), (3, 0.25), (4, 10.0)] {
        let folder = TempDir::new().unwrap();
        let place = [600_000.0, cell_m, 0.0, 5_230_000.0, 0.0, -cell_m];
        let raster = Raster::new(32632, [side, side], place);
        let slope =
            |[x, y]: [f64; 2]| (400.0 + (x - 600_000.0) * (y - 5_230_000.0) / cell_m) as f32;
        let package = built_of(&folder, &raster.write(folder.path(), "few.tif", slope));
        let terrain = Terrain::read(&export(&package, "terrain", &["--heights", "as-is"]));
        check_tree(&terrain).unwrap();
        let finest = terrain.levels() - 1;
        let there = terrain.tiles.keys().filter(|name| name[0] == finest).count();
        assert!((1..=9).contains(&there), "{side}: {there} tiles of level {finest}");
        let told = &terrain.layer["corniche"]["levels"][finest as usize];
        assert!(told["deviation_m"].as_f64().unwrap() <= told["assumed_error_m"].as_f64().unwrap());
    }
}

/// `--bounds` exports whole tiles of the finest level, with the bytes of the whole export, and
/// their parents.
#[test]
fn bounds_take_the_tiles_that_meet_them() {
    let folder = TempDir::new().unwrap();
    let raster = Raster::new(32632, [61, 61], [535_000.0, 150.0, 0.0, 5_199_000.0, 0.0, -150.0]);
    let hills = |[x, y]: [f64; 2]| (300.0 + 80.0 * (x / 900.0).sin() * (y / 700.0).cos()) as f32;
    let package = built_of(&folder, &raster.write(folder.path(), "hills.tif", hills));
    let export = |name: &str, more: &[&str]| {
        let options = ["--heights", "as-is", "--max-level", "12"];
        export(&package, name, &[&options, more].concat())
    };
    let whole = export("whole", &[]);
    let bounds = [9.50, 46.89, 9.52, 46.91];
    let text = bounds.map(|degrees| degrees.to_string()).join(",");
    let part = export("part", &["--bounds", &text]);
    let [all, some] = [&whole, &part].map(|folder| Terrain::read(folder));
    check_tree(&some).unwrap();
    let side = 180.0 / f64::from(1 << 12);
    let meets = |&&[level, x, y]: &&Name| {
        let (west, south) = (f64::from(x) * side - 180.0, f64::from(y) * side - 90.0);
        let is_across = west < bounds[2] && west + side > bounds[0];
        level == 12 && is_across && south < bounds[3] && south + side > bounds[1]
    };
    let finest = |terrain: &Terrain| -> Vec<Name> {
        terrain.tiles.keys().filter(|name| name[0] == 12).copied().collect()
    };
    let wanted: Vec<Name> = all.tiles.keys().filter(meets).copied().collect();
    assert!(wanted.len() < finest(&all).len() && !wanted.is_empty());
    assert_eq!(finest(&some), wanted);
    for [level, x, y] in wanted {
        let [one, other] = [&whole, &part]
            .map(|folder| fs::read(folder.join(format!("{level}/{x}/{y}.terrain"))).unwrap());
        assert!(one == other, "{level}/{x}/{y}");
    }
    let told: Vec<f64> =
        some.layer["bounds"].as_array().unwrap().iter().map(|at| at.as_f64().unwrap()).collect();
    assert!(told.iter().zip(bounds).all(|(told, asked)| (told - asked).abs() < 1e-12), "{told:?}");
    let output = folder.path().join("beside");
    let words = ["export", "quantized-mesh", e2e::text(&package), "-o", e2e::text(&output)];
    let ran = corniche(words.iter().chain(&["--heights", "as-is", "--bounds", "20,46,21,47"]));
    assert!(ran.code == 2 && ran.err.contains("no ground in the requested area"), "{}", ran.err);
}

/// Ground that is smaller than the sampling distance of a coarse level is not lost.
#[test]
fn small_ground_is_on_coarse_levels() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let terrain = Terrain::read(&export(&package, "terrain", &["--max-level", "3"]));
    assert_eq!(terrain.levels(), 4);
    let told = &terrain.layer["corniche"]["levels"][3];
    assert!(told["deviation_m"].as_f64().unwrap() > 0.0, "{told}");
}

/// Terrain is the same on both sides of 180° as elsewhere, in both grids.
#[test]
fn terrain_goes_on_across_the_antimeridian() {
    let folder = TempDir::new().unwrap();
    let raster = Raster::new(32660, [81, 61], [824_800.0, 100.0, 0.0, 1_110_000.0, 0.0, -100.0]);
    let hills =
        |[x, y]: [f64; 2]| (300.0 + 80.0 * (x / 900.0).sin() + 60.0 * (y / 700.0).cos()) as f32;
    let dem = raster.write(folder.path(), "across.tif", hills);
    let package = built_of(&folder, &dem);
    let region =
        Region { crs: "EPSG:32660".to_owned(), metres_per_unit: [1.0; 2], dem: dem.clone() };
    for tiling in ["geographic", "web-mercator"] {
        let options = ["--tiling", tiling, "--max-level", "12", "--heights", "as-is"];
        let terrain = Terrain::read(&export(&package, tiling, &options));
        let last = terrain.tiles.keys().map(|name| name[1]).max().unwrap();
        assert!(terrain.tiles.contains_key(&[0, 0, 0]) && last > 2000, "nothing in the west");
        check_tree(&terrain).unwrap();
        check_borders(&terrain).unwrap();
        let levels = check_heights(&terrain, &package, &region);
        for (level, found) in levels.iter().enumerate().filter(|(_, found)| found.places > 0) {
            found.check(&terrain.layer["corniche"]["levels"][level]).unwrap();
        }
        assert!(levels[12].places > 1000, "{:?}", levels[12]);
        let both =
            [0, last].map(|x| terrain.tiles.keys().any(|name| name[0] == 12 && name[1] == x));
        assert_eq!(both, [true; 2], "tiles on both sides");
    }
}

/// Web Mercator ends before the poles.
#[test]
fn data_beyond_the_grid_are_refused() {
    let folder = TempDir::new().unwrap();
    let raster = Raster::new(4326, [41, 21], [10.0, 0.01, 0.0, 85.15, 0.0, -0.01]);
    let dem = raster.write(folder.path(), "north.tif", |[lon, _]| (100.0 * lon) as f32);
    let package = built_of(&folder, &dem);
    let output = folder.path().join("terrain");
    let run = |tiling: &str| {
        let words = ["export", "quantized-mesh", text(&package), "-o", text(&output)];
        corniche(words.iter().chain(&[
            "--heights",
            "as-is",
            "--max-level",
            "8",
            "--tiling",
            tiling,
        ]))
    };
    let ran = run("web-mercator");
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--tiling geographic"), "{}", ran.err);
    assert!(!output.exists());
    assert_eq!(run("geographic").code, 0);
}

/// Availability in tiles covers all tiles, and layer.json declares it.
#[test]
#[ignore = "slow: two exports of all levels"]
fn availability_in_tiles_is_that_of_layer_json() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let [layer, tiles] = ["layer", "tiles"].map(|place| {
        let options = ["--max-level", "12", "--availability", place];
        Terrain::read(&export(&package, place, &options))
    });
    assert!(layer.tiles.values().all(|tile| tile.metadata.is_none()));
    assert!(layer.layer.get("metadataAvailability").is_none());
    assert!(tiles.layer.get("available").is_none());
    let depth = tiles.layer["metadataAvailability"].as_u64().unwrap() as u32;
    let mut told: BTreeSet<Name> =
        tiles.tiles.keys().filter(|name| name[0] == 0).copied().collect();
    for ([level, x, y], tile) in &tiles.tiles {
        let metadata = tile.metadata.as_ref();
        assert_eq!(metadata.is_some(), level % depth == 0, "{level}/{x}/{y}");
        let levels = metadata.and_then(|metadata| metadata["available"].as_array());
        for (down, blocks) in levels.into_iter().flatten().enumerate() {
            told.extend(checks::tiles_of(blocks, level + 1 + down as u32));
        }
    }
    assert_eq!(told, layer.tiles.keys().copied().collect());
    assert!(told.len() > 20);
}

/// Any number of threads produces the same bytes; compressed files contain the same tiles.
#[test]
#[ignore = "slow: three exports of all levels"]
fn bytes_do_not_depend_on_threads() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let last = cases(10, 10, 12);
    let of = |name: &str, options: &[&str]| {
        export(&package, name, &[&["--max-level", &last.to_string()], options].concat())
    };
    let [one, three] = ["1", "3"].map(|count| of(count, &["--threads", count]));
    let packed = of("packed", &["--compress", "gzip"]);
    for level in 0..=last {
        for x in names(&one.join(level.to_string())) {
            for y in names(&one.join(format!("{level}/{x}"))) {
                let [one, three, packed] = [&one, &three, &packed]
                    .map(|folder| fs::read(folder.join(format!("{level}/{x}/{y}"))).unwrap());
                assert_eq!(one, three);
                assert!(packed.starts_with(&[0x1f, 0x8b]) && packed.len() < one.len() + 40);
            }
        }
    }
    let [one, packed] = [one, packed].map(|folder| Terrain::read(&folder));
    assert_eq!(one.layer, packed.layer);
    assert!(one.tiles.iter().zip(&packed.tiles).all(|(one, other)| one.1.uv == other.1.uv));
}

#[test]
fn what_cannot_be_exported_is_refused_and_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let unknown = folder.path().join("unknown.pmtiles");
    copy_pass(&unknown, &["--quiet", "--relief", "off"]);
    let output = folder.path().join("terrain");
    let run = |options: &[&str]| {
        let words = ["export", "quantized-mesh", text(&unknown), "-o", text(&output)];
        corniche(words.iter().chain(options))
    };
    let ran = run(&[]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--heights as-is"), "{}", ran.err);
    assert_eq!(names(folder.path()), ["unknown.pmtiles"]);
    let as_is = ["--heights", "as-is", "--max-level", "9", "--quiet"];
    assert_eq!(run(&as_is).code, 0);
    let layer: Value =
        serde_json::from_slice(&fs::read(output.join("layer.json")).unwrap()).unwrap();
    assert!(layer["description"].as_str().unwrap().contains("unknown"), "{layer}");
    // An earlier export is overwritten on request, another folder never.
    assert_eq!(run(&as_is).code, 3);
    assert_eq!(run(&[&as_is[..], &["-O"]].concat()).code, 0);
    fs::remove_dir_all(&output).unwrap();
    fs::create_dir(&output).unwrap();
    fs::write(output.join("mine.txt"), "mine").unwrap();
    assert_eq!(run(&[&as_is[..], &["-O"]].concat()).code, 2);
    assert_eq!(names(&output), ["mine.txt"]);
}
