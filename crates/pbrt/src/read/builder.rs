//! Scenes built by calls instead of text: the statements of the format with values from memory.
//!
//! A record of all calls stands for the text of the scene, so that messages about it have places,
//! too. Equal scenes have equal records: of long arrays they have a hash.

use std::sync::Arc;

use description::schema::Settings;
use description::{ColorSpaceDesc, FileId, OptionsDesc, SourceMap, Span, Spanned, TransformDesc};
use math::DMat4;

use super::build;
use super::parameter::{ParameterType, RawParameter, Values};
use super::state::MaterialReference;
use super::statement::{
    CameraStatement, InstanceStatement, LightStatement, MaterialStatement, MediumStatement, ObjectStatement,
    ShapeStatement, Statement, Statements, TextureStatement,
};
use assets::AssetSource;
use description::DiagnosticList;
use description::Imported;
use description::did_you_mean;

/// The name of the record of calls.
const RECORD: &str = "<scene>";
/// The most values of an array that are recorded one by one.
const LONGEST: usize = 8;

/// A parameter of a call.
#[derive(Clone, Debug)]
pub struct Argument {
    /// Its name in the format.
    pub name: String,
    /// The name of its type, such as `rgb`. If absent, it is the type that the statement expects
    /// and the values fit: three numbers are a colour or a point, one is a grey.
    pub type_name: Option<String>,
    /// Its values.
    pub values: ArgumentValues,
    /// The length of a row, if they are an array of several dimensions: it must be that of a point,
    /// a colour or the indices of a face.
    pub row: Option<usize>,
}

/// The values of a parameter of a call. The description of the scene shares numbers and indices;
/// points are copied once more.
#[derive(Clone, Debug)]
pub enum ArgumentValues {
    /// Real numbers.
    Floats(Arc<[f32]>),
    /// Integers.
    Integers(Arc<[i32]>),
    /// Truth values.
    Bools(Vec<bool>),
    /// Texts, and names of textures and spectra.
    Strings(Vec<String>),
}

/// Where a thing is at the start and at the end of the shutter time: its matrices to the world.
#[derive(Clone, Copy, Debug)]
pub struct Motion(pub [DMat4; 2]);

impl Default for Motion {
    fn default() -> Self {
        Self([DMat4::IDENTITY; 2])
    }
}

/// What a shape has beside its type and parameters.
#[derive(Clone, Debug, Default)]
pub struct Placement {
    /// Where it is.
    pub motion: Motion,
    /// Whether its surface is turned inside out.
    pub reverse_orientation: bool,
    /// The name of its material.
    pub material: Option<String>,
    /// What it emits: a type and parameters.
    pub area_light: Option<(String, Vec<Argument>)>,
    /// The names of the media inside and outside; an empty name is none.
    pub media: Option<[String; 2]>,
    /// The object that it belongs to, instead of the world.
    pub object: Option<String>,
}

/// Collects the statements of a scene.
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    statements: Statements,
    record: String,
    report: DiagnosticList,
}

impl SceneBuilder {
    /// Sets the `Film`, `Sampler`, `PixelFilter`, `Integrator` or `Accelerator`; the error names
    /// these.
    pub fn set(&mut self, directive: &str, kind: &str, arguments: Vec<Argument>) -> Result<(), String> {
        let statement = self.statement(directive, kind, arguments);
        let all = &mut self.statements;
        let slot = match directive {
            "Film" => &mut all.film,
            "Sampler" => &mut all.sampler,
            "PixelFilter" => &mut all.filter,
            "Integrator" => &mut all.integrator,
            "Accelerator" => &mut all.accelerator,
            _ => return Err("only Film, Sampler, PixelFilter, Integrator and Accelerator are set".into()),
        };
        *slot = Some(statement);
        Ok(())
    }

