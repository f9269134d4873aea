//! Roads as shadow volumes (SV): a box for each segment of a road in plan, which cuts the road out of the ground.

use std::ops::Range;

use wgpu::{Face, VertexAttribute, vertex_attr_array};

use super::super::{
    pipeline::{Shader, shader},
    road_instances::{RoadInstance, own_width_value},
};
use crate::tiles::RoadVolume;

impl RoadInstance for RoadVolume {
    type Words = Instance;

    const SHADER: Shader =
        shader!("volumes": "common", "tile", "drawn_ground", "coverage", "boxes", "volumes");
    const ATTRIBUTES: &[VertexAttribute] = &vertex_attr_array![
        0 => Float32x2, 1 => Float32x2, 2 => Float32x2, 3 => Float32x2, 4 => Float32x2, 5 => Uint32,
        6 => Float32, 7 => Float32x2, 8 => Float32
    ];
    /// The corners of the strip of triangles around a box, as `shaders/volumes.wgsl` counts them.
    const CORNERS: Range<u32> = 0..14;
    /// Only the far faces are drawn: one fragment per pixel and box, also with the eye inside the box.
    const CULL: Option<Face> = Some(Face::Front);

    fn words(&self) -> Instance {
        instance(self, 0)
    }
}

/// An instance: two plan positions and two height ranges as two f32 each, rise and width factor as f32, class, look, flat ends and other tile as u32,
/// own width, two numbers for dashes and length of the network's part as f32.
pub(crate) type Instance = [u32; 15];

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
    let flags = (volume.kind.look as u32) << 4 | start << 7 | end << 8;
    let class = u32::from(volume.kind.class.number()) | flags | other << 9;
    let [dash_start, dash_rate] = numbers(volume.dash.0);
    let [own_width, part] = numbers([own_width_value(volume.kind.own_width), volume.part_m]);
    [
        a, b, c, d, low, high, near_low, near_high, rise, width, class, own_width, dash_start,
        dash_rate, part,
    ]
}
