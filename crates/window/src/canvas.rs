//! What the window has on the graphics card, apart from the surface: the map, and textures of the
//! panel. When the device is lost, a new canvas takes the place of the old one.

mod snapshot;

use corniche_live::{MapCanvas, MapScene};
use corniche_viewer::gpu::{Gpu, GpuError};
use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_wgpu::ScreenDescriptor;

pub(crate) use self::snapshot::Snapshot;

/// What the window has on the graphics card.
pub(crate) struct Canvas {
    pub(crate) map: MapCanvas,
    ui: egui_wgpu::Renderer,
    format: wgpu::TextureFormat,
    /// The pictures that are shown, as the panel's toolkit knows them.
    pictures: Vec<(wgpu::Texture, TextureId)>,
}

/// The pictures of the map, as large as the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pictures {
    /// One picture.
    One(TextureId),
    /// Two pictures, left and right of the divider.
    Two([TextureId; 2]),
}

/// What came of drawing a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Drew {
    /// The pictures.
    pub(crate) pictures: Pictures,
    /// Whether anything was drawn: not if the scene was the same as before.
    pub(crate) is_new: bool,
}

impl Canvas {
    /// Nothing drawn yet; the panel will be painted into views of this `format`.
    pub(crate) fn new(gpu: Gpu, format: wgpu::TextureFormat) -> Self {
        let options = egui_wgpu::RendererOptions {
            dithering: false,
            ..egui_wgpu::RendererOptions::default()
        };
        Self {
            ui: egui_wgpu::Renderer::new(gpu.device(), format, options),
            format,
            map: MapCanvas::new(gpu),
            pictures: Vec::new(),
        }
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Gpu {
        self.map.gpu()
    }

    /// Draws the scene, unless it is what is shown already.
    ///
    /// # Errors
    /// When the pictures are beyond what the adapter can draw.
    pub(crate) fn draw(&mut self, scene: &MapScene) -> Result<Drew, GpuError> {
        let is_new = self.map.draw(scene)?;
        if is_new {
            // Pixel for pixel, or enlarged where they are smaller than the window.
            let filter =
                if scene.is_full() { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
            let mut before = std::mem::take(&mut self.pictures);
            for (picture, _) in self.map.parts(0.5) {
                let texture = picture.view().texture();
                let known = before.iter().position(|(known, _)| known == texture);
                let device = self.map.gpu().device();
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
        let pictures = match &self.pictures[..] {
            [(_, first), (_, second)] => Pictures::Two([*first, *second]),
            all => Pictures::One(all.first().map_or(TextureId::default(), |(_, id)| *id)),
        };
        Ok(Drew { pictures, is_new })
    }

    /// Whether the pictures shown have all the window's pixels.
    pub(crate) fn is_full(&self) -> bool {
        self.map.shown().is_some_and(MapScene::is_full)
    }

    /// Begins to read the map that is shown, without panel and overlay; `None` while no map is shown.
    pub(crate) fn snap_map(&self, divider_share: f32) -> Option<Snapshot> {
        self.map.begin_read(divider_share).map(Snapshot::of_map)
    }

    /// Uploads what the panel changed of its textures; to be called before what was laid out is painted. Returns the
    /// textures to free after that.
    pub(crate) fn take_textures(&mut self, mut delta: TexturesDelta) -> Vec<TextureId> {
        let gpu = self.map.gpu();
        for (id, changes) in &delta.set {
            for change in changes {
                self.ui.update_texture(gpu.device(), gpu.queue(), *id, change);
            }
        }
        let unused = delta.free.iter().copied().collect();
        delta.clear();
        unused
    }

    /// Frees textures that nothing will use from now on.
    pub(crate) fn free_textures(&mut self, unused: &[TextureId]) {
        for id in unused {
            self.ui.free_texture(id);
        }
    }

    /// Paints the whole window: the map and what lies on it.
    pub(crate) fn paint(
        &mut self,
        primitives: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
        into: &wgpu::TextureView,
    ) {
        let gpu = self.map.gpu();
        let (device, queue) = (gpu.device(), gpu.queue());
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

    /// Paints the whole window into a picture and begins to read it.
    pub(crate) fn snap_window(
        &mut self,
        primitives: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
    ) -> Snapshot {
        let texture = snapshot::texture(self.gpu(), self.format, screen.size_in_pixels);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.paint(primitives, screen, &view);
        Snapshot::of_window(self.gpu(), &texture)
    }
}

#[cfg(test)]
#[path = "canvas_tests.rs"]
pub(crate) mod tests;
