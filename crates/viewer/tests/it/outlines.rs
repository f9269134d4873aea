//! Compares the edges of roads that the composite draws with a plain filter over labels and depths
//! on the CPU.
//!
//! Edges are the differences between two pictures, one of which was drawn without edges: no other
//! feature has their colour.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use crate::support::{frame, gpu, ground_line, lay, plain_style, terrain, triangles};
use corniche_geom::TileId;
use corniche_styles::{RoadStyle, Style};
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions, RoadOutline,
    camera::{Camera, Orientation},
    for_tests::{class_of, is_service, is_tunnel},
    gpu::{DrawTile, Gpu, Renderer, Targets, TileBuffers},
    tiles::{TileGeometry, TileLines},
};
use glam::DVec2;

/// Same as in `shaders/composite.wgsl`.
const FARTHER: f32 = 1.1;

fn center() -> DVec2 {
    DVec2::from_array(frame().tile_bounds(TileId::ROOT).center())
}

/// Edges in a colour that neither ground nor roads have, and no haze to hide them.
fn style(width_m: f32) -> Style {
    let plain = plain_style(width_m);
    let roads = plain.roads.map(|road| RoadStyle { outline: [1.0, 0.0, 1.0], ..road });
    Style { roads, haze_reach: 1e6, ..plain }
}

/// Returns the root tile with this ground and with roads given by class and ends in plan.
fn tile(step: u16, height_m: impl Fn(f64, f64) -> f64, roads: &[(u8, [DVec2; 2])]) -> TileGeometry {
    let ground = terrain(TileId::ROOT, step, height_m);
    let mesh = triangles(TileId::ROOT, &ground);
    let lines =
        roads.iter().map(|(number, [from, to])| ground_line(*number, lay(*from, *to, &mesh)));
    let lines = TileLines {
        ground: lines.collect(),
        width_margin_m: crate::support::WIDTH_MARGIN_M,
        ..TileLines::default()
    };
    TileGeometry::assemble(TileId::ROOT, Some(&ground), &lines, &frame(), crate::support::QUANTUM_M)
}

/// The resources for drawing edges.
struct Edges<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    camera: &'a Camera,
    style: Style,
    targets: Targets,
}

impl<'a> Edges<'a> {
    fn new(gpu: &'a Gpu, camera: &'a Camera, style: Style, samples_per_side: u32) -> Self {
        let targets = Targets::new(gpu, camera.size_px, samples_per_side).unwrap();
        Self { gpu, renderer: Renderer::new(gpu), camera, style, targets }
    }

    fn picture(&self, tile: &TileGeometry, outline: RoadOutline) -> Vec<u8> {
        let buffers = TileBuffers::new(self.gpu, tile, None);
        let view = FrameView {
            camera: self.camera,
            style: &self.style,
            layers: PackageLooks::NONE,
            roads: RoadOptions { outline, ..RoadOptions::for_method(RoadMethod::Geometry) },
            exaggeration: 1.0,
            point_scale: 1.0,
            height_range_m: [0.0, 1000.0],
            wall_m: 0.0,
            cell_px: f64::INFINITY,
            latitude_deg: 47.0,
            is_wireframe: false,
        };
        let tiles = [DrawTile { buffers: &buffers, skirt_depth_m: 0.0 }];
        self.renderer.draw(self.gpu, &view, &tiles, &self.targets);
        self.targets.picture.read(self.gpu).unwrap()
    }

