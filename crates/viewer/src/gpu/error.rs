//! Errors of graphics devices and of reading pixels back.

/// Why there is no graphics device, or why it cannot draw the request.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum GpuError {
    #[error("no graphics adapter found; install a Vulkan driver (software: mesa-vulkan-drivers)")]
    NoAdapter { source: wgpu::RequestAdapterError },
    #[error(
        "no graphics adapter has {name:?} in its name, as WGPU_ADAPTER_NAME requests; unset the variable to use the fastest adapter"
    )]
    NotNamed { name: String },
    #[error("the graphics adapter {adapter:?} provides no device")]
    NoDevice { adapter: String, source: wgpu::RequestDeviceError },
    #[error(
        "an image of {} × {} pixels, with {samples_per_side} × {samples_per_side} samples in each, is larger than the \
         adapter can draw ({limit_px} samples a side)",
        size_px[0],
        size_px[1]
    )]
    TooLarge { size_px: [u32; 2], samples_per_side: u32, limit_px: u32 },
    #[error("an image needs at least one pixel, not {} × {}", size_px[0], size_px[1])]
    Empty { size_px: [u32; 2] },
    #[error(
        "{samples_per_side} samples along each side of a pixel are out of range; pass 1 to {most}"
    )]
    Samples { samples_per_side: u32, most: u32 },
    #[error("images of {sizes_px:?} samples cannot be compared: they must have the same size")]
    SizesDiffer { sizes_px: [[u32; 2]; 3] },
}

/// Why pixels could not be read back.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReadBackError {
    #[error("the graphics device did not finish drawing")]
    Poll { source: wgpu::PollError },
    #[error("the drawn pixels cannot be mapped")]
    Map { source: wgpu::BufferAsyncError },
    #[error("the drawn pixels cannot be read")]
    Range { source: wgpu::MapRangeError },
    #[error("the graphics device failed: {what}")]
    Fault { what: String },
    #[error("the drawn pixels were not returned")]
    Missing,
    #[error("no frame has been timed since the last query")]
    Untimed,
}
