//! Light paths: the offset of their random numbers, that of the choice of the light where they
//! begin, which is in proportion to power, their number in a pass, whether a surface may lie beyond
//! the scene's sphere, the centre and radius of that, and the least and the largest film position
//! that they reach.

use film::Film;
use sampling::Sampler;
use scene::light_sampler::PowerLightSampler;

use super::Flattener;

impl Flattener<'_> {
    /// What light paths need; its offset.
    pub fn light_paths(&mut self, sampler: &Sampler, film: &Film) -> u32 {
        let numbers = self.sampler(sampler);
        let emitting = self.power(&PowerLightSampler::new(self.scene.lights()));
        let (sphere, reach) = (self.scene.sphere(), film.reach());
        let is_unbounded = self.scene.world().is_unbounded();
        let count = film.pixel_bounds().area() as f32;
        let at = self.slab.add([numbers, emitting, count.to_bits(), is_unbounded.into()]);
        let places = [&sphere.center.to_array()[..], &[sphere.radius]].concat();
        let bounds = [reach.min, reach.max].map(|corner| corner.to_array());
        self.slab.add_numbers(places.into_iter().chain(bounds.into_iter().flatten()));
        at
    }
}
