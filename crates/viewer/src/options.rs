//! How roads are drawn: option values that the command line, the window and the renderer share.

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use corniche_styles::{RoadStyle, Style, WidthScaling};

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RoadMethod {
    /// Roads are geometry lying on the TIN of their level (GEO).
    #[serde(rename = "geo")]
    Geometry,
    /// Roads are volumes that are intersected with the ground (SV).
    #[serde(rename = "sv")]
    ShadowVolumes,
    /// No roads are drawn.
    #[serde(rename = "none")]
    None,
}

/// How a road begins, ends and bends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Caps {
    /// Roads have a half disc around every point of the line.
    Round,
    /// Roads have no caps: every segment is a rectangle, and there are gaps at the outer side of bends.
    None,
}

/// How the fragment shader of volumes decides whether the ground at its pixel is road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CapTest {
    /// The distance in plan from that ground to the segment decides. It is exact to some hundredths of a pixel at any distance.
    Distance,
    /// The paper's formula decides: where the ray of view enters and leaves the volume, as the roots of a quadratic.
    /// It is imprecise far from the eye and is kept for comparison. Only for volumes.
    PaperQuadratic,
}

/// What the quad of a piece of road covers (GEO).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quads {
    /// All ground beside the piece, within the road's width.
    Beds,
    /// What lies as high as the piece: the quad is level across the road, as in the paper (section 4.2), so a road on a slope is too
    /// narrow (its Fig. 15). Kept for comparison. Only for geometry.
    Level,
}

/// What roads as geometry are laid on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Mapping {
    /// The triangles of their tile.
    #[default]
    OnTriangles,
    /// Nothing: they are straight from each point of their source to the next, and ground between two points hides them or lies below, as in Agrawal
    /// et al. 2006, Fig. 12. Kept for comparison.
    Unmapped,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outline {
    /// Outlines are as wide as the style says.
    #[serde(rename = "style")]
    OfStyle,
    /// No edge.
    #[serde(rename = "none")]
    None,
    /// One pixel: a kernel of 3 × 3.
    #[serde(rename = "3")]
    Kernel3,
    /// Two pixels: a kernel of 5 × 5.
    #[serde(rename = "5")]
    Kernel5,
}

/// Some of the functional road classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClassSet(u16);

impl FromIterator<FunctionalRoadClass> for ClassSet {
    fn from_iter<I: IntoIterator<Item = FunctionalRoadClass>>(classes: I) -> Self {
        classes.into_iter().fold(Self::NONE, Self::with)
    }
}

impl ClassSet {
    /// All of them.
    pub const ALL: Self = Self((1 << FunctionalRoadClass::COUNT) - 1);

    /// None of them.
    pub const NONE: Self = Self(0);

    /// Whether a class is among them.
    #[must_use]
    pub fn contains(self, class: FunctionalRoadClass) -> bool {
        self.0 >> class.number() & 1 == 1
    }

    /// These classes and one more.
    #[must_use]
    pub fn with(self, class: FunctionalRoadClass) -> Self {
        Self(self.0 | 1 << class.number())
    }

    /// The classes that are in both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The classes that are in one of them or in both.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// These classes, as a list, the most important first.
    pub fn iter(self) -> impl Iterator<Item = FunctionalRoadClass> {
        FunctionalRoadClass::all().filter(move |class| self.contains(*class))
    }

    /// These classes except one.
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
    /// The test in the fragment shader of volumes.
    pub cap_test: CapTest,
    /// What the quads of geometry cover.
    pub quads: Quads,
    /// How widths depend on distance.
    pub width_growth: WidthGrowth,
    /// The edge around roads.
    pub outline: Outline,
}

impl RoadOptions {
    /// The usual options of a method: all classes, round caps, the test by distance, everything else as the style says.
    #[must_use]
    pub fn of(method: RoadMethod) -> Self {
        Self {
            method,
            classes: ClassSet::ALL,
            caps: Caps::Round,
            cap_test: CapTest::Distance,
            quads: Quads::Beds,
            width_growth: WidthGrowth::ByDistance,
            outline: Outline::OfStyle,
        }
    }

    /// How the widths of a style's roads of a class grow with distance, with these options.
    #[must_use]
    pub fn width_scaling(&self, style: &Style, road: &RoadStyle) -> WidthScaling {
        let exponent = road.exponent.unwrap_or(style.width_scaling.exponent);
        let scaling = WidthScaling { exponent, ..style.width_scaling };
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
