//! A road class fades over half a zoom step.

use super::*;

fn road(max_pixel_m: Option<f32>) -> RoadStyle {
    RoadStyle { max_pixel_m, ..Style::road_atlas().roads[6] }
}

#[test]
fn a_class_fades_over_half_a_zoom_step() {
    assert!((road(Some(10.0)).last_pixel_m() - 14.142_135).abs() < 1e-5);
}

#[test]
fn a_class_without_a_scale_is_always_there() {
    assert!(road(None).last_pixel_m().is_infinite());
}

#[test]
fn the_presets_show_more_important_classes_farther() {
    for name in crate::style_preset_names() {
        let style = crate::parse_style(crate::style_preset(name).unwrap()).unwrap();
        assert!(style.roads.is_sorted_by(|a, b| a.last_pixel_m() > b.last_pixel_m()), "{name}");
        assert_eq!(style.roads[0].max_pixel_m, None, "{name}: motorways are always drawn");
    }
}
