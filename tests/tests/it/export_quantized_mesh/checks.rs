//! Invariants of terrain tiles.

use std::{
    collections::{BTreeSet, HashMap},
    path::Path,
};

use corniche_testing::Random;
use e2e::{
    ground::{FromEarth, Ground, Region},
    manifest,
};
use serde_json::Value;

use super::terrain::{LAST, Name, Terrain, Tile, geocentric};

type Check = Result<(), String>;

fn ensure(holds: bool, what: impl FnOnce() -> String) -> Check {
    if holds { Ok(()) } else { Err(what()) }
}

/// The tiles that a list of rectangles names.
pub(crate) fn tiles_of(blocks: &Value, level: u32) -> Vec<Name> {
    let blocks = blocks.as_array().unwrap();
    let each = |block: &Value| {
        let [from_x, from_y, to_x, to_y] = ["startX", "startY", "endX", "endY"]
            .map(|name| u32::try_from(block[name].as_u64().unwrap()).unwrap());
        (from_x..=to_x)
            .flat_map(|x| (from_y..=to_y).map(move |y| [level, x, y]))
            .collect::<Vec<_>>()
    };
    blocks.iter().flat_map(each).collect()
}

/// layer.json names the files, each once; both roots are there; each tile has its parent.
pub(crate) fn check_tree(terrain: &Terrain) -> Check {
    let levels = terrain.layer["available"].as_array().unwrap();
    let named: Vec<Name> = levels
        .iter()
        .enumerate()
        .flat_map(|(level, blocks)| tiles_of(blocks, level as u32))
        .collect();
    let distinct: BTreeSet<Name> = named.iter().copied().collect();
    ensure(distinct.len() == named.len(), || "a tile is named twice".to_owned())?;
    let there: BTreeSet<Name> = terrain.tiles.keys().copied().collect();
    ensure(distinct == there, || "layer.json names other tiles".to_owned())?;
    for x in 0..roots(terrain) {
        ensure(there.contains(&[0, x, 0]), || format!("no root {x}"))?;
    }
    for [level, x, y] in there.iter().filter(|name| name[0] > 0) {
        let parent = [level - 1, x / 2, y / 2];
        ensure(there.contains(&parent), || format!("{parent:?} is missing"))?;
    }
    ensure(terrain.layer["maxzoom"] == terrain.levels() - 1, || "maxzoom".to_owned())
}

fn roots(terrain: &Terrain) -> u32 {
    if terrain.layer["projection"] == "EPSG:4326" { 2 } else { 1 }
}

/// Triangles cover the square once, counter-clockwise; each edge exists twice or is on the border;
/// corners exist; the lists of border vertices are complete.
pub(crate) fn check_mesh(tile: &Tile) -> Check {
    let mut balance: HashMap<[usize; 2], i32> = HashMap::new();
    let mut twice_area = 0;
    for corners in &tile.triangles {
        let [a, b, c] = corners.map(|k| tile.uv[k].map(i64::from));
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        ensure(twice > 0, || format!("triangle {corners:?} is not counter-clockwise"))?;
        twice_area += twice;
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let step = if from < to { 1 } else { -1 };
            *balance.entry([from.min(to), from.max(to)]).or_default() += step;
        }
    }
    let side = i64::from(LAST);
    ensure(twice_area == 2 * side * side, || "triangles do not cover the tile once".to_owned())?;
    let sides: [fn([u16; 2]) -> bool; 4] =
        [|[u, _]| u == 0, |[_, v]| v == 0, |[u, _]| u == LAST, |[_, v]| v == LAST];
    for (edge, sum) in balance {
        let is_border = sides.iter().any(|is_on| edge.iter().all(|k| is_on(tile.uv[*k])));
        ensure(sum == 0 || is_border, || format!("edge {edge:?} is open"))?;
    }
    for corner in [[0, 0], [LAST, 0], [0, LAST], [LAST, LAST]] {
        ensure(tile.uv.contains(&corner), || format!("corner {corner:?} is missing"))?;
    }
    for (is_on, list) in sides.iter().zip(&tile.edges) {
        let found: BTreeSet<usize> = (0..tile.uv.len()).filter(|k| is_on(tile.uv[*k])).collect();
        let listed: BTreeSet<usize> = list.iter().copied().collect();
        ensure(found == listed && list.len() == listed.len(), || "a list of an edge".to_owned())?;
    }
    ensure(tile.steps.contains(&0) && (tile.steps.contains(&LAST) || tile.step_m() == 0.0), || {
        "heights do not use their range".to_owned()
    })
}

