//! The ground of tiles: its triangles, its skirts and, if asked for, the edges of its triangles.

use std::{ops::Range, sync::OnceLock};

use wgpu::{
    Buffer, BufferUsages, ColorWrites, CompareFunction, DepthStencilState, Device, IndexFormat,
    PrimitiveTopology, RenderPass, RenderPipeline, VertexBufferLayout, VertexStepMode,
    vertex_attr_array,
};

use super::super::{
    Gpu,
    formats::{COLOR, DEPTH, OWNER},
    pipeline::{ENTRIES, PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
};
use crate::{
    frame_view::Wireframe,
    tiles::{GroundMesh, GroundVertex},
};

pub(crate) const SHADER: Shader = shader!("terrain": "common", "terrain");

/// Bytes of a vertex: position as three f32, normal and skirt flag as four i8.
const VERTEX_BYTES: u64 = 16;

/// Draws the ground of tiles.
pub(crate) struct Terrain {
    surface: RenderPipeline,
    skirts: RenderPipeline,
    wires: RenderPipeline,
}

/// The ground of a tile on the graphics card.
pub(crate) struct GroundBuffers {
    vertices: Buffer,
    indices: Buffer,
    /// The indices of the ground, then those of the skirts.
    surface: Range<u32>,
    skirts: Range<u32>,
    /// Three indices for each triangle of the ground, from which the edges are made.
    triangles: Vec<u32>,
    edges: OnceLock<Buffer>,
}

impl Terrain {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let groups = [Some(&layouts.frame), Some(&layouts.tile)];
        let attributes = vertex_attr_array![0 => Float32x3, 1 => Snorm8x4];
        let ground = |constants| PipelineRecipe {
            shader: SHADER,
            entries: ENTRIES,
            groups: &groups,
            buffer: Some(VertexBufferLayout {
                array_stride: VERTEX_BYTES,
                step_mode: VertexStepMode::Vertex,
                attributes: &attributes,
            }),
            topology: PrimitiveTopology::TriangleList,
            // From below the ground its underside is seen.
            cull: None,
            // Depth is reversed: nearer is greater.
            depth: Some(depth(CompareFunction::Greater, true)),
            targets: &[(COLOR, ColorWrites::ALL), (OWNER, ColorWrites::ALL)],
            blend: None,
            constants,
        };
        let wires = PipelineRecipe {
            entries: ["vertex", "wire_fragment"],
            topology: PrimitiveTopology::LineList,
            depth: Some(depth(CompareFunction::GreaterEqual, false)),
            // Alpha and owner still say that there is ground.
            targets: &[(COLOR, ColorWrites::COLOR), (OWNER, ColorWrites::empty())],
            ..ground(&[("PULL_PX", 2.0)])
        };
        Self {
            surface: ground(&[("SKIRT", 0.0)]).build(device),
            skirts: ground(&[("SKIRT", 1.0)]).build(device),
            wires: wires.build(device),
        }
    }

    /// Draws the ground of some tiles, each given with its index in the list of tiles of the frame.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        tiles: &[(usize, &GroundBuffers)],
        wireframe: Wireframe,
    ) {
        shared.set_frame(pass);
        for is_skirts in [false, true] {
            pass.set_pipeline(if is_skirts { &self.skirts } else { &self.surface });
            for (index, ground) in tiles {
                let part = if is_skirts { &ground.skirts } else { &ground.surface };
                shared.set_tile(pass, *index);
                ground.draw(pass, &ground.indices, part.clone());
            }
        }
        if wireframe == Wireframe::Shown {
            pass.set_pipeline(&self.wires);
            for (index, ground) in tiles {
                let edges = ground.edges(gpu);
                shared.set_tile(pass, *index);
                ground.draw(pass, edges, 0..(edges.size() / 4) as u32);
            }
        }
    }
}

/// A test against the depth buffer, which may also write it.
fn depth(compare: CompareFunction, is_written: bool) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

impl GroundBuffers {
    /// Uploads the ground of a tile; `None` if there is none.
    pub(crate) fn new(gpu: &Gpu, mesh: &GroundMesh) -> Option<Self> {
        let buffer = |contents: &[u8], usage| gpu.buffer("tile", contents, usage);
        let all = mesh.indices.len() as u32;
        let surface = mesh.surface_indices as u32;
        (all > 0).then(|| Self {
            vertices: buffer(&vertex_bytes(&mesh.vertices), BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&mesh.indices), BufferUsages::INDEX),
            surface: 0..surface,
            skirts: surface..all,
            triangles: mesh.indices[..mesh.surface_indices].to_vec(),
            edges: OnceLock::new(),
        })
    }

    /// Bytes of the buffers that [`GroundBuffers::new`] makes of a mesh.
    pub(crate) fn bytes_of(mesh: &GroundMesh) -> u64 {
        mesh.vertices.len() as u64 * VERTEX_BYTES
            + mesh.indices.len() as u64 * size_of::<u32>() as u64
    }

    /// Bytes of its buffers; the edges count once they have been drawn.
    pub(crate) fn gpu_bytes(&self) -> u64 {
        let buffers = [&self.vertices, &self.indices].into_iter().chain(self.edges.get());
        buffers.map(Buffer::size).sum()
    }

    /// Two indices for each edge of the ground. The buffer is made when the edges are first drawn, because few pictures
    /// show them.
    fn edges(&self, gpu: &Gpu) -> &Buffer {
        self.edges.get_or_init(|| {
            gpu.buffer("edges", bytemuck::cast_slice(&edges(&self.triangles)), BufferUsages::INDEX)
        })
    }

    fn draw(&self, pass: &mut RenderPass<'_>, indices: &Buffer, part: Range<u32>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(part, 0, 0..1);
    }
}

/// Each edge of some triangles, once.
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

fn vertex_bytes(vertices: &[GroundVertex]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(vertices.len() * VERTEX_BYTES as usize);
    for vertex in vertices {
        bytes.extend_from_slice(bytemuck::cast_slice(&vertex.position_in_tile));
        bytes.extend_from_slice(bytemuck::cast_slice(&vertex.normal_skirt));
    }
    bytes
}

#[cfg(test)]
#[path = "terrain_tests.rs"]
mod tests;
