//! What the graphics card draws, against references computed in f64 on the CPU.
//!
//! Software Vulkan is enough. Without any adapter each test reports itself skipped.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

mod support;

use corniche_geom::TileId;
use corniche_viewer::camera::{Camera, Orientation};
use glam::{DVec2, DVec3};
use support::{
    SceneTile, cast, draw, draw_exaggerated, frame, gpu, ground_line, lay, plain_style,
    plan_distance_m, terrain, triangles,
};

const SIZE: [u32; 2] = [640, 480];

/// Middle of the root tile, 5120 m wide.
fn center() -> DVec2 {
    DVec2::from_array(frame().tile_bounds(TileId::ROOT).center())
}

fn camera(height_m: f64, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    Camera::look_at(
        center().extend(height_m),
        distance_m,
        Orientation { heading_deg, pitch_deg },
        SIZE,
    )
}

/// The root tile with this ground and straight roads, given as class, from and to relative to the centre.
fn scene(
    step: u16,
    height_m: impl Fn(f64, f64) -> f64,
    roads: &[(u8, [f64; 2], [f64; 2])],
) -> SceneTile {
    let ground = terrain(TileId::ROOT, step, height_m);
    let mesh = triangles(TileId::ROOT, &ground);
    let line = |from: [f64; 2], to: [f64; 2]| {
        lay(center() + DVec2::from_array(from), center() + DVec2::from_array(to), &mesh)
    };
    let lines =
        roads.iter().map(|(number, from, to)| ground_line(*number, line(*from, *to))).collect();
    (TileId::ROOT, ground, lines, 0.0)
}

/// How a drawing disagrees with the reference: covered iff the ground's plan position is within half the width.
struct Disagreement {
    /// Pixels that should be covered.
    covered: usize,
    /// Pixels that are covered although they should not be, the boundary being farther than the band away.
    extra: usize,
    /// Pixels that are not covered although they should be, likewise.
    missing: usize,
    /// Pixels left out because the depth jumps around them.
    excluded: usize,
}

impl Disagreement {
    fn wrong(&self) -> usize {
        self.extra + self.missing
    }
}

/// Compares labels with a reference from the device's own depth, unprojected in f64.
fn compare(
    drawing: &support::Drawing,
    camera: &Camera,
    tile: &SceneTile,
    half_m: f64,
    band_px: f64,
) -> Disagreement {
    let mut sum = Disagreement { covered: 0, extra: 0, missing: 0, excluded: 0 };
    for (index, at) in drawing.pixels() {
        if drawing.depth[index] == 0.0 {
            continue;
        }
        if drawing.is_at_jump(index) {
            sum.excluded += 1;
            continue;
        }
        let depth_m = camera.near_m() / f64::from(drawing.depth[index]);
        let ground = camera.eye_in_world() + camera.ray_in_world(at) * depth_m;
        let beyond_m = plan_distance_m(ground.truncate(), &tile.2) - half_m;
        sum.covered += usize::from(beyond_m <= 0.0);
        // A step of a pixel on the screen moves the plan position by at least this much.
        let band_m = band_px * camera.pixel_at_unit_depth_m() * depth_m;
        let drawn = drawing.labels[index] != 0;
        sum.extra += usize::from(drawn && beyond_m > band_m);
        sum.missing += usize::from(!drawn && beyond_m < -band_m);
    }
    sum
}

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
        assert_eq!(drawing.labels[index] / 2, 7, "no road at {at}");
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
        corniche_viewer::style::WidthScaling { threshold_m: 400.0, exponent: 0.5, constant: 1.0 };
    let width_px = |style: &corniche_viewer::style::Style, distance_m| {
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
    // Level seen, two pixels wide: 1 to 3 in each column.
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

/// The check above sees what it should see.
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
    // Up the slope the quad lies in the ground; caps and sides are exact.
    let tile = scene(64, up_hill, &[(3, [0.0, -300.0], [0.0, 280.0])]);
    let height_m = up_hill(0.0, center().y);
    let camera = camera(height_m, 1500.0, 30.0, 40.0);
    let drawing = draw(&gpu, &camera, &plain_style(30.0), std::slice::from_ref(&tile));
    let found = compare(&drawing, &camera, &tile, 15.0, 0.05);
    assert!(found.covered > 500);
    assert_eq!(found.wrong(), 0, "of {}", found.covered);
}

