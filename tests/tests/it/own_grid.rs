//! Nodes that are the DEM's own samples, with options: degrees, rectangles, thinning, several
//! grids.

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{corniche, json, manifest, real_data, sample, text, write_ascii_grid};
use serde_json::Value;

/// Height of a sample by its longitude and latitude: rough enough for a TIN, multiples of a quarter
/// of a metre.
fn height_m([lon, lat]: [f64; 2]) -> f64 {
    let waves = 400.0 + 150.0 * (lon * 210.0).sin() + 90.0 * (lat * 330.0).cos();
    (waves * 4.0).round() / 4.0
}

/// An ASCII grid of `columns` × `rows` samples in degrees, the south-western one at `first`.
fn write_degrees(path: &Path, [columns, rows]: [usize; 2], first: [f64; 2], step: f64) -> PathBuf {
    let place = format!(
        "xllcenter {}\nyllcenter {}\ncellsize {step}\nNODATA_value -9999",
        first[0], first[1]
    );
    write_ascii_grid(path, [columns, rows], &place, |column, row| {
        let steps_north = rows - 1 - row;
        height_m([first[0] + column as f64 * step, first[1] + steps_north as f64 * step])
    });
    path.to_path_buf()
}

fn build(package: &Path, dems: &[&Path], options: &[&str]) -> String {
    let mut arguments = vec!["build", "--dem"];
    arguments.extend(dems.iter().map(|dem| text(dem)));
    arguments.extend(["-o", text(package), "--quiet", "-O", "--dem-crs", "EPSG:4326"]);
    arguments.extend(options);
    let ran = corniche(arguments);
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran.err
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap_or_else(|| panic!("no list: {value}"));
    list.iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// Vertices of the finest tiles, in coordinates of the CRS, are at samples and within the error
/// bound of their heights.
#[test]
fn tiles_in_crs_coordinates_have_the_samples_as_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let (step, first) = (0.001, [9.0, 47.0]);
    let dem = write_degrees(&folder.path().join("a.asc"), [301, 301], first, step);
    let package = folder.path().join("a.pmtiles");
    assert_eq!(build(&package, &[&dem], &["--max-error", "4"]), "");
    let manifest = manifest(&package);
    assert_eq!(
        (&manifest["crs"], &manifest["nodes_are_samples"]),
        (&"EPSG:4326".into(), &true.into())
    );
    let factors = numbers(&manifest["metres_per_unit"]);
    let cell_m = numbers(&manifest["frame"]["cell_m"]);
    for axis in 0..2 {
        assert!((cell_m[axis] / factors[axis] - step).abs() < 1e-12, "{cell_m:?} {factors:?}");
    }
    let max_level = manifest["frame"]["max_level"].as_u64().unwrap();
    let tiles = json(&["info", text(&package), "--json"])["tiles"].clone();
    let mut vertices = 0;
    for id in tiles.as_array().unwrap().iter().map(|id| id.as_str().unwrap()) {
        let dump =
            |which: &str| json(&["tile", text(&package), id, "--json", "--coordinates", which]);
        let (degrees, metres) = (dump("crs"), dump("working"));
        assert_eq!(metres, json(&["tile", text(&package), id, "--json"]), "working is the default");
        assert_eq!(numbers(&metres["metres_per_unit"]), factors);
        assert_eq!(
            (&degrees["coordinates"], &metres["coordinates"]),
            (&"crs".into(), &"working".into())
        );
        assert_eq!(numbers(&metres["cell_m"]).len(), 2);
        let [in_degrees, in_metres] =
            [&degrees, &metres].map(|tile| tile["tin"]["vertices"].as_array().unwrap().clone());
        assert_eq!(in_degrees.len(), in_metres.len());
        for (at, at_m) in in_degrees.iter().zip(&in_metres) {
            let (at, at_m) = (numbers(at), numbers(at_m));
            assert!((0..2).all(|axis| (at[axis] * factors[axis] - at_m[axis]).abs() < 1e-6));
            let sample = [0, 1].map(|axis| (at[axis] - first[axis]) / step);
            assert!(sample.iter().all(|k| (k - k.round()).abs() < 1e-6), "{at:?} is no sample");
            if id.starts_with(&format!("{max_level}/")) {
                let here = [0, 1].map(|axis: usize| first[axis] + sample[axis].round() * step);
                assert!((at[2] - height_m(here)).abs() <= 0.126, "{at:?}");
                vertices += 1;
            }
        }
    }
    assert!(vertices > 1000, "{vertices}");
    let refused = corniche(["tile", text(&package), "0/0/0", "--coordinates", "crs"]);
    assert_eq!(refused.code, 2, "without --json it says nothing: {}", refused.out);
}

