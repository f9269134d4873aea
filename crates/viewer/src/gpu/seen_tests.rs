//! A class is in a picture if it covers as much as a few pixels, and heights are those of the
//! visible ground.

use corniche_geom::Bounds;

use super::*;
use crate::{
    camera::{Orientation, WorldBox},
    gpu::labels_tests::{road_label, service_label, tunnel_label},
    layers::tests::class,
};

fn numbers(classes: ClassSet) -> Vec<u8> {
    classes.iter().map(FunctionalRoadClass::number).collect()
}

fn samples(roads: &[u8]) -> SeenSamples<'_> {
    SeenSamples {
        per_side: 1,
        columns: 8,
        roads,
        decks: None,
        lines: &[],
        areas: None,
        points: None,
        numbered: &[],
    }
}

/// Samples of lines whose classes have the numbers of their styles.
fn lines(labels: &[u8], is_apart: bool) -> [LineSamples; 1] {
    let classes = std::array::from_fn(|style| Some((class(2, style as u8), is_apart)));
    [LineSamples { labels: labels.to_vec(), decks: None, classes }]
}

fn classes_of(seen: &ShownTiles) -> Vec<u8> {
    seen.layers.iter().map(|of| of.class.class).collect()
}

#[test]
fn bands_service_roads_and_tunnels_count_for_their_class() {
    let roads = [
        [road_label(2, 0), road_label(2, 0), road_label(2, 1), road_label(2, 3)],
        [service_label(5); 4],
        [tunnel_label(0, true), tunnel_label(0, false), tunnel_label(0, true), 0],
        [
            tunnel_label(4, true),
            tunnel_label(4, false),
            tunnel_label(4, true),
            tunnel_label(4, true),
        ],
    ]
    .concat();
    let seen = samples(&roads).seen();
    assert_eq!(numbers(seen.roads), [2, 4, 5]);
    assert_eq!(numbers(seen.tunnels), [4]);
    // With four samples per pixel, four samples are one pixel.
    let seen = SeenSamples { per_side: 2, ..samples(&roads) }.seen();
    assert!(numbers(seen.roads).is_empty());
}

/// Sides and undersides of bridges hide roads and do not count as roads.
#[test]
fn decks_hide_what_is_beneath_them() {
    let roads = [road_label(3, 0); 12];
    let decks = [[1; 4], [2; 4], [road_label(1, 0); 4]].concat();
    let seen = SeenSamples { decks: Some(&decks), ..samples(&roads) }.seen();
    assert_eq!(numbers(seen.roads), [1]);
}

#[test]
fn areas_beneath_roads_are_not_seen_and_points_above_them_are() {
    let roads = [[0; 4], [road_label(3, 0); 4]].concat();
    let areas = [[1; 4], [2; 4]].concat();
    let points = [[0; 4], [3; 4]].concat();
    let numbered = [class(0, 7), class(0, 8), class(5, 0)];
    let samples = SeenSamples {
        areas: Some(&areas),
        points: Some(&points),
        numbered: &numbered,
        ..samples(&roads)
    };
    let seen = samples.seen();
    let of = |class| SeenClass { class, height_m: None };
    assert_eq!(seen.layers, [of(class(5, 0)), of(class(0, 7))]);
}

/// Three rows of eight samples: samples of a line on a road or within two pixels of it are not
/// drawn, if the style says so.
#[test]
fn lines_make_room_for_roads() {
    let (country, county) = (road_label(0, 0), road_label(4, 0));
    let labels = [[country; 8], [0; 8], [county; 8]].concat();
    let of = |roads: &[u8], is_apart| {
        let lines = lines(&labels, is_apart);
        classes_of(&SeenSamples { lines: &lines, ..samples(roads) }.seen())
    };
    assert_eq!(of(&[0; 24], true), [0, 4]);
    let below = [[0; 8], [0; 8], [road_label(5, 0); 8]].concat();
    assert!(of(&below, true).is_empty());
    assert_eq!(of(&below, false), [0, 4]);
    // Such lines are drawn on paths and tunnels.
    assert_eq!(of(&[[0; 8], [0; 8], [road_label(8, 0); 8]].concat(), true), [0, 4]);
    assert_eq!(of(&[[0; 8], [0; 8], [tunnel_label(5, true); 8]].concat(), true), [0, 4]);
}

