//! Roads, edges and profiles of packages that were built in parts, or of a region of the data,
//! equal those of the whole.

use std::{collections::BTreeMap, fs, path::Path};

use e2e::{build_from, built_in_subtrees, copy_pass, text};

use super::{Line, Row, export, features, number, pass_inputs, profile, succeed};

#[test]
fn a_package_built_in_parts_exports_the_bytes_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // A file contains the name of its package.
    let [whole, merged] = ["whole", "parts"].map(|name| at(name).join("pass.pmtiles"));
    for package in [&whole, &merged] {
        fs::create_dir(package.parent().unwrap()).unwrap();
    }
    let [dem, osm] = pass_inputs();
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let bound = ["--max-error", "10"];
    build_from([&dem, &osm], &whole, &[&bound[..], &["-q"]].concat());
    let built = built_in_subtrees(folder.path(), &[&inputs[..], &bound].concat(), 1);
    fs::write(&merged, built).unwrap();
    let exported = |package: &Path, what: &str, ending: &str, options: &[&str]| -> Vec<u8> {
        let target = package.with_extension(ending);
        succeed(export(package, what, &target, &[&["-O"], options].concat()));
        fs::read(target).unwrap()
    };
    for (what, ending, options) in
        [("roads", "gpkg", &inputs[..]), ("roads", "fgb", &[]), ("edges", "csv", &inputs)]
    {
        let [one, other] =
            [&whole, &merged].map(|package| exported(package, what, ending, options));
        assert!(one == other && one.len() > 1000, "{what}, {ending}, {options:?}");
    }
    let [one, other] = [&whole, &merged].map(|package| profile(package, "137,138,102", &inputs).0);
    assert!(one.len() > 100 && one == other);
}

/// The remaining parts of roads have the same grades as in the whole; pieces and classes have no
/// effect.
#[test]
fn parts_of_roads_have_the_grades_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let package = at("pass.pmtiles");
    copy_pass(&package, &["-q"]);
    let [dem, osm] = pass_inputs();
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let run = |name: &str, options: &[&str]| {
        let target = at(name);
        succeed(export(&package, "roads", &target, &[&inputs[..], options].concat()));
        features(&target)
    };
    let whole = run("whole.gpkg", &[]);
    for (found, lines) in run("classes.gpkg", &["--classes", "2-4"]) {
        let (expected, of_whole) =
            whole.iter().find(|(row, _)| row["way_id"] == found["way_id"]).unwrap();
        assert_eq!((&found, &lines), (expected, of_whole));
    }
    let mut sums: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    for (row, _) in run("pieces.gpkg", &["--pieces"]) {
        if !row["ascent_m"].is_empty() {
            assert!(
                row["steepest_pct"].is_empty() || number(&row, "length_2d_m") >= 50.0,
                "{row:?}"
            );
            let own = sums.entry(row["way_id"].clone()).or_default();
            own[0] += number(&row, "ascent_m");
            own[1] += number(&row, "descent_m");
        }
    }
    // The parts on both sides of the bounds add up to the whole.
    let mut halves: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    for (name, bounds) in [("west.gpkg", "9.0,46,9.53,47.5"), ("east.gpkg", "9.53,46,10,47.5")] {
        for (row, _) in run(name, &["--bounds", bounds]) {
            if !row["ascent_m"].is_empty() {
                assert_eq!(row["smoothed_by"], "chain", "{row:?}");
                let own = halves.entry(row["way_id"].clone()).or_default();
                own[0] += number(&row, "ascent_m");
                own[1] += number(&row, "descent_m");
            }
        }
    }
    for (row, _) in &whole {
        let own = halves[&row["way_id"]];
        for (found, name) in own.iter().zip(["ascent_m", "descent_m"]) {
            assert!((found - number(row, name)).abs() < 0.05, "{name}: {found} {row:?}");
        }
        let own = sums[&row["way_id"]];
        for (found, name) in own.iter().zip(["ascent_m", "descent_m"]) {
            assert!((found - number(row, name)).abs() < 0.01, "{name}: {found} {row:?}");
        }
    }
}

/// The distance from the rectangle of a package's data at which a road equals that in a larger
/// package: the range of the smoothing.
const AWAY_M: f64 = 1500.0;

/// Bounds of a build skip tiles and clip chains: roads far from them have the same lines, heights
/// and grades.
#[test]
fn a_package_of_a_part_of_the_data_has_the_roads_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (whole, part) = (at("whole.pmtiles"), at("part.pmtiles"));
    copy_pass(&whole, &["-q"]);
    let [dem, osm] = pass_inputs();
    build_from([&dem, &osm], &part, &["-q", "--bounds", "9.48,46.86,9.6,46.97"]);
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let roads = |package: &Path| -> BTreeMap<String, (Row, Vec<Line>)> {
        let target = package.with_extension("gpkg");
        succeed(export(package, "roads", &target, &inputs));
        let by_way = |(row, lines): (Row, Vec<Line>)| (row["way_id"].clone(), (row, lines));
        features(&target).into_iter().map(by_way).collect()
    };
    let [whole, part] = [&whole, &part].map(|package| roads(package));
    let vertices = || part.values().flat_map(|(_, lines)| lines.iter().flatten());
    let west_m = vertices().map(|at| at[0]).fold(f64::INFINITY, f64::min);
    let mut compared = 0;
    for (way_id, (row, lines)) in &part {
        let (of_whole, expected) = &whole[way_id];
        let is_away = |line: &Line| line.iter().all(|at| at[0] > west_m + AWAY_M);
        if !expected.iter().all(is_away) {
            continue;
        }
        compared += 1;
        for name in row.keys() {
            // Triangles of other tiles are others.
            if name == "ground_tolerance_m" || name == "vertices_out" || name == "vertices_in" {
                continue;
            }
            match (row[name].parse::<f64>(), of_whole[name].parse::<f64>()) {
                (Ok(found), Ok(expected)) => {
                    assert!((found - expected).abs() < 0.01, "{name}: {row:?} {of_whole:?}");
                }
                _ => assert_eq!(row[name], of_whole[name], "{name}: {row:?}"),
            }
        }
        // The lattices of both may differ by less than a millimetre.
        let ends = |lines: &[Line]| [lines[0][0], *lines[0].last().unwrap()];
        for (found, expected) in ends(lines).iter().zip(ends(expected)) {
            assert!(found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 0.01));
        }
    }
    assert!(compared > 20 && part.len() < whole.len(), "{compared} of {}", part.len());
}
