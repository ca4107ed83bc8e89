//! Pictures by GPUs: an algorithm of a [`Session`] whose passes a device renders.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use description::{Diagnostic, SceneDesc, Schedule, Span};
use film::Film;
use geometry::RayStats;
use gpu::{Algorithm, Flat, Renderer, Subject, flatten, lacking_stages};
use integrators::{Cancelled, Control, FirstHits, Integrator, PassError, Session};
use sampling::Sampler;
use scene::texture::color_space;
use scene::{Scene, View};

pub use gpu::{Device, DrawError, Drawing, GpuError, Kernels, Rasterizer, Refusal};

/// An algorithm on a device.
struct OnDevice {
    renderer: Renderer,
    algorithm: Algorithm,
    sampler: Sampler,
    name: String,
}

/// Goes on with a session by the algorithm that a scene describes, on a device. Warnings are of
/// what is done otherwise than described. The error says what kernels do not draw, and leaves the
/// session as it was.
pub fn move_to(
    session: &mut Session,
    desc: &SceneDesc,
    kernels: &Arc<Kernels>,
) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let film = &session.state().film;
    let Flattened { flat, algorithm, sampler } =
        flattened(desc, session.scene(), session.view(), film, kernels, Rays::OfDevice)?;
    let schedule = desc.options.schedule;
    let lacking = lacking_stages(&algorithm, flat.parts()).filter(|_| schedule == Schedule::Wavefront);
    let name = name(kernels.device(), &flat);
    let renderer = Renderer::new(kernels.clone(), &flat, &algorithm, film, schedule)
        .map_err(|error| vec![failed(&error)])?;
    session.set_integrator(Box::new(OnDevice { renderer, algorithm, sampler, name }));
    let warning = lacking.map(|what| {
        let message =
            format!("the schedule `wavefront` has no stages for {what}: there is one kernel instead");
        Diagnostic::warning("no-wavefront", message, desc.options.origin.parameter("schedule"))
    });
    Ok(warning.into_iter().collect())
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
        let occupancy = self.renderer.occupancy();
        let occupancy = occupancy.map(|share| ("occupancy", format!("{:.1} % of the places", 100.0 * share)));
        [("device", self.name.clone()), ("device memory", format!("{megabytes:.1} MiB"))]
            .into_iter()
            .chain(occupancy)
            .collect()
    }
}
