//! Tiles of mixed levels whose skirts are as deep as the viewer makes them (own error + neighbour's
//! error) leave no hole: rays that come from above and end below the ground hit ground or skirt.
//! With skirts of half that depth some rays do not.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{TILE_CELLS, TileId};

use crate::support::{
    Built, Options, Raster, TILE, build_raster,
    rays::{Point, Scene},
    terrain::{bits, noise, waves},
};

/// Depths of the skirts of a cut by the viewer's rule (the viewer's tests check this rule): where
/// tiles of two levels share a stretch of border, both skirts are as deep as both errors together.
fn skirt_depths_m(built: &Built, cut: &BTreeSet<TileId>) -> BTreeMap<TileId, f64> {
    let mut depths_m: BTreeMap<TileId, f64> = cut.iter().map(|&id| (id, 0.0)).collect();
    let error_m = |id: TileId| built.ground(id).unwrap().geometric_error_m;
    for &a in cut {
        let inner = built.frame().tile_bounds(a);
        for &b in cut.iter().filter(|b| b.z() < a.z()) {
            let outer = built.frame().tile_bounds(b);
            let shared = [
                inner.max_x.min(outer.max_x) - inner.min_x.max(outer.min_x),
                inner.max_y.min(outer.max_y) - inner.min_y.max(outer.min_y),
            ];
            // The tiles share a part of the borders, not only a corner.
            if shared[0] >= 0.0 && shared[1] >= 0.0 && shared[0] + shared[1] > 0.0 {
                for id in [a, b] {
                    let depth_m = depths_m.get_mut(&id).unwrap();
                    *depth_m = depth_m.max(error_m(a) + error_m(b));
                }
            }
        }
    }
    depths_m
}

/// A cut through the quadtree: `split` selects the tiles that are refined further.
fn cut(built: &Built, split: impl Fn(TileId) -> bool) -> BTreeSet<TileId> {
    let mut cut = BTreeSet::new();
    let mut left = vec![TileId::ROOT];
    while let Some(id) = left.pop() {
        let children: Vec<_> = id.children().filter(|id| built.ground(*id).is_some()).collect();
        if split(id) && !children.is_empty() && id.z() < built.frame().max_level() {
            left.extend(children);
        } else {
            cut.insert(id);
        }
    }
    cut
}

/// Stretches of the borders of drawn tiles, by the line that contains them: axis and position of
/// the line, then the position along it.
type Borders = BTreeMap<(usize, i64), Vec<[(f64, f64); 2]>>;

/// The meshes of a cut with skirts of the fraction `share` of their depth.
fn scene(built: &Built, depths_m: &BTreeMap<TileId, f64>, share: f64) -> (Scene, Borders) {
    let (mut scene, mut borders) = (Scene::default(), Borders::new());
    let corner = built.frame().root_corner();
    for (&id, &depth_m) in depths_m {
        let tin = &built.ground(id).unwrap().tin;
        let nodes = built.nodes(id, tin);
        let side = TILE_CELLS * built.frame().stride(id.z());
        let place = |vertex: u32| -> Point {
            let (node, height_q) =
                (nodes[vertex as usize], tin.vertices()[vertex as usize].height_q);
            let (x, y) = (node.i - corner.i, corner.j - node.j);
            [x as f64, y as f64, f64::from(height_q) * built.quantum_m()]
        };
        for corners in tin.triangles() {
            scene.add(corners.map(place));
            for k in 0..3 {
                let ends = [corners[k], corners[(k + 1) % 3]].map(place);
                // An edge on the tile's border: x or y is the same whole number of tile sides at
                // both ends.
                let line = (0..2).find(|&axis| {
                    ends[0][axis].to_bits() == ends[1][axis].to_bits()
                        && (ends[0][axis] as i64) % side == 0
                });
                let Some(axis) = line else { continue };
                let low = ends.map(|[x, y, z]| [x, y, z - depth_m * share]);
                scene.add([ends[0], low[0], ends[1]]);
                scene.add([ends[1], low[0], low[1]]);
                let mut stretch = ends.map(|end| (end[1 - axis], end[2]));
                stretch.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
                borders.entry((axis, ends[0][axis] as i64)).or_default().push(stretch);
            }
        }
    }
    (scene, borders)
}

