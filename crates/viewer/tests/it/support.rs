//! Scenes from closed forms, and references that do not use the code under test.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "this is test code, though no test itself"
)]

pub(crate) mod areas;
pub(crate) mod country;
pub(crate) mod network;
pub(crate) mod package;
pub(crate) mod scene;
pub(crate) mod scenes;

use corniche_geom::{Cell, GridFrame, NodeIndex, TILE_CELLS, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::{RoadBand, RoadBands, RoadStyle, Style, WidthScaling};
use corniche_tileset::TileTerrain;
use corniche_tin::{Tin, TinVertex};
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions,
    camera::Camera,
    for_tests::{GroundLine, TileOwner, class_of},
    gpu::{DrawTile, Gpu, Renderer, Targets, TileBuffers},
    tiles::{TileGeometry, TileLines},
};
use glam::{DVec2, DVec3};

pub(crate) const CELL_M: f64 = 10.0;
pub(crate) const QUANTUM_M: f64 = 1.0 / 64.0;
/// Maximum half width of drawn roads, unless a test sets another one.
pub(crate) const WIDTH_MARGIN_M: f64 = 1000.0;

/// A device, or `None` and a message on the terminal; with `CORNICHE_REQUIRE_GPU=1` a missing
/// device is a failure.
pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::new() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{error}");
            corniche_testing::skip("no GPU adapter");
            None
        }
    }
}

/// The cells and the scale of all scenes of a test.
#[derive(Debug, Clone, Copy)]
pub(crate) struct World {
    /// Length of cells northwards divided by eastwards.
    pub(crate) ratio: f64,
    /// Working metres per true metre, east and north.
    pub(crate) scale: [f64; 2],
}

impl World {
    pub(crate) fn cell(self, east_m: f64) -> Cell {
        Cell { east_m, north_m: east_m * self.ratio }.fitted()
    }
}

thread_local! {
    static WORLD: std::cell::Cell<World> =
        const { std::cell::Cell::new(World { ratio: 1.0, scale: [1.0; 2] }) };
}

/// The world of this test: square cells and true metres, unless the test runs `within` another
/// world.
pub(crate) fn world() -> World {
    WORLD.get()
}

/// Calls `make` with `world` as the world of its scenes.
pub(crate) fn within<T>(world: World, make: impl FnOnce() -> T) -> T {
    let before = WORLD.replace(world);
    let made = make();
    WORLD.set(before);
    made
}

/// Two levels of a grid far from the origin, like real grids.
pub(crate) fn frame() -> GridFrame {
    let cell = world().cell(CELL_M);
    GridFrame::new([0.25, 0.75], cell, NodeIndex { i: 51_200, j: 512_000 }, 1).unwrap()
}

pub(crate) fn class(number: u8) -> FunctionalRoadClass {
    FunctionalRoadClass::new(number).unwrap()
}

