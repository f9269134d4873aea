//! Agreement between the tiles of a package: borders are equal to the last bit, and errors and
//! heights are nested.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{NodeIndex, TileId};
use corniche_tin::{Tin, TinVertex};

use super::Built;

/// Lists all disagreements between tiles.
pub(crate) fn faults(built: &Built) -> Vec<String> {
    let mut faults = shared_vertices(built);
    faults.extend(shared_borders(built));
    faults.extend(nesting(built));
    faults
}

/// A node that is a vertex of several tiles of one level has one height and one normal, also in all
/// four tiles at a corner.
pub(crate) fn shared_vertices(built: &Built) -> Vec<String> {
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

/// The stretches on which triangles of a tile end at one of its sides: columns (or rows, if `rows`)
/// equal to `at`.
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
pub(crate) fn shared_borders(built: &Built) -> Vec<String> {
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

/// No tile beneath another has a larger error or heights outside the other's range; no vertex is
/// outside its own tile's range.
pub(crate) fn nesting(built: &Built) -> Vec<String> {
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
        // A height is stored to the nearest half step.
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
