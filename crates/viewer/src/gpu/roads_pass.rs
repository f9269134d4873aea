use corniche_roads::FunctionalRoadClass;
use wgpu::{BufferUsages, CommandEncoder};

use super::{
    Gpu,
    bindings::FrameBindings,
    renderer::{DrawTile, FrameView, Renderer, begin},
    targets::Targets,
    tile_buffers::volume_bytes,
};
use crate::{
    RoadMethod,
    scene::{BorderTile, Bridge, bridges},
    tiles::RoadVolume,
};

/// The bridges of a frame, in order of class.
pub(super) struct Bridges {
    list: Vec<Bridge>,
    instances: Option<wgpu::Buffer>,
}

impl Bridges {
    /// Finds them and uploads their volumes, each relative to the finer of its tiles.
    pub(super) fn new(gpu: &Gpu, method: RoadMethod, tiles: &[DrawTile<'_>]) -> Self {
        let border_tiles: Vec<BorderTile<'_>> = tiles
            .iter()
            .map(|tile| BorderTile {
                id: tile.buffers.id,
                width_m: tile.buffers.width_m,
                skirt_depth_m: tile.skirt_depth_m,
                ends: tile.buffers.roads(method).map_or(&[], |roads| &roads.ends),
            })
            .collect();
        let list = bridges(&border_tiles);
        let volumes = list.iter().map(|bridge| {
            let reference_m = tiles[bridge.fine].buffers.reference_m;
            let place = |at: [f64; 2]| [0, 1].map(|k| (at[k] - reference_m[k]) as f32);
            let [start, end] = bridge.ends_m.map(place);
            let volume = RoadVolume {
                start_in_tile: start,
                end_in_tile: end,
                height_range_in_tile: bridge
                    .height_range_m
                    .map(|height_m| (height_m - reference_m[2]) as f32),
                class: bridge.class,
            };
            (volume, bridge.coarse as u32 + 1)
        });
        let bytes = volume_bytes(volumes);
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("bridges", &bytes, BufferUsages::VERTEX));
        Self { list, instances }
    }

    /// The bridges of a class, piece by piece as they share a tile: the tile's index and a range of instances.
    fn runs(&self, class: FunctionalRoadClass) -> Vec<(usize, std::ops::Range<u32>)> {
        let first = self.list.partition_point(|bridge| bridge.class < class) as u32;
        let mut start = first;
        self.list[first as usize..]
            .chunk_by(|a, b| (a.class, a.fine) == (b.class, b.fine))
            .take_while(|run| run[0].class == class)
            .map(|run| {
                let range = start..start + run.len() as u32;
                start = range.end;
                (run[0].fine, range)
            })
            .collect()
    }
}

impl Renderer {
    /// Classes outside, tiles inside: a more important road lies above a lesser one across tile borders too.
    pub(super) fn roads_pass(
        &self,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        tiles: &[DrawTile<'_>],
        bridges: &Bridges,
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        // The pass clears the labels even when it draws no road.
        let mut pass = begin(encoder, "roads", &[&targets.labels.view], None);
        let (pipelines, corners) = match view.roads.method {
            RoadMethod::Geometry => (&self.pipelines.segments, 0..4),
            RoadMethod::ShadowVolumes => (&self.pipelines.volumes, 0..14),
            RoadMethod::None => return,
        };
        pass.set_bind_group(0, &bindings.frame, &[]);
        pass.set_bind_group(2, &bindings.ground, &[]);
        let over_steps = &self.pipelines.volumes;
        for class in FunctionalRoadClass::all().rev() {
            let index = usize::from(class.number());
            let has_center = view.style.roads[index].center.is_some();
            for is_center in [false, true] {
                if is_center && !has_center {
                    continue;
                }
                pass.set_pipeline(if is_center { &pipelines.centers } else { &pipelines.fills });
                for (place, tile) in tiles.iter().enumerate() {
                    let Some(roads) = tile.buffers.roads(view.roads.method) else { continue };
                    let range = roads.class_ranges[index].clone();
                    let Some(instances) = roads.instances.as_ref().filter(|_| !range.is_empty())
                    else {
                        continue;
                    };
                    bindings.set_tile(&mut pass, place);
                    pass.set_vertex_buffer(0, instances.slice(..));
                    pass.draw(corners.clone(), range);
                }
                let Some(instances) = &bridges.instances else { continue };
                pass.set_pipeline(if is_center { &over_steps.centers } else { &over_steps.fills });
                pass.set_vertex_buffer(0, instances.slice(..));
                for (place, range) in bridges.runs(class) {
                    bindings.set_tile(&mut pass, place);
                    pass.draw(0..14, range);
                }
            }
        }
    }
}
