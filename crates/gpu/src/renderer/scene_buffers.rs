//! A scene on a device.

use std::sync::Arc;

use super::Kernels;
use crate::device::{Binding, Buffer, Device, GpuError, Kernel, Task, Workgroups};
use crate::flatten::Flat;
use crate::trees::Trees;

/// The buffers of a scene, beside which kernels have two of their own.
pub(crate) struct SceneBuffers {
    kernels: Arc<Kernels>,
    pub trees: Trees,
    pub head: Buffer,
    pub triangles: Buffer,
    pub items: Buffer,
    pub tables: Buffer,
    texels: Buffer,
}

impl SceneBuffers {
    /// Takes a scene to the device, with its tables.
    pub fn new(kernels: Arc<Kernels>, flat: &Flat, tables: &[u32]) -> Result<Self, GpuError> {
        let device = kernels.device();
        let triangles = device.buffer("triangles of the scene", &flat.bvh.triangles)?;
        Ok(Self {
            trees: Trees::new(device, &flat.bvh, &triangles)?,
            head: device.buffer("heads of the scene", &[flat.head])?,
            triangles,
            items: device.buffer("shapes and instances of the scene", &flat.bvh.items)?,
            tables: device.buffer("tables of the scene", tables)?,
            texels: device.buffer("texels of the scene", &flat.texels)?,
            kernels,
        })
    }

    /// All of them and two others, in the order of bindings.
    pub fn with<'a>(&'a self, own: [&'a Buffer; 2]) -> [&'a dyn Binding; 8] {
        let Self { kernels: _, trees, head, triangles, items, tables, texels } = self;
        let [batch, results] = own;
        [head, trees, triangles, items, tables, batch, results, texels]
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
    pub fn task<'a>(&self, kernel: &'a Kernel, own: [&Buffer; 2], workgroups: Workgroups<'a>) -> Task<'a> {
        self.device().task(kernel, &self.with(own), workgroups)
    }
}
