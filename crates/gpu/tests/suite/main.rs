//! Laws and kernels on a GPU beside their twins on the CPU.
//!
//! Tests that need a GPU, or a driver that is one in software, end early and say so where there is
//! none; with `ALHAZEN_GPU=require` in the environment they fail instead.

mod bodies;
mod chains;
mod direct_light;
mod dynamic;
mod faults;
mod frames;
mod kernels;
mod laws;
mod layers;
mod measured;
mod media;
mod motion;
mod openpbr;
mod photons;
mod pictures;
mod portals;
mod raster;
mod ray_queries;
mod refusals;
mod single_sided;
mod texts;
mod textures;
mod trace;
mod twins;
mod validation;
mod wavefront;

use alhazen_gpu::{Device, GpuError};
use testkit::skip;

/// The GPU of a test, by a part of its name in `ALHAZEN_GPU` or the first one; `None` where the
/// test cannot run.
pub fn device() -> Option<Device> {
    opened(Device::open)
}

/// The same with ray queries, which `ALHAZEN_GPU=require` does not require.
pub fn device_with_ray_queries() -> Option<Device> {
    let device = opened(Device::for_ray_queries)?;
    if !device.has_ray_queries() {
        skip(&format!("{} has no ray queries", device.name()));
    }
    Some(device).filter(Device::has_ray_queries)
}

fn opened(open: impl Fn(&str) -> Result<Device, GpuError>) -> Option<Device> {
    let wish = std::env::var("ALHAZEN_GPU").unwrap_or_default();
    let required = wish == "require";
    match open(if required { "" } else { &wish }) {
        Ok(device) => Some(device),
        Err(error) if required => panic!("{error}"),
        Err(error) => {
            skip(&error.to_string());
            None
        }
    }
}
