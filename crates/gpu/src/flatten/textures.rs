//! Textures.
//!
//! | words | texture |
//! |---|---|
//! | `Number`, number | the number everywhere |
//! | `Spectrum`, offset | a spectrum everywhere |
//! | `Program`, count, 0, 0, and for each operation 4 words: code, target, slots of operands, argument | a program |
//!
//! Slots of operands are bytes of a word. Arguments of codes are numbers or
//! offsets: of a spectrum, a direction, a mapping, or of one of these:
//!
//! | words | operation |
//! |---|---|
//! | pyramid, mapping, filter, largest anisotropy, scale, 1 where it is inverted, colour space or 0, type of spectrum | an image |
//! | mapping, octaves, roughness | fBm, turbulence |
//! | mapping, octaves, roughness, scale, variation, colour space | marble |
//!
//! A mapping to texture space is three rows of a matrix. One to the plane is its kind, three zeros
//! and numbers:
//!
//! | kind | numbers |
//! |---|---|
//! | linear | three columns of a matrix |
//! | spherical, cylindrical | the mapping to texture space |
//! | planar | the same, two axes, each with an offset |

use description::Span;
use image::TextureFilter;
use math::Transform;
use math::Vec2;
use scene::texture::{
    Code, FloatTextureId, Fractal, ImageLookup, Mapping2d, Operation, SpectrumTextureId, SpectrumType,
};
use spectrum::RgbColorSpace;

use super::Flattener;
use crate::tags::{CodeTag, LookupTag, MappingTag, SpectrumTypeTag, TextureTag};

