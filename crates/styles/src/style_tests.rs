use super::*;

#[test]
fn the_atlas_gives_more_important_roads_more_width() {
    let style = Style::road_atlas();
    assert!(
        style.roads.is_sorted_by(|a, b| a.width_m > b.width_m && a.min_width_px >= b.min_width_px)
    );
    assert!(style.tint.is_sorted_by(|a, b| a.0 < b.0));
    assert!(style.tint[0].0.abs() < 1e-9 && (style.tint[TINT_STOPS - 1].0 - 1.0).abs() < 1e-9);
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
    assert_eq!(rgb(0xFF_00_33), [1.0, 0.0, 0.2]);
}
