//! How long the passes of a frame take on the graphics card.

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Features, QuerySet, QuerySetDescriptor,
    QueryType,
};

use super::{Gpu, ReadBackError};

/// One mark before each pass and one after the last.
const MARKS: u32 = 4;
/// Bytes of all marks; each is a u64.
const MARK_BYTES: u64 = 8 * MARKS as u64;

/// Milliseconds that the passes of a frame took on the graphics card.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassTimes {
    /// Terrain.
    pub terrain_ms: f64,
    /// Roads.
    pub roads_ms: f64,
    /// Composite.
    pub composite_ms: f64,
}

/// Notes when the passes of one frame begin and end. Used for one frame after the other.
pub struct PassTimer {
    marks: QuerySet,
    resolved: Buffer,
    readable: Buffer,
    period_ns: f64,
}

impl PassTimer {
    /// What the device must be able to do.
    pub(super) const FEATURES: Features =
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
        Some(Self {
            marks: gpu.device.create_query_set(&QuerySetDescriptor {
                label: Some("passes"),
                ty: QueryType::Timestamp,
                count: MARKS,
            }),
            resolved: buffer("times", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readable: buffer("times to read", BufferUsages::COPY_DST | BufferUsages::MAP_READ),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// The pass with this number, 0 first, begins; with [`MARKS`] − 1 the last has ended.
    pub(super) fn mark(&self, encoder: &mut CommandEncoder, number: u32) {
        encoder.write_timestamp(&self.marks, number);
        if number == MARKS - 1 {
            encoder.resolve_query_set(&self.marks, 0..MARKS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, MARK_BYTES);
        }
    }

    /// Waits for the frame drawn last and tells how long its passes took.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn read(&self, gpu: &Gpu) -> Result<PassTimes, ReadBackError> {
        let slice = self.readable.slice(..);
        let (sender, receiver) = std::sync::mpsc::channel();
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // The receiver outlives the poll below, so sending cannot fail.
            let _ = sender.send(result);
        });
        gpu.finish()?;
        if let Ok(Err(source)) = receiver.try_recv() {
            return Err(ReadBackError::Map { source });
        }
        let marks: Vec<u64> = {
            let mapped =
                slice.get_mapped_range().map_err(|source| ReadBackError::Range { source })?;
            let (words, _) = mapped.as_chunks::<8>();
            words.iter().map(|word| u64::from_le_bytes(*word)).collect()
        };
        self.readable.unmap();
        // A clock that was set back in between must not make a pass take forever.
        let ms = |k: usize| marks[k + 1].saturating_sub(marks[k]) as f64 * self.period_ns / 1e6;
        Ok(PassTimes { terrain_ms: ms(0), roads_ms: ms(1), composite_ms: ms(2) })
    }
}

impl Gpu {
    /// Waits until everything handed over so far is drawn.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn finish(&self) -> Result<(), ReadBackError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|source| ReadBackError::Poll { source })
    }
}
