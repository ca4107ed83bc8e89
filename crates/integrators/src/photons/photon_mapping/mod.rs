//! Photon mapping: photons from the lights are stored where they hit surfaces, and gathered by
//! camera rays.
//!
//! Photons leave the lights and are scattered by BSDF sampling. At each surface that is not purely
//! specular their power Φ, direction and position are stored in a *photon map*. The radiance that
//! such a surface at x reflects is then, over the photons near x,
//!
//! ```text
//! L(x, ωₒ) = ∫ f(x, ωₒ, ωᵢ) L(x, ωᵢ) |cos θᵢ| dωᵢ = ∫ f d²Φ/dA ≈ Σ f(x, ωₒ, ω_p) Φ_p · K(d_p/r)/r²
//! ```
//!
//! There are two maps. The *caustic map* has light from lights through specular surfaces only; the
//! *global map* has light that other surfaces have scattered. Direct light is estimated by shadow
//! rays, since its edges should be sharp. `gather.rs` describes how each light path is counted
//! once. With `gather` rays of a final gather the global map is not seen directly but through the
//! reflection of a diffuse surface, which averages its noise.
//!
//! Its strength is caustics, also those seen in a mirror, and those of lights at a point, which no
//! path from the camera finds. It is *biased*: photons are spread over the radius r of the nearest
//! ones. The edges of caustics are soft; corners are a little dark, as the disk extends beyond the
//! surface; light leaks under doors and around objects thinner than r, and on surfaces that curve
//! within r a little is lost below the horizon. Each pass emits new photons, so noise falls with
//! the number of passes as in path tracing, while the bias stays. It is proportional to r² in the
//! middle of surfaces and to r in the mean over a room with corners, and r² to 1/`photons`: the
//! Cornell box is too dark by 0.8 % with 50 000 of them, by 0.4 % with 200 000 and by 0.2 % with
//! 800 000, without another limit on the radius. Narrow glossy lobes are noisy in light through
//! glass.
//!
//! Memory holds the photons of one pass: at most the number of subpaths times their mean length, 73
//! bytes each, and twice as much while the tree is built.
//!
//! Sources: [Jensen 1996]; [Jensen 2001a].

mod emission;
mod gather;

use std::ops::AddAssign;

use description::{Diagnostic, LightSamplerDesc, PhotonMappingDesc, PhotonMappingShow};
use film::Film;
use geometry::RayStats;
use sampling::Sampler;
use scene::{Interfaces, Scene, ShutterSample, View};
use spectrum::{CIE_Y_INTEGRAL, SampledSpectrum, SampledWavelengths};

use crate::bidirectional::{Balance, Bidirectional, Lights, Vertex, hero_only};
use crate::light_paths::unbounded;
use crate::photons::photon::Photon;
use crate::photons::photon_map::{Neighbourhood, PhotonMap};
use crate::transport::Tracer;
use crate::transport::direct::DirectLighting;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError};

use emission::{Emission, Kind};
use gather::{Gather, MeanRadius, PhotonMaps};

/// Photon mapping.
#[derive(Debug)]
pub struct PhotonMapping {
    settings: PhotonMappingDesc,
    sampler: Sampler,
    photon_seed: u32,
    lights: Lights,
    direct: DirectLighting,
    radius: f32,
    tally: Tally,
    mean_radius: MeanRadius,
}

/// Statistics of the maps.
#[derive(Debug, Default)]
struct Tally {
    passes: u64,
    caustic: u64,
    global: u64,
    largest_memory: usize,
}

impl Tally {
    fn of_pass(caustic: usize, global: usize, memory: usize) -> Self {
        Self { passes: 1, caustic: caustic as u64, global: global as u64, largest_memory: memory }
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.passes += other.passes;
        self.caustic += other.caustic;
        self.global += other.global;
        self.largest_memory = self.largest_memory.max(other.largest_memory);
    }
}

impl PhotonMapping {
    /// `sampler` is for camera rays, `photon_seed` for photons.
    pub fn new(settings: PhotonMappingDesc, sampler: Sampler, photon_seed: u32) -> Self {
        let (lights, direct) = (Lights::none(), DirectLighting::none(Interfaces::Pass));
        let (tally, mean_radius) = (Tally::default(), MeanRadius::new(1.0));
        Self { settings, sampler, photon_seed, lights, direct, radius: 1.0, tally, mean_radius }
    }

    /// The kind of photons of the global map, which depends on its use.
    fn global_kind(&self) -> Kind {
        if self.settings.gather > 0 { Kind::All } else { Kind::Indirect }
    }

