//! Direct light of the first surfaces by reservoirs: samples of lights that pixels and frames share
//! [Bitterli 2020].

use std::sync::Arc;

use super::frame::{Eye, Reuse};
use crate::algorithm::Algorithm;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;
use crate::shaders::{self, Parts};
use crate::tags::{ReuseBit, bit};

/// Bytes of a reservoir: `Reservoir` of `shaders/realtime/reservoirs.wgsl`.
pub const RESERVOIR: u64 = 80;

/// The parts of the buffer: of this frame and of the one before by turns, and of steps between.
pub const PARTS: u64 = 4;
const FIRST: u32 = 2;
const SECOND: u32 = 3;

/// Pixels around that samples are taken from.
const NEIGHBOURS: u32 = 3;

/// How samples that are shared count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// By what all could have chosen them with: the picture is right in the mean.
    Unbiased,
    /// By their number: faster, and too dark where surfaces and shadows differ.
    Biased,
}

/// The kernels, and what is known of the frame before.
pub struct Reservoirs {
    weights: Weights,
    /// Finds all other light.
    pub light: Arc<Kernel>,
    pub candidates: Arc<Kernel>,
    pub reuse: Arc<Kernel>,
    /// What the steps are told: candidates, reuse of the frame before, and of neighbours.
    pub steps: [Buffer; 3],
    half: u32,
    /// The camera of the frame before, if it has samples.
    before: Option<Eye>,
}

impl Reservoirs {
    /// Without samples.
    pub fn new(
        kernels: &Kernels,
        algorithm: &Algorithm,
        parts: Parts,
        weights: Weights,
    ) -> Result<Self, GpuError> {
        let [candidates, reuse] = shaders::reservoirs(parts);
        let (light, (candidates, reuse)) = rayon::join(
            || kernels.get("light", shaders::light(algorithm, parts, true)),
            || rayon::join(|| kernels.get("candidates", candidates), || kernels.get("reuse", reuse)),
        );
        let step = || kernels.device().parameters(&Reuse::default());
        Ok(Self {
            weights,
            light: light?,
            candidates: candidates?,
            reuse: reuse?,
            steps: [step()?, step()?, step()?],
            half: 0,
            before: None,
        })
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.before = None;
    }

    /// Prepares a frame in motion by a camera, whose parameters have `projected` as the camera
    /// before.
    pub fn begin(&mut self, device: &Device, eye: Eye, projected: Eye) -> Result<(), GpuError> {
        let biased = bit(self.weights == Weights::Biased, ReuseBit::IsBiased);
        let before = bit(self.before == Some(projected), ReuseBit::HasBefore);
        let (now, then, flags) = (self.half, 1 - self.half, biased | before);
        let steps = [
            Reuse { source: 0, target_part: FIRST, neighbours: 0, flags },
            Reuse { source: then, target_part: SECOND, neighbours: 0, flags },
            Reuse { source: SECOND, target_part: now, neighbours: NEIGHBOURS, flags },
        ];
        for (buffer, step) in self.steps.iter().zip(steps) {
            device.write(buffer, &[step])?;
        }
        self.half = then;
        self.before = Some(eye);
        Ok(())
    }
}
