//! Pictures by GPUs: an algorithm of a [`Session`] whose passes a device renders.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use description::{Diagnostic, SceneDesc, Span};
use film::Film;
use geometry::RayStats;
use gpu::{Algorithm, Flat, Renderer, Subject, flatten};
use integrators::{Cancelled, Control, FirstHits, Integrator, PassError, Session};
use sampling::Sampler;
use scene::texture::color_space;
use scene::{Scene, View};

pub use gpu::{Device, DrawError, Drawing, GpuError, Kernels, Rasterizer, Refusal, Schedule};

/// An algorithm on a device.
struct OnDevice {
    renderer: Renderer,
    algorithm: Algorithm,
    sampler: Sampler,
    name: String,
}

/// The algorithm that a scene describes, on a device, for the scene, view and film of a session.
/// The error says what kernels do not draw.
pub(crate) fn integrator(
    desc: &SceneDesc,
    session: &Session,
    kernels: &Arc<Kernels>,
    schedule: Schedule,
) -> Result<Box<dyn Integrator>, Vec<Diagnostic>> {
    let film = &session.state().film;
    let Flattened { flat, algorithm, sampler } =
        flattened(desc, session.scene(), session.view(), film, kernels, Rays::OfDevice)?;
    let name = name(kernels.device(), &flat);
    match Renderer::new(kernels.clone(), &flat, &algorithm, film, schedule) {
        Ok(renderer) => Ok(Box::new(OnDevice { renderer, algorithm, sampler, name })),
        Err(error) => Err(vec![failed(&error)]),
    }
}

/// A scene for a device, and how it is rendered there.
pub(crate) struct Flattened {
    pub(crate) flat: Flat,
    pub(crate) algorithm: Algorithm,
    pub(crate) sampler: Sampler,
}

/// By what rays are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rays {
    /// By the ray queries of a device that was opened for them, if they trace the scene.
    OfDevice,
    /// By kernels.
    OfKernels,
}

/// The name of a device, and by what it traces rays if ray queries were asked for.
pub(crate) fn name(device: &Device, flat: &Flat) -> String {
    let name = device.name();
    if flat.parts().ray_queries {
        format!("{name} with ray queries")
    } else if device.has_ray_queries() {
        format!("{name} without ray queries, because something moves or there is too much of it")
    } else {
        name.to_owned()
    }
}

/// A scene, by the algorithm and the sampler that `desc` describes. The error says what kernels do
/// not draw.
pub(crate) fn flattened(
    desc: &SceneDesc,
    scene: &Scene,
    view: &View,
    film: &Film,
    kernels: &Kernels,
    rays: Rays,
) -> Result<Flattened, Vec<Diagnostic>> {
    let refuse = |what: String| {
        let message = format!("the engine for GPUs does not have {what}");
        vec![Diagnostic::warning("not-on-gpu", message, desc.integrator.origin.span)]
    };
    let (space, seed) = (color_space(desc.film.color_space), integrators::seed_of_integrator(desc));
    let algorithm = Algorithm::new(&desc.integrator.value, space, seed).map_err(refuse)?;
    let (sampler, light_sampler) = (integrators::sampler(desc), integrators::light_sampler(desc));
    let never = Default::default();
    let lights = scene.light_sampler(algorithm.light_sampler(), &never).unwrap_or_default();
    let largest_buffer = usize::try_from(kernels.device().largest_buffer()).unwrap_or(usize::MAX);
    let subject = Subject {
        scene,
        view,
        film,
        algorithm: &algorithm,
        sampler: &sampler,
        light_sampler: &light_sampler,
        largest_buffer,
        ray_queries: rays == Rays::OfDevice && kernels.device().has_ray_queries(),
    };
    let flat = flatten(subject, &lights)
        .map_err(|refusals| refusals.into_iter().map(Diagnostic::from).collect::<Vec<_>>())?;
    Ok(Flattened { flat, algorithm, sampler })
}

/// What is said where the device fails.
pub(crate) fn failed(error: &GpuError) -> Diagnostic {
    Diagnostic::warning("not-on-gpu", error.to_string(), Span::NONE)
}

impl Integrator for OnDevice {
    fn passes(&self) -> u32 {
        self.algorithm.passes(&self.sampler)
    }

    fn splats(&self) -> bool {
        self.algorithm.splats()
    }

    /// All is on the device already.
    fn prepare(&mut self, _scene: &Scene, _view: &View, _control: &Control) -> Result<(), Cancelled> {
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
        let filter = film.filter().clone();
        let hits = FirstHits::new(pass, scene, view, &filter, &self.sampler);
        let is_cancelled = || control.cancel.load(Ordering::Relaxed);
        match self.renderer.pass(
            pass,
            view,
            film,
            &|tile, pixel, lambda| hits.of(tile, pixel, lambda),
            is_cancelled,
        ) {
            Ok(Some(rays)) => Ok(RayStats { rays, ..RayStats::default() }),
            Ok(None) => Err(PassError::Cancelled),
            Err(gpu::PassError::OutOfMemory(problem)) => Err(PassError::OutOfMemory(problem)),
            Err(gpu::PassError::Gpu(error)) => Err(PassError::Device(error.to_string())),
        }
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        let megabytes = self.renderer.bytes() as f64 / f64::from(1 << 20);
        vec![("device", self.name.clone()), ("device memory", format!("{megabytes:.1} MiB"))]
    }
}
