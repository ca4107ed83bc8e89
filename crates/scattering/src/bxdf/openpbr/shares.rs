//! How layers share the light from one direction, at all wavelengths of a path.

use super::OpenPbr;
use super::stack::{Inside, Taken};
use crate::fresnel::mean_fresnel;
use lanes::{Callee, Mask, Real};
use math::{Vec3, Vector3, safe_sqrt, sqr};
use spectrum::{N, SampledSpectrum};

/// Shares of the light from one direction above, as they were if nothing absorbed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares<R = f32> {
    /// What layers take; of what a film changes, at one wavelength.
    pub taken: Taken<R>,
    /// What the coat reflects, if it is tilted, too.
    pub coat: R,
    /// What the coat leaves to be seen of the base from the direction, over what it leaves if it is
    /// not tilted.
    pub seen: R,
    /// What the facets of the dielectric reflect.
    pub dielectric: SampledSpectrum<R>,
    /// What is left for the diffuse base.
    pub diffuse_rest: SampledSpectrum<R>,
    /// What the facets of glass reflect, on average.
    pub reflected: R,
    /// What they refract.
    pub refracted: R,
    /// What is left for scattering between the facets of glass.
    pub glass_rest: R,
    /// What glass does with light from the direction itself, if it is below.
    pub inside: Inside<R>,
}

impl<R: Real> Shares<R> {
    /// What passes the fuzz.
    #[inline(always)]
    pub fn below_fuzz(&self) -> R {
        self.taken.left + self.taken.coat
    }

    /// What is left for scattering between the facets of metal.
    #[inline(always)]
    pub fn metal_rest(&self) -> R {
        (self.taken.left - self.taken.metal).max(R::zero())
    }
}

/// Means of what is left for the last layer, over directions by their cosine; zero where nothing
/// spreads light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rests<R = f32> {
    pub fuzz: R,
    pub metal: R,
    pub diffuse: SampledSpectrum<R>,
    pub glass_above: R,
    pub glass_below: R,
    /// The share of the rest of glass that passes to the other side, from above and from below.
    pub through_above: R,
    pub through_below: R,
}

/// The shares of a direction.
struct SharesAt<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    w: Vector3<R>,
}

impl<R: Real> Callee<R> for SharesAt<'_, '_, R> {
    type Output = Shares<R>;

    #[inline(always)]
    fn run(self) -> Shares<R> {
        let Self { surface, w } = self;
        let mut shares = surface.bulk_shares(w);
        let is_glass = surface.glass().gt(R::zero());
        if surface.stack.is_thin {
            if is_glass.any() {
                let sheet = surface.table.inside(&surface.location, &surface.waves, w);
                shares.reflected = sheet.reflected;
                shares.refracted = sheet.refracted;
                shares.glass_rest = sheet.left;
            }
        } else if (is_glass & w.z.lt(R::zero())).any() {
            shares.inside = surface.table.inside(&surface.location, &surface.waves, w);
        }
        surface.under_coat(shares, w)
    }
}

impl<R: Real> OpenPbr<'_, R> {
    /// The shares of a direction above or, if it is below, of its opposite.
    #[inline(always)]
    pub(super) fn shares(&self, w: Vector3<R>) -> Shares<R> {
        R::call(SharesAt { surface: self, w })
    }

    /// The same where glass is no sheet, without what is inside.
    #[inline(always)]
    fn bulk_shares(&self, w: Vector3<R>) -> Shares<R> {
        let zero = R::zero();
        let taken = self.table.taken(&self.location, self.waves[0], w);
        let mut shares = Shares {
            taken,
            coat: taken.coat,
            seen: R::one(),
            dielectric: SampledSpectrum::splat(taken.dielectric),
            diffuse_rest: SampledSpectrum::splat((taken.left - taken.dielectric).max(zero)),
            reflected: taken.dielectric,
            refracted: taken.refracted,
            glass_rest: (taken.left - taken.dielectric - taken.refracted).max(zero),
            inside: Inside { reflected: zero, refracted: zero, left: zero },
        };
        if self.table.has_film() {
            let (mut refracted, mut rest) = (shares.diffuse_rest, shares.diffuse_rest);
            for i in 0..N {
                let taken = self.table.taken(&self.location, self.waves[i], w);
                shares.dielectric[i] = taken.dielectric;
                shares.diffuse_rest[i] = (taken.left - taken.dielectric).max(zero);
                refracted[i] = taken.refracted;
                rest[i] = (taken.left - taken.dielectric - taken.refracted).max(zero);
            }
            shares.reflected = shares.dielectric.average();
            shares.refracted = refracted.average();
            shares.glass_rest = rest.average();
        }
        shares
    }

    /// What the layers over the base pass on at a cosine, for a middle azimuth.
    #[inline(always)]
    pub(super) fn passed(&self, cosine: R) -> R {
        let across = safe_sqrt(R::splat(0.5) * (R::one() - sqr(cosine)));
        self.table.taken(&self.location, R::zero(), Vec3::new(across, across, cosine)).below_coat
    }

    /// The means of what is left.
    #[inline(always)]
    pub(super) fn rests(&self) -> Rests<R> {
        let zero = R::zero();
        let means = self.table.means(&self.location, self.waves[0]);
        let spreads = self.stack.spreads();
        let above = R::select(spreads, means.glass_above, zero);
        let below = R::select(spreads, means.glass_below, zero);
        let mut rests = Rests {
            fuzz: means.fuzz,
            metal: R::select(spreads, means.metal, zero),
            diffuse: SampledSpectrum::splat(means.diffuse),
            glass_above: above,
            glass_below: below,
            through_above: zero,
            through_below: zero,
        };
        if self.table.has_film() {
            for i in 0..N {
                rests.diffuse[i] = self.table.means(&self.location, self.waves[i]).diffuse;
            }
        }
        if self.stack.is_thin {
            let half = R::splat(0.5);
            return Rests { through_above: half, through_below: half, ..rests };
        }
        let is_glass = above.gt(zero) & below.gt(zero) & self.glass().gt(zero);
        if is_glass.any() {
            let most = sqr(self.stack.index) * below / above;
            let through = (R::one() - mean_fresnel(self.stack.index)).min(most);
            rests.through_above = R::select(is_glass, through, zero);
            rests.through_below = R::select(is_glass, through / most, zero);
        }
        rests
    }
}
