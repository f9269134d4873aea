//! Errors of graphics devices and of reading pixels back.

/// Why there is no graphics device, or it cannot draw what is asked.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum GpuError {
    #[error("no graphics adapter found; install a Vulkan driver (software: mesa-vulkan-drivers)")]
    NoAdapter { source: wgpu::RequestAdapterError },
    #[error(
        "no graphics adapter has {name:?} in its name, as WGPU_ADAPTER_NAME asks; unset it to take the fastest"
    )]
    NotNamed { name: String },
    #[error("the graphics adapter {adapter:?} gives no device")]
    NoDevice { adapter: String, source: wgpu::RequestDeviceError },
    #[error(
        "a picture of {} × {} pixels, {samples_per_side} × {samples_per_side} samples in each, is beyond what the \
         adapter can draw ({limit_px} samples a side)",
        size_px[0],
        size_px[1]
    )]
    TooLarge { size_px: [u32; 2], samples_per_side: u32, limit_px: u32 },
    #[error("a picture needs at least one pixel, not {} × {}", size_px[0], size_px[1])]
    Empty { size_px: [u32; 2] },
    #[error(
        "{samples_per_side} samples on a pixel's side are out of range; it must be 1 to {most}"
    )]
    Samples { samples_per_side: u32, most: u32 },
    #[error("pictures of {sizes_px:?} samples cannot be compared: they must be of one size")]
    SizesDiffer { sizes_px: [[u32; 2]; 3] },
}

/// Why pixels did not come back.
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
    #[error("the graphics device could not do its work: {what}")]
    Fault { what: String },
    #[error("the drawn pixels did not come back")]
    Missing,
    #[error("no frame was timed since the last one")]
    Untimed,
}
