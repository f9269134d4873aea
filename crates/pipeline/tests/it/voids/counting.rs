//! The expected content of a package, counted by nodes and cells of the raster that was written.

use corniche_geom::{HeightGrid, NodeIndex, TileId};
use corniche_testing::{check_covers_ground, check_tin};
use corniche_tin::Tin;

use super::{
    MAX_ERROR_M,
    support::{Built, Raster, TILE},
};

/// The raster that was written, with voids filled by the rule: data within `reach` in each of the
/// eight directions.
pub(crate) fn filled(raster: &Raster, reach: i64) -> Raster {
    let at = |column: i64, row: i64| {
        raster.height_m(NodeIndex { i: raster.west + column, j: raster.north - row })
    };
    let fill = |column: i64, row: i64| -> Option<f32> {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (east, south) in [(0, 1), (1, 0), (1, 1), (1, -1), (0, -1), (-1, 0), (-1, -1), (-1, 1)]
        {
            let found = (1..=reach)
                .find_map(|cells| Some((cells, at(column + cells * east, row + cells * south)?)));
            let (cells, height_m) = found?;
            let weight = 1.0 / (cells as f64 * ((east * east + south * south) as f64).sqrt());
            sum += weight * f64::from(height_m);
            weights += weight;
        }
        Some((sum / weights) as f32)
    };
    let mut heights_m = raster.heights_m.clone();
    for (index, height_m) in
        heights_m.iter_mut().enumerate().filter(|(_, height_m)| height_m.is_nan())
    {
        let (column, row) = (index % raster.columns, index / raster.columns);
        *height_m = fill(column as i64, row as i64).unwrap_or(f32::NAN);
    }
    Raster { heights_m, ..*raster }
}

pub(crate) fn check_ground(name: &str, built: &Built, truth: &Raster, source: &Raster) {
    let count =
        |raster: &Raster| raster.heights_m.iter().filter(|height_m| !height_m.is_nan()).count();
    let samples = built.manifest.counts.samples;
    let counted = [samples.with_data, samples.filled, samples.void];
    let filled = count(truth) - count(source);
    let void = truth.heights_m.len() - count(truth);
    assert_eq!(counted, [count(source), filled, void].map(|nodes| nodes as u64), "{name}");

    for level in 0..=built.frame().max_level() {
        let mut uncovered = 0;
        for (x, y) in (0..1_u32 << level).flat_map(|x| (0..1_u32 << level).map(move |y| (x, y))) {
            uncovered += check_tile(name, built, truth, TileId::new(level, x, y).unwrap());
        }
        let said = built.manifest.levels[usize::from(level)].uncovered_nodes;
        assert_eq!(said, uncovered, "{name}: uncovered nodes of level {level}");
    }
}

/// Checks a tile, which may be missing; returns its nodes with data that no cell of its level
/// covers. Nodes on the east and south border belong to the next tile.
fn check_tile(name: &str, built: &Built, truth: &Raster, id: TileId) -> u64 {
    let frame = built.frame();
    let (corner, stride) = (frame.tile_corner(id), frame.stride(id.z()));
    let node = |column: i64, row: i64| NodeIndex {
        i: corner.i + column * stride,
        j: corner.j - row * stride,
    };
    let side = TILE as usize + 3;
    let level_heights = HeightGrid::from_fn(side, side, |column, row| {
        truth.height_m(node(column as i64 - 1, row as i64 - 1)).unwrap_or(f32::NAN)
    });
    let none = Tin::default();
    let ground = built.ground(id);
    let tin = ground.map_or(&none, |ground| &ground.tin);
    check_tin(tin);
    // No wall and no hole: in plan the TIN consists of the ground cells of its level, to the last
    // edge.
    check_covers_ground(tin, &level_heights);
    assert_eq!(ground.is_none(), tin.is_empty(), "{name}: {id}");
    // No spike: a vertex has the height of the raster.
    let quantum_m = built.quantum_m();
    for (vertex, node) in tin.vertices().iter().zip(built.nodes(id, tin)) {
        let height_m = f64::from(truth.height_m(node).expect("there are data at a vertex"));
        let off_m = (f64::from(vertex.height_q) * quantum_m - height_m).abs();
        assert!(off_m <= quantum_m / 2.0, "{name}: {id} {vertex:?} is {off_m} m off");
    }
    check_error(name, built, truth, id);
    uncovered_nodes(name, truth, &level_heights, corner, stride)
}

