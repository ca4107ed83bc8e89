//! Builds the integrator and sampler that a scene describes.

use description::schema::Settings;
use description::{
    BdptDesc, CameraKind, Connected, Diagnostic, Engine, HaltonRandomization, IntegratorDesc, MaterialKind,
    MltTechnique, PathDesc, Randomization, ReflectionsDesc, SamplerKind, SceneDesc, Spanned,
};
use film::Layer;
use sampling::sampler::{Halton, Independent, PaddedSobol, Pmj02Bn, Sobol, Stratified, ZSobol};
use sampling::{Randomize, Sampler, hash};
use scene::Interfaces;
use scene::texture::color_space;

use crate::adaptive::{Adaptive, PixelIntegrator};
use crate::bidirectional::techniques::{MAX_BYTES, MAX_DEPTH};
use crate::{
    AmbientOcclusion, Bdpt, Function, Integrator, LightTracing, MAX_PHOTON_PATHS, Mlt, Path, PhotonMapping,
    PixelLoop, Radiosity, RandomWalk, RayCasting, RayIntegrator, SimplePath, Sppm, Vcm, WaveIntegrator,
    Wavefront, Whitted,
};

/// The result of [`build`].
pub struct Built {
    /// The algorithm with its sampler.
    pub integrator: Box<dyn Integrator>,
    /// Settings that are rendered differently from their description, in any scene.
    pub warnings: Vec<Diagnostic>,
}

/// Builds the integrator of a scene. Returns all errors and warnings if there is an error.
pub fn build(desc: &SceneDesc) -> Result<Built, Vec<Diagnostic>> {
    let mut wrong = desc.sampler.check(&desc.sampler.origin);
    wrong.extend(desc.integrator.check(&desc.integrator.origin));
    let mut builder = Builder { desc, diagnostics: wrong };
    if builder.diagnostics.iter().any(Diagnostic::is_error) {
        return Err(builder.diagnostics);
    }
    let integrator = builder.integrator(sampler(desc));
    builder.media();
    builder.subsurface();
    builder.connections_to_lens();
    builder.parts();
    builder.samples();
    let diagnostics = builder.diagnostics;
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(diagnostics);
    }
    Ok(Built { integrator, warnings: diagnostics })
}

/// The sampler of a scene whose settings are valid.
pub fn sampler(scene: &SceneDesc) -> Sampler {
    sampler_with_seed(scene, seed(scene))
}

/// The sampler of light paths of a scene, independent of that of camera paths.
pub fn light_sampler(scene: &SceneDesc) -> Sampler {
    const LIGHTS: u32 = 0x6c69_6768;
    let seed = hash(&[seed(scene), LIGHTS]) as u32;
    let samples = scene.sampler.kind.arranged_samples();
    Sampler::PaddedSobol(PaddedSobol::new(samples, Randomize::FastOwen, seed))
}

/// The seed of what the integrator of a scene draws beside the numbers of its samplers: photons, or
/// chains.
pub fn seed_of_integrator(scene: &SceneDesc) -> u32 {
    const PHOTONS: u32 = 0x7068_6f74;
    let given = match &scene.integrator.value {
        IntegratorDesc::Sppm(desc) => desc.seed,
        other if other.facts().stores_photons => None,
        _ => return seed(scene),
    };
    hash(&[given.map_or(seed(scene), |seed| seed as u32), PHOTONS]) as u32
}

/// The seed of the sampler of a scene.
fn seed(scene: &SceneDesc) -> u32 {
    scene.sampler.seed.unwrap_or(scene.options.seed) as u32
}

fn sampler_with_seed(scene: &SceneDesc, seed: u32) -> Sampler {
    let desc = &scene.sampler;
    let (samples, resolution) = (desc.kind.samples_per_pixel(), scene.film.resolution);
    match desc.kind {
        SamplerKind::Independent { .. } => Sampler::Independent(Independent::new(samples, seed)),
        SamplerKind::Stratified { strata, jitter } => {
            Sampler::Stratified(Stratified::new(strata, jitter, seed))
        }
        SamplerKind::Halton { randomization, .. } => {
            let randomization = match randomization {
                HaltonRandomization::None => Randomize::None,
                HaltonRandomization::PermuteDigits => Randomize::PermuteDigits,
                HaltonRandomization::Owen => Randomize::Owen,
            };
            Sampler::Halton(Halton::new(samples, randomization, seed))
        }
        SamplerKind::PaddedSobol { randomization, .. } => {
            Sampler::PaddedSobol(PaddedSobol::new(samples, randomize(randomization), seed))
        }
        SamplerKind::Sobol { randomization, .. } => {
            Sampler::Sobol(Sobol::new(samples, resolution, randomize(randomization), seed))
        }
        SamplerKind::ZSobol { randomization, .. } => {
            Sampler::ZSobol(ZSobol::new(samples, resolution, randomize(randomization), seed))
        }
        SamplerKind::Pmj02Bn { .. } => Sampler::Pmj02Bn(Pmj02Bn::new(samples, seed)),
    }
}

struct Builder<'a> {
    desc: &'a SceneDesc,
    diagnostics: Vec<Diagnostic>,
}

