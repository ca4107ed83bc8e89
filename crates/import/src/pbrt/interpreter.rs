//! Runs the directives of a scene and its included files: keeps the graphics state and collects statements.
//!
//! After a mistake inside a statement, reading goes on at the next directive, so that all mistakes of a scene are found
//! in one run.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use description::{ColorSpaceDesc, Diagnostic, FileId, SourceMap, Span, Spanned};

use super::names;
use super::parameter::{self, ParameterType, RawParameter, is_directive};
use super::state::{Attributes, Block, BlockKind, GraphicsState, MaterialReference, TransformSet};
use super::statement::{
    CameraStatement, InstanceStatement, LightStatement, MaterialStatement, MediumStatement, ObjectStatement,
    ShapeStatement, Statement, Statements, TextureStatement,
};
use super::token::{Token, TokenKind, Tokens};
use crate::assets::{AssetSource, read_unpacked, resolve};
use crate::number;
use crate::report::Report;
use crate::suggest::did_you_mean;

/// A statement that could not be read; what is wrong has been reported.
#[derive(Debug)]
pub(super) struct Abandoned;

pub(super) type Step<T = ()> = Result<T, Abandoned>;

/// Where a directive may stand.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Before `WorldBegin`.
    Options,
    /// After it.
    World,
    Anywhere,
}

/// All directives and where they may stand.
const DIRECTIVES: [(&str, Place); 40] = [
    ("Accelerator", Place::Options),
    ("ActiveTransform", Place::Anywhere),
    ("AreaLightSource", Place::World),
    ("Attribute", Place::Anywhere),
    ("AttributeBegin", Place::World),
    ("AttributeEnd", Place::World),
    ("Camera", Place::Options),
    ("ColorSpace", Place::Anywhere),
    ("ConcatTransform", Place::Anywhere),
    ("CoordSysTransform", Place::Anywhere),
    ("CoordinateSystem", Place::Anywhere),
    ("Film", Place::Options),
    ("Identity", Place::Anywhere),
    ("Import", Place::World),
    ("Include", Place::Anywhere),
    ("Integrator", Place::Options),
    ("LightSource", Place::World),
    ("LookAt", Place::Anywhere),
    ("MakeNamedMaterial", Place::World),
    ("MakeNamedMedium", Place::Anywhere),
    ("Material", Place::World),
    ("MediumInterface", Place::Anywhere),
    ("NamedMaterial", Place::World),
    ("ObjectBegin", Place::World),
    ("ObjectEnd", Place::World),
    ("ObjectInstance", Place::World),
    ("Option", Place::Anywhere),
    ("PixelFilter", Place::Options),
    ("ReverseOrientation", Place::World),
    ("Rotate", Place::Anywhere),
    ("Sampler", Place::Options),
    ("Scale", Place::Anywhere),
    ("Shape", Place::World),
    ("Texture", Place::World),
    ("Transform", Place::Anywhere),
    ("TransformBegin", Place::World),
    ("TransformEnd", Place::World),
    ("TransformTimes", Place::Options),
    ("Translate", Place::Anywhere),
    ("WorldBegin", Place::Options),
];

/// All options and the types of their values.
const OPTIONS: [(&str, ParameterType); 11] = [
    ("disablepixeljitter", ParameterType::Bool),
    ("disabletexturefiltering", ParameterType::Bool),
    ("disablewavelengthjitter", ParameterType::Bool),
    ("displacementedgescale", ParameterType::Float),
    ("forcediffuse", ParameterType::Bool),
    ("msereferenceimage", ParameterType::String),
    ("msereferenceout", ParameterType::String),
    ("pixelstats", ParameterType::Bool),
    ("rendercoordsys", ParameterType::String),
    ("seed", ParameterType::Integer),
    ("wavefront", ParameterType::Bool),
];

const COLOR_SPACES: [(&str, ColorSpaceDesc); 4] = [
    ("srgb", ColorSpaceDesc::Srgb),
    ("dci-p3", ColorSpaceDesc::DciP3),
    ("rec2020", ColorSpaceDesc::Rec2020),
    ("aces2065-1", ColorSpaceDesc::Aces2065_1),
];

