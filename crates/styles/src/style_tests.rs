//! Widths and colours of a style follow its numbers.

use super::*;
use crate::TintHeights;

#[test]
fn the_atlas_gives_more_important_roads_more_width() {
    let style = Style::road_atlas();
    assert!(
        style.roads.is_sorted_by(|a, b| a.width_m > b.width_m && a.min_width_px >= b.min_width_px)
    );
    assert!(style.tint.stops.is_sorted_by(|a, b| a.0 < b.0));
}

#[test]
fn widths_are_true_up_to_the_threshold_and_grow_beyond() {
    let scaling = WidthScaling { threshold_m: 1000.0, exponent: 0.5, constant: 1.0 };
    assert!((scaling.factor(10.0) - 1.0).abs() < 1e-12);
    assert!((scaling.factor(1000.0) - 1.0).abs() < 1e-12);
    assert!((scaling.factor(4000.0) - 2.0).abs() < 1e-12);
}

#[test]
fn hex_is_red_green_blue() {
    assert_eq!(crate::parse_color("#FF0033").unwrap(), [1.0, 0.0, 0.2]);
}

/// The width of a road comes from its `width` tag, its lanes or its class; tags give at most 60 m,
/// a class gives any width of the style.
#[test]
fn tags_decide_the_width_where_the_style_looks_at_them() {
    let class = FunctionalRoadClass::new(4).unwrap();
    let tagged = |mm| OwnWidth::Millimetres(std::num::NonZeroU32::new(mm).unwrap());
    let lanes = |count| OwnWidth::Lanes(std::num::NonZeroU8::new(count).unwrap());
    let mut style = Style::road_atlas();
    assert_eq!(style.width_m(class, tagged(6500)), 11.0);
    assert!(!style.is_capped(tagged(70_000)));
    style.own_widths = Some(OwnWidths { lane_m: Some(3.0) });
    for (own, width_m, is_capped) in [
        (OwnWidth::Unknown, 11.0, false),
        (tagged(6500), 6.5, false),
        (tagged(60_000), 60.0, false),
        (tagged(60_001), 60.0, true),
        (lanes(2), 6.0, false),
        (lanes(20), 60.0, false),
        (lanes(21), 60.0, true),
    ] {
        assert_eq!((style.width_m(class, own), style.is_capped(own)), (width_m, is_capped));
    }
    style.own_widths = Some(OwnWidths { lane_m: None });
    assert_eq!((style.width_m(class, lanes(21)), style.is_capped(lanes(21))), (11.0, false));
    style.roads[4].width_m = 200.0;
    assert_eq!(style.width_m(class, OwnWidth::Unknown), 200.0);
}

#[test]
fn colours_of_a_tint_are_linear_between_stops() {
    let stops = vec![(0.0, [0.0; 3]), (100.0, [1.0; 3]), (200.0, [0.5; 3])];
    let tint = Tint { heights: TintHeights::Metres, stops };
    for (height_m, grey) in [(-5.0, 0.0), (25.0, 0.25), (100.0, 1.0), (150.0, 0.75), (900.0, 0.5)] {
        assert_eq!(tint.color_at(height_m, [0.0, 1.0], 47.0), [grey; 3], "{height_m}");
    }
}

/// A share is a position in the package's range of heights; metres are metres; by climate, heights
/// move with the snow line, but not at sea level.
#[test]
fn heights_of_a_tint_are_what_its_unit_says() {
    let colors = [[0.0; 3], [1.0; 3]];
    let stops = |heights, at: [f32; 2], latitude_deg| {
        let tint = Tint { heights, stops: at.into_iter().zip(colors).collect() };
        tint.stops_m([100.0, 300.0], latitude_deg).iter().map(|stop| stop.0).collect::<Vec<_>>()
    };
    assert_eq!(stops(TintHeights::Shares, [0.0, 0.5], 0.0), [100.0, 200.0]);
    assert_eq!(stops(TintHeights::Metres, [-10.0, 2900.0], 0.0), [-10.0, 2900.0]);
    assert_eq!(stops(TintHeights::MetresByClimate, [-10.0, 2900.0], 47.0), [-10.0, 2900.0]);
    assert_eq!(stops(TintHeights::MetresByClimate, [-10.0, 2900.0], -67.0), [-10.0, 1200.0]);
}

/// Drawn widths: a carriageway has a width of its own, a slip road 0.6 of that, a service road 0.6
/// of its class; tags override the style.
#[test]
fn widths_follow_what_a_road_is() {
    let mut style = Style::road_atlas();
    let class = FunctionalRoadClass::new(0).unwrap();
    let of = |form, highway: &str| RoadAttributes {
        form,
        highway: highway.to_owned(),
        width_mm: std::num::NonZeroU32::new(9000),
        ..RoadAttributes::default()
    };
    let all = [
        (Form::Ordinary, "motorway"),
        (Form::DualCarriageway, "motorway"),
        (Form::Link, "motorway_link"),
        (Form::Ordinary, "service"),
    ];
    let widths =
        |style: &Style| all.map(|(form, highway)| style.width_of_m(class, &of(form, highway)));
    let near = |found: [f32; 4], expected: [f32; 4]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}");
    };
    near(widths(&style), [24.0, 12.0, 7.2, 14.4]);
    style.own_widths = Some(OwnWidths { lane_m: None });
    near(widths(&style), [9.0, 9.0, 5.4, 5.4]);
    near(
        [
            style.roads[0].widened(2.0).width_m,
            style.roads[0].widened(2.0).carriageway_width_m,
            0.0,
            0.0,
        ],
        [48.0, 24.0, 0.0, 0.0],
    );
}
