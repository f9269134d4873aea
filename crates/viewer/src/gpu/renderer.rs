//! The renderer draws tiles into targets, pass by pass, and has no state of any frame.

#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
mod read_seen;

use std::{collections::BTreeSet, sync::OnceLock};

use corniche_styles::LayerLook;
use wgpu::{CommandEncoder, LoadOp, TextureView};

use super::{
    Gpu, GpuError,
    area_buffers::AreaBuffers,
    drawables::{
        areas::{AreaTile, StencilAreas},
        average::Average,
        composite::Composite,
        decks::DeckDrawable,
        difference::DifferenceDrawable,
        label_blocks::LabelBlocks,
        label_colors::LabelColors,
        level_connectors::LevelConnectors,
        line_layers,
        points::{PointDrawable, PointTile},
        terrain::{GroundOfTile, TerrainDrawable},
    },
    passes::{begin, begin_with_stencil},
    picture::Picture,
    pipeline::ENTRIES,
    road_instances::{RoadBuffers, RoadInstance, RoadPipeline, RoadsOfTile},
    shared_bindings::{DrawnFrame, SharedBindings, SharedLayouts},
    target_texture::TargetTexture,
    targets::{LabelTargets, Targets},
    tile_buffers::{DrawTile, LayerBuffers, TileBuffers},
    timings::PassTimer,
};
use crate::{
    frame_view::FrameView,
    layer_view::view_of_lines,
    layers::PackageLooks,
    options::{ClassSet, RoadMethod},
    scene::BorderTile,
    tiles::{LineLayer, RoadSegment, RoadVolume},
};

/// Draws tiles; has no state of any frame. Resources that not every picture needs are created at
/// first use.
pub struct Renderer {
    layouts: SharedLayouts,
    terrain: TerrainDrawable,
    areas: OnceLock<StencilAreas>,
    geo_roads: OnceLock<RoadPipeline>,
    sv_roads: OnceLock<RoadPipeline>,
    decks: OnceLock<DeckDrawable>,
    blocks: LabelBlocks,
    composite: Composite,
    line_colors: OnceLock<LabelColors>,
    points: OnceLock<PointDrawable>,
    average: Average,
    difference: OnceLock<DifferenceDrawable>,
}

impl Renderer {
    /// Creates the pipelines that every picture needs.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        let layouts = SharedLayouts::new(device);
        Self {
            terrain: TerrainDrawable::new(device, &layouts),
            areas: OnceLock::new(),
            geo_roads: OnceLock::new(),
            sv_roads: OnceLock::new(),
            decks: OnceLock::new(),
            blocks: LabelBlocks::new(device, &layouts),
            composite: Composite::new(device, &layouts),
            line_colors: OnceLock::new(),
            points: OnceLock::new(),
            average: Average::new(device),
            difference: OnceLock::new(),
            layouts,
        }
    }

    /// Draws terrain, areas, roads, lines and points into `targets`.
    pub fn draw(&self, gpu: &Gpu, view: &FrameView<'_>, tiles: &[DrawTile<'_>], targets: &Targets) {
        self.draw_timed(gpu, view, tiles, targets, None);
    }

    /// Does the same as [`Renderer::draw`]; `timer` records how long each pass takes.
    pub fn draw_timed(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        tiles: &[DrawTile<'_>],
        targets: &Targets,
        mut timer: Option<&mut PassTimer>,
    ) {
        let shared = &self.shared(gpu, view, tiles, targets);
        let frame = DrawnFrame { gpu, shared, view, targets };
        let roads = DrawnLines::new(frame, tiles, |tile| Some(&tile.roads));
        let areas = areas_of(tiles, view, |tile| &tile.areas);
        let drawn = PackageLooks::from_looks(vec![vec![LayerLook::Area(view.style.drawn_area())]]);
        let drawn_view = &FrameView { layers: &drawn, ..*view };
        let drawn_areas = areas_of(tiles, drawn_view, |tile| &tile.drawn_areas);
        let points = points_of(tiles, view);
        self.with_lines(frame, tiles, |lines| {
            if let Some(timer) = &mut timer {
                let has_decks = roads.has_decks() || lines.iter().any(|(_, of)| of.has_decks());
                timer.begin([!areas.is_empty() || !drawn_areas.is_empty(), has_decks]);
            }
            let mut mark = |encoder: &mut CommandEncoder, number| {
                if let Some(timer) = &mut timer {
                    timer.mark(encoder, number);
                }
            };
            gpu.submit("frame", |encoder| {
                mark(encoder, 0);
                self.pass_terrain(frame, encoder, tiles);
                mark(encoder, 1);
                self.pass_areas(frame, encoder, &areas, &targets.ground);
                let drawn = DrawnFrame { view: drawn_view, ..frame };
                self.pass_areas(drawn, encoder, &drawn_areas, &targets.ground);
                mark(encoder, 2);
                self.pass_labels(frame, encoder, &roads.on_ground, &targets.roads);
                mark(encoder, 3);
                self.pass_decks(&roads, lines, encoder);
                mark(encoder, 4);
                self.pass_composite(frame, encoder);
                let of_package = |(layer, _): &(LineLayer, _)| *layer < LineLayer::Overlays;
                let (of_package, of_user) = lines.split_at(lines.partition_point(of_package));
                // Decks hide the lines on the ground below them.
                for (layer, lines) in of_package {
                    self.pass_lines(*layer, lines, encoder);
                }
                if roads.has_decks() {
                    let labels = [&targets.decks(gpu).labels, &targets.roads];
                    self.pass_deck_colors(frame, encoder, labels, false);
                }
                for (_, lines) in of_package.iter().filter(|(_, lines)| lines.has_decks()) {
                    let labels = self.draw_line_labels(lines, encoder);
                    self.pass_deck_colors(lines.frame, encoder, labels, true);
                }
                for (layer, lines) in of_user {
                    self.pass_lines(*layer, lines, encoder);
                }
                self.pass_points(frame, encoder, &points, targets.picture.drawn());
                self.average.draw(gpu, encoder, &targets.picture);
                mark(encoder, 5);
            });
        });
    }

    /// Draws into `into` where the roads of two drawings differ, over the picture of the first one
    /// in pale grey. Both must have been drawn with the same camera; all three must have the same
    /// size and samples.
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
        let difference = self.difference.get_or_init(|| DifferenceDrawable::new(&gpu.device));
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

    /// The pipeline of shadow volumes; connectors are drawn as shadow volumes with either method.
    fn sv_roads(&self, gpu: &Gpu) -> &RoadPipeline {
        self.sv_roads.get_or_init(|| self.roads_on_ground::<RoadVolume>(gpu))
    }

    fn roads_on_ground<T: RoadInstance>(&self, gpu: &Gpu) -> RoadPipeline {
        let layouts = &self.layouts;
        RoadPipeline::new::<T>(&gpu.device, layouts, &layouts.ground, ENTRIES, None)
    }

    fn decks(&self, gpu: &Gpu) -> &DeckDrawable {
        self.decks.get_or_init(|| DeckDrawable::new(&gpu.device, &self.layouts))
    }
}

