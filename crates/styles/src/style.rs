//! How the map looks: plain values, no GPU.

use corniche_areas::AreaClass;
use corniche_roads::{Form, FunctionalRoadClass, OwnWidth, RoadAttributes};
use serde::{Deserialize, Serialize};

use crate::{AreaStyle, Dash, Light, LineStyle, Rgb, RoadBands, Tint};

/// How the roads of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RoadStyle {
    /// Width on the ground near the eye.
    pub width_m: f32,
    /// Width of one of two carriageways, there.
    pub carriageway_width_m: f32,
    /// Roads are never drawn thinner than this.
    pub min_width_px: f32,
    /// Colours of the surface, from the edges to the middle.
    pub bands: RoadBands,
    /// Colour of the edge.
    pub outline: Rgb,
    /// The most true metres of ground in a pixel at which roads are drawn in full; beyond, they become fainter. `None`:
    /// they always are.
    pub max_pixel_m: Option<f32>,
    /// Where widths grow with distance, roads grow no wider than this; `None`: without end. What is wider near the eye stays so.
    pub max_width_px: Option<f32>,
    /// How widths grow with distance, instead of [`WidthScaling::exponent`].
    pub exponent: Option<f32>,
    /// The most true metres of ground in a pixel at which roads have their edge in full; at twice as many they have none. `None`: they
    /// always have it.
    pub edge_max_pixel_m: Option<f32>,
    /// Colour where a road has no edge; [`RoadBands::main_color`] where it is `None`.
    pub thin: Option<Rgb>,
    /// How much of the ground a road hides, edge included: 1 hides it.
    pub opacity: f32,
    /// Dashes along it.
    pub dash: Dash,
}

impl RoadStyle {
    /// Width of service roads as a share of that of their class, and of slip roads as a share of a carriageway of theirs.
    pub const NARROW_WIDTH_SHARE: f32 = 0.6;

    /// The same with other widths on the ground.
    #[must_use]
    pub fn widened(mut self, factor: f32) -> Self {
        self.width_m *= factor;
        self.carriageway_width_m *= factor;
        self
    }

    /// Width on a flat map: the most that roads grow to with distance. Thinner than a pixel is not seen.
    #[must_use]
    pub fn flat_width_px(&self) -> f32 {
        self.max_width_px.unwrap_or(self.min_width_px).max(1.0)
    }
}

/// How much roads widen with distance (the paper, section 6.2 and Fig. 10).
///
/// Up to `threshold_m` a road has its true width. Beyond, the width is multiplied by
/// `(distance / threshold_m) ^ exponent`. With exponent 0, roads become smaller with distance like everything else; with 1,
/// they keep their width in pixels. In between, far roads remain visible and still look far.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WidthScaling {
    /// Distance from the eye up to which widths are true.
    pub threshold_m: f32,
    /// 0 to 1.
    pub exponent: f32,
    /// Factor on all widths; 1 is true.
    pub constant: f32,
}

impl WidthScaling {
    /// Factor on the width at a distance from the eye.
    #[must_use]
    pub fn factor(&self, distance_m: f64) -> f64 {
        let growth = (distance_m / f64::from(self.threshold_m)).max(1.0);
        f64::from(self.constant) * libm::pow(growth, f64::from(self.exponent))
    }
}

/// Roads are drawn by their own tags, where they have some.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OwnWidths {
    /// Width of one lane: roads with `lanes` and without `width` are so many times as wide. `None`: `lanes` are not looked at.
    pub lane_m: Option<f32>,
}

impl OwnWidths {
    /// Tags make no road wider than this: what is tagged beyond it is rather an error, or the width of a square.
    pub const WIDEST_M: f32 = 60.0;

    /// The widest lane that a style may have.
    pub const WIDEST_LANE_M: f32 = 10.0;

    /// The width that a road's tags ask for, metres, before it is capped; `None` if they do not say.
    #[must_use]
    pub fn asked_m(self, own: OwnWidth) -> Option<f32> {
        match own {
            OwnWidth::Unknown => None,
            OwnWidth::Millimetres(mm) => Some((f64::from(mm.get()) / 1e3) as f32),
            OwnWidth::Lanes(lanes) => self.lane_m.map(|lane_m| f32::from(lanes.get()) * lane_m),
        }
    }
}

