//! Nodes that are the DEM's own samples: adjoining files, noise in numbers, thinning, rectangles.

use std::fs;
use std::path::{Path, PathBuf};

use corniche_dem::{Dem, GridPlan, OpenOptions, PlanOptions, Resampling};
use corniche_geom::{Cell, NodeIndex, TILE_CELLS, TileId};
use proptest::prelude::*;

use crate::fixture::{Raster, all, check, check_words, in_utm, open, options, plan};

/// A 3″ square of SRTM by its name, with heights from indices.
fn srtm(folder: &Path, name: &str) -> PathBuf {
    let bytes: Vec<u8> = (0..1201_i16)
        .flat_map(|row| (0..1201_i16).flat_map(move |column| (500 + column - row).to_be_bytes()))
        .collect();
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// x of the western and y of the northern borders of all finest tiles, as bits.
fn borders(plan: &GridPlan) -> [Vec<u64>; 2] {
    let frame = &plan.frame;
    let z = frame.max_level();
    let bounds = |k: u32| frame.tile_bounds(TileId::new(z, k, k).unwrap());
    let all = 0..1_u32 << z;
    [
        all.clone().map(|k| bounds(k).min_x.to_bits()).collect(),
        all.map(|k| bounds(k).max_y.to_bits()).collect(),
    ]
}

/// With one latitude for all, packages of adjoining squares share one grid: the same cell, origin
/// and tile borders; so does the package of all squares.
#[test]
fn adjoining_squares_fit_when_their_latitude_is_pinned() {
    let folder = tempfile::tempdir().unwrap();
    let south = srtm(folder.path(), "N47E009.hgt");
    let north = srtm(folder.path(), "N48E009.hgt");
    let east = srtm(folder.path(), "N47E010.hgt");
    let planned = |files: &[&PathBuf], latitude_deg: Option<f64>| {
        let files: Vec<PathBuf> = files.iter().map(|&file| file.clone()).collect();
        let asked = PlanOptions { scale_latitude_deg: latitude_deg, ..options() };
        open(&files).plan(&asked).unwrap()
    };
    let grid = |plan: &GridPlan| {
        let frame = &plan.frame;
        let cell = frame.cell().to_array().map(f64::to_bits);
        (cell, frame.origin_m().map(f64::to_bits), plan.metres_per_unit.map(f64::to_bits))
    };
    // Without a latitude, squares above each other have different latitudes; squares side by side
    // share theirs.
    assert_ne!(grid(&planned(&[&south], None)), grid(&planned(&[&north], None)));
    assert_eq!(grid(&planned(&[&south], None)), grid(&planned(&[&east], None)));
    let pinned = Some(47.5);
    let together = planned(&[&south, &north, &east], pinned);
    assert_eq!(together.resampling, Resampling::Aligned);
    let [columns, rows] = borders(&together);
    for file in [&south, &north, &east] {
        let alone = planned(&[file], pinned);
        assert_eq!(alone.resampling, Resampling::Aligned);
        assert_eq!(grid(&alone), grid(&together));
        let [own_columns, own_rows] = borders(&alone);
        let shared = |own: &[u64], all: &[u64]| own.iter().filter(|x| all.contains(x)).count();
        // 1200 samples to a degree from a multiple of 1200: at least four whole tiles.
        assert!(shared(&own_columns, &columns) >= 4 && shared(&own_rows, &rows) >= 4);
        let corner = alone.frame.root_corner();
        assert!(corner.i % TILE_CELLS == 0 && corner.j % TILE_CELLS == 0);
    }
    let (low, high) = (planned(&[&south], pinned), planned(&[&north], pinned));
    assert_eq!(low.north_east.j, high.south_west.j, "they share a row of samples");
    assert_eq!(
        (low.south_west, low.north_east),
        (NodeIndex { i: 9 * 1200, j: 47 * 1200 }, NodeIndex { i: 10 * 1200, j: 48 * 1200 })
    );
}

/// 1/1200 of a degree and a corner half of that outside, written with few digits: the same grid as
/// with all digits.
#[test]
fn digits_left_out_of_a_geotransform_change_no_grid() {
    let folder = tempfile::tempdir().unwrap();
    let step = 1.0 / 1200.0;
    let [west, north] = [9.0 - step / 2.0, 48.0 + step / 2.0];
    let planned = |name: &str, map: [f64; 6]| {
        let raster = Raster::new(4326, [1201, 1201], map);
        plan(&open(&[raster.write(folder.path(), name, |_| 1_u8)]))
    };
    let exact = planned("exact.tif", [west, step, 0.0, north, 0.0, -step]);
    assert_eq!(exact.frame.origin_m(), [0.0, 0.0]);
    for digits in 9..=15 {
        let cut = |value: f64| format!("{value:.digits$}").parse::<f64>().unwrap();
        let down = |value: f64| {
            let unit = 10_f64.powi(digits as i32);
            (value * unit).floor() / unit
        };
        for (how, map) in [
            ("rounded", [cut(west), cut(step), 0.0, cut(north), 0.0, -cut(step)]),
            ("cut-off", [down(west), down(step), 0.0, down(north), 0.0, -down(step)]),
        ] {
            let noisy = planned(&format!("{how}-{digits}.tif"), map);
            assert_eq!(noisy.resampling, Resampling::Aligned, "{how}, {digits} digits");
            assert_eq!(noisy.frame, exact.frame, "{how}, {digits} digits");
            assert_eq!(noisy.metres_per_unit, exact.metres_per_unit, "{how}, {digits} digits");
        }
    }
}

/// If every K-th sample is a node, these are the samples whose index, counted from the origin of
/// the grid, is a multiple of K, in any part of a product.
#[test]
fn every_nth_sample_is_taken_with_its_bits() {
    let folder = tempfile::tempdir().unwrap();
    let value = |at: [f64; 2]| ((at[0] * 7.0 + at[1] * 3.0).sin() * 900.0) as f32;
    // Samples at 8 + 10 k and 2 + 10 k.
    for (name, west, north) in
        [("a.tif", 500_003.0, 5_200_507.0), ("b.tif", 500_013.0, 5_200_537.0)]
    {
        let raster = Raster::new(32632, [61, 52], [west, 10.0, 0.0, north, 0.0, -10.0]);
        let dem = open(&[raster.write(folder.path(), name, value)]);
        for every in [1, 2, 3, 7] {
            let asked = PlanOptions { cell_every: Some(every), ..options() };
            let plan = dem.plan(&asked).unwrap();
            let side_m = 10.0 * f64::from(every);
            assert_eq!(plan.frame.cell(), Cell::from(side_m));
            assert_eq!(plan.frame.origin_m(), [8.0, 2.0]);
            let case = if every == 1 { Resampling::Aligned } else { Resampling::Thinned };
            assert_eq!(plan.resampling, case);
            let said = format!("one in {every}");
            assert_eq!(plan.resampling_text.contains(&said), every > 1, "{}", plan.resampling_text);
            let mut taken = 0;
            let window = all(&plan);
            let heights = dem.reader(&plan).window(window).unwrap().heights;
            for row in 0..52 {
                for column in 0..61 {
                    let at = raster.sample_at(column, row);
                    let index = [(at[0] - 8.0) / 10.0, (at[1] - 2.0) / 10.0].map(|k| k as i64);
                    let every = i64::from(every);
                    if index[0] % every != 0 || index[1] % every != 0 {
                        continue;
                    }
                    let node = NodeIndex { i: index[0] / every, j: index[1] / every };
                    assert_eq!([plan.frame.x_m(node.i), plan.frame.y_m(node.j)], at);
                    let (c, r) = (node.i - window.corner.i, window.corner.j - node.j);
                    let found = heights.height(c as usize, r as usize);
                    assert_eq!(found.map(f32::to_bits), Some(value(at).to_bits()));
                    taken += 1;
                }
            }
            assert_eq!(taken, window.columns * window.rows, "nodes are these and no others");
        }
    }
}

#[test]
fn thinning_of_degrees_counts_from_the_whole_degree() {
    let folder = tempfile::tempdir().unwrap();
    let dem = open(&[srtm(folder.path(), "N47E009.hgt")]);
    for every in [2_u32, 3, 5] {
        let plan = dem.plan(&PlanOptions { cell_every: Some(every), ..options() }).unwrap();
        let whole = i64::from(1200 / every);
        assert_eq!(plan.resampling, Resampling::Thinned);
        // 9° and 48° are multiples of the cell for all of these.
        assert_eq!(plan.south_west, NodeIndex { i: 9 * whole, j: 47 * whole });
        assert_eq!(plan.north_east, NodeIndex { i: 10 * whole, j: 48 * whole });
        let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
        for (column, row) in [(0, 0), (1, 0), (0, 1), (100, 37), (240, 240)] {
            let (c, r) = (column * every as usize, row * every as usize);
            assert_eq!(heights.height(column, row), Some((500 + c as i32 - r as i32) as f32));
        }
    }
}

#[test]
fn thinning_is_refused_where_nodes_are_no_samples() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.001, 0.0, 47.3, 0.0, -0.001];
    let dem = open(&[Raster::new(4326, [40, 30], map).write(folder.path(), "a.tif", |_| 1.0_f32)]);
    let refused = |asked: PlanOptions, words: &[&str]| {
        check_words(&dem.plan(&asked).unwrap_err(), words);
    };
    let every = |n: u32| PlanOptions { cell_every: Some(n), ..options() };
    refused(every(0), &["--cell-every 0", "from 1 to 1000"]);
    refused(every(1001), &["--cell-every 1001", "from 1 to 1000"]);
    refused(PlanOptions { cell: Some(90.0.into()), ..every(2) }, &["--cell ", "--cell-every"]);
    refused(
        PlanOptions { crs: Some("utm".to_owned()), ..every(2) },
        &["--cell-every", "--crs dem"],
    );
    // Without --crs: lengths far north are not true, and UTM was chosen.
    let far = [9.0, 0.1, 0.0, 70.0, 0.0, -0.1];
    let far = open(&[Raster::new(4326, [40, 60], far).write(folder.path(), "f.tif", |_| 1.0_f32)]);
    let text = far.plan(&every(2)).unwrap_err().to_string();
    assert!(text.contains("pass --crs dem") && text.contains("more than 3 %"), "{text}");
    assert!(!text.contains("omit"), "{text}");
    // For a rotated grid, --crs dem does not help.
    let turned = [500_000.0, 8.0, 6.0, 5_200_000.0, 6.0, -8.0];
    let turned = Raster::new(32632, [40, 30], turned).write(folder.path(), "t.tif", |_| 1.0_f32);
    let text = open(&[turned]).plan(&every(2)).unwrap_err().to_string();
    assert!(text.contains("pass --cell") && !text.contains("--crs"), "{text}");
    // So few samples that none, or a single row, is left.
    refused(every(500), &["--cell-every 500", "2 × 2"]);
}

