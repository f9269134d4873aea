//! The surface of the window, and the handling of its failures.

use std::sync::Arc;

use corniche_viewer::gpu::Gpu;
use egui::ClippedPrimitive;
use egui_wgpu::ScreenDescriptor;
use wgpu::{
    Backends, CurrentSurfaceTexture, ErrorFilter, Instance, InstanceDescriptor, Surface,
    SurfaceConfiguration, SurfaceTexture, TextureFormat,
};
use winit::{event_loop::ActiveEventLoop, window::Window};

use crate::{WindowError, canvas::Canvas};

/// The surface and its painted size.
pub(crate) struct Screen {
    surface: Surface<'static>,
    instance: Instance,
    /// The configuration of the surface. Colours are painted as sRGB already; the surface does not
    /// convert them.
    pub(crate) configuration: SurfaceConfiguration,
    /// The painted width and height; 0 on some systems while the window is minimised. No side is
    /// larger than the device's largest texture. A window across several screens may be larger; the
    /// system then enlarges the image.
    pub(crate) size_px: [u32; 2],
    /// Whether the surface can be used: requesting a texture from an unconfigured surface would end
    /// the program.
    is_configured: bool,
}

/// The result of painting a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Painted {
    /// The frame is shown.
    Shown,
    /// Nothing was painted; an immediate retry is worthwhile.
    Later,
    /// Nothing is painted while the window is hidden; an event reports when that changes.
    Hidden,
}

impl Screen {
    /// Creates the surface of a window and a device that draws on it. OpenGL is used only if there
    /// is nothing better.
    pub(crate) fn new(
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
        let size_px = drawable_px(&gpu, [size.width, size.height]);
        let configuration = configuration(&surface, &gpu)?;
        let mut screen = Self { surface, instance, configuration, size_px, is_configured: false };
        screen.configure(&gpu)?;
        Ok((screen, gpu))
    }

    /// Handles a new size of the window.
    pub(crate) fn resize(&mut self, canvas: &Canvas, size_px: [u32; 2]) {
        self.size_px = drawable_px(canvas.gpu(), size_px);
        // The surface is configured before the next frame, so that of many sizes in a row only the
        // last one costs time.
        self.is_configured = false;
    }

    /// Configures the surface for its size, unless a side is 0 or the device is lost.
    fn configure(&mut self, gpu: &Gpu) -> Result<(), WindowError> {
        self.is_configured = false;
        if self.size_px.contains(&0) {
            return Ok(());
        }
        [self.configuration.width, self.configuration.height] = self.size_px;
        let filters = [ErrorFilter::Validation, ErrorFilter::OutOfMemory, ErrorFilter::Internal];
        let scopes = filters.map(|filter| gpu.device.push_error_scope(filter));
        self.surface.configure(&gpu.device, &self.configuration);
        let ended = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
        // All scopes are ended, even if the first one caught an error.
        if let Some(source) = ended.collect::<Vec<_>>().into_iter().flatten().next() {
            return Err(WindowError::Surface { source: source.into() });
        }
        self.is_configured = !gpu.is_lost();
        Ok(())
    }

    /// Paints the layout, if the surface provides a texture.
    pub(crate) fn paint(
        &mut self,
        canvas: &mut Canvas,
        window: &Arc<Window>,
        (primitives, screen): (&[ClippedPrimitive], &ScreenDescriptor),
    ) -> Result<Painted, WindowError> {
        let texture = match self.acquire(canvas, window)? {
            Ok(texture) => texture,
            Err(none) => return Ok(none),
        };
        let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        canvas.paint(primitives, screen, &view);
        window.pre_present_notify();
        canvas.gpu().queue.present(texture);
        Ok(Painted::Shown)
    }

    /// Gets a texture to paint into, or the reason why there is none now. An outdated or lost
    /// surface is configured or recreated, a few times at most.
    fn acquire(
        &mut self,
        canvas: &Canvas,
        window: &Arc<Window>,
    ) -> Result<Result<SurfaceTexture, Painted>, WindowError> {
        let gpu = canvas.gpu();
        for _ in 0..3 {
            if !self.is_configured {
                self.configure(gpu)?;
            }
            if !self.is_configured {
                // A side is 0 or the device is lost; then everything is recreated before the next
                // frame.
                return Ok(Err(Painted::Later));
            }
            match self.surface.get_current_texture() {
                CurrentSurfaceTexture::Success(texture)
                | CurrentSurfaceTexture::Suboptimal(texture) => {
                    let size = texture.texture.size();
                    if [size.width, size.height] == self.size_px {
                        return Ok(Ok(texture));
                    }
                    self.is_configured = false;
                }
                CurrentSurfaceTexture::Timeout => return Ok(Err(Painted::Later)),
                CurrentSurfaceTexture::Occluded => return Ok(Err(Painted::Hidden)),
                CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Validation => {
                    self.is_configured = false;
                }
                CurrentSurfaceTexture::Lost => {
                    self.is_configured = false;
                    self.surface = new_surface(&self.instance, window)?;
                }
            }
        }
        // The window changes faster than the surface can follow.
        Ok(Err(Painted::Later))
    }

    /// Creates a new surface and a new device in place of the lost ones.
    pub(crate) fn rebuild(&mut self, window: &Arc<Window>) -> Result<Gpu, WindowError> {
        self.is_configured = false;
        self.surface = new_surface(&self.instance, window)?;
        let gpu = Gpu::for_window(&self.instance, &self.surface)?;
        self.configuration = configuration(&self.surface, &gpu)?;
        self.size_px = drawable_px(&gpu, self.size_px);
        self.configure(&gpu)?;
        Ok(gpu)
    }
}

/// The size, with no side larger than the device can paint.
fn drawable_px(gpu: &Gpu, size_px: [u32; 2]) -> [u32; 2] {
    size_px.map(|side| side.min(gpu.max_side_px()))
}

fn new_surface(instance: &Instance, window: &Arc<Window>) -> Result<Surface<'static>, WindowError> {
    instance
        .create_surface(Arc::clone(window))
        .map_err(|source| WindowError::Surface { source: source.into() })
}

fn configuration(surface: &Surface<'_>, gpu: &Gpu) -> Result<SurfaceConfiguration, WindowError> {
    let none = || WindowError::NoFormat { adapter: gpu.adapter_name.clone() };
    let default = surface.get_default_config(&gpu.adapter, 1, 1).ok_or_else(none)?;
    let formats = surface.get_capabilities(&gpu.adapter).formats;
    let format = [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm]
        .into_iter()
        .find(|format| formats.contains(format))
        .unwrap_or(default.format);
    Ok(SurfaceConfiguration { format, present_mode: wgpu::PresentMode::AutoVsync, ..default })
}
