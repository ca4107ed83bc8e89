//! The GPU: which one, its buffers, and kernels that it runs.
//!
//! Nothing here panics for what a machine or a driver does: faults that drivers report at any time
//! are kept, and the next call returns them.

use std::borrow::Cow;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use wgpu::util::DeviceExt;
use wgpu::{
    BindingResource, BufferUsages, DeviceType, ExperimentalFeatures, Features, InstanceFlags, Limits,
};

use crate::bvh::MAX_FOR_RAY_QUERIES;
use crate::pruning::{bindings, parsed};

/// What buffers are used for.
const USAGE: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_SRC).union(BufferUsages::COPY_DST);

/// Why the GPU cannot do what was asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GpuError {
    /// No adapter can be used; the names of those that were found.
    NoDevice(Vec<String>),
    /// The driver gives no device.
    Refused(String),
    /// The device is gone: reset, unplugged or crashed. Open another.
    Lost(String),
    /// The device has too little memory.
    OutOfMemory(String),
    /// A buffer is larger than the device can bind: its name, bytes, and the limit.
    TooLarge(&'static str, u64, u64),
    /// The driver takes a call or a shader for invalid, which is a fault of this crate.
    Invalid(String),
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NoDevice(found) if found.is_empty() => {
                f.write_str("no GPU: Vulkan is not installed, or has no driver")
            }
            Self::NoDevice(found) => write!(f, "no such GPU; there are: {}", found.join(", ")),
            Self::Refused(reason) => write!(f, "the GPU cannot be opened: {reason}"),
            Self::Lost(reason) => write!(f, "the GPU is lost: {reason}"),
            Self::OutOfMemory(reason) => write!(f, "the GPU is out of memory: {reason}"),
            Self::TooLarge(name, bytes, limit) => {
                write!(f, "the {name} take {bytes} bytes, and the GPU can bind {limit} bytes")
            }
            Self::Invalid(reason) => write!(f, "the GPU's driver refuses a call: {reason}"),
        }
    }
}

impl std::error::Error for GpuError {}

/// A GPU that is open.
#[derive(Debug)]
pub struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    name: String,
    is_software: bool,
    has_ray_queries: bool,
    /// The first fault that the driver has reported.
    fault: Arc<Mutex<Option<GpuError>>>,
}

/// A compute shader that is compiled. Its bindings are buffers of group 0, numbered from 0.
#[derive(Debug)]
pub struct Kernel {
    pub(crate) pipeline: wgpu::ComputePipeline,
    /// The bindings that it uses.
    bindings: Vec<u32>,
}

/// Memory of the GPU.
#[derive(Debug)]
pub struct Buffer(pub(crate) wgpu::Buffer);

/// A kernel with its buffers, and how many workgroups it is run in.
pub(crate) struct Task<'a> {
    kernel: &'a Kernel,
    bindings: wgpu::BindGroup,
    workgroups: Workgroups<'a>,
}

/// A number of workgroups.
pub(crate) enum Workgroups<'a> {
    /// This one.
    Of([u32; 3]),
    /// That at a byte of a buffer, which a kernel has written.
    At(&'a Buffer, u64),
}

/// What kernels are run on.
pub trait Binding {
    /// For the library.
    #[doc(hidden)]
    fn resource(&self) -> BindingResource<'_>;
}

impl Binding for Buffer {
    fn resource(&self) -> BindingResource<'_> {
        self.0.as_entire_binding()
    }
}

/// A copy that the host can read when a submission is done.
pub(crate) struct Copied {
    pub copy: wgpu::Buffer,
    pub done: wgpu::SubmissionIndex,
}

impl Device {
    /// Opens the GPU whose name contains `name`, without regard to case; the fastest kind there is
    /// if that is empty. A software renderer is the last choice.
    pub fn open(name: &str) -> Result<Self, GpuError> {
        Self::with(name, Features::empty())
    }