/// The passes of a frame.
impl Renderer {
    /// Draws colour, depth and owner of the ground.
    fn pass_terrain(
        &self,
        frame: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        tiles: &[DrawTile<'_>],
    ) {
        let Targets { ground, depth, owners, .. } = frame.targets;
        let colors = [&ground.view, &owners.view];
        let mut pass = begin(encoder, "terrain", &colors, Some(&depth.view), LoadOp::Clear(()));
        let grounds: Vec<_> = tiles
            .iter()
            .enumerate()
            .filter_map(|(index, draw)| {
                let TileBuffers { ground, textures, .. } = draw.buffers;
                Some(GroundOfTile { tile: index, ground: ground.as_ref()?, textures })
            })
            .collect();
        self.terrain.draw(frame, &mut pass, &grounds);
    }

    /// Draws areas over colours such as those of the ground. Without areas there is no areas pass.
    fn pass_areas(
        &self,
        frame: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        areas: &[AreaTile<'_>],
        into: &TargetTexture,
    ) {
        if areas.is_empty() {
            return;
        }
        let stencil = &frame.targets.stencil(frame.gpu).view;
        let mut pass = begin_with_stencil(encoder, "areas", &into.view, stencil);
        let new = || StencilAreas::new(&frame.gpu.device, &self.layouts);
        self.areas.get_or_init(new).draw(frame, &mut pass, areas);
    }

    /// Draws labels of roads, or of lines of a layer: for each tile the classes that are shown
    /// there.
    fn pass_labels(
        &self,
        DrawnFrame { gpu, shared, view, .. }: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        roads: &DrawnRoads<'_>,
        targets: &LabelTargets,
    ) {
        // The pass clears the labels even if it draws nothing.
        let mut pass = begin(encoder, "labels", &[&targets.labels.view], None, LoadOp::Clear(()));
        let pipeline = match view.roads.method {
            RoadMethod::Geometry => self.geo_roads(gpu),
            RoadMethod::ShadowVolumes => self.sv_roads(gpu),
            RoadMethod::None => return,
        };
        pipeline.draw(&mut pass, shared, &shared.ground, &roads.of_tiles);
        if !roads.connectors.is_empty() {
            roads.connectors.draw(&mut pass, shared, &shared.ground, self.sv_roads(gpu));
        }
    }

    /// Draws a layer of lines over the samples of the picture. If no tile has such lines, or the
    /// style draws none, there is no lines pass.
    fn pass_lines(&self, layer: LineLayer, lines: &DrawnLines<'_>, encoder: &mut CommandEncoder) {
        let frame = lines.frame;
        if lines.on_ground.is_empty() {
            return;
        }
        let DrawnFrame { gpu, view, targets, .. } = frame;
        let labels = targets.lines(gpu);
        self.pass_labels(frame, encoder, &lines.on_ground, labels);
        self.blocks.find(frame, encoder, labels);
        let into = [targets.picture.drawn()];
        let mut pass = begin(encoder, "lines", &into, None, LoadOp::Load);
        let new = || line_layers::line_colors(&gpu.device, &self.layouts);
        let colors = self.line_colors.get_or_init(new);
        let rows = line_layers::rows(view, layer.lines_of(view));
        colors.bind(frame, &mut pass, &rows, labels, &[&targets.roads.labels]);
        colors.draw(&mut pass, targets);
    }

    /// Calls `draw` with the lines of all layers that tiles have, from the lowest to the highest.
    fn with_lines<T>(
        &self,
        frame: DrawnFrame<'_>,
        tiles: &[DrawTile<'_>],
        draw: impl FnOnce(&[(LineLayer, DrawnLines<'_>)]) -> T,
    ) -> T {
        let layers: BTreeSet<LineLayer> =
            tiles.iter().flat_map(|tile| tile.buffers.layers.keys().copied()).collect();
        let styles: Vec<_> = layers.iter().map(|layer| layer.style_of(frame.view)).collect();
        let views: Vec<_> = styles.iter().map(|style| view_of_lines(frame.view, style)).collect();
        let bound = |view| SharedBindings::with_view(DrawnFrame { view, ..frame }, &self.layouts);
        let shared: Vec<_> = views.iter().map(bound).collect();
        let frames = views.iter().zip(&shared);
        let frames = frames.map(|(view, shared)| DrawnFrame { shared, view, ..frame });
        let lines = layers.into_iter().zip(frames).map(|(layer, frame)| {
            (layer, DrawnLines::new(frame, tiles, |tile| tile.layers.get(&layer)))
        });
        draw(&lines.collect::<Vec<_>>())
    }

    /// Draws the labels of the decks of bridges among lines, and of the lines on the ground: other
    /// lines may have been drawn since. Returns both labels.
    fn draw_line_labels<'a>(
        &self,
        DrawnLines { frame, on_ground, decks }: &DrawnLines<'a>,
        encoder: &mut CommandEncoder,
    ) -> [&'a LabelTargets; 2] {
        let DrawnFrame { gpu, targets, .. } = *frame;
        let labels = [targets.line_decks(gpu), targets.lines(gpu)];
        self.pass_labels(*frame, encoder, on_ground, labels[1]);
        self.decks(gpu).draw_labels(*frame, encoder, decks.parts(), labels);
        labels
    }

    /// Draws points over the samples of a picture. Without points there is no points pass.
    fn pass_points(
        &self,
        frame: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        points: &[PointTile<'_>],
        into: &TextureView,
    ) {
        if !points.is_empty() {
            let mut pass = begin(encoder, "points", &[into], None, LoadOp::Load);
            let new = || PointDrawable::new(&frame.gpu.device, &self.layouts);
            self.points.get_or_init(new).draw(frame, &mut pass, points);
        }
    }

    /// Draws the samples of the picture. Drawables over the map, such as labels, are drawn after
    /// the composite: in this pass, or in one with `LoadOp::Load` if they need a depth test.
    fn pass_composite(&self, frame: DrawnFrame<'_>, encoder: &mut CommandEncoder) {
        let DrawnFrame { view, targets, .. } = frame;
        if view.roads.method != RoadMethod::None {
            self.blocks.find(frame, encoder, &targets.roads);
        }
        let into = [targets.picture.drawn()];
        let mut pass = begin(encoder, "composite", &into, None, LoadOp::Clear(()));
        self.composite.draw(frame, &mut pass);
    }

    /// Draws the depths of all decks of bridges, and the labels of those of roads. Without decks
    /// there are no deck passes.
    fn pass_decks(
        &self,
        roads: &DrawnLines<'_>,
        lines: &[(LineLayer, DrawnLines<'_>)],
        encoder: &mut CommandEncoder,
    ) {
        let DrawnFrame { gpu, targets, .. } = roads.frame;
        let mut others = LoadOp::Clear(());
        let all = std::iter::once(roads).chain(lines.iter().map(|(_, lines)| lines));
        for lines in all.filter(|lines| lines.has_decks()) {
            self.decks(gpu).draw_depths(lines.frame, encoder, lines.decks.parts(), others);
            others = LoadOp::Load;
        }
        if roads.has_decks() {
            let labels = [&targets.decks(gpu).labels, &targets.roads];
            self.decks(gpu).draw_labels(roads.frame, encoder, roads.decks.parts(), labels);
        }
    }

    /// Draws the colours of decks, of roads or of lines, over the samples of the picture, from
    /// their labels and those on the ground.
    fn pass_deck_colors(
        &self,
        frame: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        labels: [&LabelTargets; 2],
        are_lines: bool,
    ) {
        self.blocks.find(frame, encoder, labels[0]);
        let into = [frame.targets.picture.drawn()];
        let mut pass = begin(encoder, "deck colors", &into, None, LoadOp::Load);
        self.decks(frame.gpu).draw_colors(frame, &mut pass, labels, are_lines);
    }
}

/// The roads of all tiles of a frame, or their lines of one layer.
struct DrawnLines<'a> {
    /// For lines a frame in which they take the place of roads.
    frame: DrawnFrame<'a>,
    on_ground: DrawnRoads<'a>,
    decks: DrawnRoads<'a>,
}

impl<'a> DrawnLines<'a> {
    /// Collects the roads, or lines, that `of` returns for tiles.
    fn new(
        frame: DrawnFrame<'a>,
        tiles: &[DrawTile<'a>],
        of: impl Fn(&'a TileBuffers) -> Option<&'a LayerBuffers>,
    ) -> Self {
        let method = frame.view.roads.method;
        let on_ground = |tile| of(tile)?.for_method(method);
        let decks = |tile| of(tile)?.decks_for(method);
        Self {
            frame,
            on_ground: DrawnRoads::new(frame, tiles, on_ground, LevelConnectors::on_ground),
            decks: DrawnRoads::new(frame, tiles, decks, LevelConnectors::of_decks),
        }
    }

    /// Whether bridges are shown.
    fn has_decks(&self) -> bool {
        !self.decks.is_empty()
    }
}

/// Roads of all tiles of a frame, on the ground or on decks.
struct DrawnRoads<'a> {
    /// The roads of tiles, each with its index in the list of tiles of the frame and the classes
    /// that are shown there.
    of_tiles: Vec<RoadsOfTile<'a>>,
    connectors: LevelConnectors,
}

impl<'a> DrawnRoads<'a> {
    fn new(
        DrawnFrame { gpu, view, .. }: DrawnFrame<'_>,
        tiles: &[DrawTile<'a>],
        of: impl Fn(&'a TileBuffers) -> Option<&'a RoadBuffers>,
        connect: impl Fn(&Gpu, &[BorderTile<'_>], &[ClassSet]) -> LevelConnectors,
    ) -> Self {
        let roads: Vec<_> = tiles.iter().map(|tile| of(tile.buffers)).collect();
        let shown: Vec<_> = tiles.iter().map(|tile| tile.shown_classes(view)).collect();
        let borders: Vec<_> =
            tiles.iter().zip(&roads).map(|(tile, roads)| tile.border(*roads)).collect();
        let connectors = connect(gpu, &borders, &shown);
        let of_tiles = roads.into_iter().zip(shown).enumerate();
        let of_tiles = of_tiles.filter_map(|(tile, (roads, classes))| {
            Some(RoadsOfTile { tile, roads: roads?, classes })
        });
        Self { of_tiles: of_tiles.collect(), connectors }
    }

    /// The roads of tiles and the connectors between them.
    fn parts(&self) -> (&[RoadsOfTile<'a>], &LevelConnectors) {
        (&self.of_tiles, &self.connectors)
    }

    /// Whether none of the roads is shown.
    fn is_empty(&self) -> bool {
        self.of_tiles.iter().all(|of| of.roads.runs(of.classes).is_empty())
    }
}

/// The tiles that have areas of a drawn class; `of` returns the areas of a tile.
fn areas_of<'a>(
    tiles: &[DrawTile<'a>],
    view: &FrameView<'_>,
    of: impl Fn(&'a TileBuffers) -> &'a Option<AreaBuffers>,
) -> Vec<AreaTile<'a>> {
    let has_drawn = |(_, areas, _): &AreaTile<'_>| {
        areas.classes.iter().any(|of| view.layers.area(of.class).is_some())
    };
    let counted = |(index, tile): (usize, &DrawTile<'a>)| {
        Some(tile.counted(index, of(tile.buffers).as_ref()?, view))
    };
    tiles.iter().enumerate().filter_map(counted).filter(has_drawn).collect()
}

/// The tiles that have points of a drawn class.
fn points_of<'a>(tiles: &[DrawTile<'a>], view: &FrameView<'_>) -> Vec<PointTile<'a>> {
    let has_drawn = |(_, points): &PointTile<'_>| {
        points.classes.iter().any(|of| view.layers.point(of.0).is_some())
    };
    let of_tile =
        |(index, tile): (usize, &DrawTile<'a>)| Some((index, tile.buffers.points.as_ref()?));
    tiles.iter().enumerate().filter_map(of_tile).filter(has_drawn).collect()
}
