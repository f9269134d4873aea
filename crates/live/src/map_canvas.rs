//! What a map shows, and what it has on the graphics card for that: tiles, and one picture or
//! several.

use std::{ops::Range, rc::Rc};

use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    FrameView, RoadMethod, RoadOptions,
    camera::Camera,
    gpu::{
        Gpu, GpuError, PassTimer, PassTimes, Picture, ReadBack, ReadBackError, Renderer,
        ResidentTiles, Targets,
    },
    lod::Drawn,
    tiles::{AreaVolumes, LineLayer, TileGeometry, TileLayer},
};

use crate::settings::Compare;

/// What a map shows, in one picture or in several that differ in how roads are drawn. Two equal scenes look the same, as long as their
/// tiles are on the graphics card.
#[derive(Debug, Clone, PartialEq)]
pub struct MapScene {
    /// The camera; its size is that of the pictures.
    pub camera: Camera,
    /// Width and height of what shows the map. Pictures are smaller while the map is drawn
    /// coarsely.
    pub shown_px: [u32; 2],
    /// Colours and widths.
    pub style: Style,
    /// Whether one method is shown, or two are compared.
    pub compare: Compare,
    /// How the roads of each picture are drawn: one picture, or GEO and SV.
    pub roads: Vec<RoadOptions>,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Working metres to a true metre.
    pub point_scale: f64,
    /// All ground lies between these true heights.
    pub height_range_m: [f64; 2],
    /// How large a cell of a tile may look, pixels; may be infinite.
    pub cell_px: f64,
    /// Latitude of the middle of the package.
    pub latitude_deg: f64,
    /// Whether the edges of triangles are drawn.
    pub is_wireframe: bool,
    /// The tiles to draw.
    pub drawn: Vec<Drawn>,
    /// Samples per pixel along each side.
    pub samples_per_side: u32,
    /// What else changes the picture when it changes: lines that a person draws, a divider that is
    /// part of the picture.
    pub revision: u64,
}

impl MapScene {
    /// One of its pictures, with roads drawn like this.
    #[must_use]
    pub fn view(&self, roads: RoadOptions) -> FrameView<'_> {
        FrameView {
            camera: &self.camera,
            style: &self.style,
            roads,
            exaggeration: self.exaggeration,
            point_scale: self.point_scale,
            height_range_m: self.height_range_m,
            wall_m: FrameView::wall_beside_m(self.height_range_m),
            cell_px: self.cell_px,
            latitude_deg: self.latitude_deg,
            is_wireframe: self.is_wireframe,
        }
    }

    /// Whether its pictures have all the pixels of what shows them.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.camera.size_px == self.shown_px
    }
}

/// Numbers of the scene that was drawn last, all pictures together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Triangles of the ground, skirts not counted.
    pub triangles: u64,
    /// Segments of roads.
    pub segments: u64,
}

/// What a map has on the graphics card. When the device is lost, a new canvas takes the place of
/// the old one.
pub struct MapCanvas {
    /// The device.
    pub gpu: Rc<Gpu>,
    renderer: Renderer,
    tiles: ResidentTiles,
    /// One for each method that is shown.
    methods: Vec<MethodPicture>,
    difference: Option<Picture>,
    shown: Option<MapScene>,
    /// Numbers of the scene that was drawn last.
    pub counts: Counts,
}

/// The picture of one method.
struct MethodPicture {
    targets: Targets,
    timer: Option<PassTimer>,
    times: Option<(RoadMethod, PassTimes)>,
    is_timing: bool,
}

impl MapCanvas {
    /// Nothing drawn yet.
    #[must_use]
    pub fn new(gpu: Gpu) -> Self {
        Self {
            renderer: Renderer::new(&gpu),
            gpu: Rc::new(gpu),
            tiles: ResidentTiles::default(),
            methods: Vec::new(),
            difference: None,
            shown: None,
            counts: Counts::default(),
        }
    }

