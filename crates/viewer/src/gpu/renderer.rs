//! The renderer draws tiles into targets, pass by pass, and holds nothing of any frame.

#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod read_seen;

use std::sync::OnceLock;

use wgpu::{CommandEncoder, LoadOp};

use super::{
    Gpu, GpuError,
    area_buffers::AreaBuffers,
    drawables::{
        areas::{AreaTile, StencilAreas},
        average::Average,
        composite::Composite,
        decks::Decks,
        difference::Difference,
        label_blocks::LabelBlocks,
        label_colors::LabelColors,
        level_connectors::LevelConnectors,
        line_layers,
        terrain::Terrain,
    },
    passes::{begin, begin_with_stencil},
    picture::Picture,
    pipeline::ENTRIES,
    road_instances::{RoadBuffers, RoadInstance, RoadPipeline},
    shared_bindings::{SharedBindings, SharedLayouts},
    target_texture::TargetTexture,
    targets::{LabelTargets, Targets},
    tile_buffers::{DrawTile, TileBuffers},
    timings::PassTimer,
};
use crate::{
    frame_view::FrameView,
    layer_view::view_of_lines,
    options::{ClassSet, RoadMethod},
    scene::BorderTile,
    tiles::{LineLayer, RoadSegment, RoadVolume},
};

/// Knows how to draw tiles; holds nothing of any frame. What not every picture needs is made when a picture first needs it.
pub struct Renderer {
    layouts: SharedLayouts,
    terrain: Terrain,
    areas: OnceLock<StencilAreas>,
    geo_roads: OnceLock<RoadPipeline>,
    sv_roads: OnceLock<RoadPipeline>,
    decks: OnceLock<Decks>,
    blocks: LabelBlocks,
    composite: Composite,
    line_colors: OnceLock<LabelColors>,
    average: Average,
    difference: OnceLock<Difference>,
}

impl Renderer {
    /// Makes the pipelines that every picture needs.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        let layouts = SharedLayouts::new(device);
        Self {
            terrain: Terrain::new(device, &layouts),
            areas: OnceLock::new(),
            geo_roads: OnceLock::new(),
            sv_roads: OnceLock::new(),
            decks: OnceLock::new(),
            blocks: LabelBlocks::new(device, &layouts),
            composite: Composite::new(device, &layouts),
            line_colors: OnceLock::new(),
            average: Average::new(device),
            difference: OnceLock::new(),
            layouts,
        }
    }

    /// Draws terrain, areas, roads and composite into `targets`.
    pub fn draw(&self, gpu: &Gpu, view: &FrameView<'_>, tiles: &[DrawTile<'_>], targets: &Targets) {
        self.draw_timed(gpu, view, tiles, targets, None);
    }

    /// Does the same as [`Renderer::draw`]; `timer` notes how long each pass takes.
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
        mut timer: Option<&mut PassTimer>,
    ) {
        let shared = &self.shared(gpu, view, tiles, targets);
        let passes = FramePasses { renderer: self, gpu, shared, view, targets };
        let method = view.roads.method;
        let on_ground = LevelConnectors::on_ground;
        let roads = DrawnRoads::new(gpu, tiles, view, |tile| tile.roads(method), on_ground);
        let areas = areas_of(tiles, view, |tile| &tile.areas);
        let drawn_style = view.style.with_drawn_areas();
        let drawn_view = &FrameView { style: &drawn_style, ..*view };
        let drawn_areas = areas_of(tiles, drawn_view, |tile| &tile.drawn_areas);
        let of_decks = LevelConnectors::of_decks;
        let decks = DrawnRoads::new(gpu, tiles, view, |tile| tile.decks(method), of_decks);
        if let Some(timer) = &mut timer {
            timer.begin([!areas.is_empty() || !drawn_areas.is_empty(), !decks.is_empty()]);
        }
        let mut mark = |encoder: &mut CommandEncoder, number| {
            if let Some(timer) = &mut timer {
                timer.mark(encoder, number);
            }
        };
        gpu.submit("frame", |encoder| {
            mark(encoder, 0);
            passes.terrain(encoder, tiles);
            mark(encoder, 1);
            passes.areas(encoder, &areas, &targets.ground);
            let drawn = FramePasses { view: drawn_view, ..passes };
            drawn.areas(encoder, &drawn_areas, &targets.ground);
            mark(encoder, 2);
            passes.labels(encoder, &roads, &targets.roads);
            mark(encoder, 3);
            passes.decks(encoder, &decks);
            mark(encoder, 4);
            passes.composite(encoder, &decks);
            for layer in LineLayer::ALL {
                passes.lines(encoder, tiles, layer);
            }
            self.average.draw(gpu, encoder, &targets.picture);
            mark(encoder, 5);
        });
    }

    /// Shows in `into` where the roads of two drawings differ, over the first one's picture in pale grey. Both were
    /// drawn with the same camera; all three have the same size and samples.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn draw_difference(
        &self,
        gpu: &Gpu,
        first: &Targets,
        second: &Targets,
        into: &Picture,
    ) -> Result<(), GpuError> {
        let sizes_px = [&first.picture, &second.picture, into].map(Picture::sampled_px);
        let is_same = sizes_px.iter().all(|size_px| *size_px == sizes_px[0])
            && first.picture.samples_per_side == into.samples_per_side;
        if !is_same {
            return Err(GpuError::SizesDiffer { sizes_px });
        }
        let difference = self.difference.get_or_init(|| Difference::new(&gpu.device));
        gpu.submit("difference", |encoder| {
            difference.draw(gpu, encoder, first, second, into);
            self.average.draw(gpu, encoder, into);
        });
        Ok(())
    }

    fn shared(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
    ) -> SharedBindings {
        let blocks: Vec<_> =
            tiles.iter().zip(1..).map(|(tile, number)| tile.rows(view, number)).collect();
        SharedBindings::new(gpu, &self.layouts, view, &blocks, targets)
    }

    fn geo_roads(&self, gpu: &Gpu) -> &RoadPipeline {
        self.geo_roads.get_or_init(|| self.roads_on_ground::<RoadSegment>(gpu))
    }

    /// Connectors are drawn as shadow volumes whatever the method.
    fn sv_roads(&self, gpu: &Gpu) -> &RoadPipeline {
        self.sv_roads.get_or_init(|| self.roads_on_ground::<RoadVolume>(gpu))
    }

    fn roads_on_ground<T: RoadInstance>(&self, gpu: &Gpu) -> RoadPipeline {
        let layouts = &self.layouts;
        RoadPipeline::new::<T>(&gpu.device, layouts, &layouts.ground, ENTRIES, None)
    }

    fn decks(&self, gpu: &Gpu) -> &Decks {
        self.decks.get_or_init(|| Decks::new(&gpu.device, &self.layouts))
    }
}

