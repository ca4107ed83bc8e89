//! Textures that are drawn on.

use wgpu::{Extent3d, TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor};

use super::pipelines::{COLOR, DEPTH, SAMPLES, SPRITE};
use super::sprites::{LAYERS, SIDE};

/// What a picture is drawn on.
pub struct Canvas {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples of colour, and of depth.
    pub samples: TextureView,
    pub depth: TextureView,
    /// The picture.
    pub picture: wgpu::Texture,
}

impl Canvas {
    /// One of a size.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let uses = drawn | TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING;
        let extent = extent(size, 1);
        Self {
            size,
            samples: view(&texture(device, "samples", extent, [1, SAMPLES], COLOR, drawn)),
            depth: view(&texture(device, "depth", extent, [1, SAMPLES], DEPTH, drawn)),
            picture: texture(device, "picture", extent, [1, 1], COLOR, uses),
        }
    }
}

/// The levels of a sprite's pyramid.
pub const LEVELS: u32 = SIDE.ilog2();

/// What sprites are drawn on.
pub struct Sheets {
    /// Samples of both textures, and of depth.
    pub samples: [TextureView; 2],
    pub depth: TextureView,
    /// One sprite. Some drivers resolve samples to the first layer of an array only, so that it is
    /// copied from here.
    pub sprite: [wgpu::Texture; 2],
    /// The sprites, each a layer of both.
    pub sheets: [wgpu::Texture; 2],
}

impl Sheets {
    /// Empty ones.
    pub fn new(device: &wgpu::Device) -> Self {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let size = extent([SIDE; 2], 1);
        let sheet = |format| {
            let uses = drawn | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
            texture(device, "sprites", extent([SIDE; 2], LAYERS), [LEVELS, 1], format, uses)
        };
        Self {
            samples: SPRITE.map(|format| view(&texture(device, "sprite", size, [1, SAMPLES], format, drawn))),
            depth: view(&texture(device, "depth of a sprite", size, [1, SAMPLES], DEPTH, drawn)),
            sprite: SPRITE.map(|format| {
                texture(device, "sprite", size, [1, 1], format, drawn | TextureUsages::COPY_SRC)
            }),
            sheets: SPRITE.map(sheet),
        }
    }

    /// A level of a layer of both, to draw on.
    pub fn level(&self, layer: u32, level: u32) -> [TextureView; 2] {
        self.views(wgpu::TextureViewDimension::D2, layer, level)
    }

    /// The same, as an array of one layer.
    pub fn array(&self, layer: u32, level: u32) -> [TextureView; 2] {
        self.views(wgpu::TextureViewDimension::D2Array, layer, level)
    }

    fn views(&self, dimension: wgpu::TextureViewDimension, layer: u32, level: u32) -> [TextureView; 2] {
        self.sheets.each_ref().map(|sheet| {
            sheet.create_view(&TextureViewDescriptor {
                dimension: Some(dimension),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        })
    }
}

fn extent([width, height]: [u32; 2], depth_or_array_layers: u32) -> Extent3d {
    Extent3d { width, height, depth_or_array_layers }
}

/// A texture of some levels and samples.
fn texture(
    device: &wgpu::Device,
    label: &str,
    size: Extent3d,
    [mip_level_count, sample_count]: [u32; 2],
    format: TextureFormat,
    usage: TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size,
        mip_level_count,
        sample_count,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn view(texture: &wgpu::Texture) -> TextureView {
    texture.create_view(&TextureViewDescriptor::default())
}
