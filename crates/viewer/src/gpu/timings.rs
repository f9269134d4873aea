//! How long the passes of a frame take on the graphics card.

use std::sync::mpsc::{Receiver, Sender, channel};

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Features, QuerySet, QuerySetDescriptor,
    QueryType,
};

use super::{Gpu, ReadBackError};

/// One mark before each pass and one after the last.
const MARKS: u32 = 4;
/// Bytes of all marks; each is a u64.
const MARK_BYTES: u64 = 8 * MARKS as u64;
/// So many frames may be under way with their times; a card is two or three behind the processor.
const FRAMES: usize = 4;

/// Milliseconds that the passes of a frame took on the graphics card.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassTimes {
    /// Terrain.
    pub terrain_ms: f64,
    /// Roads.
    pub roads_ms: f64,
    /// Composite, what it asks about blocks before, and the averaging of samples.
    pub composite_ms: f64,
}

/// Notes when the passes of frames begin and end.
///
/// ```text
///  frame n ──► marks ──► resolved ──► readable[k] ──► mapped when the card is done with n ──► taken, free again
/// ```
///
/// A frame that finds no readable buffer free goes untimed.
pub struct PassTimer {
    marks: QuerySet,
    resolved: Buffer,
    readable: [Buffer; FRAMES],
    /// Those no frame is using.
    free: Vec<usize>,
    /// Where the frame that is being recorded goes.
    current: Option<usize>,
    sender: Sender<Mapped>,
    receiver: Receiver<Mapped>,
    period_ns: f64,
}

/// A readable buffer that was to be mapped, and how that went.
type Mapped = (usize, Result<(), wgpu::BufferAsyncError>);

impl PassTimer {
    /// What the device must be able to do.
    pub(crate) const FEATURES: Features =
        Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

    /// `None` when the adapter has no clock.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(Self::FEATURES) {
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
            sender,
            receiver,
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// The pass with this number, 0 first, begins; with [`MARKS`] − 1 the last has ended.
    pub(crate) fn mark(&mut self, encoder: &mut CommandEncoder, number: u32) {
        if number == 0 {
            self.current = self.free.pop();
        }
        let Some(slot) = self.current else { return };
        encoder.write_timestamp(&self.marks, number);
        if number == MARKS - 1 {
            let readable = &self.readable[slot];
            encoder.resolve_query_set(&self.marks, 0..MARKS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, readable, 0, MARK_BYTES);
            let sender = self.sender.clone();
            encoder.map_buffer_on_submit(readable, wgpu::MapMode::Read, .., move |result| {
                // Nobody listens once the timer is gone.
                let _ = sender.send((slot, result));
            });
            self.current = None;
        }
    }

    /// Waits for the frame drawn last and tells how long its passes took.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read(&mut self, gpu: &Gpu) -> Result<PassTimes, ReadBackError> {
        gpu.finish()?;
        self.newest()?.ok_or(ReadBackError::Untimed)
    }

    /// How long the passes of the newest frame took that is done, if any was done since this was asked last. Never
    /// waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn poll(&mut self, gpu: &Gpu) -> Result<Option<PassTimes>, ReadBackError> {
        gpu.device.poll(wgpu::PollType::Poll).map_err(|source| ReadBackError::Poll { source })?;
        self.newest()
    }

    /// Takes all frames that are done; frames are done in order.
    fn newest(&mut self) -> Result<Option<PassTimes>, ReadBackError> {
        let mut newest = None;
        while let Ok((slot, result)) = self.receiver.try_recv() {
            self.free.push(slot);
            result.map_err(|source| ReadBackError::Map { source })?;
            newest = Some(self.times(&self.readable[slot])?);
            self.readable[slot].unmap();
        }
        Ok(newest)
    }

    fn times(&self, readable: &Buffer) -> Result<PassTimes, ReadBackError> {
        let mapped =
            readable.get_mapped_range(..).map_err(|source| ReadBackError::Range { source })?;
        let (words, _) = mapped.as_chunks::<8>();
        let marks: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        // A clock that was set back in between must not make a pass take forever.
        let ms = |k: usize| marks[k + 1].saturating_sub(marks[k]) as f64 * self.period_ns / 1e6;
        Ok(PassTimes { terrain_ms: ms(0), roads_ms: ms(1), composite_ms: ms(2) })
    }
}
