//! How the map looks: plain values, no GPU.

use corniche_areas::AreaClass;
use corniche_roads::{Form, FunctionalRoadClass, OwnWidth, RoadAttributes};
use serde::{Deserialize, Serialize};

use crate::{AreaStyle, Dash, Light, LineStyle, Rgb, RoadBand, RoadBands, Tint, TintHeights};

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
    /// The most true metres of ground in a pixel at which roads are drawn in full; see [`RoadStyle::shown_share`]. `None`:
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

    /// The default style, like a road atlas: warm roads with dark edges, pale ground. It is equal to the preset
    /// `road-atlas`.
    #[must_use]
    pub fn road_atlas() -> Self {
        Self {
            roads: atlas_roads(),
            areas: [
                water(0xA9_C9_DD),
                water(0xA9_C9_DD),
                area(0xE6_F1_F8, 0.7),
                area(0x7F_AE_78, 0.42),
                area(0xD6_E4_A8, 0.3),
                area(0xD8_C2_B4, 0.45),
                area(0xA2_CD_8B, 0.5),
                area(0xBC_B4_AA, 0.3),
            ],
            boundaries: boundaries(),
            overlays: overlays(),
            drawn: LineStyle {
                casing: Some(rgb(0x2B_2B_2B)),
                ..LineStyle::solid(rgb(0xFF_E6_00), 3.0)
            },
            own_widths: None,
            width_scaling: WidthScaling { threshold_m: 1500.0, exponent: 0.75, constant: 4.0 },
            outline_px: 1,
            shortest_part_px: 40.0,
            tint: Tint {
                heights: TintHeights::MetresByClimate,
                stops: vec![
                    (-100.0, rgb(0xB5_CF_A6)),
                    (0.0, rgb(0xC6_DB_B2)),
                    (250.0, rgb(0xD5_E3_BC)),
                    (600.0, rgb(0xE6_E7_C4)),
                    (1100.0, rgb(0xED_E2_C0)),
                    (1700.0, rgb(0xE2_D1_B0)),
                    (2300.0, rgb(0xD5_C6_B2)),
                    (2800.0, rgb(0xDB_D6_D0)),
                    (3400.0, rgb(0xF1_F3_F6)),
                ],
            },
            light: Light {
                azimuth_deg: 315.0,
                altitude_deg: 45.0,
                hillshade: 0.85,
                sky: 0.4,
                gentle: 2.5,
                valley_haze: 0.2,
                shadow: rgb(0x5A_62_86),
                sunlit: rgb(0xFF_F8_DC),
            },
            photo: 1.0,
            haze: rgb(0xDC_E6_EE),
            sky: rgb(0x9F_C1_E0),
            void: rgb(0xE2_E0_DB),
            water: rgb(0xA9_C9_DD),
            wall: rgb(0x8E_84_78),
            haze_reach: 6.0,
        }
    }
}

