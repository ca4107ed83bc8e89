//! Random walks between the layers of a coated surface.
//!
//! Positions along the surface do not matter, only the height above the base. An estimate of `f`
//! refracts both directions into the coat and walks on from `wo`. Each event is connected to the
//! direction of the light, refracted inwards. At a rough coat a direction of the walk may also be
//! refracted outwards to the light; both strategies are weighted by the power heuristic. A sample
//! walks until it leaves.

use super::{CoatedBase, Layered};
use crate::{BsdfSample, BxdfFlags, Dielectric, Directions, HenyeyGreenstein, Scatter, TransportMode};
use lanes::{Callee, Mask, Real, exp, ln};
use math::{Vec2, Vec3, Vector3, sqr};
use sampling::HashSequence;
use spectrum::SampledSpectrum;

/// A random walk inside of the coat.
struct Walk<R: Real> {
    /// The direction of travel.
    w: Vector3<R>,
    /// The height above the base.
    z: R,
    /// The product of f·|cos|/p and of transmittances so far.
    beta: SampledSpectrum<R>,
    /// Whether the walk goes on.
    alive: R::Mask,
}

/// The random numbers of an event. Each has its own, so that they are the same whatever happens in
/// other lanes.
struct Numbers<R: Real> {
    roulette: R,
    flight: R,
    uc: R,
    u: Vec2<R>,
}

impl<R: Real> Numbers<R> {
    #[inline(always)]
    fn next(random: &mut HashSequence<R::Int>) -> Self {
        let [roulette, flight, uc] = [random.get_1d(), random.get_1d(), random.get_1d()];
        Self { roulette, flight, uc, u: random.get_2d() }
    }
}

/// What happens to a walk next: one thing in each lane that is alive.
struct Event<R: Real> {
    in_medium: R::Mask,
    at_base: R::Mask,
    at_interface: R::Mask,
}

impl<R: Real> Walk<R> {
    /// The walk that begins with a refraction inwards.
    #[inline(always)]
    fn enter(entrance: &BsdfSample<R>, thickness: R) -> Self {
        let beta = entrance.f * (entrance.wi.z.abs() / entrance.pdf);
        Self { w: entrance.wi, z: thickness, beta, alive: carries_light(entrance) }
    }

    /// Plays Russian roulette where little is left after some events.
    #[inline(always)]
    fn roulette(&mut self, depth: u32, u: R) {
        let left = self.beta.max_component();
        let plays = self.alive & left.lt(R::splat(0.25));
        if depth <= 3 || !plays.any() {
            return;
        }
        let survives = u.lt(left);
        self.beta = SampledSpectrum::select(plays, self.beta / left, self.beta);
        self.alive = self.alive & (!plays | survives);
    }

    /// Goes on to the next event, in a coat of this thickness, with a medium where it has one.
    #[inline(always)]
    fn go_on(&mut self, thickness: R, has_medium: R::Mask, u: R) -> Event<R> {
        let down = self.w.z.lt(R::zero());
        let mut height = R::select(down, R::zero(), thickness);
        let mut in_medium = R::Mask::splat(false);
        if has_medium.any() {
            let z = self.z - ln(R::one() - u) * self.w.z;
            in_medium = self.alive & has_medium & z.gt(R::zero()) & z.lt(thickness);
            height = R::select(in_medium, z, height);
        }
        if !has_medium.all() {
            let transmitted = self.beta * transmittance(thickness, self.w);
            self.beta = SampledSpectrum::select(has_medium, self.beta, transmitted);
        }
        self.z = height;
        let at_layers = self.alive & !in_medium;
        Event { in_medium, at_base: at_layers & down, at_interface: at_layers & !down }
    }

    /// Goes on along a sample where the mask is true; ends where there is none.
    #[inline(always)]
    fn scatter(&mut self, at: R::Mask, sample: &BsdfSample<R>) {
        let beta = self.beta * (sample.f * (sample.wi.z.abs() / sample.pdf));
        self.beta = SampledSpectrum::select(at, beta, self.beta);
        self.w = Vec3::select(at, sample.wi, self.w);
        self.alive = self.alive & (!at | carries_light(sample));
    }

    /// Scatters in the medium where the mask is true; returns the density of the direction.
    #[inline(always)]
    fn scatter_in_medium(
        &mut self,
        at: R::Mask,
        phase: &HenyeyGreenstein<R>,
        albedo: SampledSpectrum<R>,
        u: Vec2<R>,
    ) -> R {
        let (w, p) = phase.sample_p(-self.w, u);
        self.beta = SampledSpectrum::select(at, self.beta * albedo, self.beta);
        self.w = Vec3::select(at, w, self.w);
        self.alive = self.alive & (!at | w.z.ne(R::zero()));
        p
    }
}

