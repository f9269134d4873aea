use std::{ops::Range, sync::OnceLock};

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use wgpu::{Buffer, BufferUsages};

use super::Gpu;
use crate::{
    options::{ClassSet, RoadMethod, RoadOptions},
    tiles::{Bed, RoadEnd, RoadList, RoadVolume, TileGeometry},
};

/// A tile on the graphics card.
pub struct TileBuffers {
    pub(crate) ground: Option<GroundBuffers>,
    pub(crate) segments: RoadBuffers,
    pub(crate) volumes: RoadBuffers,
    pub(crate) reference_m: [f64; 3],
    pub(crate) width_margin_m: f64,
    pub(crate) size_m: [f64; 2],
    pub(crate) id: TileId,
    triangles: u64,
}

pub(crate) struct GroundBuffers {
    pub(crate) vertices: Buffer,
    pub(crate) indices: Buffer,
    /// Indices of the ground, then of the skirts.
    pub(crate) surface: Range<u32>,
    pub(crate) skirts: Range<u32>,
    /// Three per triangle of the ground: what the edges are made of.
    triangles: Vec<u32>,
    edges: OnceLock<Buffer>,
}

impl GroundBuffers {
    /// Two indices for each edge of the ground, made when they are first drawn: few pictures show them.
    pub(crate) fn edges(&self, gpu: &Gpu) -> &Buffer {
        self.edges.get_or_init(|| {
            gpu.buffer("edges", bytemuck::cast_slice(&edges(&self.triangles)), BufferUsages::INDEX)
        })
    }

    /// The buffer above, if it was made.
    pub(crate) fn drawn_edges(&self) -> Option<&Buffer> {
        self.edges.get()
    }
}

