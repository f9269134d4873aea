use std::ops::Range;

use corniche_roads::FunctionalRoadClass;
use wgpu::util::DeviceExt;

use super::Gpu;
use crate::tiles::TileGeometry;

/// A tile on the graphics card.
pub struct TileBuffers {
    pub(super) ground: Option<GroundBuffers>,
    pub(super) segments: Option<wgpu::Buffer>,
    pub(super) class_ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    pub(super) reference_m: [f64; 3],
    triangles: u64,
}

pub(super) struct GroundBuffers {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    pub(super) index_count: u32,
}

/// Bytes of one ground vertex: position as three f32, normal and skirt flag as four i8.
pub(super) const GROUND_STRIDE: u64 = 16;
/// Bytes of one road segment: two positions as three f32 each, class as u32.
pub(super) const SEGMENT_STRIDE: u64 = 28;

impl TileBuffers {
    /// Uploads a tile.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry) -> Self {
        let buffer = |contents: &[u8], usage| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("tile"),
                contents,
                usage,
            })
        };
        let ground = (!tile.ground.indices.is_empty()).then(|| GroundBuffers {
            vertices: buffer(&ground_bytes(tile), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&tile.ground.indices), wgpu::BufferUsages::INDEX),
            index_count: tile.ground.indices.len() as u32,
        });
        let segments = (!tile.roads.all().is_empty())
            .then(|| buffer(&segment_bytes(tile), wgpu::BufferUsages::VERTEX));
        let mut class_ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for class in FunctionalRoadClass::all() {
            class_ranges[usize::from(class.number())] = tile.roads.range_of(class);
        }
        Self {
            ground,
            segments,
            class_ranges,
            reference_m: tile.reference_m,
            triangles: (tile.ground.surface_indices / 3) as u64,
        }
    }

    /// Triangles of its ground, skirts not counted.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        self.triangles
    }

    /// Segments of its roads.
    #[must_use]
    pub fn road_segments(&self) -> u64 {
        self.class_ranges.iter().map(|range| u64::from(range.end - range.start)).sum()
    }
}

fn ground_bytes(tile: &TileGeometry) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(tile.ground.vertices.len() * GROUND_STRIDE as usize);
    for vertex in &tile.ground.vertices {
        bytes.extend_from_slice(bytemuck::cast_slice(&vertex.position_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&vertex.normal_skirt));
    }
    bytes
}

fn segment_bytes(tile: &TileGeometry) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(tile.roads.all().len() * SEGMENT_STRIDE as usize);
    for segment in tile.roads.all() {
        bytes.extend_from_slice(bytemuck::cast_slice(&segment.start_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&segment.end_in_tile));
        bytes.extend_from_slice(&u32::from(segment.class.number()).to_ne_bytes());
    }
    bytes
}
