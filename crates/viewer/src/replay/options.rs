//! Options of a flight: which ground is drawn, how tiles are loaded and how frames are timed.

use crate::{
    picture_options::PictureOptions,
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
    /// How each picture is drawn.
    pub picture: PictureOptions,
    /// How much of the ground is drawn.
    pub detail: Detail,
    /// Limits for loading and keeping tiles.
    pub budget: StreamBudget,
    /// Tiles are loaded in advance for the camera's position in this many seconds; 0 loads none in
    /// advance.
    pub ahead_s: f64,
    /// Number of frames, at equal steps from the beginning of the flight to its end.
    pub frames: u32,
}

/// Checks the numbers of the options.
pub(crate) fn check(options: &ReplayOptions) -> Result<(), OutOfRange> {
    options.picture.check()?;
    range::within("a look-ahead time", options.ahead_s, 0.0..=3600.0, "0 to 3600 seconds")?;
    let frames = f64::from(options.frames);
    range::within("a number of frames", frames, 1.0..=1e6, "1 to 1 000 000")
}
