//! How roads are drawn and how everything looks, for all commands that draw.

use clap::{ArgAction, Args, builder::TypedValueParser};
use corniche_presets::{Words, one_of};
use corniche_styles::Style;
use corniche_viewer::{
    CapTest, Caps, ClassSet, Outline, Quads, RoadMethod, RoadOptions, WidthGrowth,
};

use super::{
    overlay::{self, OverlayArg},
    values::{parse_within, word_of},
};
use crate::failure::Failure;

/// The heading in the help under which options stand that are there for comparisons with published methods.
pub(crate) const COMPARING: &str = "Comparing with the papers";

/// How roads are drawn. The methods without caps are named by `fly` alone, which can so take one flight with and without.
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
    ("geo", "As geometry on the TIN", Roads::Geo),
    ("geo-no-caps", "As geometry on the TIN, cut off straight at every point", Roads::GeoNoCaps),
    ("sv", "As shadow volumes: exact to the pixel, also on steep ground", Roads::Sv),
    ("sv-no-caps", "As shadow volumes, cut off straight at every point", Roads::SvNoCaps),
    ("none", "Not at all", Roads::None),
];

impl Roads {
    /// What all commands draw where nothing is said: exact to the pixel on every ground.
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

    /// The value of `--roads` in commands that draw with one method; whether roads have caps is said by `--caps` there.
    pub(crate) fn one_method() -> impl TypedValueParser<Value = Self> {
        let [geo, _, sv, _, none] = ROADS;
        one_of([geo, sv, none])
    }

    /// The same method drawn without caps.
    pub(crate) fn without_caps(self) -> Self {
        self.with_caps(Caps::None)
    }

    /// The same method drawn with these caps.
    fn with_caps(self, caps: Caps) -> Self {
        match (self, caps) {
            (Self::Geo, Caps::None) => Self::GeoNoCaps,
            (Self::Sv, Caps::None) => Self::SvNoCaps,
            (roads, _) => roads,
        }
    }
}

/// Whether areas, or boundaries, are drawn.
const ON_OFF: Words<bool, 2> = [("on", "Those that the style draws", true), ("off", "None", false)];

/// How roads begin, bend and end.
const CAPS: Words<Caps, 2> = [
    ("round", "With a half disc around every point", Caps::Round),
    ("none", "Cut off straight at every point", Caps::None),
];

/// How widths depend on the distance from the eye.
pub(crate) const WIDTH_GROWTHS: Words<WidthGrowth, 3> = [
    ("none", "True widths", WidthGrowth::None),
    ("constant", "True widths times the style's constant", WidthGrowth::Constant),
    (
        "distance",
        "True widths near the eye, growing beyond the style's threshold",
        WidthGrowth::ByDistance,
    ),
];

/// The edge of roads.
pub(crate) const OUTLINES: Words<Outline, 4> = [
    ("style", "As wide as the style says", Outline::OfStyle),
    ("none", "None", Outline::None),
    ("3", "One pixel, by a kernel of 3 × 3", Outline::Kernel3),
    ("5", "Two pixels, by a kernel of 5 × 5", Outline::Kernel5),
];

/// How a fragment of a shadow volume finds out whether the ground it sees is road.
const CAP_TESTS: Words<CapTest, 2> = [
    ("distance", "By the distance in plan: exact far from the eye too", CapTest::Distance),
    (
        "paper",
        "By the paper's formula, for comparison: loses precision far from the eye",
        CapTest::PaperQuadratic,
    ),
];

/// What the quad of a piece of road covers.
const QUADS: Words<Quads, 2> = [
    ("beds", "All ground beside the piece, within the road's width", Quads::Beds),
    (
        "level",
        "What lies as high as the piece, as in the paper, for comparison: roads on slopes are too narrow",
        Quads::Level,
    ),
];

