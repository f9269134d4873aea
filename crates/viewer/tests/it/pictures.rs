//! Operations on whole pictures: averaged samples, differences, wireframes, and the times of
//! passes.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use std::time::{Duration, Instant};

use crate::support::{class, frame, gpu, ground_line, lay, plain_style, terrain, triangles};
use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    for_tests::PlanLine,
    gpu::{
        DIFFERENCE_COLORS, DrawTile, Gpu, GpuError, PassTimer, Picture, Renderer, Targets,
        TileBuffers,
    },
    tiles::{RoadKind, TileGeometry, TileLines},
};
use glam::DVec2;

const SIZE: [u32; 2] = [200, 150];

fn center() -> DVec2 {
    DVec2::from_array(frame().tile_bounds(TileId::ROOT).center())
}

/// Hills with one road of class 2 between two points, relative to the middle.
fn geometry(from: [f64; 2], to: [f64; 2]) -> TileGeometry {
    let ground =
        terrain(TileId::ROOT, 16, |x, y| 300.0 + 50.0 * (x / 200.0).sin() * (y / 150.0).cos());
    let [from, to] = [from, to].map(|at| center() + DVec2::from_array(at));
    let points_m = lay(from, to, &triangles(TileId::ROOT, &ground));
    let line = ground_line(2, points_m);
    let plan = PlanLine {
        dashes: None,
        way_id: 1,
        kind: RoadKind::plain(class(2)),
        points_m: vec![from.to_array(), to.to_array()],
        ground_range_m: vec![ground.height_range_m],
    };
    let lines = TileLines {
        ground: vec![line],
        plan: vec![plan],
        width_margin_m: 100.0,
        ..TileLines::default()
    };
    TileGeometry::assemble(TileId::ROOT, Some(&ground), &lines, &frame(), crate::support::QUANTUM_M)
}

fn camera() -> Camera {
    let orientation = Orientation { heading_deg: 20.0, pitch_deg: 50.0 };
    Camera::look_at(center().extend(300.0), 1800.0, orientation, SIZE)
}

fn view<'a>(camera: &'a Camera, style: &'a Style) -> FrameView<'a> {
    FrameView {
        camera,
        style,
        layers: PackageLooks::NONE,
        roads: RoadOptions::for_method(RoadMethod::Geometry),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [200.0, 400.0],
        wall_m: 0.0,
        cell_px: f64::INFINITY,
        latitude_deg: 47.0,
        is_wireframe: false,
    }
}

fn draw(gpu: &Gpu, tile: &TileGeometry, view: &FrameView<'_>, samples_per_side: u32) -> Targets {
    let buffers = TileBuffers::new(gpu, tile, None);
    let targets = Targets::new(gpu, view.camera.size_px, samples_per_side).unwrap();
    let tiles = [DrawTile { buffers: &buffers, skirt_depth_m: 0.0 }];
    Renderer::new(gpu).draw(gpu, view, &tiles, &targets);
    targets
}

/// The mean of each square of samples, rounded to the nearest step.
fn average(samples: &[u8], [width, height]: [usize; 2], per_side: usize) -> Vec<u8> {
    let mut means = Vec::new();
    for y in 0..height {
        for x in 0..width {
            for channel in 0..4 {
                let sum: usize = (0..per_side * per_side)
                    .map(|k| (y * per_side + k / per_side, x * per_side + k % per_side))
                    .map(|(row, column)| (row * width * per_side + column) * 4 + channel)
                    .map(|index| usize::from(samples[index]))
                    .sum();
                means.push(((sum + per_side * per_side / 2) / (per_side * per_side)) as u8);
            }
        }
    }
    means
}

#[test]
fn a_picture_of_several_samples_is_the_mean_of_a_larger_one() {
    let Some(gpu) = gpu() else { return };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    // The lines on the plane of voids keep their distance in pixels; on black they are not visible.
    let style = Style { outline_px: 0, void: [0.0; 3], ..plain_style(30.0) };
    let camera = camera();
    for samples_per_side in 1..=4 {
        let averaged = draw(&gpu, &tile, &view(&camera, &style), samples_per_side);
        let large = camera.supersampled(samples_per_side);
        let samples = draw(&gpu, &tile, &view(&large, &style), 1).picture.read(&gpu).unwrap();
        let expected = average(&samples, SIZE.map(|side| side as usize), samples_per_side as usize);
        assert_eq!(averaged.picture.size_px, SIZE);
        assert_eq!(expected.len(), (SIZE[0] * SIZE[1] * 4) as usize);
        let found = averaged.picture.read(&gpu).unwrap();
        let differing = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "of {} with {samples_per_side}", expected.len());
    }
}

