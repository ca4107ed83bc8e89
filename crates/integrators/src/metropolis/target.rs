//! Target functions of chains: the contribution of the path at a point of primary sample space.

use film::Splatter;
use math::{Bounds2, Point2};
use sampling::Sampler;
use scene::ShutterSample;
use scene::camera::{CameraRayDifferential, CameraSample, FilmPositions};
use spectrum::{SampledSpectrum, SampledWavelengths, xyz_from};

use crate::Path;
use crate::bidirectional::Bidirectional;
use crate::transport::Tracer;
use crate::transport::pixel_samples::camera_ray;

/// A contribution to the film.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contribution {
    /// Positions in pixels.
    places: FilmPositions,
    /// Radiance over the density of the point.
    l: SampledSpectrum,
    /// The wavelengths of `l`.
    lambda: SampledWavelengths,
    /// Whether the film wants light at all wavelengths alike, not as the eye sees it.
    is_spectral: bool,
}

impl Contribution {
    /// The scalar contribution function: the mean of X, Y and Z, which is positive for all colours,
    /// or for a spectral film the light's integral over wavelength.
    pub fn c(&self) -> f32 {
        let c = if self.is_spectral {
            self.l.safe_div(self.lambda.pdf()).average()
        } else {
            let xyz = xyz_from(&self.l, &self.lambda);
            (xyz.x + xyz.y + xyz.z) / 3.0
        };
        if c.is_finite() { c.max(0.0) } else { 0.0 }
    }

    /// Splats the light, times a factor.
    pub fn splat(&self, factor: f32, splatter: &Splatter) {
        if factor > 0.0 && !self.l.is_black() {
            let l = self.l * factor;
            self.places.within(splatter.reach()).for_each(|film| splatter.add(film, &l, &self.lambda));
        }
    }
}

/// The film positions that contribute to pixels: the pixels, extended by the filter's radius.
#[derive(Clone, Copy)]
pub(super) struct FilmDomain(Bounds2);

/// The camera's end of a path.
struct CameraEnd {
    film: Point2,
    lambda: SampledWavelengths,
    time: f32,
    camera_ray: Option<CameraRayDifferential>,
}

impl FilmDomain {
    pub fn new(splatter: &Splatter) -> Self {
        Self(splatter.reach())
    }

    /// The area in pixels: one over the density of film positions.
    pub fn area(&self) -> f32 {
        self.0.area()
    }

    /// The camera's dimensions: wavelengths (1), film (2), time (1), lens (2).
    fn sample(&self, tracer: &mut Tracer) -> CameraEnd {
        let Tracer { scene, view, sampler, .. } = tracer;
        let wavelength = sampler.get_1d();
        let film = self.0.lerp(sampler.get_2d());
        let (time, lens) = (sampler.get_1d(), sampler.get_2d());
        let sample = CameraSample { film, lens, time, filter_weight: 1.0 };
        CameraEnd {
            film,
            lambda: ShutterSample::wavelengths(view, wavelength),
            time: view.camera.sample_time(time),
            camera_ray: camera_ray(scene, view, &sample),
        }
    }
}

/// Maps points of primary sample space to contributions.
pub(super) trait Target: Sync {
    /// The contribution of a point; its mean over the cube is the picture. The tracer holds the
    /// first stream of random numbers.
    fn contribution(&self, tracer: &mut Tracer, others: &mut [Sampler; 2]) -> Contribution;
}

/// Path tracing: a camera path with all its contributions.
pub(super) struct CameraPaths<'a> {
    pub film: FilmDomain,
    pub path: &'a Path,
}

impl Target for CameraPaths<'_> {
    fn contribution(&self, tracer: &mut Tracer, _: &mut [Sampler; 2]) -> Contribution {
        let CameraEnd { film, mut lambda, camera_ray, .. } = self.film.sample(tracer);
        let l = camera_ray.map_or(SampledSpectrum::ZERO, |camera_ray| {
            let l = self.path.li_from(1, tracer, camera_ray.ray, &mut lambda);
            l * (camera_ray.weight * self.film.area())
        });
        Contribution { places: film.into(), l, lambda, is_spectral: tracer.view.wavelengths.is_some() }
    }
}

/// Bidirectional path tracing: one path, sampled by one strategy.
///
/// The first dimensions choose the number of scattering events ([`Depths`]), and then one of the
/// strategies, all with the same probability; the contribution is divided by the probability of
/// both. Camera subpath, light subpath and connection have separate streams, so that the length of
/// one subpath does not shift the dimensions of the other.
pub(super) struct ConnectedPaths<'a> {
    pub film: FilmDomain,
    pub paths: Bidirectional<'a>,
}

impl Target for ConnectedPaths<'_> {
    fn contribution(&self, tracer: &mut Tracer, others: &mut [Sampler; 2]) -> Contribution {
        let greatest = self.paths.max_depth;
        let (depth, probability) = Depths { greatest }.choose(tracer.sampler.get_1d());
        let strategies = depth + 2;
        let s = choose(tracer.sampler.get_1d(), strategies);
        let end = self.film.sample(tracer);
        let lambda = end.lambda;
        let (places, l) = self
            .find(s, strategies - s, &end, tracer, others)
            .unwrap_or((end.film.into(), SampledSpectrum::ZERO));
        let is_spectral = tracer.view.wavelengths.is_some();
        Contribution { places, l: l * (strategies as f32 / probability), lambda, is_spectral }
    }
}

