//! The pipelines, and the layouts of what they are given.

use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    CompareFunction, DepthStencilState, MultisampleState, PrimitiveState, PrimitiveTopology, RenderPipeline,
    ShaderStages, TextureFormat, TextureSampleType, TextureViewDimension, VertexBufferLayout, VertexStepMode,
    vertex_attr_array,
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
    pub layouts: Layouts,
    pub surfaces: RenderPipeline,
    pub sky: RenderPipeline,
    pub water: RenderPipeline,
    pub sprites: RenderPipeline,
    /// Makes a sprite.
    pub bake: RenderPipeline,
    /// Makes the next level of a sprite's pyramid.
    pub reduce: RenderPipeline,
}

/// The layouts of groups.
pub struct Layouts {
    /// The camera, the sky and a sampler.
    pub eye: BindGroupLayout,
    /// The picture of the mirrored view.
    pub mirror: BindGroupLayout,
    /// The textures of sprites.
    pub album: BindGroupLayout,
}

/// Vertices, and rows of the matrices of instances.
const TRIANGLES: &[Option<VertexBufferLayout>] = &[
    Some(VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![
            0 => Float32x3, 1 => Snorm16x4, 2 => Unorm10_10_10_2, 3 => Unorm10_10_10_2
        ],
    }),
    Some(VertexBufferLayout {
        array_stride: 48,
        step_mode: VertexStepMode::Instance,
        attributes: &vertex_attr_array![4 => Float32x4, 5 => Float32x4, 6 => Float32x4],
    }),
];

/// The frames of sprites.
const FRAMES: &[Option<VertexBufferLayout>] = &[Some(VertexBufferLayout {
    array_stride: 64,
    step_mode: VertexStepMode::Instance,
    attributes: &vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4],
})];

/// A surface that covers a pixel in part is composited over the pixel; the nearness of that stays.
const OVER: BlendState = BlendState {
    color: BlendComponent::OVER,
    alpha: BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
};

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
            &device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("raster"), source });
        let layouts = Layouts::new(device);
        let Layouts { eye, mirror, album } = &layouts;
        let plain = Plan {
            entries: ["surface_vertex", "surface_fragment"],
            groups: &[Some(eye)],
            buffers: TRIANGLES,
            targets: &[COLOR],
            blend: None,
            depth: Some((CompareFunction::Greater, true)),
            topology: PrimitiveTopology::TriangleList,
        };
        let sky = Plan {
            entries: ["sky_vertex", "sky_fragment"],
            buffers: &[],
            depth: Some((CompareFunction::GreaterEqual, false)),
            ..plain
        };
        let water = Plan {
            entries: ["surface_vertex", "water_fragment"],
            groups: &[Some(eye), Some(mirror)],
            ..plain
        };
        let sprites = Plan {
            entries: ["sprite_vertex", "sprite_fragment"],
            groups: &[Some(eye), Some(album)],
            buffers: FRAMES,
            blend: Some(OVER),
            depth: Some((CompareFunction::Greater, false)),
            topology: PrimitiveTopology::TriangleStrip,
            ..plain
        };
        let bake = Plan { entries: ["surface_vertex", "bake_fragment"], targets: &SPRITE, ..plain };
        let reduce = Plan {
            entries: ["reduce_vertex", "reduce_fragment"],
            groups: &[Some(eye), Some(album)],
            buffers: &[],
            targets: &SPRITE,
            depth: None,
            ..plain
        };
        let [surfaces, sky, water, sprites, bake, reduce] =
            [plain, sky, water, sprites, bake, reduce].map(|plan| plan.pipeline(device, module));
        Self { layouts, surfaces, sky, water, sprites, bake, reduce }
    }
}

impl Plan<'_> {
    fn pipeline(&self, device: &wgpu::Device, module: &wgpu::ShaderModule) -> RenderPipeline {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let target = |format: &TextureFormat| {
            Some(ColorTargetState { format: *format, blend: self.blend, write_mask: ColorWrites::ALL })
        };
        let targets: Vec<_> = self.targets.iter().map(target).collect();
        let count = if self.depth.is_some() { SAMPLES } else { 1 };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.entries[1]),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(self.entries[0]),
                compilation_options: Default::default(),
                buffers: self.buffers,
            },
            primitive: PrimitiveState { topology: self.topology, ..Default::default() },
            depth_stencil: self.depth.map(|(compare, writes)| DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(writes),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: MultisampleState { count, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(self.entries[1]),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

impl Layouts {
    fn new(device: &wgpu::Device) -> Self {
        Self {
            eye: layout(device, &[None, Some(TextureViewDimension::Cube)], true),
            mirror: layout(device, &[Some(TextureViewDimension::D2)], false),
            album: layout(device, &[Some(TextureViewDimension::D2Array); 2], false),
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
