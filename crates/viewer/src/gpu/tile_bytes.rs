use super::tile_buffers::{GROUND_STRIDE, SEGMENT_STRIDE, VOLUME_STRIDE};
use crate::tiles::TileGeometry;

/// Bytes that a tile takes on the graphics card, told before it is there. Its wireframe is not counted: it is made
/// when it is first shown.
#[must_use]
pub fn tile_bytes(tile: &TileGeometry) -> u64 {
    tile.ground.vertices.len() as u64 * GROUND_STRIDE
        + tile.ground.indices.len() as u64 * size_of::<u32>() as u64
        + tile.roads.all().len() as u64 * SEGMENT_STRIDE
        + tile.volumes.all().len() as u64 * VOLUME_STRIDE
}

impl super::TileBuffers {
    /// Bytes of its buffers on the graphics card, with its wireframe if that was shown.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        let ground = self.ground.iter().flat_map(|ground| {
            [&ground.vertices, &ground.indices].into_iter().chain(ground.drawn_edges())
        });
        let roads = [&self.segments, &self.volumes].into_iter().flat_map(|r| &r.instances);
        ground.chain(roads).map(wgpu::Buffer::size).sum()
    }
}
