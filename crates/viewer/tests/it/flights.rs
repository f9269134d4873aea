//! Checks what flights report about the GPU: the bytes of a tile and the times of the passes.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use std::time::Instant;

use crate::support::{
    country::{Country, height_m},
    gpu,
};
use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    gpu::{DrawTile, PassTimer, Renderer, Targets, TileBuffers, tile_bytes},
    tiles::TileSource,
};
use glam::DVec3;

/// The memory budget relies on the number of bytes computed before a tile is uploaded.
#[test]
fn a_tile_takes_as_many_bytes_as_told_before() {
    let Some(gpu) = gpu() else { return };
    let country = Country::new();
    for id in [TileId::ROOT, TileId::new(2, 1, 2).unwrap(), TileId::new(4, 8, 8).unwrap()] {
        let tile = country.load(id).unwrap();
        assert!(
            !tile.roads.segments.all().is_empty() && !tile.roads.volumes.all().is_empty(),
            "{id} has roads"
        );
        assert_eq!(tile_bytes(&tile), TileBuffers::new(&gpu, &tile, None).gpu_bytes(), "{id}");
    }
}

#[test]
fn passes_take_some_time_and_no_more_than_the_frame() {
    let Some(gpu) = gpu() else { return };
    let Some(mut timer) = PassTimer::new(&gpu) else {
        corniche_testing::skip("the adapter has no clock");
        return;
    };
    let country = Country::new();
    let buffers = TileBuffers::new(&gpu, &country.load(TileId::ROOT).unwrap(), None);
    let tiles = [DrawTile { buffers: &buffers, skirt_depth_m: 0.0 }];
    let [x, y] = country.frame.tile_bounds(TileId::ROOT).center();
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 30.0 };
    let target = DVec3::new(x, y, height_m(x, y));
    let camera = Camera::look_at(target, 40_000.0, orientation, [640, 480]);
    let targets = Targets::new(&gpu, camera.size_px, 1).unwrap();
    let style = Style::road_atlas();
    let renderer = Renderer::new(&gpu);
    let mut frame = |method| {
        let view = FrameView {
            camera: &camera,
            style: &style,
            layers: PackageLooks::NONE,
            roads: RoadOptions::for_method(method),
            exaggeration: 1.0,
            point_scale: 1.0,
            height_range_m: [90.0, 1910.0],
            wall_m: 0.0,
            cell_px: f64::INFINITY,
            latitude_deg: 47.0,
            is_wireframe: false,
        };
        let started = Instant::now();
        renderer.draw_timed(&gpu, &view, &tiles, &targets, Some(&mut timer));
        gpu.finish().unwrap();
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let passes = timer.read(&gpu).unwrap();
        println!("{method:?}: {passes:?} of {frame_ms:.2} ms");
        let sum_ms = passes.total_ms();
        assert!(sum_ms <= frame_ms, "{passes:?} in {frame_ms} ms");
        assert!(passes.terrain_ms > 0.0 && passes.composite_ms > 0.0, "{passes:?}");
        assert!(
            passes.areas_ms.abs() < f64::EPSILON,
            "without areas there is no time for areas: {passes:?}"
        );
        passes
    };
    // The timer can be used for many frames; the smallest of several times is least disturbed by
    // other programs.
    let least_ms = |method| (0..5).map(|_| frame(method).roads_ms).fold(f64::INFINITY, f64::min);
    let [bare_ms, volumes_ms] = [RoadMethod::None, RoadMethod::ShadowVolumes].map(least_ms);
    assert!(bare_ms < volumes_ms, "roads take time: {volumes_ms} ms, without {bare_ms} ms");
}