/// Each edge of some triangles once.
fn edges(triangles: &[u32]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> = triangles
        .chunks_exact(3)
        .flat_map(|corners| [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// What one method draws of a tile's roads.
#[derive(Default)]
pub(crate) struct RoadBuffers {
    /// One instance per segment, in order of class; `None` without any.
    pub(crate) instances: Option<Buffer>,
    pub(crate) class_ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    /// Where the roads meet the tile's border.
    pub(crate) ends: Vec<RoadEnd>,
}

impl RoadBuffers {
    /// Uploads a list, coded as instances.
    fn new<T>(gpu: &Gpu, list: &RoadList<T>, bytes: &[u8]) -> Self {
        let mut class_ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for (class, range) in FunctionalRoadClass::all().zip(&mut class_ranges) {
            *range = list.range_of(class);
        }
        let instances =
            (!bytes.is_empty()).then(|| gpu.buffer("roads", bytes, BufferUsages::VERTEX));
        Self { instances, class_ranges, ends: list.ends().to_vec() }
    }

    /// The instances of some classes, in as few pieces as may be.
    pub(crate) fn runs(&self, classes: ClassSet) -> Vec<Range<u32>> {
        let mut runs: Vec<Range<u32>> = Vec::new();
        for (class, range) in FunctionalRoadClass::all().zip(&self.class_ranges) {
            if range.is_empty() || !classes.contains(class) {
                continue;
            }
            match runs.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => runs.push(range.clone()),
            }
        }
        runs
    }
}

/// Bytes of one ground vertex: position as three f32, normal and skirt flag as four i8.
pub(crate) const GROUND_STRIDE: u64 = 16;
/// Bytes of one road segment: two plan positions as two f32 each, two shares, two slopes, a height and a width
/// factor as f32, class and flags as u32, eight bounds as f16.
pub(crate) const SEGMENT_STRIDE: u64 = 60;
/// Bytes of one road volume: two plan positions and two height ranges as two f32 each, rise and width factor as
/// f32, class and other tile as u32.
pub(crate) const VOLUME_STRIDE: u64 = 44;

impl TileBuffers {
    /// Uploads a tile.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry) -> Self {
        let buffer = |contents: &[u8], usage| gpu.buffer("tile", contents, usage);
        let all = tile.ground.indices.len() as u32;
        let surface = tile.ground.surface_indices as u32;
        let ground = (all > 0).then(|| GroundBuffers {
            vertices: buffer(&ground_bytes(tile), BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&tile.ground.indices), BufferUsages::INDEX),
            surface: 0..surface,
            skirts: surface..all,
            triangles: tile.ground.indices[..tile.ground.surface_indices].to_vec(),
            edges: OnceLock::new(),
        });
        let segments = RoadBuffers::new(gpu, &tile.roads, &segment_bytes(tile));
        let volumes = tile.volumes.all().iter().map(|volume| (*volume, 0));
        let volumes = RoadBuffers::new(gpu, &tile.volumes, &volume_bytes(volumes));
        Self {
            ground,
            segments,
            volumes,
            reference_m: tile.reference_m,
            width_margin_m: tile.width_margin_m,
            size_m: tile.size_m,
            id: tile.id,
            triangles: (tile.ground.surface_indices / 3) as u64,
        }
    }

    /// Triangles of its ground, skirts not counted.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        self.triangles
    }

    /// Segments of its roads that are drawn so.
    #[must_use]
    pub fn road_segments(&self, roads: RoadOptions) -> u64 {
        let drawn =
            self.roads(roads.method).into_iter().flat_map(|drawn| drawn.runs(roads.classes));
        drawn.map(|range| u64::from(range.end - range.start)).sum()
    }

    pub(crate) fn roads(&self, method: RoadMethod) -> Option<&RoadBuffers> {
        match method {
            RoadMethod::Geometry => Some(&self.segments),
            RoadMethod::ShadowVolumes => Some(&self.volumes),
            RoadMethod::None => None,
        }
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
        let Bed { slopes, rises, most_m, leaves_tile } = segment.bed;
        for pair in [segment.start_in_tile, segment.end_in_tile, segment.shares, slopes] {
            bytes.extend_from_slice(bytemuck::cast_slice(&pair));
        }
        bytes.extend_from_slice(&segment.height_in_tile.to_ne_bytes());
        bytes.extend_from_slice(&segment.width_factor.to_ne_bytes());
        let [at_start, at_end] = segment.has_caps;
        let flags = [at_start, at_end].into_iter().chain(leaves_tile);
        let flags = flags.zip(4..).fold(0, |flags, (flag, bit)| flags | u32::from(flag) << bit);
        bytes.extend_from_slice(&(u32::from(segment.class.number()) | flags).to_ne_bytes());
        for bound in [rises].iter().chain(&most_m).flatten() {
            bytes.extend_from_slice(&f16_above(*bound).to_ne_bytes());
        }
    }
    bytes
}

/// The bits of a 16-bit float that is not below a number from 0 up: the nearest such, or a little more.
fn f16_above(value: f32) -> u16 {
    // 2^-14, below which its digits get fewer, and the greatest there is.
    const LEAST: f32 = 6.103_515_6e-5;
    const MOST: f32 = 65_504.0;
    if value <= 0.0 {
        return 0;
    }
    // Both count exponent and digits in one number; the exponents differ by 112, the digits by 13 bits.
    let bits = value.clamp(LEAST, MOST).to_bits();
    (((bits + 0x1FFF) >> 13) - (112 << 10)) as u16
}

/// Volumes, each with the number of the other tile it belongs to, 0 for those that are no connectors.
pub(crate) fn volume_bytes(volumes: impl Iterator<Item = (RoadVolume, u32)>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(volumes.size_hint().0 * VOLUME_STRIDE as usize);
    for (volume, other) in volumes {
        bytes.extend_from_slice(bytemuck::cast_slice(&volume.start_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&volume.end_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&volume.height_range_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&volume.near.range_in_tile));
        bytes.extend_from_slice(&volume.near.rise.to_ne_bytes());
        bytes.extend_from_slice(&volume.width_factor.to_ne_bytes());
        let class = u32::from(volume.class.number());
        bytes.extend_from_slice(&(class | other << 4).to_ne_bytes());
    }
    bytes
}

#[cfg(test)]
#[path = "tile_buffers_tests.rs"]
mod tests;
