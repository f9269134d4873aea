//! Gates and figures: shadow volumes agree with both references; the disagreement of geometry is
//! measured.

use corniche_geom::TileId;
use corniche_styles::{Style, WidthScaling};
use corniche_testing::some_of;
use corniche_viewer::{
    CapTest, Caps, PackageLooks, RoadMethod, RoadOptions, WidthGrowth,
    camera::{Camera, Orientation},
    for_tests::{class_of, may_be_clamped, settle},
    lod::Quality,
    tiles::{LoadTileError, TileStore},
};
use glam::{DVec2, DVec3};

use super::{
    ground_rays,
    measures::{self, CenterLines},
    reference::{Comparison, DepthOracle},
    support::{
        World,
        country::{Country, QUANTUM_M},
        gpu,
        scene::{Scene, Tile},
        scenes::{self, Named, four_tiles, one_tile, style},
        within,
    },
};

pub(crate) const METHODS: [RoadMethod; 2] = [RoadMethod::Geometry, RoadMethod::ShadowVolumes];

pub(crate) fn name_of(method: RoadMethod) -> &'static str {
    match method {
        RoadMethod::Geometry => "GEO",
        RoadMethod::ShadowVolumes => "SV",
        RoadMethod::None => "none",
    }
}

fn print_row(
    name: &str,
    method: RoadMethod,
    found: &Comparison,
    rays: Option<(usize, usize)>,
    lines: CenterLines,
) {
    let rays = rays.map_or("-".to_owned(), |(compared, wrong)| format!("{wrong} of {compared}"));
    println!(
        "{name:34} {:4} {:>7} compared, {:>6} wrong ({:5.2} %), {:>5} in band, {:>5} at jumps | O2 {rays:>14} | missing {:5.1} + {:4.1} at jumps of {:6.1} px",
        name_of(method),
        found.compared,
        found.wrong,
        100.0 * found.wrong as f64 / found.compared.max(1) as f64,
        found.in_band,
        found.at_jumps,
        lines.missing_px,
        lines.missing_at_jumps_px,
        lines.seen_px,
    );
}

/// Draws a scene from its cameras with both methods, prints the figures and checks both against
/// their gates.
pub(crate) fn check(named: &Named) {
    let Some(gpu) = gpu() else { return };
    let Named { name, scene, cameras } = named;
    let is_plain = scene.style.roads.iter().all(|road| road.min_width_px == 0.0);
    let has_bands = scene.style.roads.iter().any(|road| road.bands.all().len() > 1);
    for method in METHODS {
        let options = RoadOptions::for_method(method);
        for camera in cameras {
            let drawing = scene.draw(&gpu, camera, options);
            let found =
                DepthOracle { scene, camera, options, drawing: &drawing, band_px: 0.05 }.compare();
            // The second reference supports neither minimum widths nor bands.
            let rays = (is_plain && !has_bands)
                .then(|| ground_rays::compare(scene, camera, options, &drawing));
            let lines = measures::center_lines(scene, camera, &drawing);
            print_row(name, method, &found, rays, lines);
            assert!(
                found.compared > 100,
                "{name}: {} pixels are too few for a test",
                found.compared
            );
            if method == RoadMethod::Geometry {
                let most = 0.003 * found.compared as f64;
                assert!(
                    found.wrong as f64 <= most,
                    "{name}: {} of {}",
                    found.wrong,
                    found.compared
                );
            } else {
                assert_eq!(found.wrong, 0, "{name}: of {}", found.compared);
                let (compared, wrong) = rays.unwrap_or_default();
                assert!(
                    wrong as f64 <= 1e-4 * compared as f64,
                    "{name}: {wrong} of {compared} by rays"
                );
                // Two pixels are allowed for lines of a hundred pixels, because a road may be
                // narrower than a pixel's diagonal.
                assert!(lines.missing_px <= 0.001 * lines.seen_px + 2.0, "{name}: {lines:?}");
            }
        }
    }
}

/// Each test checks a few scenes, so that none takes long.
fn check_named(names: &[&str]) {
    let all = scenes::all();
    for name in names {
        check(all.iter().find(|named| named.name == *name).expect("a scene of this name"));
    }
}

/// Cells like those of a geographic DEM at 48° N.
const OBLONG: World = World { ratio: 1.5, scale: [1.0; 2] };
/// The same cells where working metres are not true metres, especially along one axis.
const DISTORTED: World = World { ratio: 1.5, scale: [1.3, 0.8] };

