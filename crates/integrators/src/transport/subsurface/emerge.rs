//! Where light that enters a body emerges from it: the way of a camera path, backwards.
//!
//! With the point pi where light of flux β arrives along ωi, the point po where it leaves along ωo,
//! the direction w within the body at po, T the boundary's transmission, and Sw and Sp as in
//! [`Bssrdf`](scattering::Bssrdf), a camera path finds
//!
//! ```text
//! diffusion     β Sw(ωi) Sp(|po − pi|) ∫ T(ωo, w) |cos w| dw
//! random walk   β Sw(ωi) ∫∫ (1 − Fr(w')) G(pi, w' → po, w) |cos w'| T(ωo, w) |cos w| dw' dw
//! ```
//!
//! where T is not scaled by refraction, and G is the radiance at po per radiance that starts from
//! pi along w'. Diffused light leaves in all directions, as the integral of the first line says.
//! For a walk, w' has the density |cos w'|/π about the normal of pi, and the walk chooses w; then
//! the boundary refracts light from there. As this is one direction or few, nothing is connected to
//! po.
//!
//! po is found by the probe about pi, as the profile depends on the distance alone, but has the
//! material's coefficients at po. A walk has those at pi.

use math::{Frame, RayDifferential};
use sampling::warp::sample_cosine_hemisphere;
use scattering::{Body, Bsdf};
use scattering::{TransportMode, fr_dielectric};
use scene::{Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

use super::Exit;
use crate::transport::Tracer;
use crate::transport::media::Heroes;

/// The least probability with which a walk leaves through a rough boundary, of which some facets
/// let through what a smooth one reflects.
const LEAVES_ROUGH: f32 = 0.25;

impl Tracer<'_> {
    /// Samples where a light path that enters a body of the scene at `entry` leaves it; `None` if
    /// it does not.
    pub(crate) fn emerge<'a>(
        &mut self,
        scene: &'a Scene,
        entry: &SurfaceInteraction,
        body: Body,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
    ) -> Option<Exit<'a>> {
        let s = &entry.surface;
        // Power includes the cosine to the geometric normal; scattering has that to the shading
        // normal.
        let cosine = s.wo.dot(s.shading.n);
        let cosines = cosine / s.wo.dot(s.n).abs();
        if !(cosine > 0.0 && cosines.is_finite()) {
            return None;
        }
        let lobe = Bsdf::new(s.shading.n, s.shading.dpdu, body.exit());
        let entering = lobe.f(s.shading.n, s.wo, TransportMode::Radiance) * (cosines * PI);
        let (mut surface, value, density) = match body.profile() {
            Some(bssrdf) => {
                let (surface, density) = self.probe(&entry.into(), &bssrdf.profiles(), heroes.hero)?;
                (surface, entering, density)
            }
            None => {
                let inside = body.interior();
                let u = self.sampler.get_2d();
                let wi = -Frame::from_z(s.n).from_local(sample_cosine_hemisphere(u));
                let passes = 1.0 - fr_dielectric(-wi.dot(s.n).abs(), inside.eta);
                let least = if body.is_smooth() { 0.0 } else { LEAVES_ROUGH };
                let walked = self.walk(&entry.into(), &inside, wi, heroes, least)?;
                let value = walked.value * entering * (passes / walked.probability);
                (walked.surface, value, walked.density)
            }
        };
        if body.diffuses() {
            surface.surface.wo = surface.surface.n;
        }
        let ray = RayDifferential::from(surface.spawn_ray(surface.surface.wo));
        let mut bsdf = scene.bsdf(self.view, &mut surface, &ray, &mut lambda.clone(), self.sampler)?;
        let there = bsdf.bxdf.body()?;
        let value = value
            * match there.profile() {
                Some(bssrdf) => bssrdf.profiles().at(surface.p().distance(entry.p())),
                None => SampledSpectrum::splat(there.eta() * there.eta()),
            };
        bsdf.bxdf.keep_leaving(body.diffuses())?;
        if body.diffuses() {
            // Of equal cosines to both normals, so that only that of the way on counts.
            surface.surface.wo = (surface.surface.n + surface.surface.shading.n).normalize();
        }
        if density[heroes.hero] <= 0.0 || value.is_black() {
            return None;
        }
        Some(Exit { surface, bsdf, value, density })
    }
}
