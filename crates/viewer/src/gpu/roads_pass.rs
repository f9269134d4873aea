use std::ops::Range;

use wgpu::{BufferUsages, CommandEncoder};

use super::{
    Gpu,
    bindings::FrameBindings,
    passes::Pipelines,
    renderer::{DrawTile, Renderer, begin},
    targets::Targets,
    tile_buffers::volume_bytes,
};
use crate::{
    frame_view::FrameView,
    options::{RoadMethod, RoadOptions},
    scene::{BorderTile, LevelConnector, level_connectors},
    tiles::{NearHeights, RoadVolume},
};

/// Corners of a segment's quad, as `shaders/roads.wgsl` counts them.
const SEGMENT_CORNERS: Range<u32> = 0..4;
/// Corners of the strip around a volume's box, as `shaders/volumes.wgsl` counts them.
const VOLUME_CORNERS: Range<u32> = 0..14;

/// The connectors of a frame, in order of the finer tile.
pub(crate) struct LevelConnectors {
    list: Vec<LevelConnector>,
    instances: Option<wgpu::Buffer>,
}

impl LevelConnectors {
    /// Finds them and uploads their volumes, each relative to the finer of its tiles.
    pub(crate) fn new(gpu: &Gpu, roads: RoadOptions, tiles: &[DrawTile<'_>]) -> Self {
        let border_tiles: Vec<BorderTile<'_>> = tiles
            .iter()
            .map(|tile| BorderTile {
                id: tile.buffers.id,
                side_m: tile.buffers.size_m[0].min(tile.buffers.size_m[1]),
                skirt_depth_m: tile.skirt_depth_m,
                ends: tile.buffers.roads(roads.method).map_or(&[], |roads| &roads.ends),
            })
            .collect();
        let mut list = level_connectors(&border_tiles);
        list.retain(|connector| roads.classes.contains(connector.class));
        let volumes = list.iter().map(|connector| {
            let reference_m = tiles[connector.fine].buffers.reference_m;
            let place = |at: [f64; 2]| [0, 1].map(|k| (at[k] - reference_m[k]) as f32);
            let [start, end] = connector.ends_m.map(place);
            let height_range_in_tile =
                connector.height_range_m.map(|height_m| (height_m - reference_m[2]) as f32);
            let volume = RoadVolume {
                start_in_tile: start,
                end_in_tile: end,
                height_range_in_tile,
                near: NearHeights { range_in_tile: height_range_in_tile, rise: 0.0 },
                width_factor: connector.width_factor,
                class: connector.class,
            };
            (volume, connector.coarse as u32 + 1)
        });
        let bytes = volume_bytes(volumes);
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("connectors", &bytes, BufferUsages::VERTEX));
        Self { list, instances }
    }

    /// Piece by piece as they share the finer tile: its index and a range of instances.
    fn runs(&self) -> impl Iterator<Item = (usize, Range<u32>)> {
        let mut start = 0;
        self.list.chunk_by(|a, b| a.fine == b.fine).map(move |run| {
            let range = start..start + run.len() as u32;
            start = range.end;
            (run[0].fine, range)
        })
    }
}

impl Renderer {
    /// One draw per tile: the target keeps the largest label, so that neither the order of classes nor that of tiles
    /// matters.
    pub(crate) fn roads_pass(
        &self,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        tiles: &[DrawTile<'_>],
        connectors: &LevelConnectors,
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        // The pass clears the labels even when it draws no road.
        let mut pass = begin(encoder, "roads", &[&targets.labels.view], None);
        let Pipelines { segments, volumes, .. } = &self.pipelines;
        let (pipeline, corners) = match view.roads.method {
            RoadMethod::Geometry => (segments, SEGMENT_CORNERS),
            RoadMethod::ShadowVolumes => (volumes, VOLUME_CORNERS),
            RoadMethod::None => return,
        };
        pass.set_bind_group(0, &bindings.frame, &[]);
        pass.set_bind_group(2, &bindings.ground, &[]);
        pass.set_pipeline(pipeline);
        for (place, tile) in tiles.iter().enumerate() {
            let Some(roads) = tile.buffers.roads(view.roads.method) else { continue };
            let Some(instances) = &roads.instances else { continue };
            bindings.set_tile(&mut pass, place);
            pass.set_vertex_buffer(0, instances.slice(..));
            for range in roads.runs(view.roads.classes) {
                pass.draw(corners.clone(), range);
            }
        }
        let Some(instances) = &connectors.instances else { return };
        pass.set_pipeline(volumes);
        pass.set_vertex_buffer(0, instances.slice(..));
        for (place, range) in connectors.runs() {
            bindings.set_tile(&mut pass, place);
            pass.draw(VOLUME_CORNERS, range);
        }
    }
}
