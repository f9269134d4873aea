use wgpu::{CommandEncoder, IndexFormat};

use super::{
    Gpu,
    bindings::FrameBindings,
    renderer::{DrawTile, Renderer, begin},
    targets::Targets,
};
use crate::frame_view::{FrameView, Wireframe};

impl Renderer {
    pub(crate) fn terrain_pass(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        bindings: &FrameBindings,
        tiles: &[DrawTile<'_>],
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        let Targets { ground, depth, owners, .. } = targets;
        let mut pass = begin(encoder, "terrain", &[&ground.view, &owners.view], Some(&depth.view));
        pass.set_bind_group(0, &bindings.frame, &[]);
        for is_skirts in [false, true] {
            let pipelines = &self.pipelines;
            pass.set_pipeline(if is_skirts { &pipelines.skirts } else { &pipelines.terrain });
            for (index, tile) in tiles.iter().enumerate() {
                let Some(ground) = &tile.buffers.ground else { continue };
                let part = if is_skirts { &ground.skirts } else { &ground.surface };
                bindings.set_tile(&mut pass, index);
                pass.set_vertex_buffer(0, ground.vertices.slice(..));
                pass.set_index_buffer(ground.indices.slice(..), IndexFormat::Uint32);
                pass.draw_indexed(part.clone(), 0, 0..1);
            }
        }
        if view.wireframe == Wireframe::Shown {
            pass.set_pipeline(&self.pipelines.wires);
            for (index, tile) in tiles.iter().enumerate() {
                let Some(ground) = &tile.buffers.ground else { continue };
                let edges = ground.edges(gpu);
                bindings.set_tile(&mut pass, index);
                pass.set_vertex_buffer(0, ground.vertices.slice(..));
                pass.set_index_buffer(edges.slice(..), IndexFormat::Uint32);
                pass.draw_indexed(0..(edges.size() / 4) as u32, 0, 0..1);
            }
        }
    }
}
