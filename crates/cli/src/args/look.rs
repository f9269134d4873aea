//! Options of how roads and everything else look, for all commands that draw.

use clap::{Args, builder::TypedValueParser};
use corniche_presets::{Words, one_of};
use corniche_styles::Style;
use corniche_viewer::{
    CapTest, Caps, ClassSet, Quads, RoadMethod, RoadOptions, RoadOutline, ShownLayers, WidthGrowth,
};

use super::{
    overlay::{self, OverlayArg},
    values::{parse_within, word_of},
};
use crate::failure::Result;

/// The help heading of options for comparisons with published methods.
pub(crate) const COMPARING: &str = "Comparing with the papers";

/// How roads are drawn. Only `fly` names the methods without caps, so that it can repeat a flight
/// with and without caps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Roads {
    Geo,
    GeoNoCaps,
    Sv,
    SvNoCaps,
    None,
}

/// All values of `--roads`.
pub(crate) const ROADS: Words<Roads, 5> = [
    ("geo", "As geometry on the terrain's triangles (TIN)", Roads::Geo),
    ("geo-no-caps", "As geometry on the TIN, cut off square at every point", Roads::GeoNoCaps),
    ("sv", "As shadow volumes: pixel-exact, also on steep ground", Roads::Sv),
    ("sv-no-caps", "As shadow volumes, cut off square at every point", Roads::SvNoCaps),
    ("none", "No roads", Roads::None),
];

impl Roads {
    /// The default of all commands: pixel-exact on every terrain.
    pub(crate) const DEFAULT: Self = Self::Sv;

    /// Its name on the command line.
    pub(crate) fn word(self) -> &'static str {
        word_of(&ROADS, &self)
    }

    pub(crate) fn method(self) -> RoadMethod {
        match self {
            Self::Geo | Self::GeoNoCaps => RoadMethod::Geometry,
            Self::Sv | Self::SvNoCaps => RoadMethod::ShadowVolumes,
            Self::None => RoadMethod::None,
        }
    }

    /// The parser of `--roads` in commands that draw with one method; there `--caps` decides about
    /// caps.
    pub(crate) fn one_method() -> impl TypedValueParser<Value = Self> {
        let [geo, _, sv, _, none] = ROADS;
        one_of([geo, sv, none])
    }

    /// The same method without caps.
    pub(crate) fn without_caps(self) -> Self {
        self.with_caps(Caps::None)
    }

    /// The same method with these caps.
    fn with_caps(self, caps: Caps) -> Self {
        match (self, caps) {
            (Self::Geo, Caps::None) => Self::GeoNoCaps,
            (Self::Sv, Caps::None) => Self::SvNoCaps,
            (roads, _) => roads,
        }
    }
}

/// The shape of the ends and bends of roads.
const CAPS: Words<Caps, 2> = [
    ("round", "With a half disc around every point", Caps::Round),
    ("none", "Cut off square at every point", Caps::None),
];

/// How widths depend on the distance from the camera.
pub(crate) const WIDTH_GROWTHS: Words<WidthGrowth, 3> = [
    ("none", "True widths", WidthGrowth::None),
    ("constant", "True widths times the style's constant", WidthGrowth::Constant),
    (
        "distance",
        "True widths near the camera, growing beyond the style's threshold",
        WidthGrowth::ByDistance,
    ),
];

/// The outline of roads.
pub(crate) const OUTLINES: Words<RoadOutline, 4> = [
    ("style", "The style's width", RoadOutline::OfStyle),
    ("none", "None", RoadOutline::None),
    ("3", "One pixel, by a kernel of 3 × 3", RoadOutline::Kernel3),
    ("5", "Two pixels, by a kernel of 5 × 5", RoadOutline::Kernel5),
];

/// How a fragment of a shadow volume decides whether its ground is road.
const CAP_TESTS: Words<CapTest, 2> = [
    ("distance", "By the distance in plan: exact also far from the camera", CapTest::Distance),
    (
        "paper",
        "By the paper's formula, for comparison: loses precision far from the camera",
        CapTest::PaperQuadratic,
    ),
];

/// The ground that the quad of a piece of road covers.
const QUADS: Words<Quads, 2> = [
    ("beds", "All ground within the road's width", Quads::Beds),
    (
        "level",
        "Only ground at the height of the piece, as in the paper, for comparison: roads on slopes are too narrow",
        Quads::Level,
    ),
];