/// Pseudo-random numbers from 0 to 1.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 += 1;
        (bits(self.0 as i64, (self.0 >> 32) as i64, 9) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The field over which rays are cast.
struct Field {
    /// Columns and rows of data, in cells.
    size: [f64; 2],
    /// First column and row, in cells from the root's corner.
    corner: [f64; 2],
    range_m: [f64; 2],
    /// Nodes, row by row, next to which a drawn tile may lack ground.
    bare: Vec<bool>,
}

impl Field {
    /// Whether the ray's path in plan has ground on every drawn level.
    fn holds(&self, from: Point, to: Point) -> bool {
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) * 2.0).ceil().max(1.0) as u32;
        (0..=steps).all(|step| {
            let share = f64::from(step) / f64::from(steps);
            let at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * share - self.corner[k]);
            let inside = (0..2).all(|k| at[k] >= 0.0 && at[k] <= self.size[k]);
            let node = at.map(|at| at.round() as usize);
            inside && !self.bare[node[1] * (self.size[0] as usize + 1) + node[0]]
        })
    }

    /// A ray through a point, from above all ground to below it; its whole length in plan is `run`
    /// cells.
    fn through(&self, at: Point, azimuth: f64, run: f64) -> [Point; 2] {
        let [low_m, high_m] = [self.range_m[0] - 1.0, self.range_m[1] + 1.0];
        let per_metre = run / (high_m - low_m);
        let end = |height_m: f64| {
            let cells = (at[2] - height_m) * per_metre;
            [at[0] + azimuth.sin() * cells, at[1] + azimuth.cos() * cells, height_m]
        };
        [end(high_m), end(low_m)]
    }
}

/// Casts rays anywhere, and rays aimed between the two sides of borders; returns how many were cast
/// and how many hit nothing.
fn cast(field: &Field, scene: &Scene, borders: &Borders, rays: usize) -> [usize; 2] {
    let mut dice = Dice(1);
    let (mut cast, mut lost) = (0, 0);
    let mut look = |ray: [Point; 2]| {
        if field.holds(ray[0], ray[1]) {
            cast += 1;
            lost += usize::from(!scene.hits(ray[0], ray[1]));
        }
    };
    // Steep to shallow rays: from one cell in plan up to hundreds.
    let run = |dice: &mut Dice| 2.0_f64.powf(10.0 * dice.roll() - 1.0);
    for _ in 0..rays {
        let height_m = field.range_m[0] + dice.roll() * (field.range_m[1] - field.range_m[0]);
        let at = [
            field.corner[0] + dice.roll() * field.size[0],
            field.corner[1] + dice.roll() * field.size[1],
            height_m,
        ];
        look(field.through(at, dice.roll() * std::f64::consts::TAU, run(&mut dice)));
    }
    let stretches: Vec<_> = borders
        .iter()
        .flat_map(|(&line, stretches)| stretches.iter().map(move |stretch| (line, *stretch)))
        .collect();
    for _ in 0..rays {
        let ((axis, line), [from, to]) = stretches[(dice.roll() * stretches.len() as f64) as usize];
        let height_m = |[from, to]: [(f64, f64); 2], along: f64| {
            from.1 + (to.1 - from.1) * (along - from.0) / (to.0 - from.0)
        };
        let along = from.0 + (to.0 - from.0) * dice.roll();
        // The lowest and the highest of the tiles that end here.
        let sides = borders[&(axis, line)]
            .iter()
            .filter(|[from, to]| (from.0..=to.0).contains(&along))
            .map(|stretch| height_m(*stretch, along));
        let [low, high] = sides.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], side| {
            [low.min(side), high.max(side)]
        });
        let aimed_m = low + (high - low) * dice.roll();
        let at =
            if axis == 0 { [line as f64, along, aimed_m] } else { [along, line as f64, aimed_m] };
        look(field.through(at, dice.roll() * std::f64::consts::TAU, run(&mut dice)));
    }
    [cast, lost]
}

/// The area in which rays may be cast for a cut whose coarsest cell is `stride`: farther than that
/// from voids.
fn field(built: &Built, raster: &Raster, stride: i64) -> Field {
    let (columns, rows) = (raster.columns as i64, raster.rows as i64);
    // Everything outside the data is void.
    let at_edge = |index: usize| {
        let (column, row) = (index as i64 % columns, index as i64 / columns);
        let inside = (stride..columns - stride).contains(&column);
        !(inside && (stride..rows - stride).contains(&row))
    };
    let mut bare: Vec<bool> = (0..raster.heights_m.len()).map(at_edge).collect();
    for (index, _) in raster.heights_m.iter().enumerate().filter(|(_, height_m)| height_m.is_nan())
    {
        let (column, row) = (index as i64 % columns, index as i64 / columns);
        for r in (row - stride).max(0)..=(row + stride).min(rows - 1) {
            for c in (column - stride).max(0)..=(column + stride).min(columns - 1) {
                bare[(r * columns + c) as usize] = true;
            }
        }
    }
    let root = built.frame().root_corner();
    Field {
        size: [(columns - 1) as f64, (rows - 1) as f64],
        corner: [(raster.west - root.i) as f64, (root.j - raster.north) as f64],
        range_m: built.ground(TileId::ROOT).unwrap().height_range_m,
        bare,
    }
}

