//! From inputs to a package and back, on the bundled samples and, if available, on real data.

use std::{fs, process::Command};

use e2e::{build_pass, copy_pass, corniche, json, real_data, root, sample, skip, text};
use serde_json::Value;

/// P4: the bytes do not depend on threads, memory, time or the target's name.
#[test]
fn same_bytes_at_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let package = |name: &str, threads: &str, memory: &str| {
        let target = folder.path().join(name);
        build_pass(&target, &["--quiet", "--threads", threads, "--memory", memory]);
        fs::read(target).unwrap()
    };
    let one = package("one.pmtiles", "1", "256M");
    assert_eq!(one, package("two.pmtiles", "2", "1G"));
    assert_eq!(one, package("eight.pmtiles", "8", "512M"));
}

/// All checks hold for the sample with --dem; a flipped byte is detected and reported.
#[test]
fn pass_keeps_its_promises_and_damage_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--quiet"]);
    let dem = sample("pass/pass-dem.tif");
    let report = json(&["verify", text(&package), "--dem", text(&dem), "--json", "--quiet"]);
    assert_eq!(report["holds"], true);
    assert!(report["borders"].as_u64().unwrap() > 10);
    assert!(
        report["errors"]
            .as_array()
            .unwrap()
            .iter()
            .all(|level| level["tightness"]["min"].as_f64() >= Some(1.0))
    );

    let mut bytes = fs::read(&package).unwrap();
    let middle = bytes.len() * 3 / 4;
    bytes[middle] ^= 0x10;
    let damaged = folder.path().join("damaged.pmtiles");
    fs::write(&damaged, bytes).unwrap();
    let ran = corniche(["verify", text(&damaged), "--quiet"]);
    assert_eq!(ran.code, 1, "{}{}", ran.out, ran.err);
    // With --quiet, only broken checks and the verdict are printed.
    let (checks, verdict) = ran.out.trim_end().rsplit_once('\n').unwrap();
    assert!(checks.starts_with("BROKEN  ") && checks.contains("tile"), "{}", ran.out);
    assert!(!ran.out.lines().any(|line| line.starts_with("holds")), "{}", ran.out);
    assert!(
        verdict.contains(" broken") && verdict.ends_with("more need --dem and --osm"),
        "{verdict}"
    );
}

/// The same with --osm, and every check by its id.
#[test]
fn pass_is_what_its_extract_says_and_checks_have_ids() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let arguments =
        ["verify", text(&package), "--dem", text(&dem), "--osm", text(&osm), "--json", "--quiet"];
    let report = json(&arguments);
    assert_eq!(report["holds"], true, "{report}");
    let checks = report["checks"].as_array().unwrap();
    for id in ["P1", "P2.bound", "P3", "sv.range", "manifest.crs", "osm.geo", "osm.counts"] {
        let check = checks.iter().find(|check| check["id"] == id);
        assert!(check.is_some_and(|check| check["checked"].as_u64() > Some(0)), "{id}: {report}");
    }
    let help = corniche(["verify", "--help"]).out;
    assert!(checks.iter().all(|check| help.contains(check["id"].as_str().unwrap())), "{help}");

    // Another extract or another table is reported as such, not as a broken package.
    let other = folder.path().join("other.osm.pbf");
    let mut bytes = fs::read(&osm).unwrap();
    bytes.push(0);
    fs::write(&other, bytes).unwrap();
    let ran = corniche(["verify", text(&package), "--osm", text(&other), "--quiet"]);
    assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
    assert!(ran.err.contains("pass.osm.pbf"), "{}", ran.err);
    let arguments =
        ["verify", text(&package), "--osm", text(&osm), "--frc-table", "valhalla", "--quiet"];
    let ran = corniche(arguments);
    assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
    assert!(ran.err.contains("--frc-table"), "{}", ran.err);
}

