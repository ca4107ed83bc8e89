//! Samples of lights, one for each lane.
//!
//! They are computed by a kernel of its own, not as a part of those that use them, as random
//! numbers are (`numbers.rs`).

use lanes::{Each, Int, Kernel, MAX_LANES, Mask, Real};
use math::{Normal3, Point3, Point3Error, Ray, Vec2, Vec3, Vector3, offset_ray_origin};
use scene::Interfaces;
use scene::light::{Light, LightId, LightLiSample, LightSampleContext};
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::numbers::SampleNumbers;
use super::pass::Pass;
use crate::transport::ShadowRay;
use crate::transport::direct::DirectLighting;

/// Light samples, before their visibility is tested.
pub(super) struct LightLanes<R: Real> {
    /// The lanes that have a sample.
    pub valid: R::Mask,
    /// Incident radiance.
    pub l: SampledSpectrum<R>,
    /// Unit direction to the light.
    pub wi: Vector3<R>,
    /// Density per solid angle, times the probability of the light.
    pub pdf: R,
    /// Point of the light.
    pub p: Point3Error<R>,
    /// Normal of the light there.
    pub n: Normal3<R>,
    /// The lights that rays cannot hit.
    pub is_delta: R::Mask,
    /// The lights infinitely far away, which have a direction but no point.
    pub is_distant: R::Mask,
    /// The lights that interfaces do not occlude.
    pub passes: R::Mask,
}

impl<R: Real> LightLanes<R> {
    /// Light from infinitely far away.
    #[inline(always)]
    pub fn from_afar(l: SampledSpectrum<R>, wi: Vector3<R>, pdf: R, valid: R::Mask) -> Self {
        let ([is, is_not], zero) = ([true, false].each(R::Mask::splat), Vec3::splat(R::zero()));
        let p = Point3Error::exact(zero);
        Self { valid, l, wi, pdf, p, n: zero, is_delta: is_not, is_distant: is, passes: is }
    }

    /// The shadow rays from points with geometric normals.
    #[inline(always)]
    pub fn shadow_rays(&self, p: Point3Error<R>, n: Normal3<R>, time: R) -> ShadowRay<R> {
        let target = Ray::between(p, n, self.p, self.n, time);
        let away = offset_ray_origin(p, n, self.wi);
        let o = Vec3::select(self.is_distant, away, target.o);
        let d = Vec3::select(self.is_distant, self.wi, target.d);
        let t_max = R::select(self.is_distant, R::splat(f32::INFINITY), R::splat(Ray::SHADOW_END));
        ShadowRay { ray: Ray::new(o, d, time), t_max }
    }
}

/// The light that is sampled.
#[derive(Clone, Copy)]
pub(super) struct LightSampling<'a, 'b> {
    pub pass: &'b Pass<'a>,
    pub direct: &'b DirectLighting,
    /// A given light, also in directions that are left to the BSDF otherwise; without it, a light
    /// is chosen in each lane.
    pub light: Option<LightId>,
}

impl LightSampling<'_, '_> {
    /// Draws a sample for each lane of `active`, and leaves them in arrays.
    #[inline(always)]
    pub fn draw<R: Real>(
        self,
        samples: &mut Samples,
        context: &LightSampleContext<R>,
        SampleNumbers { uc, u }: SampleNumbers<R>,
        lambda: &SampledWavelengths<R>,
        active: R::Mask,
    ) {
        self.pass.instruction_set.dispatch_large(&mut Sample {
            sampling: self,
            samples,
            context: [context.p.p, context.p.error, context.n, context.ns].each(arrays),
            time: context.time.to_array(),
            u: [uc, u.x, u.y].each(R::to_array),
            lambda: lambda.lambda().each(R::to_array),
            lambda_pdf: lambda.pdf().0.each(R::to_array),
            active: active.bits(),
        });
    }
}

/// Light samples in arrays, which are made once.
#[derive(Default)]
pub(super) struct Samples {
    /// Radiance, direction, density, position, its error and normal.
    columns: [[f32; MAX_LANES]; 17],
    /// The lanes that have a sample, and those of delta lights, of distant ones, and of those that
    /// interfaces do not occlude.
    masks: [u32; 4],
}

impl Samples {
    const WI: usize = N;
    const PDF: usize = N + 3;
    const P: usize = N + 4;
    const P_ERROR: usize = N + 7;
    /// Follows the error.
    const NORMAL: usize = N + 10;

    /// The samples.
    #[inline(always)]
    pub fn lanes<R: Real>(&self) -> LightLanes<R> {
        let [valid, is_delta, is_distant, passes] = self.masks.each(R::Mask::from_bits);
        LightLanes {
            valid,
            l: SampledSpectrum([0, 1, 2, 3].each(|i: usize| R::load(&self.columns[i]))),
            wi: self.vector(Self::WI),
            pdf: R::load(&self.columns[Self::PDF]),
            p: Point3Error::new(self.vector(Self::P), self.vector(Self::P_ERROR)),
            n: self.vector(Self::NORMAL),
            is_delta,
            is_distant,
            passes,
        }
    }

