//! Pieces of road over the steps between tiles of different levels: on the ground, where both
//! methods draw them as shadow volumes, and on decks.

use std::ops::Range;

use bytemuck::Pod;
use corniche_roads::slab_thickness_m;
use wgpu::{BindGroup, Buffer, BufferUsages, RenderPass};

use super::{
    super::{
        Gpu,
        road_instances::{RoadInstance as _, RoadPipeline},
        shared_bindings::SharedBindings,
    },
    sv_roads,
};
use crate::{
    options::ClassSet,
    scene::{BorderTile, LevelConnector, level_connectors},
    tiles::{
        DashPlace, DeckPiece, NearHeights, OPEN_M, RoadVolume, dash_of_segment_m, relative,
        relative_in_plan,
    },
};

/// The connectors of a frame, in order of the finer tile.
pub(crate) struct LevelConnectors {
    list: Vec<LevelConnector>,
    instances: Option<Buffer>,
}

impl LevelConnectors {
    /// Finds the connectors between roads on the ground of `tiles` and uploads their volumes, each
    /// relative to the reference point of its finer tile. `shown` has the classes that are shown on
    /// each tile.
    pub(crate) fn on_ground(gpu: &Gpu, tiles: &[BorderTile<'_>], shown: &[ClassSet]) -> Self {
        Self::new(gpu, tiles, shown, |connector| {
            let volume = volume(connector, tiles[connector.fine].reference_m);
            sv_roads::instance(&volume, connector.coarse as u32 + 1)
        })
    }

    /// Does the same as [`LevelConnectors::on_ground`] for decks.
    pub(crate) fn of_decks(gpu: &Gpu, tiles: &[BorderTile<'_>], shown: &[ClassSet]) -> Self {
        Self::new(gpu, tiles, shown, |connector| {
            piece(connector, tiles[connector.fine].reference_m).words()
        })
    }

    fn new<I: Pod>(
        gpu: &Gpu,
        tiles: &[BorderTile<'_>],
        shown: &[ClassSet],
        instance: impl Fn(&LevelConnector) -> I,
    ) -> Self {
        let mut list = level_connectors(tiles);
        list.retain(|connector| {
            shown[connector.fine].or(shown[connector.coarse]).contains(connector.kind.class)
        });
        let all: Vec<I> = list.iter().map(instance).collect();
        let buffer = || gpu.buffer("connectors", bytemuck::cast_slice(&all), BufferUsages::VERTEX);
        let instances = (!all.is_empty()).then(buffer);
        Self { list, instances }
    }

    /// Whether there are no connectors.
    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Draws the connectors with the pipeline for their instances.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        drawn: &BindGroup,
        pipeline: &RoadPipeline,
    ) {
        if let Some(instances) = &self.instances {
            pipeline.draw_instances(pass, shared, drawn, instances, self.runs());
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

/// The volume of a connector, relative to the reference point of its finer tile.
fn volume(connector: &LevelConnector, reference_m: [f64; 3]) -> RoadVolume {
    let [start, end] = connector.ends_m.map(|at| relative_in_plan(at, reference_m));
    let height_range_in_tile =
        connector.height_range_m.map(|height_m| (height_m - reference_m[2]) as f32);
    RoadVolume {
        start_in_tile: start,
        end_in_tile: end,
        height_range_in_tile,
        near: NearHeights { range_in_tile: height_range_in_tile, rise: 0.0 },
        width_factor: connector.width_factor,
        kind: connector.kind,
        // The road continues in two tiles.
        part_m: OPEN_M,
        dash: DashPlace::flat(dash_of_segment_m(connector.ends_m)),
        flat_ends: [false; 2],
    }
}

/// The deck piece of a connector: from the end in the finer tile to the end in the coarser one,
/// thick enough to close the step.
fn piece(connector: &LevelConnector, reference_m: [f64; 3]) -> DeckPiece {
    let [first_m, second_m] = connector.heights_m;
    let place = |[x, y]: [f64; 2], height_m: f64| relative([x, y, height_m], reference_m);
    DeckPiece {
        start_in_tile: place(connector.ends_m[0], first_m),
        end_in_tile: place(connector.ends_m[1], second_m),
        mitres: [[0.0; 2]; 2],
        lands: [false; 2],
        deck_m: OPEN_M,
        slab_m: (slab_thickness_m(connector.kind.class) + (second_m - first_m).abs()) as f32,
        width_factor: connector.width_factor,
        kind: connector.kind,
        part_m: OPEN_M,
        dash: DashPlace::flat(dash_of_segment_m(connector.ends_m)),
    }
}
