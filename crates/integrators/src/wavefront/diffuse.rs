//! Shading of Lambertian surfaces in lanes.

use std::f32::consts::FRAC_1_PI;

use geometry::{Hit, PatchLanes};
use lanes::{Kernel, Mask, Real};
use math::{Frame, Point3Error, Ray, Vec2, Vec3, offset_ray_origin};
use sampling::sampler::Address;
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

use super::columns::Rows;
use super::lights::{self, Contexts};
use super::paths::Paths;
use super::queues::{Queues, Shadow};
use crate::transport::direct::DirectLighting;
use crate::transport::pixel_samples::PixelSamples;

/// Shades hits of one material, whose albedo is the same everywhere.
pub(super) struct ShadeDiffuse<'a, 'b> {
    pub pixels: &'a PixelSamples<'a>,
    pub direct: &'a DirectLighting,
    /// The albedo.
    pub reflectance: &'a Spectrum,
    pub hits: &'a [Option<Hit>],
    /// Indices of hits, and their paths.
    pub turns: &'a [u32],
    pub rows: &'a [u32],
    pub paths: &'b mut Paths,
    pub queues: &'b mut Queues,
}

impl Kernel for ShadeDiffuse<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for (turns, rows) in self.turns.chunks(R::LANES).zip(self.rows.chunks(R::LANES)) {
            self.shade::<R>(turns, rows);
        }
    }
}

impl ShadeDiffuse<'_, '_> {
    #[inline(always)]
    fn shade<R: Real>(&mut self, turns: &[u32], queue: &[u32]) {
        let rows = Rows::<R>::first(queue);
        let mut patches = PatchLanes::new();
        let mut left_out = 0;
        for (lane, (&turn, &row)) in turns.iter().zip(queue).enumerate() {
            let hit = self.hits[turn as usize].as_ref().expect("invariant: paths without hit have ended");
            match self.pixels.scene.world().patch(hit) {
                Some(primitive) => patches.set(lane, &primitive, hit.uv),
                None => {
                    left_out |= 1 << lane;
                    self.queues.scalar.push((row, turn));
                }
            }
        }
        let paths = &mut *self.paths;
        let surface = patches.points::<R>();
        let direction = paths.direction.vector(rows);
        let wo = -direction.normalize();
        let time = R::gather(&paths.time, rows.indices);
        let lambda = wavelengths(paths, rows);
        let reflectance = self.reflectance.sample(&lambda).clamp(R::zero(), R::one());
        let frame = Frame::from_z_and_x(surface.ns, surface.dpdu);
        let wo_z = frame.to_local(wo).z;
        let is_level = wo_z.abs().lt(R::splat(f32::MIN_POSITIVE));
        let scatters = rows.active & !R::Mask::from_bits(left_out) & !reflectance.is_black();
        let origin = offset_ray_origin(surface.p, surface.n, wo);
        let context = Contexts { p: Point3Error::exact(origin), n: surface.n, ns: surface.ns, time };

        // Next-event estimation.
        let mut address = self.address(rows);
        let (u, u_light) = (self.draw_1d::<R>(&mut address), self.draw_2d::<R>(&mut address));
        let source = (self.pixels.scene, self.direct);
        let light = lights::sample(source, &context, u, u_light, &lambda, scatters);
        let wi_z = frame.to_local(light.wi).z;
        let is_reflected = (wi_z * wo_z).gt(R::zero());
        let cos = light.wi.dot(surface.ns).abs();
        let beta = self.paths.beta.spectrum(rows);
        let f = reflectance * R::splat(FRAC_1_PI);
        let l = f * light.l * cos;
        let ratio = cosine_hemisphere_pdf(wi_z.abs()) / light.pdf;
        let weight = R::select(light.is_delta, R::one(), R::one() / (R::one() + ratio * ratio));
        let l = beta * (l * (weight / light.pdf));
        let lit = light.valid & is_reflected & !is_level & !l.is_black();
        let target = Ray::between(surface.p, surface.n, light.p, light.n, time);
        let away = offset_ray_origin(surface.p, surface.n, light.wi);
        let o = Vec3::select(light.is_distant, away, target.o);
        let d = Vec3::select(light.is_distant, light.wi, target.d);
        let t_max = R::select(light.is_distant, R::splat(f32::INFINITY), R::splat(Ray::SHADOW_END));
        self.queues.push_shadows(rows, lit, light.passes, &Shadow { l, ray: Ray::new(o, d, time), t_max });

        // The next direction, with the density of its cosine: β changes by the albedo.
        let _ = self.draw_1d::<R>(&mut address);
        let wi = sample_cosine_hemisphere(self.draw_2d::<R>(&mut address));
        let wi = Vec3::new(wi.x, wi.y, wi.z.copysign(wo_z));
        let pdf = cosine_hemisphere_pdf(wi.z.abs());
        let world = frame.from_local(wi);
        let scattered = scatters & !is_level & wi.z.abs().ge(R::splat(f32::MIN_POSITIVE));
        let beta = beta * (f * (world.dot(surface.ns).abs() / pdf));

        let paths = &mut *self.paths;
        let eta_scale = R::gather(&paths.eta_scale, rows.indices);
        let probability = (beta * eta_scale).max_component();
        let plays = probability.lt(R::one()) & depth_above_one(paths, rows);
        let survived = if (plays & scattered).any() {
            let u = self.pixels.sampler.at_1d::<R>(&address);
            u.lt(probability)
        } else {
            R::Mask::splat(true)
        };
        let goes_on = scattered & (!plays | survived);
        let beta = SampledSpectrum::select(plays, beta / probability, beta);
        let origin = offset_ray_origin(surface.p, surface.n, world);
        paths.beta.set(rows, goes_on, beta.0);
        paths.origin.set(rows, goes_on, origin.to_array());
        paths.direction.set(rows, goes_on, world.to_array());
        let vectors = [context.p.p, context.p.error, context.n, context.ns];
        for (columns, v) in paths.vertex.iter_mut().zip(vectors) {
            columns.set(rows, goes_on, v.to_array());
        }
        let (pdf, plays) = (pdf.to_array(), plays.bits());
        rows.each_of(goes_on, |lane, row| {
            paths.pdf[row] = pdf[lane];
            paths.depth[row] += 1;
            paths.rough_before[row] = true;
            paths.dimension[row] += 6 + (plays >> lane & 1);
            if let Some(kept) = paths.differentials.get_mut(row) {
                *kept = None;
            }
            self.queues.next.push(row as u32);
        });
    }

