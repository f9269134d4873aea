//! What a map has on the graphics card: the canvas, tiles and pictures.

use std::rc::Rc;

use corniche_geom::TileId;
use corniche_live::MapScene;
use corniche_viewer::{
    RoadOptions,
    gpu::{Gpu, Picture, ReadBack, Renderer, ResidentTiles, Targets},
    tiles::TileGeometry,
};
use web_sys::HtmlCanvasElement;

use crate::{problem::Problem, settings::Compare};

/// What the page shows of the map. Two equal scenes look the same, as long as their tiles are on the graphics card.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    pub(crate) map: MapScene,
    pub(crate) compare: Compare,
    pub(crate) divider: f32,
}

/// Numbers of the scene that was drawn last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Counts {
    pub(crate) triangles: u64,
    pub(crate) segments: u64,
}

/// The canvas of a page and what is drawn on it.
pub(crate) struct PageCanvas {
    gpu: Rc<Gpu>,
    surface: wgpu::Surface<'static>,
    canvas: HtmlCanvasElement,
    renderer: Renderer,
    tiles: ResidentTiles,
    targets: Vec<Targets>,
    difference: Option<Picture>,
    shown: Option<Scene>,
    configured_px: Option<[u32; 2]>,
    counts: Counts,
}

impl PageCanvas {
    /// A device for a canvas.
    ///
    /// # Errors
    /// When the browser has no WebGPU, or no adapter that can draw there.
    pub(crate) async fn new(canvas: HtmlCanvasElement) -> Result<Self, Problem> {
        let global = js_sys::global();
        let has_webgpu = js_sys::Reflect::get(&global, &"navigator".into())
            .and_then(|navigator| js_sys::Reflect::get(&navigator, &"gpu".into()))
            .is_ok_and(|gpu| !gpu.is_undefined() && !gpu.is_null());
        if !has_webgpu {
            return Err(Problem::new(
                "no-webgpu",
                "This browser has no WebGPU, or the page is not served by HTTPS.",
                "Use a current Chrome, Edge, Firefox or Safari, and an address that begins with https:// or http://localhost.",
            ));
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::BROWSER_WEBGPU,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let surface = instance
            .create_surface(wgpu::SurfaceTarget::Canvas(canvas.clone()))
            .map_err(|error| {
                Problem::new(
                    "no-webgpu",
                    format!("The canvas gives no WebGPU context: {error}"),
                    "Reload the page.",
                )
            })?;
        let gpu = Gpu::request(&instance, Some(&surface))
            .await
            .map_err(|error| Problem::of_gpu(&error))?;
        let renderer = Renderer::new(&gpu);
        Ok(Self {
            gpu: Rc::new(gpu),
            surface,
            canvas,
            renderer,
            tiles: ResidentTiles::default(),
            targets: Vec::new(),
            difference: None,
            shown: None,
            configured_px: None,
            counts: Counts::default(),
        })
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Rc<Gpu> {
        &self.gpu
    }

    /// Numbers of the scene that was drawn last.
    pub(crate) fn counts(&self) -> Counts {
        self.counts
    }

    /// Removes tiles and uploads others.
    pub(crate) fn change(&mut self, evict: &[TileId], upload: &[TileGeometry]) {
        self.tiles.change(&self.gpu, evict, upload);
    }

    /// Removes all tiles; what is shown stays.
    pub(crate) fn clear(&mut self) {
        self.tiles.clear();
    }

    /// Draws the scene and shows it, unless it is shown already. Returns whether something was drawn.
    ///
    /// # Errors
    /// When the picture is beyond what the adapter can draw, or the canvas cannot be drawn to.
    pub(crate) fn draw(&mut self, scene: &Scene) -> Result<bool, Problem> {
        if self.shown.as_ref() == Some(scene) {
            return Ok(false);
        }
        let told = |error: corniche_viewer::gpu::GpuError| Problem::of_gpu(&error);
        self.shown = None;
        self.targets.truncate(scene.map.roads.len());
        self.counts = Counts::default();
        for (place, roads) in scene.map.roads.iter().enumerate() {
            let size_px = scene.map.camera.size_px();
            let fits = |targets: &Targets| {
                (targets.size_px(), targets.samples_per_side())
                    == (size_px, scene.map.samples_per_side)
            };
            if !self.targets.get(place).is_some_and(fits) {
                let targets =
                    Targets::new(&self.gpu, size_px, scene.map.samples_per_side).map_err(told)?;
                self.targets.truncate(place);
                self.targets.push(targets);
            }
            self.draw_one(place, *roads, scene);
        }
        if scene.compare == Compare::Difference
            && let [first, second] = &self.targets[..]
        {
            let (size_px, samples) = (scene.map.camera.size_px(), scene.map.samples_per_side);
            let fits = |picture: &Picture| {
                (picture.size_px(), picture.samples_per_side()) == (size_px, samples)
            };
            let picture = match self.difference.take().filter(fits) {
                Some(picture) => picture,
                None => Picture::new(&self.gpu, size_px, samples).map_err(told)?,
            };
            self.renderer.draw_difference(&self.gpu, first, second, &picture).map_err(told)?;
            self.difference = Some(picture);
        } else {
            self.difference = None;
        }
        self.shown = Some(scene.clone());
        self.show(scene)?;
        Ok(true)
    }

    fn draw_one(&mut self, place: usize, roads: RoadOptions, scene: &Scene) {
        let view = scene.map.view(roads);
        let tiles = self.tiles.draw_list(&scene.map.drawn);
        for tile in &tiles {
            self.counts.triangles += tile.buffers.triangles();
            self.counts.segments += tile.road_segments(&view);
        }
        self.renderer.draw(&self.gpu, &view, &tiles, &self.targets[place]);
    }

    /// The pictures that the canvas shows: each with the columns where it is seen.
    fn parts(&self) -> Vec<(&Picture, std::ops::Range<u32>)> {
        let Some(scene) = &self.shown else { return Vec::new() };
        let [width, _] = scene.map.camera.size_px();
        if let Some(picture) = &self.difference {
            return vec![(picture, 0..width)];
        }
        match &self.targets[..] {
            [left, right] => {
                let column = ((scene.divider * width as f32).round() as u32).min(width);
                vec![(left.picture(), 0..column), (right.picture(), column..width)]
            }
            all => all.iter().take(1).map(|targets| (targets.picture(), 0..width)).collect(),
        }
    }

    /// Copies the pictures to the canvas. The canvas has the format of the pictures, so no pass is needed.
    fn show(&mut self, scene: &Scene) -> Result<(), Problem> {
        let size_px = scene.map.camera.size_px();
        if self.configured_px != Some(size_px) {
            let [width, height] = size_px;
            self.canvas.set_width(width);
            self.canvas.set_height(height);
            let usual = self.surface.get_default_config(self.gpu.adapter(), width, height);
            let usual = usual.ok_or_else(|| {
                Problem::new("limits", "The canvas cannot be drawn to.", "Try another browser.")
            })?;
            let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::RENDER_ATTACHMENT;
            let format = wgpu::TextureFormat::Rgba8Unorm;
            self.surface.configure(
                self.gpu.device(),
                &wgpu::SurfaceConfiguration { usage, format, ..usual },
            );
            self.configured_px = Some(size_px);
        }
        let (wgpu::CurrentSurfaceTexture::Success(texture)
        | wgpu::CurrentSurfaceTexture::Suboptimal(texture)) = self.surface.get_current_texture()
        else {
            // The next frame tries again.
            self.shown = None;
            return Ok(());
        };
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("canvas") };
        let mut encoder = self.gpu.device().create_command_encoder(&descriptor);
        for (picture, columns) in self.parts() {
            let origin = wgpu::Origin3d { x: columns.start, y: 0, z: 0 };
            let extent = wgpu::Extent3d {
                width: columns.end - columns.start,
                height: size_px[1],
                depth_or_array_layers: 1,
            };
            if extent.width > 0 {
                encoder.copy_texture_to_texture(
                    wgpu::TexelCopyTextureInfo {
                        origin,
                        ..picture.view().texture().as_image_copy()
                    },
                    wgpu::TexelCopyTextureInfo { origin, ..texture.texture.as_image_copy() },
                    extent,
                );
            }
        }
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.queue().present(texture);
        Ok(())
    }

    /// Begins to read what is shown.
    pub(crate) fn begin_read(&self) -> Vec<(ReadBack, std::ops::Range<u32>)> {
        self.parts()
            .into_iter()
            .map(|(picture, columns)| (picture.begin_read(&self.gpu), columns))
            .collect()
    }

    /// Width of what is shown, pixels.
    pub(crate) fn shown_width_px(&self) -> u32 {
        self.shown.as_ref().map_or(0, |scene| scene.map.camera.size_px()[0])
    }
}
