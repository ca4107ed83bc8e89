//! Radiosity: interreflection of diffuse surfaces by finite elements, solved once for all views.
//!
//! Surfaces are subdivided into patches. The exitance of patch i is its radiosity B_i = E_i + ρ_i
//! Σ_j F_ij B_j: emission and reflected light of all patches, F_ij being the [form
//! factor](form_factor) from i to j. [Progressive shooting](shooting) solves this without storing
//! the matrix: repeatedly, the brightest patch shoots its light to all others. Each of the first
//! `steps` passes shoots until a smaller share is unshot, the last one until `tolerance` is
//! reached, and renders a new draft, with an ambient term for unshot light. The following passes,
//! as many as there are samples per pixel, render the finished solution.
//!
//! Patches are [subdivided](subdivide) where irradiance changes fast. The solution is
//! [rendered](show) by interpolation between vertices, or by a final gather. It has fixed
//! [wavelengths](bands).
//!
//! All surfaces are diffuse. Other BSDFs are replaced by their mean albedo ρ_hh; glass becomes a
//! diffusely transmitting sheet. Surfaces reflect on both sides. Shading normals are used in the
//! final gather only. Moving shapes have their positions at the middle of the shutter interval.
//!
//! It has no noise but that of a final gather, and is biased: light is constant over each quarter
//! of a shooting patch and of a receiving element, and visibility is sampled by a few rays. In the
//! Cornell box the mean of a gathered picture has an error of 0.5 %, and single points in the
//! shadow of the blocks 2 %, with the settings' defaults; interpolated, shadows are blurred over
//! their elements. `max_depth` counts as in all algorithms: light that was scattered more often is
//! missing.
//!
//! An element takes about 2 kB with its share of vertices, a patch 256 bytes more per scattering
//! event, and again 2 kB if it is subdivided. If there are more primitives than half of
//! `max_patches`, only [lights and the largest](primitives) have patches; the others receive light,
//! but do not reflect it to other surfaces. The time of a shot grows with the number of elements,
//! and the number of shots with that of patches. Sources: [Goral 1984], [Cohen 1988], [Cohen 1993].

mod bands;
mod domain;
mod element;
mod form_factor;
mod hemicube;
mod light_samples;
mod mesh;
mod ply;
mod primitives;
mod shooting;
mod show;
mod subdivide;
mod surfaces;
#[cfg(test)]
mod tests;
mod unsupported;

use std::sync::Arc;

use description::{Diagnostic, LightSamplerDesc, RadiosityDesc};
use film::{Film, FilmTile, Sample};
use geometry::RayStats;
use rayon::prelude::*;
use sampling::Sampler;
use scene::camera::CameraRayDifferential;
use scene::light_sampler::LightSampler;
use scene::{Scene, View};
use spectrum::RgbColorSpace;

use crate::transport::Tracer;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, OutputFile, PassError};
use bands::Bands;
use shooting::Solution;
use show::{Interpolation, SolutionRadiance};

/// Radiosity by progressive shooting.
pub struct Radiosity {
    settings: RadiosityDesc,
    sampler: Sampler,
    color_space: &'static RgbColorSpace,
    state: Option<State>,
    /// Whether the film holds a draft.
    draft_is_shown: bool,
}

/// The solution of a scene, and its display.
struct State {
    solution: Solution,
    lights: Arc<LightSampler>,
    /// The number of shooting steps done.
    sent: u32,
    interpolation: Interpolation,
    /// The step of the solution in the interpolation.
    shown: Option<u32>,
    /// The mesh file to be saved.
    mesh: Vec<u8>,
}

impl State {
    /// The state before shooting.
    fn new(
        scene: &Scene,
        view: &View,
        settings: &RadiosityDesc,
        control: &Control,
    ) -> Result<Self, Cancelled> {
        let solution = Solution::new(scene, view, settings, control)?;
        let lights = scene.light_sampler(LightSamplerDesc::Bvh, &control.cancel).ok_or(Cancelled)?;
        let interpolation = Interpolation::new(scene, &solution, &lights, 0);
        Ok(Self { solution, lights, sent: 0, interpolation, shown: None, mesh: Vec::new() })
    }

