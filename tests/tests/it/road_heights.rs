//! Roads on the elevation files themselves: heights compared with those that GDAL reads, grades of
//! smoothed lines, edges of the network.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod cut_packages;
mod distances;
mod split_ways;
mod tagged_bridges;
mod to_and_fro;
mod whole_and_parts;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf::{self, PbfWay};
use e2e::{Ran, build_from, copy_pass, corniche, real_data, sample, text, write_ascii_grid};
use gdal::{Dataset, GeoTransformEx as _, raster::Buffer, vector::LayerAccess as _};

type Row = BTreeMap<String, String>;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// A line of positions with heights.
type Line = Vec<[f64; 3]>;

/// Features of a file: their fields as texts, empty for null, and their lines.
fn features(path: &Path) -> Vec<(Row, Vec<Line>)> {
    let dataset = Dataset::open(path).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let mut found = Vec::new();
    for feature in layer.features() {
        let fields = feature.fields().map(|(name, value)| {
            let value = value.and_then(|value| match value {
                gdal::vector::FieldValue::IntegerValue(value) => Some(value.to_string()),
                gdal::vector::FieldValue::Integer64Value(value) => Some(value.to_string()),
                gdal::vector::FieldValue::RealValue(value) => Some(value.to_string()),
                gdal::vector::FieldValue::StringValue(value) => Some(value),
                _ => None,
            });
            (name, value.unwrap_or_default())
        });
        let geometry = feature.geometry().unwrap();
        let lines = (0..geometry.geometry_count()).map(|part| {
            let mut points = Vec::new();
            geometry.get_geometry(part).get_points(&mut points);
            points.into_iter().map(|(x, y, z)| [x, y, z]).collect()
        });
        found.push((fields.collect(), lines.collect()));
    }
    found
}

fn number(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name}: {row:?}"))
}

/// An elevation file as GDAL reads it, bilinear between its samples; an independent implementation.
struct Bilinear {
    transform: [f64; 6],
    samples: Buffer<f64>,
}

impl Bilinear {
    fn open(path: &Path) -> Self {
        let dataset = Dataset::open(path).unwrap();
        let samples = dataset.rasterband(1).unwrap().read_band_as::<f64>().unwrap();
        Self { transform: dataset.geo_transform().unwrap(), samples }
    }

    /// Returns `None` outside, and at voids.
    fn at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let (column, row) = self.transform.invert().unwrap().apply(x, y);
        let on_sample = |at: f64| if (at - at.round()).abs() < 1e-7 { at.round() } else { at };
        let [column, row] = [column - 0.5, row - 0.5].map(on_sample);
        let (columns, rows) = self.samples.shape();
        let mut sum = 0.0;
        for (column, across) in
            [(column.floor(), 1.0 - column.fract()), (column.floor() + 1.0, column.fract())]
        {
            for (row, along) in [(row.floor(), 1.0 - row.fract()), (row.floor() + 1.0, row.fract())]
            {
                if across * along <= 0.0 {
                    continue;
                }
                if column < 0.0 || row < 0.0 || column >= columns as f64 || row >= rows as f64 {
                    return None;
                }
                let sample = self.samples.data()[row as usize * columns + column as usize];
                if sample < -5_000.0 {
                    return None;
                }
                sum += across * along * sample;
            }
        }
        Some(sum)
    }
}

/// Lines are as close to an elevation file as their field says, at vertices and at many points
/// between them. Returns the number of compared points.
fn are_within(features: &[(Row, Vec<Line>)], dem: &Bilinear, field: &str) -> usize {
    let mut compared = 0;
    let mut share = 0.123_f64;
    for (row, lines) in features {
        let most_m = number(row, field) + 1e-4;
        for [from, to] in lines.iter().flat_map(|line| line.array_windows::<2>()) {
            share = (share + 0.618_034).fract();
            for (share, most_m) in
                [(0.0, most_m.min(2e-4)), (0.25, most_m), (0.75, most_m), (share, most_m)]
            {
                // Vertices of the ground are within the field, too; only those on the DEM are
                // exact.
                let most_m =
                    if field == "height_tolerance_m" { most_m } else { number(row, field) + 1e-4 };
                let at: [f64; 3] =
                    std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
                let Some(height_m) = dem.at([at[0], at[1]]) else { continue };
                compared += 1;
                let off_m = (at[2] - height_m).abs();
                assert!(off_m <= most_m, "{row:?} at {at:?}: {off_m}");
            }
        }
    }
    compared
}

