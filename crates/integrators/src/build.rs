//! From what a scene's author said of algorithm and sampler to an integrator.

use description::{
    Diagnostic, IntegratorDesc, LightSamplerDesc, MltDesc, PhotonKernel, PhotonMappingDesc,
    PhotonMappingShow, RadiosityDesc, Randomization, SamplerKind, SceneDesc, SppmDesc, VcmDesc,
};
use sampling::sampler::{Halton, Independent, PaddedSobol, Sobol, Stratified, ZSobol};
use sampling::{Randomize, Sampler, hash};
use scene::Interfaces;
use scene::light_sampler::LightSamplerKind;
use scene::texture::color_space;

use crate::bidirectional::techniques::{MAX_BYTES, MAX_DEPTH};
use crate::light_paths::endless;
use crate::radiosity;
use crate::{
    AmbientOcclusion, Bdpt, BdptSettings, Integrator, Kernel, LightTracing, Mlt, MltSettings, Path,
    PathSettings, PhotonMapping, PhotonMappingSettings, PixelLoop, Radiosity, RadiositySettings, RandomWalk,
    RayCasting, RayIntegrator, SimplePath, Sppm, SppmSettings, Vcm, VcmSettings, Whitted,
};

/// What [`build`] gives.
pub struct Built {
    /// The algorithm with its sampler.
    pub integrator: Box<dyn Integrator>,
    /// What is drawn otherwise than described.
    pub warnings: Vec<Diagnostic>,
}

/// Makes the integrator of a scene, or tells everything that is wrong with its settings (warnings
/// included).
pub fn build(desc: &SceneDesc) -> Result<Built, Vec<Diagnostic>> {
    let mut builder = Builder { desc, diagnostics: Vec::new() };
    builder.media();
    let sampler = builder.sampler();
    let integrator = builder.integrator(sampler);
    let diagnostics = builder.diagnostics;
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(diagnostics);
    }
    Ok(Built { integrator, warnings: diagnostics })
}

struct Builder<'a> {
    desc: &'a SceneDesc,
    diagnostics: Vec<Diagnostic>,
}

