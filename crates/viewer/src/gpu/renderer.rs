//! The renderer draws tiles into targets, pass by pass, and holds nothing of any frame.

#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod read_seen;

use std::sync::OnceLock;

use wgpu::{CommandEncoder, LoadOp};

use super::{
    Gpu, GpuError,
    drawables::{
        areas::{AreaTile, StencilAreas},
        average::Average,
        composite::Composite,
        decks::Decks,
        difference::Difference,
        geo_roads,
        label_blocks::LabelBlocks,
        level_connectors::LevelConnectors,
        line_layers::LineColors,
        sv_roads,
        terrain::Terrain,
    },
    passes::{begin, begin_with_stencil},
    picture::Picture,
    road_instances::{RoadBuffers, RoadPipeline},
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
    tiles::LineLayer,
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
    line_colors: OnceLock<LineColors>,
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
        let tile_uniforms = tiles.iter().map(DrawTile::uniforms);
        let shared = SharedBindings::new(gpu, &self.layouts, view, tile_uniforms, targets);
        let roads = LabelledLines::new(gpu, tiles, view, |tile| tile.roads(view.roads.method));
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let areas = areas_of(tiles, view, DrawTile::areas);
        let drawn_style = view.style.with_drawn_areas();
        let drawn_view = FrameView { style: &drawn_style, ..*view };
        let drawn_areas = areas_of(tiles, &drawn_view, DrawTile::drawn_areas);
        let decks = DrawnDecks::new(gpu, tiles, view);
        if let Some(timer) = &mut timer {
            timer.begin([!areas.is_empty() || !drawn_areas.is_empty(), !decks.is_empty()]);
        }
        let mut mark = |encoder: &mut CommandEncoder, number| {
            if let Some(timer) = &mut timer {
                timer.mark(encoder, number);
            }
        };
        mark(&mut encoder, 0);
        self.terrain_pass(gpu, &mut encoder, &shared, tiles, view, targets);
        mark(&mut encoder, 1);
        let ground = (&targets.ground, targets);
        self.areas_pass(gpu, &mut encoder, &shared, &areas, view, ground);
        self.areas_pass(gpu, &mut encoder, &shared, &drawn_areas, &drawn_view, ground);
        mark(&mut encoder, 2);
        self.labels_pass(gpu, &mut encoder, &shared, &roads, view, &targets.roads);
        mark(&mut encoder, 3);
        self.decks_passes(gpu, &mut encoder, &shared, &decks, targets);
        mark(&mut encoder, 4);
        self.composite_pass(gpu, &mut encoder, &shared, view, (targets, &decks));
        for layer in LineLayer::ALL {
            self.lines_pass(gpu, &mut encoder, &shared, (tiles, layer), view, targets);
        }
        self.average.draw(gpu, &mut encoder, targets.picture());
        mark(&mut encoder, 5);
        gpu.queue.submit([encoder.finish()]);
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
        let sizes_px = [first.picture(), second.picture(), into].map(Picture::sampled_px);
        let is_same = sizes_px.iter().all(|size_px| *size_px == sizes_px[0])
            && first.samples_per_side() == into.samples_per_side();
        if !is_same {
            return Err(GpuError::SizesDiffer { sizes_px });
        }
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("difference") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let difference = self.difference.get_or_init(|| Difference::new(&gpu.device));
        difference.draw(gpu, &mut encoder, first, second, into);
        self.average.draw(gpu, &mut encoder, into);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Colour, depth and owner of the ground.
    fn terrain_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        tiles: &[DrawTile<'_>],
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
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
        self.terrain.draw(gpu, &mut pass, shared, &grounds, view);
    }

    /// Areas, over colours such as those of the ground. Without areas there is no such pass.
    fn areas_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        areas: &[AreaTile<'_>],
        view: &FrameView<'_>,
        (into, targets): (&TargetTexture, &Targets),
    ) {
        if areas.is_empty() {
            return;
        }
        let stencil = &targets.stencil(gpu).view;
        let mut pass = begin_with_stencil(encoder, "areas", &into.view, stencil);
        let drawable = self.areas.get_or_init(|| StencilAreas::new(&gpu.device, &self.layouts));
        drawable.draw(gpu, &mut pass, shared, areas, view);
    }

    /// Labels of roads, or of lines of a layer: of each tile those of the classes that are shown there.
    fn labels_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        lines: &LabelledLines<'_>,
        view: &FrameView<'_>,
        targets: &LabelTargets,
    ) {
        // The pass clears the labels even when it draws nothing.
        let mut pass = begin(encoder, "labels", &[&targets.labels.view], None, LoadOp::Clear(()));
        let of_tiles = lines.of_tiles.iter().zip(&lines.shown).enumerate();
        let of_tiles =
            of_tiles.filter_map(|(index, (buffers, classes))| Some((index, (*buffers)?, *classes)));
        match view.roads.method {
            RoadMethod::Geometry => {
                self.geo_roads(gpu).draw(&mut pass, shared, shared.ground(), of_tiles);
            }
            RoadMethod::ShadowVolumes => {
                self.sv_roads(gpu).draw(&mut pass, shared, shared.ground(), of_tiles);
            }
            RoadMethod::None => return,
        }
        if !lines.connectors.is_empty() {
            lines.connectors.draw(&mut pass, shared, shared.ground(), self.sv_roads(gpu));
        }
    }

    fn geo_roads(&self, gpu: &Gpu) -> &RoadPipeline {
        self.geo_roads.get_or_init(|| geo_roads::pipeline(&gpu.device, &self.layouts))
    }

    /// Connectors are drawn as shadow volumes whatever the method.
    fn sv_roads(&self, gpu: &Gpu) -> &RoadPipeline {
        self.sv_roads.get_or_init(|| sv_roads::pipeline(&gpu.device, &self.layouts))
    }

    /// A layer of lines, over the samples of the picture. Where no tile has such lines, or the style draws none, there is no such pass.
    fn lines_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        (tiles, layer): (&[DrawTile<'_>], LineLayer),
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        let style = layer.style_of(view.style);
        let view = view_of_lines(view, &style);
        let lines =
            LabelledLines::new(gpu, tiles, &view, |tile| tile.lines(layer, view.roads.method));
        if lines.is_empty() {
            return;
        }
        let shared = shared.with_view(gpu, &self.layouts, &view, targets);
        let labels = targets.lines(gpu);
        self.labels_pass(gpu, encoder, &shared, &lines, &view, labels);
        self.blocks.find(gpu, encoder, &shared, labels);
        let into = [targets.picture().drawn()];
        let mut pass = begin(encoder, "lines", &into, None, LoadOp::Load);
        let line_colors =
            self.line_colors.get_or_init(|| LineColors::new(&gpu.device, &self.layouts));
        line_colors.draw(gpu, &mut pass, &shared, (&view, layer), targets);
    }

    /// The samples of the picture. What is drawn over the map, such as labels, is drawn after the composite: in this pass, or
    /// in one with `LoadOp::Load` if it needs a depth test.
    fn composite_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        view: &FrameView<'_>,
        (targets, decks): (&Targets, &DrawnDecks<'_>),
    ) {
        if view.roads.method != RoadMethod::None {
            self.blocks.find(gpu, encoder, shared, &targets.roads);
        }
        if !decks.is_empty() {
            self.blocks.find(gpu, encoder, shared, &targets.decks(gpu).labels);
        }
        let into = [targets.picture().drawn()];
        let mut pass = begin(encoder, "composite", &into, None, LoadOp::Clear(()));
        self.composite.draw(gpu, &mut pass, shared, view, targets);
        if !decks.is_empty() {
            let seen = (targets, targets.decks(gpu));
            self.decks(gpu).draw_colors(gpu, &mut pass, shared, view, seen);
        }
    }

    /// Depths and labels of decks of bridges. Without decks there are no such passes.
    fn decks_passes(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        decks: &DrawnDecks<'_>,
        targets: &Targets,
    ) {
        if !decks.is_empty() {
            let tiles = decks.of_tiles.iter().copied();
            let into = (targets, targets.decks(gpu));
            self.decks(gpu).draw(gpu, encoder, shared, &tiles, into, &|pass, drawn, pipeline| {
                decks.connectors.draw(pass, shared, drawn, pipeline);
            });
        }
    }

    fn decks(&self, gpu: &Gpu) -> &Decks {
        self.decks.get_or_init(|| Decks::new(&gpu.device, &self.layouts))
    }
}

