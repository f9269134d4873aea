//! How roads are drawn: option values that the command line, the window and the renderer share.

use corniche_roads::FunctionalRoadClass;

use crate::style::{Style, WidthScaling};

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadMethod {
    /// As geometry lying on the TIN of their level (GEO).
    Geometry,
    /// As volumes cut with the ground (SV).
    ShadowVolumes,
    /// Not at all.
    None,
}

/// How a road begins, ends and bends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Caps {
    /// With a half disc around every point of the line.
    Round,
    /// Cut off straight: every segment is a rectangle, and bends gape.
    None,
}

/// How a fragment of a volume finds out whether the ground it sees is road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CapTest {
    /// By the distance in plan from that ground to the segment. Exact to some hundredths of a pixel anywhere.
    Distance,
    /// By the paper's formula: where the ray of view enters and leaves the volume, as the roots of a quadratic.
    /// Loses its digits far from the eye; there for comparison. Volumes only.
    PaperQuadratic,
}

/// How widths depend on the distance from the eye (the paper, Fig. 10).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WidthGrowth {
    /// True widths.
    None,
    /// True widths times [`WidthScaling::constant`].
    Constant,
    /// True widths near the eye, growing beyond [`WidthScaling::threshold_m`].
    ByDistance,
}

/// The edge drawn around roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// As wide as the style says.
    OfStyle,
    /// None.
    None,
    /// One pixel: a kernel of 3 × 3.
    Kernel3,
    /// Two pixels: a kernel of 5 × 5.
    Kernel5,
}

/// Some of the functional road classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClassSet(u16);

impl ClassSet {
    /// All of them.
    pub const ALL: Self = Self((1 << FunctionalRoadClass::COUNT) - 1);

    /// Whether a class is among them.
    #[must_use]
    pub fn contains(self, class: FunctionalRoadClass) -> bool {
        self.0 >> class.number() & 1 == 1
    }

    /// These and a class.
    #[must_use]
    pub fn with(self, class: FunctionalRoadClass) -> Self {
        Self(self.0 | 1 << class.number())
    }

    /// These but for a class.
    #[must_use]
    pub fn without(self, class: FunctionalRoadClass) -> Self {
        Self(self.0 & !(1 << class.number()))
    }
}

/// How the roads of a picture are drawn; colours and widths are the style's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoadOptions {
    /// The method.
    pub method: RoadMethod,
    /// Roads of other classes are left out.
    pub classes: ClassSet,
    /// Ends and bends.
    pub caps: Caps,
    /// The test in the fragments of volumes.
    pub cap_test: CapTest,
    /// Widths over distance.
    pub width_growth: WidthGrowth,
    /// The edge.
    pub outline: Outline,
}

impl RoadOptions {
    /// The method as it is meant to be seen: all classes, round caps, decided by distance, all else by the style.
    #[must_use]
    pub fn of(method: RoadMethod) -> Self {
        Self {
            method,
            classes: ClassSet::ALL,
            caps: Caps::Round,
            cap_test: CapTest::Distance,
            width_growth: WidthGrowth::ByDistance,
            outline: Outline::OfStyle,
        }
    }

    /// The growth of widths of a style that is drawn so.
    #[must_use]
    pub fn width_scaling(&self, style: &Style) -> WidthScaling {
        let scaling = style.width_scaling;
        match self.width_growth {
            WidthGrowth::None => WidthScaling { exponent: 0.0, constant: 1.0, ..scaling },
            WidthGrowth::Constant => WidthScaling { exponent: 0.0, ..scaling },
            WidthGrowth::ByDistance => WidthScaling { constant: 1.0, ..scaling },
        }
    }

    /// Radius of the outline's kernel, pixels.
    #[must_use]
    pub fn outline_px(&self, style: &Style) -> u32 {
        match self.outline {
            Outline::OfStyle => style.outline_px,
            Outline::None => 0,
            Outline::Kernel3 => 1,
            Outline::Kernel5 => 2,
        }
    }
}

#[cfg(test)]
#[path = "options_tests.rs"]
mod tests;
