//! Rendering of a solution.
//!
//! *Interpolated*: the irradiance of a vertex is the mean of the elements around it, extrapolated
//! from their quarters. It is interpolated linearly over the fan of triangles between an element's
//! centre, which has the mean irradiance of the element, and its outline. Radiance is L = L_e + (ρ
//! E + τ E′)/π with the albedo of the point, so that textures are sharp; E is the irradiance of the
//! visible side and E′ that of the other.
//!
//! *Gathered*: direct light is estimated by one light sample per sample of a pixel, as in path
//! tracing, and indirect light from the elements that rays in cosine-distributed directions hit.
//! Shadows are then sharp, and errors of the solution are visible only through one more diffuse
//! reflection ([Lischinski 1993]; [Cohen 1993]). Surfaces without elements (infinite planes,
//! formulas, solids, curves, and the smallest of too many primitives) are always gathered; they
//! receive light but do not reflect it to other surfaces. Gathered light is scattered once more
//! than the light of elements, so that the part of it at the depth limit is left out.

use math::{Frame, Ray, RayDifferential, Vec2};
use rayon::prelude::*;
use sampling::warp;
use scene::light_sampler::LightSampler;
use scene::{Scene, SurfaceInteraction};
use std::f32::consts::FRAC_1_PI;
use std::sync::Arc;

use super::bands::Bands;
use super::element::Albedo;
use super::light_samples::{arrives, sample_light};
use super::mesh::{Cell, Corner};
use super::shooting::Solution;
use super::surfaces::{first_solid, seen_side};
use crate::transport::Tracer;
use crate::transport::path_state::pass_through;

/// A solution interpolated over the surfaces.
pub(crate) struct Interpolation {
    /// The outline of each element.
    outlines: Vec<Vec<Corner>>,
    /// The irradiance of both sides at each vertex.
    vertices: Vec<[Bands; 2]>,
    /// The ambient irradiance of unshot light.
    ambient: Bands,
    lights: Arc<LightSampler>,
    /// Rays that gather light for each sample of a pixel; 0: interpolated.
    gather: u32,
}

impl Interpolation {
    /// Averages the irradiance of elements at their vertices.
    pub fn new(scene: &Scene, solution: &Solution, lights: &Arc<LightSampler>, gather: u32) -> Self {
        let mesh = &solution.cut.mesh;
        let elements = &solution.cut.elements;
        let outline =
            |element: &super::element::Element| mesh.outline(scene.world(), mesh.cell(element.cell));
        let outlines: Vec<Vec<Corner>> = elements.par_iter().map(outline).collect();
        let mut vertices = vec![[Bands::ZERO; 2]; mesh.vertices().len()];
        let mut counts = vec![0.0f32; vertices.len()];
        for (element, outline) in elements.iter().zip(&outlines) {
            for corner in outline {
                let sum = &mut vertices[corner.vertex as usize];
                let here = element.irradiance_at(&mesh.cell(element.cell).domain(), corner.uv);
                (0..2).for_each(|i| sum[i] += here[i]);
                counts[corner.vertex as usize] += 1.0;
            }
        }
        for (sum, count) in vertices.iter_mut().zip(counts) {
            *sum = sum.map(|side| side * f32::max(count, 1.0).recip());
        }
        Self { outlines, vertices, ambient: solution.ambient(), lights: Arc::clone(lights), gather }
    }

    /// Memory taken, in bytes.
    pub fn bytes(&self) -> usize {
        let outlines: usize = self.outlines.iter().map(|outline| size_of_val(&**outline)).sum();
        outlines + size_of_val(&*self.outlines) + size_of_val(&*self.vertices)
    }

    /// The irradiance of both sides at a point of an element.
    pub fn irradiance(&self, solution: &Solution, leaf: &Cell, uv: Vec2) -> [Bands; 2] {
        let outline = &self.outlines[leaf.element as usize];
        let center = leaf.domain().center();
        let mut best = (f32::NEG_INFINITY, [0.0; 3], [Corner::default(); 2]);
        for i in 0..outline.len() {
            let side = [outline[i], outline[(i + 1) % outline.len()]];
            let [a, b] = side.map(|corner| corner.uv);
            let whole = (a - center).perp_dot(b - center);
            let (wa, wb) =
                ((uv - center).perp_dot(b - center) / whole, (a - center).perp_dot(uv - center) / whole);
            // The triangle that contains the point: neither of its two outer weights is negative,
            // up to rounding.
            let least = wa.min(wb);
            if least > best.0 {
                best = (least, [1.0 - wa - wb, wa, wb], side);
            }
        }
        let (_, [wc, wa, wb], [a, b]) = best;
        let middle = solution.cut.elements[leaf.element as usize].irradiance();
        let (a, b) = (&self.vertices[a.vertex as usize], &self.vertices[b.vertex as usize]);
        [0, 1].map(|i| (middle[i] * wc + a[i] * wa + b[i] * wb).max(Bands::ZERO) + self.ambient)
    }