#[test]
fn edges_are_as_wide_with_several_samples_as_with_one() {
    let Some(gpu) = gpu() else { return };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    let style = Style { outline_px: 2, ..plain_style(60.0) };
    let camera = camera();
    let dark = |samples_per_side| {
        let targets = draw(&gpu, &tile, &view(&camera, &style), samples_per_side);
        let pixels = targets.picture.read(&gpu).unwrap();
        pixels.chunks_exact(4).map(|p| 255.0 - f64::from(p[0])).sum::<f64>() / 255.0
    };
    let [one, three] = [dark(1), dark(3)];
    assert!((one - three).abs() < 0.03 * one, "{one} pixels of darkness, with samples {three}");
}

#[test]
fn impossible_pictures_are_refused() {
    let Some(gpu) = gpu() else { return };
    let side_px = gpu.max_side_px();
    assert!(Picture::new(&gpu, [side_px, 1], 1).is_ok());
    assert!(matches!(Picture::new(&gpu, [side_px, 1], 2), Err(GpuError::TooLarge { .. })));
    assert!(matches!(Picture::new(&gpu, [0, 1], 1), Err(GpuError::Empty { .. })));
    assert!(matches!(Picture::new(&gpu, [1, 1], 0), Err(GpuError::Samples { .. })));
    assert!(matches!(Picture::new(&gpu, [1, 1], 5), Err(GpuError::Samples { .. })));
}

#[test]
fn a_difference_shows_whose_road_is_where() {
    let Some(gpu) = gpu() else { return };
    let (camera, style) = (camera(), plain_style(40.0));
    let view = view(&camera, &style);
    let first = draw(&gpu, &geometry([-500.0, -300.0], [600.0, 400.0]), &view, 1);
    let second = draw(&gpu, &geometry([-500.0, 300.0], [600.0, -400.0]), &view, 1);
    let difference = Picture::new(&gpu, SIZE, 1).unwrap();
    Renderer::new(&gpu).draw_difference(&gpu, &first, &second, &difference).unwrap();
    let [a, b] = [&first, &second].map(|targets| targets.read_labels(&gpu).unwrap());
    let pixels = difference.read(&gpu).unwrap();
    let bytes = |rgb: [f32; 3]| rgb.map(|channel| (channel * 255.0).round() as u8);
    let mut counts = [0; 3];
    for (index, pixel) in pixels.chunks_exact(4).enumerate() {
        let rgb = [pixel[0], pixel[1], pixel[2]];
        let (which, is_right) = match (a[index], b[index]) {
            (a, b) if a == b => (0, rgb[0] == rgb[1] && rgb[1] == rgb[2] && rgb[0] > 150),
            (_, 0) => (1, rgb == bytes(DIFFERENCE_COLORS.first_only)),
            _ => (2, rgb == bytes(DIFFERENCE_COLORS.second_only)),
        };
        assert!(is_right, "{rgb:?} for labels {} and {}", a[index], b[index]);
        counts[which] += 1;
    }
    assert!(counts[0] > 10_000 && counts[1] > 300 && counts[2] > 300, "{counts:?}");
}

#[test]
fn a_difference_needs_pictures_of_one_size() {
    let Some(gpu) = gpu() else { return };
    let targets = Targets::new(&gpu, [40, 30], 2).unwrap();
    let renderer = Renderer::new(&gpu);
    // The number of samples is equal, but the number of pixels is not.
    for (size_px, samples) in [([41, 30], 2), ([80, 60], 1)] {
        let into = Picture::new(&gpu, size_px, samples).unwrap();
        let refused = renderer.draw_difference(&gpu, &targets, &targets, &into);
        assert!(matches!(refused, Err(GpuError::SizesDiffer { .. })));
    }
}

#[test]
fn a_wireframe_darkens_the_ground_and_leaves_all_else() {
    let Some(gpu) = gpu() else { return };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    let (camera, style) = (camera(), plain_style(40.0));
    let bare = draw(&gpu, &tile, &view(&camera, &style), 1);
    let wired_view = FrameView { is_wireframe: true, ..view(&camera, &style) };
    let wired = draw(&gpu, &tile, &wired_view, 1);
    assert_eq!(bare.read_owners(&gpu).unwrap(), wired.read_owners(&gpu).unwrap());
    assert_eq!(bare.read_labels(&gpu).unwrap(), wired.read_labels(&gpu).unwrap());
    assert!(bare.read_depth(&gpu).unwrap() == wired.read_depth(&gpu).unwrap());
    let [bare, wired] = [bare, wired].map(|targets| targets.read_ground(&gpu).unwrap());
    let pairs = || bare.chunks_exact(4).zip(wired.chunks_exact(4));
    assert!(pairs().all(|(a, b)| a[3] == b[3]), "ground stays ground");
    // Outside the ground a line may extend into the sky, which this picture does not contain.
    let ground = || pairs().filter(|(a, _)| a[3] == 255);
    let darker = ground().filter(|(a, b)| b[0] < a[0]).count();
    let other = ground().filter(|(a, b)| a != b && b[0] >= a[0]).count();
    // Cells of 160 m with three edges each: half of the pixels of this view are not on any edge.
    assert!(darker > 3000 && darker < 20_000, "{darker} pixels of edges");
    assert_eq!(other, 0);
}