/// What the passes of a frame draw with and into.
#[derive(Clone, Copy)]
struct FramePasses<'a> {
    renderer: &'a Renderer,
    gpu: &'a Gpu,
    shared: &'a SharedBindings,
    view: &'a FrameView<'a>,
    targets: &'a Targets,
}

impl FramePasses<'_> {
    /// Colour, depth and owner of the ground.
    fn terrain(self, encoder: &mut CommandEncoder, tiles: &[DrawTile<'_>]) {
        let Self { renderer, gpu, shared, view, targets } = self;
        let Targets { ground, depth, owners, .. } = targets;
        let colors = [&ground.view, &owners.view];
        let mut pass = begin(encoder, "terrain", &colors, Some(&depth.view), LoadOp::Clear(()));
        let grounds: Vec<_> = tiles
            .iter()
            .enumerate()
            .filter_map(|(index, tile)| {
                Some((index, tile.buffers.ground.as_ref()?, &tile.buffers.textures))
            })
            .collect();
        renderer.terrain.draw(gpu, &mut pass, shared, &grounds, view);
    }

    /// Areas, over colours such as those of the ground. Without areas there is no such pass.
    fn areas(self, encoder: &mut CommandEncoder, areas: &[AreaTile<'_>], into: &TargetTexture) {
        let Self { renderer, gpu, shared, view, targets } = self;
        if areas.is_empty() {
            return;
        }
        let stencil = &targets.stencil(gpu).view;
        let mut pass = begin_with_stencil(encoder, "areas", &into.view, stencil);
        let new = || StencilAreas::new(&gpu.device, &renderer.layouts);
        renderer.areas.get_or_init(new).draw(gpu, &mut pass, shared, areas, view);
    }

    /// Labels of roads, or of lines of a layer: of each tile those of the classes that are shown there.
    fn labels(self, encoder: &mut CommandEncoder, roads: &DrawnRoads<'_>, targets: &LabelTargets) {
        let Self { renderer, gpu, shared, view, .. } = self;
        // The pass clears the labels even when it draws nothing.
        let mut pass = begin(encoder, "labels", &[&targets.labels.view], None, LoadOp::Clear(()));
        let pipeline = match view.roads.method {
            RoadMethod::Geometry => renderer.geo_roads(gpu),
            RoadMethod::ShadowVolumes => renderer.sv_roads(gpu),
            RoadMethod::None => return,
        };
        pipeline.draw(&mut pass, shared, &shared.ground, &roads.of_tiles);
        if !roads.connectors.is_empty() {
            roads.connectors.draw(&mut pass, shared, &shared.ground, renderer.sv_roads(gpu));
        }
    }

    /// A layer of lines, over the samples of the picture. Where no tile has such lines, or the style draws none, there is no such pass.
    fn lines(self, encoder: &mut CommandEncoder, tiles: &[DrawTile<'_>], layer: LineLayer) {
        let Self { renderer, gpu, shared, targets, .. } = self;
        let style = layer.style_of(self.view.style);
        let view = &view_of_lines(self.view, &style);
        let lines = DrawnRoads::of_layer(gpu, tiles, view, layer);
        if lines.is_empty() {
            return;
        }
        let shared = &shared.with_view(gpu, &renderer.layouts, view, targets);
        let labels = targets.lines(gpu);
        FramePasses { shared, view, ..self }.labels(encoder, &lines, labels);
        renderer.blocks.find(gpu, encoder, shared, labels);
        let into = [targets.picture.drawn()];
        let mut pass = begin(encoder, "lines", &into, None, LoadOp::Load);
        let colors = renderer
            .line_colors
            .get_or_init(|| line_layers::line_colors(&gpu.device, &renderer.layouts));
        let rows = line_layers::rows(view, layer);
        colors.bind(gpu, &mut pass, shared, &rows, (targets, labels), &[&targets.roads.labels]);
        colors.draw(&mut pass, targets);
    }

    /// The samples of the picture. What is drawn over the map, such as labels, is drawn after the composite: in this pass, or
    /// in one with `LoadOp::Load` if it needs a depth test.
    fn composite(self, encoder: &mut CommandEncoder, decks: &DrawnRoads<'_>) {
        let Self { renderer, gpu, shared, view, targets } = self;
        if view.roads.method != RoadMethod::None {
            renderer.blocks.find(gpu, encoder, shared, &targets.roads);
        }
        if !decks.is_empty() {
            renderer.blocks.find(gpu, encoder, shared, &targets.decks(gpu).labels);
        }
        let into = [targets.picture.drawn()];
        let mut pass = begin(encoder, "composite", &into, None, LoadOp::Clear(()));
        renderer.composite.draw(gpu, &mut pass, shared, view, targets);
        if !decks.is_empty() {
            let seen = (targets, targets.decks(gpu));
            renderer.decks(gpu).draw_colors(gpu, &mut pass, shared, view, seen);
        }
    }

    /// Depths and labels of decks of bridges. Without decks there are no such passes.
    fn decks(self, encoder: &mut CommandEncoder, decks: &DrawnRoads<'_>) {
        let Self { renderer, gpu, shared, targets, .. } = self;
        if !decks.is_empty() {
            let drawn = (&decks.of_tiles[..], &decks.connectors);
            let into = (targets, targets.decks(gpu));
            renderer.decks(gpu).draw(gpu, encoder, shared, drawn, into);
        }
    }
}

/// The roads of all tiles of a frame, their decks of bridges, or their lines of one layer.
struct DrawnRoads<'a> {
    /// The roads of tiles, each with its index in the list of tiles of the frame and the classes that are shown there.
    of_tiles: Vec<(usize, &'a RoadBuffers, ClassSet)>,
    connectors: LevelConnectors,
}

impl<'a> DrawnRoads<'a> {
    fn new(
        gpu: &Gpu,
        tiles: &[DrawTile<'a>],
        view: &FrameView<'_>,
        of: impl Fn(&'a TileBuffers) -> Option<&'a RoadBuffers>,
        connect: impl Fn(&Gpu, &[BorderTile<'_>], &[ClassSet]) -> LevelConnectors,
    ) -> Self {
        let roads: Vec<_> = tiles.iter().map(|tile| of(tile.buffers)).collect();
        let shown: Vec<_> = tiles.iter().map(|tile| tile.shown_classes(view)).collect();
        let borders: Vec<_> =
            tiles.iter().zip(&roads).map(|(tile, roads)| tile.border(*roads)).collect();
        let connectors = connect(gpu, &borders, &shown);
        let of_tiles = roads.into_iter().zip(shown).enumerate();
        let of_tiles = of_tiles.filter_map(|(index, (roads, shown))| Some((index, roads?, shown)));
        Self { of_tiles: of_tiles.collect(), connectors }
    }

    /// The lines of a layer; `view` is the layer's.
    fn of_layer(gpu: &Gpu, tiles: &[DrawTile<'a>], view: &FrameView<'_>, layer: LineLayer) -> Self {
        let of = |tile| TileBuffers::lines(tile, layer, view.roads.method);
        Self::new(gpu, tiles, view, of, LevelConnectors::on_ground)
    }

    /// Whether nothing of them is shown.
    fn is_empty(&self) -> bool {
        self.of_tiles.iter().all(|(_, roads, shown)| roads.runs(*shown).is_empty())
    }
}

/// The tiles that have areas of a class that is drawn, among those that `of` finds on a tile.
fn areas_of<'a>(
    tiles: &[DrawTile<'a>],
    view: &FrameView<'_>,
    of: impl Fn(&'a TileBuffers) -> &'a Option<AreaBuffers>,
) -> Vec<AreaTile<'a>> {
    let has_drawn = |(_, areas, _): &AreaTile<'_>| {
        areas.classes.iter().any(|of| view.style.area(of.class).is_drawn())
    };
    let counted = |(index, tile): (usize, &DrawTile<'a>)| {
        Some(tile.counted(index, of(tile.buffers).as_ref()?, view))
    };
    tiles.iter().enumerate().filter_map(counted).filter(has_drawn).collect()
}
