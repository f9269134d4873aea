//! Classes by scale: which classes are drawn, how they fade, which are submitted; slip roads and
//! tunnels.

use corniche_styles::{RoadBands, RoadStyle, Style, WidthScaling};
use corniche_viewer::{
    RoadOptions,
    camera::Camera,
    gpu::{DrawTile, TileBuffers},
    tiles::RoadLook,
};

use super::{
    agreement::{METHODS, check, name_of},
    reference::DepthOracle,
    support::{
        Drawing, bands, gpu,
        scene::Scene,
        scenes::{Named, Road, camera, hills, junction, one_tile, style},
    },
};
use crate::labels::{road_label, service_label, tunnel_label};

/// The ground that a pixel covers at a distance.
fn pixel_m(camera: &Camera, distance_m: f64) -> f32 {
    (camera.pixel_at_unit_depth_m() * distance_m) as f32
}

/// A junction seen at a slant. Classes 2, 4 and 6 end at three distances, and widths grow up to a
/// few pixels.
fn fading() -> (Scene, Camera) {
    let view = camera(400.0, 1300.0, 30.0, 62.0);
    let mut style = Style {
        width_scaling: WidthScaling { threshold_m: 300.0, exponent: 0.75, constant: 1.0 },
        ..style(9.0)
    };
    for (class, distance_m) in [(2, 1000.0), (4, 850.0), (6, 900.0)] {
        style.roads[class].max_pixel_m = Some(pixel_m(&view, distance_m));
    }
    for (road, max_width_px) in style.roads.iter_mut().zip([9.0, 8.0, 11.0, 8.0, 12.0, 8.0, 7.0]) {
        road.max_width_px = Some(max_width_px);
    }
    (one_tile(8, hills, &junction(), style), view)
}

#[test]
fn both_methods_agree_with_the_references_where_classes_end_and_widths_stop_growing() {
    let (scene, camera) = fading();
    check(&Named { name: "classes by scale", scene, cameras: vec![camera] });
}

/// The same gate fails if the picture uses another scale or another cap of widths.
#[test]
fn other_scales_and_caps_fail() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = fading();
    for method in METHODS {
        let options = RoadOptions::for_method(method);
        let wrong_of = |change: &dyn Fn(&mut RoadStyle)| {
            let mut other = scene.clone();
            other.style.roads.iter_mut().for_each(change);
            let drawing = other.draw(&gpu, &camera, options);
            let (scene, drawing) = (&scene, &drawing);
            DepthOracle { scene, camera: &camera, options, drawing, band_px: 0.05 }.compare().wrong
        };
        let at_every_scale = wrong_of(&|road| road.max_pixel_m = None);
        let a_little_later =
            wrong_of(&|road| road.max_pixel_m = road.max_pixel_m.map(|pixel_m| pixel_m * 1.05));
        let without_cap = wrong_of(&|road| road.max_width_px = None);
        println!("{}: {at_every_scale}, {a_little_later}, {without_cap}", name_of(method));
        assert!(at_every_scale > 200 && a_little_later > 20 && without_cap > 200);
    }
}

/// Share of a class's colour where a pixel covers `pixel_m` true metres: 1 up to its scale, 0 half
/// a zoom step later, and linear in the zoom between them.
fn shown_share(max_pixel_m: f32, pixel_m: f64) -> f64 {
    (1.0 - 2.0 * (pixel_m / f64::from(max_pixel_m)).log2()).clamp(0.0, 1.0)
}

/// On flat ground seen from straight above, the colour in the middle of a road is a mix of the
/// ground's and the road's colour, with the share from the style, opacity included.
#[test]
fn the_colour_of_a_fading_class_follows_its_closed_form() {
    let Some(gpu) = gpu() else { return };
    let black = RoadStyle { bands: RoadBands::one([0.0; 3]), ..style(60.0).roads[5] };
    let mut style = Style { roads: [black; 9], outline_px: 0, haze_reach: 1000.0, ..style(60.0) };
    let road: Road = (5, vec![[-900.0, 0.0], [900.0, 0.0]]);
    let scale_m = 3.0_f32;
    style.roads[5].max_pixel_m = Some(scale_m);
    style.roads[5].opacity = 0.8;
    let scene = one_tile(256, |_, _| 0.0, &[road], style);
    for method in METHODS {
        for zoom_steps in [-0.5, 0.0, 0.1, 0.25, 0.4, 0.49, 0.6_f64] {
            let unit = camera(0.0, 1.0, 0.0, 0.0).pixel_at_unit_depth_m();
            let distance_m = f64::from(scale_m) * zoom_steps.exp2() / unit;
            let view = camera(0.0, distance_m, 0.0, 0.0);
            let draw = |options| scene.draw(&gpu, &view, options).picture;
            let [drawn, bare] = [
                RoadOptions::for_method(method),
                RoadOptions::for_method(corniche_viewer::RoadMethod::None),
            ]
            .map(draw);
            let middle = (view.size_px[1] / 2 * view.size_px[0] + view.size_px[0] / 2) * 4;
            let [drawn, bare] = [drawn, bare].map(|rgba| f64::from(rgba[middle as usize + 1]));
            let share = 1.0 - drawn / bare;
            let expected = 0.8 * shown_share(scale_m, f64::from(scale_m) * zoom_steps.exp2());
            assert!((share - expected).abs() < 0.01, "{zoom_steps}: {share} for {expected}");
        }
    }
}

