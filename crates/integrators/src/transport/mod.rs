//! Common parts of the algorithms: tracing rays, the state of a path, direct lighting, Russian
//! roulette.
//!
//! | file | holds |
//! |---|---|
//! | `tracer` | scene, view, random numbers and statistics of a sample; cancellation |
//! | `pixel_samples` | camera rays of all pixels of a pass |
//! | `first_hit` | the first hit of a camera ray, for the AOVs of the film |
//! | `first_hits` | those of all samples of a pass, for other engines |
//! | `parts` | the first event of a path, for layers of parts of the light |
//! | `path_state` | a path from the camera between two vertices |
//! | `vertex` | vertices from which lights are sampled |
//! | `direct` | next-event estimation and its weights |
//! | `media` | flights through participating media, and their transmittance |
//! | `subsurface` | paths under the surface of bodies |
//! | `single_scattering` | what a medium adds to a ray by one scattering event |
//! | `record` | what happens along the paths of a sample, for people who want to see it |
//! | `roulette` | Russian roulette |
//! | `visibility` | shadow rays |

pub(crate) mod direct;
pub(crate) mod first_hit;
mod first_hits;
pub(crate) mod media;
pub(crate) mod parts;
pub(crate) mod path_state;
pub(crate) mod pixel_samples;
mod record;
pub(crate) mod roulette;
pub(crate) mod sample_counts;
pub(crate) mod single_scattering;
pub(crate) mod subsurface;
pub(crate) mod surroundings;
mod tracer;
pub(crate) mod vertex;
mod visibility;

pub use first_hits::FirstHits;
pub use record::{Record, Step};
pub use tracer::Tracer;
pub(crate) use visibility::ShadowRay;