/// Every option for the grid can also be in a settings file; the command line takes precedence.
#[test]
fn cells_thinning_and_latitude_are_options_and_settings() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let dem = write_degrees(&at("a.asc"), [121, 121], [9.0, 47.0], 0.001);
    let settings = |name: &str, lines: &str| {
        fs::write(at(name), format!("[terrain]\n{lines}\n")).unwrap();
        at(name)
    };
    let grid = |options: &[&str]| {
        build(&at("a.pmtiles"), &[&dem], options);
        let manifest = manifest(&at("a.pmtiles"));
        (
            manifest["frame"].clone(),
            manifest["metres_per_unit"].clone(),
            manifest["resampling"].clone(),
        )
    };
    for (options, lines) in [
        (&["--cell", "60,90"][..], "cell = [60, 90]"),
        (&["--cell", "60"], "cell = 60"),
        (&["--cell-every", "3"], "cell-every = 3"),
        (&["--scale-latitude", "46"], "scale-latitude = 46"),
        (&["--crs", "utm"], "crs = \"utm\""),
    ] {
        let file = settings("own.toml", lines);
        let said = grid(options);
        assert_eq!(grid(&["--config", text(&file)]), said, "{lines}");
        assert_ne!(said, grid(&[]), "{lines}");
    }
    // --cell-every on the command line overrides the cell of the file, and --cell its cell_every.
    let cell = settings("cell.toml", "cell = [60, 90]");
    assert_eq!(grid(&["--config", text(&cell), "--cell-every", "2"]), grid(&["--cell-every", "2"]));
    let every = settings("every.toml", "cell-every = 2");
    assert_eq!(grid(&["--config", text(&every), "--cell", "60,90"]), grid(&["--cell", "60,90"]));
    let refused = |options: &[&str], words: &[&str]| {
        let mut arguments = vec!["build", "--dem", text(&dem), "--dem-crs", "EPSG:4326", "-o"];
        let target = at("none.pmtiles");
        arguments.push(text(&target));
        arguments.extend(options);
        let ran = corniche(arguments);
        assert_eq!(ran.code, 2, "{options:?}: {}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{options:?}: {}", ran.err);
        assert!(!target.exists());
    };
    refused(&["--cell", "60,90", "--cell-every", "2"], &["--cell-every", "--cell"]);
    refused(&["--cell", "60x90"], &["--cell", "20,30"]);
    refused(&["--cell", "60,-90"], &["--cell", "positive"]);
    refused(&["--cell-every", "0"], &["--cell-every 0", "from 1"]);
    refused(&["--cell-every", "200"], &["--cell-every 200", "2 × 2"]);
    refused(&["--scale-latitude", "95"], &["--scale-latitude 95", "between -89 and 89"]);
    refused(&["--crs", "EPSG:4269"], &["--crs", "EPSG:4269", "nor the CRS of the DEM"]);
    let both = settings("both.toml", "cell = 60\ncell-every = 2");
    refused(&["--config", text(&both)], &["--cell and --cell-every"]);
    let bad = settings("bad.toml", "cell = [60, 0]");
    refused(&["--config", text(&bad)], &["cell", "positive"]);
}

