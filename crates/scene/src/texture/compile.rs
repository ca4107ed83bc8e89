//! Compiles the textures of a description to programs.
//!
//! All textures become nodes of the graph in the order of the description, in which each refers
//! only to textures before it. A texture of spectra becomes one node for each [`SpectrumType`], as
//! the meaning of its colours depends on its use. Programs are compiled for the textures that
//! parameters of materials and shapes refer to. An invalid or unsupported texture is reported and
//! replaced by a constant.

use super::graph::{Graph, Index, MAX_OPERATIONS, MAX_TOTAL_OPERATIONS, NodeId, ProgramError};
use super::program::{Code, MAX_SLOTS};
use super::{
    FloatTextureId, Fractal, ImageLookup, Mapping2d, Mapping3d, Marble, SpectrumImage, SpectrumTextureId,
    SpectrumType, TextureContext, Textures, compile_spectrum, pyramids::Pyramids,
};
use description::{
    Arena, Diagnostic, FloatParameter, Handle, ImageDesc, ImageTextureDesc, MappingDesc, Parameter,
    SceneDesc, Span, SpectrumDesc, SpectrumParameter, Stated, TextureDesc, TextureKind,
};
use image::TextureFilter;
use math::{DMat4, DVec3, Transform, Vec2, Vec3, Vector3};
use spectrum::RgbColorSpace;

/// The textures of a scene while it is compiled.
#[derive(Debug)]
pub struct TextureCompiler {
    graph: Graph,
    /// The nodes of the description's textures, by handle.
    nodes: Nodes,
}

#[derive(Debug, Default)]
struct Nodes {
    float: Vec<NodeId>,
    /// One for each spectrum type.
    spectrum: Vec<[NodeId; SpectrumType::ALL.len()]>,
}

impl TextureCompiler {
    /// Builds the graph of a description's textures. Errors and warnings are added to
    /// `diagnostics`.
    pub fn new(desc: &SceneDesc, render_from_world: &DMat4, diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut builder = GraphBuilder {
            graph: Graph::default(),
            nodes: Nodes::default(),
            pyramids: Pyramids::new(&desc.images),
            mappings: Index::default(),
            solid_mappings: Index::default(),
            directions: Index::default(),
            fractals: Index::default(),
            marbles: Index::default(),
            float_images: Index::default(),
            spectrum_images: Index::default(),
            images: &desc.images,
            render_from_world,
            diagnostics,
        };
        for (_, texture) in desc.float_textures.iter() {
            let node = builder.texture(texture, ());
            builder.nodes.float.push(node);
        }
        for (_, texture) in desc.spectrum_textures.iter() {
            let start = builder.diagnostics.len();
            let nodes = SpectrumType::ALL.map(|spectrum_type| {
                let end = builder.diagnostics.len();
                let node = builder.texture(texture, spectrum_type);
                // The errors are the same for each type.
                if end > start {
                    builder.diagnostics.truncate(end);
                }
                node
            });
            builder.nodes.spectrum.push(nodes);
        }
        let mut compiler = Self { graph: builder.graph, nodes: builder.nodes };
        // Program 0 replaces those that cannot be compiled.
        let zero = compiler.graph.number(0.0);
        compiler.program(zero, Span::NONE, diagnostics);
        compiler
    }