    /// Sets an option; the error says which there are.
    pub fn option(&mut self, name: &str, values: ArgumentValues) -> Result<(), String> {
        let options = OptionsDesc::default().settings();
        let Some(option) = options.iter().find(|option| option.field.name == name) else {
            let help = did_you_mean(name, options.iter().map(|option| option.field.name));
            return Err(format!("there is no option `{name}` {}", help.unwrap_or_default()));
        };
        let types = ParameterType::of(option.kind);
        self.begin("Option");
        let mut parameter =
            self.parameter(Argument { name: name.into(), type_name: None, values, row: None });
        parameter.adopt(types);
        self.statements.options.retain(|earlier| earlier.name != name);
        self.statements.options.push(parameter);
        Ok(())
    }

    /// Sets the camera, which looks along +z with y up, and the medium around it.
    pub fn camera(&mut self, kind: &str, arguments: Vec<Argument>, motion: Motion, medium: Option<String>) {
        let statement = self.statement("Camera", kind, arguments);
        self.note(motion, &medium);
        let camera_from_world = super::state::TransformSet(motion.0).inverse();
        let medium = medium.map(|name| Spanned::new(name, statement.span));
        self.statements.camera = Some(CameraStatement { statement, camera_from_world, medium });
    }

    /// Adds a texture of numbers, or of spectra, under a name that no other of these has.
    pub fn texture(
        &mut self,
        name: &str,
        is_spectrum: bool,
        kind: &str,
        arguments: Vec<Argument>,
        world_from_texture: DMat4,
    ) {
        let statement = self.statement("Texture", kind, arguments);
        self.note(Motion([world_from_texture; 2]), &(name, is_spectrum));
        let name = Spanned::new(name.to_owned(), statement.span);
        let all = &mut self.statements;
        all.texture_names.insert((is_spectrum, name.value.clone()), name.span);
        all.texture_order.push(is_spectrum);
        let textures = if is_spectrum { &mut all.spectrum_textures } else { &mut all.float_textures };
        textures.push(TextureStatement { statement, name, world_from_texture });
    }

    /// Adds a material under a name.
    pub fn material(&mut self, name: &str, kind: &str, arguments: Vec<Argument>) {
        let statement = self.statement("Material", kind, arguments);
        self.note(Motion::default(), &name);
        let name = Some(Spanned::new(name.to_owned(), statement.span));
        self.statements.materials.push(MaterialStatement { statement, name });
    }

    /// Adds a medium under a name.
    pub fn medium(&mut self, name: &str, kind: &str, arguments: Vec<Argument>, motion: Motion) {
        let statement = self.statement("MakeNamedMedium", kind, arguments);
        self.note(motion, &name);
        let name = Spanned::new(name.to_owned(), statement.span);
        let world_from_medium = self.transform(motion);
        self.statements.media.push(MediumStatement { statement, name, world_from_medium });
    }

    /// Adds a light, in a medium.
    pub fn light(&mut self, kind: &str, arguments: Vec<Argument>, motion: Motion, medium: Option<String>) {
        let statement = self.statement("LightSource", kind, arguments);
        self.note(motion, &medium);
        let medium = medium.map(|name| Spanned::new(name, statement.span));
        let world_from_light = self.transform(motion);
        self.statements.lights.push(LightStatement { statement, world_from_light, medium });
    }

    /// Adds a shape.
    pub fn shape(&mut self, kind: &str, arguments: Vec<Argument>, placement: Placement) {
        let Placement { motion, reverse_orientation, material, area_light, media, object } = placement;
        let area_light = area_light.map(|(kind, arguments)| {
            let statement = self.statement("AreaLightSource", &kind, arguments);
            self.statements.area_lights.push(statement);
            self.statements.area_lights.len() as u32 - 1
        });
        let statement = self.statement("Shape", kind, arguments);
        self.note(motion, &(reverse_orientation, &material, area_light, &media, &object));
        let spanned = |name: String| Spanned::new(name, statement.span);
        let shape = ShapeStatement {
            world_from_object: self.transform(motion),
            reverse_orientation,
            material: match material {
                Some(name) => MaterialReference::Named(spanned(name)),
                None => MaterialReference::Default,
            },
            area_light,
            medium_interface: media.map(|names| names.map(spanned)),
            statement,
        };
        match object.and_then(|name| self.object_named(&name)) {
            Some(object) => object.shapes.push(shape),
            None => self.statements.shapes.push(shape),
        }
    }

