//! Light tracing: light paths connected to the camera.
//!
//! A light subpath starts at a light, chosen in proportion to power, and is scattered from surface
//! to surface by BSDF sampling. As no ray can hit a pinhole, each of its vertices x is connected to
//! the camera: if it is visible, the pixel of the film position of x receives
//!
//! ```text
//! β·f(x)·|cos θ|·W_e / p_lens
//! ```
//!
//! where β is the flux that arrived over the density of the subpath, W_e the importance of the
//! camera and p_lens the density of the point on the lens. The picture is the mean over all
//! subpaths.
//!
//! Its strength is focused light: light subpaths sample the caustic of a glass ball well. Mirrors
//! and glass stay black, as no vertex can be connected through a specular surface. Most rays do not
//! contribute to the picture; the summary reports the share that does. Directly visible lights, of
//! depth 0, are rendered by one camera ray per pixel, since infinite lights are not vertices of
//! subpaths.
//!
//! Light subpaths go under the surfaces of bodies
//! (`bidirectional/under_surface.rs`). Where they come out of a random walk they are not connected:
//! a camera ray that meets such a body makes the walk, and those through other bodies that it comes
//! to directly, and the vertices of the light subpath are connected to the end of each.
//!
//! Unbiased for paths that it can sample. Unbounded surfaces are black beyond the scene's bounds
//! where light comes from infinity (`unbounded.rs`). A light subpath that a cancellation cuts off
//! has splatted its first vertices. Sources: [Arvo 1986]; [Dutré 1993]; [Veach 1997 §10.3.1].

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use description::{Diagnostic, LightTracingDesc};
use film::Film;
use geometry::RayStats;
use sampling::Sampler;
use scattering::Body;
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use crate::bidirectional::{Balance, Bidirectional, Encounter, Lights, Vertex};
use crate::light_paths::unbounded;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError};

/// Light tracing.
#[derive(Debug)]
pub struct LightTracing {
    settings: LightTracingDesc,
    sampler: Sampler,
    light_sampler: Sampler,
    lights: Lights,
    /// Rays of light subpaths, including those to the camera.
    rays: AtomicU64,
    /// The number of these that reached the film.
    reached: AtomicU64,
}

impl LightTracing {
    /// `sampler` is for camera rays, `light_sampler` for light subpaths.
    pub fn new(settings: LightTracingDesc, sampler: Sampler, light_sampler: Sampler) -> Self {
        let [rays, reached] = [0; 2].map(AtomicU64::new);
        Self { settings, sampler, light_sampler, lights: Lights::none(), rays, reached }
    }
}

impl Integrator for LightTracing {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn splats(&self) -> bool {
        true
    }

    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        unbounded::warnings(scene, "light-tracing")
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.lights = Lights::and_media(scene, view, control)?;
        Ok(())
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::connecting(film.pixel_bounds().area() as f32),
            max_depth: self.settings.max_depth,
            light_goes_under: true,
            regularize: false,
        };
        let filter = film.filter().clone();
        let (tiles, splatter) = film.tiles_and_splatter()?;
        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
        let stats = pixels.add(tiles, control, |sample, tracer| {
            let lambda = &sample.lambda;
            let mut light_sampler = self.light_sampler.clone();
            light_sampler.start_pixel_sample(sample.pixel, pass, 0);
            let (mut l, mut exits) = (SampledSpectrum::ZERO, Vec::new());
            if let Some(camera_ray) = &sample.camera_ray {
                let walks = Cell::new(0);
                let is_end = |vertex: &Vertex| {
                    let walks_on = |body: Body| !body.diffuses();
                    // A body of greater depth is seen by reflection.
                    let is_next = vertex.depth == walks.get() + 1 && vertex.body().is_some_and(walks_on);
                    !(vertex.is_exit || is_next)
                };
                paths.camera_subpath_to(is_end, camera_ray, lambda, tracer, |encounter, tracer| {
                    match encounter {
                        Encounter::Light(found) if found.t == 2 => l += found.l,
                        Encounter::Vertex(vertex) if vertex.is_exit => {
                            if let Some(found) = paths.direct(vertex, lambda, tracer) {
                                l += found.l;
                            }
                            walks.set(vertex.depth);
                            exits.push(*vertex);
                        }
                        _ => (),
                    }
                });
            }
            let (mut reached, rays_before) = (0, tracer.stats.rays);
            tracer.with_sampler(&mut light_sampler, |tracer| {
                paths.light_subpath(sample.time, lambda, tracer, |vertex, tracer| {
                    let u = tracer.sampler.get_2d();
                    if let Some(seen) = paths.connect_to_camera(vertex, u, splatter.reach(), lambda, tracer) {
                        seen.splat(&splatter, &seen.found.l, lambda);
                        reached += 1;
                    }
                    for exit in exits.iter().filter(|exit| exit.depth + vertex.depth <= paths.max_depth) {
                        if let Some(found) = paths.connect(exit, vertex, lambda, tracer) {
                            l += found.l;
                        }
                    }
                });
            });
            splatter.add_paths(1);
            self.rays.fetch_add(tracer.stats.rays - rays_before, Ordering::Relaxed);
            self.reached.fetch_add(reached, Ordering::Relaxed);
            l
        })?;
        Ok(stats)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        let [reached, rays] = [&self.reached, &self.rays].map(|count| count.load(Ordering::Relaxed));
        let share = 100.0 * reached as f64 / rays.max(1) as f64;
        vec![(
            "reached",
            format!("{share:.2} % of the rays of light paths contributed to the film, {reached} of {rays}"),
        )]
    }
}
