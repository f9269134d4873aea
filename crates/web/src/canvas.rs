//! The canvas of a page, which the images of a map are copied to.

use corniche_live::{MapCanvas, MapScene};
use corniche_viewer::gpu::Gpu;
use web_sys::HtmlCanvasElement;

use crate::problem::Problem;

/// The canvas of a page and the content drawn on it.
pub(crate) struct PageCanvas {
    pub(crate) map: MapCanvas,
    surface: wgpu::Surface<'static>,
    canvas: HtmlCanvasElement,
    configured_px: Option<[u32; 2]>,
    /// The left edge of the second of two images, as a share of the width.
    pub(crate) divider: f32,
}

impl PageCanvas {
    /// Creates a device for a canvas.
    ///
    /// # Errors
    /// When the browser has no adapter that can draw there. The page has already checked that
    /// WebGPU is available.
    pub(crate) async fn new(canvas: HtmlCanvasElement) -> Result<Self, Problem> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::BROWSER_WEBGPU,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let surface = instance
            .create_surface(wgpu::SurfaceTarget::Canvas(canvas.clone()))
            .map_err(|error| {
                Problem::new(
                    "no-webgpu",
                    format!("The canvas provides no WebGPU context: {error}"),
                    "Reload the page.",
                )
            })?;
        let gpu = Gpu::request(&instance, Some(&surface))
            .await
            .map_err(|error| Problem::of_gpu(&error))?;
        let map = MapCanvas::new(gpu);
        Ok(Self { map, surface, canvas, configured_px: None, divider: 0.5 })
    }

    /// Draws the scene and shows it, unless it is shown already; of two images, the second begins
    /// at the share `divider` of the width. Returns whether something was drawn.
    ///
    /// # Errors
    /// When the image exceeds the limits of the adapter, or the canvas cannot be drawn to.
    pub(crate) fn draw(&mut self, scene: &MapScene, divider: f32) -> Result<bool, Problem> {
        let is_new = self.map.draw(scene).map_err(|error| Problem::of_gpu(&error))?;
        if is_new {
            self.divider = divider;
            self.show(scene.camera.size_px)?;
        }
        Ok(is_new)
    }

    /// Copies the images to the canvas. The canvas has the format of the images, so no pass is
    /// needed.
    fn show(&mut self, size_px: [u32; 2]) -> Result<(), Problem> {
        let gpu = &self.map.gpu;
        if self.configured_px != Some(size_px) {
            let [width, height] = size_px;
            self.canvas.set_width(width);
            self.canvas.set_height(height);
            let usual = self.surface.get_default_config(&gpu.adapter, width, height);
            let usual = usual.ok_or_else(|| {
                Problem::new("limits", "The canvas cannot be drawn to.", "Try another browser.")
            })?;
            let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::RENDER_ATTACHMENT;
            let format = wgpu::TextureFormat::Rgba8Unorm;
            self.surface
                .configure(&gpu.device, &wgpu::SurfaceConfiguration { usage, format, ..usual });
            self.configured_px = Some(size_px);
        }
        let (wgpu::CurrentSurfaceTexture::Success(texture)
        | wgpu::CurrentSurfaceTexture::Suboptimal(texture)) = self.surface.get_current_texture()
        else {
            // The next frame tries again.
            self.map.forget_shown();
            return Ok(());
        };
        let [_, height] = size_px;
        gpu.submit("canvas", |encoder| {
            for (picture, columns) in self.map.parts(self.divider) {
                let origin = wgpu::Origin3d { x: columns.start, y: 0, z: 0 };
                let (from, into) = (picture.view().texture(), &texture.texture);
                let width = columns.end - columns.start;
                if width > 0 {
                    encoder.copy_texture_to_texture(
                        wgpu::TexelCopyTextureInfo { origin, ..from.as_image_copy() },
                        wgpu::TexelCopyTextureInfo { origin, ..into.as_image_copy() },
                        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                    );
                }
            }
        });
        gpu.queue.present(texture);
        Ok(())
    }
}