    /// Adds an object of that name, without shapes yet. It is drawn where it has instances.
    pub fn object(&mut self, name: &str) {
        let span = self.begin("ObjectBegin");
        self.note(Motion::default(), &name);
        let name = Spanned::new(name.to_owned(), span);
        self.statements.objects.push(ObjectStatement { name, shapes: Vec::new(), instances: Vec::new() });
    }

    /// Adds an instance of an object, to the world or to another object.
    pub fn instance(&mut self, object: &str, motion: Motion, into: Option<&str>) {
        let span = self.begin("ObjectInstance");
        self.note(motion, &(object, into));
        let object = Spanned::new(object.to_owned(), span);
        let world_from_object = self.transform(motion);
        let instance = InstanceStatement { object, span, world_from_object };
        match into.and_then(|name| self.object_named(name)) {
            Some(object) => object.instances.push(instance),
            None => self.statements.instances.push(instance),
        }
    }

    /// The scene. Files that it names are relative to the current folder of the assets.
    pub fn finish(self, assets: &dyn AssetSource) -> Imported {
        let mut sources = SourceMap::default();
        sources.add(RECORD.to_owned(), self.record.into_bytes());
        let (desc, report) = build::build(self.statements, self.report, &sources, assets);
        Imported { desc, sources, diagnostics: report.finish() }
    }

    fn object_named(&mut self, name: &str) -> Option<&mut ObjectStatement> {
        self.statements.objects.iter_mut().find(|object| object.name.value == name)
    }

    fn transform(&self, motion: Motion) -> TransformDesc {
        let [start, end] = motion.0;
        TransformDesc { start, end, times: self.statements.transform_times.unwrap_or([0.0, 1.0]) }
    }

    fn statement(&mut self, directive: &str, kind: &str, arguments: Vec<Argument>) -> Statement {
        let begin = self.begin(directive);
        let kind_span = self.write(&format!(" {kind:?}"));
        let parameters: Vec<_> = arguments.into_iter().map(|argument| self.parameter(argument)).collect();
        let end = parameters.last().map_or(kind_span, |last| last.span);
        Statement {
            span: begin.to(end),
            kind: Spanned::new(kind.to_owned(), kind_span),
            parameters,
            defaults: Default::default(),
            color_space: ColorSpaceDesc::Srgb,
        }
    }

    fn parameter(&mut self, argument: Argument) -> RawParameter {
        let Argument { name, type_name, values, row } = argument;
        let declaration = self.write(&match &type_name {
            Some(type_name) => format!(" \"{type_name} {name}\""),
            None => format!(" \"{name}\""),
        });
        let (natural, text) = match &values {
            ArgumentValues::Floats(values) => {
                (ParameterType::Float, shown(values, |value| value.to_le_bytes()))
            }
            ArgumentValues::Integers(values) => {
                (ParameterType::Integer, shown(values, |value| value.to_le_bytes()))
            }
            ArgumentValues::Bools(values) => (ParameterType::Bool, shown(values, |&value| [value.into()])),
            ArgumentValues::Strings(values) => (ParameterType::String, format!(" {values:?}")),
        };
        let span = self.write(&text);
        let values = match values {
            ArgumentValues::Floats(values) => Values::Floats(values),
            ArgumentValues::Integers(values) => Values::Integers(values),
            ArgumentValues::Bools(values) => Values::Bools(values),
            ArgumentValues::Strings(values) => {
                Values::Strings(values.into_iter().map(|value| Spanned::new(value, span)).collect())
            }
        };
        let mut parameter = RawParameter {
            kind: natural,
            is_typed: false,
            name,
            values,
            row,
            span: declaration.to(span),
            declaration,
            color_space: ColorSpaceDesc::Srgb,
        };
        match type_name.map(|name| (ParameterType::from_name(&name), name)) {
            Some((Some(kind), _)) => {
                parameter.adopt(&[kind]);
                parameter.kind = kind;
                parameter.is_typed = true;
            }
            Some((None, name)) => {
                let message = format!("there is no parameter type `{name}`");
                self.report.error("unknown-parameter-type", message, declaration);
            }
            None => {}
        }
        parameter
    }

