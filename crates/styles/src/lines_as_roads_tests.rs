//! Line styles replace road styles.

use super::*;

#[test]
fn lines_take_the_places_of_roads() {
    let plain = LineStyle::solid([1.0, 0.0, 0.0], 3.0);
    let cased = LineStyle { casing: Some([1.0; 3]), ..plain };
    let style = Style::road_atlas().with_lines_as_roads(&[plain, cased]);
    assert_eq!(style.roads[0].bands.all().len(), 1);
    assert_eq!(style.roads[0].min_width_px, 3.0);
    let bands = style.roads[1].bands;
    assert_eq!(bands.all().iter().map(|band| band.width_share).collect::<Vec<_>>(), [1.0, 0.6]);
    assert_eq!(style.roads[1].min_width_px, 5.0);
    assert_eq!(style.roads[2].opacity, 0.0, "there is no third style");
}
