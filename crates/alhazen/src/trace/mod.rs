//! The paths of a pixel: what happens along them, in words and as drawings.
//!
//! A [`PixelTrace`] has the steps of some samples of a pixel in world space. It is told in words by
//! its `Display`, drawn by [`Drawing`] as an SVG picture over a cutaway view of the scene, and
//! written as a PLY file of edges.

mod cutaway;
mod drawing;
mod edges;
mod frame;
mod ply;
mod words;

use std::ops::Range;

use integrators::{Cancelled, Control, Step};
use math::Vec3;
use scattering::BxdfFlags;
use scene::Scene;
use scene::light::LightId;
use spectrum::SampledSpectrum;

pub use drawing::{Drawing, Side};
pub use edges::{Edge, EdgeKind};
pub use ply::to_ply;

use crate::Job;

/// What happens along the paths of samples of a pixel.
#[derive(Clone, Debug)]
pub struct PixelTrace {
    /// Column and row of the pixel.
    pub pixel: [i32; 2],
    /// Its samples.
    pub samples: Vec<SampleTrace>,
}

/// What happens along the paths of a sample.
#[derive(Clone, Debug)]
pub struct SampleTrace {
    /// The index of the sample in the pixel.
    pub index: u32,
    /// The wavelengths at which light is followed, in nanometres.
    pub wavelengths: Vec<f32>,
    /// Its colour, as it is added to the picture.
    pub rgb: [f32; 3],
    /// What happens.
    pub steps: Vec<TraceStep>,
}

/// A step of a sample in world space.
#[derive(Clone, Debug, PartialEq)]
pub enum TraceStep {
    /// A ray to the nearest surface.
    Ray {
        /// How it leaves.
        way: Way,
        /// The number of the vertex that it leaves, counted from 1; 0 for the camera, and for a ray
        /// that goes straight on.
        vertex: usize,
        /// Where it begins.
        from: Vec3,
        /// Its direction, of unit length.
        d: Vec3,
        /// The distance to the surface that it hits, and the name of the object.
        hit: Option<(f32, String)>,
    },
    /// The surface scatters light.
    Surface {
        /// The point.
        p: Vec3,
        /// The name of its material.
        material: String,
        /// The kinds of scattering.
        lobes: String,
    },
    /// A medium scatters light at a point.
    Medium {
        /// The point.
        p: Vec3,
    },
    /// A shadow ray.
    Shadow {
        /// Where it begins.
        from: Vec3,
        /// Its direction, of unit length.
        d: Vec3,
        /// Its length, which may be infinite.
        length: f32,
        /// Whether nothing is in its way.
        is_clear: bool,
    },
    /// Light reaches the camera.
    Light {
        /// The light.
        name: String,
        /// How often it is scattered on its way.
        events: u32,
        /// The colour that it adds to the sample.
        rgb: [f32; 3],
    },
}

/// How a ray leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// From the camera.
    Camera,
    /// From a surface, on the side from which the path has come.
    Reflected,
    /// From a surface, on the other side.
    Transmitted,
    /// From a point in a medium.
    Scattered,
    /// On through an interface between media, or otherwise straight on.
    Onward,
}

/// Why there is no trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceError {
    /// The render does not have this pixel.
    NoPixel,
    /// The algorithm does not estimate pixels one by one.
    Algorithm,
    /// It was cancelled.
    Cancelled,
}

impl From<Cancelled> for TraceError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl PixelTrace {
    /// Traces samples of a pixel of a job, without adding them to its film.
    pub fn new(
        job: &mut Job,
        pixel: [i32; 2],
        samples: Range<u32>,
        control: &Control,
    ) -> Result<Self, TraceError> {
        let session = &mut job.session;
        if !session.state().film.pixel_bounds().contains(pixel) {
            return Err(TraceError::NoPixel);
        }
        let samples = samples.map(|index| {
            let record = session.record(pixel, index, control)?.ok_or(TraceError::Algorithm)?;
            let (scene, film) = (session.scene(), &session.state().film);
            let colors = |l: &SampledSpectrum| film.rgb(l, &record.lambda);
            let steps = Steps { scene, vertices: Vec::new(), rays: 0 }.all(&record.steps, colors);
            let wavelengths = record.lambda.lambda().iter().zip(record.lambda.pdf().0);
            let wavelengths = wavelengths.filter(|(_, pdf)| *pdf > 0.0).map(|(lambda, _)| *lambda).collect();
            Ok(SampleTrace { index, wavelengths, rgb: colors(&record.l), steps })
        });
        Ok(Self { pixel, samples: samples.collect::<Result<_, TraceError>>()? })
    }
}

