//! The graphics device: how to open it, its capabilities, and its faults.

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use corniche_work::locked;
use wgpu::Features;

use super::{GpuError, ReadBackError, adapter::adapter};

/// Features that a device needs to time the passes of a frame.
pub(crate) const TIMESTAMPS: Features =
    Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// A graphics device.
pub struct Gpu {
    /// Adapter of the device; it knows the capabilities of surfaces.
    pub adapter: wgpu::Adapter,
    /// Name and backend of the adapter, for reports: "llvmpipe (…) (vulkan)".
    pub adapter_name: String,
    /// Device of `wgpu`: creates buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// Queue of `wgpu`: receives commands.
    pub queue: wgpu::Queue,
    faults: Arc<Faults>,
}

/// Faults that the device reports by callbacks.
#[derive(Default)]
struct Faults {
    is_lost: AtomicBool,
    first: Mutex<Option<String>>,
}

impl Faults {
    /// Records the faults of `device` from now on.
    fn from_device(device: &wgpu::Device) -> Arc<Self> {
        let faults = Arc::new(Self::default());
        let seen = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, _| seen.is_lost.store(true, Ordering::Release));
        let seen = Arc::clone(&faults);
        // Without a handler the process would abort.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut first = locked(&seen.first);
            first.get_or_insert_with(|| error.to_string());
        }));
        faults
    }
}

/// Names of the graphics APIs that the program was built for, as `WGPU_BACKEND` takes them. Drawing
/// finds out which of them a machine supports.
#[must_use]
pub fn backends() -> Vec<String> {
    let built_in = wgpu::Instance::enabled_backend_features();
    built_in.iter_names().map(|(name, _)| name.to_ascii_lowercase()).collect()
}

impl Gpu {
    /// Opens a device of the fastest adapter, or of a software adapter if there is no other. No
    /// window is needed.
    ///
    /// Environment variables can choose the adapter, as in other programs that use wgpu:
    /// `WGPU_BACKEND` (vulkan, gl, metal, dx12) and `WGPU_ADAPTER_NAME` (a part of the adapter's
    /// name).
    ///
    /// # Errors
    /// When there is no adapter, or none with the name that the environment requests, or the
    /// adapter provides no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new() -> Result<Self, GpuError> {
        match std::env::var("WGPU_BACKEND") {
            Ok(names) => Self::with_backends(wgpu::Backends::from_comma_list(&names)),
            // OpenGL is the last choice.
            Err(_) => Self::with_backends(wgpu::Backends::PRIMARY)
                .or_else(|_| Self::with_backends(wgpu::Backends::SECONDARY)),
        }
    }

    /// Does the same as [`Gpu::new`], but with these backends only.
    ///
    /// # Errors
    /// When they have no adapter, or none with the name that the environment requests, or the
    /// adapter provides no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn with_backends(backends: wgpu::Backends) -> Result<Self, GpuError> {
        let descriptor = wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        pollster::block_on(Self::request(&wgpu::Instance::new(descriptor), None))
    }

    /// Opens a device for a window: its adapter can present pictures on `surface`, which `instance`
    /// created. The instance decides which backends are tried; `WGPU_ADAPTER_NAME` may choose the
    /// adapter here, too.
    ///
    /// # Errors
    /// When no such adapter can present pictures there, or the adapter provides no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn for_window(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<Self, GpuError> {
        pollster::block_on(Self::request(instance, Some(surface)))
    }

    /// Opens a device, with or without a window, for callers that must not wait.
    ///
    /// # Errors
    /// When there is no such adapter, or the adapter provides no device.
    pub async fn request(
        instance: &wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Self, GpuError> {
        let adapter = adapter(instance, surface).await?;
        let info = adapter.get_info();
        let adapter_name = format!("{} ({})", info.name, info.backend);
        // All other limits are WebGPU's defaults. No shader depends on the maximum size of a
        // picture.
        let required_limits = wgpu::Limits {
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("corniche"),
            required_features: adapter.features() & TIMESTAMPS,
            required_limits,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|source| GpuError::NoDevice { adapter: adapter_name.clone(), source })?;
        let faults = Faults::from_device(&device);
        Ok(Self { adapter, adapter_name, device, queue, faults })
    }

    /// Whether the adapter is software on the CPU, not a GPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device is lost, for instance because its driver was reset. All resources that
    /// were created with the device are lost, too: a window creates them again.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.faults.is_lost.load(Ordering::Acquire)
    }

    /// Whether there is a fault that [`Gpu::take_fault`] will return.
    #[must_use]
    pub fn has_fault(&self) -> bool {
        locked(&self.faults.first).is_some()
    }

    /// Returns the first fault since the last call: memory ran out, or the renderer made a mistake.
    /// Pictures drawn since then cannot be trusted. Reading pixels back reports the same fault.
    #[must_use]
    pub fn take_fault(&self) -> Option<String> {
        locked(&self.faults.first).take()
    }

    /// Maximum side of a picture in samples: the adapter's own limit.
    #[must_use]
    pub fn max_side_px(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Waits until all submitted work is drawn.
    ///
    /// # Errors
    /// When the device is lost, or it had a fault since the last check.
    pub fn finish(&self) -> Result<(), ReadBackError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|source| ReadBackError::Poll { source })?;
        self.check()
    }

    /// Fails when the device had a fault since the last check.
    pub(crate) fn check(&self) -> Result<(), ReadBackError> {
        self.take_fault().map_or(Ok(()), |what| Err(ReadBackError::Fault { what }))
    }

    /// Records commands and submits them.
    pub fn submit(&self, label: &str, record: impl FnOnce(&mut wgpu::CommandEncoder)) {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some(label) };
        let mut encoder = self.device.create_command_encoder(&descriptor);
        record(&mut encoder);
        self.queue.submit([encoder.finish()]);
    }

    /// Creates a texture with `sizes` mip levels, each half as large as the previous one.
    #[must_use]
    pub fn texture(
        &self,
        label: &str,
        format: wgpu::TextureFormat,
        [width, height]: [u32; 2],
        sizes: u32,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: sizes,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Creates a buffer with these contents, whose length is a multiple of 4.
    ///
    /// The helper of `wgpu` maps the buffer instead, and panics when the device is lost.
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
