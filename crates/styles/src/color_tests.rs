//! Colours follow CSS; the error for an invalid colour says what to write.

use super::*;

#[test]
fn colours_are_read_as_css_has_them() {
    for (text, bytes) in [
        ("#D93A2B", [217, 58, 43]),
        ("#d93a2b", [217, 58, 43]),
        ("#f80", [255, 136, 0]),
        // CSS Color Module Level 4, 6.1.
        ("tomato", [255, 99, 71]),
        ("RebeccaPurple", [102, 51, 153]),
        ("lightgray", [211, 211, 211]),
        ("lightgrey", [211, 211, 211]),
        ("rgb(1, 2, 3)", [1, 2, 3]),
        ("black", [0, 0, 0]),
    ] {
        assert_eq!(parse_color(text).map(to_bytes), Ok(bytes), "{text}");
    }
}

#[test]
fn what_is_no_opaque_colour_is_refused() {
    for text in [
        "",
        "#",
        "red1",
        "#12345",
        "#+12345",
        "transparent",
        "#11223344",
        "rgb(0 0 0 / 50%)",
        "#D93A2B x",
    ] {
        let said = parse_color(text).unwrap_err().to_string();
        let hint = ["tomato", "the opacity separately"].iter().any(|hint| said.contains(hint));
        assert!(said.contains(&format!("{text:?}")) && hint, "{text}: {said}");
    }
    let said = parse_color(&"x".repeat(66_000)).unwrap_err().to_string();
    assert!(said.len() < 200, "{said}");
}