/// Makes steps of a record ones of a trace.
struct Steps<'a> {
    scene: &'a Scene,
    /// The vertices so far: point, normal (zero in a medium), and direction back along the path.
    vertices: Vec<[Vec3; 3]>,
    /// The number of rays so far.
    rays: usize,
}

impl Steps<'_> {
    fn all(mut self, steps: &[Step], colors: impl Fn(&SampledSpectrum) -> [f32; 3]) -> Vec<TraceStep> {
        steps.iter().map(|step| self.step(step, &colors)).collect()
    }

    fn point(&self, p: Vec3) -> Vec3 {
        self.scene.world_from_render().transform_point3(p.as_dvec3()).as_vec3().into()
    }

    fn step(&mut self, step: &Step, colors: &impl Fn(&SampledSpectrum) -> [f32; 3]) -> TraceStep {
        match step {
            Step::Ray { ray, hit } => {
                let (way, vertex) = self.origin(ray.o, ray.d);
                self.rays += 1;
                let (from, d, length) = self.line(ray.o, ray.d);
                let hit = hit.as_ref().map(|(t, object)| (t * length, object.clone()));
                TraceStep::Ray { way, vertex, from, d, hit }
            }
            Step::Surface { p, n, wo, material, lobes } => {
                self.vertices.push([*p, *n, *wo]);
                let material = self.scene.names().material(*material).to_owned();
                TraceStep::Surface { p: self.point(*p), material, lobes: kinds(*lobes) }
            }
            Step::Medium { p } => {
                self.vertices.push([*p, Vec3::ZERO, Vec3::ZERO]);
                TraceStep::Medium { p: self.point(*p) }
            }
            Step::Shadow { ray, t_max, is_clear } => {
                let (from, d, length) = self.line(ray.o, ray.d);
                TraceStep::Shadow { from, d, length: length * t_max, is_clear: *is_clear }
            }
            Step::Light { light, events, l } => {
                let name = light.map_or("a medium".into(), |light| self.light(light));
                TraceStep::Light { name, events: *events, rgb: colors(l) }
            }
        }
    }

    /// How a ray along `d` leaves `o`, and the number of its vertex. Algorithms that split paths go
    /// on from earlier ones.
    fn origin(&self, o: Vec3, d: Vec3) -> (Way, usize) {
        // Rays begin a little off the surface.
        let is_at = |[p, ..]: &[Vec3; 3]| (o - *p).length() <= 1e-4 * (1.0 + p.length());
        match self.vertices.iter().rposition(is_at) {
            None if self.rays == 0 => (Way::Camera, 0),
            None => (Way::Onward, 0),
            Some(index) => {
                let [_, n, wo] = self.vertices[index];
                let sides = n.dot(d) * n.dot(wo);
                let way = match sides > 0.0 {
                    _ if n == Vec3::ZERO => Way::Scattered,
                    true => Way::Reflected,
                    false => Way::Transmitted,
                };
                (way, index + 1)
            }
        }
    }

    /// A point and a direction of unit length in world space, and the length of the direction
    /// there.
    fn line(&self, o: Vec3, d: Vec3) -> (Vec3, Vec3, f32) {
        let along: Vec3 = self.scene.world_from_render().transform_vector3(d.as_dvec3()).as_vec3().into();
        (self.point(o), along.normalize_or_zero(), along.length())
    }

    fn light(&self, id: LightId) -> String {
        let light = self.scene.light(id);
        let kind = if light.is_infinite() { "the surroundings" } else { "a light" };
        format!("{kind} (number {} of {})", id.0, self.scene.lights().len())
    }
}

/// Kinds of scattering in words.
fn kinds(lobes: BxdfFlags) -> String {
    let widths =
        [(BxdfFlags::DIFFUSE, "diffuse"), (BxdfFlags::GLOSSY, "glossy"), (BxdfFlags::SPECULAR, "specular")];
    let sides = [(BxdfFlags::REFLECTION, "reflection"), (BxdfFlags::TRANSMISSION, "transmission")];
    let named = |names: &[(BxdfFlags, &str)]| {
        let present = names.iter().filter(|(flag, _)| lobes.contains(*flag)).map(|(_, name)| *name);
        present.collect::<Vec<_>>().join(" and ")
    };
    format!("{} {}", named(&widths), named(&sides))
}