#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// Colours and widths: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "NAME|FILE", default_value = "road-atlas")]
    pub(crate) style: String,
    /// How strongly photos are seen, where the package has some: off, or 0 to 1 [default: as the style says]
    #[arg(long, value_name = "off|SHARE", value_parser = parse_strength)]
    pub(crate) photo: Option<f32>,
    /// Areas (water, forest …), where the package has some: as the style draws them, or off
    #[arg(long, value_parser = one_of(ON_OFF), default_value = "on", action = ArgAction::Set)]
    pub(crate) areas: bool,
    /// Boundaries, where the package has some: as the style draws them, or off
    #[arg(long, value_parser = one_of(ON_OFF), default_value = "on", action = ArgAction::Set)]
    pub(crate) boundaries: bool,
    /// Draw the lines of a file over the map: GeoJSON, GPX, GeoPackage, Shapefile …; give it again for another file
    ///
    /// Behind the file's name: ,color=COLOUR (#C21E8A or tomato) ,width=PIXELS ,opacity=SHARE ,dash=DASH/GAP ,pattern=dots/PX (or beads, arrows) in pixels.
    #[arg(long, value_name = "FILE[,color=…]", value_parser = overlay::parse)]
    pub(crate) overlay: Vec<OverlayArg>,
    /// Take the datum of such a file for that of WGS84 where PROJ knows nothing between them; its lines can then lie 100 m and more beside the map
    #[arg(long, requires = "overlay")]
    pub(crate) allow_ballpark: bool,
    /// How roads begin, bend and end
    #[arg(long, value_parser = one_of(CAPS), default_value = "round", help_heading = COMPARING, hide_short_help = true)]
    caps: Caps,
    /// How widths depend on the distance from the eye
    #[arg(long, value_parser = one_of(WIDTH_GROWTHS), default_value = "distance", help_heading = COMPARING, hide_short_help = true)]
    width_growth: WidthGrowth,
    /// Outline of roads: the style's, none, or one from a kernel of 3 or 5 pixels
    #[arg(long, value_parser = one_of(OUTLINES), default_value = "style", help_heading = COMPARING, hide_short_help = true)]
    outline: Outline,
    /// How shadow volumes find their round ends [default: distance]
    #[arg(long, value_parser = one_of(CAP_TESTS), help_heading = COMPARING, hide_short_help = true)]
    cap_test: Option<CapTest>,
    /// What the quads of roads as geometry cover [default: beds]
    #[arg(long, value_parser = one_of(QUADS), help_heading = COMPARING, hide_short_help = true)]
    geo_quads: Option<Quads>,
}

/// A share from 0 to 1; `off` is 0.
fn parse_strength(text: &str) -> Result<f32, String> {
    let share = if text == "off" { "0" } else { text };
    parse_within(share, 0.0..=1.0, "write off, or a number from 0 to 1")
}

impl LookArgs {
    /// A style, with photos as strong as `--photo` says, and with areas unless `--areas` says otherwise, and with the lines of `--overlay`.
    pub(crate) fn styled(&self, style: Style) -> Style {
        let style = if self.areas { style } else { style.without_areas() };
        let style = if self.boundaries { style } else { style.without_boundaries() };
        let style = Style { photo: self.photo.unwrap_or(style.photo), ..style };
        overlay::styled(&self.overlay, style)
    }

    /// Whether an option is given that only some methods have.
    pub(crate) fn needs_method(&self) -> bool {
        self.cap_test.is_some() || self.geo_quads.is_some()
    }

    /// What `--roads` says together with `--caps`.
    ///
    /// # Errors
    /// When `--cap-test` or `--geo-quads` is given and nothing is drawn that it could change.
    pub(crate) fn roads(&self, given: &[Roads]) -> Result<Vec<Roads>, Failure> {
        let roads: Vec<Roads> = given.iter().map(|roads| roads.with_caps(self.caps)).collect();
        if self.cap_test.is_some() && !roads.contains(&Roads::Sv) {
            return Err(Failure::unusable(
                "--cap-test has an effect only on shadow volumes with round caps; give it together with --roads sv",
            ));
        }
        if self.geo_quads.is_some()
            && !roads.iter().any(|roads| roads.method() == RoadMethod::Geometry)
        {
            return Err(Failure::unusable(
                "--geo-quads has an effect only on roads as geometry; give it together with --roads geo",
            ));
        }
        Ok(roads)
    }

    /// How to draw roads of which [`Self::roads`] told.
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
