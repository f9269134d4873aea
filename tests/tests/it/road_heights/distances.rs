//! Values reported as "at most" are upper bounds: random points on written lines are compared with
//! the elevation files as GDAL reads them; and measures of spans that the ground obstructs are
//! those of their lines.

use std::{fs, path::Path, process::Command};

use corniche_testing::{
    Raster,
    pbf::{self, PbfWay},
};
use e2e::{build_from, real_data, skip, some_of, text, write_ascii_grid};
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use tempfile::TempDir;

use super::{Bilinear, Line, Row, export, features, number, pass_inputs, profile, succeed};

/// Points that are compared in the quick tests.
const PLACES: usize = 20_000;

/// From one CRS to another by PROJ, x first.
fn transform(from: u32, to: u32) -> CoordTransform {
    let of = |code| {
        let mut crs = SpatialRef::from_epsg(code).unwrap();
        crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        crs
    };
    CoordTransform::new(&of(from), &of(to)).unwrap()
}

/// Random points on lines, distributed over their length, are within `field` of an elevation file.
/// Returns the number of compared points, and the largest distance.
fn are_within(
    features: &[(Row, Vec<Line>)],
    (dem, to_dem): (&Bilinear, Option<&CoordTransform>),
    (field, places): (&str, usize),
) -> (usize, f64) {
    let (mut compared, mut farthest_m) = (0, 0.0_f64);
    let long = |[from, to]: &[[f64; 3]; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
    let lines = features.iter().flat_map(|(_, lines)| lines);
    let all: f64 = lines.flat_map(|line| line.array_windows::<2>()).map(long).sum();
    let mut state = 11_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    for (row, lines) in features.iter().filter(|(row, _)| !row[field].is_empty()) {
        let most_m = number(row, field);
        let segments = lines.iter().flat_map(|line| line.array_windows::<2>());
        for segment @ [from, to] in segments {
            for _ in 0..=(long(segment) / all * places as f64) as usize {
                let share = random();
                let at: [f64; 3] =
                    std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
                let mut place = [[at[0]], [at[1]]];
                if let Some(to_dem) = to_dem {
                    let [x, y] = &mut place;
                    to_dem.transform_coords(x, y, &mut []).unwrap();
                }
                let Some(height_m) = dem.at([place[0][0], place[1][0]]) else { continue };
                compared += 1;
                let off_m = (at[2] - height_m).abs();
                farthest_m = farthest_m.max(off_m);
                assert!(off_m <= most_m + 1e-6, "{row:?} at {at:?}: {off_m}, told {most_m}");
            }
        }
    }
    (compared, farthest_m)
}

/// Exports roads of a package with heights of its triangles and of its elevation file, and compares
/// both with that file. Returns the largest distances.
fn compare(
    folder: &Path,
    [dem, osm]: [&Path; 2],
    options: &[&str],
    (to_dem, places): (Option<&CoordTransform>, usize),
) -> [f64; 2] {
    let package = folder.join("package.pmtiles");
    build_from([dem, osm], &package, &[&["-q", "-O"], options].concat());
    let read = Bilinear::open(dem);
    let on_dem = folder.join("dem.gpkg");
    let inputs = ["--dem", text(dem), "--osm", text(osm), "-O"];
    succeed(export(&package, "roads", &on_dem, &inputs));
    let of_dem = features(&on_dem);
    let is_told = |(row, _): &(Row, Vec<Line>)| {
        row["height_source"] != "dem" || !row["height_tolerance_m"].is_empty()
    };
    // Where voids were filled, the distance is unknown.
    let untold = of_dem.iter().filter(|of| !is_told(of)).count();
    assert!(untold * 100 <= of_dem.len(), "{options:?}: {untold} of {}", of_dem.len());
    let (compared, dem_m) = are_within(&of_dem, (&read, to_dem), ("height_tolerance_m", places));
    assert!(compared > 50, "{options:?}: {compared}");
    let on_ground = folder.join("ground.gpkg");
    succeed(export(&package, "roads", &on_ground, &["-O"]));
    let mut of_ground = features(&on_ground);
    let (_, ground_m) = are_within(&of_ground, (&read, to_dem), ("height_tolerance_m", places));
    // The same lines, compared with the elevation file.
    for ((row, _), (on_dem, _)) in of_ground.iter_mut().zip(&of_dem) {
        assert_eq!(row["way_id"], on_dem["way_id"]);
        row.insert("ground_tolerance_m".to_owned(), on_dem["ground_tolerance_m"].clone());
    }
    let (compared, _) = are_within(&of_ground, (&read, to_dem), ("ground_tolerance_m", places));
    assert!(compared > 50, "{options:?}: {compared}");
    [dem_m, ground_m]
}

#[test]
fn lines_are_within_their_field_whatever_the_nodes_are() {
    let folder = TempDir::new().unwrap();
    let [dem, osm] = pass_inputs();
    let crs = |to: u32| Some(transform(to, 32632));
    let cases: [(&[&str], Option<CoordTransform>, [f64; 2]); 5] = [
        (&[], None, [0.0, 1.0]),
        (&["--max-error", "8"], None, [0.0, 3.0]),
        // Nodes that are not samples: lines differ from the file's surface by metres, and the field
        // reports it.
        (&["--cell-every", "3"], None, [1.0, 1.0]),
        (&["--crs", "EPSG:32633"], crs(32633), [0.5, 0.0]),
        (&["--cell", "33"], None, [1.0, 0.0]),
    ];
    for (options, to_dem, least_m) in cases {
        let found_m = compare(folder.path(), [&dem, &osm], options, (to_dem.as_ref(), PLACES));
        for (found_m, least_m) in found_m.into_iter().zip(least_m) {
            assert!(found_m >= least_m, "{options:?}: {found_m}");
        }
    }
}

/// A hundred thousand points in each region, on lines of the package's triangles and of the
/// elevation file, for all kinds of nodes.
#[test]
#[ignore = "slow: six regions, three packages of each, some minutes"]
fn lines_of_real_regions_are_within_their_field() {
    let folder = TempDir::new().unwrap();
    let [dem, osm] = pass_inputs();
    let mut regions = vec![("pass", dem, osm, [32632, 32633])];
    for (dem, osm, codes) in [
        (
            "liechtenstein/N47E009.hgt",
            "liechtenstein/liechtenstein-2021-10-28.osm.pbf",
            [4326, 32632],
        ),
        ("portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf", [4269, 26910]),
        ("swellendam/srtm_41_19_4326.tif", "swellendam/swellendam-roads.osm.pbf", [4326, 32734]),
        (
            "delft-oostpoort/delft_dtm_0.5m.tif",
            "delft-oostpoort/tudelft-full.osm.pbf",
            [28992, 25831],
        ),
        (
            "finland-m3-road/m3-existing-ground-0.5m.tif",
            "finland-m3-road/m3-road.osm",
            [3875, 3067],
        ),
    ] {
        let (Some(file), Some(mut extract)) = (real_data(dem), real_data(osm)) else { continue };
        if extract.extension().is_some_and(|ending| ending == "osm") {
            let packed = folder.path().join("road.osm.pbf");
            let words = ["cat", "-O", text(&extract), "-o", text(&packed)];
            if !Command::new("osmium").args(words).status().is_ok_and(|status| status.success()) {
                skip("there is no program osmium (Debian: osmium-tool)");
                continue;
            }
            extract = packed;
        }
        regions.push((dem, file, extract, codes));
    }
    for (name, dem, osm, [own, utm]) in some_of(regions, [6, 6, 1]) {
        let utm_name = format!("EPSG:{utm}");
        let back = transform(utm, own);
        for (options, to_dem) in [
            (&[][..], None),
            (&["--cell-every", "3"], None),
            (&["--crs", utm_name.as_str()], Some(&back)),
        ] {
            let found_m = compare(folder.path(), [&dem, &osm], options, (to_dem, 100_000));
            println!("{name} {options:?}: at most {found_m:?} m from the file");
        }
    }
}

/// Samples on a rotated grid, none of which are nodes.
#[test]
fn lines_over_a_turned_file_are_within_their_field() {
    let folder = TempDir::new().unwrap();
    let place = [497_500.0, 19.0, 6.0, 5_200_500.0, 6.0, -19.0];
    let raster = Raster::new(32632, [220, 220], place);
    let bumps = |at: [f64; 2]| {
        let wave = |at: f64, length: f64| (at / length).sin();
        (700.0 + 40.0 * wave(at[0], 70.0) * wave(at[1], 90.0) + 25.0 * wave(at[0] + at[1], 33.0))
            as f32
    };
    let dem = raster.write(folder.path(), "turned.tif", bumps);
    let to_degrees = transform(32632, 4326);
    let osm = folder.path().join("roads.osm.pbf");
    let places = [[499_000.0, 5_199_600.0], [500_300.0, 5_198_300.0], [501_100.0, 5_199_500.0]];
    write_way(&osm, &to_degrees, &places, &[(&[1, 2, 3], "")]);
    let [dem_m, _] = compare(folder.path(), [&dem, &osm], &[], (None, PLACES));
    assert!(dem_m > 0.5, "{dem_m}");
}

/// The case of a public bug report: nodes are every second sample.
#[test]
fn lines_of_thinned_samples_are_told_as_far_from_the_file() {
    let [Some(dem), Some(osm)] =
        ["cases/cell-every/dem.tif", "cases/cell-every/roads.osm.pbf"].map(real_data)
    else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let [dem_m, ground_m] =
        compare(folder.path(), [&dem, &osm], &["--cell-every", "2"], (None, PLACES));
    assert!(dem_m > 4.5 && ground_m > 4.5, "{dem_m} {ground_m}");
}

/// Ways through points of UTM 32, whose nodes are numbered from 1.
fn write_way(
    osm: &Path,
    to_degrees: &CoordTransform,
    places: &[[f64; 2]],
    ways: &[(&[i64], &'static str)],
) {
    let nodes: Vec<(i64, [f64; 2])> = (1..)
        .zip(places)
        .map(|(id, &[x, y])| {
            let mut at = [[x], [y]];
            let [x, y] = &mut at;
            to_degrees.transform_coords(x, y, &mut []).unwrap();
            (id, [at[0][0], at[1][0]])
        })
        .collect();
    let ways: Vec<PbfWay<'_>> = (1..)
        .zip(ways)
        .map(|(id, (node_ids, structure))| {
            let mut tags = vec![("highway", "primary")];
            if !structure.is_empty() {
                tags.push((*structure, "yes"));
            }
            PbfWay { id, tags, node_ids: node_ids.to_vec() }
        })
        .collect();
    fs::write(osm, pbf::network(&[], &nodes, &ways)).unwrap();
}

/// The ascent of way 2 in all outputs: roads, edges, and the profile.
fn are_ascents(folder: &Path, [dem, osm]: [&Path; 2], options: &[&str], ascent_m: f64) {
    let package = folder.join("span.pmtiles");
    build_from([dem, osm], &package, &[&["-q", "-O"], options].concat());
    let inputs = ["--dem", text(dem), "--osm", text(osm), "-O"];
    let target = folder.join("span.gpkg");
    succeed(export(&package, "roads", &target, &inputs));
    let roads = features(&target);
    let (row, lines) = roads.iter().find(|(row, _)| row["way_id"] == "2").unwrap();
    let of_line: f64 = lines
        .iter()
        .flat_map(|line| line.array_windows::<2>())
        .map(|[from, to]| (to[2] - from[2]).max(0.0))
        .sum();
    for told_m in [number(row, "ascent_m"), number(row, "ground_ascent_m"), of_line] {
        assert!((told_m - ascent_m).abs() < 0.06, "{told_m} {ascent_m} {row:?}");
    }
    assert!(number(row, "steepest_pct") > 1.0, "{row:?}");
    let (_, told) = profile(&package, "2", &inputs[..4]);
    let up = format!("Up       {:.1} m", number(row, "ascent_m"));
    assert!(told.out.matches(&up).count() == 2, "{up}: {}", told.out);
    let edges = folder.join("edges.csv");
    succeed(export(&package, "edges", &edges, &inputs));
    let all = features(&edges);
    let edge = all.iter().find(|(row, _)| row["ways"].contains('2')).unwrap();
    let both_m: f64 = ["ascent_m", "descent_m"].map(|name| number(&edge.0, name)).iter().sum();
    let of_roads: f64 = roads
        .iter()
        .flat_map(|(row, _)| ["ascent_m", "descent_m"].map(|name| number(row, name)))
        .sum();
    assert!((both_m - of_roads).abs() < 0.1, "{both_m} {of_roads}");
}

/// The cases of public bug reports: a tunnel under a strait whose floor is in its way, and a bridge
/// over a hump.
#[test]
fn spans_that_the_ground_stops_are_measured_as_they_are_written() {
    for (dem, osm, ascent_m) in [("strait.tif", "tunnel", 66.08), ("hump.tif", "bridge", 39.97)] {
        let files = [dem.to_owned(), format!("{osm}.osm.pbf")];
        let [Some(dem), Some(osm)] =
            files.map(|file| real_data(&format!("cases/clamped-spans/{file}")))
        else {
            return;
        };
        let folder = TempDir::new().unwrap();
        are_ascents(folder.path(), [&dem, &osm], &[], ascent_m);
    }
}

/// Positions of ridges along a road, and their heights, metres.
type Ridges<'a> = &'a [(f64, f64)];

/// Ridges with known tops are in the way of bridges, and trenches in that of a tunnel.
#[test]
fn ridges_and_trenches_count_by_their_tops_and_floors() {
    // Positions of ridges, metres along the road, and their heights: negative ones are trenches.
    let cases: [(Ridges<'_>, &str, f64); 3] = [
        (&[(1000.0, 24.0)], "bridge", 24.0),
        (&[(900.0, 10.0), (1400.0, 31.0)], "bridge", 41.0),
        (&[(1000.0, -18.0), (1500.0, -7.0)], "tunnel", 25.0),
    ];
    for (ridges, structure, ascent_m) in cases {
        let folder = TempDir::new().unwrap();
        let [dem, osm] = ["dem.asc", "roads.osm.pbf"].map(|name| folder.path().join(name));
        let place = "xllcenter 499000\nyllcenter 5199500\ncellsize 20\nNODATA_value -9999";
        write_ascii_grid(&dem, [131, 51], place, |column, _| {
            let along_m = 20.0 * column as f64;
            let over = |(at_m, high_m): &(f64, f64)| {
                high_m * (1.0 - (along_m - at_m).abs() / 200.0).max(0.0)
            };
            300.0 + ridges.iter().map(over).sum::<f64>()
        });
        let place = |along_m: f64| [499_000.0 + along_m, 5_200_003.0];
        let places = [300.0, 500.0, 1900.0, 2200.0].map(place);
        let ways: [(&[i64], &str); 3] = [(&[1, 2], ""), (&[2, 3], structure), (&[3, 4], "")];
        write_way(&osm, &transform(32632, 4326), &places, &ways);
        let options = ["--dem-crs", "EPSG:32632"];
        are_ascents(folder.path(), [&dem, &osm], &options, ascent_m);
    }
}
