use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use super::{PassTimer, ReadBackError};

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

/// A graphics device.
pub struct Gpu {
    adapter: wgpu::Adapter,
    adapter_name: String,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    faults: Arc<Faults>,
}

/// What the device reports from elsewhere than where it was called.
#[derive(Default)]
struct Faults {
    is_lost: AtomicBool,
    first: Mutex<Option<String>>,
}

impl Gpu {
    /// Takes the fastest adapter, a software one if there is no other; no window is needed.
    ///
    /// The environment may choose, as with other programs of this kind: `WGPU_BACKEND` (vulkan, gl, metal, dx12) and
    /// `WGPU_ADAPTER_NAME` (a part of it).
    ///
    /// # Errors
    /// When there is no adapter, or none as the environment asks for, or it gives no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new() -> Result<Self, GpuError> {
        match std::env::var("WGPU_BACKEND") {
            Ok(names) => Self::with_backends(wgpu::Backends::from_comma_list(&names)),
            // OpenGL only if there is nothing better.
            Err(_) => Self::with_backends(wgpu::Backends::PRIMARY)
                .or_else(|_| Self::with_backends(wgpu::Backends::SECONDARY)),
        }
    }

    /// The same with these backends alone.
    ///
    /// # Errors
    /// When they have no adapter, or none as the environment asks for, or it gives no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn with_backends(backends: wgpu::Backends) -> Result<Self, GpuError> {
        let descriptor = wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        pollster::block_on(Self::request(&wgpu::Instance::new(descriptor), None))
    }

    /// The same for a window: an adapter that can show pictures on `surface`, which `instance` made. The
    /// instance decides which backends there are; `WGPU_ADAPTER_NAME` may choose here too.
    ///
    /// # Errors
    /// When no such adapter can show pictures there or it gives no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn for_window(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<Self, GpuError> {
        pollster::block_on(Self::request(instance, Some(surface)))
    }

    /// The same without waiting, with or without a window.
    ///
    /// # Errors
    /// When there is no such adapter or it gives no device.
    pub async fn request(
        instance: &wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Self, GpuError> {
        let adapter = adapter(instance, surface).await?;
        let info = adapter.get_info();
        let adapter_name = format!("{} ({})", info.name, info.backend);
        // Everything else keeps to WebGPU's defaults; how large a picture may be is not for shaders to depend on.
        let required_limits = wgpu::Limits {
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("corniche"),
            required_features: adapter.features() & PassTimer::FEATURES,
            required_limits,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|source| GpuError::NoDevice { adapter: adapter_name.clone(), source })?;
        let faults = Arc::new(Faults::default());
        let seen = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, _| seen.is_lost.store(true, Ordering::Release));
        let seen = Arc::clone(&faults);
        // Without a handler the process would end.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut first = seen.first.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert_with(|| error.to_string());
        }));
        Ok(Self { adapter, adapter_name, device, queue, faults })
    }

    /// What draws, for reports: "llvmpipe (…) (vulkan)".
    #[must_use]
    pub fn adapter_name(&self) -> &str {
        &self.adapter_name
    }

    /// Whether the processor draws, for want of a graphics card.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device is gone, by a reset of its driver for instance. All that was made with it is gone too: a
    /// window makes everything anew.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.faults.is_lost.load(Ordering::Acquire)
    }

    /// The first thing that went wrong since this was asked last: memory ran out, or a mistake in the renderer. What
    /// was drawn since cannot be trusted. Reading pixels back tells of it too.
    #[must_use]
    pub fn take_fault(&self) -> Option<String> {
        self.faults.first.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Largest side of a picture, samples counted: the adapter's own limit.
    #[must_use]
    pub fn max_side_px(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// What the device is made from; knows what surfaces can do.
    #[must_use]
    pub fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// Makes buffers, textures and pipelines.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Takes work.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Waits until everything handed over so far is drawn.
    ///
    /// # Errors
    /// When the device is lost or something went wrong since the last time.
    pub fn finish(&self) -> Result<(), ReadBackError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|source| ReadBackError::Poll { source })?;
        self.check()
    }

    /// Fails when something went wrong since the last time.
    pub(crate) fn check(&self) -> Result<(), ReadBackError> {
        self.take_fault().map_or(Ok(()), |what| Err(ReadBackError::Fault { what }))
    }

    /// A buffer with these contents, whose length is a multiple of 4.
    ///
    /// `wgpu`'s own helper maps the buffer instead and panics when the device is lost.
    pub(crate) fn buffer(
        &self,
        label: &str,
        contents: &[u8],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: contents.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, contents);
        buffer
    }
}

/// The adapter the environment names, else the fastest, else a software one.
async fn adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    if let Ok(name) = std::env::var("WGPU_ADAPTER_NAME") {
        return named_adapter(instance, surface, name).await;
    }
    let fastest = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        compatible_surface: surface,
        ..Default::default()
    };
    let software = wgpu::RequestAdapterOptions {
        force_fallback_adapter: true,
        compatible_surface: surface,
        ..Default::default()
    };
    if let Ok(adapter) = instance.request_adapter(&fastest).await {
        return Ok(adapter);
    }
    let found = instance.request_adapter(&software).await;
    found.map_err(|source| GpuError::NoAdapter { source })
}

async fn named_adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
    name: String,
) -> Result<wgpu::Adapter, GpuError> {
    let wanted = name.to_lowercase();
    instance
        .enumerate_adapters(wgpu::Backends::all())
        .await
        .into_iter()
        .filter(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)))
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
        .ok_or(GpuError::NotNamed { name })
}
