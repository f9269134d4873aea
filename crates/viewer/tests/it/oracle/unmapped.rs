//! Undraped roads (`render --unmapped`) against a reference: ribbons that are straight in space
//! between the points of their source; and against drawings with deliberate errors.

use corniche_viewer::{RoadMethod, RoadOptions, camera::Camera};
use glam::DVec2;

use super::{
    decks::{Deck, DeckOracle, Found, Slab, UNDERSIDE},
    reference::Look,
    support::{
        gpu,
        scene::Scene,
        scenes::{self, camera, style},
    },
};

fn options() -> RoadOptions {
    RoadOptions::for_method(RoadMethod::Geometry)
}

/// A road with one point on each side, and one that bends.
const ROADS: [&[[f64; 2]]; 2] =
    [&[[-420.0, 30.0], [400.0, 10.0]], &[[-300.0, -250.0], [0.0, -160.0], [310.0, -240.0]]];

type Ground = fn(f64, f64) -> f64;

fn hill(x: f64, y: f64) -> f64 {
    100.0 + 60.0 * (-(x * x + y * y) / 40_000.0).exp()
}

fn valley(x: f64, _: f64) -> f64 {
    100.0 + 0.3 * (x.abs() - 200.0).max(-120.0)
}

fn waves(x: f64, y: f64) -> f64 {
    120.0 + 25.0 * (x / 70.0).sin() + 15.0 * (y / 50.0).cos()
}

fn scene(ground: Ground) -> Scene {
    let roads: Vec<(u8, Vec<[f64; 2]>)> =
        ROADS.iter().zip([3, 6]).map(|(points, class)| (class, points.to_vec())).collect();
    scenes::one_tile(8, ground, &roads, style(14.0))
}

/// The expected ribbons: lines in space between the points of roads, which have the height of the
/// drawn ground.
fn straight(scene: &Scene) -> Vec<Deck> {
    let triangles = &scene.tiles[0].triangles;
    let height_m = |at: DVec2| {
        let above = triangles.iter().find_map(|[a, b, c]| {
            let [u, v, w] = [*b - *a, *c - *a, at.extend(0.0) - *a];
            let area = u.x * v.y - u.y * v.x;
            let [s, t] = [(w.x * v.y - w.y * v.x) / area, (u.x * w.y - u.y * w.x) / area];
            (s >= -1e-9 && t >= -1e-9 && s + t <= 1.0 + 1e-9).then_some(a.z + s * u.z + t * v.z)
        });
        above.expect("a point on the ground")
    };
    let place = |[x, y]: [f64; 2]| [x, y, height_m(scenes::center() + DVec2::new(x, y))];
    let deck =
        |(points, class): (&&[[f64; 2]], u8)| (class, points.iter().map(|at| place(*at)).collect());
    ROADS.iter().zip([3, 6]).map(deck).collect()
}

fn compare(
    scene: &Scene,
    decks: &[Deck],
    camera: &Camera,
    gpu: &corniche_viewer::gpu::Gpu,
) -> Found {
    let options = options();
    let unmapped = Scene { tiles: vec![scene.tiles[0].unmapped()], ..scene.clone() };
    let drawing = unmapped.draw(gpu, camera, options);
    assert!(drawing.labels.iter().all(|label| *label == 0), "nothing lies on the ground");
    let look = Look { style: &scene.style, options, camera };
    let slabs = decks.iter().map(|deck| Slab::new(deck, look).into_ribbon()).collect();
    DeckOracle { slabs, style: &scene.style, camera, drawing: &drawing }.compare()
}

#[test]
fn roads_laid_on_nothing_are_straight_in_space() {
    let Some(gpu) = gpu() else { return };
    let grounds: [(&str, Ground); 3] = [("hill", hill), ("valley", valley), ("waves", waves)];
    for (name, ground) in grounds {
        let scene = scene(ground);
        let decks = straight(&scene);
        let mut compared = 0;
        for camera in [camera(120.0, 900.0, 20.0, 50.0), camera(120.0, 1200.0, 200.0, 20.0)] {
            let found = compare(&scene, &decks, &camera, &gpu);
            println!("{name:8} {found:?}");
            assert_eq!(found.wrong, 0, "{name}: {found:?}");
            compared += found.compared;
        }
        assert!(compared > 500, "{name}: {compared} pixels are no test");
    }
}

/// The hill hides the road inside it, and over the valley the road is nearer to the eye than the
/// ground.
#[test]
fn the_ground_hides_a_road_that_is_laid_on_nothing() {
    let Some(gpu) = gpu() else { return };
    let view = camera(120.0, 1500.0, 0.0, 0.0);
    let seen = |ground: Ground| {
        let mapped = scene(ground);
        let unmapped = Scene { tiles: vec![mapped.tiles[0].unmapped()], ..mapped.clone() };
        let on_ground = mapped.draw(&gpu, &view, options());
        let on_ground = on_ground.labels.iter().filter(|label| **label != 0).count();
        let drawing = unmapped.draw(&gpu, &view, options());
        let ribbons = drawing.decks.as_ref().unwrap();
        let ribbons = ribbons.iter().filter(|label| **label > UNDERSIDE).count();
        ribbons as f64 / on_ground as f64
    };
    let [through, over] = [hill, valley].map(seen);
    println!("through a hill {through:.2}, over a valley {over:.2} of the pixels on the ground");
    assert!(through < 0.6 && over > 0.95, "{through} {over}");
}

/// A road that bends with the ground, or is a metre higher, is detected.
#[test]
fn other_lines_are_refused() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = (scene(valley), camera(120.0, 900.0, 20.0, 50.0));
    let decks = straight(&scene);
    let sagging = decks.iter().map(|(class, points)| {
        let middle = [0, 1, 2].map(|k| f64::midpoint(points[0][k], points[1][k]));
        let [x, y, z] = middle;
        let mut points = points.clone();
        points.insert(1, [x, y, z - 3.0]);
        (*class, points)
    });
    let lifted = decks.iter().map(|(class, points)| {
        (*class, points.iter().map(|[x, y, z]| [*x, *y, z + 1.0]).collect())
    });
    for (what, decks) in
        [("sags by 3 m", sagging.collect::<Vec<Deck>>()), ("1 m above", lifted.collect())]
    {
        let found = compare(&scene, &decks, &camera, &gpu);
        println!("must fail, {what}: {found:?}");
        assert!(found.wrong > 20, "{what}: {found:?}");
    }
}