/// Hills, cliffs and spikes, with needles on borders of tiles that coarse levels miss, so that the
/// gap there is nearly all of their error. Heights by raster column and row; the first sample is
/// `shift` from a corner of tiles.
fn rough(shift: [i64; 2], column: i64, row: i64) -> f32 {
    let at = [column + shift[0], row + shift[1]];
    let on_border =
        |axis: usize| at[axis].rem_euclid(TILE) == 0 && at[1 - axis].rem_euclid(16) == 7;
    if on_border(0) || on_border(1) {
        return 500.0;
    }
    let spike =
        if bits(column, row, 6).is_multiple_of(300) { 150.0 * noise(column, row) } else { 0.0 };
    let cliff = if (column + 3 * row).rem_euclid(409) < 150 { 90.0 } else { 0.0 };
    80.0 * waves(column / 4, row / 3) + cliff + spike
}

/// Builds, cuts, and casts rays: whole skirts leave no hole; skirts of half the depth do.
fn check(raster: &Raster, splits: &[&dyn Fn(TileId) -> bool], rays: usize) {
    let built = build_raster(raster, Options::plain(20.0)).unwrap();
    let (mut rays_cast, mut holes) = (0, [0; 2]);
    for (number, split) in splits.iter().enumerate() {
        let cut = cut(&built, split);
        let levels: BTreeSet<u8> = cut.iter().map(|id| id.z()).collect();
        assert!(levels.len() > 1, "cut {number} mixes levels");
        let coarsest = *levels.first().unwrap();
        let field = field(&built, raster, built.frame().stride(coarsest));
        let depths_m = skirt_depths_m(&built, &cut);
        let (whole, borders) = scene(&built, &depths_m, 1.0);
        let [cast_whole, lost] = cast(&field, &whole, &borders, rays);
        assert_eq!(lost, 0, "cut {number}, levels {levels:?}: of {cast_whole} rays");
        rays_cast += cast_whole;
        for (share, holes) in [0.5, 0.0].into_iter().zip(&mut holes) {
            let (torn, _) = scene(&built, &depths_m, share);
            *holes += cast(&field, &torn, &borders, rays)[1];
        }
    }
    assert!(rays_cast > rays, "{rays_cast} rays were cast");
    // The check works: skirts of half the depth leave holes, no skirts leave more.
    assert!(holes[0] > 0 && holes[1] > holes[0], "{holes:?} of {rays_cast}");
}

/// Whether a tile is in the western half.
fn is_west(id: TileId) -> bool {
    id.z() > 0 && id.ancestor(1).x() == 0
}

fn random(id: TileId) -> bool {
    id.z() == 0 || !bits(i64::from(id.x()), i64::from(id.y()), u64::from(id.z())).is_multiple_of(3)
}

#[test]
fn no_hole_between_levels_up_to_two_apart() {
    let raster = Raster::new([2049, 513], [0, 0], |c, r| rough([0, 0], c, r));
    // Level 1 next to level 3; every second tile refined by one level; any mixture.
    let chequered = |id: TileId| id.z() < 2 || id.z() == 2 && (id.x() + id.y()).is_multiple_of(2);
    check(&raster, &[&|id| !is_west(id), &chequered, &random], 6000);
}

#[test]
fn no_hole_between_levels_three_apart() {
    let raster = Raster::new([4097, 257], [0, 0], |c, r| rough([0, 0], c, r));
    check(&raster, &[&|id| !is_west(id), &is_west_or_root], 6000);
}

fn is_west_or_root(id: TileId) -> bool {
    id.z() == 0 || is_west(id)
}

/// Data that start and end inside tiles, with voids: where all drawn levels have ground, there is
/// no hole either.
#[test]
fn no_hole_on_ground_with_voids() {
    let raster = Raster::new([1700, 490], [90, 33], |column, row| {
        let block = bits(column.div_euclid(23), row.div_euclid(19), 4) % 100 < 3;
        if block || bits(column, row, 5).is_multiple_of(4000) {
            f32::NAN
        } else {
            rough([90, 33], column, row)
        }
    });
    check(&raster, &[&|id| !is_west(id), &random], 6000);
}
