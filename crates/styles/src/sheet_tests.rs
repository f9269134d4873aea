//! The built-in styles follow their rules, and errors name the mistakes in a style.

use super::*;
use crate::{Rgb, TintHeights, style_preset, style_preset_names};

fn atlas() -> &'static str {
    style_preset("road-atlas").expect("the default style is there")
}

/// Checks that the road atlas with `from` replaced by `to` is rejected with a message that has all
/// these words.
fn refuses(from: &str, to: &str, words: &[&str]) {
    let text = atlas().replacen(from, to, 1);
    assert_ne!(text, atlas(), "{from:?} is not in the style");
    let error = parse_style(&text).expect_err(to).to_string();
    for word in words {
        assert!(error.contains(word), "{to:?}: no {word:?} in {error}");
    }
}

#[test]
fn the_styles_that_come_along_are_styles_of_ordered_roads() {
    assert_eq!(style_preset_names().collect::<Vec<_>>(), ["road-atlas", "dark", "relief", "photo"]);
    for name in style_preset_names() {
        let style = parse_style(style_preset(name).unwrap()).unwrap();
        assert!(
            style
                .roads
                .is_sorted_by(|a, b| a.width_m > b.width_m && a.min_width_px >= b.min_width_px),
            "{name}: more important roads are wider"
        );
        assert_eq!(style.roads[8].bands.all().len(), 1, "{name}");
    }
    assert!(style_preset("road atlas").is_none());
}

