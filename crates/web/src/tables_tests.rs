//! Styles and class names of the page are the bundled ones.

use corniche_styles::{parse_style, style_preset, style_preset_names};

use super::*;

#[test]
fn styles_are_those_of_the_program() {
    let names: Vec<&str> = style_preset_names().collect();
    assert_eq!(style_names(), names);
    for name in names {
        let text = style_preset(name).unwrap();
        assert_eq!(style(name), Ok(parse_style(text).unwrap()), "{name}");
    }
    let why = style("neon").unwrap_err();
    assert!(why.contains("there is no style \"neon\"; there are road-atlas"), "{why}");
}

#[test]
fn classes_have_names_and_those_of_other_tables_numbers() {
    assert_eq!(class_labels("default")[0], "motorway");
    assert_eq!(class_labels("mine")[3], "class 3");
}

#[test]
fn an_own_style_is_kept_by_its_address_until_it_comes_anew() {
    let [dark, relief] = ["dark", "relief"].map(|name| parse_style(style_preset(name).unwrap()));
    let (dark, relief) = (dark.unwrap(), relief.unwrap());
    let address = "styles/mine.toml";
    assert!(style(address).is_err());
    for text in ["dark", "relief"] {
        keep(&corniche_web_styles::style_table(address, style_preset(text).unwrap()).unwrap())
            .unwrap();
        let expected = if text == "dark" { &dark } else { &relief };
        assert_eq!(style(address).as_ref(), Ok(expected));
    }
    let damaged = keep(&[7, 0, 0, 0, 0, 0, 0, 0, 1]).unwrap_err();
    assert!(damaged.contains("different versions"), "{damaged}");
    assert_eq!(style(address), Ok(relief), "the one before stays");
    assert!(!style_names().contains(&address.to_owned()), "it does not come with the program");
}
