//! Path tracing between surfaces, in scenes with media: flights, and vertices where media scatter.
//!
//! Emission of media counts along every flight, that of paths of `max_depth` scattering events
//! included.

use film::FirstEvent;
use math::Point3;
use scattering::HenyeyGreenstein;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Path;
use crate::Tracer;
use crate::transport::media::FlightEnd;
use crate::transport::path_state::PathState;
use crate::transport::vertex::{MediumVertex, Vertex};

impl Path {
    /// Lets a path fly through its medium, if it has one, up to `t_max`. Returns the light on the
    /// way, if it `counts`, and the end, which is never a vertex beyond `max_depth`.
    #[inline]
    pub(crate) fn fly(
        &self,
        tracer: &mut Tracer,
        path: &mut PathState,
        t_max: f32,
        lambda: &SampledWavelengths,
        counts: bool,
    ) -> (SampledSpectrum, FlightEnd) {
        let Some(flight) = path.fly(tracer, t_max, lambda) else {
            return (SampledSpectrum::ZERO, FlightEnd::Passed);
        };
        let l = if counts { flight.emitted } else { SampledSpectrum::ZERO };
        tracer.take_part(None, &path.first, path.depth, l);
        let end = match flight.end {
            FlightEnd::Scattered { .. } if path.depth == self.settings.max_depth => FlightEnd::Absorbed,
            end => end,
        };
        (l, end)
    }

    /// Scatters a path in a medium; returns the direct light, and whether it goes on.
    pub(super) fn scatter_in_medium(
        &self,
        tracer: &mut Tracer,
        path: &mut PathState,
        p: Point3,
        phase: HenyeyGreenstein,
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        path.depth += 1;
        if path.depth == 1 {
            path.first = FirstEvent::Volume;
        }
        let vertex = MediumVertex::new(p, &path.ray.ray, phase);
        let l = self.direct(tracer, path, &Vertex::Medium(&vertex), lambda);
        let (wi, pdf) = phase.sample_p(vertex.wo, tracer.sampler.get_2d());
        path.leave(vertex.context.spawn_ray(wi).into(), pdf, Some(vertex.context));
        (l, self.goes_on(tracer, path))
    }
}
