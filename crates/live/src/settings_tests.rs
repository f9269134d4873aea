//! A comparison draws both methods, and a width factor affects only its own class.

use super::*;

#[test]
fn a_comparison_draws_both_methods_whichever_was_chosen() {
    let roads = RoadOptions::for_method(RoadMethod::None);
    assert_eq!(Compare::Off.pictures(roads), [roads]);
    let methods = |compare: Compare| -> Vec<RoadMethod> {
        compare.pictures(roads).iter().map(|options| options.method).collect()
    };
    for compare in [Compare::Split, Compare::Difference] {
        assert_eq!(methods(compare), [RoadMethod::Geometry, RoadMethod::ShadowVolumes]);
    }
}

#[test]
fn a_factor_widens_its_class_and_no_other() {
    let style = Style::road_atlas();
    let mut settings = MapSettings::usual(RoadOptions::for_method(RoadMethod::ShadowVolumes));
    settings.width_factors[3] = 2.0;
    let applied = settings.applied_to(&style);
    for (class, (before, after)) in style.roads.iter().zip(&applied.roads).enumerate() {
        let expected = if class == 3 { 2.0 * before.width_m } else { before.width_m };
        assert!((after.width_m - expected).abs() < 1e-6, "class {class}");
    }
}