    /// Emits the photons of a pass.
    fn maps(&self, emission: &Emission, control: &Control) -> Result<(PhotonMaps, RayStats), PassError> {
        let map = |kind, paths| {
            let (photons, stats) = emission.emit(kind, paths, control, |vertex, _| Photon::at(vertex))?;
            Ok::<_, PassError>((PhotonMap::build(photons, paths, control)?, stats))
        };
        let (caustic, mut stats) = map(Kind::Caustic, self.settings.caustic_photons)?;
        let (global, global_stats) = map(self.global_kind(), self.settings.photons)?;
        stats += global_stats;
        Ok((PhotonMaps { caustic, global }, stats))
    }

    /// Draws the photons as dots; one with all its initial power is white.
    fn draw(
        &self,
        emission: &Emission,
        film: &mut Film,
        control: &Control,
    ) -> Result<(Tally, RayStats), PassError> {
        let scene = emission.paths.scene;
        let mean = |lambda: &SampledWavelengths, l: SampledSpectrum| l.safe_div(lambda.pdf()).average();
        let fixed = SampledWavelengths::sample_visible(0.5);
        let power: f32 = scene.lights().iter().map(|light| mean(&fixed, light.phi(&fixed))).sum();
        let white = mean(&fixed, SampledSpectrum::ONE) / (power * CIE_Y_INTEGRAL);
        let (_, splatter) = film.tiles_and_splatter()?;
        let dot = |vertex: &Vertex, tracer: &mut Tracer| {
            let lens = tracer.sampler.get_2d();
            if let Some(seen) = emission.paths.connect_to_camera(
                vertex,
                lens,
                splatter.reach(),
                &emission.shutter.lambda,
                tracer,
            ) {
                let l = hero_only(vertex.beta * white, vertex.hero_only);
                seen.splat(&splatter, &l, &emission.shutter.lambda);
            }
        };
        splatter.add_paths(1);
        let (caustic, mut stats) =
            emission.emit(Kind::Caustic, self.settings.caustic_photons, control, dot)?;
        let (global, global_stats) =
            emission.emit(self.global_kind(), self.settings.photons, control, dot)?;
        stats += global_stats;
        Ok((Tally::of_pass(caustic.len(), global.len(), 0), stats))
    }
}

impl Integrator for PhotonMapping {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn splats(&self) -> bool {
        true
    }

    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        unbounded::warnings(scene, "photon-mapping")
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.lights = Lights::and_media(scene, view, control)?;
        self.direct = DirectLighting::new(scene, LightSamplerDesc::Bvh, Interfaces::Pass, control)?;
        self.radius = self.settings.radius.unwrap_or(0.03 * scene.sphere().radius);
        self.mean_radius = MeanRadius::new(self.radius);
        Ok(())
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let settings = &self.settings;
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::connecting(film.pixel_bounds().area() as f32),
            max_depth: settings.max_depth,
            light_goes_under: true,
            regularize: false,
        };
        let shutter = ShutterSample::of_pass(view, self.photon_seed, pass);
        // Positions of displayed photons are those of the first pass; wavelengths change from pass
        // to pass.
        let generation = if settings.show == PhotonMappingShow::Photons { 0 } else { pass };
        let emission = Emission { paths: &paths, shutter, seed: self.photon_seed, generation };
        if settings.show == PhotonMappingShow::Photons {
            let (tally, stats) = self.draw(&emission, film, control)?;
            self.tally += tally;
            return Ok(stats);
        }
        let (maps, mut stats) = self.maps(&emission, control)?;
        let neighbourhood = Neighbourhood {
            nearest: settings.nearest as usize,
            radius: self.radius,
            kernel: settings.kernel,
        };
        let (direct, mean_radius) = (&self.direct, &self.mean_radius);
        let gather = Gather { direct, maps: &maps, settings, neighbourhood, mean_radius };
        let filter = film.filter().clone();
        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
        stats += pixels.add_at(Some(&shutter), film.tiles_mut()?, control, |sample, tracer| {
            let Some(camera_ray) = sample.camera_ray else { return SampledSpectrum::ZERO };
            gather.li(camera_ray.ray, &sample.lambda, tracer) * camera_ray.weight
        })?;
        let memory = maps.caustic.memory() + maps.global.memory();
        self.tally += Tally::of_pass(maps.caustic.len(), maps.global.len(), memory);
        Ok(stats)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        let Tally { passes, caustic, global, largest_memory } = self.tally;
        if passes == 0 {
            return Vec::new();
        }
        let (global, caustic) = (global / passes, caustic / passes);
        let photons = format!("{global} in the global map of a pass, {caustic} in its caustic map");
        if self.settings.show == PhotonMappingShow::Photons {
            return vec![("photons", photons)];
        }
        let mebibytes = largest_memory as f64 / f64::from(1 << 20);
        let (mean, largest) = (self.mean_radius.mean(), self.mean_radius.largest);
        vec![
            ("photons", format!("{photons}; {mebibytes:.1} MiB")),
            ("radius", format!("{mean:.3} on average, {largest:.3} at most")),
        ]
    }
}