impl Flattener<'_> {
    /// A texture of numbers, which a thing at `span` has; its offset.
    pub fn number_texture(&mut self, FloatTextureId(id): FloatTextureId, span: Span) -> u32 {
        self.texture(id, span)
    }

    /// A texture of spectra, which a thing at `span` has; its offset.
    pub fn spectrum_texture(&mut self, SpectrumTextureId(id): SpectrumTextureId, span: Span) -> u32 {
        self.texture(id, span)
    }

    fn texture(&mut self, id: u32, span: Span) -> u32 {
        if let Some(&at) = self.textures.get(&id) {
            return at;
        }
        let textures = self.scene.textures();
        let program = textures.programs()[id as usize];
        let operations = &textures.operations()[program.first as usize..][..program.length as usize];
        let at = match operations {
            [Operation { code: Code::Number(number), .. }] => {
                self.slab.add([TextureTag::Number as u32, number.to_bits()])
            }
            [Operation { code: Code::Spectrum(index), .. }] => {
                let spectrum = self.spectrum(&textures.spectra()[*index as usize]);
                self.slab.add([TextureTag::Spectrum as u32, spectrum])
            }
            operations => {
                self.parts.programs = true;
                let mut words = vec![TextureTag::Program as u32, operations.len() as u32, 0, 0];
                for operation in operations {
                    let (code, argument) = self.code(operation.code, span);
                    let slots = u32::from_le_bytes(operation.operands);
                    words.extend([code as u32, operation.target.into(), slots, argument]);
                }
                self.slab.add(words)
            }
        };
        self.textures.insert(id, at);
        at
    }

    /// The code of an operation, and its argument.
    fn code(&mut self, code: Code, span: Span) -> (CodeTag, u32) {
        let textures = self.scene.textures();
        self.parts.images |= matches!(code, Code::FloatImage(_) | Code::SpectrumImage(_));
        self.parts.noise |= matches!(
            code,
            Code::Dots(_) | Code::Fbm(_) | Code::Wrinkled(_) | Code::Windy(_) | Code::Marble(_)
        );
        match code {
            Code::Number(number) => (CodeTag::Number, number.to_bits()),
            Code::Spectrum(index) => (CodeTag::Spectrum, self.spectrum(&textures.spectra()[index as usize])),
            Code::Squares(index) => (CodeTag::Squares, self.mapping(index)),
            Code::Cubes(index) => (CodeTag::Cubes, self.solid_mapping(index)),
            Code::Facing(index) => {
                let direction = textures.directions()[index as usize];
                (CodeTag::Facing, self.slab.add_numbers(direction.to_array()))
            }
            Code::Step(edge) => (CodeTag::Step, edge.to_bits()),
            Code::Scale => (CodeTag::Scale, 0),
            Code::Mix => (CodeTag::Mix, 0),
            Code::Bilerp(index) => (CodeTag::Bilerp, self.mapping(index)),
            Code::FloatImage(index) => {
                let lookup = textures.float_images()[index as usize];
                (CodeTag::Image, self.image_texture(&lookup, [0, 0], span))
            }
            Code::SpectrumImage(index) => {
                let image = &textures.spectrum_images()[index as usize];
                let kind = match image.spectrum_type {
                    SpectrumType::Albedo => SpectrumTypeTag::Albedo,
                    SpectrumType::Unbounded => SpectrumTypeTag::Unbounded,
                    SpectrumType::Illuminant => SpectrumTypeTag::Illuminant,
                };
                let space = self.color_space(image.space);
                (CodeTag::Image, self.image_texture(&image.lookup, [space, kind as u32], span))
            }
            Code::Dots(index) => (CodeTag::Dots, self.mapping(index)),
            Code::Fbm(index) => (CodeTag::Fbm, self.fractal(textures.fractals()[index as usize], &[])),
            Code::Wrinkled(index) => {
                (CodeTag::Wrinkled, self.fractal(textures.fractals()[index as usize], &[]))
            }
            Code::Windy(index) => (CodeTag::Windy, self.solid_mapping(index)),
            Code::Marble(index) => {
                let marble = &textures.marbles()[index as usize];
                let space = self.color_space(RgbColorSpace::srgb());
                let more = [marble.scale.to_bits(), marble.variation.to_bits(), space];
                (CodeTag::Marble, self.fractal(marble.fractal, &more))
            }
        }
    }

    /// A lookup in an image, of a colour space and a type of spectrum; its offset.
    fn image_texture(&mut self, lookup: &ImageLookup, space: [u32; 2], span: Span) -> u32 {
        let &ImageLookup { mapping, pyramid: id, filter, scale, invert } = lookup;
        let pyramid = &self.scene.textures().pyramids()[id as usize];
        let pyramid = match self.pyramids.get(&id) {
            Some(&at) => at,
            None => self.image(pyramid.levels(), pyramid.wrap(), span),
        };
        self.pyramids.insert(id, pyramid);
        let mapping = self.mapping(mapping);
        let (filter, anisotropy) = match filter {
            TextureFilter::Point => (LookupTag::Point, 0.0),
            TextureFilter::Bilinear => (LookupTag::Bilinear, 0.0),
            TextureFilter::Trilinear => (LookupTag::Trilinear, 0.0),
            TextureFilter::Ewa { max_anisotropy } => (LookupTag::Ewa, max_anisotropy),
        };
        let [anisotropy, scale] = [anisotropy, scale].map(f32::to_bits);
        let [space, kind] = space;
        self.slab.add([pyramid, mapping, filter as u32, anisotropy, scale, invert.into(), space, kind])
    }

    /// A sum of noise; its offset.
    fn fractal(&mut self, fractal: Fractal, more: &[u32]) -> u32 {
        let mapping = self.solid_mapping(fractal.mapping);
        let words = [mapping, fractal.octaves, fractal.roughness.to_bits()];
        self.slab.add(words.into_iter().chain(more.iter().copied()))
    }

    /// A mapping to texture space; its offset.
    fn solid_mapping(&mut self, index: u32) -> u32 {
        let mapping = &self.scene.textures().solid_mappings()[index as usize];
        self.slab.add_numbers(rows(&mapping.texture_from_render))
    }

    /// A mapping to the plane; its offset.
    fn mapping(&mut self, index: u32) -> u32 {
        let (tag, numbers): (MappingTag, Vec<f32>) = match &self.scene.textures().mappings()[index as usize] {
            &Mapping2d::Uv { scale, delta } => {
                (MappingTag::Linear, flat(&[Vec2::new(scale.x, 0.0), Vec2::new(0.0, scale.y), delta]))
            }
            Mapping2d::Affine { columns } => (MappingTag::Linear, flat(columns)),
            Mapping2d::Spherical { texture_from_render } => {
                (MappingTag::Spherical, rows(texture_from_render))
            }
            Mapping2d::Cylindrical { texture_from_render } => {
                (MappingTag::Cylindrical, rows(texture_from_render))
            }
            Mapping2d::Planar { texture_from_render, axes, delta } => {
                let [s, t] = axes.map(|axis| axis.to_array());
                (
                    MappingTag::Planar,
                    [&rows(texture_from_render)[..], &s, &[delta.x], &t, &[delta.y]].concat(),
                )
            }
        };
        let at = self.slab.add([tag as u32, 0, 0, 0]);
        self.slab.extend_numbers(numbers);
        at
    }
}

/// The upper three rows of a matrix.
pub fn rows(transform: &Transform) -> Vec<f32> {
    let matrix = transform.matrix();
    [0, 1, 2].iter().flat_map(|&row| matrix.row(row).to_array()).collect()
}

fn flat(vectors: &[Vec2]) -> Vec<f32> {
    vectors.iter().flat_map(|v| v.to_array()).collect()
}
