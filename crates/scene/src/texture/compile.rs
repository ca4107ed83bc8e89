//! From what the author said of textures to the tables.
//!
//! The author's textures come first in the tables and in the author's order, so that a handle is an
//! id. A texture of spectra comes once for each [`SpectrumType`], as only its use decides what its
//! colours stand for. A texture that is wrong, or not drawn yet, is reported and replaced by a
//! stand-in.

use super::{
    Bilerp, Checkerboard, FloatImage, FloatTexture, FloatTextureId, ImageLookup, Mapping2d, Mapping3d,
    SpectrumImage, SpectrumTexture, SpectrumTextureId, SpectrumType, Texture, Textures, compile_spectrum,
    pyramids::Pyramids,
};
use description::{
    Arena, Diagnostic, FloatParameter, Handle, ImageDesc, ImageTextureDesc, MappingDesc, Origin, Parameter,
    SceneDesc, Span, SpectrumDesc, SpectrumParameter, Stated, TextureDesc, TextureKind,
};
use image::TextureFilter;
use math::{DMat4, Transform, Vec2};
use spectrum::{RgbColorSpace, Spectrum};

/// How many textures a texture may depend on in a row; evaluation recurs as deeply.
const MAX_DEPTH: u32 = 64;

/// All textures of a scene. What is wrong with them, or not drawn, is added to `diagnostics`.
pub fn compile(desc: &SceneDesc, render_from_world: &DMat4, diagnostics: &mut Vec<Diagnostic>) -> Textures {
    let types = SpectrumType::ALL;
    let textures = Textures {
        float: vec![Texture::Constant(0.0); desc.float_textures.len()],
        spectrum: vec![Texture::Constant(Spectrum::ZERO); types.len() * desc.spectrum_textures.len()],
    };
    let pyramids = Pyramids::new(&desc.images);
    let mut compiler = Compiler { textures, pyramids, images: &desc.images, render_from_world, diagnostics };

    let mut float_depths = Vec::with_capacity(desc.float_textures.len());
    for (handle, texture) in desc.float_textures.iter() {
        let depth = depth(texture, &float_depths, &float_depths, compiler.diagnostics);
        if depth.is_some() {
            compiler.textures.float[handle.index()] = compiler.texture(texture, ());
        }
        float_depths.push(depth.unwrap_or(0));
    }
    let mut spectrum_depths = Vec::with_capacity(desc.spectrum_textures.len());
    for (handle, texture) in desc.spectrum_textures.iter() {
        let depth = depth(texture, &spectrum_depths, &float_depths, compiler.diagnostics);
        if depth.is_some() {
            for (i, &spectrum_type) in types.iter().enumerate() {
                let reported = compiler.diagnostics.len();
                let id = SpectrumDesc::id(handle, spectrum_type);
                compiler.textures.spectrum[id.0 as usize] = compiler.texture(texture, spectrum_type);
                if i > 0 {
                    compiler.diagnostics.truncate(reported);
                }
            }
        }
        spectrum_depths.push(depth.unwrap_or(0));
    }
    compiler.textures
}

impl Textures {
    /// The texture of a parameter of the scene that these textures were compiled from.
    pub fn float_parameter(&mut self, parameter: &FloatParameter) -> FloatTextureId {
        match parameter {
            Parameter::Value(value) => self.push_float(Texture::Constant(*value)),
            Parameter::Texture(handle) => f32::id(*handle, ()),
        }
    }

    /// The texture of a parameter of the scene that these textures were compiled from, given at
    /// `span`, whose colours stand for a `spectrum_type`. What makes no sense is added to
    /// `diagnostics`.
    pub fn spectrum_parameter(
        &mut self,
        parameter: &SpectrumParameter,
        spectrum_type: SpectrumType,
        span: Span,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> SpectrumTextureId {
        match parameter {
            Parameter::Value(value) => {
                let spectrum = compile_spectrum(value, spectrum_type, span, diagnostics);
                self.push_spectrum(Texture::Constant(spectrum))
            }
            Parameter::Texture(handle) => SpectrumDesc::id(*handle, spectrum_type),
        }
    }
}

/// The texture that gives a sort of values.
type TextureOf<V> = Texture<<V as Value>::Constant, <V as Value>::Id, <V as Value>::Image>;

/// The two sorts of values that textures give, as the author says them: numbers and spectra.
trait Value: From<f32> + Clone {
    /// What the value stands for.
    type Use: Copy;
    type Constant: Clone;
    type Id: Copy;
    type Image;

