//! The part of a style's text that is about areas.

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
    /// How much of the ground it hides, 0 to 1; 0 does not draw the class.
    opacity: f64,
    /// Ground steeper than this is not painted, 1 to 89 degrees; left out: all ground is.
    steepest_deg: Option<f64>,
}

/// The areas by class, of which a whole style names each.
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
