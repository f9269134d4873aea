//! Looks of layers: from the class, else from the layer, else from the geometry.

use super::*;
use crate::Style;
use crate::parse_style;

/// A layer with these classes.
fn layer(id: &str, geometry: LayerGeometry, classes: &[&str]) -> LayerForm {
    let classes = classes.iter().map(|class| format!("[[class]]\nid = \"{class}\"\n"));
    let text = format!(
        "id = \"{id}\"\ngeometry = \"{}\"\n{}",
        geometry.name(),
        classes.collect::<String>()
    );
    toml::from_str(&text).unwrap()
}

fn style(text: &str) -> Style {
    parse_style(&format!("base = \"road-atlas\"\n{text}\n")).unwrap()
}

#[test]
fn what_a_style_does_not_name_has_the_look_of_its_geometry() {
    let defaults = "[layer_defaults.area]\ncolor = \"#FF0000\"\nopacity = 0.25\n\
        [layer_defaults.line]\ncolor = \"#00FF00\"\nwidth_px = 7\n\
        [layer_defaults.point]\ncolor = \"#0000FF\"\nsize_px = 11\noutline = \"#000000\"";
    let style = style(defaults);
    let look = |geometry| style.layer_look(&layer("own", geometry, &["a"]), 0);
    let LayerLook::Area(area) = look(LayerGeometry::Area) else { panic!() };
    assert_eq!((area.color, area.opacity, area.steepest_deg), ([1.0, 0.0, 0.0], 0.25, None));
    let LayerLook::Line(line) = look(LayerGeometry::Line) else { panic!() };
    assert_eq!((line.color, line.width_px, line.dash), ([0.0, 1.0, 0.0], 7.0, Dash::SOLID));
    assert!(!line.is_apart_from_roads);
    let LayerLook::Point(point) = look(LayerGeometry::Point) else { panic!() };
    assert_eq!((point.size_px, point.outline, point.opacity), (11.0, Some([0.0; 3]), 1.0));
    // A class of a table that the style does not know, beside one that it knows.
    let layer = built_in_layer("boundaries");
    assert_ne!(style.layer_look(&layer, 0), look(LayerGeometry::Line));
    // No class of the table has this number.
    assert!(style.layer_look(&layer, 200).is_drawn());
}

#[test]
fn classes_come_before_layers_and_layers_before_geometries() {
    let style = style(
        "[layers.own]\ncolor = \"#FF0000\"\nwidth_px = 3\ndash = [4, 4]\n\
         [layers.own.b]\nwidth_px = 5\npattern = { length_px = 24, widths = [1, 0.5] }",
    );
    let layer = layer("own", LayerGeometry::Line, &["a", "b", "c"]);
    let looks: Vec<LineStyle> = (0..3)
        .map(|class| match style.layer_look(&layer, class) {
            LayerLook::Line(line) => line,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(looks[0], looks[2]);
    assert_eq!(crate::to_bytes(looks[1].color), [255, 0, 0]);
    assert_eq!(looks[0].dash, Dash::new(&[4.0, 4.0]).unwrap());
    assert_eq!((looks[0].width_px, looks[1].width_px), (3.0, 5.0));
    assert!(looks[1].dash.widths.is_some());
}

/// At 1:25 000 a pixel of 1/96 inch covers 6.6 metres.
#[test]
fn the_scale_of_a_class_limits_lines_unless_the_style_does() {
    let mut layer = layer("own", LayerGeometry::Line, &["a"]);
    let limit = |layer: &LayerForm, text: &str| match style(text).layer_look(layer, 0) {
        LayerLook::Line(line) => line.max_pixel_m,
        other => panic!("{other:?}"),
    };
    assert_eq!(limit(&layer, ""), None);
    layer.classes[0].scale = Some(25_000.0);
    assert!((limit(&layer, "").unwrap() - 6.614_583).abs() < 1e-4);
    assert_eq!(limit(&layer, "[layers.own]\nmax_pixel_m = 3"), Some(3.0));
    assert!(limit(&layer, "[layer_defaults.line]\nmax_pixel_m = 3").unwrap() > 6.0);
}

/// The looks that areas and boundaries have had from the beginning.
#[test]
fn built_in_layers_look_as_their_styles_say() {
    let [areas, boundaries, railways] = ["areas", "boundaries", "railways"].map(built_in_layer);
    for (name, sea, border) in [
        ("road-atlas", [0xA9, 0xC9, 0xDD], [0x8A, 0x3F, 0x86]),
        ("dark", [0x12, 0x38, 0x6B], [0xC9, 0xA2, 0xE8]),
        ("relief", [0x9D, 0xC3, 0xD6], [0x8A, 0x3F, 0x86]),
        ("photo", [0xA9, 0xC9, 0xDD], [0xFF, 0xA8, 0xF0]),
    ] {
        let style = parse_style(crate::style_preset(name).unwrap()).unwrap();
        let LayerLook::Area(area) = style.layer_look(&areas, 2) else { panic!() };
        assert_eq!((crate::to_bytes(area.color), area.steepest_deg), (sea, Some(35.0)), "{name}");
        for class in 0..7 {
            let LayerLook::Line(line) = style.layer_look(&boundaries, class) else { panic!() };
            assert_eq!(crate::to_bytes(line.color), border, "{name}");
            assert!(line.is_apart_from_roads && line.dash != Dash::SOLID, "{name}");
        }
        let looks = (0..railways.classes.len()).map(|class| style.layer_look(&railways, class));
        assert!(looks.clone().all(|look| look.is_drawn()), "{name}");
        // A table and a style that fit each other.
        for layer in corniche_config::LAYERS.iter().map(|(name, _)| built_in_layer(name)) {
            let named = style.layers.layers[&layer.id].keys();
            let has = |id: &String| layer.classes.iter().any(|class| class.id == *id);
            let mut unknown = named.filter(|id| !id.is_empty() && !has(id));
            assert_eq!(unknown.next(), None, "{name} {}", layer.id);
        }
    }
}

/// A style that gives a layer another colour also gives one to its classes with an own colour,
/// which it would otherwise inherit.
#[test]
fn no_class_keeps_the_colour_of_another_style() {
    let colors = |name: &str| -> BTreeMap<(String, String), Option<[f32; 3]>> {
        let style = parse_style(crate::style_preset(name).unwrap()).unwrap();
        let layers = style.layers.layers.into_iter().flat_map(|(id, classes)| {
            classes.into_iter().map(move |(class, look)| ((id.clone(), class), look.color))
        });
        layers.collect()
    };
    let atlas = colors("road-atlas");
    for name in ["dark", "photo"] {
        let own = colors(name);
        for (key, color) in &atlas {
            let layer = (key.0.clone(), String::new());
            let is_recoloured = own[&layer] != atlas[&layer];
            if is_recoloured && color.is_some() {
                assert_ne!(own[key], *color, "{name} {key:?}");
            }
        }
    }
}