    fn constant(&self, usage: Self::Use, span: Span, diagnostics: &mut Vec<Diagnostic>) -> Self::Constant;
    fn id(handle: Handle<TextureDesc<Self>>, usage: Self::Use) -> Self::Id;
    fn push(textures: &mut Textures, texture: TextureOf<Self>) -> Self::Id;
    fn image(lookup: ImageLookup, image: &ImageDesc, usage: Self::Use) -> Self::Image;
    /// Whether images keep their colours.
    const IN_COLOR: bool;
}

impl Value for f32 {
    type Use = ();
    type Constant = f32;
    type Id = FloatTextureId;
    type Image = FloatImage;
    const IN_COLOR: bool = false;

    fn constant(&self, (): (), span: Span, diagnostics: &mut Vec<Diagnostic>) -> f32 {
        if !self.is_finite() {
            let message = format!("{self} is no value for a texture");
            diagnostics.push(Diagnostic::error("invalid-value", message, span));
        }
        *self
    }

    fn id(handle: Handle<TextureDesc<f32>>, (): ()) -> FloatTextureId {
        FloatTextureId(handle.index() as u32)
    }

    fn push(textures: &mut Textures, texture: FloatTexture) -> FloatTextureId {
        textures.push_float(texture)
    }

    fn image(lookup: ImageLookup, _: &ImageDesc, (): ()) -> FloatImage {
        FloatImage { lookup }
    }
}

impl Value for SpectrumDesc {
    type Use = SpectrumType;
    type Constant = Spectrum;
    type Id = SpectrumTextureId;
    type Image = SpectrumImage;
    const IN_COLOR: bool = true;

    fn constant(&self, usage: SpectrumType, span: Span, diagnostics: &mut Vec<Diagnostic>) -> Spectrum {
        // Which colours are out of range depends on the use, which is not known here.
        let reported = diagnostics.len();
        let spectrum = compile_spectrum(self, usage, span, diagnostics);
        if !diagnostics[reported..].iter().any(Diagnostic::is_error) {
            diagnostics.truncate(reported);
        }
        spectrum
    }

    fn id(handle: Handle<TextureDesc<SpectrumDesc>>, usage: SpectrumType) -> SpectrumTextureId {
        SpectrumTextureId((handle.index() * SpectrumType::ALL.len() + usage as usize) as u32)
    }

    fn push(textures: &mut Textures, texture: SpectrumTexture) -> SpectrumTextureId {
        textures.push_spectrum(texture)
    }