    /// The directions to the lights.
    #[inline(always)]
    pub fn directions<R: Real>(&self) -> Vector3<R> {
        self.vector(Self::WI)
    }

    #[inline(always)]
    fn vector<R: Real>(&self, first: usize) -> Vector3<R> {
        let [x, y, z] = [0, 1, 2].each(|axis| R::load(&self.columns[first + axis]));
        Vec3::new(x, y, z)
    }

    /// Sets numbers of all lanes.
    #[inline(always)]
    fn store<R: Real>(&mut self, first: usize, values: &[R]) {
        for (i, value) in values.iter().enumerate() {
            value.store(&mut self.columns[first + i]);
        }
    }

    /// Sets numbers of the lanes of a mask.
    #[inline(always)]
    fn blend<R: Real>(&mut self, first: usize, mask: R::Mask, values: &[R]) {
        for (i, &value) in values.iter().enumerate() {
            let column = &mut self.columns[first + i];
            R::select(mask, value, R::load(column)).store(column);
        }
    }

    /// Sets numbers of one lane.
    #[inline]
    fn set(&mut self, lane: usize, first: usize, values: &[f32]) {
        for (i, &value) in values.iter().enumerate() {
            self.columns[first + i][lane] = value;
        }
    }
}

/// Samples lights; has all that samples depend on, in arrays.
struct Sample<'a, 'b> {
    sampling: LightSampling<'a, 'b>,
    /// Changed where lanes have a sample.
    samples: &'b mut Samples,
    context: [[[f32; MAX_LANES]; 3]; 4],
    time: [f32; MAX_LANES],
    /// Numbers that choose the light and the point.
    u: [[f32; MAX_LANES]; 3],
    lambda: [[f32; MAX_LANES]; N],
    lambda_pdf: [[f32; MAX_LANES]; N],
    /// The lanes to sample.
    active: u32,
}

/// By reference, as its arrays would be copied for each call.
impl Kernel for &mut Sample<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        self.samples.masks = [0; 4];
        let LightSampling { pass, direct, light } = self.sampling;
        let Pass { area_lights, pixels, .. } = pass;
        let [p, error, n, ns] = [0, 1, 2, 3].each(|i| vector::<R>(&self.context[i]));
        let context = LightSampleContext { p: Point3Error::new(p, error), n, ns, time: R::load(&self.time) };
        let [u, x, y] = [0, 1, 2].each(|i| R::load(&self.u[i]));
        let active = R::Mask::from_bits(self.active);
        let [lambda, lambda_pdf] =
            [&self.lambda, &self.lambda_pdf].each(|numbers| [0, 1, 2, 3].each(|i| R::load(&numbers[i])));
        let lambda = SampledWavelengths::new(lambda, lambda_pdf);
        let (lights, pmf, chosen) = match light {
            Some(LightId(light)) => (R::Int::splat(light), R::one(), active),
            None => direct.lights().sample_lanes(&context, u, active),
        };
        let (rows, in_lanes) = area_lights.rows::<R>(lights, chosen);
        if in_lanes.any() {
            let emitters = area_lights.emitters::<R>(rows);
            let (sample, valid) = emitters.shape.sample_from(&context, Vec2::new(x, y));
            let (wi, is_apart) = (sample.p.p - p).normalize_masked();
            let mask = in_lanes & valid & is_apart;
            let l = area_lights.radiance(pixels.scene, &emitters, sample.n, -wi, &lambda, mask);
            let is_lit = (mask & !l.is_black()).bits();
            // Interfaces occlude none of the lights that have a surface.
            let samples = &mut *self.samples;
            samples.masks = [is_lit, 0, 0, is_lit];
            samples.store(0, &l.0);
            samples.store(Samples::WI, &wi.to_array());
            samples.store(Samples::PDF, &[sample.pdf]);
            samples.store(Samples::P, &sample.p.p.to_array());
            samples.store(Samples::P_ERROR, &sample.p.error.to_array());
            samples.store(Samples::NORMAL, &sample.n.to_array());
        }
        let mut others = chosen & !in_lanes;
        let ids = lights.to_array();
        while others.any() {
            let lane = others.bits().trailing_zeros() as usize;
            let id = LightId(ids[lane]);
            let same = others & lights.eq(R::Int::splat(id.0));
            if self.sample_at_rest::<R>(id, p, Vec2::new(x, y), &lambda, same) {
                others = others & !same;
            } else {
                self.sample_one(id, lane);
                others = others & R::Mask::from_bits(others.bits() & (others.bits() - 1));
            }
        }
        let pdf = R::load(&self.samples.columns[Samples::PDF]) * pmf;
        self.samples.store(Samples::PDF, &[pdf]);
    }
}