    /// Removes tiles and uploads others.
    pub fn change(&mut self, evict: &[TileId], upload: &[TileGeometry]) {
        self.tiles.change(&self.gpu, evict, upload);
    }

    /// Removes all tiles; what is shown stays.
    pub fn clear(&mut self) {
        self.tiles.clear();
    }

    /// Replaces the lines and areas that a person draws on a tile.
    pub(crate) fn replace_drawn(&mut self, id: TileId, lines: &TileLayer, areas: &AreaVolumes) {
        if let Some(tile) = self.tiles.get_mut(id) {
            tile.replace_lines(&self.gpu, LineLayer::Drawn, lines);
            tile.replace_drawn_areas(&self.gpu, areas);
        }
    }

    /// The most samples on a side of a pixel with which a picture of this size can be drawn, at
    /// least 1.
    #[must_use]
    pub fn most_samples(&self, size_px: [u32; 2]) -> u32 {
        let longest_px = size_px.into_iter().max().unwrap_or(1);
        (self.gpu.max_side_px() / longest_px.max(1)).max(1)
    }

    /// Draws the scene, unless it is what is shown already. Returns whether something was drawn.
    ///
    /// # Errors
    /// When the pictures are beyond what the adapter can draw.
    pub fn draw(&mut self, scene: &MapScene) -> Result<bool, GpuError> {
        if self.shown.as_ref() == Some(scene) {
            return Ok(false);
        }
        self.shown = None;
        self.methods.truncate(scene.roads.len());
        self.counts = Counts::default();
        for (place, roads) in scene.roads.iter().enumerate() {
            self.fit(place, scene)?;
            self.draw_method(place, *roads, scene);
        }
        let before = self.difference.take();
        if let (Compare::Difference, [first, second]) = (scene.compare, &self.methods[..]) {
            let (size_px, samples) = (scene.camera.size_px, scene.samples_per_side);
            let fits = |picture: &Picture| {
                (picture.size_px, picture.samples_per_side) == (size_px, samples)
            };
            let picture = match before.filter(fits) {
                Some(picture) => picture,
                None => Picture::new(&self.gpu, size_px, samples)?,
            };
            let (first, second) = (&first.targets, &second.targets);
            self.renderer.draw_difference(&self.gpu, first, second, &picture)?;
            self.difference = Some(picture);
        }
        self.shown = Some(scene.clone());
        Ok(true)
    }

    /// Makes room for the picture at `place`.
    fn fit(&mut self, place: usize, scene: &MapScene) -> Result<(), GpuError> {
        let (size_px, samples) = (scene.camera.size_px, scene.samples_per_side);
        let fits = |method: &MethodPicture| {
            (method.targets.picture.size_px, method.targets.picture.samples_per_side)
                == (size_px, samples)
        };
        if self.methods.get(place).is_some_and(fits) {
            return Ok(());
        }
        let targets = Targets::new(&self.gpu, size_px, samples)?;
        if let Some(method) = self.methods.get_mut(place) {
            method.targets = targets;
        } else {
            // Pages do not show how long passes take.
            let is_timed = !cfg!(target_arch = "wasm32");
            let timer = is_timed.then(|| PassTimer::new(&self.gpu)).flatten();
            self.methods.push(MethodPicture { targets, timer, times: None, is_timing: false });
        }
        Ok(())
    }

    fn draw_method(&mut self, place: usize, roads: RoadOptions, scene: &MapScene) {
        let Some(method) = self.methods.get_mut(place) else { return };
        let view = scene.view(roads);
        let tiles = self.tiles.draw_list(&scene.drawn);
        for tile in &tiles {
            self.counts.triangles += tile.buffers.triangles;
            self.counts.segments += tile.road_segments(&view);
        }
        // Times of another method do not count for this one.
        method.times = method.times.filter(|(of, _)| *of == roads.method);
        method.is_timing = method.timer.is_some();
        let timer = method.timer.as_mut();
        self.renderer.draw_timed(&self.gpu, &view, &tiles, &method.targets, timer);
    }