/// Bridges and tunnels by independent rules: on the ground at both ends, and never below it, or
/// above, respectively; those without a crossing are straight.
fn are_on_decks(features: &[(Row, Vec<Line>)], dem: &Bilinear) {
    let mut straight = 0;
    for (row, lines) in features {
        let [line] = &lines[..] else { panic!("{row:?}") };
        let away = if row["bridge"] == "1" { 1.0 } else { -1.0 };
        let over_m = |at: &[f64; 3]| away * (at[2] - dem.at([at[0], at[1]]).unwrap());
        let (first, last) = (line[0], line[line.len() - 1]);
        assert!(over_m(&first).abs() < 2e-4 && over_m(&last).abs() < 2e-4, "{row:?}");
        assert!(line.iter().all(|at| over_m(at) > -2e-4), "{row:?}");
        let is_clear = line[1..line.len() - 1].iter().all(|at| over_m(at) > 1e-3);
        if row["free_height_m"].is_empty() && is_clear {
            straight += 1;
            let distance_m = |to: &[f64; 3]| (to[0] - first[0]).hypot(to[1] - first[1]);
            let grade = (last[2] - first[2]) / distance_m(&last);
            // The ways of the sample's bridges are nearly straight, too.
            for at in line.iter().filter(|_| row["bridge"] == "1") {
                assert!((first[2] + grade * distance_m(at) - at[2]).abs() < 0.05, "{row:?} {at:?}");
            }
        }
    }
    assert!(straight >= 3, "{straight} of {}", features.len());
}

fn pass_inputs() -> [PathBuf; 2] {
    ["pass/pass-dem.tif", "pass/pass.osm.pbf"].map(sample)
}

fn export(package: &Path, what: &str, target: &Path, options: &[&str]) -> Ran {
    corniche([&["export", what, text(package), "-o", text(target), "-q"], options].concat())
}

/// The rows of a profile along ways.
fn profile(package: &Path, ways: &str, options: &[&str]) -> (Vec<Row>, Ran) {
    let csv = package.with_extension("csv");
    let way = ["profile", text(package), "--way", ways, "--csv", text(&csv), "-O", "-q"];
    let ran = succeed(corniche([&way[..], options].concat()));
    let table = fs::read_to_string(csv).unwrap();
    let cells = |line: &str| -> Vec<String> { line.split(',').map(str::to_owned).collect() };
    let mut lines = table.lines().map(cells);
    let names = lines.next().unwrap();
    (lines.map(|line| names.iter().cloned().zip(line).collect()).collect(), ran)
}

#[test]
fn roads_have_the_heights_of_the_elevation_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let package = at("pass.pmtiles");
    copy_pass(&package, &["-q"]);
    let [dem, osm] = pass_inputs();
    let (on_dem, on_ground) = (at("dem.gpkg"), at("ground.gpkg"));
    succeed(export(&package, "roads", &on_dem, &["--dem", text(&dem), "--osm", text(&osm)]));
    succeed(export(&package, "roads", &on_ground, &[]));
    let (roads, ground) = (features(&on_dem), features(&on_ground));
    let read = Bilinear::open(&dem);
    let (of_decks, of_dem): (Vec<_>, Vec<_>) =
        roads.iter().cloned().partition(|(row, _)| row["height_source"] != "dem");
    assert!(are_within(&of_dem, &read, "height_tolerance_m") > 10_000);
    are_on_decks(&of_decks, &read);
    // The same lines on the package's triangles differ by as much as the field says.
    let of_ground: Vec<(Row, Vec<Line>)> = ground
        .iter()
        .zip(&roads)
        .map(|((own, lines), (on_dem, _))| {
            assert_eq!(own["way_id"], on_dem["way_id"]);
            (on_dem.clone(), lines.clone())
        })
        .collect();
    assert!(are_within(&of_ground, &read, "ground_tolerance_m") > 10_000);
    // Lines that share a point have the same height there.
    let mut heights: BTreeMap<[u64; 2], u64> = BTreeMap::new();
    let mut shared = 0;
    for vertex in roads.iter().flat_map(|(_, lines)| lines.iter().flatten()) {
        let place = [vertex[0], vertex[1]].map(f64::to_bits);
        if let Some(before) = heights.insert(place, vertex[2].to_bits()) {
            shared += 1;
            assert_eq!(before, vertex[2].to_bits(), "{vertex:?}");
        }
    }
    assert!(shared > 20);
    let mut structures = 0;
    for ((on_dem, _), (on_ground, _)) in roads.iter().zip(&ground) {
        let (source, of_ground) = match (&*on_dem["bridge"], &*on_dem["tunnel"]) {
            ("1", _) => ("deck", "ground_under_bridge"),
            (_, "1") => ("tunnel", "ground_over_tunnel"),
            _ => ("dem", "ground"),
        };
        assert_eq!([&on_dem["height_source"], &on_ground["height_source"]], [source, of_ground]);
        assert_eq!(on_dem["smoothed_by"], "chain", "{on_dem:?}");
        assert_eq!(on_ground["ascent_m"].is_empty(), source != "dem", "{on_ground:?}");
        assert_eq!(on_dem["height_tolerance_m"].is_empty(), source != "dem", "{on_dem:?}");
        if source == "dem" {
            assert!(on_dem["free_height_m"].is_empty(), "{on_dem:?}");
            // Noise increases the ascents and descents of the ground, and never decreases them by
            // more than the smoothing of the ends.
            let up = |name: &str| number(on_dem, name);
            let most_m = 2.0 * up("smoothing_max_m") + 1e-3;
            assert!(up("ascent_m") <= up("ground_ascent_m") + most_m, "{on_dem:?}");
            let net = |ascent: &str, descent: &str| up(ascent) - up(descent);
            let off = net("ascent_m", "descent_m") - net("ground_ascent_m", "ground_descent_m");
            assert!(off.abs() <= most_m, "{on_dem:?}");
        } else {
            structures += 1;
        }
    }
    assert!(structures >= 3);
}