#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// Colours and widths: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "NAME|FILE", default_value = "road-atlas")]
    pub style: String,
    /// Opacity of photos, where the package has some: off, or 0 to 1 [default: from the style]
    #[arg(long, value_name = "off|SHARE", value_parser = parse_strength)]
    pub photo: Option<f32>,
    /// The layers of the package to draw, such as areas,railways; or none [default: all]
    #[arg(long, value_name = "NAMES|none")]
    layers: Option<String>,
    /// Draw the lines of a file over the map: GeoJSON, GPX, GeoPackage, Shapefile …; repeat the
    /// option for more files
    ///
    /// After the file's name: ,color=COLOUR (#C21E8A or tomato) ,width=PIXELS ,opacity=SHARE
    /// ,dash=DASH/GAP ,pattern=dots/PX (or beads, arrows) in pixels.
    #[arg(long, value_name = "FILE[,color=…]", value_parser = overlay::parse)]
    pub overlay: Vec<OverlayArg>,
    /// Allow PROJ's ballpark transformations (no datum shift) for files of --overlay; their lines
    /// can then be off by 100 m or more
    #[arg(long, requires = "overlay")]
    pub allow_ballpark: bool,
    /// The shape of the ends and bends of roads
    #[arg(long, value_parser = one_of(CAPS), default_value = "round", help_heading = COMPARING, hide_short_help = true)]
    caps: Caps,
    /// How widths depend on the distance from the camera
    #[arg(long, value_parser = one_of(WIDTH_GROWTHS), default_value = "distance", help_heading = COMPARING, hide_short_help = true)]
    width_growth: WidthGrowth,
    /// Outline of roads: the style's, none, or one from a kernel of 3 or 5 pixels
    #[arg(long, value_parser = one_of(OUTLINES), default_value = "style", help_heading = COMPARING, hide_short_help = true)]
    outline: RoadOutline,
    /// How shadow volumes compute their round caps [default: distance]
    #[arg(long, value_parser = one_of(CAP_TESTS), help_heading = COMPARING, hide_short_help = true)]
    cap_test: Option<CapTest>,
    /// The ground that the quads of roads drawn as geometry cover [default: beds]
    #[arg(long, value_parser = one_of(QUADS), help_heading = COMPARING, hide_short_help = true)]
    geo_quads: Option<Quads>,
}

/// Parses a fraction from 0 to 1; `off` is 0.
fn parse_strength(text: &str) -> Result<f32, String> {
    let share = if text == "off" { "0" } else { text };
    parse_within(share, 0.0..=1.0, "write off, or a number from 0 to 1")
}

impl LookArgs {
    /// The style with the opacity of `--photo`, and with the lines of `--overlay`.
    pub(crate) fn styled(&self, style: Style) -> Style {
        let style = Style { photo: self.photo.unwrap_or(style.photo), ..style };
        overlay::styled(&self.overlay, style)
    }

    /// The layers of `--layers`.
    pub(crate) fn shown_layers(&self) -> ShownLayers {
        self.layers.as_deref().map_or(ShownLayers::ALL, ShownLayers::from_list)
    }

    /// Whether an option is given that applies to some methods only.
    pub(crate) fn needs_method(&self) -> bool {
        self.cap_test.is_some() || self.geo_quads.is_some()
    }

    /// The values of `--roads` together with `--caps`.
    ///
    /// # Errors
    /// When `--cap-test` or `--geo-quads` is given and would have no effect.
    pub(crate) fn roads(&self, given: &[Roads]) -> Result<Vec<Roads>> {
        let roads: Vec<Roads> = given.iter().map(|roads| roads.with_caps(self.caps)).collect();
        if self.cap_test.is_some() && !roads.contains(&Roads::Sv) {
            refuse!(
                "--cap-test applies only to shadow volumes with round caps; use it with --roads sv"
            );
        }
        if self.geo_quads.is_some()
            && !roads.iter().any(|roads| roads.method() == RoadMethod::Geometry)
        {
            refuse!("--geo-quads applies only to roads as geometry; use it with --roads geo");
        }
        Ok(roads)
    }

    /// The options for drawing roads with one of the methods that [`Self::roads`] returned.
    pub(crate) fn road_options(&self, roads: Roads) -> RoadOptions {
        RoadOptions {
            method: roads.method(),
            classes: ClassSet::ALL,
            caps: match roads {
                Roads::GeoNoCaps | Roads::SvNoCaps => Caps::None,
                _ => Caps::Round,
            },
            cap_test: self.cap_test.unwrap_or(CapTest::Distance),
            quads: self.geo_quads.unwrap_or(Quads::Beds),
            width_growth: self.width_growth,
            outline: self.outline,
        }
    }
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
