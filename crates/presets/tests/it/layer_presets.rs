//! Built-in layers, and errors of layer tables with their lines.

use corniche_layers::{LayerTable, stacked_layers};
use corniche_presets::{layer_preset, layer_preset_names, parse_layer_table};

fn preset(name: &str) -> LayerTable {
    let text = layer_preset(name).unwrap_or_else(|| panic!("{name} is not a built-in layer"));
    parse_layer_table(text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Tags of an object, and its class.
type TagsCase<'a> = (&'a [(&'a str, &'a str)], Option<&'a str>);

fn class(table: &LayerTable, tags: &[(&str, &str)]) -> Option<String> {
    Some(table.classes()[usize::from(table.classify(tags)?)].id.clone())
}

/// Layers are called like their files, and have titles in English and German.
#[test]
fn built_in_layers_are_valid() {
    let layers: Vec<LayerTable> = layer_preset_names().map(preset).collect();
    for (name, layer) in layer_preset_names().zip(&layers) {
        assert_eq!(layer.id(), name);
        let titles = layer.classes().iter().map(|class| &class.title).chain([&layer.form().title]);
        for title in titles {
            assert!(
                title.title(&["en"]).is_some() && title.title(&["de"]) != title.title(&["en"])
                    || title.title(&["de"]) == Some("Park"),
                "{title:?}"
            );
        }
    }
    let order: Vec<&str> =
        stacked_layers(&layers).unwrap().into_iter().map(|index| layers[index].id()).collect();
    let expected = [
        "areas",
        "waterways",
        "buildings",
        "landforms",
        "railways",
        "ferries",
        "boundaries",
        "places",
        "peaks",
        "pois",
    ];
    assert_eq!(order, expected);
    assert_eq!(layer_preset("roads"), None);
}

#[test]
fn railways_have_the_class_of_their_tags() {
    let railways = preset("railways");
    let cases: [TagsCase; 13] = [
        (&[("railway", "rail"), ("usage", "main")], Some("main")),
        (&[("railway", "rail"), ("usage", "main"), ("service", "crossover")], Some("service")),
        (&[("railway", "rail"), ("usage", "branch")], Some("branch")),
        (&[("railway", "rail")], Some("branch")),
        (&[("railway", "narrow_gauge"), ("rack", "abt")], Some("rack")),
        (&[("railway", "narrow_gauge"), ("rack", "no")], Some("narrow-gauge")),
        (&[("railway", "rail"), ("usage", "industrial")], Some("industrial")),
        (&[("railway", "funicular")], Some("rack")),
        (&[("railway", "subway")], Some("light")),
        (&[("railway", "tram")], Some("tram")),
        (&[("railway", "disused")], None),
        (&[("railway", "station")], None),
        (&[("highway", "primary")], None),
    ];
    for (tags, expected) in cases {
        assert_eq!(class(&railways, tags).as_deref(), expected, "{tags:?}");
    }
}

#[test]
fn errors_name_line_and_key() {
    let head = "id = \"walls\"\ngeometry = \"line\"\n";
    let cases = [
        ("id = 5", "line 1, column 6"),
        ("id = \"a\"\ngeometry = \"surface\"", "line 2, column 12"),
        ("id = \"a\"\ngeometry = \"line\"\ncolour = 1\nclass = []", "unknown field `colour`"),
        (
            "id = \"a b\"\ngeometry = \"line\"\n[[class]]\nid = \"c\"\ntags = { k = \"v\" }",
            "line 1: id: \"a b\"",
        ),
        ("id = \"a\"\ngeometry = \"line\"", "missing field `class`"),
    ];
    for (text, fragment) in cases {
        let error = parse_layer_table(text).unwrap_err().to_string();
        assert!(error.contains(fragment), "{error}");
    }
    let classes = [
        (
            "\n[[class]]\nid = \"a\"\ntags.barrier = [\n]\n",
            "line 6: class[0].tags.barrier: lists no value",
        ),
        (
            "\n[[class]]\nid = \"a\"\ntags = { barrier = { below = 1, unit = \"league\" } }\n",
            "line 6",
        ),
        (
            "[[class]]\nid = \"a\"\ntags = { barrier = true }\n\n[[class]]\nid = \"b\"\ntags = [\n  { barrier = \"wall\" },\n]\n",
            "line 9: class[1].tags: class \"b\" is never reached",
        ),
        (
            "[[class]]\nid = \"a\"\ntags = [\n  { barrier = true },\n  { wall = false },\n]\n",
            "line 7: class[0].tags[1]: requires no tag",
        ),
        ("[[class]]\nid = \"a\"\n", "line 3: class[0].tags: the class has no tags"),
        (
            "[attributes]\nheight = { number = \"m\" }\n\"a\\u0007\" = \"text\"\n[[class]]\nid = \"a\"\ntags.b = true\n",
            "line 5: attributes.\"a\\u{7}\"",
        ),
    ];
    let isolated = "geometry = \"point\"\n[attributes]\nfar = { derived = \"isolation\" }\n[[class]]\nid = \"a\"\ntags.b = true\n";
    let error = parse_layer_table(&format!("id = \"peaks\"\n{isolated}")).unwrap_err().to_string();
    assert!(error.contains("line 4: attributes.far: isolation applies to"), "{error}");
    for (text, fragment) in classes {
        let error = parse_layer_table(&format!("{head}{text}")).unwrap_err().to_string();
        assert!(error.contains(fragment), "{error}");
    }
}
