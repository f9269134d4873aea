//! Grades of `corniche profile`: over the whole profile, however the road is split into ways.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![allow(clippy::float_cmp, reason = "numbers as they are printed")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf::{self, PbfWay};
use e2e::{build_from, corniche, real_data, text, write_ascii_grid};

/// A vertex: its distance, the height of the smoothed line, and its grade, percent.
type Smooth = [f64; 3];

/// The printed text of ways, and the smoothed line of all vertices.
fn profile([dem, osm, package]: [&Path; 3], ways: &[i64]) -> (String, Vec<Smooth>) {
    let list = package.with_extension("csv");
    let ways = ways.iter().map(i64::to_string).collect::<Vec<_>>().join(",");
    let ran = corniche([
        "profile",
        "-q",
        text(package),
        "--way",
        &ways,
        "--dem",
        text(dem),
        "--osm",
        text(osm),
        "--csv",
        text(&list),
        "-O",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let rows = fs::read_to_string(&list).unwrap();
    let smooth = |row: &str| {
        let fields: Vec<&str> = row.split(',').collect();
        [2, 8, 9].map(|at| fields[at].parse().unwrap())
    };
    (ran.out, rows.lines().skip(1).map(smooth).collect())
}

fn steepest_pct(said: &str) -> f64 {
    let line = said.lines().find(|line| line.starts_with("Steepest")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap_or_else(|_| panic!("{said}"))
}

/// Each grade is that of the smoothed line 25 m before and after its vertex, whatever way these
/// points are on.
fn assert_grades_of_whole(rows: &[Smooth]) {
    let [begin_m, end_m] = [rows[0][0], rows[rows.len() - 1][0]];
    let slope = |k: usize| {
        let ([from_m, from, _], [to_m, to, _]) = (rows[k], rows[k + 1]);
        (to - from) / (to_m - from_m)
    };
    // The height there, and its tolerance: between two vertices the smoothed line bends no more
    // than from those before them to those after.
    let height_m = |along_m: f64| {
        let after = rows.partition_point(|row| row[0] < along_m).clamp(1, rows.len() - 1);
        let ([from_m, from, _], [to_m, to, _]) = (rows[after - 1], rows[after]);
        let around = [after.saturating_sub(2), after.min(rows.len() - 2)].map(slope);
        let off_m = (around[1] - around[0]).abs() * (to_m - from_m) / 4.0;
        (from + (to - from) * (along_m - from_m) / (to_m - from_m), off_m)
    };
    for [along_m, _, grade_pct] in rows {
        let middle_m = along_m.min(end_m - 25.0).max(begin_m + 25.0);
        let [(from, from_off), (to, to_off)] = [-25.0, 25.0].map(|by_m| height_m(middle_m + by_m));
        let (own_pct, off_pct) = (2.0 * (to - from), 2.0 * (from_off + to_off));
        // Heights are printed to a millimetre.
        assert!((own_pct - grade_pct).abs() < off_pct + 0.01, "{along_m}: {own_pct} {grade_pct}");
    }
}

/// Ten ways of 18 m on a slope of 10 %.
#[test]
fn ways_that_are_shorter_than_fifty_metres_have_a_steepest_grade_together() {
    let Some(dem) = real_data("cases/profile-short-ways/dem.tif") else { return };
    let osm = dem.with_file_name("roads.osm.pbf");
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("short.pmtiles");
    build_from([&dem, &osm], &package, &["-q"]);
    let (said, rows) = profile([&dem, &osm, &package], &(1..=10).collect::<Vec<_>>());
    assert_eq!(steepest_pct(&said), 10.0, "{said}");
    assert!(rows.iter().all(|[.., grade_pct]| (grade_pct - 10.0).abs() < 0.02));
}

#[test]
fn a_bend_where_two_ways_meet_counts_on_both() {
    let Some(dem) = real_data("cases/profile-bend/dem.tif") else { return };
    let osm = dem.with_file_name("roads.osm.pbf");
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("bend.pmtiles");
    build_from([&dem, &osm], &package, &["-q"]);
    let (_, rows) = profile([&dem, &osm, &package], &[1, 2]);
    assert_grades_of_whole(&rows);
}

/// Nodes of a road of 1 500 m over a crest, every 38 m.
const NODES: i64 = 41;

/// A package of the road, split into ways that begin and end at nodes, each with whether it runs
/// against the road; `side` adds a road at the crest.
fn crest(folder: &Path, cuts: &[([i64; 2], bool)], side: bool) -> [PathBuf; 3] {
    let [dem, osm, package] =
        ["dem.asc", "roads.osm.pbf", "crest.pmtiles"].map(|name| folder.join(name));
    let place = "xllcorner 9\nyllcorner 47\ncellsize 0.0001";
    write_ascii_grid(&dem, [320, 100], place, |column, row| {
        600.0 - 0.7 * (column as f64 - 150.0).abs() + 0.1 * row as f64
    });
    let mut nodes: Vec<(i64, [f64; 2])> =
        (0..NODES).map(|k| (k + 1, [9.005 + 5e-4 * k as f64, 47.005])).collect();
    let tags = vec![("highway", "secondary")];
    let mut ways: Vec<PbfWay<'_>> = (1..)
        .zip(cuts)
        .map(|(id, &([first, last], is_against))| {
            let mut node_ids: Vec<i64> = (first + 1..=last + 1).collect();
            if is_against {
                node_ids.reverse();
            }
            PbfWay { id, tags: tags.clone(), node_ids }
        })
        .collect();
    if side {
        nodes.push((100, [9.0147, 47.008]));
        ways.push(PbfWay { id: 900, tags, node_ids: vec![21, 100] });
    }
    fs::write(&osm, pbf::network(&[], &nodes, &ways)).unwrap();
    let wgs84 = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;
    fs::write(dem.with_extension("prj"), wgs84).unwrap();
    build_from([&dem, &osm], &package, &["-q", "-O"]);
    [dem, osm, package]
}

#[test]
fn a_road_has_the_same_grades_however_it_is_cut_into_ways() {
    let folder = tempfile::tempdir().unwrap();
    let every = |step: i64, turn: fn(i64) -> bool| -> Vec<([i64; 2], bool)> {
        let cuts = (0..NODES - 1).step_by(step as usize);
        cuts.map(|k| ([k, (k + step).min(NODES - 1)], turn(k))).collect()
    };
    for side in [false, true] {
        let whole = crest(folder.path(), &every(NODES - 1, |_| false), side);
        let (expected, smooth) = profile(whole.each_ref().map(PathBuf::as_path), &[1]);
        assert_grades_of_whole(&smooth);
        for cuts in [every(1, |_| false), every(1, |k| k % 3 == 1), every(7, |k| k % 2 == 1)] {
            let parts = crest(folder.path(), &cuts, side);
            let ways: Vec<i64> = (1..=cuts.len() as i64).collect();
            let (said, rows) = profile(parts.each_ref().map(PathBuf::as_path), &ways);
            assert_grades_of_whole(&rows);
            assert_eq!(said, expected, "{cuts:?}");
            for (own, whole) in rows.iter().zip(&smooth) {
                assert!((own[2] - whole[2]).abs() < 0.05, "{own:?} {whole:?} {cuts:?}");
            }
        }
    }
}
