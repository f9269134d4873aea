//! Roads as shadow volumes (SV): a box for each segment of a road in plan, intersected with the
//! ground.

use std::ops::Range;

use wgpu::{Face, VertexAttribute, vertex_attr_array};

use super::super::{
    pipeline::{Shader, shader},
    road_instances::{RoadInstance, kind_bits, own_width_value},
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
    /// The corners of the triangle strip around a box, in the order of `shaders/volumes.wgsl`.
    const CORNERS: Range<u32> = 0..14;
    /// Draws only the far faces: one fragment per pixel and box, also with the eye inside the box.
    const CULL: Option<Face> = Some(Face::Front);

    fn words(&self) -> Instance {
        instance(self, 0)
    }
}

/// An instance: two plan positions and two height ranges as two f32 each, rise and width factor as
/// f32, class, look, flat ends and other tile as u32, own width, two numbers for dashes and length
/// of the network's part as f32.
pub(crate) type Instance = [u32; 15];

/// Returns the instance of a volume. If the volume connects two levels, `other` is the number of
/// the other tile, otherwise 0.
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
    let class = kind_bits(volume.kind, volume.flat_ends) | other << 9;
    let [dash_start, dash_rate] = numbers(volume.dash.0);
    let [own_width, part] = numbers([own_width_value(volume.kind.own_width), volume.part_m]);
    [
        a, b, c, d, low, high, near_low, near_high, rise, width, class, own_width, dash_start,
        dash_rate, part,
    ]
}
