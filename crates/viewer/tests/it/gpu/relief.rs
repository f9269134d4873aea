//! Roads behind ridges, over them and on rough ground.

use corniche_geom::TileId;
use glam::DVec2;

use super::{
    camera, center, compare, hidden_centerline_points, scene,
    support::{cast, draw, gpu, plain_style, plan_distance_m, triangles},
};

#[test]
fn nothing_of_a_road_shows_from_behind_a_ridge() {
    let Some(gpu) = gpu() else { return };
    // A ridge from west to east, 400 m high and 800 m wide on each side, with a road on its
    // northern slope.
    let ridge = |_: f64, y: f64| (400.0 - (y - center().y).abs() * 0.5).max(0.0);
    let tile = scene(8, ridge, &[(0, [-1500.0, 500.0], [1500.0, 500.0])]);
    let mesh = triangles(TileId::ROOT, &tile.1);
    for pitch_deg in [78.0, 84.0] {
        let from_south = camera(200.0, 3000.0, 0.0, pitch_deg);
        let drawing = draw(&gpu, &from_south, &plain_style(30.0), std::slice::from_ref(&tile));
        // The reference: the pixels that show ground of the road, by rays through the triangles.
        let visible = drawing
            .pixels()
            .filter(|(_, at)| at.y % 2.0 < 1.0 && at.x % 8.0 < 1.0)
            .filter(|(_, at)| {
                let ray = from_south.ray_in_world(*at);
                cast(from_south.eye_in_world, ray, &mesh).is_some_and(|depth_m| {
                    let ground = from_south.eye_in_world + ray * depth_m;
                    plan_distance_m(ground.truncate(), &tile.2) <= 15.0
                })
            });
        assert_eq!(visible.count(), 0, "the scene hides its road");
        assert_eq!(drawing.pixels_of(0).len(), 0, "pitch {pitch_deg}");
        let from_north = camera(200.0, 3000.0, 180.0, pitch_deg);
        let drawing = draw(&gpu, &from_north, &plain_style(30.0), std::slice::from_ref(&tile));
        let seen = drawing.pixels_of(0).len();
        assert!(seen > 500, "{seen} pixels of the road from the other side");
    }
}

#[test]
fn a_road_over_a_ridge_ends_at_its_crest() {
    let Some(gpu) = gpu() else { return };
    let ridge = |_: f64, y: f64| (400.0 - (y - center().y).abs() * 0.5).max(0.0);
    let tile = scene(8, ridge, &[(0, [100.0, -900.0], [-200.0, 900.0])]);
    let mesh = triangles(TileId::ROOT, &tile.1);
    let camera = camera(300.0, 1500.0, 0.0, 80.0);
    let drawing = draw(&gpu, &camera, &plain_style(40.0), std::slice::from_ref(&tile));
    let mut outside = 0;
    for at in drawing.pixels_of(0) {
        // At the silhouette one pixel is allowed, because the ray through the pixel's centre may
        // pass over the crest.
        let on_road = [0.0, 0.5, 1.0].iter().any(|down_px| {
            let ray = camera.ray_in_world(at + DVec2::new(0.0, *down_px));
            cast(camera.eye_in_world, ray, &mesh).is_some_and(|depth_m| {
                let ground = camera.eye_in_world + ray * depth_m;
                plan_distance_m(ground.truncate(), &tile.2) <= 20.5
            })
        });
        outside += usize::from(!on_road);
    }
    assert!(drawing.pixels_of(0).len() > 1000);
    assert_eq!(outside, 0, "of {} pixels hang over the crest", drawing.pixels_of(0).len());
}

#[test]
fn roads_on_rough_ground_are_neither_buried_nor_floating() {
    let Some(gpu) = gpu() else { return };
    let hills = |x: f64, y: f64| 400.0 + 60.0 * (x / 170.0).sin() * (y / 210.0).cos();
    let tile = scene(
        8,
        hills,
        &[(1, [-900.0, -700.0], [800.0, 600.0]), (4, [-800.0, 500.0], [900.0, -300.0])],
    );
    for (distance_m, pitch_deg) in [(1500.0, 0.0), (2500.0, 45.0), (3000.0, 70.0)] {
        let camera = camera(400.0, distance_m, 25.0, pitch_deg);
        let drawing = draw(&gpu, &camera, &plain_style(40.0), std::slice::from_ref(&tile));
        let found = compare(&drawing, &camera, &tile, 20.0, 0.05);
        println!(
            "GEO on hills at pitch {pitch_deg}: of {} pixels {} are missing, {} too many, {} excluded",
            found.covered, found.missing, found.extra, found.excluded
        );
        assert!(found.covered > 1000);
        assert_eq!(found.extra, 0, "only ground within half the width is painted");
        // GEO guarantees that the centre-line is drawn wherever it is in view.
        assert_eq!(hidden_centerline_points(&drawing, &camera, &tile), 0);
        // Flat quads on cross slopes: a measurement, with a bound that detects a regression.
        assert!((found.missing as f64) < 0.1 * found.covered as f64);
    }
}