/// From nearby all segments are submitted; where a class has faded out, none of it is submitted.
#[test]
fn what_has_faded_away_is_not_submitted() {
    let Some(gpu) = gpu() else { return };
    let mut style = style(20.0);
    style.roads[5].max_pixel_m = Some(1.0);
    let roads: Vec<Road> =
        vec![(1, vec![[-900.0, 50.0], [900.0, 50.0]]), (5, vec![[-900.0, 0.0], [900.0, 0.0]])];
    let scene = one_tile(256, |_, _| 0.0, &roads, style);
    let buffers = TileBuffers::new(&gpu, &scene.tiles[0].geometry, None);
    for method in METHODS {
        let segments = |distance_m| {
            let camera = camera(0.0, distance_m, 0.0, 0.0);
            let view = Scene::view(&camera, &scene.style, RoadOptions::for_method(method));
            DrawTile { buffers: &buffers, skirt_depth_m: 0.0 }.road_segments(&view)
        };
        let gone_m = 2.0_f64.sqrt() / camera(0.0, 1.0, 0.0, 0.0).pixel_at_unit_depth_m();
        // The tile's roads may paint ground of its neighbours that is this much nearer.
        let margin_m = 2.0 * scene.tiles[0].geometry.width_margin_m;
        let all = segments(100.0);
        assert_eq!(segments(gone_m + margin_m - 1.0), all);
        let left = segments(gone_m + margin_m + 1.0);
        assert!(left > 0 && left < all, "{left} of {all}");
    }
}

/// A scene of one straight road of class 1 with a centre line and this look, on flat ground.
fn one_road(look: RoadLook) -> Scene {
    let mut style = style(60.0);
    style.roads[1].bands = bands(&[1.0, 0.7, 0.4]);
    let roads: Vec<Road> =
        vec![(1, vec![[-900.0, 0.0], [900.0, 0.0]]), (6, vec![[0.0, -900.0], [0.0, 900.0]])];
    let scene = one_tile(256, |_, _| 0.0, &roads, style);
    let of_way = |way_id| if way_id == 1 { look } else { RoadLook::Plain };
    Scene { tiles: scene.tiles.iter().map(|tile| tile.with_looks(of_way)).collect(), ..scene }
}

/// The labels of a column of pixels at this offset to the right of the middle, or of the row
/// through the middle.
fn labels(drawing: &Drawing, column_of: Option<usize>) -> Vec<u8> {
    let [width, height] = drawing.size_px.map(|side| side as usize);
    match column_of {
        Some(right) => (0..height).map(|y| drawing.labels[y * width + width / 2 + right]).collect(),
        None => drawing.labels[height / 2 * width..][..width].to_vec(),
    }
}

/// Tunnels with bends, one above the other, and slip roads: both methods have the dashes where the
/// reference expects them, and the length continues at bends.
#[test]
fn dashes_go_on_at_bends_in_both_methods() {
    let bent =
        vec![[-500.0, -200.0], [-180.0, -90.0], [-150.0, 60.0], [90.0, 130.0], [420.0, -60.0]];
    let roads: Vec<Road> = vec![
        (1, bent),
        (4, vec![[-300.0, 250.0], [-20.0, -15.0], [200.0, -260.0]]),
        (4, vec![[-450.0, 100.0], [300.0, 300.0]]),
        (6, vec![[60.0, -300.0], [-60.0, 320.0]]),
    ];
    let mut style = style(30.0);
    for road in &mut style.roads {
        road.min_width_px = 3.0;
    }
    style.roads[4].bands = bands(&[1.0, 0.6, 0.3]);
    for road in &mut style.roads {
        road.carriageway_width_m = 12.0;
    }
    let scene = one_tile(16, hills, &roads, style);
    let looks =
        [RoadLook::Tunnel, RoadLook::CarriagewayTunnel, RoadLook::Link, RoadLook::Carriageway];
    let of_way = |way_id: i64| looks[way_id as usize - 1];
    let tiles = scene.tiles.iter().map(|tile| tile.with_looks(of_way)).collect();
    check(&Named {
        name: "tunnels with bends, slip roads, carriageways",
        scene: Scene { tiles, ..scene },
        cameras: vec![camera(400.0, 1100.0, 15.0, 20.0), camera(400.0, 1700.0, 250.0, 55.0)],
    });
}