#[test]
fn times_of_frames_come_without_waiting() {
    let Some(gpu) = gpu() else { return };
    let Some(mut timer) = PassTimer::new(&gpu) else {
        corniche_testing::skip("the adapter has no clock");
        return;
    };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    let buffers = TileBuffers::new(&gpu, &tile, None);
    let tiles = [DrawTile { buffers: &buffers, skirt_depth_m: 0.0 }];
    let targets = Targets::new(&gpu, SIZE, 2).unwrap();
    let (camera, style) = (camera(), plain_style(40.0));
    let renderer = Renderer::new(&gpu);
    assert_eq!(timer.poll(&gpu).unwrap(), None, "nothing was drawn");
    // More frames at once than the timer can record: some are not timed, and none fails.
    for _ in 0..12 {
        renderer.draw_timed(&gpu, &view(&camera, &style), &tiles, &targets, Some(&mut timer));
    }
    let started = Instant::now();
    let mut times = None;
    while times.is_none() && started.elapsed() < Duration::from_secs(20) {
        times = timer.poll(&gpu).unwrap();
    }
    let times = times.expect("times within 20 s");
    assert!(times.terrain_ms > 0.0 && times.composite_ms > 0.0, "{times:?}");
    gpu.finish().unwrap();
    timer.poll(&gpu).unwrap();
    assert_eq!(timer.poll(&gpu).unwrap(), None, "a frame is reported once");
    // All buffers are free again.
    renderer.draw_timed(&gpu, &view(&camera, &style), &tiles, &targets, Some(&mut timer));
    assert!(timer.read(&gpu).is_ok());
}

#[test]
fn classes_left_out_are_not_drawn() {
    let Some(gpu) = gpu() else { return };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    let (camera, style) = (camera(), plain_style(40.0));
    for method in [RoadMethod::Geometry, RoadMethod::ShadowVolumes] {
        let labels = |left_out: u8| {
            let all = RoadOptions::for_method(method);
            let roads = RoadOptions { classes: all.classes.without(class(left_out)), ..all };
            let view = FrameView { roads, ..view(&camera, &style) };
            draw(&gpu, &tile, &view, 1).read_labels(&gpu).unwrap()
        };
        assert!(labels(3).iter().any(|label| *label != 0), "{method:?}: the road is of class 2");
        assert!(labels(2).iter().all(|label| *label == 0), "{method:?}");
    }
}

#[test]
fn opengl_draws_the_same_picture() {
    let Some(gpu) = gpu() else { return };
    let Ok(opengl) = Gpu::with_backends(wgpu::Backends::GL) else {
        corniche_testing::skip("no OpenGL");
        return;
    };
    let tile = geometry([-500.0, -300.0], [600.0, 400.0]);
    let style = Style { outline_px: 1, ..plain_style(40.0) };
    let camera = camera();
    for method in [RoadMethod::Geometry, RoadMethod::ShadowVolumes] {
        let view = FrameView { roads: RoadOptions::for_method(method), ..view(&camera, &style) };
        let [a, b] =
            [&gpu, &opengl].map(|gpu| draw(gpu, &tile, &view, 2).picture.read(gpu).unwrap());
        let differing = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert_eq!(a.len(), (SIZE[0] * SIZE[1] * 4) as usize);
        assert!(differing < a.len() / 1000, "{method:?}: {differing} of {}", a.len());
    }
}

#[test]
fn a_mistake_is_told_and_does_not_end_the_process() {
    let Some(gpu) = gpu() else { return };
    assert_eq!(gpu.take_fault(), None);
    // Larger than any device allows.
    let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 1 << 60,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
    assert!(gpu.take_fault().is_some());
    assert_eq!(gpu.take_fault(), None, "reported once");
    assert!(!gpu.is_lost());
    gpu.device.destroy();
    let _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    assert!(gpu.is_lost());
    assert!(Targets::new(&gpu, [8, 8], 1).unwrap().picture.read(&gpu).is_err());
}
