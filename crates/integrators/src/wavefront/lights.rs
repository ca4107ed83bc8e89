//! Samples of lights, one for each lane.

use lanes::{Each, Int, MAX_LANES, Mask, Real};
use math::{Normal3, Point3Error, Vec2, Vec3, Vector3};
use scene::Interfaces;
use scene::light::{LightId, LightLiSample, LightSampleContext};
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::pass::Pass;

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

/// Values of lanes while they are set one by one.
struct LaneValues<const C: usize>([[f32; MAX_LANES]; C]);

impl<const C: usize> LaneValues<C> {
    fn set(&mut self, lane: usize, first: usize, values: &[f32]) {
        values.iter().enumerate().for_each(|(i, &value)| self.0[first + i][lane] = value);
    }
}

/// One sample of one light for each lane of `active`, chosen by `u` and `u_light`.
#[inline(always)]
pub(super) fn sample<R: Real>(
    pass: &Pass,
    context: &LightSampleContext<R>,
    u: R,
    u_light: Vec2<R>,
    lambda: &SampledWavelengths<R>,
    active: R::Mask,
) -> LightLanes<R> {
    let inputs = Inputs {
        context: [context.p.p, context.p.error, context.n, context.ns].each(arrays),
        time: context.time.to_array(),
        u: [u_light.x, u_light.y].each(R::to_array),
        lambda: lambda.lambda().each(R::to_array),
        lambda_pdf: lambda.pdf().0.each(R::to_array),
    };
    let mut values = LaneValues([[0.0; MAX_LANES]; 17]);
    let mut masks = [0; 4];
    let (lights, pmf, chosen) = pass.direct.lights().sample_lanes(context, u, active);
    let (rows, mut in_lanes) = pass.rectangles.rows::<R>(lights, chosen);
    let mut sampled = None;
    if in_lanes.any() {
        match pass.rectangles.emission::<R>(pass.pixels.scene, rows, in_lanes) {
            Some(emission) => {
                let (rectangles, scale) = pass.rectangles.get::<R>(rows);
                let (sample, valid) = rectangles.sample_from(context, u_light);
                in_lanes = in_lanes & valid;
                sampled = Some((sample, emission, scale));
            }
            None => in_lanes = R::Mask::splat(false),
        }
    }
    let (others, lights) = (chosen & !in_lanes, lights.to_array());
    each(others.bits(), |lane| inputs.sample(pass, LightId(lights[lane]), lane, &mut values, &mut masks));
    let number = |column: usize| R::load(&values.0[column]);
    let vector = |first: usize| Vec3::new(number(first), number(first + 1), number(first + 2));
    let [valid, is_delta, is_distant, passes] = masks.each(R::Mask::from_bits);
    let l = SampledSpectrum([0, 1, 2, 3].each(number));
    let (wi, pdf, n) = (vector(N), number(N + 3) * pmf, vector(N + 10));
    let p = Point3Error::new(vector(N + 4), vector(N + 7));
    let Some((sample, emission, scale)) = sampled else {
        return LightLanes { valid, l, wi, pdf, p, n, is_delta, is_distant, passes };
    };
    let (toward, is_apart) = (sample.p.p - context.p.p).normalize_masked();
    let emits = if emission.two_sided { in_lanes } else { in_lanes & sample.n.dot(toward).le(R::zero()) };
    let radiance = emission.radiance.spectrum.sample(lambda) * scale;
    let is_lit = emits & is_apart & !radiance.is_black();
    LightLanes {
        valid: valid | is_lit,
        l: SampledSpectrum::select(in_lanes, radiance, l),
        wi: Vec3::select(in_lanes, toward, wi),
        pdf: R::select(in_lanes, sample.pdf * pmf, pdf),
        p: Point3Error::new(
            Vec3::select(in_lanes, sample.p.p, p.p),
            Vec3::select(in_lanes, sample.p.error, p.error),
        ),
        n: Vec3::select(in_lanes, sample.n, n),
        is_delta,
        is_distant,
        // Interfaces occlude none of the lights that have a surface.
        passes: passes | is_lit,
    }
}

/// What samples depend on, in arrays.
struct Inputs {
    context: [[[f32; MAX_LANES]; 3]; 4],
    time: [f32; MAX_LANES],
    u: [[f32; MAX_LANES]; 2],
    lambda: [[f32; MAX_LANES]; N],
    lambda_pdf: [[f32; MAX_LANES]; N],
}

impl Inputs {
    fn context(&self, lane: usize) -> LightSampleContext {
        let [p, error, n, ns] = self.context.each_ref().map(|v| Vec3::from_array(v.map(|c| c[lane])));
        LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[lane] }
    }

    /// Samples the light of one lane.
    fn sample(
        &self,
        pass: &Pass,
        id: LightId,
        lane: usize,
        values: &mut LaneValues<17>,
        [valid, is_delta, is_distant, passes]: &mut [u32; 4],
    ) {
        let (scene, bit) = (pass.pixels.scene, 1 << lane);
        let [x, y] = self.u.each_ref().map(|u| u[lane]);
        let lambda = self.lambda.each_ref().map(|v| v[lane]);
        let lambda = SampledWavelengths::new(lambda, self.lambda_pdf.each_ref().map(|v| v[lane]));
        let sample = scene.sample_light(id, &self.context(lane), Vec2::new(x, y), &lambda, true);
        let Some(LightLiSample { l, wi, pdf, p, n }) = sample else { return };
        let light = scene.light(id);
        *valid |= bit;
        *is_delta |= if light.is_delta() { bit } else { 0 };
        *is_distant |= if p.is_none() { bit } else { 0 };
        *passes |= if pass.direct.interfaces(light) == Interfaces::Pass { bit } else { 0 };
        values.set(lane, 0, &l.0);
        values.set(lane, N, &wi.to_array());
        values.set(lane, N + 3, &[pdf]);
        if let Some(p) = p {
            values.set(lane, N + 4, &p.p.to_array());
            values.set(lane, N + 7, &p.error.to_array());
        }
        values.set(lane, N + 10, &n.to_array());
    }
}

#[inline(always)]
fn arrays<R: Real>(v: Vector3<R>) -> [[f32; MAX_LANES]; 3] {
    v.to_array().each(R::to_array)
}

/// Calls `f` with the index of each bit that is set.
#[inline(always)]
fn each(mut bits: u32, mut f: impl FnMut(usize)) {
    while bits != 0 {
        f(bits.trailing_zeros() as usize);
        bits &= bits - 1;
    }
}