/// Nodes of a small network on a plane off the central meridian of UTM 32, in degrees.
const NODES: [(i64, [f64; 2]); 13] = [
    (1, [8.990, 46.940]),
    (2, [8.996, 46.941]),
    (3, [9.002, 46.942]),
    (4, [9.008, 46.943]),
    (5, [9.002, 46.948]),
    (6, [9.002, 46.936]),
    // At the position of node 2, but another node.
    (7, [8.996, 46.941]),
    (8, [8.996, 46.947]),
    (9, [9.014, 46.944]),
    // A ring without a junction.
    (20, [8.980, 46.930]),
    (21, [8.988, 46.930]),
    (22, [8.986, 46.935]),
    (23, [8.979, 46.934]),
];

/// The nodes of a way, and the tag of its structure, if it is not on the ground.
type PlainWay<'a> = (&'a [i64], &'a str);

/// Builds a package of ways on bumpy ground; the ids of ways are their positions in the list.
fn package_of(folder: &Path, name: &str, ways: &[PlainWay<'_>]) -> [PathBuf; 3] {
    package_with(folder, name, (&NODES, ways))
}

fn package_with(
    folder: &Path,
    name: &str,
    (nodes, ways): (&[(i64, [f64; 2])], &[PlainWay<'_>]),
) -> [PathBuf; 3] {
    let [dem, osm, package] =
        ["dem.asc".to_owned(), format!("{name}.osm.pbf"), format!("{name}.pmtiles")]
            .map(|name| folder.join(name));
    let place = "xllcenter 497000\nyllcenter 5195000\ncellsize 20\nNODATA_value -9999";
    write_ascii_grid(&dem, [301, 301], place, |column, row| {
        let noise = f64::from((column as u32 * 7919 + row as u32 * 104_729) % 97) / 97.0;
        // A ridge between nodes 2 and 3.
        let ridge = if (140..153).contains(&column) { 30.0 } else { 0.0 };
        500.0 + 1.2 * column as f64 + 4.0 * noise + ridge
    });
    let ways: Vec<PbfWay<'_>> = (1..)
        .zip(ways)
        .map(|(id, (node_ids, structure))| {
            let mut tags = vec![("highway", "secondary")];
            if !structure.is_empty() {
                tags.push((structure, "yes"));
            }
            PbfWay { id, tags, node_ids: node_ids.to_vec() }
        })
        .collect();
    fs::write(&osm, pbf::network(&[], nodes, &ways)).unwrap();
    build_from([&dem, &osm], &package, &["-q", "--dem-crs", "EPSG:32632"]);
    [dem, osm, package]
}

/// Splitting, turning and re-ordering ways changes no total by more than a centimetre, and no edge.
#[test]
fn grades_do_not_depend_on_how_ways_are_split() {
    let folder = tempfile::tempdir().unwrap();
    let mut totals: Vec<[f64; 3]> = Vec::new();
    let mut all_edges: Vec<Vec<Row>> = Vec::new();
    let variants: [(&str, &[PlainWay<'_>]); 3] = [
        (
            "whole",
            &[(&[1, 2, 3, 4, 9], ""), (&[5, 3, 6], ""), (&[7, 8], ""), (&[20, 21, 22, 23, 20], "")],
        ),
        (
            "split",
            &[
                (&[3, 5], ""),
                (&[1, 2], ""),
                (&[2, 3], ""),
                (&[3, 4], ""),
                (&[4, 9], ""),
                (&[3, 6], ""),
                (&[7, 8], ""),
                (&[22, 23, 20, 21, 22], ""),
            ],
        ),
        (
            "turned",
            &[
                (&[8, 7], ""),
                (&[6, 3], ""),
                (&[9, 4, 3], ""),
                (&[3, 2, 1], ""),
                (&[5, 3], ""),
                (&[21, 20, 23], ""),
                (&[23, 22, 21], ""),
            ],
        ),
    ];
    for (name, ways) in variants {
        let [dem, osm, package] = package_of(folder.path(), name, ways);
        let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
        let target = folder.path().join(format!("{name}.gpkg"));
        succeed(export(&package, "roads", &target, &inputs));
        let mut total = [0.0; 3];
        for (row, _) in features(&target) {
            assert_eq!(row["smoothed_by"], "chain");
            total[0] += number(&row, "length_2d_m");
            total[1] += number(&row, "ascent_m") + number(&row, "descent_m");
            total[2] = f64::max(total[2], number(&row, "smoothing_max_m"));
            assert_eq!(row["steepest_pct"].is_empty(), number(&row, "length_2d_m") < 50.0);
        }
        totals.push(total);
        let target = folder.path().join(format!("{name}-edges.csv"));
        succeed(export(&package, "edges", &target, &inputs));
        let mut edges: Vec<Row> = features(&target).into_iter().map(|(row, _)| row).collect();
        for edge in &mut edges {
            edge.remove("ways");
        }
        all_edges.push(edges);
    }
    for total in &totals[1..] {
        for (found, expected) in total.iter().zip(&totals[0]) {
            assert!((found - expected).abs() < 0.01, "{totals:?}");
        }
    }
    // Node 3 is a junction, node 2 is not: way 7–8 only has a node at the same position.
    let ends: Vec<[&str; 2]> =
        all_edges[0].iter().map(|edge| [&*edge["from_node"], &*edge["to_node"]]).collect();
    assert_eq!(ends[..5], [["1", "3"], ["3", "5"], ["3", "6"], ["3", "9"], ["7", "8"]]);
    // The ring begins somewhere, and runs counterclockwise.
    assert_eq!((ends.len(), ends[5][0]), (6, ends[5][1]));
    for edges in &all_edges[1..] {
        assert_eq!(edges.len(), all_edges[0].len());
        for (found, expected) in edges.iter().zip(&all_edges[0]) {
            let is_ring = expected["from_node"] == expected["to_node"];
            for name in ["from_node", "to_node", "class", "highway", "oneway"] {
                assert!(found[name] == expected[name] || is_ring, "{name}");
            }
            let names = ["length_m", "ascent_m", "descent_m", "from_height_m", "to_height_m"];
            for name in &names[..if is_ring { 3 } else { 5 }] {
                let off = number(found, name) - number(expected, name);
                assert!(off.abs() < 0.01, "{name}: {found:?} {expected:?}");
            }
        }
    }
}

/// Edges at one node have one height there; a bridge passes over a ridge in its way; the reverse
/// edge has the same values in reverse.
#[test]
fn edges_meet_and_bridges_go_over_what_is_in_their_way() {
    let folder = tempfile::tempdir().unwrap();
    let ways: [PlainWay<'_>; 5] =
        [(&[1, 2], ""), (&[2, 3], "bridge"), (&[3, 4], ""), (&[5, 4], ""), (&[4, 9], "tunnel")];
    let [dem, osm, package] = package_of(folder.path(), "bridge", &ways);
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let target = folder.path().join("edges.gpkg");
    let ran = succeed(export(&package, "edges", &target, &inputs));
    assert!(ran.out.is_empty() && ran.err.is_empty(), "{}{}", ran.out, ran.err);
    let edges = features(&target);
    let ways: Vec<&str> = edges.iter().map(|(row, _)| &*row["ways"]).collect();
    assert_eq!(ways, ["1f 2f 3f", "4b", "5f"]);
    let [(over, _), (side, _), (tunnel, _)] = &edges[..] else { panic!("{ways:?}") };
    assert!((number(over, "bridge_share") - 1.0 / 3.0).abs() < 0.02, "{over:?}");
    assert_eq!((number(side, "bridge_share"), number(tunnel, "tunnel_share")), (0.0, 1.0));
    assert_eq!(over["to_height_m"], side["from_height_m"]);
    // A tunnel with a dead end is level.
    let of_tunnel = ["ascent_m", "descent_m"].map(|name| number(tunnel, name));
    assert_eq!((of_tunnel, &tunnel["to_height_m"]), ([0.0; 2], &side["from_height_m"]));
    // A ridge of 30 m is in the way of the bridge: its line passes over it, and is measured like
    // this.
    assert!((25.0..30.0).contains(&number(over, "descent_m")), "{over:?}");
    assert_eq!(
        [&over["ascent_m"], &over["descent_m"]],
        [&over["descent_back_m"], &over["ascent_back_m"]]
    );
    // The plane rises 1.2 m in 20 m of the map; the ridge has 27 m more, up and down.
    let of_ridge_pct = 100.0 * 2.0 * number(over, "descent_m") / number(over, "length_m");
    assert!((number(over, "weighted_grade_pct") - of_ridge_pct - 6.0).abs() < 0.5, "{over:?}");
}

/// A bridge over a road, however it is split and turned: a metre above it, by the same totals.
#[test]
fn decks_do_not_depend_on_how_bridges_are_split() {
    let folder = tempfile::tempdir().unwrap();
    let ground: [PlainWay<'_>; 3] = [(&[1, 2], ""), (&[5, 6], ""), (&[4, 9], "")];
    let variants: [(&str, &[PlainWay<'_>]); 3] = [
        ("deck", &[(&[2, 3, 4], "bridge")]),
        ("split-deck", &[(&[2, 3], "bridge"), (&[3, 4], "bridge")]),
        ("turned-deck", &[(&[4, 3], "bridge"), (&[3, 2], "bridge")]),
    ];
    let mut all: Vec<[f64; 4]> = Vec::new();
    for (name, bridges) in variants {
        let [dem, osm, package] = package_of(folder.path(), name, &[&ground, bridges].concat());
        let crs = ["--crs", "EPSG:4979", "--heights", "as-is"];
        let inputs = [&["--dem", text(&dem), "--osm", text(&osm)][..], &crs].concat();
        let target = folder.path().join(format!("{name}.gpkg"));
        succeed(export(&package, "roads", &target, &inputs));
        let roads = features(&target);
        let mut own = [0.0, 0.0, 0.0, f64::INFINITY];
        for (row, lines) in roads.iter().filter(|(row, _)| row["bridge"] == "1") {
            assert_eq!(row["height_source"], "deck");
            own[0] += number(row, "ascent_m") + number(row, "descent_m");
            own[1] += number(row, "ground_ascent_m") + number(row, "ground_descent_m");
            let heights = lines.iter().flatten().map(|at| at[2]);
            own[2] = heights.fold(own[2], f64::max);
            own[3] = row["free_height_m"].parse().unwrap_or(own[3]).min(own[3]);
        }
        assert!((own[3] - 1.0).abs() < 1e-3, "{own:?}");
        all.push(own);
        let heights_at = |lon: f64| -> Vec<u64> {
            let lines = roads.iter().flat_map(|(_, lines)| lines.iter().flatten());
            lines.filter(|at| (at[0] - lon).abs() < 1e-7).map(|at| at[2].to_bits()).collect()
        };
        for lon in [8.996, 9.008] {
            let [one, other] = heights_at(lon)[..] else { panic!("{lon}") };
            assert_eq!(one, other);
        }
    }
    for own in &all[1..] {
        assert!(own.iter().zip(&all[0]).all(|(one, other)| (one - other).abs() < 0.01), "{all:?}");
    }
}

/// A profile over a bridge is that of its deck, in both directions; also on a coarse level.
#[test]
fn profiles_go_over_decks() {
    let folder = tempfile::tempdir().unwrap();
    let ways: [PlainWay<'_>; 3] = [(&[1, 2], ""), (&[4, 3, 2], "bridge"), (&[4, 9], "")];
    let [dem, osm, package] = package_of(folder.path(), "profile", &ways);
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let run = |ways: &str, options: &[&str]| -> Vec<Row> {
        let (rows, ran) = profile(&package, ways, &[&inputs[..], options].concat());
        assert!(ran.out.contains("bridges and tunnels are estimates"), "{}", ran.out);
        assert!(!ran.out.contains("without"), "{}", ran.out);
        rows
    };
    // Without the extract, bridges are unknown.
    let (_, alone) = profile(&package, "2", &[]);
    assert!(alone.out.contains("Up, down unknown on"), "{}", alone.out);
    assert!(!alone.out.contains("Steepest"), "{}", alone.out);
    let heights = |rows: &[Row]| -> Vec<f64> {
        let on_deck = rows.iter().filter(|row| row["height_source"] == "deck");
        on_deck.map(|row| number(row, "height_m")).collect()
    };
    let there = run("1,2,3", &[]);
    assert!(there.iter().all(|row| row["part"] == "0" && !row["smooth_m"].is_empty()));
    let mut back = heights(&run("3,2,1", &[]));
    back.reverse();
    let own = heights(&there);
    assert!(own.len() >= 4, "{own:?}");
    // Where two ways meet, the vertex belongs to the first: one end of the bridge is missing on
    // each way.
    let [first, last] = [own[0], own[own.len() - 2]];
    assert!(back.iter().any(|height_m| (height_m - first).abs() < 0.01), "{own:?} {back:?}");
    assert!(back.iter().any(|height_m| (height_m - last).abs() < 0.01), "{own:?} {back:?}");
    let ends = |rows: &[f64]| rows[rows.len() - 1];
    let coarse = heights(&run("1,2,3", &["--level", "0"]));
    assert!((ends(&coarse) - ends(&own)).abs() < 0.01, "{coarse:?} {own:?}");
}

/// Other elevation files and extracts are rejected, and nothing is written.
#[test]
fn files_of_another_package_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let package = at("pass.pmtiles");
    copy_pass(&package, &["-q"]);
    let [dem, osm] = pass_inputs();
    let other = at("other.tif");
    let mut bytes = fs::read(&dem).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&other, bytes).unwrap();
    let other_osm = at("other.osm.pbf");
    let way = PbfWay { id: 1, tags: vec![("highway", "primary")], node_ids: vec![1, 2] };
    fs::write(&other_osm, pbf::network(&[], &NODES, &[way])).unwrap();
    let target = at("roads.gpkg");
    for (options, word) in [
        (vec!["--dem", text(&other)], "not the elevation files"),
        (vec!["--dem", text(&dem), "--osm", text(&other_osm)], "other.osm.pbf"),
        (vec!["--osm", text(&osm)], "--dem"),
    ] {
        let ran = export(&package, "roads", &target, &options);
        assert_eq!(ran.code, 2, "{options:?}: {}", ran.err);
        assert!(ran.err.contains(word), "{options:?}: {}", ran.err);
        assert!(!target.exists());
    }
    let ran = export(&package, "edges", &target, &["--dem", text(&dem)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    // Impossible requests are reported before large files are read.
    let json = at("roads.geojson");
    let words = ["export", "roads", text(&package), "-o", text(&json), "--dem", text(&dem)];
    let ran = corniche(words.iter().chain(&["--crs", "EPSG:4979"]));
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--heights as-is") && !ran.err.contains("hashing"), "{}", ran.err);
    // The elevation file may be anywhere among the words, also before the package.
    let words = ["export", "roads", "-q", "-o", text(&target), "--dem", text(&dem), text(&package)];
    succeed(corniche(words));
}

/// Real ground with voids: every height that is exported is that of the file.
#[test]
fn roads_of_liechtenstein_have_the_heights_of_srtm() {
    let (Some(dem), Some(osm)) = (
        real_data("liechtenstein/N47E009.hgt"),
        real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf"),
    ) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let package = at("li.pmtiles");
    build_from([&dem, &osm], &package, &["-q", "--bounds", "9.5,47.1,9.6,47.2"]);
    let target = at("roads.fgb");
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    succeed(export(&package, "roads", &target, &inputs));
    let mut roads = features(&target);
    roads.retain(|(row, _)| row["height_source"] == "dem");
    assert!(are_within(&roads, &Bilinear::open(&dem), "height_tolerance_m") > 100_000);
}