/// A tile's ground from a height function of x and y in the working CRS, with a vertex every `step`
/// nodes.
pub(crate) fn terrain(id: TileId, step: u16, height_m: impl Fn(f64, f64) -> f64) -> TileTerrain {
    let (frame, window) = (frame(), frame().tile_window(id));
    let count = TILE_CELLS as u16 / step + 1;
    let (mut vertices, mut normals) = (Vec::new(), Vec::new());
    for row in 0..count {
        for column in 0..count {
            let node = window.node(usize::from(column * step), usize::from(row * step));
            let (x, y) = (frame.x_m(node.i), frame.y_m(node.j));
            let height_q = (height_m(x, y) / QUANTUM_M).round() as i32;
            normals.push(octahedron_normal(
                (height_m(x + 1.0, y) - height_m(x - 1.0, y)) / 2.0,
                (height_m(x, y + 1.0) - height_m(x, y - 1.0)) / 2.0,
            ));
            vertices.push(TinVertex { row: row * step, column: column * step, height_q });
        }
    }
    let mut triangles = Vec::new();
    for row in 0..u32::from(count) - 1 {
        for column in 0..u32::from(count) - 1 {
            let nw = row * u32::from(count) + column;
            let (ne, sw) = (nw + 1, nw + u32::from(count));
            triangles.extend([[nw, sw, ne], [ne, sw, sw + 1]]);
        }
    }
    let heights = || vertices.iter().map(|vertex| f64::from(vertex.height_q) * QUANTUM_M);
    let range =
        [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    TileTerrain {
        normals,
        tin: Tin::new(vertices.clone(), &triangles).unwrap(),
        geometric_error_m: 1.0,
        height_range_m: range,
        uncovered_nodes: 0,
    }
}

/// The normal of ground with these slopes in metres per metre, encoded as in packages.
fn octahedron_normal(east: f64, north: f64) -> [i8; 2] {
    let length = east.abs() + north.abs() + 1.0;
    [-east, -north].map(|part| (part / length * 127.0).round() as i8)
}

/// Triangles of a tile's ground in world space, f64.
pub(crate) fn triangles(id: TileId, terrain: &TileTerrain) -> Vec<[DVec3; 3]> {
    let (frame, window) = (frame(), frame().tile_window(id));
    let place = |index: u32| {
        let vertex = terrain.tin.vertices()[index as usize];
        let node = window.node(usize::from(vertex.column), usize::from(vertex.row));
        DVec3::new(frame.x_m(node.i), frame.y_m(node.j), f64::from(vertex.height_q) * QUANTUM_M)
    };
    terrain.tin.triangles().iter().map(|corners| corners.map(place)).collect()
}

/// Drapes the plan segment a–b on triangles: a vertex at each crossing with an edge, heights from
/// the triangles.
pub(crate) fn lay(a: DVec2, b: DVec2, ground: &[[DVec3; 3]]) -> Vec<[f64; 3]> {
    let mut at = vec![0.0, 1.0];
    for corners in ground {
        for k in 0..3 {
            let (p, q) = (corners[k].truncate(), corners[(k + 1) % 3].truncate());
            let (d, e) = (b - a, q - p);
            let cross = d.perp_dot(e);
            let (t, s) = ((p - a).perp_dot(e) / cross, (p - a).perp_dot(d) / cross);
            if cross != 0.0 && (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s) {
                at.push(t);
            }
        }
    }
    at.sort_by(f64::total_cmp);
    at.dedup_by(|x, y| (*x - *y).abs() < 1e-9);
    at.iter()
        .map(|t| a + (b - a) * *t)
        .map(|p| [p.x, p.y, height_at(p, ground).expect("the line lies on the ground")])
        .collect()
}

pub(crate) fn height_at(at: DVec2, ground: &[[DVec3; 3]]) -> Option<f64> {
    ground.iter().find_map(|[a, b, c]| {
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        let weight = |p: &DVec3, q: &DVec3| (p.truncate() - at).perp_dot(q.truncate() - at) / area;
        let (wa, wb, wc) = (weight(b, c), weight(c, a), weight(a, b));
        (wa.min(wb).min(wc) >= -1e-9).then_some(wa * a.z + wb * b.z + wc * c.z)
    })
}

/// A straight road that was draped on the ground.
pub(crate) fn ground_line(number: u8, points_m: Vec<[f64; 3]>) -> GroundLine {
    let plan = |[x, y, _]: [f64; 3]| [x, y];
    let source = [plan(points_m[0]), plan(points_m[points_m.len() - 1])];
    let sources_m = vec![source; points_m.len() - 1];
    GroundLine { sources_m, ..GroundLine::of_source(1, class(number), points_m) }
}

/// Depth at which a ray (of depth 1) first meets a triangle.
///
/// Source: Möller & Trumbore 1997, *Fast, Minimum Storage Ray/Triangle Intersection*.
pub(crate) fn cast(eye: DVec3, ray: DVec3, ground: &[[DVec3; 3]]) -> Option<f64> {
    let mut nearest = None;
    for [a, b, c] in ground {
        let (e1, e2) = (b - a, c - a);
        let p = ray.cross(e2);
        let determinant = e1.dot(p);
        if determinant.abs() < 1e-12 {
            continue;
        }
        let t = eye - a;
        let u = t.dot(p) / determinant;
        let q = t.cross(e1);
        let v = ray.dot(q) / determinant;
        let depth = e2.dot(q) / determinant;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && depth > 0.0 && nearest.is_none_or(|n| depth < n)
        {
            nearest = Some(depth);
        }
    }
    nearest
}

/// Roads with one width for all classes, without growth: `half_width_m` defines everything.
pub(crate) fn plain_style(width_m: f32) -> Style {
    let road = RoadStyle {
        dash: corniche_styles::Dash::SOLID,
        width_m,
        carriageway_width_m: width_m,
        min_width_px: 0.0,
        bands: RoadBands::one([1.0; 3]),
        outline: [0.0; 3],
        max_pixel_m: None,
        max_width_px: None,
        exponent: None,
        edge_max_pixel_m: None,
        thin: None,
        opacity: 1.0,
    };
    Style {
        roads: [road; 9],
        shortest_part_px: 0.0,
        width_scaling: WidthScaling { threshold_m: 1e9, exponent: 0.0, constant: 1.0 },
        ..Style::road_atlas()
    }
}

/// Bands with these shares of a road's width, each in a different shade.
pub(crate) fn bands(shares: &[f32]) -> RoadBands {
    let shade = |k: usize| (k as f32 + 1.0) / (shares.len() as f32 + 1.0);
    let bands = shares.iter().enumerate().map(|(k, width_share)| RoadBand {
        width_share: *width_share,
        color: [shade(k), 1.0 - shade(k), 0.0],
    });
    RoadBands::new(&bands.collect::<Vec<_>>()).unwrap()
}

/// The layers that were read back from the device.
pub(crate) struct Drawing {
    pub(crate) size_px: [u32; 2],
    pub(crate) picture: Vec<u8>,
    pub(crate) ground: Vec<u8>,
    pub(crate) depth: Vec<f32>,
    pub(crate) labels: Vec<u8>,
    /// The labels of decks; `None` if no decks were drawn.
    pub(crate) decks: Option<Vec<u8>>,
    pub(crate) owners: Vec<TileOwner>,
}

impl Drawing {
    pub(crate) fn read(gpu: &Gpu, targets: &Targets) -> Self {
        let drawing = Self {
            size_px: targets.picture.size_px,
            picture: targets.picture.read(gpu).unwrap(),
            ground: targets.read_ground(gpu).unwrap(),
            depth: targets.read_depth(gpu).unwrap(),
            labels: targets.read_labels(gpu).unwrap(),
            decks: targets.read_deck_labels(gpu).unwrap(),
            owners: targets.read_owners(gpu).unwrap(),
        };
        keep(&drawing);
        drawing
    }

    /// Centres of all pixels with their index.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = (usize, DVec2)> + '_ {
        let width = self.size_px[0] as usize;
        (0..self.labels.len()).map(move |index| {
            (index, DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5))
        })
    }

    /// Centres of the pixels with a label of this class.
    pub(crate) fn pixels_of(&self, number: u8) -> Vec<DVec2> {
        self.pixels()
            .filter(|(index, _)| class_of(self.labels[*index]) == Some(number))
            .map(|(_, at)| at)
            .collect()
    }

    /// Whether the depths around a pixel jump: a silhouette or a border of the ground.
    pub(crate) fn is_at_jump(&self, index: usize) -> bool {
        let width = i64::from(self.size_px[0]);
        let (x, y) = (index as i64 % width, index as i64 / width);
        let mut range = [f32::INFINITY, 0.0_f32];
        for dy in -1..=1 {
            for dx in -1..=1 {
                let (nx, ny) = (x + dx, y + dy);
                if (0..width).contains(&nx) && (0..i64::from(self.size_px[1])).contains(&ny) {
                    let depth = self.depth[(ny * width + nx) as usize];
                    range = [range[0].min(depth), range[1].max(depth)];
                }
            }
        }
        range[1] > range[0] * 1.08
    }
}

