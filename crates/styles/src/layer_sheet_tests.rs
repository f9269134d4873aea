//! Entries of layers are checked as far as that is possible without their tables.

use crate::parse_style;

/// The error for the road atlas with additional text.
fn refusal(text: &str) -> String {
    parse_style(&format!("base = \"road-atlas\"\n{text}\n")).expect_err(text).to_string()
}

#[test]
fn layers_and_classes_of_any_names_may_be_styled() {
    for id in ["walls", "a", "x-9", "roads", "color", "layers", &"a".repeat(32)] {
        for text in [
            format!("[layers.{id}]\nopacity = 0.5"),
            format!("[layers.{id}.{id}]\nopacity = 0.5"),
            format!("[layers.{id}]"),
        ] {
            parse_style(&format!("base = \"road-atlas\"\n{text}\n")).expect(&text);
        }
    }
}

#[test]
fn names_that_no_table_can_have_are_refused() {
    for id in ["Walls", "9x", "-x", "x-", "a_b", "\"a b\"", "\"\"", "\"é\"", &"a".repeat(33)] {
        let said = refusal(&format!("[layers.{id}]\nopacity = 0.5"));
        assert!(said.contains("is not the name of a layer"), "{said}");
        if id != "\"\"" {
            let said = refusal(&format!("[layers.walls.{id}]\nopacity = 0.5"));
            assert!(said.contains("layers.walls.") && said.contains("of a class"), "{said}");
        }
    }
}

#[test]
fn a_class_without_a_name_is_refused() {
    let said = refusal("[layers.walls.\"\"]\nopacity = 0.5");
    assert!(said.contains("line 2") && said.contains("unknown field"), "{said}");
}

#[test]
fn entries_of_two_geometries_are_not_mixed() {
    for (text, words) in [
        (
            "[layers.a]\nwidth_px = 1\nsize_px = 3",
            &["layers.a: size_px is for layers of points, but width_px is for layers of lines"][..],
        ),
        (
            "[layers.a]\nsteepest_deg = 9\n[layers.a.b]\ndash = [2, 2]",
            &["layers.a: dash", "steepest_deg is for layers of areas"],
        ),
        (
            "[layer_defaults.area]\nsize_px = 4",
            &["layer_defaults.area: size_px is for layers of points, but these are areas"],
        ),
        (
            "[layer_defaults.polygon]\nopacity = 1",
            &["layer_defaults.\"polygon\" is not a geometry", "area, line or point"],
        ),
    ] {
        let said = refusal(text);
        assert!(words.iter().all(|word| said.contains(word)), "{text}: {said}");
    }
}

#[test]
fn numbers_out_of_their_range_are_named() {
    for (entry, value, range) in [
        ("opacity", "1.1", "0 to 1"),
        ("opacity", "nan", "0 to 1"),
        ("steepest_deg", "0.5", "1 to 89"),
        ("width_px", "0", "0.5 to 50"),
        ("size_px", "101", "1 to 100"),
        ("max_pixel_m", "inf", "0.01 to 1000000"),
    ] {
        for layer in ["layers.a", "layers.a.b"] {
            let said = refusal(&format!("[{layer}]\n{entry} = {value}"));
            let path = format!("{layer}.{entry} of");
            assert!(said.contains(&path) && said.contains(range), "{said}");
        }
    }
    let both = "[layers.a]\ndash = [4, 4]\npattern = { length_px = 24, widths = [1] }";
    assert!(refusal(both).contains("dash or pattern, not both"));
    assert!(refusal("[layers.a]\ndash = [4]").contains("two or four lengths"));
}
