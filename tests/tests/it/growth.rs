//! `corniche growth` as a tool for studies: several packages side by side, a line per way, and the
//! script that varies settings.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs, path::Path, process::Command};

use corniche_testing::pbf;
use e2e::{
    Ran, binary, build_from, build_pass, copy_pass, corniche, json, manifest, names, real_data,
    root, sample, text, write_ascii_grid,
};
use serde_json::Value;

/// The lines of a CSV file by the names of its columns.
fn lines(csv: &str) -> Vec<BTreeMap<String, String>> {
    let mut lines = csv.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| {
            // In the last cell there may be commas.
            let cells: Vec<&str> = line.splitn(headings.len(), ',').collect();
            assert_eq!(cells.len(), headings.len(), "{line}");
            headings
                .iter()
                .zip(cells)
                .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
                .collect()
        })
        .collect()
}

fn sum(lines: &[BTreeMap<String, String>], column: &str, class: u64) -> i64 {
    let of_class = lines.iter().filter(|line| line["class"] == class.to_string());
    of_class.filter_map(|line| line[column].parse::<i64>().ok()).sum()
}

/// The columns of the list add up to the growth table: vertices of each level and class, and points
/// of the source. The lengths add up to the kept length of `info`.
fn adds_up(package: &Path, folder: &Path) -> Vec<BTreeMap<String, String>> {
    let csv = folder.join("ways.csv");
    let ran = corniche(["growth", text(package), "--json", "--per-way", text(&csv), "-O"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let table: Value = serde_json::from_str(&ran.out).unwrap();
    let ways = lines(&fs::read_to_string(&csv).unwrap());
    let finest = table["levels"].as_array().unwrap().len() - 1;
    let rows = table["rows"].as_array().unwrap();
    assert!(!rows.is_empty());
    for row in rows {
        let (level, class) = (row["level"].as_u64().unwrap(), row["class"].as_u64().unwrap());
        let vertices = sum(&ways, &format!("geo_vertices_level_{level}"), class);
        assert_eq!(Some(vertices), row["geo_vertices"].as_i64(), "{row}");
        if level == finest as u64 {
            assert_eq!(
                Some(sum(&ways, "source_vertices", class)),
                row["source_vertices"].as_i64(),
                "{row}"
            );
        }
    }
    let (on_ground, off_ground): (Vec<_>, Vec<_>) =
        ways.into_iter().partition(|way| !way["way_id"].is_empty());
    assert!(
        off_ground.iter().all(|line| line["source_vertices"].parse::<i64>().unwrap() > 0),
        "{off_ground:?}"
    );
    let ids: Vec<i64> = on_ground.iter().map(|way| way["way_id"].parse().unwrap()).collect();
    assert!(ids.is_sorted_by(|one, other| one < other), "each way once, by id");
    let kept_m: f64 = on_ground.iter().map(|way| way["length_m"].parse::<f64>().unwrap()).sum();
    let told_m = manifest(package)["counts"]["roads_kept_um"].as_f64().unwrap() / 1e6;
    assert!((kept_m - told_m).abs() <= 1e-6 * told_m, "{kept_m} of {told_m}");
    for way in &on_ground {
        let number = |column: &str| way[column].parse::<f64>().unwrap();
        let of_levels: f64 =
            (0..=finest).map(|level| number(&format!("geo_vertices_level_{level}"))).sum();
        assert!((of_levels - number("geo_vertices_all_levels")).abs() < 0.5, "{way:?}");
        if number("source_vertices") > 0.0 {
            let growth =
                number(&format!("geo_vertices_level_{finest}")) / number("source_vertices");
            assert!((growth - number("growth_over_source")).abs() < 1e-6, "{way:?}");
        } else {
            assert_eq!(way["growth_over_source"], "", "{way:?}");
        }
    }
    on_ground
}

#[test]
fn lines_of_ways_add_up_to_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let ways = adds_up(&package, folder.path());
    assert_eq!(Some(ways.len() as u64), manifest(&package)["counts"]["roads_kept"].as_u64());
    // A region of the same data: roads end at the bounds, within tiles.
    build_pass(
        &package,
        &["-q", "-O", "--max-error", "10", "--bounds", "9.47,46.88,9.52,46.93", "--all-classes"],
    );
    let part = adds_up(&package, folder.path());
    assert!(part.len() < ways.len() && part.len() > 3, "{} of {}", part.len(), ways.len());
    // Ways that are completely inside have the points of the whole package; others have no more
    // than that.
    let mut same = 0;
    for way in &part {
        let whole = ways.iter().find(|whole| whole["way_id"] == way["way_id"]).unwrap();
        let number =
            |way: &BTreeMap<String, String>, column: &str| way[column].parse::<f64>().unwrap();
        let points = [way, whole].map(|way| number(way, "source_vertices"));
        assert!(points[0] <= points[1], "{way:?} {whole:?}");
        if (number(way, "length_m") - number(whole, "length_m")).abs() < 1e-3 {
            assert!((points[0] - points[1]).abs() < 0.5, "{way:?} {whole:?}");
            same += 1;
        }
    }
    assert!(same >= 3, "{same}");
}

#[test]
fn lines_of_real_ways_add_up_to_the_table() {
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let osm = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("li.pmtiles");
    build_from([&dem, &osm], &package, &["-q", "--max-error", "10"]);
    assert!(adds_up(&package, folder.path()).len() > 1000);
}

/// A way of 61 points, evenly spaced from west to east over a plane of nine tiles: all are its own
/// points, and none are clips at tile borders. Within bounds that clip it between its points, only
/// those inside count, and none of the clips at the bounds.
#[test]
fn cuts_are_no_points_of_a_way() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] =
        ["a.asc", "a.osm.pbf", "a.pmtiles"].map(|name| folder.path().join(name));
    let place = "xllcenter 497000\nyllcenter 5197000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(&dem, [601, 601], place, |column, _| 500.0 + column as f64);
    let longitude = |k: i32| 8.98 + 0.04 * f64::from(k) / 60.0;
    let points_deg = (0..=60).map(|k| [longitude(k), 46.945]).collect();
    let line = pbf::WayToWrite { tags: vec![("highway", "primary")], points_deg };
    fs::write(&osm, pbf::extract(&[], &[line])).unwrap();
    let points = |options: &[&str]| -> i64 {
        build_from(
            [&dem, &osm],
            &package,
            &[&["-q", "-O", "--dem-crs", "EPSG:32632"], options].concat(),
        );
        let [way] = &adds_up(&package, folder.path())[..] else { panic!("one way") };
        way["source_vertices"].parse().unwrap()
    };
    assert_eq!(points(&[]), 61);
    // Bounds are rounded outwards to whole cells, a fifth of the way from point to point.
    let [west, east] = [longitude(12) + 0.0003, longitude(48) - 0.0003];
    assert_eq!(points(&["--bounds", &format!("{west},46.9,{east},47")]), 35);
}

