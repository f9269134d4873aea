//! Growing widths and sets of classes follow their options.

use super::*;

/// How much widths grow at a distance of 4 km, with a threshold of 1 km, an exponent of 0.5 and a
/// constant of 3.
#[test]
fn widths_grow_as_the_option_says() {
    let style = Style {
        width_scaling: WidthScaling { threshold_m: 1000.0, exponent: 0.5, constant: 3.0 },
        ..Style::road_atlas()
    };
    let check = |width_growth, at_500_m: f64, at_4_km: f64| {
        let options =
            RoadOptions { width_growth, ..RoadOptions::for_method(RoadMethod::ShadowVolumes) };
        let scaling = options.width_scaling(&style, &style.roads[2]);
        assert!((scaling.factor(500.0) - at_500_m).abs() < 1e-9, "{width_growth:?}");
        assert!((scaling.factor(4000.0) - at_4_km).abs() < 1e-9, "{width_growth:?}");
    };
    check(WidthGrowth::None, 1.0, 1.0);
    check(WidthGrowth::Constant, 3.0, 3.0);
    check(WidthGrowth::ByDistance, 1.0, 2.0);
}

#[test]
fn a_class_is_in_a_set_until_it_is_taken_out() {
    let [two, five] = [2, 5].map(|number| FunctionalRoadClass::new(number).unwrap());
    assert!(FunctionalRoadClass::all().all(|class| ClassSet::ALL.contains(class)));
    let set = ClassSet::ALL.without(two).without(two);
    assert!(!set.contains(two) && set.contains(five));
    assert_eq!(set.with(two), ClassSet::ALL);
}

#[test]
fn outlines_are_as_wide_as_their_kernel_reaches() {
    let style = Style { outline_px: 7, ..Style::road_atlas() };
    let check = |outline, expected_px| {
        let options = RoadOptions { outline, ..RoadOptions::for_method(RoadMethod::Geometry) };
        assert_eq!(options.outline_px(&style), expected_px, "{outline:?}");
    };
    check(RoadOutline::OfStyle, 7);
    check(RoadOutline::None, 0);
    check(RoadOutline::Kernel3, 1);
    check(RoadOutline::Kernel5, 2);
}
