//! Roads on flat and evenly sloping ground: position, width, order and centre lines.

use corniche_geom::TileId;
use corniche_viewer::camera::{Camera, Orientation};
use glam::DVec2;

use super::{
    SIZE, camera, center, compare, hidden_centerline_points, scene,
    support::{bands, draw, frame, gpu, ground_line, lay, plain_style, terrain, triangles},
};
use crate::labels::road_label;

#[test]
fn a_road_is_where_the_camera_says() {
    let Some(gpu) = gpu() else { return };
    let tile = scene(256, |_, _| 300.0, &[(2, [-400.0, -200.0], [500.0, 300.0])]);
    let camera = camera(300.0, 2000.0, 20.0, 50.0);
    let drawing = draw(&gpu, &camera, &plain_style(20.0), std::slice::from_ref(&tile));
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let point = center() + DVec2::new(-400.0 + 900.0 * share, -200.0 + 500.0 * share);
        let (at, _) = camera.project(point.extend(300.0)).unwrap();
        let index = at.y as usize * SIZE[0] as usize + at.x as usize;
        assert_eq!(drawing.labels[index], road_label(2, 0), "no road at {at}");
    }
    let beside = center() + DVec2::new(-100.0, 200.0);
    let (at, _) = camera.project(beside.extend(300.0)).unwrap();
    assert_eq!(drawing.labels[at.y as usize * SIZE[0] as usize + at.x as usize], 0);
}

#[test]
fn a_straight_road_has_its_width() {
    let Some(gpu) = gpu() else { return };
    // Straight down from 1000 m; slanted, so that pixel centres fall everywhere across the road.
    let tile = scene(256, |_, _| 0.0, &[(2, [-37.0, -2000.0], [41.0, 2000.0])]);
    let camera = camera(0.0, 1000.0, 0.0, 0.0);
    for width_m in [10.0_f32, 23.5, 60.0] {
        let drawing = draw(&gpu, &camera, &plain_style(width_m), std::slice::from_ref(&tile));
        let slant = 4000.0 / 78_f64.hypot(4000.0);
        let expected_px = f64::from(width_m) / (1000.0 * camera.pixel_at_unit_depth_m()) / slant;
        let measured_px = drawing.pixels_of(2).len() as f64 / f64::from(SIZE[1]);
        assert!(
            (measured_px - expected_px).abs() < 0.1,
            "{measured_px} px instead of {expected_px} px"
        );
    }
}

#[test]
fn a_road_grows_beyond_the_threshold_and_never_gets_thinner_than_asked() {
    let Some(gpu) = gpu() else { return };
    let tile = scene(256, |_, _| 0.0, &[(2, [-37.0, -2000.0], [41.0, 2000.0])]);
    let mut style = plain_style(10.0);
    style.width_scaling =
        corniche_styles::WidthScaling { threshold_m: 400.0, exponent: 0.5, constant: 1.0 };
    let width_px = |style: &corniche_styles::Style, distance_m| {
        let drawing =
            draw(&gpu, &camera(0.0, distance_m, 0.0, 0.0), style, std::slice::from_ref(&tile));
        // The middle row alone: its distance from the eye is the camera's.
        let rows = 200.0..280.0;
        drawing.pixels_of(2).iter().filter(|at| rows.contains(&at.y)).count() as f64 / 80.0
    };
    let pixel_m = camera(0.0, 1600.0, 0.0, 0.0).pixel_at_unit_depth_m() * 1600.0;
    let grown_px = width_px(&style, 1600.0);
    assert!(
        (grown_px - 20.0 / pixel_m).abs() < 0.15,
        "{grown_px} px instead of {}",
        20.0 / pixel_m
    );
    style.roads[2].min_width_px = 20.0;
    let least_px = width_px(&style, 1600.0);
    assert!((least_px - 20.0).abs() < 0.15, "{least_px} px instead of 20");
}

#[test]
fn a_thin_road_at_a_grazing_angle_does_not_break_into_dashes() {
    let Some(gpu) = gpu() else { return };
    let bumps = |x: f64, y: f64| 20.0 + 3.0 * (x / 60.0).sin() * (y / 80.0).cos();
    let tile = scene(4, bumps, &[(7, [-2400.0, 300.0], [2400.0, 420.0])]);
    let mut style = plain_style(3.0);
    style.roads[7].min_width_px = 2.0;
    let camera = camera(20.0, 2500.0, 0.0, 80.0);
    let drawing = draw(&gpu, &camera, &style, std::slice::from_ref(&tile));
    assert_eq!(hidden_centerline_points(&drawing, &camera, &tile), 0);
    // A level view and two pixels width: 1 to 3 pixels in each column.
    let per_column = drawing.pixels_of(7).len() as f64 / f64::from(SIZE[0]);
    assert!((1.5..2.5).contains(&per_column), "{per_column} pixels a column");
}

