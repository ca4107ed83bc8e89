//! A scene in the memory of a GPU, and the passes over it.

use half::f16;
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, BufferUsages, CommandEncoder, Extent3d, LoadOp,
    Operations, RenderPass, RenderPassColorAttachment, RenderPassDepthStencilAttachment, StoreOp,
    TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

use super::canvas::{Canvas, LEVELS, Sheets};
use super::detail::Drawn;
use super::eye::Eye;
use super::models::{Model, Models, Vertex};
use super::pipelines::{COLOR, Pipelines};
use super::pond::Pond;
use super::sky::{self, Sky};
use super::sprites::Sprite;
use crate::device::{Copied, Device, GpuError};

/// The rows of the matrix that moves nothing.
const AT_REST: [[f32; 4]; 3] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Triangles in memory.
struct Mesh {
    vertices: Buffer,
    indices: Buffer,
    count: u32,
}

/// A scene in the memory of a GPU.
pub struct Painted {
    pipelines: Pipelines,
    models: Mesh,
    pond: Option<Mesh>,
    sky: TextureView,
    sampler: wgpu::Sampler,
    /// Two canvases, of the mirrored view and of the view.
    canvases: Option<[Canvas; 2]>,
    sheets: Option<Sheets>,
}

impl Painted {
    /// Takes it there.
    pub fn new(device: &Device, models: &Models, pond: Option<&Pond>, sky: &Sky) -> Result<Self, GpuError> {
        let (gpu, queue) = device.wgpu();
        let size = Extent3d { width: sky::SIDE, height: sky::SIDE, depth_or_array_layers: 6 };
        let descriptor = wgpu::TextureDescriptor {
            label: Some("sky"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: COLOR,
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let texels: Vec<u16> = sky.texels.iter().flatten().map(|x| x.to_bits()).collect();
        let texels = bytemuck::cast_slice(&texels);
        let cube = gpu.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, texels);
        let filter = wgpu::FilterMode::Linear;
        let painted = Self {
            pipelines: Pipelines::new(gpu),
            models: Mesh::new(device, &models.vertices, &models.indices)?,
            pond: match pond {
                Some(pond) => Some(Mesh::new(device, &pond.vertices, &pond.indices)?),
                None => None,
            },
            sky: cube.create_view(&TextureViewDescriptor {
                dimension: Some(TextureViewDimension::Cube),
                ..Default::default()
            }),
            sampler: gpu.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: filter,
                min_filter: filter,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            }),
            canvases: None,
            sheets: None,
        };
        device.checked(painted)
    }

    /// Makes sprites.
    pub fn bake(
        &mut self,
        device: &Device,
        light: &Eye,
        models: &[Model],
        missing: &[(Sprite, u32)],
    ) -> Result<(), GpuError> {
        let (gpu, queue) = device.wgpu();
        for (sprite, layer) in missing {
            let sheets = self.sheets.get_or_insert_with(|| Sheets::new(gpu));
            let model = &models[sprite.group as usize];
            let eye = light.of_clip(sprite.clip_from_group(model));
            let eye = bind_eye(gpu, &self.pipelines.layouts.eye, &eye, &self.sky, &self.sampler);
            let mut encoder = gpu.create_command_encoder(&Default::default());
            let [color, normal] =
                sheets.sprite.each_ref().map(|sprite| sprite.create_view(&Default::default()));
            let targets = [(&sheets.samples[0], Some(&color)), (&sheets.samples[1], Some(&normal))];
            let mut pass = begin(&mut encoder, &targets, Some(&sheets.depth));
            pass.set_pipeline(&self.pipelines.bake);
            pass.set_bind_group(0, &eye, &[]);
            let instances = buffer(gpu, bytemuck::bytes_of(&AT_REST), BufferUsages::VERTEX);
            self.models.set(&mut pass, &instances);
            pass.draw_indexed(model.indices.clone(), 0, 0..1);
            drop(pass);
            for (from, to) in sheets.sprite.iter().zip(&sheets.sheets) {
                let mut place = to.as_image_copy();
                place.origin.z = *layer;
                encoder.copy_texture_to_texture(from.as_image_copy(), place, from.size());
            }
            for level in 1..LEVELS {
                let [from, to] = [sheets.array(*layer, level - 1), sheets.level(*layer, level)];
                let from = bind(gpu, &self.pipelines.layouts.album, &from);
                let targets = [(&to[0], None), (&to[1], None)];
                let mut pass = begin(&mut encoder, &targets, None);
                pass.set_pipeline(&self.pipelines.reduce);
                pass.set_bind_group(0, &eye, &[]);
                pass.set_bind_group(1, &from, &[]);
                pass.draw(0..3, 0..1);
            }
            queue.submit([encoder.finish()]);
        }
        device.checked(())
    }

    /// Draws the mirrored view, if there is one, and the view; the colours of its pixels, row by
    /// row.
    pub fn draw(
        &mut self,
        device: &Device,
        size: [u32; 2],
        models: &[Model],
        mirrored: Option<&Drawn>,
        drawn: &Drawn,
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let (gpu, queue) = device.wgpu();
        if self.canvases.as_ref().is_none_or(|canvases| canvases[1].size != size) {
            // Nothing is drawn on that of the mirrored view where there is none.
            let small = mirrored.map_or([1, 1], |_| size);
            self.canvases = Some([small, size].map(|size| Canvas::new(gpu, size)));
        }
        let Some([mirror, canvas]) = &self.canvases else { return Ok(Vec::new()) };
        let mut encoder = gpu.create_command_encoder(&Default::default());
        let mut water = None;
        if let Some(drawn) = mirrored {
            self.view(gpu, &mut encoder, mirror, models, drawn, None);
            let picture = mirror.picture.create_view(&Default::default());
            water = Some(bind(gpu, &self.pipelines.layouts.mirror, &[picture]));
        }
        self.view(gpu, &mut encoder, canvas, models, drawn, water.as_ref());
        let [width, height] = size;
        // Rows of copies begin at multiples of 256 bytes.
        let stride = (8 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = gpu.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(stride) * u64::from(height),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            canvas.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &copy,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(stride),
                    rows_per_image: None,
                },
            },
            Extent3d { width, height, depth_or_array_layers: 1 },
        );
        let done = queue.submit([encoder.finish()]);
        let take = bytemuck::pod_collect_to_vec::<u8, u16>;
        let halves = device.contents(&Copied { copy, done }, take)?;
        let row = |row: &[u16]| {
            let pixels = row[..4 * width as usize].chunks_exact(4);
            pixels.map(|p| [p[0], p[1], p[2]].map(|bits| f16::from_bits(bits).to_f32())).collect::<Vec<_>>()
        };
        Ok(halves.chunks_exact(stride as usize / 2).flat_map(row).collect())
    }

    /// One pass: triangles, water, the sky, and sprites over all.
    fn view(
        &self,
        gpu: &wgpu::Device,
        encoder: &mut CommandEncoder,
        canvas: &Canvas,
        models: &[Model],
        drawn: &Drawn,
        water: Option<&BindGroup>,
    ) {
        let eye = bind_eye(gpu, &self.pipelines.layouts.eye, &drawn.eye, &self.sky, &self.sampler);
        let resolved = canvas.picture.create_view(&Default::default());
        let mut pass = begin(encoder, &[(&canvas.samples, Some(&resolved))], Some(&canvas.depth));
        pass.set_bind_group(0, &eye, &[]);
        if !drawn.instances.is_empty() {
            let instances = buffer(gpu, bytemuck::cast_slice(&drawn.instances), BufferUsages::VERTEX);
            pass.set_pipeline(&self.pipelines.surfaces);
            self.models.set(&mut pass, &instances);
            for (group, instances) in &drawn.groups {
                pass.draw_indexed(models[*group as usize].indices.clone(), 0, instances.clone());
            }
        }
        if let (Some(pond), Some(water)) = (&self.pond, water) {
            let instances = buffer(gpu, bytemuck::bytes_of(&AT_REST), BufferUsages::VERTEX);
            pass.set_pipeline(&self.pipelines.water);
            pass.set_bind_group(1, water, &[]);
            pond.set(&mut pass, &instances);
            pass.draw_indexed(0..pond.count, 0, 0..1);
        }
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..3, 0..1);
        if let (Some(sheets), false) = (&self.sheets, drawn.sprites.is_empty()) {
            let views = sheets.sheets.each_ref().map(|sheet| sheet.create_view(&Default::default()));
            let album = bind(gpu, &self.pipelines.layouts.album, &views);
            let instances = buffer(gpu, bytemuck::cast_slice(&drawn.sprites), BufferUsages::VERTEX);
            pass.set_pipeline(&self.pipelines.sprites);
            pass.set_bind_group(1, &album, &[]);
            pass.set_vertex_buffer(0, instances.slice(..));
            pass.draw(0..4, 0..drawn.sprites.len() as u32);
        }
    }
}

