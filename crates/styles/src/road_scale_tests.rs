//! A road class fades over half a zoom step.

use super::*;

fn road(max_pixel_m: Option<f32>) -> RoadStyle {
    RoadStyle { max_pixel_m, ..Style::road_atlas().roads[6] }
}

/// Full, half a zoom step later nothing, and the middle of that step is half of it: 10 · 2^(1/4).
#[test]
fn a_class_fades_over_half_a_zoom_step() {
    let road = road(Some(10.0));
    for (pixel_m, share) in [
        (0.0, 1.0),
        (1.0, 1.0),
        (10.0, 1.0),
        (10.0 * 2.0_f64.powf(0.125), 0.75),
        (10.0 * 2.0_f64.powf(0.25), 0.5),
        (10.0 * 2.0_f64.sqrt(), 0.0),
        (1e9, 0.0),
        (f64::INFINITY, 0.0),
    ] {
        let found = road.shown_share(pixel_m);
        assert!((found - share).abs() < 1e-6, "{pixel_m} m: {found} for {share}");
    }
    assert!((road.last_pixel_m() - 14.142_135).abs() < 1e-5);
}

#[test]
fn a_class_without_a_scale_is_always_there() {
    let road = road(None);
    for pixel_m in [0.0, 1.0, 1e12, f64::INFINITY] {
        assert!((road.shown_share(pixel_m) - 1.0).abs() < 1e-12);
    }
    assert!(road.last_pixel_m().is_infinite());
}

#[test]
fn the_presets_show_more_important_classes_farther() {
    for name in crate::style_preset_names() {
        let style = crate::parse_style(crate::style_preset(name).unwrap()).unwrap();
        assert!(style.roads.is_sorted_by(|a, b| a.last_pixel_m() > b.last_pixel_m()), "{name}");
        assert_eq!(style.roads[0].max_pixel_m, None, "{name}: motorways are always drawn");
    }
}