impl Sample<'_, '_> {
    fn context(&self, lane: usize) -> LightSampleContext {
        let vector = |i: usize| Vec3::from_array([0, 1, 2].each(|c: usize| self.context[i][c][lane]));
        let [p, error, n, ns] = [0, 1, 2, 3].each(vector);
        LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[lane] }
    }

    /// Samples a light at rest from points, in the lanes of a mask. Gives whether it did: lights of
    /// other kinds are left to be sampled one by one.
    #[inline(always)]
    fn sample_at_rest<R: Real>(
        &mut self,
        id: LightId,
        from: Point3<R>,
        u: Vec2<R>,
        lambda: &SampledWavelengths<R>,
        mask: R::Mask,
    ) -> bool {
        let LightSampling { pass, direct, light } = self.sampling;
        let (light, is_chosen) = (pass.pixels.scene.light(id), light.is_none());
        let (l, wi, pdf, has_light) = match light.row() {
            Light::ImageInfinite(sky) if sky.is_at_rest() => sky.sample_at_rest(u, lambda, is_chosen),
            // Left to the BSDF.
            Light::UniformInfinite(_) if is_chosen => return true,
            Light::UniformInfinite(sky) => {
                let (l, wi, pdf) = sky.sample(u, lambda);
                (l, wi, pdf, R::Mask::splat(true))
            }
            Light::Distant(sun) if sun.motion.is_none() => {
                (sun.radiance.sample(lambda), splat(sun.w), R::one(), R::Mask::splat(true))
            }
            Light::Point(lamp) if lamp.motion.is_none() => {
                let (l, wi, is_apart) = lamp.sample_at_rest(from, lambda);
                self.samples.blend(Samples::P, mask, &splat::<R>(lamp.p).to_array());
                self.samples.blend(Samples::P_ERROR, mask, &[R::zero(); 6]);
                (l, wi, R::one(), is_apart)
            }
            _ => return false,
        };
        let mask = mask & has_light;
        let passes = direct.interfaces(light) == Interfaces::Pass;
        let is = [true, light.is_delta(), !matches!(light.row(), Light::Point(_)), passes];
        let samples = &mut *self.samples;
        for (lanes, is) in samples.masks.iter_mut().zip(is) {
            *lanes |= if is { mask.bits() } else { 0 };
        }
        samples.blend(0, mask, &l.0);
        samples.blend(Samples::WI, mask, &wi.to_array());
        samples.blend(Samples::PDF, mask, &[pdf]);
        true
    }

    /// Samples the light of one lane.
    fn sample_one(&mut self, id: LightId, lane: usize) {
        let LightSampling { pass, direct, light } = self.sampling;
        let (scene, bit) = (pass.pixels.scene, 1 << lane);
        let [_, x, y] = [0, 1, 2].each(|i: usize| self.u[i][lane]);
        let lambda = [0, 1, 2, 3].each(|i: usize| self.lambda[i][lane]);
        let lambda = SampledWavelengths::new(lambda, [0, 1, 2, 3].each(|i: usize| self.lambda_pdf[i][lane]));
        let (context, is_chosen) = (self.context(lane), light.is_none());
        let sample = scene.sample_light(id, &context, Vec2::new(x, y), &lambda, is_chosen);
        let Some(LightLiSample { l, wi, pdf, p, n }) = sample else { return };
        let light = scene.light(id);
        let passes = direct.interfaces(light) == Interfaces::Pass;
        let is = [true, light.is_delta(), p.is_none(), passes];
        let samples = &mut *self.samples;
        for (i, is) in is.into_iter().enumerate() {
            samples.masks[i] |= if is { bit } else { 0 };
        }
        samples.set(lane, 0, &l.0);
        samples.set(lane, Samples::WI, &wi.to_array());
        samples.set(lane, Samples::PDF, &[pdf]);
        if let Some(p) = p {
            samples.set(lane, Samples::P, &p.p.to_array());
            samples.set(lane, Samples::P_ERROR, &p.error.to_array());
        }
        samples.set(lane, Samples::NORMAL, &n.to_array());
    }
}

#[inline(always)]
fn splat<R: Real>(v: Vector3) -> Vector3<R> {
    Vec3::from_array(v.to_array().each(R::splat))
}

#[inline(always)]
fn arrays<R: Real>(v: Vector3<R>) -> [[f32; MAX_LANES]; 3] {
    v.to_array().each(R::to_array)
}

#[inline(always)]
fn vector<R: Real>(columns: &[[f32; MAX_LANES]; 3]) -> Vector3<R> {
    Vec3::from_array(columns.each(|column| R::load(&column)))
}
