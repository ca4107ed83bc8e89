//! From a solution to a picture.
//!
//! *Interpolated*: every vertex has the mean of the irradiances that the elements around it have
//! there, as their quarters tell, and light changes linearly over the fan of triangles between an
//! element's centre, which has the element's own irradiance, and its outline. What is seen is L =
//! L_e + (ρ E + τ E′)/π with the albedo of the very point, so that textures are sharp, E being the
//! irradiance of the side that is seen and E′ that of the other.
//!
//! *Gathered*: direct light is sampled as by paths, one light a sample, and indirect light is what
//! rays in random directions of the cosine's density find on the elements. Shadows are then as
//! sharp as they are, and errors of the solution count only after one more diffuse reflection
//! ([Lischinski 1993]; [Cohen 1993]). Surfaces that have no elements (planes without end, formulas,
//! solids, curves, and the smallest where there are too many primitives) are always shown so; they
//! take light but pass none on. What is gathered is scattered once more than what the elements
//! show, so that of their light that part is left out which was scattered as often as it may be.

use math::{Frame, Ray, RayDifferential, Vec2};
use rayon::prelude::*;
use sampling::warp;
use scene::light_sampler::LightSampler;
use scene::{Scene, SurfaceInteraction};
use std::f32::consts::FRAC_1_PI;

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
    /// The irradiance that is still to come, evenly.
    ambient: Bands,
    lights: LightSampler,
    /// Rays that gather light for each sample of a pixel; 0: interpolated.
    gather: u32,
}

impl Interpolation {
    /// Spreads the light of elements to their vertices.
    pub fn new(scene: &Scene, solution: &Solution, lights: &LightSampler, gather: u32) -> Self {
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
        Self { outlines, vertices, ambient: solution.ambient(), lights: lights.clone(), gather }
    }

    /// Bytes of memory that it takes.
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
            // The one that holds the point, or nearly does: of its two outer weights none is
            // negative.
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

    /// What a surface scatters to where it is seen from, by samples.
    fn gathered(&self, tracer: &mut Tracer, interaction: &SurfaceInteraction, albedo: &Albedo) -> Bands {
        let s = &interaction.surface;
        let ns = s.shading.n;
        let toward = if s.wo.dot(ns) < 0.0 { -ns } else { ns };
        let frame = Frame::from_z(toward);
        let samples = self.interpolation.gather.max(1);
        let mut sum = Bands::ZERO;
        for _ in 0..samples {
            if !tracer.goes_on() {
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

    /// What a surface scatters of direct light, by one sample of one light.
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
        if share.is_black() || l.is_black() || !arrives(tracer.scene, light, &context, &sample, tracer.stats)
        {
            return Bands::ZERO;
        }
        share * l * (cos_theta.abs() * FRAC_1_PI / (pmf * sample.pdf))
    }

    /// The radiance that elements send back along a ray to be scattered once more, emission apart.
    fn found(&self, tracer: &mut Tracer, ray: Ray) -> Bands {
        let (scene, cut) = (tracer.scene, &self.solution.cut);
        let Some((hit, surface)) = first_solid(scene, ray, tracer.stats) else { return Bands::ZERO };
        let Some((leaf, uv)) = cut.mesh.leaf(scene.world(), &hit, &surface) else { return Bands::ZERO };
        let quarter = leaf.domain().quarter_of(uv);
        cut.elements[leaf.element as usize].radiosity(quarter)[seen_side(&surface)] * FRAC_1_PI
    }
}