    /// The irradiance of both sides at a vertex.
    pub fn at_vertex(&self, vertex: u32) -> &[Bands; 2] {
        &self.vertices[vertex as usize]
    }

    /// The outline of an element.
    pub fn outline(&self, element: u32) -> &[Corner] {
        &self.outlines[element as usize]
    }
}

/// Estimates the radiance of a solution along rays.
pub(crate) struct SolutionRadiance<'a> {
    pub interpolation: &'a Interpolation,
    pub solution: &'a Solution,
}

impl SolutionRadiance<'_> {
    /// The radiance that arrives along a ray.
    pub fn radiance(&self, tracer: &mut Tracer, mut ray: RayDifferential) -> Bands {
        let (scene, &Self { interpolation, solution }) = (tracer.scene, self);
        let wavelengths = &solution.wavelengths;
        let mut l = Bands::ZERO;
        loop {
            let Some(hit) = tracer.hit(&ray.ray) else {
                return l + wavelengths.sample(|lambda| scene.escaped(&ray.ray, lambda));
            };
            let surface = scene.world().surface(&ray.ray, &hit);
            let mut interaction = scene.interaction(&hit, surface);
            if interaction.area_light.is_some() {
                l += wavelengths.sample(|lambda| scene.emitted(&interaction, surface.wo, lambda));
            }
            let Some(albedo) = Albedo::at(scene, tracer.view, &mut interaction, &ray, wavelengths) else {
                ray = pass_through(&ray, &interaction, hit.t);
                continue;
            };
            if solution.settings.max_depth == 0 {
                return l;
            }
            let leaf = solution.cut.mesh.leaf(scene.world(), &hit, &surface);
            if let (Some((leaf, uv)), 0) = (leaf, interpolation.gather) {
                let sides = albedo.scatter(&interpolation.irradiance(solution, leaf, uv));
                return l + sides[seen_side(&surface)] * FRAC_1_PI;
            }
            return l + self.gathered(tracer, &interaction, &albedo);
        }
    }

    /// Radiance of a surface from direct and gathered indirect light, by samples.
    fn gathered(&self, tracer: &mut Tracer, interaction: &SurfaceInteraction, albedo: &Albedo) -> Bands {
        let s = &interaction.surface;
        let ns = s.shading.n;
        let toward = if s.wo.dot(ns) < 0.0 { -ns } else { ns };
        let frame = Frame::from_z(toward);
        let samples = self.interpolation.gather.max(1);
        let mut sum = Bands::ZERO;
        for _ in 0..samples {
            if !tracer.may_trace() {
                return sum;
            }
            sum += self.direct(tracer, interaction, albedo);
            let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
            let (back, on) = (albedo.reflectance.mean(), albedo.transmittance.mean());
            if back + on == 0.0 {
                continue;
            }
            let reflects = uc < back / (back + on);
            let mut wi = warp::sample_cosine_hemisphere(u);
            let weight = if reflects {
                albedo.reflectance * ((back + on) / back)
            } else {
                wi.z = -wi.z;
                albedo.transmittance * ((back + on) / on)
            };
            let ray = interaction.spawn_ray(frame.from_local(wi));
            sum += weight * self.found(tracer, ray);
        }
        sum * (samples as f32).recip()
    }

    /// Radiance of a surface from direct light, by one sample of one light.
    fn direct(&self, tracer: &mut Tracer, interaction: &SurfaceInteraction, albedo: &Albedo) -> Bands {
        let &Self { interpolation, solution } = self;
        let s = &interaction.surface;
        let (u, u_light) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let context = interaction.light_context();
        let Some((light, pmf)) = interpolation.lights.sample(&context, u) else { return Bands::ZERO };
        let found = sample_light(tracer.scene, &solution.wavelengths, light, &context, u_light);
        let Some((l, sample)) = found else { return Bands::ZERO };
        let cos_theta = sample.wi.dot(s.shading.n);
        let same_side = (cos_theta > 0.0) == (s.wo.dot(s.shading.n) > 0.0);
        let share = if same_side { albedo.reflectance } else { albedo.transmittance };
        if share.is_black() || l.is_black() || !arrives(tracer.scene, &context, &sample, tracer.stats) {
            return Bands::ZERO;
        }
        share * l * (cos_theta.abs() * FRAC_1_PI / (pmf * sample.pdf))
    }

    /// The radiance of elements along a ray, without emission, that may be scattered once more.
    fn found(&self, tracer: &mut Tracer, ray: Ray) -> Bands {
        let (scene, cut) = (tracer.scene, &self.solution.cut);
        let Some((hit, surface)) = first_solid(scene, ray, tracer.stats) else { return Bands::ZERO };
        let Some((leaf, uv)) = cut.mesh.leaf(scene.world(), &hit, &surface) else { return Bands::ZERO };
        let quarter = leaf.domain().quarter_of(uv);
        cut.elements[leaf.element as usize].radiosity(quarter)[seen_side(&surface)] * FRAC_1_PI
    }
}
