//! From statements to descriptions: a file for each family of statements; this file resolves names
//! and files for all of them.

mod asked;
mod camera;
mod files;
mod light;
mod material;
mod medium;
mod reader;
#[cfg(test)]
mod reference;
mod settings;
mod shape;
mod spectra;
mod texture;
mod volume;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use description::{
    Diagnostic, FloatTextureDesc, Handle, MaterialDesc, MediumDesc, ObjectDesc, Origin, SceneDesc, SourceMap,
    Span, Spanned, SpectrumDesc, SpectrumTextureDesc, Stated,
};
use scattering::MeasuredTable;

use self::files::ImageRequests;
use self::reader::Reader;
use super::state::MaterialReference;
use super::statement::{MaterialStatement, MediumStatement, Statement, Statements};
use assets::AssetSource;
use description::DiagnosticList;
use description::{closest, did_you_mean};

/// Turns the statements of a scene into its description.
pub(crate) fn build(
    mut statements: Statements,
    report: DiagnosticList,
    sources: &SourceMap,
    assets: &dyn AssetSource,
) -> (SceneDesc, DiagnosticList) {
    let mut builder = Builder::new(&statements, report, sources, assets);
    let desc = builder.scene(&mut statements);
    (desc, builder.report)
}

/// Wavelengths and values.
type Samples = Arc<[(f32, f32)]>;

/// Builds descriptions; its state is shared by all families.
pub(crate) struct Builder<'a> {
    pub(crate) report: DiagnosticList,
    assets: &'a dyn AssetSource,
    sources: &'a SourceMap,
    float_textures: HashMap<String, Handle<FloatTextureDesc>>,
    spectrum_textures: HashMap<String, Handle<SpectrumTextureDesc>>,
    materials: HashMap<String, Handle<MaterialDesc>>,
    media: HashMap<String, Handle<MediumDesc>>,
    spectra: HashMap<PathBuf, Option<Samples>>,
    measurements: HashMap<PathBuf, Option<Arc<MeasuredTable>>>,
    /// Declarations of the attributes that some statement used.
    pub(crate) used_attributes: HashSet<Span>,
    images: ImageRequests,
    meshes: shape::Meshes,
    grids: volume::Grids,
    objects: HashMap<String, Handle<ObjectDesc>>,
    /// The number of objects that are complete, and may be operands of a solid.
    complete_objects: usize,
    /// Types of the statements that were read, with the parameters that they looked up.
    #[cfg(test)]
    recorded: Vec<(String, Vec<asked::Asked>)>,
}

impl<'a> Builder<'a> {
    fn new(
        statements: &Statements,
        report: DiagnosticList,
        sources: &'a SourceMap,
        assets: &'a dyn AssetSource,
    ) -> Self {
        let mut builder = Self {
            report,
            assets,
            sources,
            float_textures: HashMap::new(),
            spectrum_textures: HashMap::new(),
            materials: HashMap::new(),
            media: HashMap::new(),
            spectra: HashMap::new(),
            measurements: HashMap::new(),
            used_attributes: HashSet::new(),
            images: ImageRequests::default(),
            meshes: HashMap::new(),
            grids: HashMap::new(),
            objects: HashMap::new(),
            complete_objects: 0,
            #[cfg(test)]
            recorded: Vec::new(),
        };
        builder.materials =
            builder.table("material", &statements.materials, |material: &MaterialStatement| {
                material.name.as_ref()
            });
        builder.media =
            builder.table("medium", &statements.media, |medium: &MediumStatement| Some(&medium.name));
        builder
    }

    /// The description of all statements.
    fn scene(&mut self, statements: &mut Statements) -> SceneDesc {
        let mut desc = SceneDesc { options: self.options(statements), ..SceneDesc::default() };
        if let Some(film) = statements.film.take() {
            desc.film = self.film(film);
        }
        if let Some(filter) = statements.filter.take() {
            desc.filter = self.filter(filter);
        }
        if let Some(sampler) = statements.sampler.take() {
            desc.sampler = self.sampler(sampler);
        }
        if let Some(integrator) = statements.integrator.take() {
            desc.integrator = self.integrator(integrator);
        }
        if let Some(accelerator) = statements.accelerator.take() {
            desc.accelerator = self.accelerator(accelerator);
        }
        if let Some(camera) = statements.camera.take() {
            desc.camera = self.camera(camera, statements.transform_times.unwrap_or([0.0, 1.0]));
        }
        self.textures(statements, &mut desc);
        desc.media = statements.media.drain(..).map(|medium| self.medium(medium)).collect();
        desc.materials = self.materials(std::mem::take(&mut statements.materials));
        desc.lights = statements.lights.drain(..).filter_map(|light| self.light(light)).collect();
        desc.area_lights = statements.area_lights.drain(..).map(|light| self.area_light(light)).collect();
        self.load_meshes(statements);
        self.objects = self.table("object", &statements.objects, |object| Some(&object.name));
        self.complete_objects = statements.objects.len();
        for shape in statements.shapes.drain(..) {
            if let Some(shape) = self.shape(shape) {
                desc.shapes.push_stated(shape);
            }
        }
        self.objects(statements, &mut desc);
        desc.images = self.decode_images();
        self.unused_attributes(statements);
        desc
    }

