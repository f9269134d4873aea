//! The `[areas]` part of a style's text.

use std::collections::BTreeMap;

use corniche_areas::AreaClass;
use serde::Deserialize;

use crate::{
    AreaStyle, StyleError,
    sheet_values::{Rgb8, within},
};

/// How the areas of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AreaSheet {
    /// Colour.
    color: Rgb8,
    /// How much of the ground an area hides, 0 to 1; 0 does not draw the class.
    opacity: f64,
    /// Ground steeper than this is not painted, 1 to 89 degrees. Default: all ground is painted.
    steepest_deg: Option<f64>,
}

/// Returns the area styles by class. A complete style defines every class.
pub(crate) fn areas(
    sheets: &BTreeMap<String, AreaSheet>,
) -> Result<[AreaStyle; AreaClass::COUNT], StyleError> {
    let nothing = AreaStyle { color: [0.0; 3], opacity: 0.0, steepest_deg: None };
    let mut styles = [nothing; AreaClass::COUNT];
    for (name, sheet) in sheets {
        let Some(class) = AreaClass::from_name(name) else {
            return Err(StyleError::AreaClass { text: name.clone() });
        };
        within(&format!("areas.{name}.opacity"), sheet.opacity, 0.0..=1.0)?;
        if let Some(steepest_deg) = sheet.steepest_deg {
            within(&format!("areas.{name}.steepest_deg"), steepest_deg, 1.0..=89.0)?;
        }
        styles[usize::from(class.number())] = AreaStyle {
            color: sheet.color.into(),
            opacity: sheet.opacity as f32,
            steepest_deg: sheet.steepest_deg.map(|steepest_deg| steepest_deg as f32),
        };
    }
    Ok(styles)
}
