//! How roads are drawn: option values that the command line, the window and the renderer share.

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use corniche_styles::{RoadStyle, Style, WidthScaling};

/// The method by which roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RoadMethod {
    /// Roads are geometry on the TIN of their level (GEO).
    #[serde(rename = "geo")]
    Geometry,
    /// Roads are shadow volumes that are intersected with the ground (SV).
    #[serde(rename = "sv")]
    ShadowVolumes,
    /// No roads are drawn.
    #[serde(rename = "none")]
    None,
}

/// The ends and bends of roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Caps {
    /// Roads have a half disc around every point of the line.
    Round,
    /// Roads have no caps: every segment is a rectangle, and there are gaps at the outer side of
    /// bends.
    None,
}

/// How the fragment shader of volumes decides whether the ground at its pixel is road.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CapTest {
    /// The distance in plan from that ground to the segment decides. It is exact to some hundredths
    /// of a pixel at any distance.
    Distance,
    /// The paper's formula decides: where the ray of view enters and leaves the volume, as the
    /// roots of a quadratic. It is imprecise far from the eye and is kept for comparison. Only for
    /// volumes.
    PaperQuadratic,
}

/// The ground that the quad of a piece of road covers (GEO).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quads {
    /// All ground next to the piece, within the road's width.
    Beds,
    /// Only ground as high as the piece: the quad is level across the road, as in the paper
    /// (section 4.2), so a road on a slope is too narrow (Fig. 15 of the paper). Kept for
    /// comparison. Only for geometry.
    Level,
}

/// The surface that roads as geometry are draped on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Mapping {
    /// The triangles of their tile.
    #[default]
    OnTriangles,
    /// Nothing: roads are straight from each point of their source to the next, and ground between
    /// two points hides them or is below them, as in Agrawal et al. 2006, Fig. 12. Kept for
    /// comparison.
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

/// The edge around roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RoadOutline {
    /// Width from the style.
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

/// A set of functional road classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClassSet(u16);

impl FromIterator<FunctionalRoadClass> for ClassSet {
    fn from_iter<I: IntoIterator<Item = FunctionalRoadClass>>(classes: I) -> Self {
        classes.into_iter().fold(Self::NONE, Self::with)
    }
}

impl ClassSet {
    /// The set of all classes.
    pub const ALL: Self = Self((1 << FunctionalRoadClass::COUNT) - 1);

    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Whether a class is in the set.
    #[must_use]
    pub fn contains(self, class: FunctionalRoadClass) -> bool {
        self.0 >> class.number() & 1 == 1
    }

    /// Returns the set with one more class.
    #[must_use]
    pub fn with(self, class: FunctionalRoadClass) -> Self {
        Self(self.0 | 1 << class.number())
    }

    /// Returns the intersection of two sets.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the union of two sets.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Iterates over the classes, the most important first.
    pub fn iter(self) -> impl Iterator<Item = FunctionalRoadClass> {
        FunctionalRoadClass::all().filter(move |class| self.contains(*class))
    }

    /// Returns the set without one class.
    #[must_use]
    pub fn without(self, class: FunctionalRoadClass) -> Self {
        Self(self.0 & !(1 << class.number()))
    }
}

/// How the roads of a picture are drawn; colours and widths come from the style.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoadOptions {
    /// The method.
    pub method: RoadMethod,
    /// The classes to draw; other roads are omitted.
    pub classes: ClassSet,
    /// Ends and bends of roads.
    pub caps: Caps,
    /// Test in the fragment shader of volumes.
    pub cap_test: CapTest,
    /// Ground that the quads of geometry cover.
    pub quads: Quads,
    /// How widths depend on distance.
    pub width_growth: WidthGrowth,
    /// Edge around roads.
    pub outline: RoadOutline,
}

impl RoadOptions {
    /// The usual options of a method: all classes, round caps, the test by distance, everything
    /// else as in the style.
    #[must_use]
    pub fn for_method(method: RoadMethod) -> Self {
        Self {
            method,
            classes: ClassSet::ALL,
            caps: Caps::Round,
            cap_test: CapTest::Distance,
            quads: Quads::Beds,
            width_growth: WidthGrowth::ByDistance,
            outline: RoadOutline::OfStyle,
        }
    }

    /// How the widths of roads in a style grow with distance, with these options.
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
            RoadOutline::OfStyle => style.outline_px,
            RoadOutline::None => 0,
            RoadOutline::Kernel3 => 1,
            RoadOutline::Kernel5 => 2,
        }
    }
}

#[cfg(test)]
#[path = "options_tests.rs"]
mod tests;