pub(crate) struct Interpreter<'a> {
    assets: &'a dyn AssetSource,
    pub(super) report: Report,
    pub(super) sources: SourceMap,
    pub(super) statements: Statements,
    pub(super) state: GraphicsState,
    pub(super) coordinate_systems: HashMap<String, TransformSet>,
    blocks: Vec<Block>,
    in_world: bool,
    /// The object that is being defined.
    object: Option<ObjectStatement>,
    /// Files that are being read.
    depth: usize,
    /// `Include` and `Import` directives that were run.
    included: usize,
    /// Files that were read, by path.
    files: HashMap<PathBuf, FileId>,
}

impl<'a> Interpreter<'a> {
    const DEEPEST_INCLUDE: usize = 64;
    const MOST_INCLUDES: usize = 10_000;
    const DEEPEST_BLOCK: usize = 10_000;

    pub(crate) fn new(assets: &'a dyn AssetSource) -> Self {
        Self {
            assets,
            report: Report::default(),
            sources: SourceMap::default(),
            statements: Statements::default(),
            state: GraphicsState::default(),
            coordinate_systems: HashMap::new(),
            blocks: Vec::new(),
            in_world: false,
            object: None,
            depth: 0,
            included: 0,
            files: HashMap::new(),
        }
    }

    /// Runs a scene from its first file.
    pub(crate) fn run(&mut self, path: &Path) {
        let Some(file) = self.open(path, Span::NONE) else { return };
        self.file(file);
        let end = self.sources.text(file).len() as u32;
        let end = Span::new(file, end, end);
        self.close_blocks(0);
        if !self.in_world {
            let message = "the scene has no `WorldBegin`, so that nothing is in its world";
            self.report.error("missing-world", message, end);
        }
    }

    /// Runs the directives of one file.
    fn file(&mut self, file: FileId) {
        let text = self.sources.shared_text(file);
        let mut tokens = Tokens::new(&text, file);
        while !self.report.is_full() {
            let token = tokens.next();
            match token.kind {
                TokenKind::End => break,
                TokenKind::Word if is_directive(tokens.bytes(token)) => {
                    let directive = String::from_utf8_lossy(tokens.bytes(token));
                    if self.directive(&directive, token, &mut tokens).is_err() {
                        recover(&mut tokens);
                    }
                }
                TokenKind::Unterminated => {
                    let message = "this string has no closing quote on its line";
                    self.report.error("unterminated-string", message, tokens.span(token));
                    recover(&mut tokens);
                }
                _ => {
                    let found = String::from_utf8_lossy(tokens.bytes(token)).into_owned();
                    let message = format!("a directive should stand here, not {}", shortened(&found));
                    self.report.error("unexpected-token", message, tokens.span(token));
                    recover(&mut tokens);
                }
            }
        }
    }

