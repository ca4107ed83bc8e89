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

/// Numbers, one for each lane.
type Lanes = [f32; MAX_LANES];

/// Light samples in arrays, which are made once: the columns of [`LightLanes`], and its masks as
/// bits.
#[derive(Default)]
pub(super) struct Samples {
    l: [Lanes; N],
    wi: [Lanes; 3],
    pdf: Lanes,
    p: [Lanes; 3],
    p_error: [Lanes; 3],
    n: [Lanes; 3],
    valid: u32,
    is_delta: u32,
    is_distant: u32,
    passes: u32,
}

impl Samples {
    /// The samples.
    #[inline(always)]
    pub fn lanes<R: Real>(&self) -> LightLanes<R> {
        LightLanes {
            valid: R::Mask::from_bits(self.valid),
            l: SampledSpectrum([0, 1, 2, 3].each(|i: usize| R::load(&self.l[i]))),
            wi: self.directions(),
            pdf: R::load(&self.pdf),
            p: Point3Error::new(vector(&self.p), vector(&self.p_error)),
            n: vector(&self.n),
            is_delta: R::Mask::from_bits(self.is_delta),
            is_distant: R::Mask::from_bits(self.is_distant),
            passes: R::Mask::from_bits(self.passes),
        }
    }

    /// The directions to the lights.
    #[inline(always)]
    pub fn directions<R: Real>(&self) -> Vector3<R> {
        vector(&self.wi)
    }

    /// Adds lanes that have a sample of a light.
    #[inline(always)]
    fn add_lanes(&mut self, lanes: u32, is_delta: bool, is_distant: bool, passes: bool) {
        self.valid |= lanes;
        self.is_delta |= if is_delta { lanes } else { 0 };
        self.is_distant |= if is_distant { lanes } else { 0 };
        self.passes |= if passes { lanes } else { 0 };
    }
}

/// Sets columns in all lanes.
#[inline(always)]
fn store<R: Real>(columns: &mut [Lanes], values: &[R]) {
    for (column, value) in columns.iter_mut().zip(values) {
        value.store(column);
    }
}

/// Sets columns in the lanes of a mask.
#[inline(always)]
fn blend<R: Real>(columns: &mut [Lanes], mask: R::Mask, values: &[R]) {
    for (column, &value) in columns.iter_mut().zip(values) {
        R::select(mask, value, R::load(column)).store(column);
    }
}

/// Sets columns in one lane.
#[inline]
fn set(columns: &mut [Lanes], lane: usize, values: &[f32]) {
    for (column, &value) in columns.iter_mut().zip(values) {
        column[lane] = value;
    }
}

/// Samples lights; has all that samples depend on, in arrays.
struct Sample<'a, 'b> {
    sampling: LightSampling<'a, 'b>,
    /// Changed where lanes have a sample.
    samples: &'b mut Samples,
    context: [[Lanes; 3]; 4],
    time: Lanes,
    /// Numbers that choose the light and the point.
    u: [Lanes; 3],
    lambda: [Lanes; N],
    lambda_pdf: [Lanes; N],
    /// The lanes to sample.
    active: u32,
}

/// By reference, as its arrays would be copied for each call.
impl Kernel for &mut Sample<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let samples = &mut *self.samples;
        (samples.valid, samples.is_delta, samples.is_distant, samples.passes) = (0, 0, 0, 0);
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
            samples.add_lanes(is_lit, false, false, true);
            store(&mut samples.l, &l.0);
            store(&mut samples.wi, &wi.to_array());
            sample.pdf.store(&mut samples.pdf);
            store(&mut samples.p, &sample.p.p.to_array());
            store(&mut samples.p_error, &sample.p.error.to_array());
            store(&mut samples.n, &sample.n.to_array());
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
        (R::load(&self.samples.pdf) * pmf).store(&mut self.samples.pdf);
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
                let (samples, zero) = (&mut *self.samples, [R::zero(); 3]);
                blend(&mut samples.p, mask, &splat::<R>(lamp.p).to_array());
                blend(&mut samples.p_error, mask, &zero);
                blend(&mut samples.n, mask, &zero);
                (l, wi, R::one(), is_apart)
            }
            _ => return false,
        };
        let mask = mask & has_light;
        let passes = direct.interfaces(light) == Interfaces::Pass;
        let is_distant = !matches!(light.row(), Light::Point(_));
        let samples = &mut *self.samples;
        samples.add_lanes(mask.bits(), light.is_delta(), is_distant, passes);
        blend(&mut samples.l, mask, &l.0);
        blend(&mut samples.wi, mask, &wi.to_array());
        R::select(mask, pdf, R::load(&samples.pdf)).store(&mut samples.pdf);
        true
    }

    /// Samples the light of one lane.
    fn sample_one(&mut self, id: LightId, lane: usize) {
        let LightSampling { pass, direct, light } = self.sampling;
        let scene = pass.pixels.scene;
        let [_, x, y] = [0, 1, 2].each(|i: usize| self.u[i][lane]);
        let lambda = [0, 1, 2, 3].each(|i: usize| self.lambda[i][lane]);
        let lambda = SampledWavelengths::new(lambda, [0, 1, 2, 3].each(|i: usize| self.lambda_pdf[i][lane]));
        let (context, is_chosen) = (self.context(lane), light.is_none());
        let sample = scene.sample_light(id, &context, Vec2::new(x, y), &lambda, is_chosen);
        let Some(LightLiSample { l, wi, pdf, p, n }) = sample else { return };
        let light = scene.light(id);
        let passes = direct.interfaces(light) == Interfaces::Pass;
        let samples = &mut *self.samples;
        samples.add_lanes(1 << lane, light.is_delta(), p.is_none(), passes);
        set(&mut samples.l, lane, &l.0);
        set(&mut samples.wi, lane, &wi.to_array());
        samples.pdf[lane] = pdf;
        if let Some(p) = p {
            set(&mut samples.p, lane, &p.p.to_array());
            set(&mut samples.p_error, lane, &p.error.to_array());
        }
        set(&mut samples.n, lane, &n.to_array());
    }
}

#[inline(always)]
fn splat<R: Real>(v: Vector3) -> Vector3<R> {
    Vec3::from_array(v.to_array().each(R::splat))
}

#[inline(always)]
fn arrays<R: Real>(v: Vector3<R>) -> [Lanes; 3] {
    v.to_array().each(R::to_array)
}

#[inline(always)]
fn vector<R: Real>(columns: &[Lanes; 3]) -> Vector3<R> {
    Vec3::from_array([0, 1, 2].each(|axis: usize| R::load(&columns[axis])))
}
