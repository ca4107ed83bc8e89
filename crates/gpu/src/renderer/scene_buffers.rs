//! A scene on a device.

use std::sync::Arc;

use super::Kernels;
use crate::device::{Binding, Buffer, Device, GpuError, Kernel, Task, Workgroups};
use crate::flatten::Flat;
use crate::trees::Trees;

/// The buffers of a scene, beside which kernels have two of their own.
pub(super) struct SceneBuffers {
    kernels: Arc<Kernels>,
    trees: Trees,
    buffers: [Buffer; 5],
}

impl SceneBuffers {
    /// Takes a scene to the device.
    pub fn new(kernels: Arc<Kernels>, flat: &Flat) -> Result<Self, GpuError> {
        let device = kernels.device();
        let buffers = [
            device.buffer("heads of the scene", &[flat.head])?,
            device.buffer("triangles of the scene", &flat.bvh.triangles)?,
            device.buffer("shapes and instances of the scene", &flat.bvh.items)?,
            device.buffer("tables of the scene", &flat.tables)?,
            device.buffer("texels of the scene", &flat.texels)?,
        ];
        let trees = Trees::new(device, &flat.bvh, &buffers[1])?;
        Ok(Self { kernels, trees, buffers })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        self.kernels.device()
    }

    /// Starts a kernel in this many workgroups, after all that was started before. `batch` says
    /// what it does, `results` are what it makes.
    pub fn run(
        &self,
        kernel: &Kernel,
        [batch, results]: [&Buffer; 2],
        workgroups: [u32; 2],
    ) -> Result<(), GpuError> {
        let [x, y] = workgroups;
        self.device().run_tasks([&self.task(kernel, [batch, results], Workgroups::Of([x, y, 1]))])
    }

    /// The same, not yet started.
    pub fn task<'a>(
        &self,
        kernel: &'a Kernel,
        [batch, results]: [&Buffer; 2],
        workgroups: Workgroups<'a>,
    ) -> Task<'a> {
        let [head, triangles, items, tables, texels] = self.buffers.each_ref();
        let all: [&dyn Binding; 8] = [head, &self.trees, triangles, items, tables, batch, results, texels];
        self.device().task(kernel, &all, workgroups)
    }
}
