//! A level is too coarse for a picture that shows a class that is missing on the level.

use corniche_geom::Cell;
use corniche_tileset::SampleErrorRecord;

use super::*;

/// A package whose levels show roads up to these classes.
fn levels(least_classes: &[Option<u8>]) -> Vec<LevelRecord> {
    let level = |(level, &least_class)| LevelRecord {
        level,
        cell_m: Cell { east_m: 1.0, north_m: 1.0 },
        max_error_m: 1.0,
        geometric_error_m: 1.0,
        errors_m: None,
        sample_error: SampleErrorRecord::default(),
        tightness: None,
        least_class,
        simplify_tolerance_m: 0.0,
        width_margin_m: 40.0,
        tiles: 1,
        triangles: 2,
        vertices: 4,
        terrain_bytes: 1,
        relief_bytes: 0,
        uncovered_nodes: 0,
    };
    (0..).zip(least_classes).map(level).collect()
}

/// The root has no roads and the next level motorways and trunk roads; the finest has no paths.
fn scales(style: &Style, roads: RoadOptions) -> [f64; 4] {
    let levels = levels(&[None, Some(1), Some(6), Some(7)]);
    let scales = LevelScales::of_roads(&levels, style, roads);
    [0, 1, 2, 3].map(|level| scales.least_pixel_m(level))
}

const METHOD: RoadMethod = RoadMethod::Geometry;

#[test]
fn a_level_is_too_coarse_where_a_class_is_shown_that_it_has_not() {
    let style = Style::road_atlas();
    let last = |class: usize| style.roads[class].last_pixel_m();
    assert!(last(1) > last(2) && last(2) > last(7));
    // Motorways are always shown, so no scale is fine enough for them, and tiles are not refined
    // for them.
    assert_eq!(scales(&style, RoadOptions::for_method(METHOD)), [last(1), last(2), last(7), 0.0]);
}

#[test]
fn roads_that_are_not_drawn_are_not_waited_for() {
    let style = Style::road_atlas();
    let class = |number| FunctionalRoadClass::new(number).unwrap();
    let few = RoadOptions {
        classes: ClassSet::NONE.with(class(1)).with(class(8)),
        ..RoadOptions::for_method(METHOD)
    };
    assert_eq!(scales(&style, few), [style.roads[1].last_pixel_m(), 0.0, 0.0, 0.0]);
    assert_eq!(scales(&style, RoadOptions::for_method(RoadMethod::None)), [0.0; 4]);
    let mut always = style;
    always.roads.iter_mut().for_each(|road| road.max_pixel_m = None);
    assert_eq!(scales(&always, RoadOptions::for_method(METHOD)), [0.0; 4]);
}

/// With the default classes per level, cells that are not refined further have all roads that the
/// default style shows.
#[test]
fn usual_packages_have_what_the_usual_style_shows() {
    // A tile whose cells look no larger than this is not refined further, so a pixel covers at
    // least the cell divided by this number.
    const CELL_PX: f64 = 2.0;
    let filter = corniche_roads::ClassFilter::usual();
    let style = Style::road_atlas();
    for class in FunctionalRoadClass::all() {
        let Some(coarsest_m) = filter.class_max_cell_m()[usize::from(class.number())] else {
            continue;
        };
        let needed_m = style.road(class).last_pixel_m() * CELL_PX;
        assert!(needed_m <= coarsest_m, "{class}: shown on cells of up to {needed_m} m");
    }
}