impl Builder<'_> {
    /// Warns if there are media, but the algorithm does not know them.
    fn media(&mut self) {
        let integrator = &self.desc.integrator;
        if self.desc.media.is_empty() || integrator.facts().knows_media {
            return;
        }
        let message =
            format!("integrator `{}` does not know participating media; left out", integrator.name());
        let warning = Diagnostic::warning("no-media", message, integrator.origin.span);
        self.diagnostics.push(warning.with_help("`vol-path` draws them"));
    }

    /// Whether the film has layers of parts of the light.
    fn has_parts(&self) -> bool {
        self.parts_of_film().next().is_some()
    }

    fn parts_of_film(&self) -> impl Iterator<Item = &Spanned<String>> {
        let layers = self.desc.film.layers.iter();
        layers.filter(|name| Layer::from_name(&name.value).is_some_and(Layer::is_part))
    }

    /// Checks that the algorithm makes the layers of parts of the light, if there are any.
    fn parts(&mut self) {
        let integrator = &self.desc.integrator;
        if integrator.facts().makes_parts {
            return;
        }
        let error = |name: &Spanned<String>| {
            let message =
                format!("integrator `{}` does not make the layer `{}`", integrator.name(), name.value);
            let error = Diagnostic::error("invalid-film", message, name.span);
            let makers = IntegratorDesc::names_with(|facts| facts.makes_parts);
            error.with_help(format!("{makers} make it"))
        };
        let errors: Vec<_> = self.parts_of_film().map(error).collect();
        self.diagnostics.extend(errors);
    }

    /// Whether a material scatters under its surface.
    fn has_subsurface(&self) -> bool {
        let mut materials = self.desc.materials.iter();
        materials.any(|(_, material)| match &material.kind {
            MaterialKind::Subsurface { .. } => true,
            MaterialKind::OpenPbr(surface) => surface.scatters_under(),
            _ => false,
        })
    }

    /// Warns if there are materials that scatter under their surface, but the algorithm does not
    /// know them.
    fn subsurface(&mut self) {
        let integrator = &self.desc.integrator;
        if integrator.facts().knows_subsurface || !self.has_subsurface() {
            return;
        }
        let message = format!(
            "integrator `{}` does not know scattering under surfaces; bodies are drawn as diffuse surfaces of their effective albedo under a boundary",
            integrator.name()
        );
        let warning = Diagnostic::warning("no-subsurface", message, integrator.origin.span);
        self.diagnostics
            .push(warning.with_help("`path`, `vol-path` and algorithms with light paths draw it"));
    }

    /// Warns if pixels cannot take different numbers of samples.
    fn samples(&mut self) {
        let integrator = &self.desc.integrator;
        if self.desc.options.adaptive.is_none() || integrator.facts().estimates_pixels {
            return;
        }
        let message = format!(
            "integrator `{}` does not estimate pixels one by one; all take the same number of samples",
            integrator.name()
        );
        self.diagnostics.push(Diagnostic::warning("not-adaptive", message, integrator.origin.span));
    }

    fn integrator(&mut self, sampler: Sampler) -> Box<dyn Integrator> {
        let color_space = color_space(self.desc.film.color_space);
        let seed = seed_of_integrator(self.desc);
        match self.desc.integrator.value.clone() {
            IntegratorDesc::RayCasting => self.waves_in_media(RayCasting, sampler),
            IntegratorDesc::Whitted(desc) if desc.reflections != ReflectionsDesc::Traced => {
                self.pixels(Whitted::new(desc), sampler)
            }
            IntegratorDesc::Whitted(desc) => self.waves_in_media(Whitted::new(desc), sampler),
            IntegratorDesc::AmbientOcclusion(desc) => {
                self.waves(AmbientOcclusion::new(desc, color_space), sampler)
            }
            IntegratorDesc::RandomWalk(desc) => self.pixels(RandomWalk(desc), sampler),
            IntegratorDesc::SimplePath(desc) => self.pixels(SimplePath(desc), sampler),
            IntegratorDesc::Path(desc) => self.path(desc, Interfaces::Stop, sampler),
            IntegratorDesc::VolPath(desc) => self.path(desc, Interfaces::Pass, sampler),
            IntegratorDesc::SimpleVolPath(desc) => {
                self.pixels(Path::without_light_sampling(desc.max_depth), sampler)
            }
            IntegratorDesc::LightTracing(desc) => {
                let light_sampler = light_sampler(self.desc);
                Box::new(LightTracing::new(desc, sampler, light_sampler))
            }
            IntegratorDesc::Bdpt(desc) => {
                let light_sampler = light_sampler(self.desc);
                let bdpt = Bdpt::new(desc, sampler, light_sampler);
                self.techniques(&desc, &bdpt);
                Box::new(bdpt)
            }
            IntegratorDesc::Mlt(desc) => Box::new(Mlt::new(desc, sampler, seed)),
            IntegratorDesc::PhotonMapping(desc) => Box::new(PhotonMapping::new(desc, sampler, seed)),
            IntegratorDesc::Vcm(desc) => {
                let light_sampler = light_sampler(self.desc);
                Box::new(Vcm::new(desc, sampler, light_sampler, seed, MAX_PHOTON_PATHS))
            }
            IntegratorDesc::Sppm(desc) => Box::new(Sppm::new(desc, sampler, seed)),
            IntegratorDesc::Radiosity(desc) => Box::new(Radiosity::new(desc, sampler, color_space)),
            IntegratorDesc::Function(desc) => {
                self.diagnostics.extend(Function::unwritable(&desc, &self.desc.integrator.origin));
                Box::new(Function::new(desc, sampler, color_space))
            }
        }
    }

    /// Checks connections of light paths to the camera, which a system of lenses does not have: an
    /// error where the picture consists of them, a warning where others remain.
    fn connections_to_lens(&mut self) {
        if !matches!(self.desc.camera.kind, CameraKind::Realistic(_)) {
            return;
        }
        let (name, span) = (self.desc.integrator.name(), self.desc.integrator.origin.span);
        let over_paths = MltTechnique::Path;
        let is_over_camera_paths =
            matches!(&self.desc.integrator.value, IntegratorDesc::Mlt(mlt) if mlt.technique == over_paths);
        let lost = match self.desc.integrator.facts().connected {
            Connected::All => {
                let message = format!("`{name}` cannot connect light paths to a `realistic` camera");
                let error = Diagnostic::error("invalid-integrator", message, span);
                self.diagnostics.push(error.with_help("use an algorithm with camera paths, as `path`"));
                return;
            }
            Connected::Some(lost) if !is_over_camera_paths => lost,
            Connected::Some(_) | Connected::Nothing => return,
        };
        let message = format!("`{name}` cannot connect light paths to a `realistic` camera; {lost}");
        self.diagnostics.push(Diagnostic::warning("camera-connections", message, span));
    }

    /// Checks the pictures of strategies: a warning if some are left out, an error if they take too
    /// much memory.
    fn techniques(&mut self, settings: &BdptDesc, bdpt: &Bdpt) {
        if !(settings.visualize_strategies || settings.visualize_weights) {
            return;
        }
        let parameter =
            if settings.visualize_strategies { "visualizestrategies" } else { "visualizeweights" };
        if settings.max_depth > MAX_DEPTH {
            let message = format!(
                "there are no pictures of strategies for paths with more than {MAX_DEPTH} scattering events"
            );
            let span = self.desc.integrator.origin.parameter(parameter);
            self.diagnostics.push(Diagnostic::warning("techniques", message, span));
        }
        let bytes = bdpt.technique_bytes(film::pixel_bounds(&self.desc.film).area());
        if bytes > MAX_BYTES {
            let [bytes, most] = [bytes, MAX_BYTES].map(|bytes| bytes as f64 / f64::from(1 << 30));
            let message = format!(
                "pictures of all strategies take {bytes:.1} GiB, more than {most:.0} GiB; render fewer pixels or lower `maxdepth`"
            );
            let span = self.desc.integrator.origin.parameter(parameter);
            self.diagnostics.push(Diagnostic::error("invalid-integrator", message, span));
        }
    }

    /// An algorithm that both engines have, and that knows media in the scalar one.
    fn waves_in_media(&self, rays: impl WaveIntegrator + 'static, sampler: Sampler) -> Box<dyn Integrator> {
        if self.desc.media.is_empty() { self.waves(rays, sampler) } else { self.pixels(rays, sampler) }
    }

    /// An algorithm that the scalar engine has.
    fn pixels(&self, rays: impl RayIntegrator + 'static, sampler: Sampler) -> Box<dyn Integrator> {
        self.adaptive(PixelLoop::new(rays, sampler.clone()), sampler)
    }

    /// An algorithm with this sampler, which may take more samples where pixels differ.
    fn adaptive(&self, pixels: impl PixelIntegrator + 'static, sampler: Sampler) -> Box<dyn Integrator> {
        const COARSE: u32 = 0x636f_6172;
        let Some(limit) = self.desc.options.adaptive else { return Box::new(pixels) };
        let coarse = sampler_with_seed(self.desc, hash(&[seed(self.desc), COARSE]) as u32);
        Box::new(Adaptive::new(pixels, [sampler, coarse], limit))
    }

    /// An algorithm that both engines have.
    fn waves(&self, rays: impl WaveIntegrator + 'static, sampler: Sampler) -> Box<dyn Integrator> {
        match self.desc.options.engine {
            Engine::Wavefront => self.adaptive(Wavefront::new(rays, sampler.clone()), sampler),
            Engine::Scalar => self.pixels(rays, sampler),
        }
    }

    fn path(&self, desc: PathDesc, interfaces: Interfaces, sampler: Sampler) -> Box<dyn Integrator> {
        let path = Path::new(desc, interfaces);
        if self.has_parts() { self.pixels(path, sampler) } else { self.waves(path, sampler) }
    }
}

fn randomize(randomization: Randomization) -> Randomize {
    match randomization {
        Randomization::None => Randomize::None,
        Randomization::PermuteDigits => Randomize::PermuteDigits,
        Randomization::FastOwen => Randomize::FastOwen,
        Randomization::Owen => Randomize::Owen,
    }
}
