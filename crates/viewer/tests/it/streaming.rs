//! From heights and roads to a finished picture: triangulated, draped, selected, drawn, without a
//! package.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use crate::support::{
    Drawing,
    country::{CELL_M, Country, MAX_ERROR_M, height_m, interpolation_error_m},
    gpu,
};
use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    for_tests,
    gpu::{DrawTile, Renderer, Targets, TileBuffers},
    lod::Quality,
    tiles::{LoadTileError, TileStore},
};
use glam::{DVec2, DVec3};

const SIZE: [u32; 2] = [640, 480];

fn target(country: &Country) -> DVec3 {
    let [x, y] = country.frame.tile_bounds(TileId::ROOT).center();
    DVec3::new(x, y, height_m(x, y))
}

/// The drawing, the requested screen-space error, and the number of tiles per level.
fn picture(
    country: &Country,
    camera: &Camera,
    error_px: f64,
    style: &Style,
) -> Option<(Drawing, [u32; 5])> {
    let gpu = gpu()?;
    let mut store = TileStore::new(country);
    let quality = Quality::by_error(error_px, 1.0);
    let drawn =
        for_tests::settle(&mut store, camera, quality, || Ok::<_, LoadTileError>(())).unwrap();
    let mut levels = [0; 5];
    for tile in &drawn {
        levels[usize::from(tile.id.z())] += 1;
    }
    let buffers: Vec<_> = for_tests::draw_list(&store, &drawn)
        .map(|(tile, depth)| (TileBuffers::new(&gpu, tile, None), depth))
        .collect();
    let tiles: Vec<_> = buffers
        .iter()
        .map(|(buffers, depth)| DrawTile { buffers, skirt_depth_m: *depth })
        .collect();
    let targets = Targets::new(&gpu, camera.size_px, 1).unwrap();
    let view = FrameView {
        camera,
        style,
        layers: PackageLooks::NONE,
        roads: RoadOptions::for_method(RoadMethod::Geometry),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [90.0, 1910.0],
        wall_m: 0.0,
        cell_px: f64::INFINITY,
        latitude_deg: 47.0,
        is_wireframe: false,
    };
    Renderer::new(&gpu).draw(&gpu, &view, &tiles, &targets);
    Some((Drawing::read(&gpu, &targets), levels))
}

#[test]
fn levels_meet_without_holes_and_within_the_error_asked_for() {
    let country = Country::new();
    // Low above the ground and with a far view: several levels at once.
    for (heading_deg, pitch_deg) in [(10.0, 55.0), (135.0, 60.0)] {
        let camera =
            Camera::look_at(target(&country), 6000.0, Orientation { heading_deg, pitch_deg }, SIZE);
        let error_px = 1.5;
        let Some((drawing, levels)) = picture(&country, &camera, error_px, &Style::road_atlas())
        else {
            return;
        };
        assert!(
            levels.iter().filter(|count| **count > 0).count() > 1,
            "{levels:?} is one level only"
        );
        assert_eq!(drawing.depth.iter().filter(|depth| **depth == 0.0).count(), 0, "holes");
        let finest_m = MAX_ERROR_M + interpolation_error_m(CELL_M);
        let (mut worst_px, mut worst_share): (f64, f64) = (0.0, 0.0);
        for (index, at) in drawing.pixels() {
            let depth_m = camera.near_m / f64::from(drawing.depth[index]);
            let ground = camera.eye_in_world + camera.ray_in_world(at) * depth_m;
            // Skirts are below the ground by design; all other samples are within the error of
            // their tile.
            if drawing.ground[index * 4 + 3] == 255 {
                let off_m = (ground.z - height_m(ground.x, ground.y)).abs();
                let pixel_m = camera.pixel_at_unit_depth_m() * depth_m;
                worst_px = worst_px.max(off_m / pixel_m);
                // If even the finest level is coarser than requested, the finest level is drawn.
                worst_share = worst_share.max(off_m / finest_m.max(error_px * pixel_m));
            }
        }
        // A half is 127 on some GPUs.
        let is_skirt = |pixel: &&[u8]| (127..=128).contains(&pixel[3]);
        let skirts = drawing.ground.chunks_exact(4).filter(is_skirt).count();
        println!(
            "levels {levels:?}: {worst_px:.2} px off at most, {worst_share:.2} of what is allowed, {skirts} pixels of skirts"
        );
        assert!(worst_share <= 1.0, "{worst_share} of the error allowed");
    }
}

#[test]
fn draped_roads_show_on_every_level() {
    let country = Country::new();
    let mut style = Style::road_atlas();
    style.roads.iter_mut().for_each(|road| road.max_pixel_m = None);
    for (error_px, distance_m) in [(2.0, 9000.0), (16.0, 9000.0), (4.0, 40_000.0)] {
        let orientation = Orientation { heading_deg: 0.0, pitch_deg: 40.0 };
        let camera = Camera::look_at(target(&country), distance_m, orientation, SIZE);
        let Some((drawing, levels)) = picture(&country, &camera, error_px, &style) else {
            return;
        };
        // The roads meet at the target; the least important one goes north from there.
        let center = 240 * SIZE[0] as usize + 320;
        let near = |at: usize| drawing.labels[at - 3..at + 4].iter().any(|label| *label != 0);
        assert!(near(center) || near(center - 640) || near(center + 640), "levels {levels:?}");
        for number in [0, 3, 6] {
            let seen = drawing.pixels_of(number).len();
            assert!(seen > 150, "{seen} pixels of class {number} on levels {levels:?}");
        }
    }
}

#[test]
fn the_height_under_a_position_comes_from_the_finest_tile() {
    let country = Country::new();
    let mut store = TileStore::new(&country);
    let at = target(&country).truncate() + DVec2::new(1234.5, -678.9);
    let found_m = store.ground_height_m(at.to_array()).unwrap().unwrap();
    let bound_m = MAX_ERROR_M + interpolation_error_m(CELL_M);
    assert!((found_m - height_m(at.x, at.y)).abs() <= bound_m);
    // None of its ancestors is read.
    assert_eq!(store.len(), 1);
    assert_eq!(store.ground_height_m([0.0, 0.0]).unwrap(), None);
}
