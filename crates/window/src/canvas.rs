//! What the window has on the graphics card, apart from the surface: tiles, pictures of the map, textures of the panel. When
//! the device is lost, a new canvas takes the place of the old one.

mod scene;
mod snapshot;

use corniche_geom::TileId;
use corniche_viewer::{
    RoadMethod, RoadOptions,
    gpu::{
        Gpu, GpuError, PassTimer, PassTimes, Picture, ReadBackError, Renderer, ResidentTiles,
        Targets,
    },
    tiles::{AreaVolumes, LineLayer, TileGeometry, TileLayer},
};
use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_wgpu::ScreenDescriptor;

pub(crate) use self::{
    scene::{Counts, Drew, Scene},
    snapshot::Snapshot,
};
use crate::{map_pictures::Pictures, settings::Compare};

/// What the window has on the graphics card.
pub(crate) struct Canvas {
    gpu: Gpu,
    ui: egui_wgpu::Renderer,
    format: wgpu::TextureFormat,
    renderer: Renderer,
    tiles: ResidentTiles,
    /// One for each method that is shown.
    maps: Vec<Map>,
    difference: Option<(TextureId, Picture)>,
    shown: Option<(Scene, Pictures)>,
    counts: Counts,
}

/// One method's picture.
struct Map {
    texture: TextureId,
    targets: Targets,
    timer: Option<PassTimer>,
    times: Option<(RoadMethod, PassTimes)>,
    is_timing: bool,
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
            renderer: Renderer::new(&gpu),
            format,
            gpu,
            tiles: ResidentTiles::default(),
            maps: Vec::new(),
            difference: None,
            shown: None,
            counts: Counts::default(),
        }
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Removes tiles and uploads others.
    pub(crate) fn change(&mut self, evict: &[TileId], upload: &[TileGeometry]) {
        self.tiles.change(&self.gpu, evict, upload);
    }

    /// Replaces the lines and areas that a person draws on a tile.
    pub(crate) fn replace_drawn(&mut self, id: TileId, lines: &TileLayer, areas: &AreaVolumes) {
        if let Some(tile) = self.tiles.get_mut(id) {
            tile.replace_lines(&self.gpu, LineLayer::Drawn, lines);
            tile.replace_drawn_areas(&self.gpu, areas);
        }
    }

    /// Draws the scene, unless it is what is shown already.
    ///
    /// # Errors
    /// When the pictures are beyond what the adapter can draw.
    pub(crate) fn draw(&mut self, scene: &Scene) -> Result<Drew, GpuError> {
        if let Some((shown, pictures)) = &self.shown
            && shown == scene
        {
            return Ok(Drew { pictures: *pictures, is_new: false });
        }
        self.shown = None;
        self.maps.truncate(scene.map.roads.len());
        self.counts = Counts::default();
        for (place, roads) in scene.map.roads.iter().enumerate() {
            self.fit_map(place, scene)?;
            self.draw_map(place, *roads, scene);
        }
        let pictures = match (scene.compare, &self.maps[..]) {
            (Compare::Split, [first, second]) => Pictures::Two([first.texture, second.texture]),
            (Compare::Difference, [_, _]) => Pictures::One(self.draw_difference(scene)?),
            (_, maps) => {
                Pictures::One(maps.first().map_or(TextureId::default(), |map| map.texture))
            }
        };
        self.shown = Some((scene.clone(), pictures));
        Ok(Drew { pictures, is_new: true })
    }

    /// Makes room for the picture at `place`.
    fn fit_map(&mut self, place: usize, scene: &Scene) -> Result<(), GpuError> {
        let (size_px, samples) = (scene.map.camera.size_px(), scene.map.samples_per_side);
        let fits = |map: &Map| {
            (map.targets.size_px(), map.targets.samples_per_side()) == (size_px, samples)
        };
        if self.maps.get(place).is_some_and(fits) {
            return Ok(());
        }
        let targets = Targets::new(&self.gpu, size_px, samples)?;
        let filter = scene.filter();
        let (device, view) = (self.gpu.device(), targets.picture().view());
        if let Some(map) = self.maps.get_mut(place) {
            self.ui.update_egui_texture_from_wgpu_texture(device, view, filter, map.texture);
            map.targets = targets;
        } else {
            let texture = self.ui.register_native_texture(device, view, filter);
            let timer = PassTimer::new(&self.gpu);
            self.maps.push(Map { texture, targets, timer, times: None, is_timing: false });
        }
        Ok(())
    }

    fn draw_map(&mut self, place: usize, roads: RoadOptions, scene: &Scene) {
        let Some(map) = self.maps.get_mut(place) else { return };
        let view = scene.map.view(roads);
        let tiles = self.tiles.draw_list(&scene.map.drawn);
        for tile in &tiles {
            self.counts.triangles += tile.buffers.triangles();
            self.counts.segments += tile.road_segments(&view);
        }
        // Times of another method do not count for this one.
        map.times = map.times.filter(|(method, _)| *method == roads.method);
        map.is_timing = map.timer.is_some();
        self.renderer.draw_timed(&self.gpu, &view, &tiles, &map.targets, map.timer.as_mut());
    }

    fn draw_difference(&mut self, scene: &Scene) -> Result<TextureId, GpuError> {
        let (size_px, samples) = (scene.map.camera.size_px(), scene.map.samples_per_side);
        let [first, second] = &self.maps[..] else { return Ok(TextureId::default()) };
        let fits = |picture: &Picture| {
            (picture.size_px(), picture.samples_per_side()) == (size_px, samples)
        };
        let (texture, picture) = match self.difference.take() {
            Some((texture, picture)) if fits(&picture) => (texture, picture),
            other => {
                let picture = Picture::new(&self.gpu, size_px, samples)?;
                let (device, view) = (self.gpu.device(), picture.view());
                let filter = scene.filter();
                let texture = match other {
                    Some((texture, _)) => {
                        self.ui
                            .update_egui_texture_from_wgpu_texture(device, view, filter, texture);
                        texture
                    }
                    None => self.ui.register_native_texture(device, view, filter),
                };
                (texture, picture)
            }
        };
        let drawn =
            self.renderer.draw_difference(&self.gpu, &first.targets, &second.targets, &picture);
        self.difference = Some((texture, picture));
        drawn.map(|()| texture)
    }

    /// Whether the pictures shown have all the window's pixels.
    pub(crate) fn is_full(&self) -> bool {
        self.shown.as_ref().is_some_and(|(scene, _)| scene.map.camera.size_px() == scene.window_px)
    }

    /// Whether it is not yet known how long the last frame took the graphics card.
    pub(crate) fn is_timing(&self) -> bool {
        self.maps.iter().any(|map| map.is_timing)
    }

    /// Numbers of the scene that was drawn last.
    pub(crate) fn counts(&self) -> Counts {
        self.counts
    }

    /// The newest times that the graphics card has finished, picture by picture; never waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub(crate) fn times(&mut self) -> Result<Vec<(RoadMethod, PassTimes)>, ReadBackError> {
        let Some((scene, _)) = &self.shown else { return Ok(Vec::new()) };
        for (map, roads) in self.maps.iter_mut().zip(&scene.map.roads) {
            if let Some(timer) = &mut map.timer
                && let Some(times) = timer.poll(&self.gpu)?
            {
                map.times = Some((roads.method, times));
                map.is_timing = false;
            }
        }
        Ok(self.maps.iter().filter_map(|map| map.times).collect())
    }

    /// Begins to read the map that is shown, without panel and overlay; `None` while no map is shown.
    pub(crate) fn snap_map(&self, divider_share: f32) -> Option<Snapshot> {
        let (scene, _) = self.shown.as_ref()?;
        let picture = match (scene.compare, &self.difference) {
            (Compare::Difference, Some((_, picture))) => {
                return Some(Snapshot::of_map(&self.gpu, picture, None, 0));
            }
            _ => self.maps.first()?.targets.picture(),
        };
        let right = self.maps.get(1).map(|map| map.targets.picture());
        let column = (divider_share * picture.size_px()[0] as f32).round() as u32;
        Some(Snapshot::of_map(&self.gpu, picture, right, column))
    }

    /// Uploads what the panel changed of its textures; to be called before what was laid out is painted. Returns the
    /// textures to free after that.
    pub(crate) fn take_textures(&mut self, mut delta: TexturesDelta) -> Vec<TextureId> {
        for (id, changes) in &delta.set {
            for change in changes {
                self.ui.update_texture(self.gpu.device(), self.gpu.queue(), *id, change);
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
        let (device, queue) = (self.gpu.device(), self.gpu.queue());
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
        let texture = snapshot::texture(&self.gpu, self.format, screen.size_in_pixels);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.paint(primitives, screen, &view);
        Snapshot::of_window(&self.gpu, &texture)
    }
}

#[cfg(test)]
#[path = "canvas_tests.rs"]
pub(crate) mod tests;
