//! The surface of the window, and all the ways in which it fails.

use std::sync::Arc;

use corniche_viewer::gpu::Gpu;
use wgpu::{
    Backends, CurrentSurfaceTexture, Instance, InstanceDescriptor, Surface, SurfaceConfiguration,
    SurfaceTexture, TextureFormat,
};
use winit::{event_loop::ActiveEventLoop, window::Window};

use crate::{WindowError, canvas::Canvas};

/// The surface, configured for the window's size.
pub(super) struct Screen {
    surface: Surface<'static>,
    instance: Instance,
    configuration: SurfaceConfiguration,
    size_px: [u32; 2],
}

/// What there is to paint into.
pub(super) enum Acquired {
    /// This.
    Texture(SurfaceTexture),
    /// Nothing just now; it is worth trying again at once.
    Later,
    /// Nothing while the window is hidden; an event will tell.
    Hidden,
}

impl Screen {
    /// The surface of a window and a device that draws on it; OpenGL only if there is nothing better.
    pub(super) fn new(
        event_loop: &ActiveEventLoop,
        window: &Arc<Window>,
    ) -> Result<(Self, Gpu), WindowError> {
        let with = |backends| {
            let display = Box::new(event_loop.owned_display_handle());
            let descriptor = InstanceDescriptor {
                backends,
                ..InstanceDescriptor::new_with_display_handle(display)
            };
            Self::with(Instance::new(descriptor.with_env()), window)
        };
        with(Backends::PRIMARY).or_else(|_| with(Backends::SECONDARY))
    }

    fn with(instance: Instance, window: &Arc<Window>) -> Result<(Self, Gpu), WindowError> {
        let surface = new_surface(&instance, window)?;
        let gpu = Gpu::for_window(&instance, &surface)?;
        let size = window.inner_size();
        let size_px = [size.width, size.height];
        let configuration = configuration(&surface, &gpu)?;
        let mut screen = Self { surface, instance, configuration, size_px };
        screen.configure(gpu.device());
        Ok((screen, gpu))
    }

    /// Colours as they are painted: encoded as sRGB, without the surface's doing.
    pub(super) fn format(&self) -> TextureFormat {
        self.configuration.format
    }

    /// Width and height; 0 while the window is minimised on some systems.
    pub(super) fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The window has another size.
    pub(super) fn resize(&mut self, canvas: &Canvas, size_px: [u32; 2]) {
        self.size_px = size_px;
        self.configure(canvas.gpu().device());
    }

    fn configure(&mut self, device: &wgpu::Device) {
        if self.size_px.contains(&0) {
            return;
        }
        [self.configuration.width, self.configuration.height] = self.size_px;
        self.surface.configure(device, &self.configuration);
    }

    /// Gets something to paint into; once for each way of losing it, the surface is made anew.
    pub(super) fn acquire(
        &mut self,
        canvas: &Canvas,
        window: &Arc<Window>,
    ) -> Result<Acquired, WindowError> {
        let device = canvas.gpu().device();
        for _ in 0..3 {
            match self.surface.get_current_texture() {
                CurrentSurfaceTexture::Success(texture)
                | CurrentSurfaceTexture::Suboptimal(texture) => {
                    let size = texture.texture.size();
                    if [size.width, size.height] == self.size_px {
                        return Ok(Acquired::Texture(texture));
                    }
                    drop(texture);
                    self.configure(device);
                }
                CurrentSurfaceTexture::Timeout => return Ok(Acquired::Later),
                CurrentSurfaceTexture::Occluded => return Ok(Acquired::Hidden),
                CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => {
                    self.configure(device);
                }
                CurrentSurfaceTexture::Lost => {
                    self.surface = new_surface(&self.instance, window)?;
                    self.configure(device);
                }
            }
        }
        // The window changes faster than the surface can follow.
        Ok(Acquired::Later)
    }

    /// A new surface and a new device, in the place of those lost.
    pub(super) fn rebuild(&mut self, window: &Arc<Window>) -> Result<Gpu, WindowError> {
        self.surface = new_surface(&self.instance, window)?;
        let gpu = Gpu::for_window(&self.instance, &self.surface)?;
        self.configuration = configuration(&self.surface, &gpu)?;
        self.configure(gpu.device());
        Ok(gpu)
    }
}

fn new_surface(instance: &Instance, window: &Arc<Window>) -> Result<Surface<'static>, WindowError> {
    instance
        .create_surface(Arc::clone(window))
        .map_err(|source| WindowError::Surface { source: source.into() })
}

fn configuration(surface: &Surface<'_>, gpu: &Gpu) -> Result<SurfaceConfiguration, WindowError> {
    let none = || WindowError::NoFormat { adapter: gpu.adapter_name().to_owned() };
    let default = surface.get_default_config(gpu.adapter(), 1, 1).ok_or_else(none)?;
    let formats = surface.get_capabilities(gpu.adapter()).formats;
    let format = [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm]
        .into_iter()
        .find(|format| formats.contains(format))
        .unwrap_or(default.format);
    Ok(SurfaceConfiguration { format, present_mode: wgpu::PresentMode::AutoVsync, ..default })
}