    /// Records the rest of a call.
    fn note(&mut self, motion: Motion, rest: &dyn std::fmt::Debug) {
        let [start, end] = motion.0.map(|matrix| matrix.to_cols_array());
        let moves = if start == end { String::new() } else { format!(" to {end:?}") };
        self.write(&format!(" at {start:?}{moves} {rest:?}"));
    }

    /// Begins a line of the record.
    fn begin(&mut self, directive: &str) -> Span {
        if !self.record.is_empty() {
            self.record.push('\n');
        }
        self.write(directive)
    }

    /// Adds a text to the record; its span is without the space at its beginning.
    fn write(&mut self, text: &str) -> Span {
        let begin = self.record.len() + text.len() - text.trim_start().len();
        self.record.push_str(text);
        Span::new(FileId(0), begin as u32, self.record.len() as u32)
    }
}

/// Values as they are recorded.
fn shown<T: std::fmt::Debug, const N: usize>(values: &[T], bytes: impl Fn(&T) -> [u8; N]) -> String {
    if values.len() <= LONGEST {
        return format!(" {values:?}");
    }
    let mut hasher = blake3::Hasher::new();
    let mut block = Vec::new();
    for chunk in values.chunks(1 << 14) {
        block.clear();
        block.extend(chunk.iter().flat_map(&bytes));
        hasher.update(&block);
    }
    format!(" [{} values, {}]", values.len(), hasher.finalize().to_hex())
}

#[cfg(test)]
mod tests {
    use super::*;
    use assets::MemoryAssets;

    fn argument(name: &str, values: ArgumentValues) -> Argument {
        Argument { name: name.into(), type_name: None, values, row: None }
    }

    fn floats(name: &str, values: &[f32]) -> Argument {
        argument(name, ArgumentValues::Floats(values.into()))
    }

    #[test]
    fn numbers_that_are_no_colour_are_refused() {
        for (values, problem) in [
            (&[0.5, 0.5][..], "`reflectance` has 2 numbers; a colour has three"),
            (&[255.0, 0.0], "`reflectance` has 2 numbers; a colour has three"),
            (&[0.1, 0.2, 0.3, 1.0], "`reflectance` has 4 numbers; a colour has three"),
            (&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "`reflectance` takes 3 values, not 6"),
        ] {
            let mut builder = SceneBuilder::default();
            builder.material("paint", "diffuse", vec![floats("reflectance", values)]);
            let found = builder.finish(&MemoryAssets::default()).diagnostics;
            assert!(found.iter().any(|found| found.message.starts_with(problem)), "{values:?}: {found:?}");
        }
        let mut builder = SceneBuilder::default();
        let samples = floats("reflectance", &[400.0, 0.2, 700.0, 0.4]);
        builder.material("paint", "diffuse", vec![samples]);
        let found = builder.finish(&MemoryAssets::default());
        assert!(!found.has_errors(), "{:?}", found.diagnostics);
    }

