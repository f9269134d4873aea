//! The GPU buffers of a tile, and their size.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use glam::{DVec3, DVec4};

use super::{
    Gpu,
    area_buffers::AreaBuffers,
    drawables::areas::{AreaTile, Counting},
    ground_buffers::GroundBuffers,
    point_buffers::PointBuffers,
    road_instances::RoadBuffers,
    slope_chain::SlopeChain,
    tile_textures::TileTextures,
    uniforms::row,
};
use crate::{
    camera::{CameraProjection, WorldBox},
    class_scale,
    frame_view::FrameView,
    options::{ClassSet, RoadMethod},
    scene::BorderTile,
    tiles::{
        AreaVolumes, ClassVolumes, LineLayer, NearHeights, TileGeometry, TileLayer, plan_around,
    },
};

/// A tile on the GPU.
pub struct TileBuffers {
    id: TileId,
    pub(crate) reference_m: [f64; 3],
    size_m: [f64; 2],
    /// `None` without ground.
    pub(crate) ground: Option<GroundBuffers>,
    pub(crate) textures: TileTextures,
    /// `None` without areas.
    pub(crate) areas: Option<AreaBuffers>,
    /// User-drawn areas.
    pub(crate) drawn_areas: Option<AreaBuffers>,
    pub(crate) roads: LayerBuffers,
    pub(crate) layers: BTreeMap<LineLayer, LayerBuffers>,
    /// `None` without points.
    pub(crate) points: Option<PointBuffers>,
    width_margin_m: f64,
    /// Lowest and highest true height of the ground and the decks; `None` without ground.
    height_range_m: Option<[f64; 2]>,
    /// Triangles of the ground, without the triangles of skirts.
    pub triangles: u64,
}

/// The roads of a tile, or its lines that are drawn at once, on the GPU, for both methods.
pub(crate) struct LayerBuffers {
    segments: RoadBuffers,
    volumes: RoadBuffers,
    /// Bridges, for both methods.
    decks: RoadBuffers,
}

impl LayerBuffers {
    fn of_lines(gpu: &Gpu, TileLayer { segments, volumes, decks }: &TileLayer) -> Self {
        Self {
            segments: RoadBuffers::new(gpu, segments),
            volumes: RoadBuffers::new(gpu, volumes),
            decks: RoadBuffers::new(gpu, decks),
        }
    }

    /// The roads on the ground for a method.
    pub(crate) fn for_method(&self, method: RoadMethod) -> Option<&RoadBuffers> {
        match method {
            RoadMethod::Geometry => Some(&self.segments),
            RoadMethod::ShadowVolumes => Some(&self.volumes),
            RoadMethod::None => None,
        }
    }

    /// The decks of bridges, which are part of the roads with every method.
    pub(crate) fn decks_for(&self, method: RoadMethod) -> Option<&RoadBuffers> {
        self.for_method(method).map(|_| &self.decks)
    }

    fn gpu_bytes(&self) -> u64 {
        self.segments.gpu_bytes() + self.volumes.gpu_bytes() + self.decks.gpu_bytes()
    }
}

/// A tile to draw in this frame.
pub struct DrawTile<'a> {
    /// The tile.
    pub buffers: &'a TileBuffers,
    /// Depth of the skirt, true metres.
    pub skirt_depth_m: f64,
}

/// Size of a tile on the GPU, bytes, computed before the upload. Its wireframe is not counted: it
/// is created when it is first shown.
#[must_use]
pub fn tile_bytes(tile: &TileGeometry) -> u64 {
    GroundBuffers::bytes_of(&tile.ground)
        + TileTextures::bytes_of(tile)
        + AreaBuffers::bytes_of(&tile.areas)
        + layer_bytes(&tile.roads)
        + tile.lines.0.values().map(layer_bytes).sum::<u64>()
        + PointBuffers::bytes_of(&tile.points)
}

fn layer_bytes(lines: &TileLayer) -> u64 {
    RoadBuffers::bytes_of(&lines.segments)
        + RoadBuffers::bytes_of(&lines.volumes)
        + RoadBuffers::bytes_of(&lines.decks)
}

impl TileBuffers {
    /// Uploads a tile. `above` has the slopes of its parent, which shade the tile far from the eye;
    /// `None` if it has no parent, or is to be shaded only by its own slopes.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry, above: Option<&SlopeChain>) -> Self {
        Self {
            id: tile.id,
            reference_m: tile.reference_m,
            size_m: tile.size_m,
            ground: GroundBuffers::new(gpu, &tile.ground),
            textures: TileTextures::new(gpu, tile, above),
            areas: AreaBuffers::new(gpu, &tile.areas),
            drawn_areas: None,
            roads: LayerBuffers::of_lines(gpu, &tile.roads),
            layers: tile
                .lines
                .0
                .iter()
                .map(|(layer, lines)| (*layer, LayerBuffers::of_lines(gpu, lines)))
                .collect(),
            points: PointBuffers::new(gpu, &tile.points),
            width_margin_m: tile.width_margin_m,
            height_range_m: tile.summary.map(|ground| ground.height_range_m),
            triangles: (tile.ground.surface_indices / 3) as u64,
        }
    }

    /// The slopes of the tile and its ancestors, for its children.
    #[must_use]
    pub fn slopes(&self) -> &SlopeChain {
        &self.textures.slopes
    }

    /// Size of the buffers on the GPU, bytes; the wireframe counts once it has been shown.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        let ground_bytes = self.ground.as_ref().map_or(0, GroundBuffers::gpu_bytes);
        ground_bytes
            + [&self.areas, &self.drawn_areas]
                .into_iter()
                .flatten()
                .map(AreaBuffers::gpu_bytes)
                .sum::<u64>()
            + self.textures.gpu_bytes()
            + self.roads.gpu_bytes()
            + self.points.as_ref().map_or(0, PointBuffers::gpu_bytes)
            + self.layers.values().map(LayerBuffers::gpu_bytes).sum::<u64>()
    }

    /// Replaces a layer of lines by the tile's current lines of that layer.
    pub fn replace_lines(&mut self, gpu: &Gpu, layer: LineLayer, lines: &TileLayer) {
        self.layers.insert(layer, LayerBuffers::of_lines(gpu, lines));
    }

    /// Replaces the user-drawn areas by the tile's current ones.
    pub fn replace_drawn_areas(&mut self, gpu: &Gpu, areas: &AreaVolumes) {
        self.drawn_areas = AreaBuffers::new(gpu, areas);
    }

    /// The volumes of the areas, class by class.
    #[must_use]
    pub fn area_classes(&self) -> &[ClassVolumes] {
        self.areas.as_ref().map_or(&[], |areas| &areas.classes)
    }
}