#[test]
fn both_methods_agree_with_the_references_on_oblong_cells() {
    for named in some_of(within(OBLONG, scenes::all), [8, 4, 1]) {
        check(&named);
    }
}

#[test]
fn both_methods_agree_with_the_references_where_widths_depend_on_the_direction() {
    // The road "as wide as its margin" would be wider than its margin here.
    for named in some_of(within(DISTORTED, scenes::all), [8, 4, 1]) {
        if named.name != "as wide as its margin" {
            check(&named);
        }
    }
}

#[test]
#[ignore = "slow: four pictures of a country, each pixel by two references"]
fn both_methods_agree_with_the_reference_where_levels_of_oblong_cells_meet() {
    within(OBLONG, volumes_agree_with_the_reference_where_levels_meet);
}

#[test]
fn volumes_agree_with_both_references_on_planes() {
    check_named(&["plane", "plane at 45°", "as wide as its margin"]);
}

#[test]
fn volumes_agree_with_both_references_on_ridges_and_cliffs() {
    check_named(&["ridge", "staircase cliff", "eye inside a box"]);
}

#[test]
fn volumes_agree_with_both_references_across_tiles() {
    check_named(&["sine hills, four tiles"]);
}

#[test]
fn volumes_agree_with_the_reference_at_junctions() {
    check_named(&["junction of 4 classes", "junction, atlas style, far"]);
}

#[test]
fn both_methods_agree_with_both_references_where_roads_end_flat() {
    check_named(&["roads that go on as others"]);
}

/// Beyond the end of the more important of two consecutive roads, within the radius of its cap, the
/// other road is drawn.
#[test]
fn no_cap_lies_on_a_road_that_goes_on() {
    let Some(gpu) = gpu() else { return };
    let camera = scenes::camera(0.0, 600.0, 0.0, 0.0);
    let on = |other: [f64; 2]| {
        let roads = [(1, vec![[-300.0, 0.0], [0.0, 0.0]]), (4, vec![[0.0, 0.0], other])];
        let scene = one_tile(256, |_, _| 0.0, &roads, style(60.0));
        METHODS.map(|method| {
            let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(method));
            let at = scenes::center() + DVec2::new(15.0, 0.0);
            let (at, _) = camera.project(at.extend(0.0)).unwrap();
            class_of(drawing.labels[at.y as usize * scenes::SIZE[0] as usize + at.x as usize])
        })
    };
    assert_eq!(on([300.0, 20.0]), [Some(4); 2]);
    assert_eq!(on([100.0, 300.0]), [Some(1); 2], "where the road turns, the cap stays");
}

#[test]
fn both_methods_agree_with_the_reference_on_roads_of_many_bands() {
    check_named(&["junction of many bands"]);
}

#[test]
fn both_methods_agree_with_the_reference_on_roads_of_their_own_width() {
    check_named(&["junction of own widths", "own widths, atlas style, far"]);
}

#[test]
fn volumes_agree_with_both_references_at_bends_edges_and_vertices() {
    check_named(&["hairpin and points", "along an edge, through vertices"]);
}

/// Returns a scene of the country's tiles that are selected for a camera.
pub(crate) fn country_scene(
    country: &Country,
    camera: &Camera,
    error_px: f64,
    style: Style,
) -> Scene {
    let mut store = TileStore::new(country);
    let quality = Quality::by_error(error_px, 1.0);
    let drawn = settle(&mut store, camera, quality, || Ok::<_, LoadTileError>(())).unwrap();
    let tiles = drawn
        .iter()
        .map(|drawn| {
            let payload = country.payload(drawn.id);
            let widths = country.widths(drawn.id);
            Tile::of_payload(&payload, &country.frame, QUANTUM_M, widths, drawn.skirt_depth_m)
        })
        .collect();
    Scene { tiles, style, layers: PackageLooks::default() }
}

fn country_camera(country: &Country, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    let [x, y] = country.frame.tile_bounds(TileId::ROOT).center();
    let target = DVec3::new(x, y, crate::support::country::height_m(x, y));
    Camera::look_at(target, distance_m, Orientation { heading_deg, pitch_deg }, scenes::SIZE)
}

fn levels(scene: &Scene) -> usize {
    let mut levels: Vec<_> = scene.tiles.iter().map(|tile| tile.geometry.id.z()).collect();
    levels.dedup();
    levels.len()
}

