//! Points against rays at the drawn triangles: a mark is drawn where nothing hides its point.

use std::f64::consts::TAU;

use corniche_layers::OsmObject;
use corniche_styles::{LayerLook, PointStyle};
use corniche_tileset::{LayerObject, LayerShape, LayerSlot};
use corniche_viewer::{PackageLooks, RoadMethod, RoadOptions, camera::Camera};
use glam::{DVec2, DVec3};

use super::{
    ground_rays::Caster,
    support::{
        self, gpu,
        scene::Scene,
        scenes::{SIZE, camera, center, one_tile, style},
    },
};

const COLOR: [u8; 3] = [255, 0, 255];

/// Marks of four pixels.
fn looks(opacity: f32) -> PackageLooks {
    let color = COLOR.map(|part| f32::from(part) / 255.0);
    let point = PointStyle { color, size_px: 4.0, outline: None, opacity, max_pixel_m: None };
    PackageLooks::from_looks(vec![vec![LayerLook::Point(point)]])
}

/// Ridges from south to north, 800 m apart and 300 m high, with points 80 m apart.
fn scene() -> Scene {
    let ridges = |x: f64, _: f64| 150.0 * (x * TAU / 800.0).cos();
    let mut scene = one_tile(2, ridges, &[], style(1.0));
    scene.style.haze_reach = 1e9;
    scene.layers = looks(1.0);
    let frame = support::frame();
    let grid = (-15..=15)
        .flat_map(|x| (-15..=15).map(move |y| [80.0 * f64::from(x), 80.0 * f64::from(y)]));
    let point = |at: [f64; 2]| LayerObject {
        class: 0,
        object: OsmObject::Node(1),
        values: Vec::new(),
        shape: LayerShape::Point(
            frame.snap((center() + DVec2::from_array(at)).to_array()).unwrap(),
        ),
    };
    let layer = (LayerSlot::new(0_u8).unwrap(), grid.map(point).collect());
    let tile = &mut scene.tiles[0].geometry;
    *tile = tile.clone().with_layers(vec![layer], &frame).unwrap();
    scene
}

/// The points of a scene in the world.
fn places(scene: &Scene) -> Vec<DVec3> {
    let tile = &scene.tiles[0].geometry;
    let reference = DVec3::from_array(tile.reference_m);
    let place = |at: &[f32; 3]| reference + DVec3::from_array(at.map(f64::from));
    tile.points.places_in_tile.iter().map(place).collect()
}

/// Counts visible and hidden points whose marks meet no other mark, and those that are drawn
/// otherwise. Points within two pixels of a silhouette are not counted.
fn compare(scene: &Scene, camera: &Camera) -> Option<([usize; 2], usize)> {
    let drawing = scene.draw(&gpu()?, camera, RoadOptions::for_method(RoadMethod::None));
    let caster = Caster::new(scene, camera);
    let on_picture: Vec<(DVec2, DVec3)> = places(scene)
        .into_iter()
        .filter_map(|at| Some((camera.project(at)?.0, at)))
        .filter(|(pixel, _)| {
            let [width, height] = SIZE.map(f64::from);
            (5.0..width - 5.0).contains(&pixel.x) && (5.0..height - 5.0).contains(&pixel.y)
        })
        .collect();
    let (mut counts, mut wrong) = ([0; 2], 0);
    for (pixel, at) in &on_picture {
        let near = on_picture.iter().filter(|(other, _)| other.distance(*pixel) < 6.0).count();
        // How far the ground at a pixel is, as a share of the distance of the point.
        let ground = |by: DVec2| {
            let far_m = at.distance(camera.eye_in_world);
            let hit = caster.hit(*pixel + by);
            hit.map_or(f64::INFINITY, |hit| hit.at.distance(camera.eye_in_world) / far_m)
        };
        let around = (0..9).map(|k| 2.0 * DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)));
        let hidden = around.into_iter().all(|by| ground(by) < 0.99);
        if near > 1 || !(hidden || ground(DVec2::ZERO) > 0.9999) {
            continue;
        }
        counts[usize::from(hidden)] += 1;
        let index = 4 * (pixel.y as usize * SIZE[0] as usize + pixel.x as usize);
        let is_drawn =
            drawing.picture[index..index + 3].iter().zip(COLOR).all(|(a, b)| a.abs_diff(b) < 3);
        wrong += usize::from(is_drawn == hidden);
    }
    Some((counts, wrong))
}

#[test]
fn marks_are_where_nothing_hides_their_points() {
    let scene = scene();
    assert_eq!(places(&scene).len(), 31 * 31);
    for (heading_deg, pitch_deg) in [(90.0, 65.0), (250.0, 70.0), (300.0, 60.0)] {
        let camera = camera(0.0, 1800.0, heading_deg, pitch_deg);
        let Some((counts, wrong)) = compare(&scene, &camera) else { return };
        println!(
            "points from {heading_deg}°, {pitch_deg}°: {counts:?} visible and hidden, {wrong} wrong"
        );
        assert!(counts[0] > 40 && counts[1] > 20, "{counts:?}");
        assert_eq!(wrong, 0);
    }
}

#[test]
fn from_above_every_mark_is_there() {
    let scene = scene();
    let camera = Camera::from_above(center(), 5.0, 0.0, [-3e3, 3e3], SIZE);
    let Some((counts, wrong)) = compare(&scene, &camera) else { return };
    assert!(counts[0] > 500 && counts[1] == 0, "{counts:?}");
    assert_eq!(wrong, 0);
}

/// A mark covers as many pixels as its disc, near and far.
#[test]
fn marks_have_their_size_in_pixels() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene();
    let marks = &mut scene.tiles[0].geometry.points;
    marks.places_in_tile.truncate(1);
    marks.classes[0].1 = 0..1;
    let at = places(&scene)[0];
    for distance_m in [300.0, 3000.0, 30_000.0] {
        let orientation =
            corniche_viewer::camera::Orientation { heading_deg: 30.0, pitch_deg: 40.0 };
        let camera = Camera::look_at(at, distance_m, orientation, SIZE);
        let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(RoadMethod::None));
        let is_mark =
            |pixel: &&[u8; 4]| pixel[..3].iter().zip(COLOR).all(|(a, b)| a.abs_diff(b) < 3);
        let pixels = drawing.picture.as_chunks::<4>().0.iter().filter(is_mark).count();
        // A disc of four pixels.
        assert!((9..=16).contains(&pixels), "{distance_m} m: {pixels} pixels");
    }
}

#[test]
fn points_that_are_not_drawn_change_no_byte() {
    let Some(gpu) = gpu() else { return };
    let camera = camera(300.0, 1500.0, 20.0, 60.0);
    let drawn = |scene: &Scene| {
        scene.draw(&gpu, &camera, RoadOptions::for_method(RoadMethod::None)).picture
    };
    let with = scene();
    let hidden = Scene { layers: looks(0.0), ..with.clone() };
    let mut bare = with.clone();
    bare.tiles[0].geometry.points = corniche_viewer::tiles::PointMarks::default();
    assert_eq!(drawn(&hidden), drawn(&bare));
    assert_ne!(drawn(&with), drawn(&bare));
}
