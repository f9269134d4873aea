//! Options of a flight: which ground is drawn, how tiles are loaded and how frames are timed.

use corniche_styles::Style;

use crate::{
    options::RoadOptions,
    range::{self, OutOfRange},
    stream::StreamBudget,
};

/// How much of the ground is drawn: the cases that Agrawal et al. 2006 compare in Table 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// All finest tiles, in view or not.
    Full,
    /// The finest tiles in view.
    Culled,
    /// Tiles by screen-space error, loaded while flying.
    Adaptive,
}

/// How a flight is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayOptions {
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// How much of the ground is drawn.
    pub detail: Detail,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels.
    pub cell_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples per pixel along each side, averaged; 1 takes the pixel's centre alone.
    pub supersampling: u32,
    /// Colours and widths.
    pub style: Style,
    /// What may be loaded and kept.
    pub budget: StreamBudget,
    /// Tiles are loaded in advance for where the camera will be in this many seconds; with 0 none are.
    pub ahead_s: f64,
    /// How many frames the flight has, evenly spread from its beginning to its end.
    pub frames: u32,
}

/// Checks the numbers among the options.
pub(crate) fn check(options: &ReplayOptions) -> Result<(), OutOfRange> {
    range::check_ground(options.screen_space_error_px, options.cell_px, options.exaggeration)?;
    range::check_supersampling(options.supersampling)?;
    range::within("a look ahead", options.ahead_s, 0.0..=3600.0, "0 to 3600 seconds")?;
    let frames = f64::from(options.frames);
    range::within("a number of frames", frames, 1.0..=1e6, "1 to 1 000 000")
}
