//! The part of a style's text about the roads of one class.

use serde::Deserialize;

use crate::{
    Dash, Rgb, RoadBand, RoadBands, RoadStyle, StyleError,
    sheet_values::{Rgb8, number, within},
};

/// How the roads of one class are drawn.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RoadSheet {
    /// Width on the ground, 0.1 to 500 m.
    pub(crate) width_m: f64,
    /// Width of one of two carriageways on the ground, 0.1 m to `width_m`. Default: `width_m`.
    pub(crate) carriageway_width_m: Option<f64>,
    /// Minimum width on the picture, 0.1 to 50 pixels.
    pub(crate) min_width_px: f64,
    /// Colour of the surface, for roads of one or two colours.
    pub(crate) color: Option<Rgb8>,
    /// Colour of the edge.
    pub(crate) outline: Rgb8,
    /// A line along the middle.
    pub(crate) center: Option<CenterSheet>,
    /// Colours of the surface from the edges to the middle, instead of `color` and `center`.
    pub(crate) bands: Option<Vec<BandSheet>>,
    /// The road is fully drawn up to this many metres of ground per pixel, 0.01 to 1e6. Default:
    /// always.
    pub(crate) max_pixel_m: Option<f64>,
    /// Roads grow with distance up to this width, 0.1 to 500 pixels. Default: no limit.
    pub(crate) max_width_px: Option<f64>,
    /// How widths grow with distance, 0 to 1. Default: as in `width_scaling`.
    pub(crate) exponent: Option<f64>,
    /// The edge is fully drawn up to this many metres of ground per pixel, 0.01 to 1e6. Default:
    /// always.
    pub(crate) edge_max_pixel_m: Option<f64>,
    /// Colour of a road without an edge. Default: the dominant colour of its bands.
    pub(crate) thin: Option<Rgb8>,
    /// How much of the ground a road hides, 0.01 to 1. Default: 1.
    pub(crate) opacity: Option<f64>,
}

/// The line along the middle of a road of two colours.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CenterSheet {
    /// Width of the line as a share of the road's width, 0.01 to 0.99.
    pub(crate) width_share: f64,
    /// Colour of the line.
    pub(crate) color: Rgb8,
}

/// One of the bands of a road.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BandSheet {
    /// Width of the band as a share of the road's width.
    pub(crate) width: f64,
    /// Colour of the band.
    pub(crate) color: Rgb8,
}

impl RoadSheet {
    /// Returns the style of this road class, if every number is within its range.
    pub(crate) fn checked(&self, class: usize) -> Result<RoadStyle, StyleError> {
        let entry = |name| format!("roads.{class}.{name}");
        within(&entry("width_m"), self.width_m, 0.1..=500.0)?;
        let number = |name, value, range| number(&entry(name), value, range);
        let carriageway_m =
            number("carriageway_width_m", self.carriageway_width_m, 0.1..=self.width_m)?;
        within(&entry("min_width_px"), self.min_width_px, 0.1..=50.0)?;
        Ok(RoadStyle {
            width_m: self.width_m as f32,
            carriageway_width_m: carriageway_m.unwrap_or(self.width_m as f32),
            min_width_px: self.min_width_px as f32,
            max_pixel_m: number("max_pixel_m", self.max_pixel_m, 0.01..=1e6)?,
            max_width_px: number("max_width_px", self.max_width_px, 0.1..=500.0)?,
            exponent: number("exponent", self.exponent, 0.0..=1.0)?,
            edge_max_pixel_m: number("edge_max_pixel_m", self.edge_max_pixel_m, 0.01..=1e6)?,
            opacity: number("opacity", self.opacity, 0.01..=1.0)?.unwrap_or(1.0),
            bands: self.bands(class)?,
            outline: self.outline.into(),
            thin: self.thin.map(Rgb::from),
            dash: Dash::SOLID,
        })
    }

    fn bands(&self, class: usize) -> Result<RoadBands, StyleError> {
        let center = self.center.map(|center| center.width_share);
        number(&format!("roads.{class}.center.width_share"), center, 0.01..=0.99)?;
        let band =
            |width: f64, color: Rgb8| RoadBand { width_share: width as f32, color: color.into() };
        match (self.color, self.center, &self.bands) {
            (Some(color), center, None) => {
                let one = RoadBands::one(color.into());
                Ok(center
                    .map_or(one, |center| one.with_center(band(center.width_share, center.color))))
            }
            (None, None, Some(bands)) => {
                let bands: Vec<RoadBand> =
                    bands.iter().map(|part| band(part.width, part.color)).collect();
                RoadBands::new(&bands)
                    .map_err(|source| StyleError::Bands { class, source: Box::new(source) })
            }
            _ => Err(StyleError::RoadColor { class }),
        }
    }
}
