use crate::{flight::Pose, gpu::PassTimes};

/// What one frame came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameRecord {
    /// Its number, 0 first.
    pub frame: u32,
    /// When in the flight.
    pub time_s: f64,
    /// Where the camera is, lifted off the ground where the flight led too near to it.
    pub pose: Pose,
    /// Tiles drawn.
    pub tiles_drawn: usize,
    /// Tiles decoded after this frame, for later ones; in the first frame those it waited for too.
    pub tiles_loaded: usize,
    /// Tiles handed to the graphics card.
    pub tiles_uploaded: usize,
    /// Tiles removed from the graphics card.
    pub tiles_evicted: usize,
    /// Tiles that the view wants and that are not there yet: coarser ones are drawn instead.
    pub tiles_missing: usize,
    /// Triangles of the ground drawn, skirts not counted.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Bytes of tiles on the graphics card.
    pub gpu_bytes: u64,
    /// Choosing tiles, processor.
    pub select_ms: f64,
    /// Reading and decoding tiles, processor. A window does it beside the drawing.
    pub decode_ms: f64,
    /// Handing tiles over, processor.
    pub upload_ms: f64,
    /// From the first command of the frame until the graphics card has drawn it.
    pub draw_ms: f64,
    /// The passes by the graphics card's own clock, if it has one.
    pub passes: Option<PassTimes>,
}