/// Service roads are narrower than the rest of their class, have one colour, are below all other
/// roads, and appear one zoom step later.
#[test]
fn service_roads_come_later_and_lie_under_all_other_roads() {
    let roads: Vec<Road> = vec![
        (7, vec![[-600.0, -40.0], [-50.0, 10.0], [600.0, 60.0]]),
        (8, vec![[0.0, -500.0], [150.0, 500.0]]),
        (7, vec![[-300.0, 450.0], [-300.0, -450.0]]),
        (5, vec![[250.0, 450.0], [300.0, -450.0]]),
    ];
    let view = camera(400.0, 1300.0, 30.0, 55.0);
    let mut style = style(20.0);
    for road in &mut style.roads {
        road.min_width_px = 2.0;
    }
    style.roads[7].bands = bands(&[1.0, 0.6, 0.3]);
    // The picture contains both the end of service roads and the end of the other roads.
    style.roads[7].max_pixel_m = Some(pixel_m(&view, 1750.0));
    let looks = [RoadLook::Service, RoadLook::Plain, RoadLook::Plain, RoadLook::Plain];
    let scene = one_tile(16, hills, &roads, style);
    let of_way = |way_id: i64| looks[way_id as usize - 1];
    let tiles = scene.tiles.iter().map(|tile| tile.with_looks(of_way)).collect();
    let scene = Scene { tiles, ..scene };
    check(&Named { name: "service roads", scene: scene.clone(), cameras: vec![view] });
    let Some(gpu) = gpu() else { return };
    for method in METHODS {
        let drawing = scene.draw(&gpu, &view, RoadOptions::for_method(method));
        let count =
            |label| drawing.pixels().filter(|(index, _)| drawing.labels[*index] == label).count();
        assert!(count(service_label(7)) > 300 && count(road_label(7, 2)) > 300);
    }
}

#[test]
fn slip_roads_are_narrower_and_lack_narrow_bands() {
    let Some(gpu) = gpu() else { return };
    let view = camera(0.0, 500.0, 0.0, 0.0);
    let true_px = 60.0 / f64::from(pixel_m(&view, 500.0));
    for method in METHODS {
        let column = |look| {
            labels(&one_road(look).draw(&gpu, &view, RoadOptions::for_method(method)), Some(100))
        };
        let count = |labels: &[u8], label: u8| {
            labels.iter().map(|found| usize::from(*found == label)).sum::<usize>()
        };
        let (plain, link) = (column(RoadLook::Plain), column(RoadLook::Link));
        let [outer, middle, inner] = [0, 1, 2].map(|band| road_label(1, band));
        for (labels, label, share) in [
            (&plain, outer, 0.3),
            (&plain, middle, 0.3),
            (&plain, inner, 0.4),
            (&link, outer, 0.6 * 0.3),
            (&link, middle, 0.6 * 0.7),
        ] {
            let found = count(labels, label) as f64;
            // A band of which both sides are seen has two edges that fall between pixels.
            assert!(
                (found - share * true_px).abs() <= 2.0,
                "{}: {found} of {share}",
                name_of(method)
            );
        }
        assert_eq!(count(&link, inner), 0, "a slip road has no line along its middle");
    }
}

/// Half of a tunnel's length is dashes, as long as the gaps. Both methods have dashes at the same
/// positions, and even the least important road on the ground hides a tunnel.
#[test]
fn tunnels_have_dashes_and_lie_under_every_road() {
    let Some(gpu) = gpu() else { return };
    let view = camera(0.0, 1000.0, 0.0, 0.0);
    let period_m = (12.0 * f64::from(pixel_m(&view, 1000.0))).log2().ceil().exp2();
    let rows = METHODS.map(|method| {
        labels(&one_road(RoadLook::Tunnel).draw(&gpu, &view, RoadOptions::for_method(method)), None)
    });
    assert_eq!(rows[0], rows[1]);
    let row = &rows[0];
    let minor = road_label(6, 0);
    let crossing = row.iter().map(|label| u32::from(*label == minor)).sum::<u32>();
    let crossing = f64::from(crossing);
    assert!((crossing * f64::from(pixel_m(&view, 1000.0)) - 60.0).abs() < 3.0, "{crossing} px");
    let possible = [minor, tunnel_label(1, false), tunnel_label(1, true)];
    assert!(row.iter().all(|label| possible.contains(label)));
    // Next to the crossing, where a dash begins and where it ends.
    let beside = &row[row.len() / 2 + 40..];
    let changes: Vec<usize> =
        (1..beside.len()).filter(|at| beside[*at] != beside[*at - 1]).collect();
    assert!(changes.len() > 6, "{changes:?}");
    let half_px = period_m / 2.0 / f64::from(pixel_m(&view, 1000.0));
    for pair in changes.windows(2) {
        assert!(((pair[1] - pair[0]) as f64 - half_px).abs() <= 1.0, "{changes:?}, {half_px}");
    }
    // A dash begins at a whole number of periods from the start of the road.
    let x_m = |pixel: usize| {
        let px = (row.len() / 2 + 40 + pixel) as f64 - row.len() as f64 / 2.0;
        900.0 + px * f64::from(pixel_m(&view, 1000.0))
    };
    let start = changes.iter().find(|at| beside[**at] & 1 == 1).copied().unwrap();
    let off = (x_m(start) / period_m).rem_euclid(1.0);
    let off_px = off.min(1.0 - off) * 2.0 * half_px;
    assert!(off_px <= 1.0, "{off_px} px from {} with {period_m}", x_m(start));
}
