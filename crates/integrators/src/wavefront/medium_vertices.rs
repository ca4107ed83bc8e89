//! The vertices of paths in media, in lanes: light samples, samples of the phase function and
//! Russian roulette.

use lanes::{Int, Kernel, Real};
use math::{Point3Error, Ray, Vec3};
use scattering::HenyeyGreenstein;
use scene::light::LightSampleContext;

use super::indices::Indices;
use super::lights::{LightSampling, Samples};
use super::media::{MediumVertices, SegmentInMedia};
use super::numbers::VertexNumbers;
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::path_vertices::{Roulette, play};
use super::queues::Queues;
use super::segment_columns::{Segment, SegmentColumns};
use super::shadows::PassageLanes;
use crate::Path;

/// Scatters paths at vertices in media.
pub(super) struct ScatterInMedia<'a, 'b> {
    pub pass: Pass<'a>,
    pub algorithm: &'b Path,
    pub vertices: &'b MediumVertices,
    pub segments: &'b SegmentColumns,
    pub paths: &'b mut PathColumns,
    pub queues: &'b mut Queues,
    pub light_samples: &'b mut Samples,
}

impl Kernel for ScatterInMedia<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for first in (0..self.vertices.hit_indices.len()).step_by(R::LANES) {
            self.scatter::<R>(first);
        }
    }
}

impl ScatterInMedia<'_, '_> {
    #[inline(always)]
    fn scatter<R: Real>(&mut self, first: usize) {
        let Self { pass, algorithm, vertices, segments, .. } = *self;
        let hit_indices = Indices::<R>::first(&vertices.hit_indices[first..]);
        let rows = Indices {
            indices: R::Int::gather(&segments.rows, hit_indices.indices),
            active: hit_indices.active,
        };
        let last = vertices.hit_indices.len() - 1;
        let place = R::Int::from_fn(|lane| (first + lane).min(last) as u32);
        let [x, y, z] = &vertices.p;
        let p = Vec3::new(R::gather(x, place), R::gather(y, place), R::gather(z, place));
        let phase = HenyeyGreenstein { g: R::gather(&vertices.g, place) };
        let (p, n) = (Point3Error::exact(p), Vec3::splat(R::zero()));
        let time = R::gather(&segments.time, hit_indices.indices);
        let wo = -segments.direction.vector(hit_indices);
        let context = LightSampleContext { p, n, ns: n, time };
        let beta = segments.beta.get(hit_indices);
        let (medium, r_u) = segments.media().at(hit_indices);
        let mut address = self.paths.address(rows, pass.pixels.index);
        let numbers = VertexNumbers::draw_in_media(&pass, &mut address);

        let lambda = self.paths.lambda_lanes(rows);
        let sampling = LightSampling { pass: &pass, direct: &algorithm.direct, light: None };
        sampling.draw(self.light_samples, &context, numbers.light, &lambda, rows.active);
        let light = self.light_samples.lanes::<R>();
        let value = phase.p(wo, light.wi);
        let l = beta * (light.l * value) / light.pdf;
        let shadow = light.shadow_rays(p, n, time);
        let ratio = R::select(light.is_delta, R::zero(), value / light.pdf);
        let passage = PassageLanes { r_u, ratio, medium, dimension: numbers.passage };
        let lit = light.valid & !(light.l * value).is_black();
        self.queues.passages.append(rows, lit, l, &shadow, &passage);

        let (wi, pdf) = phase.sample_p(wo, numbers.bsdf.u);
        let eta_scale = R::gather(&segments.eta_scale, hit_indices.indices);
        let depth = R::Int::gather(&segments.depth, hit_indices.indices).wrapping_add(R::Int::splat(1));
        let Roulette { survives, weight, dimension } =
            play(&pass, address, depth, beta * eta_scale, rows.active);
        dimension.scatter(survives, &mut self.paths.dimension, rows.indices);
        rows.each_of(survives, |_, row| self.paths.rough_before[row] = true);
        let segment = Segment {
            ray: Ray::new(p.p, wi, time),
            beta: beta * weight,
            eta_scale,
            depth,
            vertex: context,
            pdf,
            media: Some(SegmentInMedia { medium, r_u, r_l: r_u / pdf }),
        };
        self.queues.next.append(rows.indices, survives, &segment);
    }
}