/// The decks of bridges of a frame. They are part of the roads, whatever the method.
struct DrawnDecks<'a> {
    /// The decks of tiles, each with its index in the list of tiles of the frame and the classes that are shown there.
    of_tiles: Vec<(usize, &'a RoadBuffers, ClassSet)>,
    connectors: LevelConnectors,
}

impl<'a> DrawnDecks<'a> {
    fn new(gpu: &Gpu, tiles: &'a [DrawTile<'_>], view: &FrameView<'_>) -> Self {
        let tiles = if view.roads.method == RoadMethod::None { &[] } else { tiles };
        let shown: Vec<_> = tiles.iter().map(|tile| tile.shown_classes(view)).collect();
        let all = tiles.iter().zip(&shown).enumerate();
        let of_tiles =
            all.map(|(index, (tile, shown))| (index, &tile.buffers.decks, *shown)).collect();
        let borders: Vec<_> =
            tiles.iter().map(|tile| tile.border(Some(&tile.buffers.decks))).collect();
        let reference_of = |index: usize| tiles[index].buffers.reference_m;
        let connectors = LevelConnectors::of_decks(gpu, &borders, reference_of, &shown);
        Self { of_tiles, connectors }
    }

    fn is_empty(&self) -> bool {
        self.of_tiles.iter().all(|(_, decks, shown)| decks.runs(*shown).is_empty())
    }
}