    fn directive(&mut self, name: &str, token: Token, tokens: &mut Tokens) -> Step {
        let span = tokens.span(token);
        let Some(&(_, place)) = DIRECTIVES.iter().find(|(known, _)| *known == name) else {
            return self.unknown_directive(name, span);
        };
        if place == Place::Options && self.in_world || place == Place::World && !self.in_world {
            let side = if self.in_world { "before" } else { "after" };
            let message = format!("`{name}` may only stand {side} `WorldBegin`");
            self.report.error("misplaced-directive", message, span);
            return Err(Abandoned);
        }
        match name {
            "Film" => self.statements.film = Some(self.only(name, span, tokens, |all| all.film.as_ref())?),
            "Sampler" => {
                self.statements.sampler = Some(self.only(name, span, tokens, |all| all.sampler.as_ref())?)
            }
            "PixelFilter" => {
                self.statements.filter = Some(self.only(name, span, tokens, |all| all.filter.as_ref())?)
            }
            "Integrator" => {
                self.statements.integrator =
                    Some(self.only(name, span, tokens, |all| all.integrator.as_ref())?);
            }
            "Accelerator" => {
                self.statements.accelerator =
                    Some(self.only(name, span, tokens, |all| all.accelerator.as_ref())?);
            }
            "Camera" => self.camera(span, tokens)?,
            "Option" => self.option(tokens)?,
            "ColorSpace" => self.color_space(tokens)?,
            "WorldBegin" => self.world_begin(),
            "AttributeBegin" => self.begin_block(BlockKind::Attribute, span)?,
            "AttributeEnd" => self.end_block(BlockKind::Attribute, span)?,
            "TransformBegin" => {
                self.report.warning_once(
                    "deprecated",
                    "`TransformBegin` is now written `AttributeBegin`",
                    span,
                );
                self.begin_block(BlockKind::Attribute, span)?;
            }
            "TransformEnd" => {
                self.report.warning_once("deprecated", "`TransformEnd` is now written `AttributeEnd`", span);
                self.end_block(BlockKind::Attribute, span)?;
            }
            "Attribute" => self.attribute(tokens)?,
            "ReverseOrientation" => self.state.reverse_orientation ^= true,
            "ObjectBegin" => self.object_begin(span, tokens)?,
            "ObjectEnd" => self.object_end(span)?,
            "ObjectInstance" => self.object_instance(span, tokens)?,
            "MakeNamedMaterial" => self.make_named_material(span, tokens)?,
            "NamedMaterial" => {
                self.state.material = MaterialReference::Named(self.string(tokens, "the material")?)
            }
            "Material" => {
                let defaults = self.state.attributes.material.clone();
                let statement = self.statement(span, tokens, "the material's type", defaults)?;
                self.state.material = MaterialReference::Nth(self.statements.materials.len() as u32);
                self.statements.materials.push(MaterialStatement { statement, name: None });
            }
            "Texture" => self.texture(span, tokens)?,
            "MakeNamedMedium" => self.make_named_medium(span, tokens)?,
            "MediumInterface" => {
                let inside = self.string(tokens, "the medium inside")?;
                let two = tokens.peek().kind == TokenKind::Quoted;
                let outside = if two { self.string(tokens, "the medium outside")? } else { inside.clone() };
                self.state.medium_interface = Some([inside, outside]);
            }
            "LightSource" => {
                let defaults = self.state.attributes.light.clone();
                let statement = self.statement(span, tokens, "the light's type", defaults)?;
                let world_from_light = self.state.ctm.over(self.times());
                let medium = self.state.outside();
                self.statements.lights.push(LightStatement { statement, world_from_light, medium });
            }
            "AreaLightSource" => {
                let defaults = self.state.attributes.light.clone();
                let statement = self.statement(span, tokens, "the area light's type", defaults)?;
                self.state.area_light = Some(self.statements.area_lights.len() as u32);
                self.statements.area_lights.push(statement);
            }
            "Shape" => self.shape(span, tokens)?,
            "Include" => self.include(tokens)?,
            "Import" => self.import(tokens)?,
            _ => self.transform(name, span, tokens)?,
        }
        Ok(())
    }

    fn unknown_directive(&mut self, name: &str, span: Span) -> Step {
        if name == "WorldEnd" {
            self.report.warning(
                "deprecated",
                "`WorldEnd` is not needed any more: the world ends with the file",
                span,
            );
            return Ok(());
        }
        let message = format!("there is no directive `{}`", shortened(name));
        self.report.push(match names::replaced("directive", name) {
            Some(replacement) => Diagnostic::error("old-name", message, span).with_help(replacement),
            None => Diagnostic {
                help: did_you_mean(name, DIRECTIVES.map(|(known, _)| known)),
                ..Diagnostic::error("unknown-directive", message, span)
            },
        });
        Err(Abandoned)
    }

    /// A statement of which a scene has one; a second one replaces the first.
    fn only(
        &mut self,
        name: &str,
        span: Span,
        tokens: &mut Tokens,
        earlier: impl Fn(&Statements) -> Option<&Statement>,
    ) -> Step<Statement> {
        let statement = self.statement(span, tokens, "its type", Arc::default())?;
        if let Some(first) = earlier(&self.statements) {
            let message = format!("this `{name}` replaces an earlier one");
            let diagnostic = Diagnostic::warning("replaced-statement", message, span);
            self.report.push(diagnostic.with_label(first.kind.span, "the earlier one"));
        }
        Ok(statement)
    }

    /// Reads the type and the parameters of a statement.
    fn statement(
        &mut self,
        span: Span,
        tokens: &mut Tokens,
        what: &str,
        defaults: Arc<Vec<RawParameter>>,
    ) -> Step<Statement> {
        let kind = self.string(tokens, what)?;
        let color_space = self.state.color_space;
        let parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(kind.span, |last| last.span);
        Ok(Statement { span: span.to(end), kind, parameters, defaults, color_space })
    }

    fn camera(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let statement =
            self.only("Camera", span, tokens, |all| all.camera.as_ref().map(|camera| &camera.statement))?;
        let camera_from_world = self.state.ctm;
        self.coordinate_systems.insert("camera".into(), camera_from_world.inverse());
        let medium = self.state.outside();
        self.statements.camera = Some(CameraStatement { statement, camera_from_world, medium });
        Ok(())
    }