    /// What was drawn last; `None` where nothing is shown.
    #[must_use]
    pub fn shown(&self) -> Option<&MapScene> {
        self.shown.as_ref()
    }

    /// What was drawn did not reach the screen: the same scene is drawn again.
    pub fn forget_shown(&mut self) {
        self.shown = None;
    }

    /// The pictures that are shown, each with the columns where it is seen. Of two pictures beside
    /// each other, the second is seen from the share `divider` of the width on.
    #[must_use]
    pub fn parts(&self, divider: f32) -> Vec<(&Picture, Range<u32>)> {
        let Some(scene) = &self.shown else { return Vec::new() };
        let [width, _] = scene.camera.size_px;
        if let Some(picture) = &self.difference {
            return vec![(picture, 0..width)];
        }
        match &self.methods[..] {
            [left, right] => {
                let column = ((divider * width as f32).round() as u32).min(width);
                let [left, right] = [left, right].map(|method| &method.targets.picture);
                vec![(left, 0..column), (right, column..width)]
            }
            all => all.iter().take(1).map(|one| (&one.targets.picture, 0..width)).collect(),
        }
    }

    /// Begins to read what is shown; `None` where nothing is.
    #[must_use]
    pub fn begin_read(&self, divider: f32) -> Option<PixelReading> {
        let parts = self.parts(divider);
        let (first, _) = parts.first()?;
        let size_px = first.size_px;
        let part = |(picture, columns): (&Picture, _)| (picture.begin_read(&self.gpu), columns);
        Some(PixelReading::new(parts.into_iter().map(part).collect(), size_px))
    }

    /// Whether it is not yet known how long the last frame took the graphics card.
    #[must_use]
    pub fn is_timing(&self) -> bool {
        self.methods.iter().any(|method| method.is_timing)
    }

    /// The newest times that the graphics card has finished, picture by picture; never waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn times(&mut self) -> Result<Vec<(RoadMethod, PassTimes)>, ReadBackError> {
        let Some(scene) = &self.shown else { return Ok(Vec::new()) };
        for (method, roads) in self.methods.iter_mut().zip(&scene.roads) {
            if let Some(timer) = &mut method.timer
                && let Some(times) = timer.poll(&self.gpu)?
            {
                method.times = Some((roads.method, times));
                method.is_timing = false;
            }
        }
        Ok(self.methods.iter().filter_map(|method| method.times).collect())
    }
}

/// Pixels on their way back from the graphics card, of one picture or of several beside each other.
pub struct PixelReading {
    parts: Vec<(ReadBack, Range<u32>)>,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
}

impl PixelReading {
    /// The pixels of readings of one size, each in its columns.
    #[must_use]
    pub fn new(parts: Vec<(ReadBack, Range<u32>)>, size_px: [u32; 2]) -> Self {
        Self { parts, size_px }
    }

    /// Whether all pixels are there; never waits.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn has_arrived(&mut self, gpu: &Gpu) -> Result<bool, ReadBackError> {
        let mut have_all = true;
        for (part, _) in &mut self.parts {
            have_all &= part.has_arrived(gpu)?;
        }
        Ok(have_all)
    }

    /// Four bytes a pixel, rows from the top; waits for what is not yet there.
    ///
    /// # Errors
    /// When the device is lost or could not draw.
    pub fn into_pixels(self, gpu: &Gpu) -> Result<Vec<u8>, ReadBackError> {
        let row_bytes = 4 * self.size_px[0].max(1) as usize;
        let mut pixels: Vec<u8> = Vec::new();
        for (part, columns) in self.parts {
            let part = part.into_texels(gpu)?;
            if pixels.is_empty() {
                pixels = part;
                continue;
            }
            let bytes = 4 * columns.start as usize..4 * columns.end as usize;
            let rows = pixels.chunks_exact_mut(row_bytes).zip(part.chunks_exact(row_bytes));
            for (row, from) in rows {
                row[bytes.clone()].copy_from_slice(&from[bytes.clone()]);
            }
        }
        Ok(pixels)
    }
}
