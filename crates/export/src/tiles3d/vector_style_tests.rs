//! Each road class has a colour and a width in the style of vector tiles.

use corniche_styles::Style;
use serde_json::Value;
use tempfile::TempDir;

use super::write;

/// Each class has a colour and a width; those of the first class come from the style.
#[test]
fn all_classes_have_a_look() {
    let folder = TempDir::new().unwrap();
    let mut style = Style::road_atlas();
    style.roads[0].max_width_px = Some(7.5);
    style.roads[1].max_width_px = None;
    style.roads[1].min_width_px = 0.25;
    let [red, green, blue] = style.roads[0].bands.main_color().map(|channel| channel * 255.0);
    write(folder.path(), &style).unwrap();
    let text = std::fs::read(folder.path().join("style.json")).unwrap();
    let document: Value = serde_json::from_slice(&text).unwrap();
    let value = |what: &str, class: usize| {
        let condition = &document[what]["conditions"][class];
        assert_eq!(condition[0], format!("${{class}} === {class}"));
        condition[1].as_str().unwrap().to_owned()
    };
    let all = |what: &str| document[what]["conditions"].as_array().unwrap().len();
    assert_eq!([all("color"), all("lineWidth")], [style.roads.len(); 2]);
    assert_eq!(
        value("color", 0),
        format!(
            "color('#{red:02x}{green:02x}{blue:02x}')",
            red = red as u8,
            green = green as u8,
            blue = blue as u8
        )
    );
    // A line thinner than a pixel is invisible.
    assert_eq!([value("lineWidth", 0), value("lineWidth", 1)], ["7.5", "1"]);
}