/// Whether there is a sample of light, and it does not go along the layers.
#[inline(always)]
fn carries_light<R: Real>(sample: &BsdfSample<R>) -> R::Mask {
    sample.valid & sample.pdf.gt(R::zero()) & sample.wi.z.ne(R::zero()) & !sample.f.is_black()
}

/// The share of light that goes a height `dz` ≥ 0 along `w` without an event.
#[inline(always)]
fn transmittance<R: Real>(dz: R, w: Vector3<R>) -> R {
    exp(-(dz / w.z.abs()))
}

/// The weight of a sample of density `p`, where another strategy has the density `other`, if there
/// is another.
#[inline(always)]
fn weight<R: Real>(p: R, other: R, is_other: R::Mask) -> R {
    R::select(is_other, R::one() / (R::one() + sqr(other / p)), R::one())
}

/// A sample of the coat's surface. It is called, because walks have several of them.
struct SampleInterface<'a, R: Real> {
    interface: &'a Dielectric<R>,
    wo: Vector3<R>,
    uc: R,
    u: Vec2<R>,
    mode: TransportMode,
    directions: Directions,
}

impl<R: Real> Callee<R> for SampleInterface<'_, R> {
    type Output = BsdfSample<R>;

    #[inline(always)]
    fn run(self) -> BsdfSample<R> {
        self.interface.sample_f(self.wo, self.uc, self.u, self.mode, self.directions)
    }
}

/// One estimate of the light from `wi` that leaves the inside of the coat to `wo`, both above.
pub(super) struct Estimate<'a, B, R: Real> {
    pub layers: &'a Layered<B, R>,
    pub wo: Vector3<R>,
    pub wi: Vector3<R>,
    pub mode: TransportMode,
    pub random: HashSequence<R::Int>,
}

impl<R: Real, B: CoatedBase<R>> Callee<R> for Estimate<'_, B, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { layers, wo, wi, mode, mut random } = self;
        let &Layered { base, interface, thickness, albedo, phase, .. } = layers;
        let (interface, directions) = (&interface, Directions::Transmission);
        let (uc, u) = (random.get_1d(), random.get_2d());
        let entrance = R::call(SampleInterface { interface, wo, uc, u, mode, directions });
        let (uc, u) = (random.get_1d(), random.get_2d());
        let light = R::call(SampleInterface { interface, wo: wi, uc, u, mode: !mode, directions });
        let mut walk = Walk::enter(&entrance, thickness);
        walk.alive = walk.alive & carries_light(&light);
        let is_rough = interface.flags().is_non_specular();
        let base_is_rough = base.flags().is_non_specular();
        let leave = Leave { interface, thickness, wi, mode };
        // Where the light goes after its refraction, and what is left of it.
        let (to_light, light_f) = (-light.wi, light.f / light.pdf);
        let mut sum = SampledSpectrum::zero();
        for depth in 0..layers.max_depth {
            let Numbers { roulette, flight, uc, u } = Numbers::next(&mut random);
            walk.roulette(depth, roulette);
            if !walk.alive.any() {
                break;
            }
            let event = walk.go_on(thickness, layers.has_medium(), flight);
            let wo = -walk.w;
            let (mut pdf, mut has_density) = (R::one(), R::Mask::splat(true));
            if event.in_medium.any() {
                let at = event.in_medium;
                let p = phase.p(wo, to_light);
                let weight = weight(light.pdf, p, is_rough);
                let through = weight * p * transmittance(thickness - walk.z, to_light);
                let l = walk.beta * albedo * light_f * through;
                sum += SampledSpectrum::select(at, l, SampledSpectrum::zero());
                pdf = R::select(at, walk.scatter_in_medium(at, &phase, albedo, u), pdf);
            }
            if event.at_base.any() {
                let at = event.at_base;
                let f = base.f(wo, to_light, mode);
                let weight = weight(light.pdf, base.pdf(wo, to_light, mode, Directions::All), is_rough);
                let through = weight * to_light.z.abs() * transmittance(thickness, to_light);
                let l = walk.beta * f * light_f * through;
                sum += SampledSpectrum::select(at & base_is_rough, l, SampledSpectrum::zero());
                let sample = base.sample_f(wo, uc, u, mode, Directions::Reflection);
                walk.scatter(at, &sample);
                pdf = R::select(at, sample.pdf, pdf);
                has_density = !at | !sample.flags.is_specular();
            }
            let at = (event.in_medium | event.at_base) & walk.alive & is_rough & walk.w.z.gt(R::zero());
            if at.any() {
                sum += SampledSpectrum::select(at, leave.l(&walk, pdf, has_density), SampledSpectrum::zero());
            }
            if event.at_interface.any() {
                let directions = Directions::Reflection;
                let sample = R::call(SampleInterface { interface, wo, uc, u, mode, directions });
                walk.scatter(event.at_interface, &sample);
            }
        }
        sum
    }
}