    /// `Option "name" value`: alone among parameters it is written without its type.
    fn option(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the option's name")?;
        let plain: String =
            name.value.chars().filter(|c| !matches!(c, '-' | '_')).map(|c| c.to_ascii_lowercase()).collect();
        let Some(&(known, kind)) = OPTIONS.iter().find(|(known, _)| *known == plain) else {
            let message = format!("there is no option `{}`", name.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&plain, OPTIONS.map(|(known, _)| known)),
                ..Diagnostic::error("unknown-option", message, name.span)
            });
            return Err(Abandoned);
        };
        let (values, end) =
            parameter::values(tokens, kind, known, name.span, &mut self.report).ok_or(Abandoned)?;
        self.statements.options.retain(|earlier| earlier.name != known);
        self.statements.options.push(RawParameter {
            kind,
            name: known.to_owned(),
            values,
            span: name.span.to(end),
            declaration: name.span,
            color_space: self.state.color_space,
        });
        Ok(())
    }

    fn color_space(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the colour space")?;
        let Some((_, space)) = COLOR_SPACES.into_iter().find(|(known, _)| *known == name.value) else {
            let message = format!("there is no colour space `{}`", name.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&name.value, COLOR_SPACES.map(|(known, _)| known)),
                ..Diagnostic::error("unknown-color-space", message, name.span)
            });
            return Err(Abandoned);
        };
        self.state.color_space = space;
        Ok(())
    }

    fn world_begin(&mut self) {
        self.in_world = true;
        self.state.ctm = TransformSet::IDENTITY;
        self.state.active = [true; 2];
        self.coordinate_systems.insert("world".into(), self.state.ctm);
    }

    fn begin_block(&mut self, kind: BlockKind, span: Span) -> Step {
        if self.blocks.len() >= Self::DEEPEST_BLOCK {
            self.report.error("unbalanced-block", "blocks are nested too deeply", span);
            return Err(Abandoned);
        }
        self.blocks.push(Block { kind, span, state: self.state.clone() });
        Ok(())
    }

    fn end_block(&mut self, kind: BlockKind, span: Span) -> Step {
        match self.blocks.last() {
            Some(block) if block.kind == kind => {
                if let Some(block) = self.blocks.pop() {
                    self.state = block.state;
                }
                Ok(())
            }
            Some(block) => {
                let message = format!("`{}` stands where `{}` is due", kind.end(), block.kind.end());
                let opened = Diagnostic::error("unbalanced-block", message, span)
                    .with_label(block.span, "opened here");
                self.report.push(opened);
                Err(Abandoned)
            }
            None => {
                let message = format!("`{}` has no `{}` before it", kind.end(), kind.begin());
                self.report.error("unbalanced-block", message, span);
                Err(Abandoned)
            }
        }
    }

    /// Reports and ends the blocks above a depth.
    fn close_blocks(&mut self, depth: usize) {
        while self.blocks.len() > depth
            && let Some(block) = self.blocks.pop()
        {
            let message = format!("this `{}` has no `{}`", block.kind.begin(), block.kind.end());
            self.report.error("unbalanced-block", message, block.span);
            self.state = block.state;
            if block.kind == BlockKind::Object {
                self.statements.objects.extend(self.object.take());
            }
        }
    }

    fn attribute(&mut self, tokens: &mut Tokens) -> Step {
        let target = self.string(tokens, "what the attributes are for")?;
        let given = parameter::parameters(tokens, self.state.color_space, &mut self.report);
        let Some(list) = self.state.attributes.target(&target.value) else {
            let message = format!("attributes cannot be for `{}`", target.value);
            self.report.push(Diagnostic {
                help: did_you_mean(&target.value, Attributes::TARGETS),
                ..Diagnostic::error("unknown-attribute-target", message, target.span)
            });
            return Ok(());
        };
        let list = Arc::make_mut(list);
        list.retain(|earlier| given.iter().all(|new| new.name != earlier.name));
        list.extend(given);
        Ok(())
    }

    fn object_begin(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the object's name")?;
        if self.object.is_some() {
            self.report.error("unbalanced-block", "an object cannot be defined inside another one", span);
            return Err(Abandoned);
        }
        self.begin_block(BlockKind::Object, span)?;
        self.object = Some(ObjectStatement { name, shapes: Vec::new() });
        Ok(())
    }

    fn object_end(&mut self, span: Span) -> Step {
        self.end_block(BlockKind::Object, span)?;
        self.statements.objects.extend(self.object.take());
        Ok(())
    }

    fn object_instance(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let object = self.string(tokens, "the object's name")?;
        if self.object.is_some() {
            let message = "an object cannot be instanced inside the definition of one";
            self.report.error("misplaced-directive", message, span);
            return Err(Abandoned);
        }
        let world_from_object = self.state.ctm.over(self.times());
        let span = span.to(object.span);
        self.statements.instances.push(InstanceStatement { object, span, world_from_object });
        Ok(())
    }

    fn make_named_material(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the material's name")?;
        let kind_span = name.span;
        let color_space = self.state.color_space;
        let mut parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(kind_span, |last| last.span);
        let defaults = self.state.attributes.material.clone();
        let kind = self.take_type("material", &name, &mut parameters)?;
        let statement = Statement { span: span.to(end), kind, parameters, defaults, color_space };
        self.statements.materials.push(MaterialStatement { statement, name: Some(name) });
        Ok(())
    }

    fn make_named_medium(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the medium's name")?;
        let color_space = self.state.color_space;
        let mut parameters = parameter::parameters(tokens, color_space, &mut self.report);
        let end = parameters.last().map_or(name.span, |last| last.span);
        let defaults = self.state.attributes.medium.clone();
        let kind = self.take_type("medium", &name, &mut parameters)?;
        let statement = Statement { span: span.to(end), kind, parameters, defaults, color_space };
        let world_from_medium = self.state.ctm.over(self.times());
        self.statements.media.push(MediumStatement { statement, name, world_from_medium });
        Ok(())
    }

    /// Takes the parameter `"string type"` out of a list.
    fn take_type(
        &mut self,
        what: &str,
        name: &Spanned<String>,
        parameters: &mut Vec<RawParameter>,
    ) -> Step<Spanned<String>> {
        let place = parameters.iter().position(|parameter| parameter.name == "type");
        let given = place.map(|place| parameters.remove(place));
        if let Some(RawParameter { values: parameter::Values::Strings(mut strings), .. }) = given
            && strings.len() == 1
        {
            return Ok(strings.remove(0));
        }
        let message = format!("the {what} `{}` needs its type, as in `\"string type\" \"…\"`", name.value);
        self.report.error("missing-parameter", message, name.span);
        Err(Abandoned)
    }

    fn texture(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the texture's name")?;
        let value = self.string(tokens, "`\"float\"` or `\"spectrum\"`")?;
        let defaults = self.state.attributes.texture.clone();
        let statement = self.statement(span, tokens, "the texture's type", defaults)?;
        let world_from_texture = self.state.ctm.0[0];
        if self.state.ctm.0[0] != self.state.ctm.0[1] {
            let message = "textures do not move: the transform at the start of the shutter is used";
            self.report.warning("ignored", message, span);
        }
        let textures = match value.value.as_str() {
            "float" => &mut self.statements.float_textures,
            "spectrum" => &mut self.statements.spectrum_textures,
            other => {
                let message = format!("a texture's values are of type `float` or `spectrum`, not `{other}`");
                self.report.push(match names::replaced("texture-value", other) {
                    Some(replacement) => {
                        Diagnostic::error("old-name", message, value.span).with_help(replacement)
                    }
                    None => Diagnostic {
                        help: did_you_mean(other, ["float", "spectrum"]),
                        ..Diagnostic::error("unknown-type", message, value.span)
                    },
                });
                return Ok(());
            }
        };
        if let Some(first) = textures.iter().find(|earlier| earlier.name.value == name.value) {
            let message = format!("there is already a {} texture `{}`", value.value, name.value);
            let diagnostic = Diagnostic::error("redefinition", message, name.span);
            self.report.push(diagnostic.with_label(first.name.span, "first defined here"));
            return Ok(());
        }
        textures.push(TextureStatement { statement, name, world_from_texture });
        self.statements.texture_order.push(value.value == "spectrum");
        Ok(())
    }

    fn shape(&mut self, span: Span, tokens: &mut Tokens) -> Step {
        let defaults = self.state.attributes.shape.clone();
        let statement = self.statement(span, tokens, "the shape's type", defaults)?;
        let shape = ShapeStatement {
            statement,
            world_from_object: self.state.ctm.over(self.times()),
            reverse_orientation: self.state.reverse_orientation,
            material: self.state.material.clone(),
            area_light: self.state.area_light,
            medium_interface: self.state.medium_interface.clone(),
        };
        match &mut self.object {
            Some(object) => object.shapes.push(shape),
            None => self.statements.shapes.push(shape),
        }
        Ok(())
    }

    fn times(&self) -> [f32; 2] {
        self.statements.transform_times.unwrap_or([0.0, 1.0])
    }

    /// Reads another file as if it stood here.
    fn include(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the file's name")?;
        if let Some(file) = self.open_named(&name) {
            self.depth += 1;
            self.file(file);
            self.depth -= 1;
        }
        Ok(())
    }

    /// Reads another file whose changes to the graphics state end with it.
    fn import(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the file's name")?;
        if let Some(file) = self.open_named(&name) {
            let (state, systems, depth) =
                (self.state.clone(), self.coordinate_systems.clone(), self.blocks.len());
            self.depth += 1;
            self.file(file);
            self.depth -= 1;
            self.close_blocks(depth);
            (self.state, self.coordinate_systems) = (state, systems);
        }
        Ok(())
    }

    fn open_named(&mut self, name: &Spanned<String>) -> Option<FileId> {
        if self.depth >= Self::DEEPEST_INCLUDE {
            let message = format!("files include each other more than {} deep", Self::DEEPEST_INCLUDE);
            self.report.error("include-limit", message, name.span);
            return None;
        }
        self.included += 1;
        if self.included > Self::MOST_INCLUDES {
            let message = format!("more than {} files are included", Self::MOST_INCLUDES);
            self.report.error("include-limit", message, name.span);
            return None;
        }
        let naming_file = self.sources.name(name.span.file);
        let path = resolve(self.assets, &name.value, naming_file, self.sources.name(FileId(0)));
        self.open(&path, name.span)
    }

    fn open(&mut self, path: &Path, span: Span) -> Option<FileId> {
        if let Some(&file) = self.files.get(path) {
            return Some(file);
        }
        let shown = path.to_string_lossy().into_owned();
        match read_unpacked(self.assets, path) {
            Ok(text) if u32::try_from(text.len()).is_ok() => {
                let file = self.sources.add(shown, text);
                self.files.insert(path.to_owned(), file);
                Some(file)
            }
            Ok(_) => {
                self.report.error("unreadable-file", format!("`{shown}` is larger than 4 GiB"), span);
                None
            }
            Err(error) => {
                self.report.error("unreadable-file", format!("cannot read `{shown}`: {error}"), span);
                None
            }
        }
    }

    /// Takes a quoted string.
    pub(super) fn string(&mut self, tokens: &mut Tokens, what: &str) -> Step<Spanned<String>> {
        let token = tokens.peek();
        if token.kind != TokenKind::Quoted {
            return self.unexpected(tokens, token, &format!("{what} in quotes"));
        }
        tokens.next();
        Ok(Spanned::new(tokens.string(token), tokens.span(token)))
    }

    /// Takes numbers, with or without brackets around them.
    pub(super) fn numbers<const N: usize>(&mut self, tokens: &mut Tokens) -> Step<[f64; N]> {
        let bracketed = tokens.peek().kind == TokenKind::Open;
        if bracketed {
            tokens.next();
        }
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let token = tokens.peek();
            match number::double(tokens.bytes(token)).filter(|value| value.is_finite()) {
                Some(value) => *number = value,
                None => return self.unexpected(tokens, token, &format!("a number ({N} in all)")),
            }
            tokens.next();
        }
        if bracketed {
            let token = tokens.peek();
            if token.kind != TokenKind::Close {
                return self.unexpected(tokens, token, &format!("`]` after {N} numbers"));
            }
            tokens.next();
        }
        Ok(numbers)
    }

    /// Reports that something else was expected.
    pub(super) fn unexpected<T>(&mut self, tokens: &Tokens, token: Token, expected: &str) -> Step<T> {
        let found = match token.kind {
            TokenKind::End => "the end of the file".to_owned(),
            _ => shortened(&String::from_utf8_lossy(tokens.bytes(token))),
        };
        let message = format!("{expected} should stand here, not {found}");
        self.report.error("unexpected-token", message, tokens.span(token));
        Err(Abandoned)
    }
}

/// Skips to the next directive.
fn recover(tokens: &mut Tokens) {
    loop {
        let token = tokens.peek();
        match token.kind {
            TokenKind::End => return,
            TokenKind::Word if is_directive(tokens.bytes(token)) => return,
            _ => _ = tokens.next(),
        }
    }
}

/// A word of a file, fit for a message.
fn shortened(word: &str) -> String {
    const LONGEST: usize = 40;
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &word[..end]),
        None => word.to_owned(),
    }
}
