//! Pieces of road over the steps between tiles of different levels. They are drawn as shadow volumes by both methods.

use std::ops::Range;

use wgpu::{Buffer, BufferUsages, RenderPass};

use super::{
    super::{Gpu, road_instances::RoadPipeline, shared_bindings::SharedBindings},
    sv_roads,
};
use crate::{
    options::ClassSet,
    scene::{BorderTile, LevelConnector, level_connectors},
    tiles::{DashPlace, NearHeights, OPEN_M, RoadVolume, dash_of_segment_m},
};

/// The connectors of a frame, in order of the finer tile.
pub(crate) struct LevelConnectors {
    list: Vec<LevelConnector>,
    instances: Option<Buffer>,
}

impl LevelConnectors {
    /// Finds the connectors between `tiles` and uploads their volumes, each relative to the reference point of its finer
    /// tile. `reference_of` gives that point for an index of `tiles`; `shown` says which classes are shown on each of them.
    pub(crate) fn new(
        gpu: &Gpu,
        tiles: &[BorderTile<'_>],
        reference_of: impl Fn(usize) -> [f64; 3],
        shown: &[ClassSet],
    ) -> Self {
        let mut list = level_connectors(tiles);
        list.retain(|connector| {
            shown[connector.fine].or(shown[connector.coarse]).contains(connector.class)
        });
        let volumes = list.iter().map(|connector| {
            let reference_m = reference_of(connector.fine);
            (volume(connector, reference_m), connector.coarse as u32 + 1)
        });
        let all = sv_roads::instances(volumes);
        let buffer = || gpu.buffer("connectors", bytemuck::cast_slice(&all), BufferUsages::VERTEX);
        let instances = (!all.is_empty()).then(buffer);
        Self { list, instances }
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Draws the connectors with the pipeline of shadow volumes.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        volumes: &RoadPipeline,
    ) {
        if let Some(instances) = &self.instances {
            volumes.draw_instances(pass, shared, instances, self.runs());
        }
    }

    /// The index of each finer tile and the range of its instances.
    fn runs(&self) -> impl Iterator<Item = (usize, Range<u32>)> {
        let mut start = 0;
        self.list.chunk_by(|a, b| a.fine == b.fine).map(move |run| {
            let range = start..start + run.len() as u32;
            start = range.end;
            (run[0].fine, range)
        })
    }
}

/// The volume of a connector; the reference point is that of its finer tile.
fn volume(connector: &LevelConnector, reference_m: [f64; 3]) -> RoadVolume {
    let place = |at: [f64; 2]| [0, 1].map(|k| (at[k] - reference_m[k]) as f32);
    let [start, end] = connector.ends_m.map(place);
    let height_range_in_tile =
        connector.height_range_m.map(|height_m| (height_m - reference_m[2]) as f32);
    RoadVolume {
        start_in_tile: start,
        end_in_tile: end,
        height_range_in_tile,
        near: NearHeights { range_in_tile: height_range_in_tile, rise: 0.0 },
        width_factor: connector.width_factor,
        class: connector.class,
        own_width: connector.own_width,
        look: connector.look,
        // It goes on in two tiles.
        part_m: OPEN_M,
        dash: DashPlace::flat(dash_of_segment_m(connector.ends_m)),
        flat_ends: [false; 2],
    }
}