/// The end of a walk that is refracted outwards to the light.
struct Leave<'a, R: Real> {
    interface: &'a Dielectric<R>,
    thickness: R,
    wi: Vector3<R>,
    mode: TransportMode,
}

impl<R: Real> Leave<'_, R> {
    /// The light of a walk that goes up and through the rough interface to `wi` next. The direction
    /// of the walk has the density `pdf`, unless it is specular.
    #[inline(always)]
    fn l(&self, walk: &Walk<R>, pdf: R, has_density: R::Mask) -> SampledSpectrum<R> {
        let Self { interface, thickness, wi, mode } = *self;
        let f = interface.f(-walk.w, wi, mode);
        let other = interface.pdf(wi, -walk.w, !mode, Directions::Transmission);
        let through = weight(pdf, other, has_density) * transmittance(thickness - walk.z, walk.w);
        SampledSpectrum::select(f.is_black(), SampledSpectrum::zero(), walk.beta * f * through)
    }
}

/// A sample of the whole, for `wo` above.
pub(super) struct SampleWalk<'a, B, R: Real> {
    pub layers: &'a Layered<B, R>,
    pub wo: Vector3<R>,
    pub uc: R,
    pub u: Vec2<R>,
    pub mode: TransportMode,
}

impl<R: Real, B: CoatedBase<R>> Callee<R> for SampleWalk<'_, B, R> {
    type Output = BsdfSample<R>;

    #[inline(always)]
    fn run(self) -> BsdfSample<R> {
        let Self { layers, wo, uc, u, mode } = self;
        let &Layered { base, interface, thickness, albedo, phase, .. } = layers;
        let entrance = interface.sample_f(wo, uc, u, mode, Directions::All);
        let reflected = entrance.valid & entrance.flags.is_reflective();
        let mut random = HashSequence::new([uc.to_bits(), u.x.to_bits(), u.y.to_bits()]);
        let mut walk = Walk::enter(&entrance, thickness);
        walk.alive = walk.alive & !reflected;
        let mut specular = entrance.flags.is_specular();
        let mut left = R::Mask::splat(false);
        let (mut f, mut wi) = (entrance.f, entrance.wi);
        // One round more than events: the last one may only leave.
        for depth in 0..=layers.max_depth {
            let Numbers { roulette, flight, uc, u } = Numbers::next(&mut random);
            walk.roulette(depth, roulette);
            if !walk.alive.any() {
                break;
            }
            let event = walk.go_on(thickness, layers.has_medium(), flight);
            let wo = -walk.w;
            if event.in_medium.any() {
                walk.scatter_in_medium(event.in_medium, &phase, albedo, u);
                specular = specular & !event.in_medium;
            }
            if event.at_base.any() {
                let sample = base.sample_f(wo, uc, u, mode, Directions::Reflection);
                specular = specular & (!event.at_base | sample.flags.is_specular());
                walk.scatter(event.at_base, &sample);
            }
            if event.at_interface.any() {
                let (interface, directions) = (&interface, Directions::All);
                let sample = R::call(SampleInterface { interface, wo, uc, u, mode, directions });
                let leaves = event.at_interface & carries_light(&sample) & sample.flags.is_transmissive();
                f = SampledSpectrum::select(leaves, walk.beta * sample.f / sample.pdf, f);
                wi = Vec3::select(leaves, sample.wi, wi);
                walk.scatter(event.at_interface, &sample);
                walk.alive = walk.alive & !leaves;
                left = left | leaves;
            }
        }
        // The ratio of f and pdf is that of a walk.
        let pdf = R::select(reflected, entrance.pdf, R::one());
        let diffuse = layers.flags().is_diffuse();
        let rough = BxdfFlags::choose(diffuse, BxdfFlags::DIFFUSE_REFLECTION, BxdfFlags::GLOSSY_REFLECTION);
        let lobe = BxdfFlags::select(specular, BxdfFlags::splat(BxdfFlags::SPECULAR_REFLECTION), rough);
        let lobe = BxdfFlags::select(reflected, entrance.flags, lobe);
        BsdfSample { valid: reflected | left, pdf_is_proportional: true, ..BsdfSample::new(f, wi, pdf, lobe) }
    }
}