/// Requested rectangles and squares are interpolated if they are not the DEM's own cells.
#[test]
fn a_cell_may_be_a_rectangle() {
    let folder = tempfile::tempdir().unwrap();
    let map = [9.0, 0.0004, 0.0, 47.3, 0.0, -0.0003];
    let truth = |[lon, lat]: [f64; 2]| 500.0 + 3000.0 * (lon - 9.0) - 5000.0 * (lat - 47.0);
    let dem = open(&[Raster::new(4326, [300, 280], map).write(folder.path(), "a.tif", truth)]);
    let own = plan(&dem);
    assert_eq!(own.resampling, Resampling::Aligned);
    let same = dem.plan(&PlanOptions { cell: Some(own.frame.cell()), ..options() }).unwrap();
    assert_eq!(
        (same.resampling, same.frame),
        (Resampling::Aligned, own.frame),
        "its own, as numbers"
    );
    for (sides, averaged) in
        [([20.0, 30.0], false), ([45.0, 30.0], false), ([30.0, 30.0], false), ([97.0, 20.0], true)]
    {
        let cell = Cell::from(sides);
        for asked in [options(), in_utm()] {
            let plan = dem.plan(&PlanOptions { cell: Some(cell), ..asked }).unwrap();
            assert_eq!(plan.frame.cell().north_m, cell.north_m);
            assert!((plan.frame.cell().east_m - cell.east_m).abs() < 0.0005);
            assert_eq!((plan.resampling, plan.frame.origin_m()), (Resampling::Resampled, [0.0; 2]));
            assert_eq!(
                plan.resampling_text.contains("average"),
                averaged,
                "{}",
                plan.resampling_text
            );
            let projection = dem.projection(&plan).unwrap();
            // A hundredth of the cell on this slope: 4 cm per metre east, 4.5 cm per metre north.
            let tolerance_m = 0.01 * (0.04 * sides[0]).hypot(0.045 * sides[1]) + 1e-3;
            let count = check(&mut dem.reader(&plan), &plan, tolerance_m, |at| {
                let mut points = [at];
                corniche_geom::Projection::wgs84_from_working(&projection, &mut points).unwrap();
                truth(points[0])
            });
            let area = 300.0 * 280.0 * own.frame.cell().east_m * own.frame.cell().north_m;
            let share = count as f64 * sides[0] * sides[1] / area;
            assert!(share > 0.97 && share < 1.01, "{sides:?}: {share}");
        }
    }
}