/// How the map looks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Style {
    /// The roads of each class, 0 first.
    pub roads: [RoadStyle; FunctionalRoadClass::COUNT],
    /// The areas of each class, in order of their numbers. Which lies above which is said by [`AreaStyle::TOP_FIRST`].
    pub areas: [AreaStyle; AreaClass::COUNT],
    /// Boundaries, by class.
    pub boundaries: [LineStyle; LineStyle::MOST],
    /// Lines of people's own files, in the order of the files.
    pub overlays: [LineStyle; LineStyle::MOST],
    /// Lines that a person draws.
    pub drawn: LineStyle,
    /// Whether roads are drawn by their own tags; `None`: all roads of a class are equally wide.
    pub own_widths: Option<OwnWidths>,
    /// How roads widen with distance.
    pub width_scaling: WidthScaling,
    /// Width of the edge of roads; the kernel has this radius.
    pub outline_px: u32,
    /// Roads that stand alone, with no more of their class and above around them, are drawn where together they are at least so long.
    /// 0: everywhere.
    pub shortest_part_px: f32,
    /// Colours of the ground by its height.
    pub tint: Tint,
    /// The light on the ground.
    pub light: Light,
    /// How strongly photos are seen where a package has some, 0 (not) to 1 (instead of the height tint).
    pub photo: f32,
    /// Colour of far ground and of the sky at the horizon.
    pub haze: Rgb,
    /// Colour of the sky far above the horizon.
    pub sky: Rgb,
    /// Colour where there is no ground, below the horizon.
    pub void: Rgb,
    /// Colour of level ground at or below 0 m.
    pub water: Rgb,
    /// Colour of the wall along the edge of the data.
    pub wall: Rgb,
    /// Ground at this many times the distance of what is looked at has lost two thirds of its colour.
    pub haze_reach: f32,
}

impl Style {
    /// The same without any areas.
    #[must_use]
    pub fn without_areas(self) -> Self {
        let areas = self.areas.map(|area| AreaStyle { opacity: 0.0, ..area });
        Self { areas, ..self }
    }

    /// Whether areas of some class are drawn.
    #[must_use]
    pub fn has_areas(&self) -> bool {
        self.areas.iter().any(AreaStyle::is_drawn)
    }

    /// The same without any boundaries.
    #[must_use]
    pub fn without_boundaries(self) -> Self {
        let boundaries = self.boundaries.map(|line| LineStyle { opacity: 0.0, ..line });
        Self { boundaries, ..self }
    }

    /// Whether boundaries of some class are drawn.
    #[must_use]
    pub fn has_boundaries(&self) -> bool {
        self.boundaries.iter().any(LineStyle::is_drawn)
    }

    /// How areas of a class are drawn.
    #[must_use]
    pub fn area(&self, class: AreaClass) -> &AreaStyle {
        &self.areas[usize::from(class.number())]
    }

    /// Width on the ground near the eye of a road of this class whose tags say `own`.
    #[must_use]
    pub fn width_m(&self, class: FunctionalRoadClass, own: OwnWidth) -> f32 {
        match self.own_widths.and_then(|widths| widths.asked_m(own)) {
            Some(asked_m) => asked_m.min(OwnWidths::WIDEST_M),
            None => self.roads[usize::from(class.number())].width_m,
        }
    }

    /// Width on the ground near the eye of a road of this class with these attributes: service roads are narrower than others,
    /// and so is one of two carriageways, where its tags do not say how wide it is, and slip roads than that.
    #[must_use]
    pub fn width_of_m(&self, class: FunctionalRoadClass, attributes: &RoadAttributes) -> f32 {
        let own = attributes.own_width();
        let is_tagged = self.own_widths.and_then(|widths| widths.asked_m(own)).is_some();
        let is_carriageway = matches!(attributes.form, Form::DualCarriageway | Form::Link);
        let width_m = if is_carriageway && !is_tagged {
            self.road(class).carriageway_width_m
        } else {
            self.width_m(class, own)
        };
        let is_narrow = attributes.form == Form::Link || attributes.highway == "service";
        if is_narrow { width_m * RoadStyle::NARROW_WIDTH_SHARE } else { width_m }
    }

    /// Whether a road's tags ask for more than [`OwnWidths::WIDEST_M`].
    #[must_use]
    pub fn is_capped(&self, own: OwnWidth) -> bool {
        let asked_m = self.own_widths.and_then(|widths| widths.asked_m(own));
        asked_m.is_some_and(|asked_m| asked_m > OwnWidths::WIDEST_M)
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "style_tests.rs"]
mod tests;