#[test]
fn nothing_of_a_road_shows_from_behind_a_ridge() {
    let Some(gpu) = gpu() else { return };
    // A ridge from west to east, 400 m high and 800 m to each side, with a road on its northern slope.
    let ridge = |_: f64, y: f64| (400.0 - (y - center().y).abs() * 0.5).max(0.0);
    let tile = scene(8, ridge, &[(0, [-1500.0, 500.0], [1500.0, 500.0])]);
    let mesh = triangles(TileId::ROOT, &tile.1);
    for pitch_deg in [78.0, 84.0] {
        let from_south = camera(200.0, 3000.0, 0.0, pitch_deg);
        let drawing = draw(&gpu, &from_south, &plain_style(30.0), std::slice::from_ref(&tile));
        // The reference: which pixels see ground of the road at all, by rays at the triangles.
        let visible = drawing
            .pixels()
            .filter(|(_, at)| at.y % 2.0 < 1.0 && at.x % 8.0 < 1.0)
            .filter(|(_, at)| {
                let ray = from_south.ray_in_world(*at);
                cast(from_south.eye_in_world(), ray, &mesh).is_some_and(|depth_m| {
                    let ground = from_south.eye_in_world() + ray * depth_m;
                    plan_distance_m(ground.truncate(), &tile.2) <= 15.0
                })
            });
        assert_eq!(visible.count(), 0, "the scene hides its road");
        assert_eq!(drawing.pixels_of(0).len(), 0, "pitch {pitch_deg}");
        let from_north = camera(200.0, 3000.0, 180.0, pitch_deg);
        let drawing = draw(&gpu, &from_north, &plain_style(30.0), std::slice::from_ref(&tile));
        let seen = drawing.pixels_of(0).len();
        assert!(seen > 500, "{seen} pixels: and is there, seen from the other side");
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
        // A pixel's breadth of slack at the silhouette, where the centre's ray may pass over the crest.
        let on_road = [0.0, 0.5, 1.0].iter().any(|down_px| {
            let ray = camera.ray_in_world(at + DVec2::new(0.0, *down_px));
            cast(camera.eye_in_world(), ray, &mesh).is_some_and(|depth_m| {
                let ground = camera.eye_in_world() + ray * depth_m;
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
        // The centre-line itself must be drawn wherever it is in view: that is what GEO promises.
        assert_eq!(hidden_centerline_points(&drawing, &camera, &tile), 0);
        // Flat quads on cross slopes: a measurement, with a bound that notices a change for the worse.
        assert!((found.missing as f64) < 0.1 * found.covered as f64);
    }
}

/// Points every 2 m along the centre-lines that the depth buffer says are in view, but whose pixel has no road.
fn hidden_centerline_points(
    drawing: &support::Drawing,
    camera: &Camera,
    tile: &SceneTile,
) -> usize {
    let mut hidden = 0;
    for pair in tile.2.iter().flat_map(|line| line.points_m.windows(2)) {
        let (a, b) = (DVec3::from_array(pair[0]), DVec3::from_array(pair[1]));
        let steps = (a.distance(b) / 2.0).ceil();
        for k in 0..steps as u32 {
            let Some((at, depth_m)) = camera.project(a.lerp(b, f64::from(k) / steps)) else {
                continue;
            };
            if at.cmplt(DVec2::ZERO).any()
                || at.x >= f64::from(SIZE[0])
                || at.y >= f64::from(SIZE[1])
            {
                continue;
            }
            let index = at.y as usize * SIZE[0] as usize + at.x as usize;
            let ground_m = camera.near_m() / f64::from(drawing.depth[index]);
            // Half a pixel beside the line, the ground is this much nearer or farther at a grazing angle.
            let in_view = (ground_m - depth_m).abs() < 0.02 * depth_m;
            hidden +=
                usize::from(in_view && !drawing.is_at_jump(index) && drawing.labels[index] == 0);
        }
    }
    hidden
}

#[test]
fn more_important_roads_lie_above_across_tiles() {
    let Some(gpu) = gpu() else { return };
    // Two tiles of the finer level side by side; their roads meet on the border, wide enough to overlap.
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
            assert_eq!(label / 2, 9 - 1, "label {label} at {offset} px from the junction");
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
    style.roads[0].center =
        Some(corniche_viewer::style::CenterLine { width_share: 0.3, color: [1.0, 1.0, 0.0] });
    let camera = camera(50.0, 900.0, 0.0, 0.0);
    let drawing = draw(&gpu, &camera, &style, &[tile]);
    for share in [0.2, 0.6, 1.0] {
        for end in [[-300.0, -200.0], [300.0, -150.0]] {
            let point = center() + DVec2::from_array(end) * (1.0 - share);
            let (at, _) = camera.project(point.extend(50.0)).unwrap();
            let label = drawing.labels[at.y as usize * SIZE[0] as usize + at.x as usize];
            assert_eq!(label, 19, "class 0 and its centre line at {at}");
        }
    }
}

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
    let style = corniche_viewer::style::Style::road_atlas();
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
            let Some(truth_m) = cast(camera.eye_in_world(), ray, &stretched) else {
                missing += usize::from(drawing.depth[index] != 0.0);
                continue;
            };
            if drawing.depth[index] == 0.0 {
                missing += 1;
                continue;
            }
            let drawn_m = camera.near_m() / f64::from(drawing.depth[index]);
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
    // One coarse tile's western half is replaced by two fine ones of a ground that differs by up to 20 m.
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
        let skirts = drawing.ground.chunks_exact(4).filter(|pixel| pixel[3] == 128).count();
        // Below the middle of the picture there is ground everywhere.
        let below = (SIZE[0] * SIZE[1] / 2) as usize;
        (drawing.depth[below..].iter().filter(|depth| **depth == 0.0).count(), skirts)
    };
    assert_eq!(holes(40.0).0, 0);
    assert!(holes(40.0).1 > 50, "skirts are marked");
    assert!(holes(0.0).1 == 0, "without depth they are not there");
}