    /// Shoots up to the step of a pass. Missing steps of earlier passes are done one by one, so
    /// that the solution depends only on the pass.
    fn advance(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        color_space: &RgbColorSpace,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let RadiosityDesc { steps, tolerance, gather, .. } = self.solution.settings;
        let mut stats = RayStats::default();
        while self.sent < steps.min(pass + 1) {
            let share = lanes::pow(tolerance, (self.sent + 1) as f32 / steps as f32);
            stats += self.solution.shoot(scene, view, share, control)?;
            self.sent += 1;
        }
        let step = pass.min(steps);
        if self.shown != Some(step) {
            let is_finished = step == steps;
            let gather = if is_finished { gather } else { 0 };
            self.interpolation = Interpolation::new(scene, &self.solution, &self.lights, gather);
            self.shown = Some(step);
            if is_finished && self.solution.settings.mesh_out.is_some() {
                self.mesh = ply::encode(scene, &self.solution, &self.interpolation, color_space);
            }
        }
        Ok(stats)
    }
}

impl Radiosity {
    /// `color_space` is that of the colours of a saved mesh.
    pub fn new(settings: RadiosityDesc, sampler: Sampler, color_space: &'static RgbColorSpace) -> Self {
        Self { settings, sampler, color_space, state: None, draft_is_shown: false }
    }
}

impl Integrator for Radiosity {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn drafts(&self) -> u32 {
        self.settings.steps
    }

    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        unsupported::warnings(scene)
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.state = Some(State::new(scene, view, &self.settings, control)?);
        self.draft_is_shown = false;
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
        let steps = self.settings.steps;
        let samples = self.sampler.samples_per_pixel();
        let Some(state) = &mut self.state else { return Ok(RayStats::default()) };
        let mut stats = state.advance(pass, scene, view, self.color_space, control)?;
        let index = if pass < steps { pass % samples } else { pass - steps };
        let filter = film.filter().clone();
        let pixels =
            PixelSamples { index, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
        let shown = SolutionRadiance { interpolation: &state.interpolation, solution: &state.solution };
        let draw = |mut tile: FilmTile| {
            control.check()?;
            let (mut sampler, mut stats) = (self.sampler.clone(), RayStats::default());
            let bounds = tile.bounds();
            for y in bounds.min[1]..bounds.max[1] {
                for x in bounds.min[0]..bounds.max[0] {
                    let sample = pixels.begin(None, [x, y], &mut sampler);
                    let (mut l, lambda) = (Bands::ZERO, shown.solution.wavelengths.groups());
                    let mut tracer = Tracer::new(scene, view, control, &mut sampler, &mut stats);
                    if let Some(CameraRayDifferential { ray, weight }) = sample.camera_ray {
                        l = shown.radiance(&mut tracer, ray) * weight;
                    }
                    let first_hit = pixels.first_hit(&tile, &sample, &lambda[0], &mut tracer);
                    tracer.finish()?;
                    let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
                    let (l, weight) = (l.groups(), sample.filter_weight);
                    tile.add([x, y], &Sample { l, lambda, weight, alpha, first_hit, parts: None });
                }
            }
            Ok(stats)
        };
        // A better solution is rendered to a new film, which replaces the draft when it is
        // complete.
        let is_new = pass < steps || self.draft_is_shown;
        let mut better = is_new.then(|| film.blank()).transpose()?;
        let tiles = better.as_mut().unwrap_or(film).tiles_mut()?;
        let drawn: Vec<RayStats> = tiles.into_par_iter().map(draw).collect::<Result<_, Cancelled>>()?;
        drawn.into_iter().for_each(|some| stats += some);
        if let Some(better) = better {
            *film = better;
        }
        self.draft_is_shown = pass < steps;
        Ok(stats)
    }

    fn files(&self) -> Vec<OutputFile> {
        let mesh = self.state.as_ref().map(|state| &state.mesh).filter(|mesh| !mesh.is_empty());
        let file = self.settings.mesh_out.iter().zip(mesh);
        file.map(|(path, mesh)| OutputFile { path: path.into(), contents: mesh.clone() }).collect()
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        let Some(State { solution, interpolation, .. }) = &self.state else { return Vec::new() };
        let mebibytes = (solution.bytes() + interpolation.bytes()) as f64 / f64::from(1 << 20);
        let mut notes = vec![
            ("patches", solution.cut.patches.len().to_string()),
            ("elements", solution.cut.elements.len().to_string()),
            ("shots", solution.shots.to_string()),
            ("unshot light", format!("{:.3} %", 100.0 * solution.unshot_share())),
            ("patch memory", format!("{mebibytes:.1} MiB")),
        ];
        let left_out = solution.cut.mesh.left_out();
        if left_out > 0 {
            notes.push(("left out", format!("{left_out} small primitives, beyond the limit of maxpatches")));
        }
        notes
    }
}
