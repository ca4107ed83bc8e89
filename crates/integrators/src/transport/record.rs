//! What happens along the paths of one sample, step by step, for people who want to see it.

use math::{Normal3, Point3, Ray, Vector3};
use scattering::BxdfFlags;
use scene::light::LightId;
use scene::material::MaterialId;
use spectrum::{SampledSpectrum, SampledWavelengths};

/// A step of a sample, in render space.
#[derive(Clone, Debug)]
pub enum Step {
    /// A ray to the nearest surface.
    Ray {
        /// The ray.
        ray: Ray,
        /// The distance of the surface, in lengths of the ray's direction, and the name of its
        /// object; `None` if there is none.
        hit: Option<(f32, String)>,
    },
    /// The surface that the last ray has hit scatters light.
    Surface {
        /// The point.
        p: Point3,
        /// Shading normal.
        n: Normal3,
        /// Unit direction back along the ray.
        wo: Vector3,
        /// Its material.
        material: MaterialId,
        /// How it scatters.
        lobes: BxdfFlags,
    },
    /// A medium scatters light.
    Medium {
        /// The point.
        p: Point3,
    },
    /// A shadow ray.
    Shadow {
        /// The ray.
        ray: Ray,
        /// Its end, in lengths of its direction; may be infinite.
        t_max: f32,
        /// Whether no surface is in its way.
        is_clear: bool,
    },
    /// Light that arrives at the camera.
    Light {
        /// The light; `None` for emission of media.
        light: Option<LightId>,
        /// The number of scattering events on its way.
        events: u32,
        /// Radiance at the camera, weighted as the estimate has it.
        l: SampledSpectrum,
    },
}

/// The steps of a sample.
#[derive(Clone, Debug)]
pub struct Record {
    /// Its wavelengths.
    pub lambda: SampledWavelengths,
    /// Its radiance.
    pub l: SampledSpectrum,
    /// What happened.
    pub steps: Vec<Step>,
}