/// A table from a file may have the name of a preset; then `verify` requires the file.
#[test]
fn verify_asks_for_a_table_that_is_called_like_a_preset() {
    let folder = tempfile::tempdir().unwrap();
    let (package, table) = (folder.path().join("pass.pmtiles"), folder.path().join("own.toml"));
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/frc/valhalla.toml");
    let own = fs::read_to_string(preset).unwrap().replace("\"bus_stop\", ", "");
    assert!(own.contains("name = \"valhalla\"") && !own.contains("bus_stop"), "{own}");
    fs::write(&table, own).unwrap();
    build_pass(&package, &["--quiet", "--max-error", "10", "--frc-table", text(&table)]);
    let osm = sample("pass/pass.osm.pbf");
    let verify = ["verify", text(&package), "--osm", text(&osm), "--quiet"];
    let ran = corniche(verify);
    assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
    for part in ["another FRC table", "\"valhalla\"", "pass that file with --frc-table"] {
        assert!(ran.err.contains(part), "{}", ran.err);
    }
    let ran = corniche(verify.into_iter().chain(["--frc-table", text(&table)]));
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
}

/// P6: the list contains what the manifest counts, defect by defect and loss by loss.
#[test]
fn the_list_of_defects_is_what_the_summary_counts() {
    let folder = tempfile::tempdir().unwrap();
    let (package, list) = (folder.path().join("pass.pmtiles"), folder.path().join("pass.csv"));
    build_pass(&package, &["--quiet", "--defects", text(&list)]);
    let counts = json(&["info", text(&package), "--json"])["manifest"]["counts"].clone();
    let csv = fs::read_to_string(&list).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("reason,object,id,count,length_m,detail"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let of = |reason: &str| rows.iter().filter(|row| row[0] == reason).count() as u64;
    for defect in counts["defects"].as_array().unwrap() {
        let reason = defect["name"].as_str().unwrap();
        assert!(of(reason) > 0, "{reason}");
        assert_eq!(of(reason), defect["count"].as_u64().unwrap(), "{reason}");
    }
    let void = "where the data have no ground (void or edge)";
    let listed_m: f64 =
        rows.iter().filter(|row| row[0] == void).map(|row| row[4].parse::<f64>().unwrap()).sum();
    let lost_m = counts["roads_lost"][1]["length_um"].as_f64().unwrap() / 1e6;
    assert!(lost_m > 100.0, "the sample has a road across a void");
    assert!((listed_m - lost_m).abs() < 1.0, "{listed_m} m listed, {lost_m} m lost");

    // A second run keeps the existing list, and says so before it begins.
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let again = folder.path().join("again.pmtiles");
    let inputs = ["build", "--dem", text(&dem), "--osm", text(&osm)];
    let ran = corniche(inputs.into_iter().chain(["-o", text(&again), "--defects", text(&list)]));
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(!again.exists());
    let ran =
        corniche(inputs.into_iter().chain(["-o", text(&again), "--defects", text(&osm), "-O"]));
    assert_eq!(ran.code, 2, "the extract is not replaced by the list: {}", ran.err);
    assert_eq!(fs::read_to_string(&list).unwrap(), csv);
}

/// P6 on the sample's known truth: every road of the extract is accounted for.
#[test]
fn pass_accounts_for_every_road() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let counts = &json(&["info", text(&package), "--json"])["manifest"]["counts"];
    let number = |value: &Value| value.as_f64().unwrap();
    let lost = counts["roads_lost"].as_array().unwrap();
    let whole = |value: &Value| value.as_u64().unwrap();
    let roads: f64 = lost.iter().map(|loss| number(&loss["roads"])).sum();
    let lost_um: u64 = lost.iter().map(|loss| whole(&loss["length_um"])).sum();
    assert!((number(&counts["roads_in"]) - number(&counts["roads_kept"]) - roads).abs() < 0.5);
    let in_um = whole(&counts["roads_in_um"]);
    assert_eq!(in_um, whole(&counts["roads_kept_um"]) + lost_um);
    assert!(number(&counts["roads_in"]) > 20.0);
    // The generator's own record: every drivable road is in the package with its true length.
    let truth = fs::read_to_string(sample("pass/truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&truth).unwrap();
    let values: [&[&str]; 8] = [
        &["motorway", "motorway_link"],
        &["trunk"],
        &["primary"],
        &["secondary"],
        &["tertiary"],
        &["unclassified"],
        &["residential", "living_street"],
        &["service", "track"],
    ];
    for (class, values) in values.iter().enumerate() {
        let sum =
            |of: &str| values.iter().map(|value| number(&truth["osm"][of][value])).sum::<f64>();
        let [roads, micrometres] =
            ["roads", "length_um"].map(|part| number(&counts["classes"][class][part]));
        let metres = micrometres / 1e6;
        assert!((roads - sum("ways_per_highway")).abs() < 0.5, "class {class}");
        // Coordinates were rounded to 1e-7 degrees, a centimetre per point.
        assert!(
            (metres - sum("length_m_per_highway")).abs() < 0.002 * metres,
            "class {class}: {metres}"
        );
    }
    let voids = &truth["voids"];
    let filled = number(&voids["small"]["filled_at_32_cells"])
        + number(&voids["large"]["filled_at_32_cells"]);
    let cells = number(&voids["small"]["cells"]) + number(&voids["large"]["cells"]);
    assert!((number(&counts["samples"]["filled"]) - filled).abs() < 0.5);
    assert!((number(&counts["samples"]["void"]) - (cells - filled)).abs() < 0.5);
    let over_void = lost
        .iter()
        .find(|loss| loss["reason"] == "where the data have no ground (void or edge)")
        .unwrap();
    assert!(number(&over_void["length_um"]) > 100e6, "way 158 ends in the large void");
    for class in 0..8 {
        assert!(number(&counts["classes"][class]["roads"]) > 0.0, "class {class} is missing");
    }
}

/// The independent check of decoded tiles, in Python, agrees.
#[test]
#[ignore = "slow: each tile is checked in Python"]
fn the_independent_check_in_python_agrees() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    // scripts/test sets a Python with the modules that the check needs.
    let interpreter = std::env::var_os("CORNICHE_PYTHON").unwrap_or_else(|| "python3".into());
    let python = |arguments: &[&str]| Command::new(&interpreter).args(arguments).output();
    let has_modules =
        python(&["-c", "import numpy, shapely"]).is_ok_and(|output| output.status.success());
    if !has_modules {
        assert!(std::env::var_os("CI").is_none(), "python3 with numpy and shapely is missing");
        skip("python3 with numpy and shapely is not here");
        return;
    }
    let script = root().join("tests/check_tile.py");
    let binary = e2e::binary();
    let output =
        python(&[text(&script), "--corniche", text(&binary), text(&package), "--max-tiles", "30"])
            .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

#[test]
fn growth_is_told_in_four_ways() {
    let folder = tempfile::tempdir().unwrap();
    let (package, svg) = (folder.path().join("pass.pmtiles"), folder.path().join("growth.svg"));
    copy_pass(&package, &["--quiet"]);
    let table = corniche(["growth", text(&package), "--svg", text(&svg)]);
    assert_eq!(table.code, 0, "{}", table.err);
    assert!(table.out.contains("all levels") && table.out.contains("FRC 0"));
    assert!(fs::read_to_string(&svg).unwrap().contains("<svg"));
    let growth = json(&["growth", text(&package), "--json"]);
    let [rows, levels] = ["rows", "levels"].map(|list| growth[list].as_array().unwrap().len());
    let csv = corniche(["growth", text(&package), "--csv"]).out;
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    // Levels and classes, then levels, then the whole, below the column names.
    assert_eq!(lines.len(), 1 + rows + levels + 1);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{csv}");
    let whole = lines.last().unwrap();
    assert_eq!(whole[..2], ["all", "all"]);
    for name in ["growth_over_source", "stored_bytes_over_source"] {
        let column = lines[0].iter().position(|heading| *heading == name).unwrap();
        assert_eq!(whole[column], growth["all_levels"][name].to_string(), "{name}");
    }
}

#[test]
fn terrain_alone_is_a_package_too() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("terrain.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let ran = corniche([
        "build",
        "--dem",
        text(&dem),
        "-o",
        text(&package),
        "--quiet",
        "--max-error",
        "10",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(json(&["verify", text(&package), "--json", "--quiet"])["holds"], true);
    let osm = sample("pass/pass.osm.pbf");
    for table in [&[][..], &["--frc-table", "default"]] {
        let arguments = ["verify", text(&package), "--osm", text(&osm), "--quiet"];
        let ran = corniche(arguments.into_iter().chain(table.iter().copied()));
        assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
        assert!(ran.err.contains("built without an extract; omit --osm"), "{}", ran.err);
    }
    let ran = corniche(["growth", text(&package)]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("--osm"), "{}", ran.err);
}

#[test]
fn pictures_come_out_or_the_missing_adapter_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (package, png) = (folder.path().join("pass.pmtiles"), folder.path().join("pass.png"));
    copy_pass(&package, &["--quiet"]);
    let ran = corniche(["render", text(&package), "-o", text(&png), "--size", "320x240"]);
    if ran.code != 0
        && std::env::var_os("CORNICHE_REQUIRE_GPU").is_none()
        && ran.err.contains("adapter")
    {
        skip(&ran.err);
        return;
    }
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(&fs::read(&png).unwrap()[..8], b"\x89PNG\r\n\x1a\n");
}

/// Real rasters that are already projected: nodes are the samples, and the finest level is within
/// the bound.
#[test]
fn projected_rasters_are_not_resampled() {
    for file in ["tirol-5m/avaMal.tif", "slovenia-1m/TM1_564_146.tif"] {
        let Some(dem) = real_data(file) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("real.pmtiles");
        let ran = corniche(["build", "--dem", text(&dem), "-o", text(&package), "--quiet"]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let report = json(&["verify", text(&package), "--dem", text(&dem), "--json", "--quiet"]);
        assert_eq!(report["holds"], true, "{file}: {report}");
        let info = json(&["info", text(&package), "--json"]);
        assert_eq!(info["manifest"]["resampling"], "nodes are the DEM's samples");
        let max_error_m = info["manifest"]["settings"]["max_error_m"].as_f64().unwrap();
        let samples = &report["samples"];
        assert!(samples["on_tin"].as_u64().unwrap() > 100_000);
        assert!(samples["max_m"].as_f64().unwrap() <= max_error_m + 1e-6, "{file}: {samples}");
    }
}

/// Results of failed downloads in the place of a package are recognized and named.
#[test]
fn a_web_page_or_a_pointer_in_the_place_of_a_package_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [package, other] = ["a.pmtiles", "b.pmtiles"].map(|name| folder.path().join(name));
    let osm = folder.path().join("a.osm.pbf");
    fs::write(&osm, []).unwrap();
    for (content, words) in [
        (
            "<!DOCTYPE html>\n<html><body>404</body></html>",
            ["an HTML page", "download the file again"],
        ),
        (
            "version https://git-lfs.github.com/spec/v1\noid sha256:00\n",
            ["a Git LFS pointer", "git lfs pull"],
        ),
        ("nothing of the kind", ["not a PMTiles file", "not a Corniche package"]),
    ] {
        fs::write(&package, content).unwrap();
        for command in [
            &["info", text(&package)][..],
            &["build", "--terrain", text(&package), "--osm", text(&osm), "-o", text(&other)],
        ] {
            let ran = corniche(command);
            assert_eq!(ran.code, 2, "{command:?}: {}", ran.err);
            for word in words.into_iter().chain(["a.pmtiles"]) {
                assert!(ran.err.contains(word), "{command:?}: {}", ran.err);
            }
        }
    }
}