    /// The addresses of the next coordinates.
    #[inline(always)]
    fn address<R: Real>(&self, rows: Rows<R>) -> Address<R::Int> {
        use lanes::Int;
        let gather = |column: &[u32]| R::Int::gather(column, rows.indices);
        let [x, y] = &self.paths.pixel;
        Address {
            pixel: [gather(x), gather(y)],
            index: self.pixels.index,
            dimension: gather(&self.paths.dimension),
        }
    }

    #[inline(always)]
    fn draw_1d<R: Real>(&self, address: &mut Address<R::Int>) -> R {
        let u = self.pixels.sampler.at_1d(address);
        address.skip(1);
        u
    }

    #[inline(always)]
    fn draw_2d<R: Real>(&self, address: &mut Address<R::Int>) -> Vec2<R> {
        let [x, y] = self.pixels.sampler.at_2d(address);
        address.skip(2);
        Vec2::new(x, y)
    }
}

#[inline(always)]
fn wavelengths<R: Real>(paths: &Paths, rows: Rows<R>) -> SampledWavelengths<R> {
    let [a, b, c, d, pdf @ ..] = paths.wavelengths.get(rows);
    SampledWavelengths::new([a, b, c, d], pdf)
}

/// Whether a path has more than one scattering event with the present one.
#[inline(always)]
fn depth_above_one<R: Real>(paths: &Paths, rows: Rows<R>) -> R::Mask {
    use lanes::Int;
    !R::Int::gather(&paths.depth, rows.indices).eq(R::Int::splat(0))
}
