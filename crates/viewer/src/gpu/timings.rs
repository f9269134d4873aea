//! Measures how long the passes of a frame take on the GPU.

use std::sync::mpsc::{Receiver, Sender, channel};

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, QuerySet, QuerySetDescriptor, QueryType,
};

use super::{Gpu, ReadBackError, device::TIMESTAMPS};

/// Timestamps of a frame: one before each of its five parts and one after the last.
const MARKS: u32 = 6;
/// Bytes of all marks of a frame; each is a u64.
const MARK_BYTES: u64 = 8 * MARKS as u64;
/// Number of frames whose times may be pending. A GPU is two or three frames behind the CPU.
const FRAMES: usize = 4;

/// Times of the passes of a frame on the GPU, milliseconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PassTimes {
    /// Time of the terrain pass.
    pub terrain_ms: f64,
    /// Time of areas; 0 if none were drawn.
    pub areas_ms: f64,
    /// Time of the passes of roads.
    pub roads_ms: f64,
    /// Time of the passes of decks of bridges; 0 if none were drawn.
    pub decks_ms: f64,
    /// Time of the composite, including the preceding pass that finds blocks with roads, and the
    /// averaging of samples.
    pub composite_ms: f64,
}

/// Records when the passes of frames begin and end.
///
/// ```text
///  frame n ──► marks ──► resolved ──► readable[k] ──► mapped when the GPU has finished n ──► taken, free again
/// ```
///
/// A frame is not timed if no readable buffer is free.
pub struct PassTimer {
    marks: QuerySet,
    resolved: Buffer,
    readable: [Buffer; FRAMES],
    /// The readable buffers that no frame uses.
    free: Vec<usize>,
    /// The readable buffer of the frame that is being recorded.
    current: Option<usize>,
    /// For each readable buffer: whether its frame has areas, and decks.
    has: [[bool; 2]; FRAMES],
    sender: Sender<Mapped>,
    receiver: Receiver<Mapped>,
    period_ns: f64,
}

/// A readable buffer, and whether it could be mapped.
type Mapped = (usize, Result<(), wgpu::BufferAsyncError>);

impl PassTimes {
    /// The time of all passes together.
    #[must_use]
    pub fn total_ms(&self) -> f64 {
        self.terrain_ms + self.areas_ms + self.roads_ms + self.decks_ms + self.composite_ms
    }
}

impl PassTimer {
    /// Creates a timer; `None` if the adapter cannot write timestamps.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(TIMESTAMPS) {
            return None;
        }
        let buffer = |label, usage| {
            gpu.device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size: MARK_BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        let readable = || buffer("times to read", BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let (sender, receiver) = channel();
        Some(Self {
            marks: gpu.device.create_query_set(&QuerySetDescriptor {
                label: Some("passes"),
                ty: QueryType::Timestamp,
                count: MARKS,
            }),
            resolved: buffer("times", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readable: std::array::from_fn(|_| readable()),
            free: (0..FRAMES).collect(),
            current: None,
            has: [[false; 2]; FRAMES],
            sender,
            receiver,
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Begins a frame; `has` tells whether it has areas, and decks. Without them there are no such
    /// passes, but some time passes between the marks around them.
    pub(crate) fn begin(&mut self, has: [bool; 2]) {
        self.current = self.free.pop();
        if let Some(slot) = self.current {
            self.has[slot] = has;
        }
    }

    /// Marks the start of the part with this number, 0 first; [`MARKS`] − 1 marks the end of the
    /// last part.
    pub(crate) fn mark(&mut self, encoder: &mut CommandEncoder, number: u32) {
        let Some(slot) = self.current else { return };
        encoder.write_timestamp(&self.marks, number);
        if number == MARKS - 1 {
            let readable = &self.readable[slot];
            encoder.resolve_query_set(&self.marks, 0..MARKS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, readable, 0, MARK_BYTES);
            let sender = self.sender.clone();
            encoder.map_buffer_on_submit(readable, wgpu::MapMode::Read, .., move |result| {
                // Sending fails if the timer was dropped; then nobody needs the times.
                let _ = sender.send((slot, result));
            });
            self.current = None;
        }
    }

    /// Waits for the frame drawn last and returns the times of its passes.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read(&mut self, gpu: &Gpu) -> Result<PassTimes, ReadBackError> {
        gpu.finish()?;
        self.newest()?.ok_or(ReadBackError::Untimed)
    }

    /// Returns the times of the passes of the newest finished frame; `None` if no frame has
    /// finished since the last call. Never waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn poll(&mut self, gpu: &Gpu) -> Result<Option<PassTimes>, ReadBackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(|source| ReadBackError::Poll { source })?;
        self.newest()
    }

    /// The times of the newest finished frame. Frames finish in order; the buffers of all finished
    /// frames become free again.
    fn newest(&mut self) -> Result<Option<PassTimes>, ReadBackError> {
        let mut newest = None;
        while let Ok((slot, result)) = self.receiver.try_recv() {
            self.free.push(slot);
            result.map_err(|source| ReadBackError::Map { source })?;
            newest = Some(self.times(slot)?);
            self.readable[slot].unmap();
        }
        Ok(newest)
    }

    fn times(&self, slot: usize) -> Result<PassTimes, ReadBackError> {
        let mapped = self.readable[slot]
            .get_mapped_range(..)
            .map_err(|source| ReadBackError::Range { source })?;
        let (words, _) = mapped.as_chunks::<8>();
        let marks: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        // If the clock was set back in between, the time counts as 0.
        let ms = |k: usize| marks[k + 1].saturating_sub(marks[k]) as f64 * self.period_ns / 1e6;
        let [has_areas, has_decks] = self.has[slot];
        Ok(PassTimes {
            terrain_ms: ms(0),
            areas_ms: if has_areas { ms(1) } else { 0.0 },
            roads_ms: ms(2),
            decks_ms: if has_decks { ms(3) } else { 0.0 },
            composite_ms: ms(4),
        })
    }
}
