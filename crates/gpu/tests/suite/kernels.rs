//! The kernels of whole pictures. Compiling them is what takes the tests' time.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use alhazen_gpu::shaders::{self, Parts};
use alhazen_gpu::{Algorithm, Flat, Kernels};
use description::Schedule;

/// The kernels of whole pictures, which tests share, so that each is compiled once. A driver in
/// software compiles the kernels of a device one after another, so that each has a device.
pub fn kernels(algorithm: &Algorithm, flat: &Flat) -> Option<Arc<Kernels>> {
    static KERNELS: Mutex<BTreeMap<String, Option<Arc<Kernels>>>> = Mutex::new(BTreeMap::new());
    let mut known = KERNELS.lock().unwrap_or_else(PoisonError::into_inner);
    let device = if flat.parts().ray_queries { crate::device_with_ray_queries } else { crate::device };
    let open = || device().map(|device| Arc::new(Kernels::new(device)));
    known.entry(shaders::pixels(algorithm, flat.parts())).or_insert_with(open).clone()
}

/// These parts, and others that many scenes need.
pub fn common(parts: Parts) -> Parts {
    Parts {
        programs: true,
        bumps: true,
        point_lights: true,
        sky_images: true,
        surface_lights: true,
        round_lights: true,
        facets: true,
        single_sided: true,
        ..parts
    }
}

/// The parts of the kernels of a picture: those that its scene needs, and others, so that many
/// scenes share few kernels, and parts are tested beside others.
pub fn shared(algorithm: &Algorithm, schedule: Schedule, needed: Parts) -> Parts {
    let with_textures = |parts| Parts {
        holes: true,
        light_holes: true,
        images: true,
        noise: true,
        media: true,
        ..common(parts)
    };
    let with_motion = |parts| Parts {
        placed_lights: true,
        motion: true,
        coats: true,
        curves: true,
        hair: true,
        ..common(parts)
    };
    let with_bodies = |parts| Parts {
        programs: true,
        images: true,
        point_lights: true,
        facets: true,
        principled: true,
        subsurface: true,
        ..parts
    };
    let suits = |with: &dyn Fn(Parts) -> Parts| with(needed) == with(Parts::default());
    match algorithm {
        Algorithm::SimplePath(_) | Algorithm::RandomWalk(_) => {
            Parts { media: true, subsurface: true, ..common(needed) }
        }
        Algorithm::AmbientOcclusion(..) => Parts { rare_samplers: true, ..common(needed) },
        Algorithm::Path(_) | Algorithm::RayCasting => {
            if suits(&with_textures) && schedule == Schedule::Megakernel {
                with_textures(needed)
            } else if suits(&with_motion) {
                with_motion(needed)
            } else if suits(&with_bodies) {
                with_bodies(needed)
            } else {
                needed
            }
        }
        Algorithm::Bdpt(_) | Algorithm::LightTracing(_) | Algorithm::Sppm(..) => {
            Parts { placed_lights: true, ..common(needed) }
        }
        Algorithm::VolPath(_) | Algorithm::SimpleVolPath(_) => {
            Parts { subsurface: needed.media, ..common(needed) }
        }
        Algorithm::Whitted(_) | Algorithm::Mlt(..) => common(needed),
    }
}