    /// Checks that edges are drawn in exactly the pixels where the plain filter finds them; returns
    /// their number.
    fn check(&self, tile: &TileGeometry, what: &str) -> usize {
        let bare = self.picture(tile, RoadOutline::None);
        let labels = self.targets.read_labels(self.gpu).unwrap();
        let depth = self.targets.read_depth(self.gpu).unwrap();
        let [width, height] = self.targets.picture.size_px.map(|side| side as usize);
        let samples = self.targets.picture.samples_per_side as usize;
        let mut total = 0;
        for (outline, radius_px) in [(RoadOutline::Kernel3, 1), (RoadOutline::Kernel5, 2)] {
            let drawn = self.picture(tile, outline);
            let is_edge =
                plain_filter(&labels, &depth, width * samples, (radius_px * samples) as i64);
            let mut expected = vec![false; width * height];
            for (index, _) in is_edge.iter().enumerate().filter(|(_, is_edge)| **is_edge) {
                let (x, y) = (index % (width * samples), index / (width * samples));
                expected[y / samples * width + x / samples] = true;
            }
            let pairs = drawn.chunks_exact(4).zip(bare.chunks_exact(4));
            for (index, (is_drawn, is_expected)) in
                pairs.map(|(a, b)| a != b).zip(&expected).enumerate()
            {
                let (x, y) = (index % width, index / width);
                assert_eq!(is_drawn, *is_expected, "{what}, {outline:?}: pixel {x}, {y}");
            }
            total += expected.iter().filter(|is_edge| **is_edge).count();
        }
        total
    }
}

/// Whether a sample without a road, or in a tunnel, is on the edge of a more important road: the
/// plain filter checks every sample, without optimization.
fn plain_filter(labels: &[u8], depth: &[f32], width: usize, radius: i64) -> Vec<bool> {
    let height = labels.len() / width;
    let around = |at: usize, end: usize| {
        let clamp = |k: i64| k.clamp(0, end as i64 - 1) as usize;
        clamp(at as i64 - radius)..=clamp(at as i64 + radius)
    };
    (0..labels.len())
        .map(|index| {
            let (x, y) = (index % width, index / width);
            let near =
                || around(y, height).flat_map(|row| around(x, width).map(move |k| row * width + k));
            let most = near()
                .filter(|k| depth[*k] >= depth[index] / FARTHER)
                .map(|k| labels[k])
                .max()
                .unwrap_or(0);
            // Roads that meet have no edge between them.
            let own = labels[index];
            let is_free = own == 0 || is_tunnel(own);
            depth[index] > 0.0 && is_free && importance(most) > importance(own)
        })
        .collect()
}

/// Roads above the ground are more important than roads below it, service roads are the least
/// important of them; all bands of a class are equally important.
fn importance(label: u8) -> u8 {
    let class = class_of(label).map_or(0, |class| 9 - class);
    match label {
        0 => class,
        _ if is_tunnel(label) => class,
        _ if is_service(label) => class + 10,
        _ => class + 20,
    }
}

/// Distance between dots, so large that only the edge of the dot itself can be drawn at its
/// position: more than three of the blocks in which the composite looks for roads. One more pixel,
/// so that dots are at different positions in their blocks.
const DOT_EVERY: u32 = 3 * 16 + 1;

/// The edge of a road as small as a sample is complete at any position in its block and in the
/// picture.
#[test]
fn a_dot_has_its_edge_wherever_it_lies() {
    let Some(gpu) = gpu() else { return };
    for samples in [1, 2] {
        // Not a whole number of blocks.
        let size_px = [203, 149].map(|side| side / samples);
        let orientation = Orientation { heading_deg: 0.0, pitch_deg: 0.0 };
        let camera = Camera::look_at(center().extend(0.0), 1000.0, orientation, size_px);
        let pixel_m = 1000.0 * camera.pixel_at_unit_depth_m();
        let edges = Edges::new(&gpu, &camera, style(1.9 * pixel_m as f32), samples);
        let at_sample = |x: u32, y: u32| {
            let pixel = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(samples);
            (camera.eye_in_world + 1000.0 * camera.ray_in_world(pixel)).truncate()
        };
        let sampled_px = size_px.map(|side| side * samples);
        for shift in 0..16 {
            let dots: Vec<(u8, [DVec2; 2])> = (shift..sampled_px[0])
                .step_by(DOT_EVERY as usize)
                .flat_map(|x| {
                    let down = (5 * shift) % DOT_EVERY;
                    (down..sampled_px[1]).step_by(DOT_EVERY as usize).map(move |y| at_sample(x, y))
                })
                .map(|at| (2, [at, at + DVec2::new(0.001 * pixel_m, 0.0)]))
                .collect();
            let count = edges.check(&tile(256, |_, _| 0.0, &dots), &format!("shift {shift}"));
            assert!(count > 8 * dots.len(), "{count} pixels of edges around {} dots", dots.len());
        }
    }
}

