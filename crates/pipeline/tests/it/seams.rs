//! P3 on synthetic terrains: two tiles have the same bits on their common border, the heights
//! beneath a tile are within its stored range and error, and nothing depends on the number of
//! threads.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use crate::support::{
    Built, Options, Raster,
    agreement::{faults, nesting, shared_borders, shared_vertices},
    build_raster,
    terrain::{TERRAINS, scattered_void},
};
use corniche_tin::{Tin, TinVertex};

/// A way to place a raster on tiles: its samples, its offset in cells from a tile corner, and the
/// requested cell.
struct Tiling {
    size: [usize; 2],
    shift: [i64; 2],
    cell_m: Option<f64>,
}

/// Exactly two by two tiles; data that start and end inside tiles; cells of two and of three and a
/// half samples.
const TILINGS: [Tiling; 4] = [
    Tiling { size: [513, 513], shift: [0, 0], cell_m: None },
    Tiling { size: [301, 700], shift: [37, 201], cell_m: None },
    Tiling { size: [1030, 301], shift: [-3, 250], cell_m: Some(20.0) },
    Tiling { size: [1001, 500], shift: [100, 7], cell_m: Some(35.0) },
];

/// Builds a terrain on a tiling and checks all agreements between tiles.
fn check(tiling: &Tiling, relief: fn(i64, i64) -> f32, is_void: fn(i64, i64) -> bool) -> Built {
    let raster = Raster::new(tiling.size, tiling.shift, |column, row| {
        if is_void(column, row) { f32::NAN } else { relief(column, row) }
    });
    let options = Options { cell_m: tiling.cell_m, ..Options::plain(12.0) };
    let built = build_raster(&raster, options).unwrap();
    assert!(built.frame().max_level() > 0, "several tiles");
    let faults = faults(&built);
    assert!(faults.is_empty(), "{:#?}", &faults[..faults.len().min(10)]);
    built
}

fn whole(_: i64, _: i64) -> bool {
    false
}

fn check_all(tiling: &Tiling) {
    for (name, relief) in TERRAINS {
        for is_void in [whole as fn(i64, i64) -> bool, scattered_void] {
            let built = check(tiling, relief, is_void);
            assert!(built.grounds().count() > 4, "{name}");
        }
    }
}

#[test]
fn tiles_agree_where_data_fill_them() {
    check_all(&TILINGS[0]);
}

#[test]
#[ignore = "slow: builds eight terrains"]
fn tiles_agree_where_data_end_inside_them() {
    check_all(&TILINGS[1]);
}

#[test]
#[ignore = "slow: builds six terrains in two tilings"]
fn tiles_agree_when_heights_are_averaged() {
    check_all(&TILINGS[2]);
    check_all(&TILINGS[3]);
}

#[test]
fn bytes_are_the_same_for_any_number_of_threads() {
    // The last three terrains are the rough ones.
    for (name, relief) in TERRAINS.into_iter().skip(3) {
        let raster = Raster::new([520, 400], [99, 77], |column, row| {
            if scattered_void(column, row) { f32::NAN } else { relief(column, row) }
        });
        let by = |threads| {
            let options = Options { fill_voids: 8, threads, ..Options::plain(12.0) };
            build_raster(&raster, options).unwrap().bytes
        };
        let one = by(1);
        assert!([2, 7].into_iter().all(|threads| by(threads) == one), "{name}");
    }
}

/// The checks above find each kind of disagreement, created by hand.
#[test]
fn disagreement_is_seen() {
    let (_, relief) = TERRAINS[5];
    let sound = || check(&TILINGS[1], relief, whole);
    let east_border = |built: &Built| {
        built
            .grounds()
            .filter(|(id, _)| {
                id.z() == built.frame().max_level()
                    && id.neighbour(1, 0).is_some_and(|beside| built.ground(beside).is_some())
            })
            .find_map(|(id, ground)| {
                let inside = |v: &TinVertex| v.column == 256 && (1..256).contains(&v.row);
                Some((id, ground.tin.vertices().iter().position(inside)?))
            })
            .unwrap()
    };

    let mut raised = sound();
    let (id, vertex) = east_border(&raised);
    let ground = raised.tiles.get_mut(&id).unwrap().terrain.as_mut().unwrap();
    let mut vertices = ground.tin.vertices().to_vec();
    vertices[vertex].height_q += 1;
    ground.tin = Tin::new(vertices, ground.tin.triangles()).unwrap();
    assert_eq!((shared_vertices(&raised).len(), shared_borders(&raised).len()), (1, 1));

    let mut turned = sound();
    let ground = turned.tiles.get_mut(&id).unwrap().terrain.as_mut().unwrap();
    ground.normals[vertex][0] ^= 1;
    assert_eq!((shared_vertices(&turned).len(), shared_borders(&turned).len()), (1, 0));

    let mut claimed = sound();
    let ground = claimed.tiles.get_mut(&id).unwrap().terrain.as_mut().unwrap();
    ground.geometric_error_m *= 1e3;
    assert_eq!(nesting(&claimed).len(), usize::from(id.z()));

    let mut low = sound();
    let ground = low.tiles.get_mut(&id).unwrap().terrain.as_mut().unwrap();
    ground.height_range_m[1] = ground.height_range_m[0];
    assert_eq!(nesting(&low).len(), 1);
}