/// The spacing of Copernicus changes eastwards at 50° and 60°: the first named file defines the
/// grid, the other is resampled onto it and reported; samples of the first stay unchanged.
#[test]
fn the_first_named_file_defines_the_grid() {
    let folder = tempfile::tempdir().unwrap();
    let truth = |[lon, lat]: [f64; 2]| 300.0 + 2000.0 * (lon - 9.0) + 1500.0 * (lat - 50.0);
    let file = |name: &str, step: f64, columns: usize, north: f64| {
        let map = [9.0 - step / 2.0, step, 0.0, north + 0.0005, 0.0, -0.001];
        Raster::new(4326, [columns, 101], map).write(folder.path(), name, truth)
    };
    let south = file("south.tif", 0.001, 301, 50.0);
    let north = file("north.tif", 0.0015, 201, 50.1);
    for (first, other, step, names) in [
        (&south, &north, 0.001, ["south.tif", "north.tif"]),
        (&north, &south, 0.0015, ["north.tif", "south.tif"]),
    ] {
        let alone = plan(&open(std::slice::from_ref(first)));
        let dem = open(&[first.clone(), other.clone()]);
        let asked = PlanOptions { scale_latitude_deg: Some(50.0), ..options() };
        let plan = dem.plan(&asked).unwrap();
        assert_eq!((plan.crs.as_str(), plan.resampling), ("EPSG:4326", Resampling::Resampled));
        assert_eq!(plan.frame.cell(), alone.frame.cell());
        assert_eq!(plan.frame.origin_m(), alone.frame.origin_m());
        let [resampled, onto] = plan.resampled_onto_first.clone().unwrap();
        assert_eq!([onto.as_str(), resampled.as_str()], names);
        assert_eq!(dem.plan(&in_utm()).unwrap().resampled_onto_first, None, "all are resampled");
        let told = plan.resampling_text.as_str();
        assert!(told.starts_with(&format!("nodes are the samples of {}", names[0])), "{told}");
        assert!(told.contains(&format!("between the samples of {}", names[1])), "{told}");
        let [east, north] = plan.metres_per_unit;
        assert!((plan.frame.cell().east_m / east - step).abs() < 1e-12);
        let on_nodes = |[x, y]: [f64; 2]| truth([x / east, y / north]);
        let read = check(&mut dem.reader(&plan), &plan, 0.03, on_nodes);
        assert!(read as f64 > 0.98 * 0.3 / step * 200.0, "{read}");
    }
}