fn distance_m(one: [f64; 3], other: [f64; 3]) -> f64 {
    (0..3).map(|axis| (one[axis] - other[axis]).powi(2)).sum::<f64>().sqrt()
}

/// The sphere contains all vertices; the centre is close; the horizon point is visible whenever a
/// vertex is.
pub(crate) fn check_header(tile: &Tile) -> Check {
    let (middle, radius_m) = tile.sphere_m;
    for vertex in 0..tile.uv.len() {
        let off = distance_m(tile.at_m(vertex), middle) - radius_m;
        ensure(off < 1e-3, || format!("vertex {vertex} is {off} m outside of the sphere"))?;
    }
    ensure(distance_m(tile.center_m, middle) <= radius_m, || "the centre".to_owned())?;
    if tile.horizon[0].is_nan() {
        return Ok(());
    }
    // Eyes all around, in radii of the ellipsoid: if the point is hidden, all vertices must be
    // hidden.
    let radii = [6_378_137.0, 6_378_137.0, 6_356_752.314_245_179];
    let hides = |eye: [f64; 3], at: [f64; 3]| {
        // Cozzi & Ring 2011, 3D Engine Design for Virtual Globes, section 12.5: behind the horizon
        // plane and inside the horizon cone.
        let to: [f64; 3] = std::array::from_fn(|k| at[k] - eye[k]);
        let over = eye.iter().map(|axis| axis * axis).sum::<f64>() - 1.0;
        let along: f64 = -(0..3).map(|k| to[k] * eye[k]).sum::<f64>();
        along > over && along * along / to.iter().map(|axis| axis * axis).sum::<f64>() > over
    };
    let mut random = Random::new(7);
    let mut hidden = 0;
    for _ in 0..200 {
        let eye = geocentric([
            random.share() * 360.0 - 180.0,
            random.share() * 180.0 - 90.0,
            10.0_f64.powf(3.0 + 4.5 * random.share()),
        ]);
        let eye: [f64; 3] = std::array::from_fn(|k| eye[k] / radii[k]);
        if hides(eye, tile.horizon) {
            hidden += 1;
            for vertex in 0..tile.uv.len() {
                let place = tile.place(vertex);
                // Below the ellipsoid the test has no meaning.
                let at = geocentric([place[0], place[1], place[2].max(0.0)]);
                // Slightly above the ground, for rounding.
                let at: [f64; 3] = std::array::from_fn(|k| at[k] / radii[k] * (1.0 - 1e-9));
                ensure(hides(eye, at), || format!("vertex {vertex} is seen from {eye:?}"))?;
            }
        }
    }
    let is_small = tile.bounds_deg[2] - tile.bounds_deg[0] < 20.0;
    ensure(!is_small || hidden > 0, || "nothing ever hides it".to_owned())
}

/// Normals of vertices point upwards. [`normals_against_the_vertical`] checks whether they match
/// the ground.
pub(crate) fn check_normals(tile: &Tile) -> Check {
    ensure(tile.normals.len() == tile.uv.len(), || "normals are missing".to_owned())?;
    for (vertex, normal) in tile.normals.iter().enumerate() {
        let vertical = tile.up(vertex);
        let up: f64 = (0..3).map(|k| vertical[k] * normal[k]).sum();
        ensure(up > 0.05, || format!("normal of vertex {vertex} points {up} upwards"))?;
    }
    Ok(())
}