    /// The handles of all named statements of a kind. Of several with the same name the first wins.
    fn table<S, T>(
        &mut self,
        what: &str,
        statements: &[S],
        name: impl Fn(&S) -> Option<&Spanned<String>>,
    ) -> HashMap<String, Handle<T>> {
        let mut table: HashMap<String, Handle<T>> = HashMap::new();
        for (index, statement) in statements.iter().enumerate() {
            let Some(spanned) = name(statement) else { continue };
            if let Some(first) = table.get(&spanned.value) {
                let message = format!("there is already a {what} `{}`", spanned.value);
                let mut diagnostic = Diagnostic::error("redefinition", message, spanned.span);
                if let Some(first) = name(&statements[first.index()]) {
                    diagnostic = diagnostic.with_label(first.span, "first defined here");
                }
                self.report.push(diagnostic);
                continue;
            }
            table.insert(spanned.value.clone(), Handle::new(index as u32));
        }
        table
    }

    /// Reads a statement by a function that takes its parameters; reports those that it did not
    /// take.
    fn read<T>(
        &mut self,
        statement: Statement,
        read: impl FnOnce(&mut Reader<'_, 'a>) -> Option<T>,
    ) -> (Option<T>, Origin) {
        let mut reader = Reader::new(self, statement);
        let value = read(&mut reader);
        #[cfg(test)]
        reader.builder.recorded.push((reader.kind.value.clone(), reader.asked.clone()));
        match value {
            Some(value) => (Some(value), reader.finish()),
            None => (None, reader.abandon()),
        }
    }

    /// [`Builder::read`] with the default for a statement that cannot be read.
    fn read_or_default<T: Default>(
        &mut self,
        statement: Statement,
        read: impl FnOnce(&mut Reader<'_, 'a>) -> Option<T>,
    ) -> Stated<T> {
        let (value, origin) = self.read(statement, read);
        Stated::new(value.unwrap_or_default(), origin)
    }

    /// Reports attributes that no statement used: no statement followed, or none has such a
    /// parameter.
    fn unused_attributes(&mut self, statements: &Statements) {
        for attribute in &statements.attributes {
            if !self.used_attributes.contains(&attribute.span) {
                let message = format!("no statement uses the attribute `{}`", attribute.value);
                self.report.warning("ignored", message, attribute.span);
            }
        }
    }

    /// The texture of a name.
    pub(crate) fn float_texture(&mut self, name: &Spanned<String>) -> Option<Handle<FloatTextureDesc>> {
        let found = self.float_textures.get(&name.value).copied();
        if found.is_none() {
            let other = self.spectrum_textures.contains_key(&name.value).then_some("a spectrum texture");
            unknown_reference(&mut self.report, "float texture", name, other, &self.float_textures);
        }
        found
    }

    /// The texture of a name.
    pub(crate) fn spectrum_texture(&mut self, name: &Spanned<String>) -> Option<Handle<SpectrumTextureDesc>> {
        let found = self.spectrum_textures.get(&name.value).copied();
        if found.is_none() {
            let other = self.float_textures.contains_key(&name.value).then_some("a float texture");
            unknown_reference(&mut self.report, "spectrum texture", name, other, &self.spectrum_textures);
        }
        found
    }

    /// The material of a name.
    fn named_material(&mut self, name: &Spanned<String>) -> Option<Handle<MaterialDesc>> {
        let found = self.materials.get(&name.value).copied();
        if found.is_none() {
            unknown_reference(&mut self.report, "material", name, None, &self.materials);
        }
        found
    }

    fn material_reference(&mut self, reference: &MaterialReference) -> Option<Handle<MaterialDesc>> {
        match reference {
            MaterialReference::Default => None,
            MaterialReference::Nth(index) => Some(Handle::new(*index)),
            MaterialReference::Named(name) => self.named_material(name),
        }
    }

    /// The medium of a name; the empty name is empty space.
    fn named_medium(&mut self, name: &Spanned<String>) -> Option<Handle<MediumDesc>> {
        if name.value.is_empty() {
            return None;
        }
        let found = self.media.get(&name.value).copied();
        if found.is_none() {
            unknown_reference(&mut self.report, "medium", name, None, &self.media);
        }
        found
    }

    /// A spectrum by its name in the format or from a file of pairs of wavelength and value.
    pub(crate) fn named_spectrum(&mut self, name: &Spanned<String>) -> Option<SpectrumDesc> {
        if spectrum::names().any(|known| known == name.value) {
            return Some(SpectrumDesc::Named(name.value.clone()));
        }
        let path = self.path(name);
        if !self.spectra.contains_key(&path) {
            let samples = if self.assets.exists(&path) {
                self.spectrum_file(&path, name.span)
            } else {
                let mut message = format!("`{}` is neither the name of a spectrum nor a file", name.value);
                if path != Path::new(&name.value) {
                    message += &format!(": there is no `{}`, and none in the current folder", path.display());
                }
                let help =
                    closest(&name.value, spectrum::names()).map(|near| format!("did you mean `{near}`?"));
                let diagnostic = Diagnostic::error("unknown-spectrum", message, name.span);
                self.report.push(Diagnostic { help, ..diagnostic });
                None
            };
            self.spectra.insert(path.clone(), samples);
        }
        self.spectra[&path].clone().map(SpectrumDesc::Samples)
    }
}

/// Reports an unknown name; `other` is what it refers to instead.
fn unknown_reference<T>(
    report: &mut DiagnosticList,
    what: &str,
    name: &Spanned<String>,
    other: Option<&str>,
    table: &HashMap<String, Handle<T>>,
) {
    if report.has_too_many_errors() {
        return;
    }
    let mut known: Vec<_> = table.keys().map(String::as_str).collect();
    known.sort_unstable();
    let message = match other {
        Some(other) => format!("`{}` is {other}; a {what} is needed here", name.value),
        None => format!("there is no {what} `{}`", name.value),
    };
    let diagnostic = Diagnostic::error("unknown-reference", message, name.span);
    report.push(Diagnostic { help: did_you_mean(&name.value, known), ..diagnostic });
}