/// The stored error is not below the true error, node by node and triangle by triangle.
fn check_error(name: &str, built: &Built, truth: &Raster, id: TileId) {
    let Some(ground) = built.ground(id) else { return };
    let nodes = built.nodes(id, &ground.tin);
    let mut true_m = 0.0_f64;
    for corners in ground.tin.triangles() {
        let at = corners.map(|corner| nodes[corner as usize]);
        let [a, b, c] = at.map(|node| [node.i as f64, node.j as f64]);
        let heights_m = corners.map(|corner| {
            f64::from(ground.tin.vertices()[corner as usize].height_q) * built.quantum_m()
        });
        let (i, j) = (at.map(|node| node.i), at.map(|node| node.j));
        for i in *i.iter().min().unwrap()..=*i.iter().max().unwrap() {
            for j in *j.iter().min().unwrap()..=*j.iter().max().unwrap() {
                let weights = corniche_geom::barycentric([i as f64, j as f64], a, b, c);
                if weights.iter().any(|&weight| weight < -1e-9) {
                    continue;
                }
                let Some(height_m) = truth.height_m(NodeIndex { i, j }) else { continue };
                let tin_m: f64 = weights.iter().zip(heights_m).map(|(weight, h)| weight * h).sum();
                true_m = true_m.max((tin_m - f64::from(height_m)).abs());
            }
        }
    }
    let stored_m = ground.geometric_error_m;
    assert!(stored_m >= true_m - 1e-6, "{name}: {id} stores {stored_m} m, is {true_m} m off");
    if id.z() == built.frame().max_level() {
        assert!(true_m <= MAX_ERROR_M + 1e-6, "{name}: {id} is {true_m} m off");
    }
}

/// Counts nodes with data outside all ground cells of a tile; each must be within one cell of the
/// level from a void.
fn uncovered_nodes(
    name: &str,
    truth: &Raster,
    level_heights: &HeightGrid,
    corner: NodeIndex,
    stride: i64,
) -> u64 {
    let mut uncovered = 0;
    // Outside the raster there is nothing to count.
    let columns = (truth.west - corner.i).max(0)
        ..(truth.west + truth.columns as i64 - corner.i).min(TILE * stride);
    let rows = (corner.j - truth.north).max(0)
        ..(corner.j - truth.north + truth.rows as i64).min(TILE * stride);
    for row in rows {
        for column in columns.clone() {
            let at = |column: i64, row: i64| NodeIndex { i: corner.i + column, j: corner.j - row };
            if truth.height_m(at(column, row)).is_none() {
                continue;
            }
            // Cells of the level that contain the node, edges included: one, two or four; also in
            // the halo, which contains the cells of the tiles west and north.
            let cells = |at: i64| {
                let on_edge = i64::from(at % stride == 0);
                at / stride + 1 - on_edge..=at / stride + 1
            };
            let covered = cells(row).any(|r| {
                cells(column).any(|c| level_heights.cell_has_ground(c as usize, r as usize))
            });
            // A tile is measured by its own TIN alone.
            let own = cells(row).any(|r| {
                r > 0
                    && cells(column)
                        .any(|c| c > 0 && level_heights.cell_has_ground(c as usize, r as usize))
            });
            if own {
                continue;
            }
            uncovered += 1;
            if covered {
                continue;
            }
            let near_void = (-stride..=stride).any(|south| {
                (-stride..=stride)
                    .any(|east| truth.height_m(at(column + east, row + south)).is_none())
            });
            assert!(near_void, "{name}: a node far from any void is bare at stride {stride}");
        }
    }
    uncovered
}
