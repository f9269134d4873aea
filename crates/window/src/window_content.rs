//! The content of the panel and the overlay in a frame: values that the app passes to them.

use corniche_live::{DrawingContent, FrameTimes, GroundPoint, Notice, controls::Mode};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::Rgb;
use corniche_viewer::{
    LayerLegend, RoadMethod,
    flight::{Pose, WorkingCrs},
    gpu::PassTimes,
};

/// All values that the panel and the overlay show, apart from the settings.
pub(crate) struct WindowContent<'a> {
    /// Name of the graphics adapter.
    pub(crate) adapter: &'a str,
    /// Whether the CPU draws.
    pub(crate) is_software: bool,
    /// The package's attribution.
    pub(crate) attribution: &'a [String],
    /// The package's CRS and its factors to working metres.
    pub(crate) crs: WorkingCrs<'a>,
    /// The ground under the cursor; `None` over sky, voids and the panel.
    pub(crate) cursor: Option<GroundPoint>,
    /// The camera; its height is a true height.
    pub(crate) pose: Pose,
    /// True metres per point of the screen at its middle; `None` without ground there.
    pub(crate) metres_per_point: Option<f64>,
    /// Map mode or fly mode.
    pub(crate) mode: Mode,
    /// Names of the styles.
    pub(crate) style_names: &'a [String],
    /// The opacity of photos in the shown style; `None` in a package without photos.
    pub(crate) photo: Option<f32>,
    /// Names of the files of lines.
    pub(crate) overlays: &'a [String],
    /// The colours of the lines of each file.
    pub(crate) overlay_colors: Vec<Rgb>,
    /// The layers of the package, with the classes that are drawn.
    pub(crate) layers: Vec<LayerLegend>,
    /// The colours of roads in the shown style, by class.
    pub(crate) road_colors: &'a [Rgb],
    /// The names of the classes.
    pub(crate) class_labels: &'a [String; FunctionalRoadClass::COUNT],
    /// The number of drawn tiles.
    pub(crate) tiles_drawn: usize,
    /// The number of tiles that the view needs and that are not on the GPU.
    pub(crate) tiles_missing: usize,
    /// The number of tiles being loaded.
    pub(crate) tiles_loading: usize,
    /// Whether the missing tiles exceed the graphics memory allowed.
    pub(crate) is_full: bool,
    /// The number of drawn triangles of the ground.
    pub(crate) triangles: u64,
    /// The number of drawn segments of roads.
    pub(crate) segments: u64,
    /// The bytes used on the GPU, and the limit.
    pub(crate) gpu_bytes: [u64; 2],
    /// The GPU times of the passes, for each image of the last frame that the GPU has finished.
    pub(crate) passes: &'a [(RoadMethod, PassTimes)],
    /// The durations of the last frames.
    pub(crate) frame_times: &'a FrameTimes,
    /// The lines that the user draws.
    pub(crate) drawing: DrawingContent,
    /// The duration of the recording so far; `None` if there is none.
    pub(crate) recording_s: Option<f64>,
    /// Messages, oldest first.
    pub(crate) notices: &'a [Notice],
}
