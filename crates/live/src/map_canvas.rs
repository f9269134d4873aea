//! The content of a map and its data on the GPU: tiles, and one image or several.

use std::{ops::Range, rc::Rc};

use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    FrameView, PackageLooks, RoadMethod, RoadOptions,
    camera::Camera,
    gpu::{
        Gpu, GpuError, PassTimer, PassTimes, Picture, ReadBack, ReadBackError, Renderer,
        ResidentTiles, Targets,
    },
    lod::DrawnTile,
    tiles::{AreaVolumes, LineLayer, TileGeometry, TileLayer},
};

use crate::settings::Compare;

/// The content of a map, in one image or in several that differ in the drawing method of roads. Two
/// equal scenes look the same, as long as their tiles are on the GPU.
#[derive(Debug, Clone, PartialEq)]
pub struct MapScene {
    /// The camera; its size is the size of the images.
    pub camera: Camera,
    /// Width and height of the window or page element, in pixels. Images are smaller while the map
    /// is drawn coarsely.
    pub shown_px: [u32; 2],
    /// Colours and widths.
    pub style: Style,
    /// How the package's layers are drawn.
    pub layers: PackageLooks,
    /// Whether one method is shown, or two are compared.
    pub compare: Compare,
    /// The drawing method of the roads of each image: one image, or GEO and SV.
    pub roads: Vec<RoadOptions>,
    /// Factor on heights.
    pub exaggeration: f64,
    /// Working metres per true metre.
    pub point_scale: f64,
    /// The true heights between which all ground lies.
    pub height_range_m: [f64; 2],
    /// The largest apparent size of a tile's cell, in pixels; may be infinite.
    pub cell_px: f64,
    /// The latitude of the middle of the package.
    pub latitude_deg: f64,
    /// Whether the edges of triangles are drawn.
    pub is_wireframe: bool,
    /// The tiles to draw.
    pub drawn: Vec<DrawnTile>,
    /// Samples per pixel along each side.
    pub samples_per_side: u32,
    /// The revision of everything else that changes the image: drawn lines, and a divider that is
    /// part of the image.
    pub revision: u64,
}

impl MapScene {
    /// One image of the scene, with roads drawn like this.
    #[must_use]
    pub fn view(&self, roads: RoadOptions) -> FrameView<'_> {
        FrameView {
            camera: &self.camera,
            style: &self.style,
            layers: &self.layers,
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

    /// Whether the images have the full resolution of the window or page element.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.camera.size_px == self.shown_px
    }

    /// Whether an image has the size and the samples of the scene.
    fn fits(&self, picture: &Picture) -> bool {
        picture.size_px == self.camera.size_px && picture.samples_per_side == self.samples_per_side
    }
}

/// The counts of the scene drawn last, for all images together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SceneCounts {
    /// Triangles of the ground, without skirts.
    pub triangles: u64,
    /// Segments of roads.
    pub segments: u64,
}

/// The data of a map on the GPU. When the device is lost, a new canvas replaces the old one.
pub struct MapCanvas {
    /// The device.
    pub gpu: Rc<Gpu>,
    renderer: Renderer,
    tiles: ResidentTiles,
    /// One image for each method in view.
    methods: Vec<MethodPicture>,
    difference: Option<Picture>,
    shown: Option<MapScene>,
    /// The counts of the scene drawn last.
    pub counts: SceneCounts,
}

/// The image of one method.
struct MethodPicture {
    targets: Targets,
    timer: Option<PassTimer>,
    times: Option<(RoadMethod, PassTimes)>,
    is_timing: bool,
}

impl MapCanvas {
    /// Creates a canvas without tiles and images.
    #[must_use]
    pub fn new(gpu: Gpu) -> Self {
        Self {
            renderer: Renderer::new(&gpu),
            gpu: Rc::new(gpu),
            tiles: ResidentTiles::default(),
            methods: Vec::new(),
            difference: None,
            shown: None,
            counts: SceneCounts::default(),
        }
    }

    /// Removes tiles and uploads others.
    pub fn change(&mut self, evict: &[TileId], upload: &[TileGeometry]) {
        self.tiles.change(&self.gpu, evict, upload);
    }

    /// Removes all tiles; the shown image stays.
    pub fn clear(&mut self) {
        self.tiles.clear();
    }