#[test]
#[ignore = "slow: four pictures of a country, each pixel by two references"]
fn volumes_agree_with_the_reference_where_levels_meet() {
    let country = Country::new();
    let views = [(6000.0, 10.0, 55.0, 1.5), (9000.0, 90.0, 70.0, 6.0)];
    for (distance_m, heading_deg, pitch_deg, error_px) in some_of(views, [2, 2, 1]) {
        let camera = country_camera(&country, distance_m, heading_deg, pitch_deg);
        let by_class = country_scene(&country, &camera, error_px, Style::road_atlas());
        assert!(levels(&by_class) > 1);
        let own = Scene { style: scenes::by_own_widths(&by_class.style), ..by_class.clone() };
        for (name, scene) in
            [("mountains, several levels", by_class), ("the same with own widths", own)]
        {
            check(&Named { name, scene, cameras: vec![camera] });
        }
    }
}

/// The share of wrong pixels of shadow volumes with these options, on hills with a junction.
fn wrong_share(options: RoadOptions, style: Style) -> Option<f64> {
    let gpu = gpu()?;
    let scene = one_tile(16, scenes::hills, &scenes::junction(), style);
    let camera = scenes::camera(400.0, 1800.0, 100.0, 55.0);
    let drawing = scene.draw(&gpu, &camera, options);
    let oracle =
        DepthOracle { scene: &scene, camera: &camera, options, drawing: &drawing, band_px: 0.05 };
    let found = oracle.compare();
    println!("{options:?}: {} of {} wrong", found.wrong, found.compared);
    assert!(found.compared > 500);
    Some(found.wrong as f64 / found.compared as f64)
}

#[test]
fn volumes_agree_with_the_reference_whatever_the_options() {
    let scaling = WidthScaling { threshold_m: 600.0, exponent: 0.6, constant: 1.7 };
    let style = Style { width_scaling: scaling, ..style(24.0) };
    let of_volumes = RoadOptions::for_method(RoadMethod::ShadowVolumes);
    for width_growth in [WidthGrowth::None, WidthGrowth::Constant, WidthGrowth::ByDistance] {
        for caps in [Caps::Round, Caps::None] {
            let options = RoadOptions { width_growth, caps, ..of_volumes };
            let Some(wrong) = wrong_share(options, style.clone()) else { return };
            assert!(wrong.abs() < f64::EPSILON, "{options:?}");
        }
    }
}

#[test]
fn volumes_wider_than_their_margin_are_cut_to_it_and_counted() {
    let Some(gpu) = gpu() else { return };
    let roads = [(3, vec![[-700.0, -310.0], [650.0, 420.0]])];
    // One and a half times as wide as the margin of 80 m allows.
    let scene = four_tiles([64; 4], |_, _| 300.0, &roads, style(240.0));
    let camera = scenes::camera(300.0, 4000.0, 15.0, 30.0);
    let options = RoadOptions::for_method(RoadMethod::ShadowVolumes);
    let drawing = scene.draw(&gpu, &camera, options);
    let oracle =
        DepthOracle { scene: &scene, camera: &camera, options, drawing: &drawing, band_px: 0.05 };
    let found = oracle.compare();
    assert!(found.compared > 1000);
    assert_eq!(found.wrong, 0);
    let clamped = |style: &Style, method| {
        let view = Scene::view(&camera, style, RoadOptions::for_method(method));
        scene.tiles.iter().filter(|tile| may_be_clamped(&tile.geometry, &view)).count()
    };
    assert_eq!(clamped(&style(240.0), RoadMethod::ShadowVolumes), 4, "the road is near all");
    assert_eq!(clamped(&style(159.0), RoadMethod::ShadowVolumes), 0);
    assert_eq!(clamped(&style(240.0), RoadMethod::Geometry), 3, "the road is on three of them");
    assert_eq!(clamped(&style(240.0), RoadMethod::None), 0);
}

#[test]
fn the_papers_test_agrees_with_the_reference_near_the_eye() {
    for caps in [Caps::Round, Caps::None] {
        let options = RoadOptions {
            cap_test: CapTest::PaperQuadratic,
            caps,
            ..RoadOptions::for_method(RoadMethod::ShadowVolumes)
        };
        let Some(wrong) = wrong_share(options, style(40.0)) else { return };
        assert!(wrong < 0.005, "{wrong}");
    }
}
