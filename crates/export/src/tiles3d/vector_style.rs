//! The appearance of vector content, which is not stored in its tiles.
//!
//! Source: Open Geospatial Consortium 2023, *3D Tiles Specification* (22-025r4), *Declarative
//! Styling*, with the `lineWidth` of CesiumJS 1.145.

use std::{fs, io, path::Path};

use corniche_styles::{RoadStyle, Style};
use serde_json::{Value, json};

/// The file's name.
const NAME: &str = "style.json";

/// Writes colours and widths by class. Widths are pixels: the largest width to which the style lets
/// roads grow with distance.
pub(crate) fn write(folder: &Path, style: &Style) -> io::Result<()> {
    let by_class = |value: &dyn Fn(&RoadStyle) -> String| {
        let conditions: Vec<Value> = (0..)
            .zip(&style.roads)
            .map(|(class, road): (usize, _)| {
                json!([format!("${{class}} === {class}"), value(road)])
            })
            .collect();
        json!({ "conditions": conditions })
    };
    let document = json!({
        "color": by_class(&|road| format!("color('{}')", hex(road))),
        "lineWidth": by_class(&|road| road.flat_width_px().to_string()),
    });
    fs::write(folder.join(NAME), serde_json::to_vec_pretty(&document)?)
}

fn hex(road: &RoadStyle) -> String {
    let [red, green, blue] = corniche_styles::to_bytes(road.bands.main_color());
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
#[path = "vector_style_tests.rs"]
mod tests;
