//! Every class that a layer can have is drawn by the style for QGIS, in the colour of the default
//! map.

use corniche_roads::FunctionalRoadClass;

use super::*;

fn values(qml: &str) -> Vec<&str> {
    qml.lines()
        .filter_map(|line| line.strip_prefix("<category value=\"")?.split('"').next())
        .collect()
}

/// A layer with two classes, of which the first has the title `"A" & <B>`.
fn layer(id: &str, geometry: &str, classes: [&str; 2]) -> StyledClasses {
    let [first, second] = classes;
    let table = serde_json::json!({
        "id": id, "geometry": geometry,
        "class": [
            { "id": first, "title": "\"A\" & <B>", "tags": { "one": true } },
            { "id": second, "tags": { "two": true } },
        ],
    });
    StyledClasses::Layer(Box::new(serde_json::from_value(table).unwrap()))
}

#[test]
fn every_class_has_a_category() {
    let style = Style::road_atlas();
    let roads: Vec<String> =
        FunctionalRoadClass::all().map(|class| class.number().to_string()).collect();
    assert_eq!(values(&qml(&StyledClasses::Roads, &style)), roads);
    for (geometry, number, symbol) in
        [("point", 0, "marker"), ("line", 1, "line"), ("area", 2, "fill")]
    {
        let qml = qml(&layer("walls", geometry, ["dry", "brick"]), &style);
        assert_eq!(values(&qml), ["dry", "brick"], "{geometry}");
        assert!(qml.contains(&format!("<layerGeometryType>{number}<")), "{qml}");
        assert_eq!(qml.matches(&format!("<symbol type=\"{symbol}\"")).count(), 2, "{qml}");
        assert!(qml.contains("label=\"&quot;A&quot; &amp; &lt;B>\""), "{qml}");
        assert!(qml.contains("label=\"brick\""), "{qml}");
        // The first class is above.
        let at = |pass| qml.find(&format!("pass=\"{pass}\"")).unwrap();
        assert!(at(2) < at(1), "{qml}");
    }
}

/// Colours and widths are those of `config/styles/road-atlas.toml`: a motorway has 5.5 px of
/// #C50D2B and an edge of 1 px on both sides, #6B1413. A pixel is 25.4 / 96 mm.
#[test]
fn colours_and_widths_are_those_of_the_default_style() {
    let style = Style::road_atlas();
    let roads = qml(&StyledClasses::Roads, &style);
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
    let areas = qml(&layer("areas", "area", ["water", "forest"]), &style);
    assert!(areas.contains(r#"alpha="0.42""#) && areas.contains("127,174,120,255"), "{areas}");
    // 16, 4, 3 and 4 px.
    let boundaries = qml(&layer("boundaries", "line", ["admin-2", "admin-3"]), &style);
    assert!(boundaries.contains(r#"v="4.233;1.058;0.794;1.058""#), "{boundaries}");
}

/// An edge of one pixel is outside of the disc.
#[test]
fn marks_are_as_large_as_on_the_map() {
    let text = "base = \"road-atlas\"\n[layers.trees]\ncolor = \"#102030\"\nsize_px = 7\noutline = \"#FFFFFF\"\n";
    let style = corniche_styles::parse_style(text).unwrap();
    let trees = qml(&layer("trees", "point", ["oak", "fir"]), &style);
    for part in [
        r#"k="color" v="16,32,48,255""#,
        r#"k="size" v="2.117""#,
        r#"k="outline_color" v="255,255,255,255""#,
        r#"k="outline_width" v="0.265""#,
    ] {
        assert!(trees.contains(part), "{part}: {trees}");
    }
}
