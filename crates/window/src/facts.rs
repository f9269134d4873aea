//! What the window tells a person in a frame, and what the person asks for: values between the map and the panel.

use corniche_viewer::{
    RoadMethod,
    flight::{Pose, WorkingCrs},
    gpu::PassTimes,
};

use corniche_styles::Rgb;

use crate::{controls::Mode, frame_times::FrameTimes, notices::Notice};

/// A place on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GroundPoint {
    /// Longitude and latitude, WGS84.
    pub(crate) lon_lat_deg: [f64; 2],
    /// x and y in the working CRS, true height.
    pub(crate) at_m: [f64; 3],
}

/// Everything shown beside the map.
pub(crate) struct Facts<'a> {
    /// What draws.
    pub(crate) adapter: &'a str,
    /// The package's credits.
    pub(crate) attribution: &'a [String],
    /// The package's CRS and what makes working metres of its coordinates.
    pub(crate) crs: WorkingCrs<'a>,
    /// The ground under the cursor; `None` over sky, voids and the panel.
    pub(crate) cursor: Option<GroundPoint>,
    /// The camera; height is true.
    pub(crate) pose: Pose,
    /// True metres in a point of the screen at its middle; `None` without ground there.
    pub(crate) metres_per_point: Option<f64>,
    /// Map or fly mode.
    pub(crate) mode: Mode,
    /// Names of the styles, and the colours of the roads of the one shown.
    pub(crate) style_names: &'a [String],
    pub(crate) road_colors: &'a [Rgb],
    /// Tiles.
    pub(crate) tiles_drawn: usize,
    pub(crate) tiles_missing: usize,
    pub(crate) tiles_loading: usize,
    /// Whether those that are missing find no room in the graphics memory allowed.
    pub(crate) is_full: bool,
    /// Triangles of the ground and segments of roads, drawn.
    pub(crate) triangles: u64,
    pub(crate) segments: u64,
    /// Bytes on the graphics card, and how many there may be.
    pub(crate) gpu_bytes: [u64; 2],
    /// By the graphics card's clock, for each picture of the last frame that it has finished.
    pub(crate) passes: &'a [(RoadMethod, PassTimes)],
    /// Frames.
    pub(crate) frame_times: &'a FrameTimes,
    /// For how long the camera's way has been recorded.
    pub(crate) recording_s: Option<f64>,
    /// What happened, oldest first.
    pub(crate) notices: &'a [Notice],
}

/// Whether a picture shows the panel and the like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shot {
    /// The map and its credits.
    Map,
    /// All that the window shows.
    Window,
}

/// What the person wants besides other settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    /// Turn north up.
    NorthUp,
    /// Back to the first view.
    Reset,
    /// From map to fly mode and back.
    ToggleFly,
    /// A picture.
    Take(Shot),
    /// Begin to record, or end it.
    ToggleRecording,
    /// Begin to record.
    StartRecording,
    /// End it and write the flight.
    StopRecording,
    /// Forget the notice at this place.
    Dismiss(usize),
}
