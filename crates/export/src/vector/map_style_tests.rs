//! Every class that a layer can have is drawn by the style for QGIS, in the colour of the default
//! map.

use corniche_roads::FunctionalRoadClass;

use super::*;

fn values(qml: &str) -> Vec<&str> {
    qml.lines()
        .filter_map(|line| line.strip_prefix("<category value=\"")?.split('"').next())
        .collect()
}

#[test]
fn every_class_has_a_category() {
    let style = Style::road_atlas();
    let roads: Vec<String> =
        FunctionalRoadClass::all().map(|class| class.number().to_string()).collect();
    assert_eq!(values(&qml("roads", &style).unwrap()), roads);
    let areas = qml("areas", &style).unwrap();
    let mut found = values(&areas);
    let mut all: Vec<&str> = AreaClass::ALL.iter().map(|class| class.name()).collect();
    found.sort_unstable();
    all.sort_unstable();
    assert_eq!(found, all);
    let boundaries = qml("boundaries", &style).unwrap();
    let all: Vec<&str> = BoundaryClass::ALL.iter().map(|class| class.name()).collect();
    assert_eq!(values(&boundaries), all);
    assert_eq!(qml("line", &style), None);
}

/// Colours and widths are those of `config/styles/road-atlas.toml`: a motorway has 5.5 px of
/// #C50D2B and an edge of 1 px on both sides, #6B1413. A pixel is 25.4 / 96 mm.
#[test]
fn colours_and_widths_are_those_of_the_default_style() {
    let roads = qml("roads", &Style::road_atlas()).unwrap();
    assert_eq!(qml("edges", &Style::road_atlas()), Some(roads.clone()));
    let motorway = roads.split("</symbol>").next().unwrap();
    for part in [
        "pass=\"0\"",
        r#"k="line_color" v="107,20,19,255""#,
        r#"k="line_width" v="1.984""#,
        "pass=\"9\"",
        r#"k="line_color" v="197,13,43,255""#,
        r#"k="line_width" v="1.455""#,
    ] {
        assert!(motorway.contains(part), "{part}: {motorway}");
    }
    let areas = qml("areas", &Style::road_atlas()).unwrap();
    assert!(areas.contains(r#"alpha="0.42""#) && areas.contains("127,174,120,255"), "{areas}");
    // 16, 4, 3 and 4 px.
    let boundaries = qml("boundaries", &Style::road_atlas()).unwrap();
    assert!(boundaries.contains(r#"v="4.233;1.058;0.794;1.058""#), "{boundaries}");
}
