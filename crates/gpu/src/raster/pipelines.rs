//! The pipelines, and the layouts of what they are given.

use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    CompareFunction, DepthStencilState, MultisampleState, PrimitiveState, PrimitiveTopology, RenderPipeline,
    ShaderStages, TextureFormat, TextureSampleType, TextureViewDimension, VertexAttribute,
    VertexBufferLayout, VertexFormat, VertexStepMode,
};

use super::models::Vertex;
use crate::shaders;

/// Of pictures.
pub const COLOR: TextureFormat = TextureFormat::Rgba16Float;

/// Of the two textures of sprites.
pub const SPRITE: [TextureFormat; 2] = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm];

/// Of depth.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Samples of a pixel, which share its shading.
pub const SAMPLES: u32 = 4;

/// All pipelines.
pub struct Pipelines {
    /// The camera, the sky and a sampler.
    pub eye: BindGroupLayout,
    /// The picture of the mirrored view.
    pub mirror: BindGroupLayout,
    /// The textures of sprites.
    pub album: BindGroupLayout,
    pub surfaces: RenderPipeline,
    pub sky: RenderPipeline,
    pub water: RenderPipeline,
    pub sprites: RenderPipeline,
    /// Makes a sprite.
    pub bake: RenderPipeline,
    /// Makes the next level of a sprite's pyramid.
    pub reduce: RenderPipeline,
}

/// What distinguishes a pipeline.
struct Plan<'a> {
    entries: [&'a str; 2],
    groups: &'a [Option<&'a BindGroupLayout>],
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    targets: &'a [TextureFormat],
    blend: Option<BlendState>,
    /// How depth is compared, and whether it is written.
    depth: Option<(CompareFunction, bool)>,
    topology: PrimitiveTopology,
}

impl Pipelines {
    /// Compiles them.
    pub fn new(device: &wgpu::Device) -> Self {
        let source = wgpu::ShaderSource::Wgsl(shaders::raster().into());
        let module =
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("raster"), source });
        let [eye, mirror, album] = [
            layout(device, &[None, Some(TextureViewDimension::Cube)], true),
            layout(device, &[Some(TextureViewDimension::D2)], false),
            layout(device, &[Some(TextureViewDimension::D2Array); 2], false),
        ];
        let vertices = attributes(
            0,
            &[
                VertexFormat::Float32x3,
                VertexFormat::Snorm16x4,
                VertexFormat::Unorm10_10_10_2,
                VertexFormat::Unorm10_10_10_2,
            ],
        );
        let rows = attributes(4, &[VertexFormat::Float32x4; 3]);
        let frames = attributes(0, &[VertexFormat::Float32x4; 4]);
        let triangles = [
            Some(buffer(size_of::<Vertex>(), VertexStepMode::Vertex, &vertices)),
            Some(buffer(48, VertexStepMode::Instance, &rows)),
        ];
        let sprites = [Some(buffer(64, VertexStepMode::Instance, &frames))];
        let make = |plan: Plan| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: plan.groups,
                immediate_size: 0,
            });
            let target = |format: &TextureFormat| {
                Some(ColorTargetState { format: *format, blend: plan.blend, write_mask: ColorWrites::ALL })
            };
            let targets: Vec<_> = plan.targets.iter().map(target).collect();
            let count = if plan.depth.is_some() { SAMPLES } else { 1 };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(plan.entries[1]),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(plan.entries[0]),
                    compilation_options: Default::default(),
                    buffers: plan.buffers,
                },
                primitive: PrimitiveState { topology: plan.topology, ..Default::default() },
                depth_stencil: plan.depth.map(|(compare, writes)| DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(writes),
                    depth_compare: Some(compare),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: MultisampleState { count, ..Default::default() },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(plan.entries[1]),
                    compilation_options: Default::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let plain = Plan {
            entries: ["surface_vertex", "surface_fragment"],
            groups: &[Some(&eye)],
            buffers: &triangles,
            targets: &[COLOR],
            blend: None,
            depth: Some((CompareFunction::Greater, true)),
            topology: PrimitiveTopology::TriangleList,
        };
        // What covers a pixel in part is over what is there; the nearness of that stays.
        let over = |src_factor, dst_factor| BlendComponent {
            src_factor,
            dst_factor,
            operation: BlendOperation::Add,
        };
        let blend = BlendState {
            color: over(BlendFactor::One, BlendFactor::OneMinusSrcAlpha),
            alpha: over(BlendFactor::Zero, BlendFactor::One),
        };
        Self {
            sky: make(Plan {
                entries: ["sky_vertex", "sky_fragment"],
                buffers: &[],
                depth: Some((CompareFunction::GreaterEqual, false)),
                ..plain
            }),
            water: make(Plan {
                entries: ["surface_vertex", "water_fragment"],
                groups: &[Some(&eye), Some(&mirror)],
                ..plain
            }),
            sprites: make(Plan {
                entries: ["sprite_vertex", "sprite_fragment"],
                groups: &[Some(&eye), Some(&album)],
                buffers: &sprites,
                blend: Some(blend),
                depth: Some((CompareFunction::Greater, false)),
                topology: PrimitiveTopology::TriangleStrip,
                ..plain
            }),
            bake: make(Plan { entries: ["surface_vertex", "bake_fragment"], targets: &SPRITE, ..plain }),
            reduce: make(Plan {
                entries: ["reduce_vertex", "reduce_fragment"],
                groups: &[Some(&eye), Some(&album)],
                buffers: &[],
                targets: &SPRITE,
                depth: None,
                ..plain
            }),
            surfaces: make(plain),
            eye,
            mirror,
            album,
        }
    }
}

/// The layout of a group: a uniform buffer for `None`, textures that are filtered, and perhaps a
/// sampler.
fn layout(device: &wgpu::Device, parts: &[Option<TextureViewDimension>], samples: bool) -> BindGroupLayout {
    let part = |dimension: &Option<TextureViewDimension>| match *dimension {
        None => wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        Some(view_dimension) => wgpu::BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: true },
            view_dimension,
            multisampled: false,
        },
    };
    let sampler = samples.then_some(wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering));
    let entries: Vec<_> = parts.iter().map(part).chain(sampler).zip(0..).collect();
    let entry = |(ty, binding)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let entries: Vec<_> = entries.into_iter().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// Attributes that follow each other, from a location on.
fn attributes(first: u32, formats: &[VertexFormat]) -> Vec<VertexAttribute> {
    let mut offset = 0;
    let attribute = |(format, shader_location): (&VertexFormat, u32)| {
        let attribute = VertexAttribute { format: *format, offset, shader_location };
        offset += format.size();
        attribute
    };
    formats.iter().zip(first..).map(attribute).collect()
}

fn buffer(
    stride: usize,
    step_mode: VertexStepMode,
    attributes: &[VertexAttribute],
) -> VertexBufferLayout<'_> {
    VertexBufferLayout { array_stride: stride as u64, step_mode, attributes }
}
