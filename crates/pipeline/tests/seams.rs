//! P3 on made-up terrains: what two tiles share they share to the last bit, what lies beneath a tile is within what
//! the tile says of itself, and none of it depends on how many threads made it.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod support;

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{NodeIndex, TileId};
use corniche_tin::{Tin, TinVertex};
use support::{
    Built, Options, Raster, build_raster,
    terrain::{TERRAINS, scattered_void},
};

/// A way to lay a raster over tiles: samples, cells from a tile corner, and the cell asked for.
struct Tiling {
    size: [usize; 2],
    shift: [i64; 2],
    cell_m: Option<f64>,
}

/// Two by two tiles exactly; data that begin and end inside tiles; cells of two and of three and a half samples.
const TILINGS: [Tiling; 4] = [
    Tiling { size: [513, 513], shift: [0, 0], cell_m: None },
    Tiling { size: [301, 700], shift: [37, 201], cell_m: None },
    Tiling { size: [1030, 301], shift: [-3, 250], cell_m: Some(20.0) },
    Tiling { size: [1001, 500], shift: [100, 7], cell_m: Some(35.0) },
];

/// Builds a terrain on a tiling and checks all that tiles promise each other.
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

/// Everything in which tiles disagree.
fn faults(built: &Built) -> Vec<String> {
    let mut faults = shared_vertices(built);
    faults.extend(shared_borders(built));
    faults.extend(nesting(built));
    faults
}

/// A node that is a vertex of several tiles of one level has one height and one normal, in all four at a corner.
fn shared_vertices(built: &Built) -> Vec<String> {
    let mut seen: BTreeMap<(u8, NodeIndex), (i32, [i8; 2], TileId)> = BTreeMap::new();
    let mut faults = Vec::new();
    for (id, ground) in built.grounds() {
        let nodes = built.nodes(id, &ground.tin);
        for ((node, vertex), normal) in nodes.iter().zip(ground.tin.vertices()).zip(&ground.normals)
        {
            let here = (vertex.height_q, *normal, id);
            let there = *seen.entry((id.z(), *node)).or_insert(here);
            if (there.0, there.1) != (here.0, here.1) {
                faults.push(format!("{node:?}: {there:?} and {here:?}"));
            }
        }
    }
    faults
}

/// A stretch of border from one vertex to the next: position and height of both.
type Stretch = [(u16, i32); 2];

/// The stretches on which triangles of a tile end at one side of it: columns (or rows, when `rows`) equal to `at`.
fn border(tin: &Tin, at: u16, rows: bool) -> BTreeSet<Stretch> {
    let place = |vertex: TinVertex| {
        if rows { (vertex.row, vertex.column) } else { (vertex.column, vertex.row) }
    };
    let mut stretches = BTreeSet::new();
    for corners in tin.triangles() {
        let corners = corners.map(|corner| tin.vertices()[corner as usize]);
        for k in 0..3 {
            let ends = [corners[k], corners[(k + 1) % 3]];
            if ends.iter().all(|&vertex| place(vertex).0 == at) {
                let mut stretch = ends.map(|vertex| (place(vertex).1, vertex.height_q));
                stretch.sort_unstable();
                stretches.insert(stretch);
            }
        }
    }
    stretches
}

/// Where both sides of a border have ground, both have the same stretches.
fn shared_borders(built: &Built) -> Vec<String> {
    let mut faults = Vec::new();
    for (id, ground) in built.grounds() {
        for (dx, dy) in [(1, 0), (0, 1)] {
            let Some(beside) = id.neighbour(dx, dy) else { continue };
            let Some(other) = built.ground(beside) else { continue };
            let rows = dy == 1;
            let sides = [border(&ground.tin, 256, rows), border(&other.tin, 0, rows)];
            // Unit steps along the border that each side covers.
            let covered = sides.each_ref().map(|side| {
                side.iter().flat_map(|&[from, to]| from.0..to.0).collect::<BTreeSet<u16>>()
            });
            let both: BTreeSet<u16> = covered[0].intersection(&covered[1]).copied().collect();
            let shared = sides.each_ref().map(|side| {
                let on_both =
                    |stretch: &&Stretch| (stretch[0].0..stretch[1].0).any(|at| both.contains(&at));
                side.iter().filter(on_both).collect::<BTreeSet<_>>()
            });
            if shared[0] != shared[1] {
                let differ: Vec<_> = shared[0].symmetric_difference(&shared[1]).take(4).collect();
                faults.push(format!("{id} and {beside} differ: {differ:?}"));
            }
        }
    }
    faults
}

/// No tile beneath another has a larger error or reaches beyond its heights; no vertex lies beyond the tile's own.
fn nesting(built: &Built) -> Vec<String> {
    let mut faults = Vec::new();
    for (id, ground) in built.grounds() {
        let [low_m, high_m] = ground.height_range_m;
        for above in (0..id.z()).map(|level| id.ancestor(level)) {
            let Some(parent) = built.ground(above) else { continue };
            let nested = parent.geometric_error_m >= ground.geometric_error_m
                && parent.height_range_m[0] <= low_m
                && parent.height_range_m[1] >= high_m;
            if !nested {
                faults.push(format!("{id} exceeds {above}"));
            }
        }
        // A height is stored to half a step.
        let slack_m = built.quantum_m() / 2.0;
        let beyond = ground.tin.vertices().iter().any(|vertex| {
            let height_m = f64::from(vertex.height_q) * built.quantum_m();
            height_m < low_m - slack_m || height_m > high_m + slack_m
        });
        if beyond {
            faults.push(format!("{id} has a vertex outside {low_m}..{high_m} m"));
        }
    }
    faults
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
fn tiles_agree_where_data_end_inside_them() {
    check_all(&TILINGS[1]);
}

#[test]
fn tiles_agree_when_heights_are_averaged() {
    check_all(&TILINGS[2]);
    check_all(&TILINGS[3]);
}

#[test]
fn bytes_are_the_same_for_any_number_of_threads() {
    // The last three are the rough ones.
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

/// The checks above see what they are for: each kind of disagreement, made by hand, is found.
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
