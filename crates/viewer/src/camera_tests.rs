//! The camera has the requested view, and depths are between 0 and 1.

use proptest::prelude::*;

use super::*;

const SIZE: [u32; 2] = [640, 480];

fn camera(heading_deg: f64, pitch_deg: f64) -> Camera {
    let target = DVec3::new(500_000.0, 5_000_000.0, 800.0);
    Camera::look_at(target, 10_000.0, Orientation { heading_deg, pitch_deg }, SIZE)
}

fn pixel(camera: &Camera, east: f64, north: f64) -> DVec2 {
    camera.project(DVec3::new(500_000.0 + east, 5_000_000.0 + north, 800.0)).unwrap().0
}

#[test]
fn the_target_is_in_the_middle_at_the_distance_asked_for() {
    let (at, depth_m) =
        camera(33.0, 60.0).project(DVec3::new(500_000.0, 5_000_000.0, 800.0)).unwrap();
    assert!((at - DVec2::new(320.0, 240.0)).length() < 1e-9);
    assert!((depth_m - 10_000.0).abs() < 1e-8);
}

#[test]
fn north_is_up_and_east_is_right() {
    for pitch_deg in [0.0, 45.0, 80.0] {
        let camera = camera(0.0, pitch_deg);
        assert!(pixel(&camera, 0.0, 1000.0).y < 239.0, "north at pitch {pitch_deg}");
        assert!(pixel(&camera, 100.0, 0.0).x > 321.0, "east at pitch {pitch_deg}");
    }
}

#[test]
fn heading_east_has_east_up_and_south_right() {
    let camera = camera(90.0, 30.0);
    assert!(pixel(&camera, 100.0, 0.0).y < 239.0);
    assert!(pixel(&camera, 0.0, -100.0).x > 321.0);
}

#[test]
fn a_tilted_camera_stands_behind_and_above_its_target() {
    let eye = camera(0.0, 60.0).eye_in_world;
    assert!((eye.y - (5_000_000.0 - 10_000.0 * 60_f64.to_radians().sin())).abs() < 1e-6);
    assert!((eye.z - (800.0 + 5_000.0)).abs() < 1e-6);
}

/// x = width / 2 + east / pixel, y = height / 2 − north / pixel, at any height.
#[test]
fn a_place_seen_from_above_is_where_the_scale_says() {
    let target = DVec3::new(500_000.0, 5_000_000.0, 800.0);
    let camera = Camera::from_above(target.truncate(), 2.5, 0.0, [0.0, 3000.0], SIZE);
    for height_m in [0.0, 800.0, 3000.0] {
        let at = DVec3::new(500_250.0, 5_000_100.0, height_m);
        let (pixel, _) = camera.project(at).unwrap();
        assert!(pixel.distance(DVec2::new(320.0 + 100.0, 240.0 - 40.0)) < 1e-9, "{pixel}");
        assert!((camera.seeing_distance_m(at) - camera.focus_m).abs() < 1e-12);
    }
    assert!((camera.pixel_at_depth_m(1.0) - 2.5).abs() < 1e-12);
    let turned = Camera::from_above(target.truncate(), 2.5, 90.0, [0.0, 3000.0], SIZE);
    let (east, _) = turned.project(target + DVec3::X * 250.0).unwrap();
    assert!(east.distance(DVec2::new(320.0, 240.0 - 100.0)) < 1e-9, "heading east: {east}");
}

#[test]
fn depths_from_above_are_between_nothing_and_one_and_come_back() {
    let target = DVec3::new(0.0, 0.0, 800.0);
    let camera = Camera::from_above(target.truncate(), 2.5, 0.0, [-100.0, 3000.0], SIZE);
    for height_m in [-100.0, 800.0, 3000.0] {
        let at = DVec3::new(10.0, 20.0, height_m);
        let clip = camera.clip_from_relative() * (at - camera.eye_in_world).extend(1.0);
        assert!(
            (clip.w - 1.0).abs() < 1e-12 && clip.z > 0.0 && clip.z < 1.0,
            "{height_m} m: {clip}"
        );
        let depth_m = camera.depth_m(clip.z);
        assert!((camera.eye_in_world.z - depth_m - height_m).abs() < 1e-9);
        let (pixel, _) = camera.project(at).unwrap();
        let back = camera.ray_start_in_world(pixel) + camera.ray_in_world(pixel) * depth_m;
        assert!(back.distance(at) < 1e-9, "{back}");
    }
}

