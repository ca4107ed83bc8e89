//! Light paths: the offset of their random numbers, that of the choice of the light where they
//! begin, which is in proportion to power, how many of them there are in a pass for each sample of
//! a pixel, whether a surface may lie beyond the scene's sphere, the centre and radius of that, and
//! the least and the largest film position that they reach.

use film::Film;
use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::light_sampler::PowerLightSampler;

use super::Flattener;
use crate::Algorithm;

impl Flattener<'_> {
    /// What light paths need; its offset.
    pub fn light_paths(&mut self, algorithm: &Algorithm, sampler: &Sampler, film: &Film) -> u32 {
        let pixels = film.pixel_bounds().area();
        let (numbers, count) = match algorithm {
            // Their numbers are coordinates of chains; film positions have the density 1/count.
            Algorithm::Mlt(..) => (0, film.reach().area()),
            // Photons take samples of one sequence, so that those of a pass are stratified.
            Algorithm::Sppm(desc, seed) => {
                let sobol = PaddedSobol::new(desc.light_paths(pixels) as u32, Randomize::FastOwen, *seed);
                (self.sampler(&Sampler::PaddedSobol(sobol)), pixels as f32)
            }
            Algorithm::LightTracing(_)
            | Algorithm::Bdpt(_)
            | Algorithm::RayCasting
            | Algorithm::Whitted(_)
            | Algorithm::AmbientOcclusion(..)
            | Algorithm::Path(_)
            | Algorithm::VolPath(_)
            | Algorithm::SimpleVolPath(_)
            | Algorithm::SimplePath(_)
            | Algorithm::RandomWalk(_) => (self.sampler(sampler), pixels as f32),
        };
        let emitting = self.power(&PowerLightSampler::new(self.scene.lights()));
        let (sphere, reach) = (self.scene.sphere(), film.reach());
        let is_unbounded = self.scene.world().is_unbounded();
        let at = self.slab.add([numbers, emitting, count.to_bits(), is_unbounded.into()]);
        let places = [&sphere.center.to_array()[..], &[sphere.radius]].concat();
        let bounds = [reach.min, reach.max].map(|corner| corner.to_array());
        self.slab.extend_numbers(places.into_iter().chain(bounds.into_iter().flatten()));
        at
    }
}