impl DrawTile<'_> {
    /// Data for connectors: points where the roads, or lines, of the tile meet its border.
    pub(crate) fn border<'b>(&'b self, roads: Option<&'b RoadBuffers>) -> BorderTile<'b> {
        let TileBuffers { id, reference_m, size_m: [east_m, north_m], .. } = *self.buffers;
        BorderTile {
            id,
            side_m: east_m.min(north_m),
            skirt_depth_m: self.skirt_depth_m,
            reference_m,
            ends: roads.map_or(&[], |roads| &roads.ends),
        }
    }

    /// The number of road segments or volumes, and pieces of decks, that are drawn in a view.
    #[must_use]
    pub fn road_segments(&self, view: &FrameView<'_>) -> u64 {
        let (roads, method) = (&self.buffers.roads, view.roads.method);
        let drawn = [roads.for_method(method), roads.decks_for(method)].into_iter().flatten();
        let drawn = drawn.flat_map(|roads| roads.runs(self.shown_classes(view)));
        drawn.map(|range| u64::from(range.end - range.start)).sum()
    }

    /// The number of points of layers that are drawn in a view, hidden ones included.
    #[must_use]
    pub fn layer_points(&self, view: &FrameView<'_>) -> u64 {
        let classes = self.buffers.points.iter().flat_map(|points| &points.classes);
        let drawn = classes.filter(|of| view.layers.point(of.0).is_some());
        drawn.map(|of| u64::from(of.1.end - of.1.start)).sum()
    }

    /// The classes of roads that are shown anywhere in the tile.
    pub(crate) fn shown_classes(&self, view: &FrameView<'_>) -> ClassSet {
        class_scale::shown_classes(view, self.nearest_m(view))
    }

    /// Lower bound of the distance from the eye to the ground that the tile's roads paint, world
    /// metres.
    fn nearest_m(&self, view: &FrameView<'_>) -> f64 {
        let TileBuffers { reference_m, size_m, width_margin_m, .. } = *self.buffers;
        let Some(height_range_m) = self.buffers.height_range_m else { return 0.0 };
        let plan = plan_around(reference_m, size_m);
        let ground =
            WorldBox::new(plan, height_range_m.map(|height_m| height_m * view.vertical_scale()));
        // GEO also paints the neighbours' ground, within the margin. Twice the margin covers slopes
        // of up to 60 degrees there.
        let around_m = 2.0 * width_margin_m + self.skirt_depth_m * view.vertical_scale();
        match view.camera.projection {
            CameraProjection::Perspective => {
                (ground.distance_m(view.camera.eye_in_world) - around_m).max(0.0)
            }
            // The same for all ground.
            CameraProjection::FromAbove { .. } => view.camera.focus_m,
        }
    }

    /// The tile's uniforms: the block `struct Tile` of `shaders/tile.wgsl`. `number` is the tile's
    /// number in the frame, from 1; numbers below 2^24 are exact in f32.
    pub(crate) fn rows(&self, view: &FrameView<'_>, number: u32) -> [[f32; 4]; 2] {
        let TileBuffers { reference_m: [x, y, height_m], size_m, width_margin_m, .. } =
            *self.buffers;
        let reference_in_world = DVec3::new(x, y, height_m * view.vertical_scale());
        let offset = reference_in_world - view.camera.eye_in_world;
        let near_m = NearHeights::reach_m(size_m);
        [
            row(offset.extend(self.skirt_depth_m * view.vertical_scale())),
            row(DVec4::new(height_m, width_margin_m, f64::from(number), near_m)),
        ]
    }

    /// The areas of the tile with its index in the list of tiles of the frame, and how they are
    /// counted.
    pub(crate) fn counted<'a>(
        &self,
        index: usize,
        areas: &'a AreaBuffers,
        view: &FrameView<'_>,
    ) -> AreaTile<'a> {
        let [low, high] = areas.box_in_tile.map(|corner| DVec3::from_array(corner.map(f64::from)));
        let reference = DVec3::from_array(self.buffers.reference_m);
        let scale = DVec3::new(1.0, 1.0, view.vertical_scale());
        let skirt = DVec3::Z * self.skirt_depth_m;
        let volumes =
            WorldBox { min: (reference + low - skirt) * scale, max: (reference + high) * scale };
        // The corners of the near plane are farther from the eye than its middle. The remainder is
        // for rounding.
        let reach_m = 1.01
            * view.camera.near_m
            * view.camera.half_extent_at_unit_depth().extend(1.0).length();
        // From above no face is cut off by the near plane.
        let is_near = view.camera.projection == CameraProjection::Perspective
            && volumes.distance_m(view.camera.eye_in_world) <= reach_m;
        (index, areas, if is_near { Counting::Behind } else { Counting::InFront })
    }
}