#[test]
fn a_view_from_above_sees_boxes_in_its_rectangle_alone_and_frames_what_it_is_to_show() {
    let plan = |x: f64| Bounds { min_x: x, min_y: -10.0, max_x: x + 10.0, max_y: 10.0 };
    let target = DVec3::new(0.0, 0.0, 800.0);
    let camera = Camera::from_above(target.truncate(), 2.5, 0.0, [0.0, 3000.0], SIZE);
    let sees = |x: f64| camera.frustum().may_see(&WorldBox::new(plan(x), [0.0, 3000.0]));
    assert!(sees(0.0) && sees(799.0) && sees(-809.0));
    assert!(!sees(801.0) && !sees(-811.0));

    let subject =
        WorldBox::new(Bounds { min_x: 4e5, min_y: 5e6, max_x: 4.6e5, max_y: 5.02e6 }, [0.0, 900.0]);
    for heading_deg in [0.0, 30.0, 90.0] {
        let camera = Camera::framing_from_above(subject, heading_deg, [0.0, 900.0], SIZE);
        let pixels: Vec<DVec2> =
            subject.corners().map(|corner| camera.project(corner).unwrap().0).collect();
        let least = pixels.iter().fold(DVec2::INFINITY, |a, b| a.min(*b)).min_element();
        assert!((0.0..20.0).contains(&least), "{heading_deg}: {least}");
    }
}

#[test]
fn depth_runs_from_one_at_the_near_plane_to_zero() {
    let camera = camera(0.0, 0.0);
    let depth = |below_eye_m: f64| {
        let clip = camera.clip_from_relative() * DVec4::new(0.0, 0.0, -below_eye_m, 1.0);
        clip.z / clip.w
    };
    assert!((depth(camera.near_m) - 1.0).abs() < 1e-12);
    assert!(depth(1e9) > 0.0 && depth(1e9) < 1e-6);
}

#[test]
fn framing_holds_every_corner_and_touches_the_border() {
    let plan = Bounds { min_x: 4e5, min_y: 5e6, max_x: 4.6e5, max_y: 5.02e6 };
    let subject = WorldBox::new(plan, [200.0, 3000.0]);
    for heading_deg in [0.0, 30.0, 200.0] {
        let camera = Camera::framing(subject, Orientation { heading_deg, pitch_deg: 55.0 }, SIZE);
        let (mut low, mut high) = (DVec2::ONE, DVec2::NEG_ONE);
        for corner in subject.corners() {
            let (at, _) = camera.project(corner).unwrap();
            let share = (at - DVec2::new(320.0, 240.0)) / DVec2::new(320.0, 240.0);
            assert!(share.abs().max_element() < 1.0, "{corner} at {at}");
            (low, high) = (low.min(share), high.max(share));
        }
        assert!((low + high).abs().max_element() < 1e-6, "{low} to {high} is not in the middle");
        assert!((high - low).max_element() > 1.85, "{low} to {high}: too far away");
    }
}

#[test]
fn distance_to_a_box_is_zero_inside() {
    let subject = WorldBox { min: DVec3::ZERO, max: DVec3::splat(2.0) };
    assert!(subject.distance_m(DVec3::ONE).abs() < 1e-12);
    assert!((subject.distance_m(DVec3::new(5.0, 6.0, 1.0)) - 5.0).abs() < 1e-12);
}

proptest! {
    /// The ray through a projected point leads back to the point.
    #[test]
    fn rays_undo_projection(
        heading_deg in 0.0..360.0_f64, pitch_deg in 0.0..85.0_f64, depth_m in 20.0..50_000.0_f64,
        x_px in 0.0..640.0_f64, y_px in 0.0..480.0_f64,
    ) {
        let camera = camera(heading_deg, pitch_deg);
        let point = camera.eye_in_world + camera.ray_in_world(DVec2::new(x_px, y_px)) * depth_m;
        let (at, back_m) = camera.project(point).unwrap();
        prop_assert!((at - DVec2::new(x_px, y_px)).length() < 1e-4);
        prop_assert!((back_m - depth_m).abs() < 1e-4);
    }

    /// A box with a point in the picture is never culled.
    #[test]
    fn nothing_in_view_is_culled(
        heading_deg in 0.0..360.0_f64, pitch_deg in 0.0..85.0_f64, depth_m in 20.0..50_000.0_f64,
        x_px in 0.0..640.0_f64, y_px in 0.0..480.0_f64, side_m in 0.0..5_000.0_f64,
    ) {
        let camera = camera(heading_deg, pitch_deg);
        let point = camera.eye_in_world + camera.ray_in_world(DVec2::new(x_px, y_px)) * depth_m;
        let subject = WorldBox { min: point - DVec3::splat(side_m), max: point + DVec3::splat(side_m / 2.0) };
        prop_assert!(camera.frustum().may_see(&subject));
    }

    /// A box behind the eye is culled.
    #[test]
    fn boxes_behind_the_eye_are_culled(pitch_deg in 0.0..85.0_f64, behind_m in 10.0..1e5_f64) {
        let camera = camera(0.0, pitch_deg);
        let point = camera.eye_in_world + camera.world_from_view.z_axis * behind_m;
        let subject = WorldBox { min: point - DVec3::ONE, max: point + DVec3::ONE };
        prop_assert!(!camera.frustum().may_see(&subject));
    }
}
