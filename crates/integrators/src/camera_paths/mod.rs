//! Algorithms that trace rays from the camera only.

mod ambient_occlusion;
mod medium_vertices;
mod path;
mod pixel_loop;
mod random_walk;
mod ray_casting;
mod simple_path;
mod whitted;

pub use ambient_occlusion::AmbientOcclusion;
pub use path::Path;
pub(crate) use pixel_loop::record;
pub use pixel_loop::{PixelLoop, RayIntegrator};
pub use random_walk::RandomWalk;
pub use ray_casting::RayCasting;
pub use simple_path::SimplePath;
pub(crate) use whitted::Node;
pub use whitted::Whitted;