/// The ratio of two differences from the normals of adjacent triangles, weighted by area, over the
/// finest level: that of the normals, and that of the vertical. 0 means equal normals, 1 that they
/// are no better than the vertical.
pub(crate) fn normals_against_the_vertical(terrain: &Terrain) -> f64 {
    let dot = |one: [f64; 3], other: [f64; 3]| (0..3).map(|k| one[k] * other[k]).sum::<f64>();
    let [mut of_normals, mut of_vertical] = [0.0; 2];
    for (_, tile) in terrain.tiles.iter().filter(|(name, _)| name[0] + 1 == terrain.levels()) {
        let mut around = vec![[0.0; 3]; tile.uv.len()];
        for corners in &tile.triangles {
            let [a, b, c] = corners.map(|k| tile.at_m(k));
            let [p, q]: [[f64; 3]; 2] = [b, c].map(|to| std::array::from_fn(|k| to[k] - a[k]));
            let area =
                [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
            for k in *corners {
                around[k] = std::array::from_fn(|axis| around[k][axis] + area[axis]);
            }
        }
        for (vertex, around) in around.iter().enumerate() {
            let length = dot(*around, *around).sqrt();
            of_normals += 1.0 - dot(*around, tile.normals[vertex]) / length;
            of_vertical += 1.0 - dot(*around, tile.up(vertex)) / length;
        }
    }
    of_normals / of_vertical
}

/// Both sides of a border have the same vertices, and their heights differ by rounding only.
pub(crate) fn check_borders(terrain: &Terrain) -> Check {
    let mut borders = 0;
    for ([level, x, y], tile) in &terrain.tiles {
        // East and north neighbours, their facing side, and the axis along the border. The eastern
        // neighbour of the last column is the first.
        let columns = roots(terrain) << level;
        for (beside, own, facing, axis) in
            [([*level, (x + 1) % columns, *y], 2, 0, 1), ([*level, *x, y + 1], 3, 1, 0)]
        {
            let Some(other) = terrain.tiles.get(&beside) else { continue };
            let along = |tile: &Tile, side: usize| {
                let mut found: Vec<(u16, f64, [f64; 3])> = tile.edges[side]
                    .iter()
                    .map(|k| (tile.uv[*k][axis], tile.place(*k)[2], tile.normals[*k]))
                    .collect();
                found.sort_by_key(|(at, ..)| *at);
                found
            };
            let (one, two) = (along(tile, own), along(other, facing));
            let rounding_m = 0.51 * (tile.step_m() + other.step_m()) + 1e-6;
            let name = || format!("{level}/{x}/{y} and {beside:?}");
            ensure(one.len() == two.len(), || format!("{}: other vertices", name()))?;
            for ((at, height, normal), (other_at, other_height, other)) in one.iter().zip(&two) {
                ensure(normal.map(f64::to_bits) == other.map(f64::to_bits), || {
                    format!("{}: other normals at {at}", name())
                })?;
                let off_m = (height - other_height).abs();
                ensure(at == other_at && off_m <= rounding_m, || {
                    format!("{}: {at} and {other_at}, {off_m} m apart", name())
                })?;
            }
            borders += 1;
        }
    }
    ensure(borders > 5, || format!("only {borders} borders"))
}

/// The difference between the tiles of a level and the package's finest ground.
#[derive(Debug, Default)]
pub(crate) struct Deviation {
    /// Vertices with ground.
    pub(crate) vertices: u64,
    /// The largest difference at a vertex, without the rounding of heights.
    pub(crate) vertex_m: f64,
    /// Points inside triangles with ground, without vertices.
    pub(crate) places: u64,
    pub(crate) place_m: f64,
    /// The position of the largest difference, in working metres.
    pub(crate) place: [f64; 3],
    /// The largest difference on the borders of tiles.
    pub(crate) border_m: f64,
}

impl Deviation {
    /// Vertices are the ground's own places; between them nothing is further away than a viewer
    /// assumes, nor, inside of tiles, much further than told: told is the largest at places that
    /// follow the ground to a tenth of what a viewer assumes, as far as their own deviations say,
    /// so a place between them may be a fifth of it further. (The largest that was seen is 0.16, on
    /// Portland with a bound of 0.45 m.)
    pub(crate) fn check(&self, told: &Value) -> Check {
        let number = |name: &str| told[name].as_f64().unwrap();
        let assumed_m = number("assumed_error_m");
        ensure(self.vertex_m < 0.01, || format!("a vertex is {} m off", self.vertex_m))?;
        let between_m = self.place_m.max(self.border_m);
        ensure(between_m <= assumed_m, || format!("{between_m} of {assumed_m} m"))?;
        let told_m = number("deviation_m");
        let slack_m = 0.2 * assumed_m;
        ensure(self.place_m <= told_m + slack_m, || format!("{}, told {told_m}", self.place_m))
    }
}

/// All of the package's finest ground.
struct Finest {
    tiles: Vec<Ground>,
    /// Its cells, metres.
    cell_m: [f64; 2],
}

impl Finest {
    fn read(package: &Path) -> Self {
        let levels = manifest(package)["levels"].as_array().unwrap().clone();
        let level = levels.len() - 1;
        let cell_m = [0, 1].map(|axis| levels[level]["cell_m"][axis].as_f64().unwrap());
        let side = 1 << level;
        let names = (0..side).flat_map(|x| (0..side).map(move |y| format!("{level}/{x}/{y}")));
        let there = |name: &String| e2e::corniche(["tile", e2e::text(package), name]).code == 0;
        let tiles = names.filter(there).map(|name| Ground::read(package, &name)).collect();
        Self { tiles, cell_m }
    }

    /// Whether there is ground within a cell on all sides: closer to the edge of the ground, tiles
    /// make no promise.
    fn is_far_from_its_end(&self, [x, y]: [f64; 2]) -> bool {
        let [east, north] = self.cell_m;
        (-1..=1).all(|i: i32| {
            (-1..=1).all(|j: i32| {
                self.height([x + east * f64::from(i), y + north * f64::from(j)]).is_some()
            })
        })
    }

    fn height(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let holds = |tile: &&Ground| {
            let [west, south, east, north] = tile.bounds;
            (west..=east).contains(&x) && (south..=north).contains(&y)
        };
        self.tiles.iter().filter(holds).find_map(|tile| tile.height([x, y]))
    }
}

/// West, south, east and north of a package's data, in degrees.
fn wgs84_bounds(package: &Path) -> [f64; 4] {
    let manifest = manifest(package);
    ["min_x", "min_y", "max_x", "max_y"]
        .map(|side| manifest["wgs84_bounds"][side].as_f64().unwrap())
}

/// Compares vertices, and random points inside triangles and on borders, with the ground.
pub(crate) fn check_heights(terrain: &Terrain, package: &Path, region: &Region) -> Vec<Deviation> {
    const INSIDE: usize = 1500;
    const ON_BORDERS: usize = 400;
    let (finest, from_earth) = (Finest::read(package), FromEarth::to(region));
    let data_deg = wgs84_bounds(package);
    let (mut random, mut random_on_borders) = (Random::new(3), Random::new(5));
    let mut levels: Vec<Deviation> = (0..terrain.levels()).map(|_| Deviation::default()).collect();
    for ([level, ..], tile) in &terrain.tiles {
        let found = &mut levels[*level as usize];
        let vertices: Vec<_> = (0..tile.uv.len()).map(|k| tile.at_m(k)).collect();
        for [x, y, z] in from_earth.carry_within(&vertices, data_deg) {
            if let Some(height) = finest.height([x, y]) {
                found.vertices += 1;
                found.vertex_m = found.vertex_m.max((height - z).abs() - 0.5 * tile.step_m());
            }
        }
        let inside: Vec<_> = (0..INSIDE)
            .map(|_| {
                let corners =
                    tile.triangles[(random.share() * tile.triangles.len() as f64) as usize];
                let [a, b, c] = corners.map(|k| tile.at_m(k));
                let (mut s, mut t) = (random.share(), random.share());
                if s + t > 1.0 {
                    (s, t) = (1.0 - s, 1.0 - t);
                }
                std::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]))
            })
            .collect();
        let on_borders: Vec<_> = (0..ON_BORDERS)
            .map(|k| {
                let mut border = tile.edges[k % 4].clone();
                border.sort_unstable_by_key(|&vertex| tile.uv[vertex]);
                let mut share = || random_on_borders.share();
                let at = (share() * (border.len() - 1) as f64) as usize;
                let ([a, b], s) = ([border[at], border[at + 1]].map(|k| tile.at_m(k)), share());
                std::array::from_fn(|k| a[k] + s * (b[k] - a[k]))
            })
            .collect();
        for [x, y, z] in from_earth.carry_within(&inside, data_deg) {
            if let Some(height) = finest.height([x, y]) {
                found.places += 1;
                if (height - z).abs() > found.place_m && finest.is_far_from_its_end([x, y]) {
                    found.place_m = (height - z).abs();
                    found.place = [x, y, height];
                }
            }
        }
        for [x, y, z] in from_earth.carry_within(&on_borders, data_deg) {
            if let Some(height) =
                finest.height([x, y]).filter(|_| finest.is_far_from_its_end([x, y]))
            {
                found.border_m = found.border_m.max((height - z).abs());
            }
        }
    }
    levels
}