#[test]
fn lists_of_ways_are_refused_where_they_would_destroy_or_mean_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let csv = folder.path().join("ways.csv");
    let [package_name, csv_name] = [text(&package), text(&csv)];
    let before = fs::read(&package).unwrap();
    assert_eq!(corniche(["growth", package_name, "--per-way", csv_name]).code, 0);
    let first = fs::read(&csv).unwrap();
    let missing = folder.path().join("nowhere/ways.csv");
    let png = folder.path().join("growth.png");
    let many = [&[package_name; 28][..], &["--svg", "many.svg"]].concat();
    let refusals: [(&[&str], i32, &str); 8] = [
        (&[package_name, "--svg", text(&png)], 2, "a name with the extension .svg"),
        (&many, 2, "at most 27"),
        (&[package_name, "--per-way", csv_name], 3, "already exists"),
        (&[package_name, package_name, "--per-way", csv_name, "-O"], 2, "a single package"),
        (&[package_name, "--per-way", package_name, "-O"], 2, "already uses this file"),
        (&[package_name, "--per-way", csv_name, "--svg", csv_name, "-O"], 2, "the same file"),
        (&[package_name, "--per-way", text(&missing)], 2, "cannot write"),
        (&[package_name, "-O"], 2, "needs more arguments"),
    ];
    for (arguments, code, word) in refusals {
        let ran = corniche([&["growth"], arguments].concat());
        assert!(
            ran.code == code && ran.err.contains(word),
            "{arguments:?}: {} {}",
            ran.code,
            ran.err
        );
    }
    assert_eq!(fs::read(&csv).unwrap(), first);
    assert_eq!(fs::read(&package).unwrap(), before);
    assert_eq!(corniche(["growth", package_name, "--per-way", csv_name, "-O"]).code, 0);
    assert_eq!(fs::read(&csv).unwrap(), first, "the same package, the same bytes");
    assert_eq!(names(folder.path()), ["pass.pmtiles", "ways.csv"], "nothing is left behind");
}

