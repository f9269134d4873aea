//! A legend lists the visible features, in the order of their importance, as they are drawn.

use corniche_layers::LayerGeometry;
use corniche_styles::Style;
use glam::DVec2;

use super::*;
use crate::{
    camera::Camera,
    layer_class::LayerClass,
    layers::{
        PackageLooks, ShownLayers,
        tests::{built_in, class, own, package},
    },
    options::{ClassSet, RoadMethod, RoadOptions},
};

fn camera(pixel_m: f64) -> Camera {
    Camera::from_above(DVec2::ZERO, pixel_m, 0.0, [0.0, 1000.0], [200, 100])
}

fn view<'a>(camera: &'a Camera, style: &'a Style) -> FrameView<'a> {
    FrameView {
        camera,
        style,
        layers: PackageLooks::NONE,
        roads: RoadOptions::for_method(RoadMethod::ShadowVolumes),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [0.0, 1000.0],
        wall_m: 0.0,
        cell_px: 2.0,
        latitude_deg: 47.0,
        is_wireframe: false,
    }
}

fn classes(numbers: &[u8]) -> ClassSet {
    FunctionalRoadClass::all().filter(|class| numbers.contains(&class.number())).collect()
}

fn labels() -> LegendRequest {
    let names = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight"];
    LegendRequest { road_labels: names.map(str::to_owned), scale: Some(10_000) }
}

fn is_near(one: Rgb, other: Rgb) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6)
}

/// A package with areas, lines and points.
fn manifest() -> Manifest {
    let tables = [built_in("areas"), built_in("boundaries"), own("trees", LayerGeometry::Point, 1)];
    package(tables.map(|table| (table, Vec::new())).into())
}

fn looks(style: &Style) -> PackageLooks {
    PackageLooks::new(&manifest(), style, &ShownLayers::ALL)
}

fn seen() -> ShownTiles {
    let layers = [class(2, 0), class(1, 0), class(1, 7), class(0, 2), class(0, 3), class(0, 5)];
    ShownTiles {
        roads: classes(&[3, 0]),
        tunnels: classes(&[3]),
        layers: layers.map(|class| SeenClass { class, height_m: Some(500.0) }).into(),
        heights_m: Some([100.0, 900.0]),
    }
}

fn told(view: &FrameView<'_>, seen: &ShownTiles, has_tint: bool) -> Legend {
    legend(view, (&labels(), &manifest()), seen, has_tint)
}

#[test]
fn roads_come_first_then_tunnels_and_layers_from_the_highest() {
    let (camera, style) = (camera(1.0), Style::road_atlas());
    let layers = looks(&style);
    let view = FrameView { layers: &layers, ..view(&camera, &style) };
    let all = told(&view, &seen(), true);
    let names: Vec<&str> = all.rows.iter().map(|row| row.label.as_str()).collect();
    // Sea and water have the same colour. The layer of trees has no titles.
    let expected = [
        "zero",
        "three",
        "tunnel",
        "class-0",
        "Country border",
        "Protected area",
        "Sea, Water",
        "Forest",
    ];
    assert_eq!(names, expected);
    assert_eq!(all.scale, Some(10_000));
    assert!((all.pixel_m - 1.0).abs() < 1e-9 && all.north_deg.abs() < 1e-9);
}

#[test]
fn nothing_is_listed_of_a_picture_that_shows_nothing() {
    let (camera, style) = (camera(1.0), Style::road_atlas());
    let none = ShownTiles {
        roads: ClassSet::NONE,
        tunnels: ClassSet::NONE,
        layers: Vec::new(),
        heights_m: None,
    };
    let told = told(&view(&camera, &style), &none, true);
    assert!(told.rows.is_empty() && told.heights.is_none());
}

