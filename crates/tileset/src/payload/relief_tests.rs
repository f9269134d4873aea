//! Reliefs stay within their stated error, and neighbouring tiles have the same slopes on their
//! border.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use corniche_testing::Random;

use super::*;

const CELL: Cell = Cell { east_m: 20.0, north_m: 30.0 };
const QUANTUM_M: f64 = 0.125;

/// A raster with its halo: `height_m(column, row)` for the tile's nodes, from −1 on.
fn raster(height_m: impl Fn(f64, f64) -> f64) -> HeightGrid {
    HeightGrid::from_fn(SIDE + 2, SIDE + 2, |column, row| {
        height_m(column as f64 - 1.0, row as f64 - 1.0) as f32
    })
}

fn hills(east: f64, south: f64) -> f64 {
    700.0 + 90.0 * (east / 23.0).sin() * (south / 31.0).cos() + 6.0 * (east * 0.9 + south).sin()
}

/// Compresses a raster, and checks that the bytes decode to the same relief and that it fulfils its
/// promises.
fn check(with_halo: &HeightGrid) -> Relief {
    let relief = Relief::of_heights(with_halo, with_halo, CELL, QUANTUM_M).unwrap();
    let read = Relief::decode(relief.coded()).unwrap();
    assert_eq!(read.coded, relief.coded);
    assert_eq!(read.border, relief.border);
    let bits =
        |relief: &Relief| relief.heights.raw().iter().map(|h| h.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&read), bits(&relief));
    for row in 0..SIDE {
        for column in 0..SIDE {
            let (was, is) =
                (with_halo.height(column + 1, row + 1), relief.heights().height(column, row));
            assert_eq!(was.is_some(), is.is_some(), "node {column}, {row}");
            if let (Some(was), Some(is)) = (was, is) {
                let error_m = f64::from((was - is).abs());
                let rounding_m = f64::from(was.abs() * f32::EPSILON);
                assert!(error_m <= relief.greatest_error_m() + rounding_m, "{error_m} m");
            }
            let on_border = [column, row].iter().any(|&at| at == 0 || at == SIDE - 1);
            let slope = relief.border_slope(column, row);
            assert_eq!(slope.is_some(), on_border && was.is_some(), "node {column}, {row}");
            if let Some(slope) = slope {
                let exact = corniche_tin::gradient(with_halo, [column + 1, row + 1], CELL);
                for axis in 0..2 {
                    let error = (slope[axis] - exact[axis]).abs();
                    assert!(error <= 0.5 / 256.0 + 1e-12, "slope at {column}, {row}: {error}");
                }
            }
        }
    }
    relief
}

#[test]
fn rough_hills_stay_within_the_stated_error_and_keep_their_slopes() {
    let mut random = Random::new(1);
    let noise: Vec<f64> = (0..300 * 300).map(|_| random.share() * 3.0).collect();
    let with_halo = raster(|east, south| {
        hills(east, south) + noise[((south + 1.0) * 300.0 + east + 1.0) as usize]
    });
    let relief = check(&with_halo);
    assert!(relief.greatest_error_m() < 0.35 * CELL.shorter_m(), "{}", relief.greatest_error_m());
    // The error of slopes of inner nodes: a tenth of the step for each of about 13 coefficients
    // that affect a node.
    let mut sum = 0.0;
    for row in 1..SIDE - 1 {
        for column in 1..SIDE - 1 {
            let is = corniche_tin::gradient(relief.heights(), [column, row], CELL);
            let was = corniche_tin::gradient(&with_halo, [column + 1, row + 1], CELL);
            sum += (0..2).map(|axis| (is[axis] - was[axis]).powi(2)).sum::<f64>();
        }
    }
    let rms = (sum / ((SIDE - 2) * (SIDE - 2)) as f64).sqrt();
    assert!((0.001..0.035).contains(&rms), "slopes are wrong by {rms}");
    assert!(relief.coded().len() < 30_000, "{} bytes", relief.coded().len());
}

#[test]
fn level_ground_and_planes_take_few_bytes() {
    for (name, with_halo) in [
        ("level", raster(|_, _| 412.3)),
        ("plane", raster(|east, south| 100.0 + 4.0 * east - 2.5 * south)),
    ] {
        let bytes = check(&with_halo).coded().len();
        assert!(bytes < 1500, "{name}: {bytes} bytes");
    }
}

type IsVoid<'a> = &'a dyn Fn(f64, f64) -> bool;