impl Builder<'_> {
    /// Warns of each medium.
    fn media(&mut self) {
        for (_, medium) in self.desc.media.iter() {
            let message = "participating media are not drawn yet; left out";
            self.diagnostics.push(Diagnostic::warning("not-drawn", message, medium.origin.span));
        }
    }

    /// A positive number of samples; 1, and an error, where it is none.
    fn samples(&mut self, samples: i32, parameter: &str) -> u32 {
        match u32::try_from(samples) {
            Ok(samples) if samples > 0 => samples,
            _ => {
                let message = format!("`{parameter}` is a number above 0, not {samples}");
                let span = self.desc.sampler.origin.parameter(parameter);
                self.diagnostics.push(Diagnostic::error("invalid-sampler", message, span));
                1
            }
        }
    }

    fn sampler(&mut self) -> Sampler {
        let desc = &self.desc.sampler;
        let seed = desc.seed.unwrap_or(self.desc.options.seed) as u32;
        let resolution = self.desc.film.resolution;
        if let SamplerKind::Stratified { strata, jitter } = desc.kind {
            let strata = [self.samples(strata[0], "xsamples"), self.samples(strata[1], "ysamples")];
            return Sampler::Stratified(Stratified::new(strata, jitter, seed));
        }
        let samples = self.samples(desc.pixel_samples, "pixelsamples");
        match desc.kind {
            SamplerKind::Independent => Sampler::Independent(Independent::new(samples, seed)),
            SamplerKind::Halton { randomization } => {
                Sampler::Halton(Halton::new(samples, resolution, randomize(randomization), seed))
            }
            SamplerKind::PaddedSobol { randomization } => {
                Sampler::PaddedSobol(PaddedSobol::new(samples, randomize(randomization), seed))
            }
            SamplerKind::Sobol { randomization } => {
                Sampler::Sobol(Sobol::new(samples, resolution, randomize(randomization), seed))
            }
            SamplerKind::ZSobol { randomization } => {
                Sampler::ZSobol(ZSobol::new(samples, resolution, randomize(randomization), seed))
            }
            SamplerKind::Pmj02Bn | SamplerKind::Stratified { .. } => {
                let message = "sampler `pmj02bn` is not drawn yet; drawn with `zsobol`";
                self.diagnostics.push(Diagnostic::warning("not-drawn", message, desc.origin.span));
                Sampler::ZSobol(ZSobol::new(samples, resolution, Randomize::FastOwen, seed))
            }
        }
    }

    /// The sampler of paths that begin at lights, which has nothing in common with that of the
    /// camera's.
    fn light_sampler(&self, of_camera: &Sampler) -> Sampler {
        const LIGHTS: u32 = 0x6c69_6768;
        let seed = hash(&[self.desc.sampler.seed.unwrap_or(self.desc.options.seed) as u32, LIGHTS]) as u32;
        let samples = of_camera.samples_per_pixel();
        Sampler::PaddedSobol(PaddedSobol::new(samples, Randomize::FastOwen, seed))
    }

    /// The seed of photons, which have nothing in common with the other samplers.
    fn photon_seed(&self, seed: Option<i32>) -> u32 {
        const PHOTONS: u32 = 0x7068_6f74;
        let seed = seed.or(self.desc.sampler.seed).unwrap_or(self.desc.options.seed);
        hash(&[seed as u32, PHOTONS]) as u32
    }

    fn integrator(&mut self, sampler: Sampler) -> Box<dyn Integrator> {
        match &self.desc.integrator.value {
            IntegratorDesc::RayCasting => pixels(RayCasting, sampler),
            &IntegratorDesc::Whitted { max_depth } => {
                pixels(Whitted { max_depth: self.depth(max_depth) }, sampler)
            }
            &IntegratorDesc::AmbientOcclusion { cos_sample, max_distance } => {
                if max_distance.is_nan() || max_distance <= 0.0 {
                    let message = format!("`maxdistance` is a number above 0, not {max_distance}");
                    self.error(message, "maxdistance");
                }
                let color_space = color_space(self.desc.film.color_space);
                pixels(AmbientOcclusion::new(cos_sample, max_distance, color_space), sampler)
            }
            &IntegratorDesc::RandomWalk { max_depth } => {
                pixels(RandomWalk { max_depth: self.depth(max_depth) }, sampler)
            }
            &IntegratorDesc::SimplePath { max_depth, sample_lights, sample_bsdf } => {
                pixels(SimplePath { max_depth: self.depth(max_depth), sample_lights, sample_bsdf }, sampler)
            }
            &IntegratorDesc::Path { max_depth, regularize, light_sampler } => {
                self.path(max_depth, regularize, light_sampler, Interfaces::Stop, sampler)
            }
            &IntegratorDesc::VolPath { max_depth, regularize, light_sampler } => {
                self.path(max_depth, regularize, light_sampler, Interfaces::Pass, sampler)
            }
            &IntegratorDesc::SimpleVolPath { max_depth } => {
                self.instead_of("simplevolpath", max_depth, false, sampler)
            }
            &IntegratorDesc::LightTracing { max_depth } => {
                self.diagnostics.extend(endless::warnings(self.desc, "light-tracing"));
                let light_sampler = self.light_sampler(&sampler);
                Box::new(LightTracing::new(self.depth(max_depth), sampler, light_sampler))
            }
            &IntegratorDesc::Bdpt { max_depth, regularize, visualize_strategies, visualize_weights } => {
                let settings = BdptSettings {
                    max_depth: self.depth(max_depth),
                    regularize,
                    unweighted: visualize_strategies,
                    weighted: visualize_weights,
                };
                let light_sampler = self.light_sampler(&sampler);
                let bdpt = Bdpt::new(settings, sampler, light_sampler);
                self.techniques(&settings, &bdpt);
                Box::new(bdpt)
            }
            IntegratorDesc::Mlt(desc) => self.mlt(desc, sampler),
            IntegratorDesc::PhotonMapping(desc) => {
                self.diagnostics.extend(endless::warnings(self.desc, "photon-mapping"));
                let settings = self.photon_mapping(desc);
                Box::new(PhotonMapping::new(settings, sampler, self.photon_seed(None)))
            }
            &IntegratorDesc::Vcm(VcmDesc { max_depth, radius, alpha }) => {
                if alpha.is_nan() || alpha <= 0.0 || alpha > 1.0 {
                    self.error(format!("`alpha` is above 0 and at most 1, not {alpha}"), "alpha");
                }
                let radius = radius.map(|radius| self.radius(radius));
                let max_depth = self.depth(max_depth);
                let settings = VcmSettings { max_depth, radius, alpha, ..VcmSettings::default() };
                let light_sampler = self.light_sampler(&sampler);
                Box::new(Vcm::new(settings, sampler, light_sampler, self.photon_seed(None)))
            }
            &IntegratorDesc::Sppm(SppmDesc { max_depth, photons_per_iteration, radius, seed }) => {
                self.diagnostics.extend(endless::warnings(self.desc, "sppm"));
                let settings = SppmSettings {
                    max_depth: self.depth(max_depth),
                    photons_per_iteration: photons_per_iteration.map(|count| self.photons(count)),
                    radius: radius.map(|radius| self.radius(radius)),
                };
                Box::new(Sppm::new(settings, sampler, self.photon_seed(seed)))
            }
            IntegratorDesc::Radiosity(desc) => self.radiosity(desc, sampler),
            IntegratorDesc::Function { .. } => self.instead_of("function", 5, false, sampler),
        }
    }

    /// Tells which strategies' pictures are left out, and refuses those that take too much memory.
    fn techniques(&mut self, settings: &BdptSettings, bdpt: &Bdpt) {
        if !(settings.unweighted || settings.weighted) {
            return;
        }
        let parameter = if settings.unweighted { "visualizestrategies" } else { "visualizeweights" };
        if settings.max_depth > MAX_DEPTH {
            let message = format!(
                "of paths with more than {MAX_DEPTH} scattering events no pictures of strategies are made"
            );
            let span = self.desc.integrator.origin.parameter(parameter);
            self.diagnostics.push(Diagnostic::warning("techniques", message, span));
        }
        let bytes = bdpt.technique_bytes(film::pixel_bounds(&self.desc.film).area());
        if bytes > MAX_BYTES {
            let [bytes, most] = [bytes, MAX_BYTES].map(|bytes| bytes as f64 / f64::from(1 << 30));
            let message = format!(
                "pictures of all strategies take {bytes:.1} GiB, more than {most:.0} GiB; a smaller picture, a part of it or a smaller `maxdepth` takes less"
            );
            self.error(message, parameter);
        }
    }

    fn photon_mapping(&mut self, desc: &PhotonMappingDesc) -> PhotonMappingSettings {
        PhotonMappingSettings {
            max_depth: self.depth(desc.max_depth),
            photons: self.count(desc.photons, 0, "photons"),
            caustic_photons: self.count(desc.caustic_photons, 0, "causticphotons"),
            nearest: self.count(desc.nearest, 1, "nearest"),
            radius: desc.radius.map(|radius| self.radius(radius)),
            kernel: match desc.kernel {
                PhotonKernel::Cone => Kernel::Cone,
                PhotonKernel::Epanechnikov => Kernel::Epanechnikov,
            },
            gather: self.count(desc.gather, 0, "gather"),
            show_photons: desc.show == PhotonMappingShow::Photons,
        }
    }

    fn mlt(&mut self, desc: &MltDesc, sampler: Sampler) -> Box<dyn Integrator> {
        let MltDesc { technique, large_step_probability, sigma, regularize, .. } = *desc;
        if !(0.0..=1.0).contains(&large_step_probability) {
            let message = format!("`largestepprobability` is from 0 to 1, not {large_step_probability}");
            self.error(message, "largestepprobability");
        }
        if !(sigma > 0.0 && sigma.is_finite()) {
            self.error(format!("`sigma` is a number above 0, not {sigma}"), "sigma");
        }
        let settings = MltSettings {
            technique,
            max_depth: self.depth(desc.max_depth),
            regularize,
            bootstrap_samples: self.count(desc.bootstrap_samples, 1, "bootstrapsamples"),
            chains: self.count(desc.chains, 1, "chains"),
            mutations_per_pixel: self.count(desc.mutations_per_pixel, 1, "mutationsperpixel"),
            large_step_probability,
            sigma,
        };
        let seed = self.desc.sampler.seed.unwrap_or(self.desc.options.seed) as u32;
        Box::new(Mlt::new(settings, sampler, seed))
    }

    fn radiosity(&mut self, desc: &RadiosityDesc, sampler: Sampler) -> Box<dyn Integrator> {
        self.diagnostics.extend(radiosity::warnings(self.desc));
        let settings = radiosity::settings(desc).unwrap_or_else(|errors| {
            errors.into_iter().for_each(|(parameter, message)| self.error(message, parameter));
            RadiositySettings::default()
        });
        Box::new(Radiosity::new(settings, sampler, color_space(self.desc.film.color_space)))
    }

    /// Path tracing where the author asked for something else.
    fn instead_of(
        &mut self,
        name: &str,
        max_depth: i32,
        regularize: bool,
        sampler: Sampler,
    ) -> Box<dyn Integrator> {
        let message = format!("integrator `{name}` is not drawn yet; drawn as `path`");
        let span = self.desc.integrator.origin.span;
        self.diagnostics.push(Diagnostic::warning("not-drawn", message, span));
        self.path(max_depth, regularize, LightSamplerDesc::Bvh, Interfaces::Pass, sampler)
    }

    fn path(
        &mut self,
        max_depth: i32,
        regularize: bool,
        light_sampler: LightSamplerDesc,
        interfaces: Interfaces,
        sampler: Sampler,
    ) -> Box<dyn Integrator> {
        let light_sampler = match light_sampler {
            LightSamplerDesc::Uniform => LightSamplerKind::Uniform,
            LightSamplerDesc::Power => LightSamplerKind::Power,
            LightSamplerDesc::Bvh => LightSamplerKind::Bvh,
            LightSamplerDesc::Exhaustive => {
                let message = "light sampler `exhaustive` is not drawn yet; drawn with `bvh`";
                let span = self.desc.integrator.origin.parameter("lightsampler");
                self.diagnostics.push(Diagnostic::warning("not-drawn", message, span));
                LightSamplerKind::Bvh
            }
        };
        let max_depth = self.depth(max_depth);
        pixels(Path::new(PathSettings { max_depth, regularize, light_sampler, interfaces }), sampler)
    }

    /// A depth of 0 or more; 0, and an error, where it is none.
    fn depth(&mut self, max_depth: i32) -> u32 {
        u32::try_from(max_depth).unwrap_or_else(|_| {
            self.error(format!("`maxdepth` is 0 or more, not {max_depth}"), "maxdepth");
            0
        })
    }

    /// A number that is not below `least`; `least`, and an error, where it is.
    fn count(&mut self, count: i32, least: u32, parameter: &str) -> u32 {
        u32::try_from(count).ok().filter(|&count| count >= least).unwrap_or_else(|| {
            self.error(format!("`{parameter}` is {least} or more, not {count}"), parameter);
            least
        })
    }

    /// A positive number of photons; 1, and an error, where it is none.
    fn photons(&mut self, count: i32) -> u32 {
        if count <= 0 {
            let message = format!("the photons of a pass are a number above 0, not {count}");
            self.error(message, "photonsperiteration");
        }
        count.max(1) as u32
    }

    /// A distance within which photons count; 1, and an error, where it is none.
    fn radius(&mut self, radius: f32) -> f32 {
        if radius > 0.0 && radius.is_finite() {
            return radius;
        }
        self.error(format!("`radius` is a distance above 0, not {radius}"), "radius");
        1.0
    }

    fn error(&mut self, message: String, parameter: &str) {
        let span = self.desc.integrator.origin.parameter(parameter);
        self.diagnostics.push(Diagnostic::error("invalid-integrator", message, span));
    }
}

fn pixels(rays: impl RayIntegrator + 'static, sampler: Sampler) -> Box<dyn Integrator> {
    Box::new(PixelLoop::new(rays, sampler))
}

fn randomize(randomization: Randomization) -> Randomize {
    match randomization {
        Randomization::None => Randomize::None,
        Randomization::PermuteDigits => Randomize::PermuteDigits,
        Randomization::FastOwen => Randomize::FastOwen,
        Randomization::Owen => Randomize::Owen,
    }
}