/// A tile to draw: id, ground, lines on it, depth of its skirt.
pub(crate) type SceneTile = (TileId, TileTerrain, Vec<GroundLine>, f64);

pub(crate) fn draw(gpu: &Gpu, camera: &Camera, style: &Style, scene: &[SceneTile]) -> Drawing {
    draw_exaggerated(gpu, camera, style, scene, 1.0)
}

pub(crate) fn draw_exaggerated(
    gpu: &Gpu,
    camera: &Camera,
    style: &Style,
    scene: &[SceneTile],
    exaggeration: f64,
) -> Drawing {
    let buffers: Vec<(TileBuffers, f64)> = scene
        .iter()
        .map(|(id, terrain, lines, skirt_depth_m)| {
            let lines = TileLines {
                ground: lines.clone(),
                width_margin_m: WIDTH_MARGIN_M,
                ..TileLines::default()
            };
            let tile = TileGeometry::assemble(*id, Some(terrain), &lines, &frame(), QUANTUM_M);
            (TileBuffers::new(gpu, &tile, None), *skirt_depth_m)
        })
        .collect();
    let tiles: Vec<DrawTile<'_>> = buffers
        .iter()
        .map(|(buffers, depth)| DrawTile { buffers, skirt_depth_m: *depth })
        .collect();
    let targets = Targets::new(gpu, camera.size_px, 1).unwrap();
    let view = FrameView {
        camera,
        style,
        layers: PackageLooks::NONE,
        roads: RoadOptions::for_method(RoadMethod::Geometry),
        exaggeration,
        point_scale: 1.0,
        height_range_m: [0.0, 1000.0],
        wall_m: 0.0,
        cell_px: f64::INFINITY,
        latitude_deg: 47.0,
        is_wireframe: false,
    };
    Renderer::new(gpu).draw(gpu, &view, &tiles, &targets);
    Drawing::read(gpu, &targets)
}

/// With `CORNICHE_KEEP_PICTURES=folder`, writes each picture of the tests to that folder.
fn keep(drawing: &Drawing) {
    let Some(folder) = std::env::var_os("CORNICHE_KEEP_PICTURES") else { return };
    let name = std::thread::current().name().unwrap_or("picture").to_owned();
    let [width, height] = drawing.size_px;
    let picture = image::RgbaImage::from_raw(width, height, drawing.picture.clone()).unwrap();
    let next = |k: &u32| std::path::Path::new(&folder).join(format!("{name}-{k}.png"));
    let free = (0..1000).map(|k| next(&k)).find(|path| !path.exists());
    picture.save(free.expect("a free name")).expect("a writable folder");
}

/// Distance in plan from a point to the nearest line.
pub(crate) fn plan_distance_m(at: DVec2, lines: &[GroundLine]) -> f64 {
    let mut nearest = f64::INFINITY;
    for line in lines {
        for pair in line.points_m.windows(2) {
            let (a, b) = (DVec2::new(pair[0][0], pair[0][1]), DVec2::new(pair[1][0], pair[1][1]));
            let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(at.distance(a + (b - a) * along));
        }
    }
    nearest
}
