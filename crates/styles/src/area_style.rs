//! The styles of areas: a colour and an opacity for each class.

use corniche_areas::AreaClass;
use serde::{Deserialize, Serialize};

use crate::Rgb;

/// How the areas of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AreaStyle {
    /// Colour.
    pub color: Rgb,
    /// How much of the ground an area hides: 1 hides it completely, 0 does not draw the class.
    pub opacity: f32,
    /// Ground steeper than this is not painted, degrees. From 0.7 times its tangent on, the paint
    /// fades. `None`: all ground is painted.
    pub steepest_deg: Option<f32>,
}

impl AreaStyle {
    /// From this share of the tangent of [`AreaStyle::steepest_deg`] on, the ground shows through.
    pub const STEEP_SHARE: f64 = 0.7;

    /// All classes, the topmost first. Where drawn areas of several classes overlap, only the first
    /// of these classes is visible: colours of classes are never mixed. Areas of one class form a
    /// union.
    ///
    /// Classes that maps draw small and sharp are above classes that cover wide ground: water in a
    /// forest is water, a park in a town is a park.
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
