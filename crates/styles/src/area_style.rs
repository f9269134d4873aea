//! The looks of areas: a colour and an opacity for each class.

use corniche_areas::AreaClass;
use serde::{Deserialize, Serialize};

use crate::Rgb;

/// How the areas of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AreaStyle {
    /// Colour.
    pub color: Rgb,
    /// How much of the ground it hides: 1 hides it, with 0 the class is not drawn.
    pub opacity: f32,
    /// Ground steeper than this is not painted, degrees; from 0.7 of its tangent on less and less is. `None`: all ground is.
    pub steepest_deg: Option<f32>,
}

impl AreaStyle {
    /// From this share of the tangent of [`AreaStyle::steepest_deg`] on the ground shows through.
    pub const STEEP_SHARE: f64 = 0.7;

    /// All classes, the topmost first. Where areas of several classes that are drawn overlap, the first of them is seen alone:
    /// colours of classes are never mixed. Within a class areas are a union.
    ///
    /// What is drawn small and sharp on maps lies above what is wide: water in a forest is water, a park in a town is a park.
    pub const TOP_FIRST: [AreaClass; AreaClass::COUNT] = [
        AreaClass::Sea,
        AreaClass::Water,
        AreaClass::Glacier,
        AreaClass::Forest,
        AreaClass::Rock,
        AreaClass::Park,
        AreaClass::Meadow,
        AreaClass::Settlement,
    ];

    /// Whether anything of the class is drawn.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.opacity > 0.0
    }
}
