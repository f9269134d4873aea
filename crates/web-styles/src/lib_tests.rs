//! A style arrives in the page's module unchanged.

use corniche_styles::{style_preset, style_preset_names};

use super::*;

/// Reads a table as `corniche-web` does.
fn read(table: &[u8]) -> Vec<(String, Style)> {
    let config = bincode::config::legacy();
    let (read, bytes) = bincode::serde::decode_from_slice(table, config).unwrap();
    assert_eq!(bytes, table.len(), "nothing is left");
    read
}

#[test]
fn a_style_arrives_as_it_was_written() {
    for name in style_preset_names() {
        let text = style_preset(name).unwrap();
        let table = style_table("styles/mine.toml", text).unwrap();
        assert_eq!(read(&table), [("styles/mine.toml".to_owned(), parse_style(text).unwrap())]);
        // A custom style can have a base like a bundled style.
        let own = format!("base = \"{name}\"\n[roads.2]\nwidth_m = 31\n");
        let arrived = read(&style_table("styles/mine.toml", &own).unwrap()).remove(0).1;
        let mut expected = parse_style(text).unwrap();
        // The carriageway of the base is kept with its width.
        (expected.roads[2].width_m, expected.roads[2].carriageway_width_m) = (31.0, 31.0);
        assert_eq!(arrived, expected);
    }
}

#[test]
fn what_is_no_style_is_told_as_by_the_program() {
    let text = style_preset("dark").unwrap();
    let unknown = format!("neon = true\n{text}");
    let out_of_range = text.replacen("outline_px = 1", "outline_px = 9", 1);
    let too_long = format!("{text}\n#{}", " ".repeat(1 << 20));
    for (text, told) in [
        ("a page, not a style", "TOML parse error at line 1"),
        (&unknown, "unknown field `neon`"),
        (&out_of_range, "outline_px of 9 is out of range; it must be 0 to 4"),
        (&too_long, "a style may have at most"),
        ("base = \"mine.toml\"", "not a built-in style"),
    ] {
        let why = style_table("mine.toml", text).unwrap_err();
        assert!(why.contains(told), "{why}");
        assert_eq!(why, parse_style(text).unwrap_err().to_string());
    }
}