    /// The texture of a parameter of the description that was given at `span`. Errors are added to
    /// `diagnostics`.
    pub fn float_parameter(
        &mut self,
        parameter: &FloatParameter,
        span: Span,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> FloatTextureId {
        let node = match parameter {
            Parameter::Value(value) => value.node((), span, &mut self.graph, diagnostics),
            Parameter::Texture(handle) => self.nodes.float[handle.index()],
        };
        FloatTextureId(self.program(node, span, diagnostics))
    }

    /// The texture of a parameter of the description that was given at `span`, whose colours are
    /// spectra of type `spectrum_type`. Errors are added to `diagnostics`.
    pub fn spectrum_parameter(
        &mut self,
        parameter: &SpectrumParameter,
        spectrum_type: SpectrumType,
        span: Span,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> SpectrumTextureId {
        let node = match parameter {
            Parameter::Value(value) => {
                let spectrum = compile_spectrum(value, spectrum_type, span, diagnostics);
                self.graph.spectrum(spectrum)
            }
            Parameter::Texture(handle) => self.nodes.spectrum[handle.index()][spectrum_type as usize],
        };
        SpectrumTextureId(self.program(node, span, diagnostics))
    }

    fn program(&mut self, node: NodeId, span: Span, diagnostics: &mut Vec<Diagnostic>) -> u32 {
        self.graph.program(node).unwrap_or_else(|error| {
            let message = match error {
                ProgramError::Operations => {
                    format!("this texture takes more than {MAX_OPERATIONS} operations")
                }
                ProgramError::Slots => {
                    format!("this texture has more than {MAX_SLOTS} intermediate values at once")
                }
                ProgramError::TotalOperations => {
                    format!("the textures of the scene take more than {MAX_TOTAL_OPERATIONS} operations")
                }
            };
            diagnostics.push(Diagnostic::error("texture-size", message, span));
            0
        })
    }

    /// The textures that have programs so far.
    pub fn textures(&self) -> &Textures {
        &self.graph.textures
    }

    /// The textures that have programs.
    pub fn finish(self) -> Textures {
        self.graph.textures
    }
}

/// The two types of texture values in a description: numbers and spectra.
trait Value: From<f32> + Clone {
    /// The meaning of the value.
    type Use: Copy;
    /// Whether image lookups return colours.
    const IN_COLOR: bool;

    fn node(
        &self,
        usage: Self::Use,
        span: Span,
        graph: &mut Graph,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> NodeId;
    /// The node of a texture; `None` if it is not built yet.
    fn built_node(handle: Handle<TextureDesc<Self>>, usage: Self::Use, nodes: &Nodes) -> Option<NodeId>;
    fn image(lookup: ImageLookup, image: &ImageDesc, usage: Self::Use, builder: &mut GraphBuilder) -> Code;
}

impl Value for f32 {
    type Use = ();
    const IN_COLOR: bool = false;

    fn node(&self, (): (), span: Span, graph: &mut Graph, diagnostics: &mut Vec<Diagnostic>) -> NodeId {
        if !self.is_finite() {
            let message = format!("{self} is not a valid value for a texture");
            diagnostics.push(Diagnostic::error("invalid-value", message, span));
        }
        graph.number(*self)
    }

    fn built_node(handle: Handle<TextureDesc<f32>>, (): (), nodes: &Nodes) -> Option<NodeId> {
        nodes.float.get(handle.index()).copied()
    }

    fn image(lookup: ImageLookup, _: &ImageDesc, (): (), builder: &mut GraphBuilder) -> Code {
        let images = &mut builder.graph.textures.float_images;
        Code::FloatImage(builder.float_images.intern(images, lookup, image_hash(&lookup)))
    }
}

impl Value for SpectrumDesc {
    type Use = SpectrumType;
    const IN_COLOR: bool = true;

    fn node(
        &self,
        usage: SpectrumType,
        span: Span,
        graph: &mut Graph,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> NodeId {
        // Which colours are out of range depends on the spectrum type, which is not known here.
        let reported = diagnostics.len();
        let spectrum = compile_spectrum(self, usage, span, diagnostics);
        if !diagnostics[reported..].iter().any(Diagnostic::is_error) {
            diagnostics.truncate(reported);
        }
        graph.spectrum(spectrum)
    }

    fn built_node(
        handle: Handle<TextureDesc<SpectrumDesc>>,
        usage: SpectrumType,
        nodes: &Nodes,
    ) -> Option<NodeId> {
        nodes.spectrum.get(handle.index()).map(|nodes| nodes[usage as usize])
    }

    fn image(
        lookup: ImageLookup,
        image: &ImageDesc,
        spectrum_type: SpectrumType,
        builder: &mut GraphBuilder,
    ) -> Code {
        let space = image
            .image
            .metadata
            .chromaticities
            .and_then(|c| RgbColorSpace::from_chromaticities([c.red, c.green, c.blue], c.white));
        let space = space.unwrap_or(RgbColorSpace::srgb());
        let images = &mut builder.graph.textures.spectrum_images;
        let image = SpectrumImage { lookup, space, spectrum_type };
        Code::SpectrumImage(builder.spectrum_images.intern(images, image, image_hash(&lookup)))
    }
}

fn image_hash(lookup: &ImageLookup) -> [f32; 4] {
    [lookup.pyramid as f32, lookup.mapping as f32, lookup.scale, f32::from(u8::from(lookup.invert))]
}

struct GraphBuilder<'a> {
    graph: Graph,
    nodes: Nodes,
    pyramids: Pyramids<'a>,
    mappings: Index,
    solid_mappings: Index,
    directions: Index,
    fractals: Index,
    marbles: Index,
    float_images: Index,
    spectrum_images: Index,
    images: &'a Arena<ImageDesc>,
    render_from_world: &'a DMat4,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl GraphBuilder<'_> {
    fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.diagnostics.push(Diagnostic::error(code, message, span));
    }

    fn texture<V: Value>(&mut self, desc: &Stated<TextureDesc<V>>, usage: V::Use) -> NodeId {
        let reported = self.diagnostics.len();
        let node = self.kind(desc, usage);
        let overflows = self.graph.value(node).is_some_and(|value| !value.is_finite());
        if overflows && !self.diagnostics[reported..].iter().any(Diagnostic::is_error) {
            let message = format!("the value of texture `{}` is too large", desc.name);
            self.error("invalid-value", message, desc.origin.span);
        }
        node
    }

    fn kind<V: Value>(&mut self, desc: &Stated<TextureDesc<V>>, usage: V::Use) -> NodeId {
        let origin = &desc.origin;
        match &desc.kind {
            TextureKind::Constant { value } => self.value(value, usage, origin.parameter("value")),
            TextureKind::Scale { texture, scale } => {
                let texture = self.operand(texture, usage, "tex", desc);
                let scale = self.operand(scale, (), "scale", desc);
                self.graph.scale(texture, scale)
            }
            TextureKind::Mix { textures, amount } => {
                let textures = self.pair(textures, ["tex1", "tex2"], usage, desc);
                let amount = self.operand(amount, (), "amount", desc);
                self.graph.mix(textures, amount)
            }
            TextureKind::Checkerboard { textures, mapping } => {
                let textures = self.pair(textures, ["tex1", "tex2"], usage, desc);
                let code = match mapping {
                    Some(mapping) => Code::Squares(self.mapping(mapping, desc)),
                    None => Code::Cubes(self.solid_mapping(desc)),
                };
                let amount = self.graph.node(code, &[]);
                self.graph.mix(textures, amount)
            }
            TextureKind::Image(image) => match self.image(image, desc, usage) {
                Some(code) => self.graph.node(code, &[]),
                None => self.graph.number(0.5),
            },
            TextureKind::Bilerp { corners: [v00, v01, v10, v11], mapping } => {
                let corners = [("v00", v00), ("v01", v01), ("v10", v10), ("v11", v11)]
                    .map(|(name, value)| self.value(value, usage, origin.parameter(name)));
                let code = Code::Bilerp(self.mapping(mapping, desc));
                self.graph.node(code, &corners)
            }
            TextureKind::DirectionMix { textures, direction } => {
                let [first, second] = self.pair(textures, ["tex1", "tex2"], usage, desc);
                let code = Code::Facing(self.direction(*direction, desc));
                let amount = self.graph.node(code, &[]);
                self.graph.mix([second, first], amount)
            }
            TextureKind::Dots { inside, outside, mapping } => {
                let inside = self.operand(inside, usage, "inside", desc);
                let outside = self.operand(outside, usage, "outside", desc);
                let code = Code::Dots(self.mapping(mapping, desc));
                let amount = self.graph.node(code, &[]);
                // Exchanged, as in pbrt-v4.
                self.graph.mix([inside, outside], amount)
            }
            TextureKind::Fbm { octaves, roughness } => {
                let code = Code::Fbm(self.fractal(*octaves, *roughness, desc));
                self.graph.node(code, &[])
            }
            TextureKind::Wrinkled { octaves, roughness } => {
                let code = Code::Wrinkled(self.fractal(*octaves, *roughness, desc));
                self.graph.node(code, &[])
            }
            TextureKind::Windy => {
                let code = Code::Windy(self.solid_mapping(desc));
                self.graph.node(code, &[])
            }
            TextureKind::Marble { octaves, roughness, scale, variation } => {
                let index = self.fractal(*octaves, *roughness, desc);
                let (scale, variation) =
                    (self.finite(*scale, "scale", desc), self.finite(*variation, "variation", desc));
                let textures = &mut self.graph.textures;
                let marble = Marble { fractal: textures.fractals[index as usize], scale, variation };
                let hash = [index as f32, scale, variation, 0.0];
                let code = Code::Marble(self.marbles.intern(&mut textures.marbles, marble, hash));
                self.graph.node(code, &[])
            }
            TextureKind::Step { texture, edge } => {
                let texture = self.operand(texture, (), "tex", desc);
                let edge = self.finite(*edge, "edge", desc);
                self.graph.step(texture, edge)
            }
            TextureKind::Ptex { .. } => {
                let message = "texture `ptex` is not drawn yet; drawn as the constant 0.5";
                self.diagnostics.push(Diagnostic::warning("not-drawn", message, origin.span));
                self.graph.number(0.5)
            }
        }
    }

    fn value<V: Value>(&mut self, value: &V, usage: V::Use, span: Span) -> NodeId {
        value.node(usage, span, &mut self.graph, self.diagnostics)
    }

    /// The node of the parameter `name` of the texture `user`.
    fn operand<V: Value, W>(
        &mut self,
        parameter: &Parameter<V>,
        usage: V::Use,
        name: &str,
        user: &Stated<TextureDesc<W>>,
    ) -> NodeId {
        let span = user.origin.parameter(name);
        match parameter {
            Parameter::Value(value) => self.value(value, usage, span),
            Parameter::Texture(handle) => V::built_node(*handle, usage, &self.nodes).unwrap_or_else(|| {
                let message = format!("texture `{}` refers to itself or to a later one", user.name);
                self.error("texture-cycle", message, span);
                self.graph.number(0.0)
            }),
        }
    }

    fn pair<V: Value>(
        &mut self,
        [first, second]: &[Parameter<V>; 2],
        names: [&str; 2],
        usage: V::Use,
        user: &Stated<TextureDesc<V>>,
    ) -> [NodeId; 2] {
        [self.operand(first, usage, names[0], user), self.operand(second, usage, names[1], user)]
    }

    /// `None`, with an error, if the image is not valid as a texture.
    fn image<V: Value>(
        &mut self,
        desc: &ImageTextureDesc,
        texture: &Stated<TextureDesc<V>>,
        usage: V::Use,
    ) -> Option<Code> {
        let origin = &texture.origin;
        if !desc.scale.is_finite() {
            let message = format!("{} is not a valid scale of an image", desc.scale);
            self.error("invalid-value", message, origin.parameter("scale"));
        }
        let anisotropy = 1.0..=f32::INFINITY;
        if desc.filter == description::TextureFilter::Ewa && !anisotropy.contains(&desc.max_anisotropy) {
            let message = format!("the maximum anisotropy must be at least 1, not {}", desc.max_anisotropy);
            self.error("invalid-value", message, origin.parameter("maxanisotropy"));
        }
        let image = &self.images[desc.image];
        let pyramid = match self.pyramids.get(desc, V::IN_COLOR, &mut self.graph.textures.pyramids) {
            Ok(pyramid) => pyramid,
            Err(error) => {
                let parameter = if desc.channel.is_some() { "channel" } else { "filename" };
                self.error("image", format!("{}: {error}", image.name), origin.parameter(parameter));
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
        Some(V::image(lookup, image, usage, self))
    }

    /// Index of a map to the plane.
    fn mapping<V>(&mut self, desc: &MappingDesc, texture: &Stated<TextureDesc<V>>) -> u32 {
        let mapping = match *desc {
            MappingDesc::Uv { scale, delta } => Mapping2d::Uv { scale: scale.into(), delta: delta.into() },
            MappingDesc::Affine { columns } => Mapping2d::Affine { columns: columns.map(Vec2::from) },
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
        };
        let at = mapping.map(&TextureContext { p: PROBE, uv: PROBE.truncate(), ..Default::default() });
        self.mappings.intern(&mut self.graph.textures.mappings, mapping, [at.st.x, at.st.y, 0.0, 0.0])
    }

    /// Index of a map to texture space.
    fn solid_mapping<V>(&mut self, texture: &Stated<TextureDesc<V>>) -> u32 {
        let mapping = Mapping3d { texture_from_render: self.texture_from_render(texture) };
        let at = mapping.map(&TextureContext { p: PROBE, ..Default::default() }).p;
        let mappings = &mut self.graph.textures.solid_mappings;
        self.solid_mappings.intern(mappings, mapping, [at.x, at.y, at.z, 0.0])
    }

    /// Index of a sum of noise.
    fn fractal<V>(&mut self, octaves: i32, roughness: f32, texture: &Stated<TextureDesc<V>>) -> u32 {
        if !(0..=MAX_OCTAVES).contains(&octaves) {
            let message =
                format!("the number of octaves must lie between 0 and {MAX_OCTAVES}, not {octaves}");
            self.error("invalid-value", message, texture.origin.parameter("octaves"));
        }
        let octaves = octaves.clamp(0, MAX_OCTAVES) as u32;
        let roughness = self.finite(roughness, "roughness", texture);
        let mapping = self.solid_mapping(texture);
        let hash = [mapping as f32, octaves as f32, roughness, 0.0];
        let fractal = Fractal { mapping, octaves, roughness };
        self.fractals.intern(&mut self.graph.textures.fractals, fractal, hash)
    }

    /// The value of the parameter `name`, which must be finite.
    fn finite<V>(&mut self, value: f32, name: &str, texture: &Stated<TextureDesc<V>>) -> f32 {
        if value.is_finite() {
            return value;
        }
        self.error("invalid-value", format!("`{name}` cannot be {value}"), texture.origin.parameter(name));
        0.0
    }

    /// Index of a direction of texture space.
    fn direction<V>(&mut self, direction: Vector3, texture: &Stated<TextureDesc<V>>) -> u32 {
        let render_from_texture = *self.render_from_world * texture.world_from_texture;
        let direction = render_from_texture.transform_vector3(direction.as_dvec3()).normalize_or_zero();
        if direction == DVec3::ZERO {
            let message = "the direction must not be zero or infinite";
            self.error("invalid-value", message, texture.origin.parameter("dir"));
        }
        let direction = Vec3::from(direction.as_vec3());
        let hash = [direction.x, direction.y, direction.z, 0.0];
        self.directions.intern(&mut self.graph.textures.directions, direction, hash)
    }

    fn texture_from_render<V>(&mut self, texture: &Stated<TextureDesc<V>>) -> Transform {
        let render_from_texture = *self.render_from_world * texture.world_from_texture;
        Transform::from_f64(render_from_texture).map(|t| t.inverse()).unwrap_or_else(|| {
            let message = "the transform of this texture has no inverse";
            self.error("singular-transform", message, texture.origin.span);
            Transform::IDENTITY
        })
    }
}

/// The largest number of octaves of a sum of noise.
const MAX_OCTAVES: i32 = 64;

/// A point at which different mappings usually have different coordinates, from which they are
/// hashed.
const PROBE: Vec3 = Vec3::new(0.625, -1.75, 2.375);
