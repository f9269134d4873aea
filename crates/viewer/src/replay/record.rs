//! The numbers that a flight records of each frame.

use crate::{flight::Pose, gpu::PassTimes};

/// The numbers of one frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrameRecord {
    /// Number of the frame, 0 first.
    pub frame: u32,
    /// Time of the frame in the flight.
    pub time_s: f64,
    /// The camera, lifted if the flight is too close to the ground.
    pub pose: Pose,
    /// Tiles drawn.
    pub tiles_drawn: usize,
    /// Tiles decoded after this frame for later frames; in the first frame also the tiles for which
    /// it waited.
    pub tiles_loaded: usize,
    /// Tiles uploaded to the GPU.
    pub tiles_uploaded: usize,
    /// Tiles evicted from the GPU.
    pub tiles_evicted: usize,
    /// Tiles that the view needs and that are not loaded yet; coarser ones are drawn instead.
    pub tiles_missing: usize,
    /// Triangles of the ground drawn, without the triangles of skirts.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Bytes of tiles on the GPU.
    pub gpu_bytes: u64,
    /// CPU time for selecting tiles.
    pub select_ms: f64,
    /// CPU time for reading and decoding tiles. A window does this in other threads while it draws.
    pub decode_ms: f64,
    /// CPU time for uploading tiles to the GPU.
    pub upload_ms: f64,
    /// Time from the first command of the frame until the GPU has drawn it.
    pub draw_ms: f64,
    /// Times of the passes by the GPU's own clock, if it has one.
    pub passes: Option<PassTimes>,
}
