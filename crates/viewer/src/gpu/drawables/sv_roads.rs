//! Roads as shadow volumes (SV): a box for each segment of a road in plan, which cuts the road out of the ground.

use std::ops::Range;

use wgpu::{Device, vertex_attr_array};

use super::super::{
    pipeline::{ENTRIES, Shader, shader},
    road_instances::{RoadInstance, RoadPipeline, RoadRecipe, own_width_value},
    shared_bindings::SharedLayouts,
};
use crate::tiles::RoadVolume;

pub(crate) const SHADER: Shader =
    shader!("volumes": "common", "tile", "drawn_ground", "coverage", "boxes", "volumes");

/// Bytes of an instance: two plan positions and two height ranges as two f32 each, rise and width factor as f32, class, look,
/// flat ends and other tile as u32, own width, two numbers for dashes and length of the network's part as f32.
const INSTANCE_BYTES: u64 = 60;
/// Corners of the strip of triangles around a box, as `shaders/volumes.wgsl` counts them.
const CORNERS: Range<u32> = 0..14;

/// Draws roads as shadow volumes.
pub(crate) fn pipeline(device: &Device, layouts: &SharedLayouts) -> RoadPipeline {
    let recipe = RoadRecipe {
        shader: SHADER,
        instance_bytes: INSTANCE_BYTES,
        attributes: &vertex_attr_array![
            0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Float32x2, 4 => Float32x2, 5 => Uint32,
            6 => Float32, 7 => Float32x2, 8 => Float32
        ],
        // Only the far faces are drawn: one fragment per pixel and box, also with the eye inside the box.
        cull: Some(wgpu::Face::Front),
        corners: CORNERS,
        drawn: &layouts.ground,
        entries: ENTRIES,
        depth: None,
        has_labels: true,
    };
    RoadPipeline::new(device, layouts, &recipe)
}

impl RoadInstance for RoadVolume {
    type Words = Instance;

    fn words(&self) -> Instance {
        instance(self, 0)
    }
}

/// An instance, as words.
pub(crate) type Instance = [u32; INSTANCE_BYTES as usize / 4];

/// The instance of a volume. `other` is the number of the other tile that it belongs to if it connects two levels, else 0.
pub(crate) fn instance(volume: &RoadVolume, other: u32) -> Instance {
    let numbers = |pair: [f32; 2]| pair.map(f32::to_bits);
    let [[a, b], [c, d], [low, high], [near_low, near_high]] = [
        volume.start_in_tile,
        volume.end_in_tile,
        volume.height_range_in_tile,
        volume.near.range_in_tile,
    ]
    .map(numbers);
    let [rise, width] = numbers([volume.near.rise, volume.width_factor]);
    let [start, end] = volume.flat_ends.map(u32::from);
    let flags = volume.look.number() << 4 | start << 7 | end << 8;
    let class = u32::from(volume.class.number()) | flags | other << 9;
    let [dash_start, dash_rate] = numbers(volume.dash.numbers());
    let [own_width, part] = numbers([own_width_value(volume.own_width), volume.part_m]);
    [
        a, b, c, d, low, high, near_low, near_high, rise, width, class, own_width, dash_start,
        dash_rate, part,
    ]
}