/// Files of one phase are one mosaic, at any distance; the description names some files and counts
/// the others.
#[test]
fn files_of_one_phase_are_one_grid() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: String, west: f64, step: f64| {
        let map = [west - step / 2.0, step, 0.0, 47.1, 0.0, -0.001];
        Raster::new(4326, [50, 60], map).write(folder.path(), &name, |_| 9.0_f32)
    };
    let mut files: Vec<PathBuf> =
        (0..5).map(|k| file(format!("{k}.tif"), 9.0 + 0.1 * f64::from(k), 0.001)).collect();
    let one = plan(&open(&files));
    assert_eq!(
        (one.resampling, one.resampling_text.as_str()),
        (Resampling::Aligned, "nodes are the DEM's samples")
    );
    assert_eq!(one.resampled_onto_first, None);
    files.push(file("other.tif".to_owned(), 9.7, 0.0015));
    let told = plan(&open(&files)).resampling_text;
    assert!(
        told.starts_with("nodes are the samples of 0.tif, 1.tif, 2.tif and 2 more; "),
        "{told}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// For any position of a file and any number of its samples, nodes are samples, bit for bit.
    #[test]
    fn nodes_of_a_thinned_file_are_samples(
        left in -2000_i64..2000, top in -2000_i64..2000, size in (2_usize..40, 2_usize..40), every in 1_u32..5,
        counts_back in any::<bool>(),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let (epsg, sign) = if counts_back { (2053, -1.0) } else { (32735, 1.0) };
        let middle = if counts_back { [0.0, 2_870_000.0] } else { [500_000.0, 7_000_000.0] };
        let map = [
            middle[0] + 20.0 * left as f64, 20.0 * sign, 0.0, middle[1] + 30.0 * top as f64, 0.0, -30.0 * sign,
        ];
        let value = |at: [f64; 2]| (at[0] * 0.37 + at[1] * 0.011).sin() as f32;
        let raster = Raster::new(epsg, [size.0, size.1], map);
        let file = raster.write(folder.path(), "a.tif", value);
        let dem = Dem::open(&[file], &OpenOptions::default()).unwrap();
        let Ok(plan) = dem.plan(&PlanOptions { cell_every: Some(every), ..options() }) else {
            // Fewer than two nodes along an axis.
            prop_assert!(size.0.min(size.1) < 2 * every as usize);
            return Ok(());
        };
        prop_assert_eq!(plan.frame.cell(), Cell::from([20.0, 30.0]).times(f64::from(every)).fitted());
        let window = all(&plan);
        let heights = dem.reader(&plan).window(window).unwrap().heights;
        for row in 0..window.rows {
            for column in 0..window.columns {
                let node = window.node(column, row);
                let [east, north] = plan.metres_per_unit;
                let at = [plan.frame.x_m(node.i) / east, plan.frame.y_m(node.j) / north];
                // Samples lie at whole metres.
                let at = at.map(f64::round);
                let found = heights.height(column, row);
                prop_assert_eq!(found.map(f32::to_bits), Some(value(at).to_bits()), "{:?}", at);
            }
        }
    }
}
