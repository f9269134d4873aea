//! The numbers that a flight records of each frame.

use crate::{flight::Pose, gpu::PassTimes};

/// The numbers of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameRecord {
    /// Its number, 0 first.
    pub frame: u32,
    /// Its time in the flight.
    pub time_s: f64,
    /// The camera, lifted if the flight comes too near to the ground.
    pub pose: Pose,
    /// Tiles drawn.
    pub tiles_drawn: usize,
    /// Tiles decoded after this frame for later frames; in the first frame also the tiles that it waited for.
    pub tiles_loaded: usize,
    /// Tiles handed to the graphics card.
    pub tiles_uploaded: usize,
    /// Tiles removed from the graphics card.
    pub tiles_evicted: usize,
    /// Tiles that the view needs and that are not loaded yet: coarser ones are drawn instead.
    pub tiles_missing: usize,
    /// Triangles of the ground drawn, without those of skirts.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Bytes of tiles on the graphics card.
    pub gpu_bytes: u64,
    /// Time of choosing tiles, on the processor.
    pub select_ms: f64,
    /// Time of reading and decoding tiles, on the processor. A window does it in other threads while it draws.
    pub decode_ms: f64,
    /// Time of handing tiles to the graphics card, on the processor.
    pub upload_ms: f64,
    /// Time from the first command of the frame until the graphics card has drawn it.
    pub draw_ms: f64,
    /// Times of the passes by the graphics card's own clock, if it has one.
    pub passes: Option<PassTimes>,
}
