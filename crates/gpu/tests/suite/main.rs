//! Laws and kernels on a GPU beside their twins on the CPU.
//!
//! Tests that need a GPU, or a driver that is one in software, end early and say so where there is
//! none; with `ALHAZEN_GPU=require` in the environment they fail instead.

mod bodies;
mod chains;
mod dynamic;
mod faults;
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
mod realtime;
mod reservoirs;
mod texts;
mod textures;
mod trace;
mod twins;
mod validation;
mod wavefront;

use std::io::Write;

use alhazen_gpu::Device;

/// The GPU of a test, by a part of its name in `ALHAZEN_GPU` or the first one; `None` where the
/// test cannot run.
pub fn device() -> Option<Device> {
    let wish = std::env::var("ALHAZEN_GPU").unwrap_or_default();
    let required = wish == "require";
    match Device::open(if required { "" } else { &wish }) {
        Ok(device) => Some(device),
        Err(error) if required => panic!("{error}"),
        Err(error) => {
            // Not by a macro, whose output the harness keeps to itself.
            let _ = writeln!(std::io::stderr(), "SKIPPED, not tested: {error}");
            None
        }
    }
}