#[test]
fn on_flat_ground_every_pixel_outside_the_band_agrees_with_the_reference() {
    let Some(gpu) = gpu() else { return };
    let roads = [
        (3, [-300.0, -200.0], [250.0, 180.0]),
        (3, [250.0, 180.0], [-100.0, 260.0]),
        (3, [-400.0, 300.0], [-399.9, 300.0]),
    ];
    let tile = scene(32, |_, _| 512.0, &roads);
    for (distance_m, heading_deg, pitch_deg) in
        [(1500.0, 0.0, 0.0), (1200.0, 45.0, 60.0), (2500.0, 200.0, 75.0)]
    {
        let camera = camera(512.0, distance_m, heading_deg, pitch_deg);
        let drawing = draw(&gpu, &camera, &plain_style(40.0), std::slice::from_ref(&tile));
        let found = compare(&drawing, &camera, &tile, 20.0, 0.05);
        assert!(found.covered > 500, "{} pixels are no test", found.covered);
        assert_eq!(found.wrong(), 0, "of {} pixels, {} excluded", found.covered, found.excluded);
    }
}

/// The comparison above detects wrong roads.
#[test]
fn the_reference_notices_wrong_roads() {
    let Some(gpu) = gpu() else { return };
    let road = [(3, [-300.0, -200.0], [250.0, 180.0])];
    let truth = scene(32, |_, _| 512.0, &road);
    let camera = camera(512.0, 1200.0, 0.0, 30.0);
    let pixel_m = camera.pixel_at_unit_depth_m() * 1200.0;
    let shifted = scene(
        32,
        |_, _| 512.0,
        &[(3, [-300.0, -200.0 + 0.3 * pixel_m], [250.0, 180.0 + 0.3 * pixel_m])],
    );
    let drawing = draw(&gpu, &camera, &plain_style(40.0), &[shifted]);
    assert!(compare(&drawing, &camera, &truth, 20.0, 0.05).wrong() > 0, "shifted by 0.3 px");
    let drawing = draw(&gpu, &camera, &plain_style(42.0), std::slice::from_ref(&truth));
    assert!(compare(&drawing, &camera, &truth, 20.0, 0.05).wrong() > 0, "5 % wider");
}

#[test]
fn on_a_tilted_plane_along_its_slope_every_pixel_agrees_with_the_reference() {
    let Some(gpu) = gpu() else { return };
    let up_hill = |_: f64, y: f64| (y - 5_117_440.0) * 0.5;
    // Uphill, the quad is in the ground; caps and sides are exact.
    let tile = scene(64, up_hill, &[(3, [0.0, -300.0], [0.0, 280.0])]);
    let height_m = up_hill(0.0, center().y);
    let camera = camera(height_m, 1500.0, 30.0, 40.0);
    let drawing = draw(&gpu, &camera, &plain_style(30.0), std::slice::from_ref(&tile));
    let found = compare(&drawing, &camera, &tile, 15.0, 0.05);
    assert!(found.covered > 500);
    assert_eq!(found.wrong(), 0, "of {}", found.covered);
}

#[test]
fn more_important_roads_lie_above_across_tiles() {
    let Some(gpu) = gpu() else { return };
    // Two tiles of the finer level side by side; their roads meet on the border, wide enough to
    // overlap.
    let [west, east] = [TileId::new(1, 0, 0).unwrap(), TileId::new(1, 1, 0).unwrap()];
    let border = frame().tile_bounds(west);
    let middle = DVec2::new(border.max_x, f64::midpoint(border.min_y, border.max_y));
    let tile = |id, number, reach_m: f64| {
        let ground = terrain(id, 64, |_, _| 100.0);
        let points_m = lay(middle, middle + DVec2::new(reach_m, 0.0), &triangles(id, &ground));
        let line = ground_line(number, points_m);
        (id, ground, vec![line], 0.0)
    };
    let camera = Camera::look_at(
        middle.extend(100.0),
        800.0,
        Orientation { heading_deg: 0.0, pitch_deg: 0.0 },
        SIZE,
    );
    let important_first = [tile(west, 1, -500.0), tile(east, 5, 500.0)];
    let important_last = [tile(west, 5, -500.0), tile(east, 1, 500.0)];
    for scene in [important_first, important_last] {
        let drawing = draw(&gpu, &camera, &plain_style(80.0), &scene);
        let center = 240 * SIZE[0] as usize + 320;
        for offset in [-10_isize, -1, 0, 10] {
            let label = drawing.labels[center.saturating_add_signed(offset)];
            assert_eq!(label, road_label(1, 0), "label {label} at {offset} px from the junction");
        }
    }
}

#[test]
fn the_center_line_of_a_road_goes_through_its_joints() {
    let Some(gpu) = gpu() else { return };
    let tile = scene(
        256,
        |_, _| 50.0,
        &[
            (0, [-300.0, -200.0], [0.0, 0.0]),
            (0, [0.0, 0.0], [300.0, -150.0]),
            (3, [0.0, -200.0], [0.0, 200.0]),
        ],
    );
    let mut style = plain_style(50.0);
    style.roads[0].bands = bands(&[1.0, 0.3]);
    let camera = camera(50.0, 900.0, 0.0, 0.0);
    let drawing = draw(&gpu, &camera, &style, &[tile]);
    for share in [0.2, 0.6, 1.0] {
        for end in [[-300.0, -200.0], [300.0, -150.0]] {
            let point = center() + DVec2::from_array(end) * (1.0 - share);
            let (at, _) = camera.project(point.extend(50.0)).unwrap();
            let label = drawing.labels[at.y as usize * SIZE[0] as usize + at.x as usize];
            assert_eq!(label, road_label(0, 1), "class 0 and its centre line at {at}");
        }
    }
}