/// Roads of an atlas, by class. Far away minor ones are narrower, and have no edge.
fn atlas_roads() -> [RoadStyle; FunctionalRoadClass::COUNT] {
    let road =
        |width_m, [min_width_px, max_width_px]: [f32; 2], color, outline, max_pixel_m| RoadStyle {
            width_m,
            carriageway_width_m: width_m,
            min_width_px,
            bands: RoadBands::one(rgb(color)),
            outline: rgb(outline),
            max_pixel_m,
            max_width_px: Some(max_width_px),
            exponent: None,
            edge_max_pixel_m: None,
            thin: None,
            opacity: 1.0,
            dash: Dash::SOLID,
        };
    // How a road is drawn where it has no room for its edge.
    let far = |exponent, edge_max_pixel_m, thin, road| RoadStyle {
        exponent,
        edge_max_pixel_m,
        thin: Some(rgb(thin)),
        ..road
    };
    let dual = |carriageway_width_m, road| RoadStyle { carriageway_width_m, ..road };
    let yellow = RoadBand { width_share: 0.3, color: rgb(0xFF_E8_8A) };
    let two_colours = |road: RoadStyle| RoadStyle { bands: road.bands.with_center(yellow), ..road };
    [
        dual(
            12.0,
            two_colours(far(
                None,
                None,
                0xD0_1C_2B,
                road(24.0, [3.0, 5.5], 0xC5_0D_2B, 0x6B_14_13, None),
            )),
        ),
        dual(
            11.0,
            two_colours(far(
                None,
                None,
                0xC7_49_01,
                road(20.0, [2.6, 5.0], 0xD7_64_2F, 0x6E_2A_0C, Some(600.0)),
            )),
        ),
        dual(
            10.0,
            far(
                None,
                Some(80.0),
                0xB7_67_00,
                road(17.0, [2.2, 4.2], 0xF2_97_00, 0x74_35_00, Some(300.0)),
            ),
        ),
        dual(
            9.0,
            far(
                Some(0.72),
                Some(60.0),
                0xAA_7B_00,
                road(14.0, [1.9, 3.8], 0xFF_E0_53, 0x8A_43_00, Some(140.0)),
            ),
        ),
        dual(
            8.0,
            far(
                Some(0.7),
                Some(45.0),
                0xA0_84_12,
                road(11.0, [1.5, 3.3], 0xFF_FA_BF, 0x73_66_2D, Some(60.0)),
            ),
        ),
        far(
            Some(0.67),
            Some(22.0),
            0x8C_88_81,
            road(8.5, [1.2, 2.9], 0xFF_FF_FF, 0x67_69_6F, Some(22.0)),
        ),
        far(
            Some(0.6),
            Some(11.0),
            0x94_8E_84,
            road(7.0, [1.1, 2.5], 0xFF_FF_FF, 0xA0_9A_93, Some(11.0)),
        ),
        far(
            Some(0.5),
            Some(5.0),
            0xAA_8C_54,
            road(4.0, [1.1, 1.8], 0xBF_9F_61, 0xA7_9B_7E, Some(6.0)),
        ),
        far(
            Some(0.45),
            Some(3.0),
            0xB8_85_60,
            road(2.0, [1.1, 1.4], 0xDD_D5_C9, 0xB9_B0_A0, Some(4.0)),
        ),
    ]
}

/// Areas of this colour that hide so much of the ground.
fn area(color: u32, opacity: f32) -> AreaStyle {
    AreaStyle { color: rgb(color), opacity, steepest_deg: None }
}

/// Water, which is not painted on cliffs: banks and coasts overlap the ground beside them.
fn water(color: u32) -> AreaStyle {
    AreaStyle { steepest_deg: Some(35.0), ..area(color, 1.0) }
}

/// Boundaries of countries are widest and seen from farthest.
fn boundaries() -> [LineStyle; LineStyle::MOST] {
    let line = |width_px, lengths_px: &[f32], max_pixel_m| LineStyle {
        opacity: 0.65,
        dash: Dash::new(lengths_px).unwrap_or(Dash::SOLID),
        max_pixel_m,
        ..LineStyle::solid(rgb(0x8A_3F_86), width_px)
    };
    let protected = LineStyle { color: rgb(0x3F_8A_4A), ..line(2.0, &[2.0, 5.0], Some(40.0)) };
    [
        line(2.6, &[16.0, 4.0, 3.0, 4.0], None),
        line(2.4, &[13.0, 4.0, 3.0, 4.0], Some(1000.0)),
        line(2.2, &[11.0, 4.0, 2.5, 4.0], Some(600.0)),
        line(2.0, &[9.0, 4.0, 2.5, 4.0], Some(250.0)),
        line(1.8, &[7.0, 4.0, 2.0, 4.0], Some(150.0)),
        line(1.7, &[5.0, 4.0, 2.0, 4.0], Some(60.0)),
        line(1.5, &[2.0, 4.0], Some(40.0)),
        protected,
        protected,
    ]
}

/// Colours that can be told from each other and from roads, with a pale edge so that they are seen on any ground.
fn overlays() -> [LineStyle; LineStyle::MOST] {
    let colors = [
        0xC2_1E_8A, 0x1F_5F_D0, 0x0B_8A_7A, 0x7A_34_B8, 0xD0_1F_2E, 0x2C_7A_1E, 0x00_8F_C4,
        0x8A_4B_12, 0x2B_2B_2B,
    ];
    let edge = Some(rgb(0xFF_FF_FF));
    colors.map(|color| LineStyle { casing: edge, ..LineStyle::solid(rgb(color), 3.0) })
}

/// `0xRR_GG_BB` as shares.
fn rgb(hex: u32) -> Rgb {
    [16, 8, 0].map(|shift| (hex >> shift & 0xFF) as f32 / 255.0)
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "style_tests.rs"]
mod tests;
