//! How layers share the light from one direction, at all wavelengths of a path.

use super::OpenPbr;
use super::stack::{Inside, Taken};
use crate::fresnel::mean_fresnel;
use math::{Vector3, sqr};
use spectrum::SampledSpectrum;

/// Shares of the light from one direction above, as they were if nothing absorbed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    /// What layers take; of what a film changes, at one wavelength.
    pub taken: Taken,
    /// What the facets of the dielectric reflect.
    pub dielectric: SampledSpectrum,
    /// What is left for the diffuse base.
    pub diffuse_rest: SampledSpectrum,
    /// What the facets of glass reflect, on average.
    pub reflected: f32,
    /// What they refract.
    pub refracted: f32,
    /// What is left for scattering between the facets of glass.
    pub glass_rest: f32,
}

impl Shares {
    /// What passes the fuzz.
    #[inline]
    pub fn below_fuzz(&self) -> f32 {
        self.taken.left + self.taken.coat
    }

    /// What is left for scattering between the facets of metal.
    #[inline]
    pub fn metal_rest(&self) -> f32 {
        (self.taken.left - self.taken.metal).max(0.0)
    }
}

/// Means of what is left for the last layer, over directions by their cosine; zero where nothing
/// spreads light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rests {
    pub fuzz: f32,
    pub metal: f32,
    pub diffuse: SampledSpectrum,
    pub glass: [f32; 2],
    /// The share of the rest of glass that passes to the other side, from above and from below.
    pub through: [f32; 2],
}

impl OpenPbr<'_> {
    /// The shares of a direction above or, if it is below, of its opposite.
    #[inline]
    pub(super) fn shares(&self, w: Vector3) -> Shares {
        let mut shares = self.bulk_shares(w);
        if self.stack.is_thin && self.glass() > 0.0 {
            let sheet = self.inside(w);
            let (reflected, refracted, glass_rest) = (sheet.reflected, sheet.refracted, sheet.left());
            shares = Shares { reflected, refracted, glass_rest, ..shares };
        }
        self.under_coat(shares, w)
    }

    /// The same where glass is no sheet.
    #[inline]
    fn bulk_shares(&self, w: Vector3) -> Shares {
        if !self.table.has_film() {
            let taken = self.table.taken(&self.numbers, 0.0, w);
            return Shares {
                taken,
                dielectric: SampledSpectrum::splat(taken.dielectric),
                diffuse_rest: SampledSpectrum::splat((taken.left - taken.dielectric).max(0.0)),
                reflected: taken.dielectric,
                refracted: taken.refracted,
                glass_rest: (taken.left - taken.dielectric - taken.refracted).max(0.0),
            };
        }
        let each = self.waves.0.map(|waves| self.table.taken(&self.numbers, waves, w));
        let of = |value: fn(&Taken) -> f32| SampledSpectrum::new(each.each_ref().map(value));
        let dielectric = of(|taken| taken.dielectric);
        Shares {
            taken: each[0],
            dielectric,
            reflected: dielectric.average(),
            diffuse_rest: of(|taken| (taken.left - taken.dielectric).max(0.0)),
            refracted: of(|taken| taken.refracted).average(),
            glass_rest: of(|taken| (taken.left - taken.dielectric - taken.refracted).max(0.0)).average(),
        }
    }

    /// What glass does with light from a direction below or, if it is a sheet, from either side.
    pub(super) fn inside(&self, w: Vector3) -> Inside {
        self.table.inside(&self.numbers, &self.waves, w)
    }

    /// What the layers above the base let pass at a cosine.
    pub(super) fn passed(&self, cosine: f32) -> f32 {
        self.table.passed(&self.numbers, cosine)
    }

    /// The means of what is left.
    #[inline]
    pub(super) fn rests(&self) -> Rests {
        let means = self.table.means(&self.numbers, self.waves[0]);
        let mut rests = Rests {
            fuzz: means.fuzz,
            metal: means.metal,
            diffuse: SampledSpectrum::splat(means.diffuse),
            glass: means.glass,
            through: [0.0; 2],
        };
        if self.table.has_film() {
            let others = self.waves.map(|waves| self.table.means(&self.numbers, waves).diffuse);
            rests.diffuse = others;
        }
        if !self.stack.spreads() {
            (rests.metal, rests.glass) = (0.0, [0.0; 2]);
        }
        if self.stack.is_thin {
            rests.through = [0.5; 2];
            return rests;
        }
        let [above, below] = rests.glass;
        if above > 0.0 && below > 0.0 && self.glass() > 0.0 {
            let most = sqr(self.stack.index) * below / above;
            let through = (1.0 - mean_fresnel(self.stack.index)).min(most);
            rests.through = [through, through / most];
        }
        rests
    }
}