/// At one metre per pixel, a motorway of 24 m is 24 pixels wide, and has all bands and its edge.
#[test]
fn near_roads_have_their_true_width() {
    let (camera, mut style) = (camera(1.0), Style::road_atlas());
    (style.roads[0].width_m, style.roads[0].edge_max_pixel_m) = (24.0, None);
    let road = road(&view(&camera, &style), FunctionalRoadClass::new(0).unwrap());
    assert!((road.width_px - 24.0).abs() < 1e-3, "{}", road.width_px);
    let of_style = &style.roads[0];
    assert_eq!(road.bands.len(), of_style.bands.all().len());
    for (band, known) in road.bands.iter().zip(of_style.bands.all()) {
        assert!(band.width_share == known.width_share && is_near(band.color, known.color));
    }
    let edge = road.edge.unwrap();
    assert!(edge.width_px == 1 && is_near(edge.color, of_style.outline), "{edge:?}");
}

/// A road that is thinner than a pixel has one colour and no edge.
#[test]
fn thin_roads_look_as_they_are_drawn() {
    let (camera, mut style) = (camera(1.0), Style::road_atlas());
    let class = FunctionalRoadClass::new(6).unwrap();
    let thin = [0.3, 0.2, 0.1];
    let mut of_class = style.roads[6];
    (of_class.width_m, of_class.min_width_px, of_class.thin) = (0.9, 0.9, Some(thin));
    style.roads[6] = of_class;
    let road = road(&view(&camera, &style), class);
    assert_eq!(road.edge, None);
    assert_eq!(road.bands.len(), 1);
    assert!(is_near(road.bands[0].color, thin));
}

#[test]
fn heights_are_told_where_colours_tell_them() {
    let (camera, mut style) = (camera(1.0), Style::road_atlas());
    let heights_of =
        |style: &Style, has_tint| told(&view(&camera, style), &seen(), has_tint).heights;
    let told = heights_of(&style, true).unwrap();
    assert_eq!(told.range_m, [100.0, 900.0]);
    assert_eq!(told.colors.len(), RAMP_COLORS);
    let at = |height_m| tint(&view(&camera, &style), height_m);
    // The colours of the middles of 64 steps of 12.5 m.
    assert_eq!([told.colors[0], told.colors[63]], [at(106.25), at(893.75)]);
    assert_eq!(heights_of(&style, false), None);
    for stop in &mut style.tint.stops {
        stop.1 = [0.5; 3];
    }
    assert_eq!(heights_of(&style, true), None);
}

/// A translucent colour is mixed with the ground on which the area is visible.
#[test]
fn areas_have_the_colour_over_their_own_ground() {
    let (camera, style) = (camera(1.0), Style::road_atlas());
    let layers = looks(&style);
    let view = FrameView { layers: &layers, ..view(&camera, &style) };
    for height_m in [0.0, 900.0] {
        let meadow: LayerClass = class(0, 5);
        let row = layer_sample(&view, &SeenClass { class: meadow, height_m: Some(height_m) });
        let AreaStyle { color, opacity, .. } = layers.area(meadow).unwrap();
        assert!(opacity < 1.0);
        let expected = mix(tint(&view, height_m), color, opacity);
        assert_eq!(row, Some(LegendSample::Area(expected)));
    }
}

/// At the limit the whole edge is drawn, at twice as many metres per pixel nothing, and between
/// them a part of it.
#[test]
fn edges_go_within_a_zoom_step() {
    let style = Style::road_atlas();
    let road = RoadStyle { edge_max_pixel_m: Some(10.0), ..style.roads[5] };
    for (pixel_m, expected) in
        [(1.0, 1.0), (10.0, 1.0), (10.0 * 2.0_f64.sqrt(), 0.5), (20.0, 0.0), (50.0, 0.0)]
    {
        let camera = camera(pixel_m);
        let share = edge_share(&view(&camera, &style), &road);
        assert!((share - expected).abs() < 1e-5, "{pixel_m}: {share}");
    }
    let always = RoadStyle { edge_max_pixel_m: None, ..road };
    assert_eq!(edge_share(&view(&camera(1000.0), &style), &always), 1.0);
}