/// Pictures of all sizes: the blocks at the right and at the bottom are cut off anywhere.
#[test]
fn edges_are_where_the_plain_filter_finds_them() {
    let Some(gpu) = gpu() else { return };
    // Ridges, some of which hide roads behind their crests, and crossing roads of several classes.
    let ridges =
        |x: f64, y: f64| 300.0 + 120.0 * ((y - center().y) / 90.0).sin() * (x / 400.0).cos();
    let at = |x: f64, y: f64| center() + DVec2::new(x, y);
    let roads = [
        (0, [at(-900.0, -300.0), at(900.0, 400.0)]),
        (3, [at(-300.0, -700.0), at(200.0, 900.0)]),
        (5, [at(-800.0, 500.0), at(700.0, -200.0)]),
        (5, [at(100.0, -900.0), at(130.0, 900.0)]),
    ];
    let tile = tile(2, ridges, &roads);
    for (size_px, samples) in [
        ([160, 128], 1),
        ([161, 127], 1),
        ([175, 113], 1),
        ([33, 47], 2),
        ([16, 16], 1),
        ([7, 5], 1),
        ([1, 1], 3),
        ([53, 41], 4),
    ] {
        let orientation = Orientation { heading_deg: 25.0, pitch_deg: 70.0 };
        let camera = Camera::look_at(center().extend(300.0), 1500.0, orientation, size_px);
        // Edges fade around roads thinner than four pixels, or thirteen where the ground is seen
        // flat; these are about that wide at the far end of the ground.
        let width_m = 26.0 * 1500.0 * camera.pixel_at_unit_depth_m();
        let edges = Edges::new(&gpu, &camera, style(width_m as f32), samples);
        let count = edges.check(&tile, &format!("{size_px:?} with {samples}"));
        assert!(count > 0 || size_px[0] < 16, "no edge in {size_px:?}");
    }
}

/// The edge of a wide road continues over a street of two pixels, and is open where a wide street
/// meets it.
#[test]
fn edges_are_open_for_wide_streets_alone() {
    let Some(gpu) = gpu() else { return };
    let at = |x: f64, y: f64| center() + DVec2::new(x, y);
    let roads = [(0, [at(0.0, -900.0), at(0.0, 900.0)]), (5, [at(-900.0, 0.0), at(900.0, 0.0)])];
    let tile = tile(256, |_, _| 0.0, &roads);
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 0.0 };
    let camera = Camera::look_at(center().extend(0.0), 1500.0, orientation, [160, 128]);
    let pixel_m = (1500.0 * camera.pixel_at_unit_depth_m()) as f32;
    for (street_px, is_open) in [(1.9, false), (2.1, false), (4.0, true), (14.0, true)] {
        let mut style = style(14.0 * pixel_m);
        style.roads[5].width_m = street_px * pixel_m;
        style.roads[5].carriageway_width_m = street_px * pixel_m;
        let edges = Edges::new(&gpu, &camera, style, 1);
        let bare = edges.picture(&tile, RoadOutline::None);
        let labels = edges.targets.read_labels(&gpu).unwrap();
        let drawn = edges.picture(&tile, RoadOutline::Kernel3);
        let pairs = drawn.chunks_exact(4).zip(bare.chunks_exact(4));
        let over = pairs
            .zip(&labels)
            .filter(|((a, b), label)| a != b && class_of(**label) == Some(5))
            .count();
        assert_eq!(over == 0, is_open, "{street_px} px: {over} pixels of the street");
    }
}