    /// The same, for rays by the ray queries of its hardware, if that has any.
    pub fn for_ray_queries(name: &str) -> Result<Self, GpuError> {
        Self::with(name, Features::EXPERIMENTAL_RAY_QUERY)
    }

    /// The same with these features, if it has them.
    fn with(name: &str, features: Features) -> Result<Self, GpuError> {
        // Without the names and the places of the source in what drivers get, which take longer to
        // find than all else of a shader's translation.
        let flags = InstanceFlags::default().difference(InstanceFlags::DEBUG);
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor { flags, ..descriptor });
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
        adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
            DeviceType::DiscreteGpu => 0,
            DeviceType::IntegratedGpu => 1,
            DeviceType::VirtualGpu => 2,
            DeviceType::Other => 3,
            DeviceType::Cpu => 4,
        });
        let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        let is_it = |known: &String| known.to_lowercase().contains(&name.to_lowercase());
        let Some(index) = names.iter().position(is_it) else { return Err(GpuError::NoDevice(names)) };
        let (adapter, name) = (&adapters[index], names[index].clone());
        let features = features & adapter.features();
        let has_ray_queries = features.contains(Features::EXPERIMENTAL_RAY_QUERY);
        // The limits of WebGPU, so that what runs on one GPU runs on all, but for sizes.
        let limits = adapter.limits();
        let own = Limits {
            max_buffer_size: limits.max_buffer_size,
            max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
            ..Limits::default()
        };
        let most = MAX_FOR_RAY_QUERIES as u32;
        let required_limits = if has_ray_queries {
            Limits {
                max_blas_primitive_count: most,
                max_tlas_instance_count: most,
                max_blas_geometry_count: 1,
                ..own.using_minimum_supported_acceleration_structure_values()
            }
        } else {
            own
        };
        let experimental_features = if has_ray_queries { experimental() } else { Default::default() };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("alhazen"),
            required_features: adapter.features() & Features::TIMESTAMP_QUERY | features,
            required_limits,
            experimental_features,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| GpuError::Refused(format!("{name}: {error}")))?;
        let fault = Arc::new(Mutex::new(None));
        let keep = |fault: &Arc<Mutex<Option<GpuError>>>| {
            let fault = fault.clone();
            move |error| {
                if let Ok(mut fault) = fault.lock() {
                    fault.get_or_insert(error);
                }
            }
        };
        let (keep_error, keep_loss) = (keep(&fault), keep(&fault));
        device.on_uncaptured_error(Arc::new(move |error| {
            keep_error(match error {
                wgpu::Error::OutOfMemory { source } => GpuError::OutOfMemory(source.to_string()),
                error => GpuError::Invalid(error.to_string()),
            });
        }));
        device.set_device_lost_callback(move |_, reason| keep_loss(GpuError::Lost(reason)));
        let is_software = adapter.get_info().device_type == DeviceType::Cpu;
        Ok(Self { device, queue, name, is_software, has_ray_queries, fault })
    }

    /// The GPU's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it is a program that runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// Whether it was opened for rays by ray queries, and has them.
    pub fn has_ray_queries(&self) -> bool {
        self.has_ray_queries
    }

    /// The most bytes of a buffer.
    pub fn largest_buffer(&self) -> u64 {
        self.device.limits().max_storage_buffer_binding_size
    }

    /// A buffer with these contents, which kernels may read and write. The name is a plural, for
    /// messages.
    pub fn buffer<T: bytemuck::NoUninit>(
        &self,
        name: &'static str,
        contents: &[T],
    ) -> Result<Buffer, GpuError> {
        // Bindings are not empty.
        let bytes: &[u8] = if contents.is_empty() { &[0; 16] } else { bytemuck::cast_slice(contents) };
        self.fits(name, bytes.len() as u64)?;
        let usage = if self.has_ray_queries { USAGE | BufferUsages::BLAS_INPUT } else { USAGE };
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some(name), contents: bytes, usage };
        let buffer = self.device.create_buffer_init(&descriptor);
        self.checked(Buffer(buffer))
    }

    /// A buffer of zeros, of this many bytes, a multiple of four.
    pub fn zeros(&self, name: &'static str, bytes: u64) -> Result<Buffer, GpuError> {
        self.fits(name, bytes)?;
        self.checked(Buffer(self.empty(name, bytes, USAGE)))
    }

    /// A buffer of numbers of workgroups, which kernels write for others.
    pub(crate) fn workgroups(&self, bytes: u64) -> Result<Buffer, GpuError> {
        self.checked(Buffer(self.empty("workgroups", bytes, USAGE | BufferUsages::INDIRECT)))
    }

    /// A buffer of parameters, which kernels may only read.
    pub fn parameters<T: bytemuck::NoUninit>(&self, contents: &T) -> Result<Buffer, GpuError> {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let contents = bytemuck::bytes_of(contents);
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some("parameters"), contents, usage };
        self.checked(Buffer(self.device.create_buffer_init(&descriptor)))
    }

    /// A buffer for this usage.
    pub(crate) fn empty(&self, name: &'static str, size: u64, usage: BufferUsages) -> wgpu::Buffer {
        let descriptor = wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        self.device.create_buffer(&descriptor)
    }

    fn fits(&self, name: &'static str, size: u64) -> Result<(), GpuError> {
        let limit = self.largest_buffer();
        if size > limit { Err(GpuError::TooLarge(name, size, limit)) } else { Ok(()) }
    }

    /// Replaces the contents of a buffer from its start, before what is started later.
    pub fn write<T: bytemuck::NoUninit>(&self, buffer: &Buffer, contents: &[T]) -> Result<(), GpuError> {
        self.write_at(buffer, 0, contents)
    }

    /// Replaces the contents of a buffer from a byte on, before what is started later.
    pub fn write_at<T: bytemuck::NoUninit>(
        &self,
        buffer: &Buffer,
        byte: u64,
        contents: &[T],
    ) -> Result<(), GpuError> {
        self.queue.write_buffer(&buffer.0, byte, bytemuck::cast_slice(contents));
        self.checked(())
    }

    /// Compiles the function `main` of a shader.
    pub fn kernel(&self, name: &str, source: &str) -> Result<Kernel, GpuError> {
        let mut kernels = self.kernels(name, source, &["main"])?;
        Ok(kernels.remove(0))
    }

    /// Compiles functions of a shader, as many at once as there are threads.
    pub fn kernels<S: AsRef<str> + Sync>(
        &self,
        name: &str,
        source: &str,
        functions: &[S],
    ) -> Result<Vec<Kernel>, GpuError> {
        let module = parsed(source).map_err(GpuError::Invalid)?;
        let bindings: Vec<Vec<u32>> =
            functions.iter().map(|function| bindings(&module, function.as_ref())).collect();
        let source = wgpu::ShaderSource::Naga(Cow::Owned(module));
        let module =
            self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source });
        let kernels = functions.par_iter().zip(bindings).map(|(function, bindings)| {
            let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(function.as_ref()),
                layout: None,
                module: &module,
                entry_point: Some(function.as_ref()),
                compilation_options: Default::default(),
                cache: None,
            });
            Kernel { pipeline, bindings }
        });
        self.checked(kernels.collect())
    }

    /// Starts a kernel in this many workgroups, after all that was started before. It gets those of
    /// the buffers that it uses; their bindings are their places.
    pub fn run<B: Binding + ?Sized>(
        &self,
        kernel: &Kernel,
        buffers: &[&B],
        workgroups: [u32; 3],
    ) -> Result<(), GpuError> {
        self.run_tasks([&self.task(kernel, buffers, Workgroups::Of(workgroups))])
    }

    /// The same, not yet started.
    pub(crate) fn task<'a, B: Binding + ?Sized>(
        &self,
        kernel: &'a Kernel,
        buffers: &[&B],
        workgroups: Workgroups<'a>,
    ) -> Task<'a> {
        Task { kernel, bindings: self.bindings(kernel, buffers), workgroups }
    }

    /// Starts kernels one after another, after all that was started before.
    pub(crate) fn run_tasks<'a>(
        &self,
        tasks: impl IntoIterator<Item = &'a Task<'a>>,
    ) -> Result<(), GpuError> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        for Task { kernel, bindings, workgroups } in tasks {
            pass.set_pipeline(&kernel.pipeline);
            pass.set_bind_group(0, bindings, &[]);
            match workgroups {
                Workgroups::Of([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
                Workgroups::At(buffer, byte) => pass.dispatch_workgroups_indirect(&buffer.0, *byte),
            }
        }
        drop(pass);
        self.queue.submit([encoder.finish()]);
        self.checked(())
    }

    /// Those of the buffers that a kernel uses.
    pub(crate) fn bindings<B: Binding + ?Sized>(&self, kernel: &Kernel, buffers: &[&B]) -> wgpu::BindGroup {
        let entries = (0..)
            .zip(buffers)
            .filter(|(binding, _)| kernel.bindings.contains(binding))
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.resource() });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &kernel.pipeline.get_bind_group_layout(0),
            entries: &entries.collect::<Vec<_>>(),
        })
    }

    /// The contents of a buffer, when all that was started is done.
    pub fn read<T: bytemuck::Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, GpuError> {
        self.read_part(buffer, 0, buffer.0.size() as usize / size_of::<T>())
    }

    /// So many values of a buffer's contents from a byte on, when all that was started is done.
    pub fn read_part<T: bytemuck::Pod>(
        &self,
        buffer: &Buffer,
        byte: u64,
        count: usize,
    ) -> Result<Vec<T>, GpuError> {
        let size = (count * size_of::<T>()) as u64;
        if size == 0 {
            return Ok(Vec::new());
        }
        self.contents(&self.copy(buffer, byte, size)?, bytemuck::pod_collect_to_vec)
    }

    /// Starts a copy of so many bytes of a buffer from a byte on, more than none, as what was
    /// started before leaves them.
    pub(crate) fn copy(&self, buffer: &Buffer, byte: u64, size: u64) -> Result<Copied, GpuError> {
        let copy = self.empty("copies", size, BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&buffer.0, byte, &copy, 0, size);
        let done = self.queue.submit([encoder.finish()]);
        self.checked(Copied { copy, done })
    }

    /// What is taken from the bytes of a copy, which are aligned to eight, when it is done.
    pub(crate) fn contents<T>(
        &self,
        Copied { copy, done }: &Copied,
        take: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, GpuError> {
        copy.map_async(wgpu::MapMode::Read, .., |_| ());
        let wait = wgpu::PollType::Wait { submission_index: Some(done.clone()), timeout: None };
        let waited = self.device.poll(wait);
        self.checked(())?;
        waited.map_err(|error| GpuError::Lost(error.to_string()))?;
        let mapped = copy.get_mapped_range(..).map_err(|error| GpuError::Lost(error.to_string()))?;
        Ok(take(&mapped))
    }

    /// The device and the queue of the library.
    pub(crate) fn wgpu(&self) -> (&wgpu::Device, &wgpu::Queue) {
        (&self.device, &self.queue)
    }

    /// A result, unless the driver has reported a fault since the last call. A device that is lost
    /// stays so.
    pub(crate) fn checked<T>(&self, result: T) -> Result<T, GpuError> {
        let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        match &*fault {
            None => Ok(result),
            Some(lost @ GpuError::Lost(_)) => Err(lost.clone()),
            Some(_) => fault.take().map_or(Ok(result), Err),
        }
    }
}

/// That ray queries may be asked for.
#[allow(unsafe_code)]
fn experimental() -> ExperimentalFeatures {
    // SAFETY: what is promised is to know that these calls of the library may have faults that are
    // undefined behaviour. They are made only for who chooses ray queries.
    unsafe { ExperimentalFeatures::enabled() }
}
