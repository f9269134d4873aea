//! Builds render pipelines from recipes, and joins shaders from their files.

use wgpu::{
    BindGroupLayout, BlendState, ColorWrites, CompareFunction, DepthStencilState, Device,
    FrontFace, PrimitiveTopology, RenderPipeline, VertexAttribute, VertexBufferLayout,
    VertexStepMode,
};

use super::formats::{COLOR, DEPTH};

/// A shader: its name and its complete text.
pub(crate) type Shader = (&'static str, &'static str);

/// Defines a [`Shader`]: its name, then the files of `shaders/` that are joined into its text, in
/// this order, without their comments. WGSL has no `include`, so declarations that several shaders
/// need are in files of their own. For use in `drawables/`.
macro_rules! shader {
    ($name:literal: $($file:literal),+) => {
        ($name, concat!($(include_str!(concat!(env!("OUT_DIR"), "/shaders/", $file, ".wgsl"))),+))
    };
}
pub(crate) use shader;

/// Names of the vertex and fragment stages in most shaders.
pub(crate) const ENTRIES: [&str; 2] = ["vertex", "fragment"];

/// A test against the depth buffer of the ground, which the pipeline may also write. Depth is
/// reversed: nearer is greater.
pub(crate) fn depth_test(compare: CompareFunction, is_written: bool) -> DepthStencilState {
    DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// The layout of vertices, or instances, of type `T`.
pub(crate) const fn vertex_layout<T>(
    step_mode: VertexStepMode,
    attributes: &[VertexAttribute],
) -> VertexBufferLayout<'_> {
    VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes }
}

/// The parameters in which pipelines differ.
#[derive(Clone)]
pub(crate) struct PipelineRecipe<'a> {
    pub(crate) shader: Shader,
    /// Names of the vertex and the fragment shader.
    pub(crate) entries: [&'a str; 2],
    pub(crate) groups: &'a [Option<&'a BindGroupLayout>],
    pub(crate) buffer: Option<VertexBufferLayout<'a>>,
    pub(crate) topology: PrimitiveTopology,
    /// Winding order of front faces.
    pub(crate) front_face: FrontFace,
    pub(crate) cull: Option<wgpu::Face>,
    pub(crate) depth: Option<DepthStencilState>,
    pub(crate) targets: &'a [(wgpu::TextureFormat, ColorWrites)],
    pub(crate) blend: Option<BlendState>,
    pub(crate) constants: &'a [(&'a str, f64)],
}

impl<'a> PipelineRecipe<'a> {
    /// A recipe for triangles, such as one over a whole picture: draws colours, both sides, without
    /// depth test.
    pub(crate) fn new(
        shader: Shader,
        groups: &'a [Option<&'a BindGroupLayout>],
        constants: &'a [(&'a str, f64)],
    ) -> Self {
        Self {
            shader,
            entries: ENTRIES,
            groups,
            buffer: None,
            topology: PrimitiveTopology::TriangleList,
            front_face: FrontFace::Ccw,
            cull: None,
            depth: None,
            targets: &[(COLOR, ColorWrites::ALL)],
            blend: None,
            constants,
        }
    }

    /// Compiles the shader and creates the pipeline.
    pub(crate) fn build(&self, device: &Device) -> RenderPipeline {
        let (name, source) = self.shader;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let options =
            wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let targets: Vec<_> = self
            .targets
            .iter()
            .map(|(format, write_mask)| {
                Some(wgpu::ColorTargetState {
                    format: *format,
                    blend: self.blend,
                    write_mask: *write_mask,
                })
            })
            .collect();
        let buffers: Vec<_> = self.buffer.iter().cloned().map(Some).collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.entries[0]),
                compilation_options: options.clone(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                front_face: self.front_face,
                cull_mode: self.cull,
                ..Default::default()
            },
            depth_stencil: self.depth.clone(),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.entries[1]),
                compilation_options: options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
