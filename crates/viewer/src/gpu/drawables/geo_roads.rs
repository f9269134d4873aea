//! Roads as geometry on the ground (GEO): a quad for each piece of a road in a triangle of the
//! ground.

use std::ops::Range;

use wgpu::{Face, VertexAttribute, vertex_attr_array};

use super::super::{
    pipeline::{Shader, shader},
    road_instances::{RoadInstance, kind_bits, own_width_value},
};
use crate::tiles::{Bed, RoadSegment};

impl RoadInstance for RoadSegment {
    /// Two plan positions as two f32 each, two shares, two slopes, a height and a width factor as
    /// f32, class, flags and look as u32, eight bounds as f16, own width, two numbers for dashes
    /// and length of the network's part as f32.
    type Words = [u32; 19];

    const SHADER: Shader = shader!("roads": "common", "tile", "drawn_ground", "coverage", "roads");
    const ATTRIBUTES: &[VertexAttribute] = &vertex_attr_array![
        0 => Float32x4, 1 => Float32x4, 2 => Float32x2, 3 => Uint32, 4 => Float16x4, 5 => Float16x4,
        6 => Float32, 7 => Float32x2, 8 => Float32
    ];
    /// The corners of a quad, in the order of `shaders/roads.wgsl`.
    const CORNERS: Range<u32> = 0..4;
    /// A quad may face any direction.
    const CULL: Option<Face> = None;

    fn words(&self) -> Self::Words {
        let Bed { slopes, rises, most_m: [cell, cells, margin], leaves_tile } = self.bed;
        let numbers = |pair: [f32; 2]| pair.map(f32::to_bits);
        let flags = self.has_caps.into_iter().chain(leaves_tile).zip(9..);
        let class = flags.fold(kind_bits(self.kind, self.flat_ends), |bits, (flag, bit)| {
            bits | u32::from(flag) << bit
        });
        let bounds = |pair: [f32; 2]| bytemuck::cast::<[u16; 2], u32>(pair.map(f16_above));
        let [[a, b], [c, d], [e, f], [g, h]] =
            [self.start_in_tile, self.end_in_tile, self.shares, slopes].map(numbers);
        let [height, width] = numbers([self.height_in_tile, self.width_factor]);
        let [rises, cell, cells, margin] = [rises, cell, cells, margin].map(bounds);
        let [dash_start, dash_rate] = numbers(self.dash.0);
        let [own_width, part] = numbers([own_width_value(self.kind.own_width), self.part_m]);
        [
            a, b, c, d, e, f, g, h, height, width, class, rises, cell, cells, margin, own_width,
            dash_start, dash_rate, part,
        ]
    }
}

/// The bits of the smallest 16-bit float that is not below `value`. Below 2^-14 the result may be
/// larger than necessary, and above 65504 it is 65504.
fn f16_above(value: f32) -> u16 {
    // 2^-14, the smallest 16-bit float with all its digits, and 65504, the largest that is finite.
    const LEAST: f32 = 6.103_515_6e-5;
    const MOST: f32 = 65_504.0;
    if value <= 0.0 {
        return 0;
    }
    // In both formats the digits follow the exponent. A 32-bit float has 13 more bits of digits,
    // and its exponent is stored as a number that is larger by 112.
    let bits = value.clamp(LEAST, MOST).to_bits();
    (((bits + 0x1FFF) >> 13) - (112 << 10)) as u16
}

#[cfg(test)]
#[path = "geo_roads_tests.rs"]
mod tests;