/// Two grids: the first named file defines the nodes. `build` warns, also with --quiet and in JSON.
#[test]
fn files_on_another_grid_than_the_first_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let south = write_degrees(&at("south.asc"), [121, 101], [9.0, 49.9], 0.001);
    let north = write_degrees(&at("north.asc"), [81, 68], [9.0, 50.0], 0.0015);
    let package = at("a.pmtiles");
    let said = build(&package, &[&south, &north], &[]);
    let words =
        ["corniche: warning: north.asc", "the grid of south.asc", "resampled onto its grid"];
    assert!(words.iter().all(|word| said.contains(word)) && said.lines().count() == 1, "{said}");
    let resampling = manifest(&package)["resampling"].as_str().unwrap().to_owned();
    assert!(resampling.starts_with("nodes are the samples of south.asc; "), "{resampling}");
    assert!(resampling.contains("between the samples of north.asc"), "{resampling}");
    let ran = corniche([
        "build",
        "--dem",
        text(&south),
        text(&north),
        "--dem-crs",
        "EPSG:4326",
        "-o",
        text(&package),
        "-O",
        "--json-progress",
    ]);
    let is_warning = |line: &str| {
        let value: Value = serde_json::from_str(line).expect("every line is JSON");
        value["warning"].as_str().is_some_and(|text| text.contains("north.asc"))
    };
    assert_eq!((ran.code, ran.err.lines().filter(|line| is_warning(line)).count()), (0, 1));
    // Files on one grid give no warning.
    assert_eq!(build(&package, &[&south], &[]), "");
}

/// `info` prints the factors and the scale in words.
#[test]
fn info_tells_factors_scale_and_sides() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let dem = write_degrees(&at("a.asc"), [121, 121], [9.0, 60.0], 0.001);
    build(&at("a.pmtiles"), &[&dem], &[]);
    let told = corniche(["info", text(&at("a.pmtiles"))]).out;
    // Long texts are folded.
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    let factors = numbers(&manifest(&at("a.pmtiles"))["metres_per_unit"]);
    // Without the last digits, because readers of JSON may round them.
    let [east, north] = [0, 1].map(|axis| format!("{:.6}", factors[axis]));
    let [east, north] = [
        format!("times {}", &east[..east.len() - 1]),
        format!("and {}", &north[..north.len() - 1]),
    ];
    for words in [
        &*east,
        &*north,
        "(east)",
        "(north)",
        "EPSG:4326",
        "cell 55.8 × 111 m",
        "along the border",
        "at the centre",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    // The bundled sample is in UTM: its factors are 1.
    let ran = corniche([
        "build",
        "--dem",
        text(&sample("pass/pass-dem.tif")),
        "-o",
        text(&at("pass.pmtiles")),
        "--quiet",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let told = corniche(["info", text(&at("pass.pmtiles"))]).out;
    assert!(told.contains("working metres are its coordinates\n"), "{told}");
}

/// Two by two samples in degrees are one cell of ground.
#[test]
fn four_samples_are_a_cell() {
    let folder = tempfile::tempdir().unwrap();
    let dem = write_degrees(&folder.path().join("a.asc"), [2, 2], [9.0, 47.0], 0.001);
    let package = folder.path().join("a.pmtiles");
    build(&package, &[&dem], &[]);
    let level = manifest(&package)["levels"][0].clone();
    assert_eq!((&level["tiles"], &level["triangles"]), (&1.into(), &2.into()));
}

/// Real rasters in degrees: nodes are the samples, and the finest level is within the bound at
/// every one on its TIN.
#[test]
fn rasters_in_degrees_are_not_resampled() {
    for file in
        ["liechtenstein/N47E009.hgt", "portland/portland-ned.tif", "swellendam/srtm_41_19_4326.tif"]
    {
        let Some(dem) = real_data(file) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("real.pmtiles");
        build(&package, &[&dem], &[]);
        let report = json(&["verify", text(&package), "--dem", text(&dem), "--json", "--quiet"]);
        assert_eq!(report["holds"], true, "{file}: {report}");
        let manifest = manifest(&package);
        assert_eq!(manifest["resampling"], "nodes are the DEM's samples", "{file}");
        let finest = manifest["levels"].as_array().unwrap().last().unwrap().clone();
        let max_m = finest["sample_error"]["max_m"].as_f64().unwrap();
        let bound_m = manifest["settings"]["max_error_m"].as_f64().unwrap();
        let quantum_m = manifest["vertical"]["quantum_m"].as_f64().unwrap();
        assert!(max_m > 0.0 && max_m <= bound_m + quantum_m, "{file}: {max_m} of {bound_m}");
        let on_tin = finest["sample_error"]["on_tin"].as_u64().unwrap();
        assert!(on_tin > 400_000, "{file}: {on_tin} samples");
    }
}
