//! The style of the map as plain values, without GPU.

use corniche_layers::LayerForm;
use corniche_roads::{Form, FunctionalRoadClass, OwnWidth, RoadAttributes};
use serde::{Deserialize, Serialize};

use crate::{Dash, LayerLook, LayerLooks, Light, LineStyle, Rgb, RoadBands, Tint};

/// How the roads of one class are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RoadStyle {
    /// Width on the ground near the eye.
    pub width_m: f32,
    /// Width on the ground near the eye of one of two carriageways.
    pub carriageway_width_m: f32,
    /// Minimum width on the picture.
    pub min_width_px: f32,
    /// Colours of the surface, from the edges to the middle.
    pub bands: RoadBands,
    /// Colour of the edge.
    pub outline: Rgb,
    /// The most true metres of ground per pixel at which roads are fully drawn; beyond that they
    /// fade. `None`: they are always fully drawn.
    pub max_pixel_m: Option<f32>,
    /// The width up to which roads grow with distance; `None`: no limit. Roads that are wider near
    /// the eye keep their width.
    pub max_width_px: Option<f32>,
    /// How widths grow with distance. It overrides [`WidthScaling::exponent`].
    pub exponent: Option<f32>,
    /// The most true metres of ground per pixel at which the edge of roads is fully drawn; at twice
    /// as many there is no edge. `None`: the edge is always drawn.
    pub edge_max_pixel_m: Option<f32>,
    /// Colour of a road without an edge; `None`: [`RoadBands::main_color`].
    pub thin: Option<Rgb>,
    /// How much of the ground a road hides, edge included: 1 hides it completely.
    pub opacity: f32,
    /// The dash pattern of the road.
    pub dash: Dash,
}

impl RoadStyle {
    /// Width of service roads as a share of the width of their class, and of slip roads as a share
    /// of a carriageway of their class.
    pub const NARROW_WIDTH_SHARE: f32 = 0.6;

    /// Returns the style with its widths on the ground multiplied by `factor`.
    #[must_use]
    pub fn widened(mut self, factor: f32) -> Self {
        self.width_m *= factor;
        self.carriageway_width_m *= factor;
        self
    }

    /// Width on a flat map: the maximum to which roads grow with distance, at least one pixel.
    #[must_use]
    pub fn flat_width_px(&self) -> f32 {
        self.max_width_px.unwrap_or(self.min_width_px).max(1.0)
    }
}

/// How much roads widen with distance (the paper, section 6.2 and Fig. 10).
///
/// Up to `threshold_m` a road has its true width. Beyond, the width is multiplied by
/// `(distance / threshold_m) ^ exponent`. With exponent 0, roads become smaller with distance like
/// everything else; with 1, they keep their width in pixels. In between, far roads remain visible
/// and still look far.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WidthScaling {
    /// Up to this distance from the eye, roads have their true width.
    pub threshold_m: f32,
    /// Exponent of the growth with distance, 0 to 1.
    pub exponent: f32,
    /// Factor on all widths; 1 is true.
    pub constant: f32,
}

impl WidthScaling {
    /// Returns the factor on the width at a distance from the eye.
    #[must_use]
    pub fn factor(&self, distance_m: f64) -> f64 {
        let growth = (distance_m / f64::from(self.threshold_m)).max(1.0);
        f64::from(self.constant) * libm::pow(growth, f64::from(self.exponent))
    }
}

/// How the `width` and `lanes` tags of roads set their widths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OwnWidths {
    /// Width of one lane: it sets the width of roads with `lanes` and without `width`. `None`:
    /// `lanes` is ignored.
    pub lane_m: Option<f32>,
}

impl OwnWidths {
    /// Maximum width from tags: a larger tagged width is rather an error, or the width of a square.
    pub const WIDEST_M: f32 = 60.0;

    /// Maximum width of a lane in a style.
    pub const WIDEST_LANE_M: f32 = 10.0;

    /// The width that a road's tags request, metres, before it is capped; `None` if the tags do not
    /// set one.
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
    /// How the layers of packages look: [`Style::layer_look`].
    pub layers: LayerLooks,
    /// The styles of lines from users' files, in the order of the files.
    pub overlays: [LineStyle; LineStyle::MOST],
    /// The style of lines that a user draws.
    pub drawn: LineStyle,
    /// Whether tags set the widths of roads; `None`: all roads of a class have the same width.
    pub own_widths: Option<OwnWidths>,
    /// How roads widen with distance.
    pub width_scaling: WidthScaling,
    /// Width of the edge of roads, and the radius of its kernel.
    pub outline_px: u32,
    /// Minimum length on the picture of a part of the road network that has no connection to roads
    /// of its class or above. Shorter parts are not drawn. 0: all parts are drawn.
    pub shortest_part_px: f32,
    /// Colours of the ground by its height.
    pub tint: Tint,
    /// The light on the ground.
    pub light: Light,
    /// How strongly photos are visible, if the package has some: 0 (not at all) to 1 (instead of
    /// the height tint).
    pub photo: f32,
    /// Colour of far ground and of the sky at the horizon.
    pub haze: Rgb,
    /// Colour of the sky far above the horizon.
    pub sky: Rgb,
    /// Colour below the horizon where there is no ground.
    pub void: Rgb,
    /// Colour of level ground at or below 0 m.
    pub water: Rgb,
    /// Colour of the wall along the edge of the data.
    pub wall: Rgb,
    /// Ground at this many times the distance of the camera's target has lost two thirds of its
    /// colour.
    pub haze_reach: f32,
}

impl Style {
    /// How the class with this number in the table of a layer is drawn: as the style says of the
    /// class, else of the layer, else of its geometry. The scale of a class limits lines and points
    /// for which the style sets no limit.
    #[must_use]
    pub fn layer_look(&self, layer: &LayerForm, class: usize) -> LayerLook {
        self.layers.look(layer, class)
    }

    /// Width on the ground near the eye of a road of this class whose tags give `own`.
    #[must_use]
    pub fn width_m(&self, class: FunctionalRoadClass, own: OwnWidth) -> f32 {
        match self.own_widths.and_then(|widths| widths.asked_m(own)) {
            Some(asked_m) => asked_m.min(OwnWidths::WIDEST_M),
            None => self.roads[usize::from(class.number())].width_m,
        }
    }

    /// Width on the ground near the eye of a road of this class with these attributes. Service
    /// roads are narrower than others. So is one of two carriageways, unless its tags set its
    /// width; slip roads are narrower than a carriageway.
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

    /// Whether a road's tags request more than [`OwnWidths::WIDEST_M`].
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
