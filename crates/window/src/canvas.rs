//! The window's data on the GPU, apart from the surface: the map, and textures of the panel. When
//! the device is lost, a new canvas replaces the old one.

mod snapshot;

use corniche_live::{MapCanvas, MapScene, PixelReading};
use corniche_viewer::gpu::{Gpu, GpuError, ReadBack};
use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_wgpu::ScreenDescriptor;

pub(crate) use self::snapshot::Snapshot;

/// The window's data on the GPU.
pub(crate) struct Canvas {
    pub(crate) map: MapCanvas,
    ui: egui_wgpu::Renderer,
    format: wgpu::TextureFormat,
    /// The shown images, with their ids in the toolkit.
    pictures: Vec<(wgpu::Texture, TextureId)>,
}

impl Canvas {
    /// Creates an empty canvas; the panel will be painted into views of this `format`.
    pub(crate) fn new(gpu: Gpu, format: wgpu::TextureFormat) -> Self {
        let options = egui_wgpu::RendererOptions {
            dithering: false,
            ..egui_wgpu::RendererOptions::default()
        };
        Self {
            ui: egui_wgpu::Renderer::new(&gpu.device, format, options),
            format,
            map: MapCanvas::new(gpu),
            pictures: Vec::new(),
        }
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.map.gpu
    }

    /// The images of the map, as large as the window: one, or those left and right of the divider.
    pub(crate) fn pictures(&self) -> Vec<TextureId> {
        self.pictures.iter().map(|(_, id)| *id).collect()
    }

    /// Draws the scene, unless it is already shown. Returns whether it was drawn.
    ///
    /// # Errors
    /// When the images exceed the limits of the adapter.
    pub(crate) fn draw(&mut self, scene: &MapScene) -> Result<bool, GpuError> {
        let is_new = self.map.draw(scene)?;
        if is_new {
            // Images are shown pixel by pixel, or enlarged if they are smaller than the window.
            let filter =
                if scene.is_full() { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
            let mut before = std::mem::take(&mut self.pictures);
            for (picture, _) in self.map.parts(0.5) {
                let texture = picture.view().texture();
                let known = before.iter().position(|(known, _)| known == texture);
                let device = &self.map.gpu.device;
                self.pictures.push(if let Some(place) = known {
                    before.swap_remove(place)
                } else {
                    let id = self.ui.register_native_texture(device, picture.view(), filter);
                    (texture.clone(), id)
                });
            }
            for (_, unused) in before {
                self.ui.free_texture(&unused);
            }
        }
        Ok(is_new)
    }

    /// Whether the shown images have the full resolution of the window.
    pub(crate) fn is_full(&self) -> bool {
        self.map.shown().is_some_and(MapScene::is_full)
    }

    /// Starts reading back the map, without panel and overlay; `None` while no map is shown.
    pub(crate) fn snap_map(&self, divider_share: f32) -> Option<Snapshot> {
        self.map.begin_read(divider_share).map(|pixels| Snapshot { pixels, has_blue_first: false })
    }

    /// Uploads the panel's texture changes; call this before painting the layout. Returns the
    /// textures to free after painting.
    pub(crate) fn take_textures(&mut self, mut delta: TexturesDelta) -> Vec<TextureId> {
        let gpu = &self.map.gpu;
        for (id, changes) in &delta.set {
            for change in changes {
                self.ui.update_texture(&gpu.device, &gpu.queue, *id, change);
            }
        }
        let unused = delta.free.iter().copied().collect();
        delta.clear();
        unused
    }

    /// Frees textures that are no longer used.
    pub(crate) fn free_textures(&mut self, unused: &[TextureId]) {
        for id in unused {
            self.ui.free_texture(id);
        }
    }

    /// Paints the whole window: the map and everything on it.
    pub(crate) fn paint(
        &mut self,
        primitives: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
        into: &wgpu::TextureView,
    ) {
        let gpu = &self.map.gpu;
        let (device, queue) = (&gpu.device, &gpu.queue);
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("window") };
        let mut encoder = device.create_command_encoder(&descriptor);
        let mut commands = self.ui.update_buffers(device, queue, &mut encoder, primitives, screen);
        {
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: into,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            self.ui.render(&mut pass.forget_lifetime(), primitives, screen);
        }
        commands.push(encoder.finish());
        queue.submit(commands);
    }

    /// Paints the whole window into an image and starts reading it back.
    pub(crate) fn snap_window(
        &mut self,
        primitives: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Snapshot {
        let (size_px, usage) = (screen.size_in_pixels, wgpu::TextureUsages::RENDER_ATTACHMENT);
        let usage = usage | wgpu::TextureUsages::COPY_SRC;
        let texture = self.gpu().texture("image of the window", self.format, size_px, 1, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.paint(primitives, screen, &view);
        let parts = vec![(ReadBack::begin(self.gpu(), &texture), 0..size_px[0])];
        let has_blue_first = matches!(
            self.format,
            wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb
        );
        Snapshot { pixels: PixelReading { parts, size_px }, has_blue_first }
    }
}

#[cfg(test)]
#[path = "canvas_tests.rs"]
pub(crate) mod tests;
