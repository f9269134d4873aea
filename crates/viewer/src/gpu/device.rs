//! The graphics device: how it is opened, what it can do, and how its faults are noticed.

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use corniche_work::locked;
use wgpu::Features;

use super::{GpuError, ReadBackError, adapter::adapter};

/// What a device must be able to do so that the passes of a frame can be timed.
pub(crate) const TIMESTAMPS: Features =
    Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// A graphics device.
pub struct Gpu {
    /// The adapter that the device belongs to; it knows what surfaces can do.
    pub adapter: wgpu::Adapter,
    /// Name and backend of the adapter, for reports: "llvmpipe (…) (vulkan)".
    pub adapter_name: String,
    /// The device of `wgpu`: makes buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// The queue of `wgpu`: takes commands.
    pub queue: wgpu::Queue,
    faults: Arc<Faults>,
}

/// What the device reports by callbacks.
#[derive(Default)]
struct Faults {
    is_lost: AtomicBool,
    first: Mutex<Option<String>>,
}

impl Faults {
    /// Notes the faults of `device` from now on.
    fn of(device: &wgpu::Device) -> Arc<Self> {
        let faults = Arc::new(Self::default());
        let seen = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, _| seen.is_lost.store(true, Ordering::Release));
        let seen = Arc::clone(&faults);
        // Without a handler the process would end.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut first = locked(&seen.first);
            first.get_or_insert_with(|| error.to_string());
        }));
        faults
    }
}

/// Names of the graphics interfaces that the program was built for, as `WGPU_BACKEND` takes them. Which of them a machine has is found
/// out when something is drawn.
#[must_use]
pub fn backends() -> Vec<String> {
    let built_in = wgpu::Instance::enabled_backend_features();
    built_in.iter_names().map(|(name, _)| name.to_ascii_lowercase()).collect()
}

impl Gpu {
    /// A device of the fastest adapter, or of a software adapter if there is no other; no window is needed.
    ///
    /// As in other programs that use wgpu, environment variables may choose: `WGPU_BACKEND` (vulkan, gl, metal, dx12) and
    /// `WGPU_ADAPTER_NAME` (a part of the adapter's name).
    ///
    /// # Errors
    /// When there is no adapter, or none with the name that the environment asks for, or it gives no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new() -> Result<Self, GpuError> {
        match std::env::var("WGPU_BACKEND") {
            Ok(names) => Self::with_backends(wgpu::Backends::from_comma_list(&names)),
            // OpenGL only if there is nothing better.
            Err(_) => Self::with_backends(wgpu::Backends::PRIMARY)
                .or_else(|_| Self::with_backends(wgpu::Backends::SECONDARY)),
        }
    }

    /// Does the same as [`Gpu::new`] with these backends only.
    ///
    /// # Errors
    /// When they have no adapter, or none with the name that the environment asks for, or it gives no device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn with_backends(backends: wgpu::Backends) -> Result<Self, GpuError> {
        let descriptor = wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        pollster::block_on(Self::request(&wgpu::Instance::new(descriptor), None))
    }

    /// A device for a window: its adapter can show pictures on `surface`, which `instance` made. The instance decides
    /// which backends are tried; `WGPU_ADAPTER_NAME` may choose the adapter here too.
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

    /// A device, with or without a window, for callers that must not wait.
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
        // All other limits are WebGPU's defaults. No shader depends on how large a picture may be.
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
        let faults = Faults::of(&device);
        Ok(Self { adapter, adapter_name, device, queue, faults })
    }

    /// Whether the adapter is a program on the processor, not a graphics card.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device is lost, for instance because its driver was reset. All that was made with it is lost too: a
    /// window makes everything again.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.faults.is_lost.load(Ordering::Acquire)
    }

    /// Whether there is a fault that [`Gpu::take_fault`] will tell.
    #[must_use]
    pub fn has_fault(&self) -> bool {
        locked(&self.faults.first).is_some()
    }

    /// The first fault since this was asked last: memory ran out, or the renderer made a mistake. What was drawn since
    /// then cannot be trusted. Reading pixels back reports the same fault.
    #[must_use]
    pub fn take_fault(&self) -> Option<String> {
        locked(&self.faults.first).take()
    }

    /// Largest side of a picture in samples: the adapter's own limit.
    #[must_use]
    pub fn max_side_px(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Waits until everything submitted so far is drawn.
    ///
    /// # Errors
    /// When the device is lost, or it had a fault since this was asked last.
    pub fn finish(&self) -> Result<(), ReadBackError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|source| ReadBackError::Poll { source })?;
        self.check()
    }

    /// Fails when the device had a fault since this was asked last.
    pub(crate) fn check(&self) -> Result<(), ReadBackError> {
        self.take_fault().map_or(Ok(()), |what| Err(ReadBackError::Fault { what }))
    }

    /// Has recorded commands done.
    pub fn submit(&self, label: &str, record: impl FnOnce(&mut wgpu::CommandEncoder)) {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some(label) };
        let mut encoder = self.device.create_command_encoder(&descriptor);
        record(&mut encoder);
        self.queue.submit([encoder.finish()]);
    }

    /// A texture with so many sizes, each half as large as the one before.
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

    /// A buffer with these contents, whose length is a multiple of 4.
    ///
    /// `wgpu`'s own helper maps the buffer instead, and panics when the device is lost.
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
