//! A style with a base equals the base with the style's own entries; errors name a wrong base and
//! wrong entries.

use crate::{
    LayerLook, LineStyle, Style, StyleError, TintHeights, layer_looks::built_in_layer, parse_style,
    style_preset, style_preset_names,
};

fn preset(name: &str) -> Style {
    parse_style(style_preset(name).unwrap()).unwrap()
}

fn style(text: &str) -> Style {
    parse_style(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn boundary(style: &Style, class: &str) -> LineStyle {
    let layer = built_in_layer("boundaries");
    let class = layer.classes.iter().position(|of| of.id == class).unwrap();
    let LayerLook::Line(line) = style.layer_look(&layer, class) else { panic!("{class}") };
    line
}

/// Returns the error for a text with a base.
fn refusal(text: &str) -> String {
    parse_style(&format!("base = \"road-atlas\"\n{text}")).expect_err(text).to_string()
}

#[test]
fn a_style_that_says_nothing_is_its_base() {
    for name in style_preset_names() {
        assert_eq!(style(&format!("base = \"{name}\"")), preset(name), "{name}");
    }
}

#[test]
fn what_is_said_goes_before_the_base_and_the_rest_is_the_bases() {
    let own = style(
        "base = \"dark\"\nphoto = 0.5\n[light]\nhillshade = 0.25\n[roads.3]\nwidth_m = 77\n[layers.areas.water]\nopacity = 0.125\n",
    );
    let mut expected = preset("dark");
    expected.photo = 0.5;
    expected.light.hillshade = 0.25;
    // Half of another width would not be a carriageway of this width.
    (expected.roads[3].width_m, expected.roads[3].carriageway_width_m) = (77.0, 77.0);
    let water = expected.layers.layers.get_mut("areas").unwrap().get_mut("water").unwrap();
    water.opacity = Some(0.125);
    assert_eq!(own, expected);
    // Another style may replace every part of the base; the result is that style.
    let dark = style_preset("dark").unwrap();
    assert_eq!(style(&format!("base = \"relief\"\n{dark}")), preset("dark"));
}

/// Colours of a road, dashes and patterns, a tint and its climate, widths and lanes do not
/// contradict the entries of the base.
#[test]
fn entries_that_exclude_each_other_are_not_mixed() {
    let bands =
        "bands = [{ width = 1, color = \"#112233\" }, { width = 0.5, color = \"#445566\" }]";
    let own = style(&format!("base = \"road-atlas\"\n[roads.0]\n{bands}\n"));
    assert_eq!(own.roads[0].bands.all().len(), 2);
    assert_eq!(own.roads[0].thin, None, "thin roads have the colour of most bands");
    let plain = style("base = \"road-atlas\"\n[roads.0]\ncolor = \"#00FF00\"\n");
    assert_eq!(plain.roads[0].bands.main_color(), [0.0, 1.0, 0.0]);
    assert_eq!(plain.roads[0].bands.all().len(), 1, "the line in the middle is another colour");
    assert_eq!(plain.roads[0].width_m, Style::road_atlas().roads[0].width_m);
    for line in ["dash = [9, 3]", "pattern = { length_px = 24, widths = [1, 0.5] }"] {
        for (base, class) in
            style_preset_names().zip(["admin-2", "admin-4", "admin-8", "protected"])
        {
            let own = style(&format!("base = \"{base}\"\n[layers.boundaries.{class}]\n{line}\n"));
            let [own, bases] = [own, preset(base)].map(|style| boundary(&style, class));
            assert_ne!(own.dash, bases.dash, "{base}");
            assert_eq!(LineStyle { dash: bases.dash, ..own }, bases, "{base}");
        }
    }
    let tint =
        "[[tint]]\nshare = 0\ncolor = \"#000000\"\n[[tint]]\nshare = 1\ncolor = \"#FFFFFF\"\n";
    let own = style(&format!("base = \"dark\"\n{tint}"));
    assert_eq!((own.tint.heights, own.tint.stops.len()), (TintHeights::Shares, 2));
    assert_eq!(style("base = \"road-atlas\"\nown_width = false\n"), Style::road_atlas());
}

/// A base must be a built-in style, not a file. So no style can be its own base, directly or
/// indirectly.
#[test]
fn a_base_that_does_not_come_along_is_refused_with_those_that_do() {
    for base in [
        "\"mine.toml\"",
        "\"\"",
        "\"Road-Atlas\"",
        "\"config/styles/dark.toml\"",
        "3",
        "[\"dark\"]",
    ] {
        let error = parse_style(&format!("base = {base}\noutline_px = 1\n")).expect_err(base);
        assert!(matches!(error, StyleError::Base { .. }), "{base}: {error}");
        let said = error.to_string();
        assert!(said.contains("road-atlas, dark, relief, photo"), "{base}: {said}");
    }
    for name in style_preset_names() {
        let text = style_preset(name).unwrap();
        assert!(!text.lines().any(|line| line.starts_with("base")), "{name} has a base");
    }
}

#[test]
fn mistakes_beside_a_base_are_told_with_their_place() {
    for (text, words) in [
        ("neon = true", &["line 2", "unknown field `neon`"][..]),
        ("[roads.3]\nwidht_m = 3", &["line 3", "widht_m"]),
        ("[light]\nhillshade = \"much\"", &["line 3", "hillshade", "string"]),
        ("light = 3", &["line 2"]),
        ("[roads.9]\nwidth_m = 3", &["line 2", "missing field"]),
        ("[roads.3]\nwidth_m = 0", &["roads.3.width_m of 0", "0.1 to 500"]),
        ("[layers.areas.swamp]\ncolour = \"#000000\"", &["line 3", "colour"]),
        ("[layers.areas]\ncolour = \"#000000\"", &["line 3", "colour"]),
        ("layers = 3", &["line 2", "map"]),
        ("[layers]\nareas = 3", &["line 3", "map"]),
        ("[areas.forest]\nopacity = 1", &["line 2", "unknown field `areas`"]),
        ("base = \"dark\"", &["line 2", "duplicate key"]),
        ("[roads]\nbase = \"dark\"", &["line 3"]),
    ] {
        let said = refusal(text);
        assert!(words.iter().all(|word| said.contains(word)), "{text}: {said}");
    }
    let said = parse_style("outline_px = 1\n").expect_err("much is missing").to_string();
    assert!(said.contains("missing field"), "{said}");
}