/// The depth of each sample is computed from a point on the ground; the same heights are computed
/// from the depths.
#[test]
fn heights_come_back_from_depths() {
    let from_above = Camera::from_above(glam::DVec2::ZERO, 2.0, 30.0, [200.0, 3000.0], [4, 4]);
    let orientation = Orientation { heading_deg: 20.0, pitch_deg: 55.0 };
    let place = WorldBox::new(
        Bounds { min_x: -50.0, min_y: -50.0, max_x: 50.0, max_y: 50.0 },
        [900.0, 1000.0],
    );
    let oblique = Camera::framing(place, orientation, [4, 4]);
    for camera in [from_above, oblique] {
        let depth_of = |pixel: usize, height_m: f64| {
            let middle = DVec2::new((pixel % 4) as f64, (pixel / 4) as f64) + 0.5;
            let (start, ray) = (camera.ray_start_in_world(middle), camera.ray_in_world(middle));
            let depth_m = (height_m * 2.0 - start.z) / ray.z;
            let (_, seen_m) = camera.project(start + ray * depth_m).unwrap();
            assert!((seen_m - depth_m).abs() < 1e-6, "{seen_m} {depth_m}");
            // The depth buffer's value is found by bisection, since the camera only has the inverse
            // function.
            let (mut low, mut high) = (1e-12, 1.0);
            for _ in 0..200 {
                let middle = f64::midpoint(low, high);
                if camera.depth_m(middle) > depth_m { low = middle } else { high = middle }
            }
            (pixel, low)
        };
        let depths = [depth_of(15, 480.0), depth_of(10, 400.5), depth_of(13, 455.0), (3, 0.0)];
        let heights: Vec<(usize, f64)> = heights_m(&camera, 2.0, depths.into_iter()).collect();
        let expected = [(15, 480.0), (10, 400.5), (13, 455.0)];
        assert_eq!(heights.len(), 3);
        for ((place, height_m), (expected_place, expected_m)) in heights.iter().zip(expected) {
            assert!(*place == expected_place && (height_m - expected_m).abs() < 1e-6);
        }
    }
}

/// The range is that of all samples, the mean that of each class.
#[test]
fn areas_have_their_mean_heights() {
    let numbered = [class(0, 3), class(0, 1)];
    let numbers = [1, 1, 1, 1, 2, 2, 2, 2];
    let all = SeenSamples { areas: Some(&numbers), numbered: &numbered, ..samples(&[0; 8]) };
    let heights = [(0, 100.0), (1, 300.0), (9, 1000.0), (4, 50.0)].into_iter();
    let seen = all.seen().with_heights(heights, Some(&numbers), &numbered);
    assert_eq!(seen.heights_m, Some([50.0, 1000.0]));
    let area = |class, height_m| SeenClass { class, height_m: Some(height_m) };
    assert_eq!(seen.layers, [area(class(0, 1), 50.0), area(class(0, 3), 200.0)]);
    let none = samples(&[0; 8]).seen().with_heights([].into_iter(), None, &[]);
    assert_eq!(none.heights_m, None);
}

/// The first sample of a row is not next to the last ones of the previous row, and bridges hide
/// lines.
#[test]
fn lines_at_the_rim_and_beneath_bridges() {
    let column = |of: usize, label: u8| {
        (0..64).map(|place| if place % 8 == of { label } else { 0 }).collect::<Vec<u8>>()
    };
    let (roads, lines) = (column(6, road_label(3, 0)), lines(&column(0, road_label(0, 0)), true));
    let all = SeenSamples { lines: &lines, ..samples(&roads) };
    assert_eq!(classes_of(&all.seen()), [0]);
    let decks = [road_label(2, 0); 64];
    let all = SeenSamples { decks: Some(&decks), ..all };
    assert!(classes_of(&all.seen()).is_empty());
}
