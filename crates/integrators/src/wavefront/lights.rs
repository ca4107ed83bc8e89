//! Samples of lights, one for each lane.

use lanes::{Each, MAX_LANES, Mask, Real};
use math::{Normal3, Point3Error, Vec2, Vec3, Vector3};
use scene::light::{LightLiSample, LightSampleContext};
use scene::{Interfaces, Scene};
use spectrum::{N, SampledSpectrum, SampledWavelengths};

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

/// The points that light is sampled for.
pub(super) struct Contexts<R: Real> {
    /// Position, with a bound of its error.
    pub p: Point3Error<R>,
    /// Geometric normal.
    pub n: Normal3<R>,
    /// Shading normal.
    pub ns: Normal3<R>,
    /// Shutter time.
    pub time: R,
}

/// Values of lanes while they are set one by one.
struct Columns<const C: usize>([[f32; MAX_LANES]; C]);

impl<const C: usize> Columns<C> {
    fn set(&mut self, lane: usize, first: usize, values: &[f32]) {
        values.iter().enumerate().for_each(|(i, &value)| self.0[first + i][lane] = value);
    }
}

/// One sample of one light for each lane of `active`, chosen by `u` and `u_light`.
#[inline(always)]
pub(super) fn sample<R: Real>(
    (scene, direct): (&Scene, &DirectLighting),
    context: &Contexts<R>,
    u: R,
    u_light: Vec2<R>,
    lambda: &SampledWavelengths<R>,
    active: R::Mask,
) -> LightLanes<R> {
    let inputs = Inputs {
        context: [context.p.p, context.p.error, context.n, context.ns].each(arrays),
        time: context.time.to_array(),
        u: [u, u_light.x, u_light.y].each(R::to_array),
        lambda: lambda.lambda().each(R::to_array),
        lambda_pdf: lambda.pdf().0.each(R::to_array),
    };
    let mut values = Columns([[0.0; MAX_LANES]; 17]);
    let mut masks = [0; 4];
    each(active.bits(), |lane| inputs.sample(scene, direct, lane, &mut values, &mut masks));
    let number = |column: usize| R::load(&values.0[column]);
    let vector = |first: usize| Vec3::new(number(first), number(first + 1), number(first + 2));
    let [valid, is_delta, is_distant, passes] = masks.each(R::Mask::from_bits);
    LightLanes {
        valid,
        l: SampledSpectrum([0, 1, 2, 3].each(number)),
        wi: vector(N),
        pdf: number(N + 3),
        p: Point3Error::new(vector(N + 4), vector(N + 7)),
        n: vector(N + 10),
        is_delta,
        is_distant,
        passes,
    }
}

/// What samples depend on, in arrays.
struct Inputs {
    context: [[[f32; MAX_LANES]; 3]; 4],
    time: [f32; MAX_LANES],
    u: [[f32; MAX_LANES]; 3],
    lambda: [[f32; MAX_LANES]; N],
    lambda_pdf: [[f32; MAX_LANES]; N],
}

impl Inputs {
    fn sample(
        &self,
        scene: &Scene,
        direct: &DirectLighting,
        lane: usize,
        values: &mut Columns<17>,
        [valid, is_delta, is_distant, passes]: &mut [u32; 4],
    ) {
        let [p, error, n, ns] = self.context.map(|v| Vec3::from_array(v.map(|c| c[lane])));
        let context = LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[lane] };
        let [u, x, y] = self.u.map(|u| u[lane]);
        let [lambda, pdf] = [self.lambda, self.lambda_pdf].map(|values| values.map(|v| v[lane]));
        let lambda = SampledWavelengths::new(lambda, pdf);
        let Some((id, pmf)) = direct.lights().sample(&context, u) else { return };
        let sample = scene.sample_light(id, &context, Vec2::new(x, y), &lambda, true);
        let Some(LightLiSample { l, wi, pdf, p, n }) = sample else { return };
        let (light, bit) = (scene.light(id), 1 << lane);
        *valid |= bit;
        *is_delta |= if light.is_delta() { bit } else { 0 };
        *is_distant |= if p.is_none() { bit } else { 0 };
        *passes |= if direct.interfaces(light) == Interfaces::Pass { bit } else { 0 };
        values.set(lane, 0, &l.0);
        values.set(lane, N, &wi.to_array());
        values.set(lane, N + 3, &[pmf * pdf]);
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
