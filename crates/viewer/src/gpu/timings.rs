//! How long the passes of a frame take on the graphics card.

use std::sync::mpsc::{Receiver, Sender, channel};

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, QuerySet, QuerySetDescriptor, QueryType,
};

use super::{Gpu, ReadBackError, device::TIMESTAMPS};

/// Timestamps of a frame: one before each of its five parts and one after the last.
const MARKS: u32 = 6;
/// Bytes of all marks of a frame; each is a u64.
const MARK_BYTES: u64 = 8 * MARKS as u64;
/// The times of so many frames may be waited for at once. A graphics card is two or three frames behind the processor.
const FRAMES: usize = 4;

/// Milliseconds that the passes of a frame took on the graphics card.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PassTimes {
    /// The pass of the terrain.
    pub terrain_ms: f64,
    /// Areas; 0 where none were drawn.
    pub areas_ms: f64,
    /// The passes of roads.
    pub roads_ms: f64,
    /// The passes of decks of bridges; 0 where none were drawn.
    pub decks_ms: f64,
    /// Composite, with the pass before it that finds blocks with roads, and the averaging of samples.
    pub composite_ms: f64,
}

/// Notes when the passes of frames begin and end.
///
/// ```text
///  frame n ──► marks ──► resolved ──► readable[k] ──► mapped when the card is done with n ──► taken, free again
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
    /// Tells for each readable buffer whether its frame has areas, and decks.
    has: [[bool; 2]; FRAMES],
    sender: Sender<Mapped>,
    receiver: Receiver<Mapped>,
    period_ns: f64,
}

/// Which readable buffer was to be mapped, and whether it was.
type Mapped = (usize, Result<(), wgpu::BufferAsyncError>);

impl PassTimes {
    /// The time of all passes together.
    #[must_use]
    pub fn total_ms(&self) -> f64 {
        self.terrain_ms + self.areas_ms + self.roads_ms + self.decks_ms + self.composite_ms
    }
}

impl PassTimer {
    /// `None` when the adapter cannot write timestamps.
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

    /// Begins a frame, with areas and with decks. Without them it has no such passes, though some time passes between the marks around them.
    pub(crate) fn begin(&mut self, has: [bool; 2]) {
        self.current = self.free.pop();
        if let Some(slot) = self.current {
            self.has[slot] = has;
        }
    }

    /// Notes that the part with this number begins, 0 first; with [`MARKS`] − 1, that the last part has ended.
    pub(crate) fn mark(&mut self, encoder: &mut CommandEncoder, number: u32) {
        let Some(slot) = self.current else { return };
        encoder.write_timestamp(&self.marks, number);
        if number == MARKS - 1 {
            let readable = &self.readable[slot];
            encoder.resolve_query_set(&self.marks, 0..MARKS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, readable, 0, MARK_BYTES);
            let sender = self.sender.clone();
            encoder.map_buffer_on_submit(readable, wgpu::MapMode::Read, .., move |result| {
                // Sending fails when the timer was dropped; then nobody needs the times.
                let _ = sender.send((slot, result));
            });
            self.current = None;
        }
    }

    /// Waits for the frame drawn last and returns how long its passes took.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read(&mut self, gpu: &Gpu) -> Result<PassTimes, ReadBackError> {
        gpu.finish()?;
        self.newest()?.ok_or(ReadBackError::Untimed)
    }

    /// How long the passes of the newest finished frame took; `None` if none has finished since this was asked last. Never
    /// waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn poll(&mut self, gpu: &Gpu) -> Result<Option<PassTimes>, ReadBackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(|source| ReadBackError::Poll { source })?;
        self.newest()
    }

    /// The times of the newest finished frame. Frames finish in order; the buffers of all that have finished are free
    /// again.
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