/// Relative luminance as WCAG 2.2 defines it.
fn luminance(color: Rgb) -> f64 {
    let [r, g, b] = color.map(|channel| {
        let share = f64::from(channel);
        if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
    });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The contrast of main roads, tracks and edges with level ground in the light.
#[test]
fn dark_roads_glow_and_their_edges_are_darker_than_any_ground() {
    let style = parse_style(style_preset("dark").unwrap()).unwrap();
    let contrast = |a: Rgb, b: Rgb| {
        let [a, b] = [a, b].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    };
    // The two highest tints are rock and snow; roads there are rare, and low classes blend into
    // these colours.
    let ground = &style.tint.stops[..style.tint.stops.len() - 2];
    for (class, road) in style.roads.iter().enumerate() {
        for (height_m, tint) in ground {
            let least = if class <= 4 { 4.5 } else { 1.7 };
            // Motorways have a pale centre line.
            let bands = road.bands.all().iter().map(|band| band.color);
            let reached = bands.map(|color| contrast(color, *tint)).fold(1.0, f64::max);
            assert!(reached >= least, "class {class} at {height_m} m: {reached:.2}");
            assert!(luminance(road.bands.main_color()) > luminance(*tint), "class {class} glows");
            assert!(luminance(road.outline) < luminance(*tint), "class {class} has an edge");
        }
    }
}

#[test]
fn colours_are_those_of_css() {
    assert_eq!(Rgb8::try_from("#ff0033".to_owned()), Ok(Rgb8([255, 0, 0x33])));
    assert_eq!(Rgb8::try_from("red".to_owned()), Ok(Rgb8([255, 0, 0])));
    for bad in ["ff0033", "#ff003", "#ff00330", "#+f0033", "#gg0000", "", "#", "#é0033", "redd"] {
        assert!(Rgb8::try_from(bad.to_owned()).is_err(), "{bad}");
    }
    refuses("\"#C50D2B\"", "\"#C50D2\"", &["line", "#C50D2", "colour"]);
}

#[test]
fn the_default_style_is_the_viewers_own() {
    let parsed = |name| parse_style(style_preset(name).unwrap()).unwrap();
    assert_eq!(parsed("road-atlas"), Style::road_atlas());
    assert_ne!(parsed("dark"), Style::road_atlas());
}

/// Checks that the road atlas with another value of this entry is rejected with a message that has
/// all these words.
fn refuses_value(table: &str, key: &str, value: &str, words: &[&str]) {
    let all = atlas();
    let start = if table.is_empty() {
        0
    } else {
        all.find(&format!("\n[{table}]\n")).unwrap_or_else(|| panic!("no table {table}"))
    };
    let entry = format!("\n{key} = ");
    let at = start + all[start..].find(&entry).unwrap_or_else(|| panic!("no {key}")) + 1;
    let end = at + all[at..].find('\n').unwrap_or(all.len() - at);
    let text = format!("{}{key} = {value}{}", &all[..at], &all[end..]);
    let error = parse_style(&text).expect_err(value).to_string();
    for word in words {
        assert!(error.contains(word), "{key} = {value}: no {word:?} in {error}");
    }
}

#[test]
fn numbers_out_of_their_range_are_named_with_it() {
    for (table, key, value, range) in [
        ("roads.0", "width_m", "0", "0.1 to 500"),
        ("roads.0", "carriageway_width_m", "25", "0.1 to 24"),
        ("roads.8", "width_m", "nan", "NaN"),
        ("roads.1", "min_width_px", "51", "0.1 to 50"),
        ("roads.2", "max_pixel_m", "0", "0.01 to 1000000"),
        ("roads.0", "max_width_px", "0", "0.1 to 500"),
        ("layers.areas.sea", "opacity", "1.1", "0 to 1"),
        ("light", "azimuth_deg", "361", "0 to 360"),
        ("light", "altitude_deg", "91", "0 to 90"),
        ("light", "sky", "-1", "0 to 1"),
        ("light", "gentle", "0", "1 to 10"),
        ("light", "valley_haze", "nan", "0 to 1"),
        ("light", "hillshade", "1.1", "0 to 1"),
        ("background", "haze_reach", "0", "0.1 to 1000"),
        ("width_scaling", "exponent", "-0.1", "0 to 1"),
        ("width_scaling", "constant", "0", "0.1 to 100"),
    ] {
        refuses_value(table, key, value, &[&format!("{table}.{key}"), range]);
    }
    refuses_value("width_scaling", "threshold_m", "inf", &["threshold_m", "1 to 10000000"]);
    refuses_value("", "outline_px", "5", &["outline_px", "0 to 4"]);
    refuses(
        "width_share = 0.3",
        "width_share = 1",
        &["roads.0.center.width_share", "0.01 to 0.99"],
    );
    let see_through = "[roads.0]\nopacity = 1.5";
    refuses("[roads.0]", see_through, &["roads.0.opacity", "0.01 to 1"]);
}

#[test]
fn what_is_unknown_or_left_out_is_named() {
    refuses("hillshade = ", "hillshading = ", &["line", "hillshading"]);
    refuses("sky = \"#9FC1E0\"\n", "", &["sky"]);
    refuses("[roads.4]", "[roads.04]", &["04", "0 to 8"]);
    refuses("[roads.4]", "[roads.9]", &["9", "0 to 8"]);
    let without = atlas().split("[roads.8]").next().expect("split gives one part at least");
    let error = parse_style(without).unwrap_err().to_string();
    assert!(error.contains("roads.8") && error.contains("missing"), "{error}");
    assert!(matches!(parse_style(&"#".repeat(2 << 20)), Err(StyleError::TooLong { .. })));
}

/// `color` and `center` are the short form of two bands.
#[test]
fn bands_may_be_written_instead_of_a_colour_and_a_centre_line() {
    let short = "color = \"#C50D2B\"\noutline = \"#6B1413\"\ncenter = { width_share = 0.3, color = \"#FFE88A\" }";
    let with = |bands: &str| {
        let text = atlas().replacen(short, &format!("outline = \"#6B1413\"\n{bands}"), 1);
        assert_ne!(text, atlas());
        parse_style(&text).map(|style| style.roads[0].bands)
    };
    let long = "bands = [{ width = 1, color = \"#C50D2B\" }, { width = 0.3, color = \"#FFE88A\" }]";
    assert_eq!(with(long).unwrap(), Style::road_atlas().roads[0].bands);
    let band = |width: f64| format!("{{ width = {width}, color = \"#102030\" }}");
    let bands = |widths: &[f64]| {
        let all: Vec<String> = widths.iter().map(|width| band(*width)).collect();
        format!("bands = [{}]", all.join(", "))
    };
    assert_eq!(with(&bands(&[1.0, 0.8, 0.6, 0.4, 0.3, 0.2, 0.1])).unwrap().all().len(), 7);
    for (text, words) in [
        (String::new(), &["[roads.0]", "either color"][..]),
        (format!("color = \"#102030\"\n{long}"), &["[roads.0]", "either color"]),
        (
            format!("center = {{ width_share = 0.3, color = \"#102030\" }}\n{long}"),
            &["either color"],
        ),
        (bands(&[]), &["[roads.0]", "1 to 16 bands, not 0"]),
        (bands(&[1.0; 17]), &["1 to 16 bands, not 17"]),
        (bands(&[0.8, 0.5]), &["[roads.0]", "first band", "0.8"]),
        (bands(&[1.0, 0.5, 0.5]), &["band 3", "must decrease"]),
        (bands(&[1.0, 0.001]), &["band 2", "below 0.01"]),
        (bands(&[1.0, f64::NAN]), &["band 2"]),
    ] {
        let error = with(&text.replace("NaN", "nan")).unwrap_err().to_string();
        for word in words {
            assert!(error.contains(word), "{text}: no {word:?} in {error}");
        }
    }
}

/// Returns the road atlas with its tint replaced by this one.
fn with_tint(entries: &[&str], by_climate: bool) -> Result<Style, StyleError> {
    let mut text = String::new();
    let mut is_tint = false;
    for line in atlas().lines().filter(|line| !line.starts_with("tint_by_climate")) {
        if line.starts_with('[') {
            is_tint = line == "[[tint]]";
        }
        if !is_tint {
            text += line;
            text += "\n";
        }
    }
    for entry in entries {
        text.extend(["[[tint]]\n", entry, "\ncolor = \"#808080\"\n"]);
    }
    parse_style(&format!("tint_by_climate = {by_climate}\n{text}"))
}

#[test]
fn tints_ascend_by_shares_or_by_metres() {
    let shares = with_tint(&["share = 0", "share = 0.4", "share = 1"], false).unwrap();
    assert_eq!(shares.tint.heights, TintHeights::Shares);
    assert_eq!(shares.tint.stops.len(), 3);
    let metres = with_tint(&["height_m = -20", "height_m = 8848"], false).unwrap();
    assert_eq!(metres.tint.heights, TintHeights::Metres);
    let climate = with_tint(&["height_m = 0", "height_m = 3000"], true).unwrap();
    assert_eq!(climate.tint.heights, TintHeights::MetresByClimate);
    let order = "ascend from 0 to 1";
    let many: Vec<String> = (0..13).map(|k| format!("height_m = {}", k * 100)).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    for (entries, by_climate, words) in [
        (&["share = 0", "share = 0", "share = 1"][..], false, order),
        (&["share = 0", "share = nan", "share = 1"], false, order),
        (&["share = 0", "share = 1e-320", "share = 1"], false, order),
        (&["share = 0.1", "share = 1"], false, order),
        (&["share = 0", "share = 0.9"], false, order),
        (&["share = 0"], false, "2 to 12 [[tint]] entries, not 1"),
        (&many, false, "2 to 12 [[tint]] entries, not 13"),
        (&["share = 0", "height_m = 100"], false, "either share in all entries"),
        (&["share = 0\nheight_m = 0", "share = 1\nheight_m = 9"], false, "either share"),
        (&["share = 0", "share = 1"], true, "tint_by_climate"),
        (&["height_m = 100", "height_m = 100.5"], false, "ascend, by 1 m"),
        (&["height_m = 100", "height_m = nan"], false, "tint.height_m"),
        (&["height_m = 0", "height_m = 9001"], false, "-12000 to 9000"),
    ] {
        let error = with_tint(entries, by_climate).unwrap_err().to_string();
        assert!(error.contains(words), "{entries:?}: {error}");
    }
}

/// Styles that are older than these entries are still valid.
#[test]
fn new_entries_of_light_and_background_may_be_left_out() {
    let added = [
        "sky = 0.",
        "gentle = ",
        "valley_haze = ",
        "shadow = ",
        "sunlit = ",
        "water = ",
        "wall = ",
    ];
    let text: String = atlas()
        .lines()
        .filter(|line| !added.iter().any(|entry| line.starts_with(entry)))
        .fold(String::new(), |text, line| text + line + "\n");
    assert_eq!(atlas().lines().count() - text.lines().count(), added.len());
    assert_eq!(parse_style(&text).unwrap(), Style::road_atlas());
}

/// Without the entry, and with `own_width = false`, only the class sets the width of a road.
#[test]
fn own_widths_are_off_unless_the_style_turns_them_on() {
    let with = |lines: &str| {
        let text: String = atlas()
            .lines()
            .filter(|line| !line.starts_with("own_width"))
            .fold(String::new(), |text, line| text + line + "\n");
        parse_style(&format!("{lines}\n{text}")).map(|style| style.own_widths)
    };
    assert_eq!(parse_style(atlas()).unwrap().own_widths, None);
    assert_eq!(with("").unwrap(), None);
    assert_eq!(with("own_width = false").unwrap(), None);
    assert_eq!(with("own_width = true").unwrap(), Some(OwnWidths { lane_m: None }));
    let lanes = "own_width = true\nlane_width_m = 3.25";
    assert_eq!(with(lanes).unwrap(), Some(OwnWidths { lane_m: Some(3.25) }));
    for (lines, words) in [
        ("lane_width_m = 3.25", "no effect without own_width"),
        ("own_width = false\nlane_width_m = 3.25", "no effect without own_width"),
        (
            "own_width = true\nlane_width_m = 0.5",
            "lane_width_m of 0.5 is out of range; it must be 1 to 10",
        ),
        ("own_width = true\nlane_width_m = 10.5", "1 to 10"),
        ("own_width = true\nlane_width_m = nan", "1 to 10"),
        ("own_width = 3.5", "expected a boolean"),
    ] {
        let error = with(lines).unwrap_err().to_string();
        assert!(error.contains(words), "{lines:?}: {error}");
    }
}