impl ConnectedPaths<'_> {
    /// The contribution of the strategy (s, t), and its film positions.
    fn find(
        &self,
        s: u32,
        t: u32,
        end: &CameraEnd,
        tracer: &mut Tracer,
        [light, connection]: &mut [Sampler; 2],
    ) -> Option<(FilmPositions, SampledSpectrum)> {
        let (paths, lambda) = (&self.paths, &end.lambda);
        let mut light_vertex = |tracer: &mut Tracer| {
            let vertex =
                tracer.with_sampler(light, |tracer| paths.light_vertex(s - 1, end.time, lambda, tracer))?;
            vertex.is_connectible().then_some(vertex)
        };
        if t == 1 {
            let vertex = light_vertex(tracer)?;
            let on_film =
                paths.connect_to_camera(&vertex, connection.get_2d(), self.film.0, lambda, tracer)?;
            return Some((on_film.places, on_film.found.weighted()));
        }
        let camera_ray = end.camera_ray.as_ref()?;
        let l = if s == 0 {
            paths.lights_met(t - 2, camera_ray, lambda, tracer)
        } else {
            let (mut l, mut from_light) = (SampledSpectrum::ZERO, None);
            paths.camera_vertices(t - 1, camera_ray, lambda, tracer, |vertex, tracer| {
                if !vertex.is_connectible() {
                    return;
                }
                let found = if s == 1 {
                    tracer.with_sampler(connection, |tracer| paths.direct(vertex, lambda, tracer))
                } else {
                    let light = from_light.get_or_insert_with(|| light_vertex(tracer));
                    light.as_ref().and_then(|light| paths.connect(vertex, light, lambda, tracer))
                };
                l += found.map_or(SampledSpectrum::ZERO, |found| found.weighted());
            });
            l
        };
        Some((end.film.into(), l * self.film.area()))
    }
}

/// One of the numbers 0 to `count` − 1, all with the same probability.
fn choose(u: f32, count: u32) -> u32 {
    ((u * count as f32) as u32).min(count - 1)
}

/// The distribution of the number of scattering events of a path, from 1 to d_max.
///
/// Light that is scattered often is faint, so longer paths have lower probabilities. Without d_max,
/// the probability of d or more events is
///
/// ```text
/// T(d) = (8/(7 + d))²        and so, up to d_max,   p(d) = (T(d) − T(d + 1)) / (1 − T(d_max + 1))
/// ```
///
/// The first few numbers have nearly the same probability. As p falls as d⁻³, more slowly than
/// light does in any room, contributions over p are bounded; the mean number of events is still
/// finite, at most 8.5 for any d_max.
#[derive(Clone, Copy, Debug)]
struct Depths {
    /// d_max, above 0.
    greatest: u32,
}

impl Depths {
    const SCALE: f64 = 8.0;

    /// The probability of `depth` or more events without d_max.
    fn at_least(depth: f64) -> f64 {
        (Self::SCALE / (Self::SCALE - 1.0 + depth)).powi(2)
    }

    /// The number sampled by `u` in [0, 1), and its probability.
    fn choose(self, u: f32) -> (u32, f32) {
        let greatest = f64::from(self.greatest);
        let all = 1.0 - Self::at_least(greatest + 1.0);
        let rest = 1.0 - f64::from(u) * all;
        let depth = (Self::SCALE / rest.sqrt() - (Self::SCALE - 1.0)).floor().clamp(1.0, greatest);
        let probability = (Self::at_least(depth) - Self::at_least(depth + 1.0)) / all;
        (depth as u32, probability as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_have_their_probability() {
        for greatest in [1, 2, 5, 100, 70_000, 2_000_000_000] {
            const CELLS: usize = 40;
            let (count, depths) = (100_000, Depths { greatest });
            let (mut observed, mut expected) = ([0; CELLS], [0.0; CELLS]);
            for i in 0..count {
                let (depth, probability) = depths.choose((i as f32 + 0.5) / count as f32);
                assert!((1..=greatest).contains(&depth) && probability > 0.0);
                let cell = (depth as usize - 1).min(CELLS - 1);
                observed[cell] += 1;
                expected[cell] = f64::from(probability) * f64::from(count);
            }
            let rest: f64 = expected[..CELLS - 1].iter().sum();
            expected[CELLS - 1] = f64::from(count) - rest;
            for (observed, expected) in observed.iter().zip(expected) {
                assert!((f64::from(*observed) - expected).abs() < 2.0, "{greatest}: {observed} {expected}");
            }
        }
    }

    #[test]
    fn depths_are_bounded() {
        for greatest in [1_000_000, u32::MAX - 2] {
            let (depth, probability) = Depths { greatest }.choose(math::ONE_MINUS_EPSILON);
            assert!(depth < 1 << 15 && probability > 0.0, "{depth} {probability}");
        }
    }
}