    fn image(lookup: ImageLookup, image: &ImageDesc, spectrum_type: SpectrumType) -> SpectrumImage {
        let space = image
            .image
            .metadata
            .chromaticities
            .and_then(|c| RgbColorSpace::from_chromaticities([c.red, c.green, c.blue], c.white));
        SpectrumImage { lookup, space: space.unwrap_or(RgbColorSpace::srgb()), spectrum_type }
    }
}

/// How many textures `texture` depends on in a row, from the depths of the textures before it.
/// `None`, with a report, if it refers to itself or a later one, or too deeply.
fn depth<V>(
    texture: &Stated<TextureDesc<V>>,
    same: &[u32],
    floats: &[u32],
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<u32> {
    fn below<T>(parameter: Option<&Parameter<T>>, depths: &[u32]) -> Option<u32> {
        match parameter {
            Some(Parameter::Texture(handle)) => Some(depths.get(handle.index())? + 1),
            _ => Some(0),
        }
    }
    let (parts, factor) = match &texture.kind {
        TextureKind::Scale { texture, scale } => ([Some(texture), None], Some(scale)),
        TextureKind::Mix { textures: [a, b], amount } => ([Some(a), Some(b)], Some(amount)),
        TextureKind::Checkerboard { textures: [a, b], .. }
        | TextureKind::DirectionMix { textures: [a, b], .. }
        | TextureKind::Dots { inside: a, outside: b, .. } => ([Some(a), Some(b)], None),
        _ => ([None, None], None),
    };
    let mut error = |code, message| {
        diagnostics.push(Diagnostic::error(code, message, texture.origin.span));
        None
    };
    let name = &texture.name;
    match (below(parts[0], same), below(parts[1], same), below(factor, floats)) {
        (Some(a), Some(b), Some(c)) if a.max(b).max(c) <= MAX_DEPTH => Some(a.max(b).max(c)),
        (Some(_), Some(_), Some(_)) => error(
            "texture-depth",
            format!("texture `{name}` depends on more than {MAX_DEPTH} others in a row"),
        ),
        _ => error("texture-cycle", format!("texture `{name}` refers to itself or to a later one")),
    }
}

struct Compiler<'a> {
    textures: Textures,
    pyramids: Pyramids<'a>,
    images: &'a Arena<ImageDesc>,
    render_from_world: &'a DMat4,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Compiler<'_> {
    fn texture<V: Value>(&mut self, desc: &Stated<TextureDesc<V>>, usage: V::Use) -> TextureOf<V> {
        let origin = &desc.origin;
        match &desc.kind {
            TextureKind::Constant(value) => {
                Texture::Constant(value.constant(usage, origin.parameter("value"), self.diagnostics))
            }
            TextureKind::Scale { texture, scale } => Texture::Scale {
                texture: self.parameter(texture, usage, origin.parameter("tex")),
                scale: self.parameter(scale, (), origin.parameter("scale")),
            },
            TextureKind::Mix { textures, amount } => Texture::Mix {
                textures: self.pair(textures, usage, origin),
                amount: self.parameter(amount, (), origin.parameter("amount")),
            },
            TextureKind::Checkerboard { textures, mapping } => {
                let pattern = match mapping {
                    Some(mapping) => Checkerboard::Squares(self.mapping(mapping, desc)),
                    None => {
                        Checkerboard::Cubes(Mapping3d { texture_from_render: self.texture_from_render(desc) })
                    }
                };
                Texture::Checkerboard { textures: self.pair(textures, usage, origin), pattern }
            }
            TextureKind::Image(image) => match self.image(image, desc, usage) {
                Some(image) => Texture::Image(image),
                None => self.half::<V>(usage, origin),
            },
            TextureKind::Bilerp { corners, mapping } => {
                let names = ["v00", "v01", "v10", "v11"];
                let constant =
                    |i: usize| corners[i].constant(usage, origin.parameter(names[i]), self.diagnostics);
                let corners = [0, 1, 2, 3].map(constant);
                Texture::Bilerp(Bilerp { corners, mapping: self.mapping(mapping, desc) })
            }
            TextureKind::DirectionMix { textures, .. } => {
                self.even_mix("directionmix", textures, usage, origin)
            }
            TextureKind::Dots { inside, outside, .. } => {
                self.even_mix("dots", &[inside.clone(), outside.clone()], usage, origin)
            }
            TextureKind::Fbm { .. } => self.middle::<V>("fbm", usage, origin),
            TextureKind::Wrinkled { .. } => self.middle::<V>("wrinkled", usage, origin),
            TextureKind::Windy => self.middle::<V>("windy", usage, origin),
            TextureKind::Marble { .. } => self.middle::<V>("marble", usage, origin),
            TextureKind::Ptex { .. } => self.middle::<V>("ptex", usage, origin),
        }
    }

    fn parameter<V: Value>(&mut self, parameter: &Parameter<V>, usage: V::Use, span: Span) -> V::Id {
        match parameter {
            Parameter::Value(value) => {
                let value = value.constant(usage, span, self.diagnostics);
                V::push(&mut self.textures, Texture::Constant(value))
            }
            Parameter::Texture(handle) => V::id(*handle, usage),
        }
    }

    fn pair<V: Value>(&mut self, textures: &[Parameter<V>; 2], usage: V::Use, origin: &Origin) -> [V::Id; 2] {
        let [first, second] = textures;
        [
            self.parameter(first, usage, origin.parameter("tex1")),
            self.parameter(second, usage, origin.parameter("tex2")),
        ]
    }

    /// What stands in for a texture that lies between two others.
    fn even_mix<V: Value>(
        &mut self,
        name: &str,
        textures: &[Parameter<V>; 2],
        usage: V::Use,
        origin: &Origin,
    ) -> TextureOf<V> {
        self.not_drawn(name, "an even mix of its values", origin);
        let amount = self.textures.push_float(Texture::Constant(0.5));
        Texture::Mix { textures: self.pair(textures, usage, origin), amount }
    }

    /// What stands in for a texture that makes its own values.
    fn middle<V: Value>(&mut self, name: &str, usage: V::Use, origin: &Origin) -> TextureOf<V> {
        self.not_drawn(name, "the constant 0.5", origin);
        self.half::<V>(usage, origin)
    }

    fn half<V: Value>(&mut self, usage: V::Use, origin: &Origin) -> TextureOf<V> {
        Texture::Constant(V::from(0.5).constant(usage, origin.span, self.diagnostics))
    }

    fn not_drawn(&mut self, name: &str, instead: &str, origin: &Origin) {
        let message = format!("texture `{name}` is not drawn yet; drawn as {instead}");
        self.diagnostics.push(Diagnostic::warning("not-drawn", message, origin.span));
    }

    /// `None`, with a report, if the image cannot serve as a texture.
    fn image<V: Value>(
        &mut self,
        desc: &ImageTextureDesc,
        texture: &Stated<TextureDesc<V>>,
        usage: V::Use,
    ) -> Option<V::Image> {
        let origin = &texture.origin;
        if !desc.scale.is_finite() {
            let message = format!("{} is no factor for an image", desc.scale);
            self.diagnostics.push(Diagnostic::error("invalid-value", message, origin.parameter("scale")));
        }
        let anisotropy = 1.0..=f32::INFINITY;
        if desc.filter == description::TextureFilter::Ewa && !anisotropy.contains(&desc.max_anisotropy) {
            let message = format!("the greatest anisotropy must be at least 1, not {}", desc.max_anisotropy);
            self.diagnostics.push(Diagnostic::error(
                "invalid-value",
                message,
                origin.parameter("maxanisotropy"),
            ));
        }
        let pyramid = match self.pyramids.get(desc, V::IN_COLOR) {
            Ok(pyramid) => pyramid,
            Err(error) => {
                let message = format!("{}: {error}", self.images[desc.image].name);
                self.diagnostics.push(Diagnostic::error("image", message, origin.parameter("filename")));
                return None;
            }
        };
        let filter = match desc.filter {
            description::TextureFilter::Point => TextureFilter::Point,
            description::TextureFilter::Bilinear => TextureFilter::Bilinear,
            description::TextureFilter::Trilinear => TextureFilter::Trilinear,
            description::TextureFilter::Ewa => TextureFilter::Ewa { max_anisotropy: desc.max_anisotropy },
        };
        let mapping = self.mapping(&desc.mapping, texture);
        let lookup = ImageLookup { mapping, pyramid, filter, scale: desc.scale, invert: desc.invert };
        Some(V::image(lookup, &self.images[desc.image], usage))
    }

    fn mapping<V>(&mut self, desc: &MappingDesc, texture: &Stated<TextureDesc<V>>) -> Mapping2d {
        match *desc {
            MappingDesc::Uv { scale, delta } => Mapping2d::Uv { scale: scale.into(), delta: delta.into() },
            MappingDesc::Spherical => {
                Mapping2d::Spherical { texture_from_render: self.texture_from_render(texture) }
            }
            MappingDesc::Cylindrical => {
                Mapping2d::Cylindrical { texture_from_render: self.texture_from_render(texture) }
            }
            MappingDesc::Planar { axes, delta } => Mapping2d::Planar {
                texture_from_render: self.texture_from_render(texture),
                axes,
                delta: Vec2::from(delta),
            },
        }
    }

    fn texture_from_render<V>(&mut self, texture: &Stated<TextureDesc<V>>) -> Transform {
        let render_from_texture = *self.render_from_world * texture.world_from_texture;
        Transform::from_f64(render_from_texture).map(|t| t.inverse()).unwrap_or_else(|| {
            let message = "the transform of this texture has no inverse";
            self.diagnostics.push(Diagnostic::error("singular-transform", message, texture.origin.span));
            Transform::IDENTITY
        })
    }
}