impl Mesh {
    fn new(device: &Device, vertices: &[Vertex], indices: &[u32]) -> Result<Self, GpuError> {
        let (gpu, _) = device.wgpu();
        let (bytes, limit) = (size_of_val(vertices) as u64, gpu.limits().max_buffer_size);
        if bytes > limit {
            return Err(GpuError::TooLarge("vertices", bytes, limit));
        }
        Ok(Self {
            vertices: buffer(gpu, bytemuck::cast_slice(vertices), BufferUsages::VERTEX),
            indices: buffer(gpu, bytemuck::cast_slice(indices), BufferUsages::INDEX),
            count: indices.len() as u32,
        })
    }

    fn set(&self, pass: &mut RenderPass, instances: &Buffer) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, instances.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
}

/// Begins a pass that clears what it draws on: targets with what their samples become.
fn begin<'a>(
    encoder: &'a mut CommandEncoder,
    targets: &[(&'a TextureView, Option<&'a TextureView>)],
    depth: Option<&TextureView>,
) -> RenderPass<'a> {
    let color = |target: &(&'a TextureView, Option<&'a TextureView>)| {
        let (view, resolve_target) = *target;
        let store = if resolve_target.is_some() { StoreOp::Discard } else { StoreOp::Store };
        let ops = Operations { load: LoadOp::Clear(wgpu::Color::TRANSPARENT), store };
        Some(RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops })
    };
    let colors: Vec<_> = targets.iter().map(color).collect();
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &colors,
        depth_stencil_attachment: depth.map(|view| RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// A buffer with contents, which are not empty.
fn buffer(gpu: &wgpu::Device, contents: &[u8], usage: BufferUsages) -> Buffer {
    let contents = if contents.is_empty() { &[0; 64] } else { contents };
    gpu.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
}

fn bind(gpu: &wgpu::Device, layout: &BindGroupLayout, views: &[TextureView]) -> BindGroup {
    let resources = views.iter().map(BindingResource::TextureView);
    group(gpu, layout, resources)
}

fn bind_eye(
    gpu: &wgpu::Device,
    layout: &BindGroupLayout,
    eye: &Eye,
    sky: &TextureView,
    sampler: &wgpu::Sampler,
) -> BindGroup {
    let eye = buffer(gpu, bytemuck::bytes_of(eye), BufferUsages::UNIFORM);
    let resources =
        [eye.as_entire_binding(), BindingResource::TextureView(sky), BindingResource::Sampler(sampler)];
    group(gpu, layout, resources)
}

fn group<'a>(
    gpu: &wgpu::Device,
    layout: &BindGroupLayout,
    resources: impl IntoIterator<Item = BindingResource<'a>>,
) -> BindGroup {
    let entries = (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
    let entries: Vec<_> = entries.collect();
    gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
