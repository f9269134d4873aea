//! How roads are drawn and how everything looks, for all commands that draw.

use clap::{Args, ValueEnum};
use corniche_viewer::{RoadMethod, RoadOptions};

use crate::failure::Failure;

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Roads {
    /// As geometry on the TIN
    Geo,
    /// As geometry on the TIN, cut off straight at every point
    GeoNoCaps,
    /// As shadow volumes: exact to the pixel, also on steep ground
    Sv,
    /// As shadow volumes, cut off straight at every point
    SvNoCaps,
    /// Not at all
    None,
}

impl Roads {
    /// As it is said on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Geo => "geo",
            Self::GeoNoCaps => "geo-no-caps",
            Self::Sv => "sv",
            Self::SvNoCaps => "sv-no-caps",
            Self::None => "none",
        }
    }

    pub(crate) fn method(self) -> RoadMethod {
        match self {
            Self::Geo | Self::GeoNoCaps => RoadMethod::Geometry,
            Self::Sv | Self::SvNoCaps => RoadMethod::ShadowVolumes,
            Self::None => RoadMethod::None,
        }
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

/// How roads begin, bend and end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Caps {
    /// With a half disc around every point
    Round,
    /// Cut off straight at every point
    None,
}

/// How widths depend on the distance from the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum WidthGrowth {
    /// True widths
    None,
    /// True widths times the style's constant
    Constant,
    /// True widths near the eye, growing beyond the style's threshold
    Distance,
}

/// The edge of roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Outline {
    /// As wide as the style says
    Style,
    /// None
    None,
    /// One pixel, by a kernel of 3 × 3
    #[value(name = "3")]
    Kernel3,
    /// Two pixels, by a kernel of 5 × 5
    #[value(name = "5")]
    Kernel5,
}

/// How a fragment of a shadow volume finds out whether the ground it sees is road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CapTest {
    /// By the distance in plan: exact far from the eye too
    Distance,
    /// By the paper's formula, for comparison: loses its digits far from the eye
    Paper,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// Colours and widths: road-atlas, dark or a style file (TOML)
    #[arg(long, value_name = "NAME|FILE", default_value = "road-atlas")]
    pub(crate) style: String,
    /// How roads begin, bend and end
    #[arg(long, value_enum, default_value_t = Caps::Round)]
    caps: Caps,
    /// How widths depend on the distance from the eye
    #[arg(long, value_enum, default_value_t = WidthGrowth::Distance)]
    width_growth: WidthGrowth,
    /// The edge of roads: the style's, none, or the one of a kernel of so many pixels
    #[arg(long, value_enum, default_value_t = Outline::Style)]
    outline: Outline,
    /// How shadow volumes find their round ends [default: distance]
    #[arg(long, value_enum)]
    cap_test: Option<CapTest>,
}

impl LookArgs {
    /// What `--roads` says together with `--caps`.
    ///
    /// # Errors
    /// When `--cap-test` is given and nothing is drawn that could be tested.
    pub(crate) fn roads(&self, given: &[Roads]) -> Result<Vec<Roads>, Failure> {
        let roads: Vec<Roads> = given.iter().map(|roads| roads.with_caps(self.caps)).collect();
        if self.cap_test.is_some() && !roads.contains(&Roads::Sv) {
            return Err(Failure::unusable(
                "--cap-test is about shadow volumes with round caps; give it together with --roads sv",
            ));
        }
        Ok(roads)
    }

    /// How to draw roads of which [`Self::roads`] told.
    pub(crate) fn road_options(&self, roads: Roads) -> RoadOptions {
        RoadOptions {
            method: roads.method(),
            classes: corniche_viewer::ClassSet::ALL,
            caps: match roads {
                Roads::GeoNoCaps | Roads::SvNoCaps => corniche_viewer::Caps::None,
                _ => corniche_viewer::Caps::Round,
            },
            cap_test: match self.cap_test {
                Some(CapTest::Paper) => corniche_viewer::CapTest::PaperQuadratic,
                Some(CapTest::Distance) | None => corniche_viewer::CapTest::Distance,
            },
            width_growth: match self.width_growth {
                WidthGrowth::None => corniche_viewer::WidthGrowth::None,
                WidthGrowth::Constant => corniche_viewer::WidthGrowth::Constant,
                WidthGrowth::Distance => corniche_viewer::WidthGrowth::ByDistance,
            },
            outline: match self.outline {
                Outline::Style => corniche_viewer::Outline::OfStyle,
                Outline::None => corniche_viewer::Outline::None,
                Outline::Kernel3 => corniche_viewer::Outline::Kernel3,
                Outline::Kernel5 => corniche_viewer::Outline::Kernel5,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[arg(long, value_enum, value_delimiter = ',')]
        roads: Vec<Roads>,
        #[command(flatten)]
        look: LookArgs,
    }

    fn line(text: &str) -> Line {
        Line::parse_from(format!("corniche {text}").split(' '))
    }

    #[test]
    fn nothing_said_is_the_method_as_it_is_meant_to_be_seen() {
        let look = line("--roads geo").look;
        for roads in [Roads::Geo, Roads::Sv, Roads::None] {
            assert_eq!(look.road_options(roads), RoadOptions::of(roads.method()), "{roads:?}");
        }
        assert_eq!(look.style, "road-atlas");
    }

    #[test]
    fn every_option_reaches_the_drawing() {
        let Line { roads, look } =
            line("--roads sv --cap-test paper --width-growth constant --outline 5 --style dark");
        let expected = RoadOptions {
            method: RoadMethod::ShadowVolumes,
            classes: corniche_viewer::ClassSet::ALL,
            caps: corniche_viewer::Caps::Round,
            cap_test: corniche_viewer::CapTest::PaperQuadratic,
            width_growth: corniche_viewer::WidthGrowth::Constant,
            outline: corniche_viewer::Outline::Kernel5,
        };
        assert_eq!(look.road_options(look.roads(&roads).unwrap()[0]), expected);
        assert_eq!(look.style, "dark");
        let look = line("--roads geo --width-growth none --outline none").look;
        let options = look.road_options(Roads::GeoNoCaps);
        assert_eq!(options.width_growth, corniche_viewer::WidthGrowth::None);
        assert_eq!(options.outline, corniche_viewer::Outline::None);
        assert_eq!(options.caps, corniche_viewer::Caps::None);
        assert_eq!(options.method, RoadMethod::Geometry);
    }

    #[test]
    fn caps_are_said_with_the_method_or_for_all_methods() {
        let Line { roads, look } = line("--roads none,geo,sv,sv-no-caps --caps none");
        let resolved = look.roads(&roads).unwrap();
        assert_eq!(resolved, [Roads::None, Roads::GeoNoCaps, Roads::SvNoCaps, Roads::SvNoCaps]);
        let Line { roads, look } = line("--roads sv,sv-no-caps");
        assert_eq!(look.roads(&roads).unwrap(), [Roads::Sv, Roads::SvNoCaps]);
        for roads in [Roads::GeoNoCaps, Roads::SvNoCaps] {
            assert_eq!(look.road_options(roads).caps, corniche_viewer::Caps::None);
        }
    }

    #[test]
    fn a_test_of_caps_needs_caps_to_test() {
        for without in ["geo", "none", "sv-no-caps", "sv --caps none"] {
            let Line { roads, look } = line(&format!("--cap-test paper --roads {without}"));
            let message = look.roads(&roads).unwrap_err().to_string();
            assert!(message.contains("--cap-test") && message.contains("--roads sv"), "{message}");
        }
    }
}
