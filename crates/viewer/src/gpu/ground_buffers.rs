//! GPU buffers of the ground of a tile, which any drawable may draw with its own pipeline.

use std::{ops::Range, sync::OnceLock};

use wgpu::{
    Buffer, BufferUsages, IndexFormat, RenderPass, VertexBufferLayout, VertexStepMode,
    vertex_attr_array,
};

use super::{Gpu, pipeline::vertex_layout};
use crate::tiles::{GroundMesh, GroundVertex};

/// The vertex layout of [`GroundBuffers`] for pipelines: position, normal and skirt flag.
pub(crate) const GROUND_VERTICES: VertexBufferLayout<'static> = vertex_layout::<GroundVertex>(
    VertexStepMode::Vertex,
    &vertex_attr_array![0 => Float32x3, 1 => Snorm8x4],
);

/// The ground of a tile on the GPU.
pub(crate) struct GroundBuffers {
    vertices: Buffer,
    indices: Buffer,
    index_format: IndexFormat,
    /// Indices of the ground; they are followed by the indices of the skirts, then of the edges of
    /// the ground inside the tile.
    pub(crate) surface: Range<u32>,
    pub(crate) skirts: Range<u32>,
    /// Indices of the skirts and of all that follows: everywhere the ground may end.
    pub(crate) walls: Range<u32>,
    /// Three indices for each triangle of the ground; the wireframe is built from them.
    triangles: Vec<u32>,
    edges: OnceLock<Buffer>,
}

impl GroundBuffers {
    /// Uploads the ground of a tile; `None` if the tile has no ground.
    pub(crate) fn new(gpu: &Gpu, mesh: &GroundMesh) -> Option<Self> {
        let buffer = |contents: &[u8], usage| gpu.buffer("tile", contents, usage);
        let all = mesh.indices.len() as u32;
        let surface = mesh.surface_indices as u32;
        let index_format = index_format(mesh);
        (all > 0).then(|| Self {
            vertices: buffer(bytemuck::cast_slice(&mesh.vertices), BufferUsages::VERTEX),
            indices: buffer(&index_bytes(&mesh.indices, index_format), BufferUsages::INDEX),
            index_format,
            surface: 0..surface,
            skirts: surface..mesh.skirt_indices as u32,
            walls: surface..all,
            triangles: mesh.indices[..mesh.surface_indices].to_vec(),
            edges: OnceLock::new(),
        })
    }

    /// Size of the buffers that [`GroundBuffers::new`] creates for a mesh, bytes.
    pub(crate) fn bytes_of(mesh: &GroundMesh) -> u64 {
        size_of_val(&mesh.vertices[..]) as u64
            + index_buffer_bytes(mesh.indices.len() as u64, index_format(mesh))
    }

    /// Size of the buffers, bytes; the wireframe counts once it has been drawn.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        let buffers = [&self.vertices, &self.indices].into_iter().chain(self.edges.get());
        buffers.map(Buffer::size).sum()
    }

    /// Draws a range of the triangles. The caller sets pipeline and bind groups.
    pub(crate) fn draw_part(&self, pass: &mut RenderPass<'_>, part: &Range<u32>) {
        self.draw(pass, (&self.indices, self.index_format), part.clone());
    }

    /// Draws the edges of the ground's triangles as lines. The caller sets pipeline and bind
    /// groups. The buffer with two indices for each edge is created at the first use, because few
    /// pictures show edges.
    pub(crate) fn draw_edges(&self, gpu: &Gpu, pass: &mut RenderPass<'_>) {
        let edges = self.edges.get_or_init(|| {
            gpu.buffer("edges", bytemuck::cast_slice(&edges(&self.triangles)), BufferUsages::INDEX)
        });
        self.draw(pass, (edges, IndexFormat::Uint32), 0..(edges.size() / 4) as u32);
    }

    fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        (indices, format): (&Buffer, IndexFormat),
        part: Range<u32>,
    ) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), format);
        pass.draw_indexed(part, 0, 0..1);
    }
}

/// Two bytes per index if the number of vertices allows it, otherwise four. The largest two-byte
/// number has a special meaning in triangle strips and is not used.
fn index_format(mesh: &GroundMesh) -> IndexFormat {
    if u16::try_from(mesh.vertices.len()).is_ok() {
        IndexFormat::Uint16
    } else {
        IndexFormat::Uint32
    }
}

/// Size of this many indices in bytes, rounded up to a multiple of 4 as buffers need it.
fn index_buffer_bytes(indices: u64, format: IndexFormat) -> u64 {
    (indices * u64::from(format.byte_size())).next_multiple_of(4)
}

/// The contents of the index buffer.
fn index_bytes(indices: &[u32], format: IndexFormat) -> Vec<u8> {
    let mut bytes = match format {
        // All indices are below the number of vertices.
        IndexFormat::Uint16 => {
            let short: Vec<u16> = indices.iter().map(|at| *at as u16).collect();
            bytemuck::cast_slice(&short).to_vec()
        }
        IndexFormat::Uint32 => bytemuck::cast_slice(indices).to_vec(),
    };
    bytes.resize(index_buffer_bytes(indices.len() as u64, format) as usize, 0);
    bytes
}

/// The edges of some triangles, each once.
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

#[cfg(test)]
#[path = "ground_buffers_tests.rs"]
mod tests;
