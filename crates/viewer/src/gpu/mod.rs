//! Everything that talks to the graphics card: device, targets, passes, buffers of tiles.
//!
//! ```text
//!  terrain pass ──► ground colour, depth, owner ──┬────────────► composite pass ──► picture
//!                                                 ▼                   ▲
//!                                     roads pass ──► road labels ─────┘
//! ```
//!
//! A label is 0 without a road, else `2 · (9 − class)`, plus 1 on a centre line: larger is more important.
//! Labels instead of colours let the composite pass find edges between classes, and let tests compare every
//! pixel's class with a reference.
//!
//! The owner of a pixel is the tile whose ground it shows. Volumes (SV) paint the ground of their own tile only;
//! each tile has all roads near enough. Marking tiles in the stencil buffer instead would allow 255 of them, and
//! a pass cannot write the stencil of a texture whose depth it reads; comparing a number costs one texture read.

mod passes;
mod renderer;
mod roads_pass;
mod targets;
mod tile_buffers;
mod tile_bytes;
mod timings;
mod uniforms;

pub use self::{
    renderer::{DrawTile, FrameView, Renderer},
    targets::{Owner, ReadBackError, Targets, label_class},
    tile_buffers::TileBuffers,
    tile_bytes::tile_bytes,
    timings::{PassTimer, PassTimes},
};

/// Why there is no graphics device.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum GpuError {
    #[error("no graphics adapter found; install a Vulkan driver (software: mesa-vulkan-drivers)")]
    NoAdapter { source: wgpu::RequestAdapterError },
    #[error("the graphics adapter {adapter:?} gives no device")]
    NoDevice { adapter: String, source: wgpu::RequestDeviceError },
    #[error(
        "a picture of {size_px:?} pixels is beyond what the adapter can draw ({limit_px} a side)"
    )]
    TooLarge { size_px: [u32; 2], limit_px: u32 },
    #[error("a picture needs at least one pixel, not {size_px:?}")]
    Empty { size_px: [u32; 2] },
}

/// A device without a window.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    adapter_name: String,
}

impl Gpu {
    /// Takes the fastest adapter, a software one if there is no other.
    ///
    /// # Errors
    /// When there is no adapter at all or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        // OpenGL only if there is nothing better.
        let adapter = request_adapter(wgpu::Backends::PRIMARY)
            .or_else(|_| request_adapter(wgpu::Backends::SECONDARY))
            .map_err(|source| GpuError::NoAdapter { source })?;
        let info = adapter.get_info();
        let adapter_name = format!("{} ({})", info.name, info.backend);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("corniche"),
            required_features: adapter.features() & PassTimer::FEATURES,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|source| GpuError::NoDevice { adapter: adapter_name.clone(), source })?;
        Ok(Self { device, queue, adapter_name })
    }

    /// What draws, for reports: "llvmpipe (…) (vulkan)".
    #[must_use]
    pub fn adapter_name(&self) -> &str {
        &self.adapter_name
    }

    /// Largest side of a picture.
    #[must_use]
    pub fn max_side_px(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}

fn request_adapter(backends: wgpu::Backends) -> Result<wgpu::Adapter, wgpu::RequestAdapterError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let fastest = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    };
    let software =
        wgpu::RequestAdapterOptions { force_fallback_adapter: true, ..Default::default() };
    pollster::block_on(instance.request_adapter(&fastest))
        .or_else(|_| pollster::block_on(instance.request_adapter(&software)))
}