    #[test]
    fn calls_give_the_scene_of_the_text() {
        let mut builder = SceneBuilder::default();
        let film = vec![argument("xresolution", ArgumentValues::Integers([7].into()))];
        builder.set("Film", "rgb", film).unwrap();
        builder.option("seed", ArgumentValues::Integers([3].into())).unwrap();
        let fov = argument("fov", ArgumentValues::Integers([40].into()));
        builder.camera("perspective", vec![fov], Motion::default(), None);
        let checks = vec![floats("tex1", &[0.1, 0.2, 0.3]), floats("tex2", &[0.5])];
        builder.texture("checks", true, "checkerboard", checks, DMat4::IDENTITY);
        let checks = ArgumentValues::Strings(vec!["checks".into()]);
        let checks = Argument { type_name: Some("texture".into()), ..argument("reflectance", checks) };
        builder.material("floor", "diffuse", vec![checks]);
        let motion = Motion([DMat4::from_translation([1.0, 2.0, 3.0].into()); 2]);
        builder.light("point", vec![floats("I", &[2.0])], motion, None);
        let mesh = vec![
            floats("P", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
            argument("indices", ArgumentValues::Integers([0, 1, 2].into())),
        ];
        let emission = Some(("diffuse".into(), vec![floats("L", &[1.0, 1.0, 0.5])]));
        let placement =
            Placement { material: Some("floor".into()), area_light: emission, ..Placement::default() };
        builder.shape("trianglemesh", mesh, placement);
        builder.object("ball");
        let placement = Placement { object: Some("ball".into()), ..Placement::default() };
        builder.shape("sphere", vec![floats("radius", &[2.0])], placement);
        builder.instance("ball", motion, None);

        let text = r#"
            Film "rgb" "integer xresolution" 7
            Option "integer seed" 3
            Camera "perspective" "float fov" 40
            WorldBegin
            Texture "checks" "spectrum" "checkerboard"
                "rgb tex1" [0.1 0.2 0.3] "rgb tex2" [0.5 0.5 0.5]
            MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "checks"
            AttributeBegin
                Translate 1 2 3
                LightSource "point" "rgb I" [2 2 2]
            AttributeEnd
            AttributeBegin
                NamedMaterial "floor"
                AreaLightSource "diffuse" "rgb L" [1 1 0.5]
                Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
            AttributeEnd
            ObjectBegin "ball"
                Shape "sphere" "float radius" 2
            ObjectEnd
            Translate 1 2 3
            ObjectInstance "ball"
        "#;
        let text = text.replace("Option \"integer seed\" 3", "Option \"seed\" 3");
        let read = super::super::read("a.pbrt", &MemoryAssets::default().with("a.pbrt", text));
        assert!(!read.has_errors(), "{:?}", read.diagnostics);
        let built = builder.finish(&MemoryAssets::default());
        assert!(built.diagnostics.is_empty(), "{:?}", built.diagnostics);
        // Places differ, and zeros of inverse matrices; everything else is the same.
        let plain = |imported: &Imported| {
            let text = format!("{:?}", imported.desc).replace("-0.0", "0.0");
            let mut parts = text.split("Span {");
            let first = parts.next().unwrap().to_owned();
            parts.fold(first, |all, part| all + part.split_once('}').unwrap().1)
        };
        assert_eq!(plain(&built), plain(&read));
        assert_eq!((built.desc.lights.len(), built.desc.shapes.len()), (1, 1));
    }

    #[test]
    fn errors_have_places_in_the_record() {
        let mut builder = SceneBuilder::default();
        builder.material("a", "diffuse", vec![floats("reflectence", &[0.5])]);
        builder.shape("sphere", vec![floats("radius", &[1.0, 2.0])], Placement::default());
        let built = builder.finish(&MemoryAssets::default());
        let places: Vec<_> = built
            .diagnostics
            .iter()
            .filter(|found| found.is_error())
            .map(|found| (built.sources.position(found.span()).line, found.code))
            .collect();
        assert_eq!(places, [(1, "unknown-parameter"), (2, "parameter-count")]);
        assert!(built.diagnostics[0].help.as_ref().unwrap().contains("`reflectance`"));
    }

    #[test]
    fn rows_must_be_points_or_faces() {
        let mesh = |point: usize, face: usize| {
            let mut builder = SceneBuilder::default();
            let points = Argument { row: Some(point), ..floats("P", &[0.0; 12]) };
            let indices = ArgumentValues::Integers([0, 1, 2, 1, 2, 3].into());
            let indices = Argument { row: Some(face), ..argument("indices", indices) };
            builder.shape("trianglemesh", vec![points, indices], Placement::default());
            let errors = builder.finish(&MemoryAssets::default()).diagnostics;
            errors.into_iter().map(|error| error.message).filter(|text| text.contains("rows")).count()
        };
        assert_eq!((mesh(3, 3), mesh(4, 3), mesh(3, 2)), (0, 1, 1));
    }

    #[test]
    fn wrong_settings_are_refused() {
        let mut builder = SceneBuilder::default();
        assert!(builder.set("Flim", "rgb", Vec::new()).is_err());
        let error = builder.option("sead", ArgumentValues::Integers([1].into())).unwrap_err();
        assert!(error.contains("`seed`"), "{error}");
    }
}
