use corniche_styles::{parse_style, style_preset, style_preset_names};

use super::*;

#[test]
fn styles_are_those_of_the_program() {
    let names: Vec<&str> = style_preset_names().collect();
    assert_eq!(style_names(), names);
    for name in names {
        let text = style_preset(name).unwrap();
        assert_eq!(style(name), Some(parse_style(text).unwrap()), "{name}");
    }
    assert_eq!(style("neon"), None);
}

#[test]
fn classes_have_names_and_those_of_other_tables_numbers() {
    assert_eq!(class_labels("default")[0], "motorway");
    assert_eq!(class_labels("mine")[3], "class 3");
}
