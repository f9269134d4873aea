//! The ground: directions, reproducible bytes, depth against rays, skirts.

use corniche_geom::TileId;
use corniche_viewer::camera::{Camera, Orientation};
use glam::DVec3;

use super::{
    SIZE, camera, center, scene,
    support::{cast, draw, draw_exaggerated, gpu, plain_style, terrain, triangles},
};

#[test]
fn north_is_up_and_east_is_right() {
    let Some(gpu) = gpu() else { return };
    let roads = [(0, [0.0, 300.0], [0.0, 400.0]), (5, [300.0, 0.0], [400.0, 0.0])];
    let tile = scene(256, |_, _| 0.0, &roads);
    for pitch_deg in [0.0, 55.0] {
        let camera = camera(0.0, 1500.0, 0.0, pitch_deg);
        let drawing = draw(&gpu, &camera, &plain_style(30.0), std::slice::from_ref(&tile));
        let (north, east) = (drawing.pixels_of(0), drawing.pixels_of(5));
        assert!(
            !north.is_empty() && north.iter().all(|at| at.y < 200.0),
            "north at pitch {pitch_deg}"
        );
        assert!(
            !east.is_empty() && east.iter().all(|at| at.x > 360.0),
            "east at pitch {pitch_deg}"
        );
    }
}

#[test]
fn the_same_frame_is_the_same_bytes() {
    let Some(gpu) = gpu() else { return };
    let tile = scene(
        8,
        |x, y| 300.0 + 50.0 * (x / 200.0).sin() * (y / 150.0).cos(),
        &[(2, [-500.0, -300.0], [600.0, 400.0])],
    );
    let camera = camera(300.0, 2000.0, 10.0, 60.0);
    let style = corniche_styles::Style::road_atlas();
    let first = draw(&gpu, &camera, &style, std::slice::from_ref(&tile));
    let second = draw(&gpu, &camera, &style, std::slice::from_ref(&tile));
    assert!(
        first.picture == second.picture
            && first.labels == second.labels
            && first.depth == second.depth
    );
}

#[test]
fn terrain_is_where_rays_meet_its_triangles() {
    let Some(gpu) = gpu() else { return };
    let hills = |x: f64, y: f64| 400.0 + 150.0 * (x / 400.0).sin() * (y / 300.0).cos();
    let tile = scene(16, hills, &[]);
    let mesh = triangles(TileId::ROOT, &tile.1);
    for (exaggeration, pitch_deg) in [(1.0, 30.0), (1.0, 78.0), (2.5, 60.0)] {
        let camera = camera(400.0 * exaggeration, 6000.0, 40.0, pitch_deg);
        let drawing = draw_exaggerated(
            &gpu,
            &camera,
            &plain_style(10.0),
            std::slice::from_ref(&tile),
            exaggeration,
        );
        let stretched: Vec<[DVec3; 3]> = mesh
            .iter()
            .map(|corners| {
                corners.map(|corner| DVec3::new(corner.x, corner.y, corner.z * exaggeration))
            })
            .collect();
        let (mut checked, mut missing, mut wrong, mut worst_px) = (0, 0, 0, 0.0_f64);
        for (index, at) in drawing.pixels().filter(|(_, at)| at.x % 5.0 < 1.0 && at.y % 5.0 < 1.0) {
            if drawing.is_at_jump(index) {
                continue;
            }
            checked += 1;
            let ray = camera.ray_in_world(at);
            let Some(truth_m) = cast(camera.eye_in_world, ray, &stretched) else {
                missing += usize::from(drawing.depth[index] != 0.0);
                continue;
            };
            if drawing.depth[index] == 0.0 {
                missing += 1;
                continue;
            }
            let drawn_m = camera.near_m / f64::from(drawing.depth[index]);
            let off_m = (drawn_m - truth_m).abs();
            wrong += usize::from(off_m > 0.5 * camera.pixel_at_unit_depth_m() * truth_m / 0.1);
            worst_px = worst_px.max(off_m / (camera.pixel_at_unit_depth_m() * truth_m));
        }
        println!(
            "terrain at pitch {pitch_deg}: {checked} rays, depth off by {worst_px:.4} pixels at most"
        );
        assert!(checked > 3000);
        assert_eq!((missing, wrong), (0, 0), "of {checked} at pitch {pitch_deg}");
    }
}

#[test]
fn skirts_close_the_crack_between_levels() {
    let Some(gpu) = gpu() else { return };
    // The western half of one coarse tile is replaced by two fine tiles of a ground that differs by
    // up to 20 m.
    let rough = |x: f64, y: f64| 300.0 + 20.0 * (x / 90.0).sin() * (y / 70.0).cos();
    let fine = |id| (id, terrain(id, 4, rough), Vec::new(), 40.0);
    let coarse = |id, skirt_m| (id, terrain(id, 128, rough), Vec::new(), skirt_m);
    let tile = |x, y| TileId::new(1, x, y).unwrap();
    let camera = Camera::look_at(
        center().extend(300.0),
        1200.0,
        Orientation { heading_deg: 60.0, pitch_deg: 70.0 },
        SIZE,
    );
    let holes = |skirt_m: f64| {
        let mut scene = vec![
            fine(tile(0, 0)),
            fine(tile(0, 1)),
            coarse(tile(1, 0), skirt_m),
            coarse(tile(1, 1), skirt_m),
        ];
        for (_, _, _, depth) in &mut scene {
            *depth = skirt_m;
        }
        let drawing = draw(&gpu, &camera, &plain_style(10.0), &scene);
        // A half is 127 on some GPUs.
        let is_skirt = |pixel: &&[u8]| (127..=128).contains(&pixel[3]);
        let skirts = drawing.ground.chunks_exact(4).filter(is_skirt).count();
        // Below the middle of the picture there is ground everywhere.
        let below = (SIZE[0] * SIZE[1] / 2) as usize;
        (drawing.depth[below..].iter().filter(|depth| **depth == 0.0).count(), skirts)
    };
    assert_eq!(holes(40.0).0, 0);
    assert!(holes(40.0).1 > 50, "skirts are marked");
    assert!(holes(0.0).1 == 0, "skirts without depth are not visible");
}