    /// Replaces the drawn lines and areas on a tile.
    pub(crate) fn replace_drawn(&mut self, id: TileId, lines: &TileLayer, areas: &AreaVolumes) {
        if let Some(tile) = self.tiles.get_mut(id) {
            tile.replace_lines(&self.gpu, LineLayer::Drawn, lines);
            tile.replace_drawn_areas(&self.gpu, areas);
        }
    }

    /// The largest number of samples per side of a pixel with which an image of this size can be
    /// drawn, at least 1.
    #[must_use]
    pub fn most_samples(&self, size_px: [u32; 2]) -> u32 {
        let longest_px = size_px.into_iter().max().unwrap_or(1);
        (self.gpu.max_side_px() / longest_px.max(1)).max(1)
    }

    /// Draws the scene, unless it is already shown. Returns whether something was drawn.
    ///
    /// # Errors
    /// When the images exceed the limits of the adapter.
    pub fn draw(&mut self, scene: &MapScene) -> Result<bool, GpuError> {
        if self.shown.as_ref() == Some(scene) {
            return Ok(false);
        }
        self.shown = None;
        self.methods.truncate(scene.roads.len());
        self.counts = SceneCounts::default();
        for (place, roads) in scene.roads.iter().enumerate() {
            self.fit(place, scene)?;
            self.draw_method(place, *roads, scene);
        }
        let before = self.difference.take();
        if let (Compare::Difference, [first, second]) = (scene.compare, &self.methods[..]) {
            let picture = match before.filter(|picture| scene.fits(picture)) {
                Some(picture) => picture,
                None => Picture::new(&self.gpu, scene.camera.size_px, scene.samples_per_side)?,
            };
            let (first, second) = (&first.targets, &second.targets);
            self.renderer.draw_difference(&self.gpu, first, second, &picture)?;
            self.difference = Some(picture);
        }
        self.shown = Some(scene.clone());
        Ok(true)
    }

    /// Allocates the image at index `place`.
    fn fit(&mut self, place: usize, scene: &MapScene) -> Result<(), GpuError> {
        if self.methods.get(place).is_some_and(|method| scene.fits(&method.targets.picture)) {
            return Ok(());
        }
        let targets = Targets::new(&self.gpu, scene.camera.size_px, scene.samples_per_side)?;
        if let Some(method) = self.methods.get_mut(place) {
            method.targets = targets;
        } else {
            // Pages do not show the times of passes.
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
        // The times of another method do not count for this one.
        method.times = method.times.filter(|(of, _)| *of == roads.method);
        method.is_timing = method.timer.is_some();
        let timer = method.timer.as_mut();
        self.renderer.draw_timed(&self.gpu, &view, &tiles, &method.targets, timer);
    }

    /// The scene drawn last; `None` if nothing is shown.
    #[must_use]
    pub fn shown(&self) -> Option<&MapScene> {
        self.shown.as_ref()
    }

    /// Notes that the last scene did not reach the screen: the same scene is drawn again.
    pub fn forget_shown(&mut self) {
        self.shown = None;
    }

    /// The shown images, each with its range of columns. Of two images side by side, the second
    /// begins at the share `divider` of the width.
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

    /// Starts reading back the shown images; `None` if nothing is shown.
    #[must_use]
    pub fn begin_read(&self, divider: f32) -> Option<PixelReading> {
        let parts = self.parts(divider);
        let (first, _) = parts.first()?;
        let size_px = first.size_px;
        let part = |(picture, columns): (&Picture, _)| (picture.begin_read(&self.gpu), columns);
        Some(PixelReading { parts: parts.into_iter().map(part).collect(), size_px })
    }

    /// Whether the GPU times of the last frame are still pending.
    #[must_use]
    pub fn is_timing(&self) -> bool {
        self.methods.iter().any(|method| method.is_timing)
    }

    /// The newest times that the GPU has finished, image by image; never waits.
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

/// Pixels being read back from the GPU, of one image or of several side by side.
pub struct PixelReading {
    /// Readings of one size, each with its range of columns.
    pub parts: Vec<(ReadBack, Range<u32>)>,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
}

impl PixelReading {
    /// Whether all pixels have arrived; never waits.
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

    /// The pixels: four bytes each, rows from the top. Waits for those that have not arrived yet.
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