#[test]
fn voids_of_every_shape_come_back() {
    let mut random = Random::new(2);
    let single = [random.below(257), random.below(257)];
    let cases: [(&str, IsVoid<'_>); 5] = [
        ("half", &|east, south| east > south),
        ("all but one node", &|east, south| [east as i64, south as i64] != single),
        ("a hole", &|east, south| (east - 90.0).hypot(south - 40.0) < 25.0),
        ("the halo", &|east, south| [east, south].iter().any(|at| !(0.0..=256.0).contains(at))),
        ("a chessboard", &|east, south| (east + south) as i64 % 2 == 0),
    ];
    for (name, is_void) in cases {
        let with_halo =
            raster(|east, south| if is_void(east, south) { f64::NAN } else { hills(east, south) });
        eprintln!("{name}: {} bytes", check(&with_halo).coded().len());
    }
    let nothing = raster(|_, _| f64::NAN);
    assert!(Relief::of_heights(&nothing, &nothing, CELL, QUANTUM_M).is_err());
}

/// Two adjacent tiles: their shared nodes have the same slopes, to the bit, although the heights of
/// both tiles are rounded differently.
#[test]
fn neighbours_have_the_same_slopes_on_their_border() {
    let last = (SIDE - 1) as f64;
    let at = |left: f64, top: f64| check(&raster(|e, s| hills(e + left, s + top)));
    let (own, east, south) = (at(0.0, 0.0), at(last, 0.0), at(0.0, last));
    let mut heights_differ = 0;
    for k in 0..SIDE {
        assert!(own.border_slope(SIDE - 1, k).is_some());
        assert_eq!(own.border_slope(SIDE - 1, k), east.border_slope(0, k));
        assert_eq!(own.border_slope(k, SIDE - 1), south.border_slope(k, 0));
        heights_differ +=
            u32::from(own.heights().height(SIDE - 1, k) != east.heights().height(0, k));
    }
    assert!(heights_differ > 100, "the heights alone would do");
}

#[test]
fn high_and_low_heights_come_back() {
    for height_m in [-430.0, 8848.0, 1.0e6, -1.0e8] {
        check(&raster(|east, south| height_m + hills(east, south)));
    }
    let beyond = raster(|_, _| 1.0e16);
    assert!(Relief::of_heights(&beyond, &beyond, CELL, QUANTUM_M).is_err());
}

/// Any change of the bytes results in an error or another relief, never in a panic, and takes no
/// more memory or time.
#[test]
fn changed_and_cut_bytes_never_panic() {
    let bytes = check(&raster(hills)).coded().to_vec();
    let mut random = Random::new(8);
    for _ in 0..60 {
        let mut changed = bytes.clone();
        let reach = random.one_of(&[40, bytes.len() as i64]);
        let at = random.below(reach) as usize;
        changed[at] ^= 1 << random.below(8);
        let _ = Relief::decode(&changed);
    }
    for cut in [0, 1, 5, 30, 60, bytes.len() - 1] {
        assert!(Relief::decode(&bytes[..cut]).is_err(), "cut to {cut}");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert!(Relief::decode(&longer).is_err());
    for _ in 0..20 {
        let noise: Vec<u8> = (0..3000).map(|_| random.bits() as u8).collect();
        let head_and_noise = [&bytes[..40], &noise].concat();
        let _ = Relief::decode(&head_and_noise);
        let _ = Relief::decode(&noise);
    }
}

#[test]
fn weights_are_those_of_the_transform() {
    let bands = std::iter::once(SMOOTH).chain((0..LEVELS).rev().flat_map(rough_bands));
    for (band, weight) in bands.zip(steps::WEIGHTS) {
        let mut square = vec![0_i64; SIDE * SIDE];
        let unit = 1_i64 << 20;
        square[(band.top + band.rows / 2) * SIDE + band.left + band.columns / 2] = unit;
        wavelet::inverse(&mut square);
        let heights = HeightGrid::from_fn(SIDE, SIDE, |column, row| {
            (square[row * SIDE + column] as f64 / unit as f64) as f32
        });
        let mut sums = [0.0; 2];
        for row in 1..SIDE - 1 {
            for column in 1..SIDE - 1 {
                let square_m = Cell { east_m: 1.0, north_m: 1.0 };
                let slopes = corniche_tin::gradient(&heights, [column, row], square_m);
                (0..2).for_each(|axis| sums[axis] += slopes[axis] * slopes[axis]);
            }
        }
        for axis in 0..2 {
            assert!(
                (sums[axis] / weight[axis] - 1.0).abs() < 0.02,
                "{band:?}: {sums:?} {weight:?}"
            );
        }
    }
}

/// Level ground at or below 0 m is water; the shore, land below 0 m that is not level, and level
/// land above 0 m are not.
#[test]
fn level_ground_at_the_sea_is_water_and_comes_back() {
    let with_halo = raster(|east, south| {
        if south > 200.0 {
            -1.0 - 0.25 * east
        } else if east < 100.0 {
            0.0
        } else if south > 100.0 {
            4.0
        } else {
            hills(east, south)
        }
    });
    let relief = check(&with_halo);
    let water = Relief::decode(relief.coded()).unwrap();
    let water = water.water().unwrap();
    for row in 0..SIDE {
        for column in 0..SIDE {
            let expected = column < 99 && row < 200;
            assert_eq!(water[row * SIDE + column], expected, "{column}, {row}");
        }
    }
    assert!(check(&raster(hills)).water().is_none());
    let nowhere = raster(|east, _| if (east as i64) % 3 == 0 { 0.0 } else { f64::NAN });
    assert!(check(&nowhere).water().is_none(), "two neighbours say nothing");
}