/// Three packages of one region side by side; the third has other settings for roads, which is
/// reported.
#[test]
fn packages_are_compared_and_what_is_not_alike_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let packages =
        ["fine", "coarse", "other"].map(|name| folder.path().join(format!("{name}.pmtiles")));
    for (package, options) in packages.iter().zip([
        &["--max-error", "5"][..],
        &["--max-error", "20", "--cell", "20"],
        &["--max-error", "20", "--cell", "20", "--all-classes", "--classes", "0-8"],
    ]) {
        build_pass(package, &[&["-q"], options].concat());
    }
    let [fine, coarse, other] = packages.each_ref().map(|path| text(path));
    let grow = |arguments: &[&str]| -> Ran {
        let ran = corniche([&["growth"], arguments].concat());
        assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.err);
        ran
    };
    let alike = grow(&[fine, coarse]);
    assert!(!alike.out.contains("The packages differ") && alike.err.is_empty(), "{}", alike.out);
    let told = grow(&[fine, coarse, other]).out;
    for word in [
        "The packages differ not only in cell and error bound",
        "  classes: A, B: ",
        "  classes by level: A, B: ",
        "; C: every class on every level",
    ] {
        let unfolded = told.replace("\n    ", " ");
        assert!(unfolded.contains(word), "{word}: {told}");
    }
    assert!(!told.contains("  extract:") && !told.contains("  CRS:"), "{told}");
    for line in told.lines().filter(|line| !line.contains(".pmtiles")) {
        assert!(line.chars().count() <= 100, "{}: {line}", line.chars().count());
    }

    let document = json(&["growth", fine, coarse, other, "--json"]);
    let alone = json(&["growth", coarse, "--json"]);
    assert_eq!(document["packages"][1]["growth"], alone);
    assert_eq!(document["packages"][1]["package"], coarse);
    assert_eq!(document["packages"][1]["cell_m"], serde_json::json!([20.0, 20.0]));
    assert_eq!(document["differences"][0]["what"], "classes");
    assert_eq!(
        document["differences"][0]["values"][0]["packages"],
        serde_json::json!([fine, coarse])
    );

    let ran = grow(&[fine, coarse, other, "--csv"]);
    assert!(
        ran.err.contains("warning: the packages differ not only in cell and error bound: classes"),
        "{}",
        ran.err
    );
    let expected: Vec<String> = [fine, coarse, other]
        .iter()
        .flat_map(|package| {
            let alone = grow(&[package, "--csv"]).out;
            let rows = alone.lines().skip(1).map(|line| format!("{package},{line}"));
            rows.collect::<Vec<_>>()
        })
        .collect();
    assert_eq!(ran.out.lines().skip(1).collect::<Vec<_>>(), expected);
    assert!(ran.out.starts_with("package,level,class,"));

    let svg = folder.path().join("a.svg");
    grow(&[fine, coarse, other, "--svg", text(&svg)]);
    let drawn = fs::read_to_string(&svg).unwrap();
    for name in ["A fine", "B coarse", "C other"] {
        assert!(drawn.contains(name), "{name}");
    }
    assert_eq!(corniche(["growth", fine, coarse, "--svg", text(&svg)]).code, 3);

    let bare = folder.path().join("bare.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    assert_eq!(
        corniche(["build", "-q", "--dem", text(&dem), "--max-error", "20", "-o", text(&bare)]).code,
        0
    );
    let refused = corniche(["growth", fine, text(&bare)]);
    assert!(
        refused.code == 2 && refused.err.contains("bare.pmtiles\" has no roads"),
        "{}",
        refused.err
    );
}

/// The script measures missing results, resumes after an interruption, and rejects a table of
/// another study.
#[test]
fn the_study_goes_on_where_it_was_stopped() {
    let python = std::env::var("CORNICHE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("study");
    let study = |more: &[&str]| -> Ran {
        let mut command = Command::new(&python);
        command.arg(root().join("scripts/growth-study")).arg("--corniche").arg(binary());
        command.args(["--out", text(&out), "--threads", "2", "--cells", "40"]).args(more);
        match command.output() {
            Ok(output) => output.into(),
            Err(error) => panic!("{python} does not start: {error}"),
        }
    };
    let first = study(&["--errors", "20"]);
    assert_eq!(first.code, 0, "{}", first.err);
    let table = out.join("study.csv");
    let one = lines(&fs::read_to_string(&table).unwrap());
    assert_eq!(one.len(), 2, "the paper's case and the default");
    let both = study(&["--errors", "20,40"]);
    assert!(
        both.code == 0 && both.err.contains("4 packages, of which 2 are measured already"),
        "{}",
        both.err
    );
    let two = lines(&fs::read_to_string(&table).unwrap());
    assert!(two.len() == 4 && one.iter().all(|line| two.contains(line)), "{two:?}");
    for line in &two {
        let number = |column: &str| line[column].parse::<f64>().unwrap();
        let growth = number("finest_vertices") / number("source_vertices");
        assert!((growth - number("growth_finest")).abs() < 1e-4, "{line:?}");
        let levels: Vec<f64> =
            line["growth_by_level"].split(' ').map(|word| word.parse().unwrap()).collect();
        assert!(
            (levels.iter().sum::<f64>() - number("growth_all_levels")).abs() < 1e-3,
            "{line:?}"
        );
        assert_eq!(levels.len().to_string(), line["levels"], "{line:?}");
    }
    // In a single run, the table is the same.
    let bytes = fs::read(&table).unwrap();
    fs::remove_file(&table).unwrap();
    assert_eq!(study(&["--errors", "20,40"]).code, 0);
    assert!(fs::read(&table).unwrap() == bytes, "other bytes");
    assert_eq!(names(&out), ["study.csv"], "nothing is left behind");

    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let own = ["--dem", text(&dem), "--osm", text(&osm), "--errors", "20"];
    let other = study(&own);
    assert!(other.code == 2 && other.err.contains("name another folder"), "{}", other.err);
    for (arguments, word) in [
        (&["--errors", "-1"][..], "not a positive number"),
        (&["--dem", text(&dem)], "go together"),
        (&["--dem", text(&dem), "--osm", text(&osm)], "give --errors"),
    ] {
        let ran = study(arguments);
        assert!(ran.code == 2 && ran.err.contains(word), "{arguments:?}: {}", ran.err);
    }
}
