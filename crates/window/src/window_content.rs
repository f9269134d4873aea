//! What a frame shows beside the map: values that go from the app to the panel and the overlay.

use corniche_live::{DrawingContent, FrameTimes, GroundPoint, Notice, controls::Mode};
use corniche_roads::FunctionalRoadClass;
use corniche_styles::Rgb;
use corniche_viewer::{
    BoundaryLines, RoadMethod,
    flight::{Pose, WorkingCrs},
    gpu::PassTimes,
};

/// Everything that the panel and the overlay show, apart from the settings.
#[expect(clippy::struct_excessive_bools, reason = "facts, independent of each other")]
pub(crate) struct WindowContent<'a> {
    /// Name of the graphics adapter.
    pub(crate) adapter: &'a str,
    /// Whether the processor draws.
    pub(crate) is_software: bool,
    /// The package's credits.
    pub(crate) attribution: &'a [String],
    /// The package's CRS and what makes working metres of its coordinates.
    pub(crate) crs: WorkingCrs<'a>,
    /// The ground under the cursor; `None` over sky, voids and the panel.
    pub(crate) cursor: Option<GroundPoint>,
    /// The camera; its height is a true height.
    pub(crate) pose: Pose,
    /// True metres in a point of the screen at its middle; `None` without ground there.
    pub(crate) metres_per_point: Option<f64>,
    /// Map mode or fly mode.
    pub(crate) mode: Mode,
    /// Names of the styles.
    pub(crate) style_names: &'a [String],
    /// How strongly the style that is shown lets photos be seen; `None` in a package without photos.
    pub(crate) photo: Option<f32>,
    /// Whether the package has water, forest and so on.
    pub(crate) has_areas: bool,
    /// Whether it has boundaries.
    pub(crate) has_boundaries: bool,
    /// Names of the files of lines.
    pub(crate) overlays: &'a [String],
    /// Colours of their lines.
    pub(crate) overlay_colors: Vec<Rgb>,
    /// The boundaries of the package that the style draws.
    pub(crate) boundary_lines: Vec<BoundaryLines>,
    /// Colours of the roads in the style that is shown, by class.
    pub(crate) road_colors: &'a [Rgb],
    /// What the roads of each class are called.
    pub(crate) class_labels: &'a [String; FunctionalRoadClass::COUNT],
    /// Tiles that are drawn.
    pub(crate) tiles_drawn: usize,
    /// Tiles that the view needs and that are not on the graphics card.
    pub(crate) tiles_missing: usize,
    /// Tiles that are being loaded.
    pub(crate) tiles_loading: usize,
    /// Whether the missing tiles do not fit into the graphics memory allowed.
    pub(crate) is_full: bool,
    /// Triangles of the ground that are drawn.
    pub(crate) triangles: u64,
    /// Segments of roads that are drawn.
    pub(crate) segments: u64,
    /// Bytes on the graphics card, and how many there may be.
    pub(crate) gpu_bytes: [u64; 2],
    /// Times of the passes by the graphics card's clock, for each picture of the last frame that it has finished.
    pub(crate) passes: &'a [(RoadMethod, PassTimes)],
    /// How long the last frames took.
    pub(crate) frame_times: &'a FrameTimes,
    /// The lines that a person draws.
    pub(crate) drawing: DrawingContent,
    /// How long a flight has been recorded; `None` while none is.
    pub(crate) recording_s: Option<f64>,
    /// Messages, oldest first.
    pub(crate) notices: &'a [Notice],
}