/// The roads of all tiles of a frame, or their lines of one layer.
struct LabelledLines<'a> {
    /// The roads of each tile.
    of_tiles: Vec<Option<&'a RoadBuffers>>,
    /// The classes that are shown somewhere on each tile.
    shown: Vec<ClassSet>,
    connectors: LevelConnectors,
}

impl<'a> LabelledLines<'a> {
    fn new(
        gpu: &Gpu,
        tiles: &'a [DrawTile<'_>],
        view: &FrameView<'_>,
        of: impl Fn(&'a TileBuffers) -> Option<&'a RoadBuffers>,
    ) -> Self {
        let of_tiles: Vec<_> = tiles.iter().map(|tile| of(tile.buffers)).collect();
        let shown: Vec<_> = tiles.iter().map(|tile| tile.shown_classes(view)).collect();
        let borders: Vec<_> =
            tiles.iter().zip(&of_tiles).map(|(tile, roads)| tile.border(*roads)).collect();
        let reference_of = |index: usize| tiles[index].buffers.reference_m;
        let connectors = LevelConnectors::on_ground(gpu, &borders, reference_of, &shown);
        Self { of_tiles, shown, connectors }
    }

    /// Whether nothing of them is shown.
    fn is_empty(&self) -> bool {
        let of_tiles = self.of_tiles.iter().zip(&self.shown);
        of_tiles
            .filter_map(|(roads, shown)| Some(roads.as_ref()?.runs(*shown)))
            .all(|r| r.is_empty())
    }
}

/// The tiles that have areas of a class that is drawn, among those that `of` finds on a tile.
fn areas_of<'a>(
    tiles: &'a [DrawTile<'_>],
    view: &FrameView<'_>,
    of: impl Fn(&'a DrawTile<'a>, usize, &FrameView<'_>) -> Option<AreaTile<'a>>,
) -> Vec<AreaTile<'a>> {
    let has_drawn = |(_, areas, _): &AreaTile<'_>| {
        areas.classes().iter().any(|of| view.style.area(of.class).is_drawn())
    };
    let tiles = tiles.iter().enumerate();
    tiles.filter_map(|(index, tile)| of(tile, index, view)).filter(has_drawn).collect()
}
