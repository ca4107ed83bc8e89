//! The kernels of a device.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::device::{Device, GpuError, Kernel};

/// The kernels of a device, each compiled when it is first used.
#[derive(Debug)]
pub struct Kernels {
    device: Device,
    /// By their sources. What compiles one holds up those alone that want the same.
    made: Mutex<BTreeMap<String, Slot>>,
}

/// A kernel, once it is compiled.
type Slot = Arc<Mutex<Option<Arc<Kernel>>>>;

impl Kernels {
    /// No kernels yet.
    pub fn new(device: Device) -> Self {
        Self { device, made: Mutex::default() }
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    pub(crate) fn get(&self, name: &str, source: String) -> Result<Arc<Kernel>, GpuError> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = made.entry(source.clone()).or_default().clone();
        drop(made);
        let mut kernel = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kernel) = &*kernel {
            return Ok(kernel.clone());
        }
        Ok(kernel.insert(Arc::new(self.device.kernel(name, &source)?)).clone())
    }
}
