//! Kernels that run one after another and then give a buffer back, with the times of their stages:
//! by the GPU's clock if it has one, and else by the host's, which waits after each stage.

use std::time::{Duration, Instant};

use wgpu::{BufferUsages, ComputePassTimestampWrites, PollType, QuerySet, QueryType};

use crate::device::{Binding, Buffer, Device, GpuError, Kernel};

/// The most kernels in a sequence.
const MOST: u32 = 64;

/// The bytes of a time of the GPU.
const TIME: u64 = 8;

/// What is kept from one sequence of kernels to the next.
pub(crate) struct Timer {
    /// The GPU's clock, where it has one, and where its times go.
    clock: Option<(QuerySet, wgpu::Buffer)>,
    /// What is copied to the host: the times, and then a buffer.
    copy: wgpu::Buffer,
}

impl Timer {
    /// For buffers of this many bytes.
    pub fn new(device: &Device, bytes: u64) -> Result<Self, GpuError> {
        let times = u64::from(2 * MOST) * TIME;
        let has_clock = device.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let clock = has_clock.then(|| {
            let descriptor =
                wgpu::QuerySetDescriptor { label: None, ty: QueryType::Timestamp, count: 2 * MOST };
            let resolved = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
            (device.device.create_query_set(&descriptor), device.empty("times", times, resolved))
        });
        let copy = device.empty("copies", times + bytes, BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        device.checked(Self { clock, copy })
    }
}

/// A sequence of kernels.
pub(crate) struct Commands<'a> {
    device: &'a Device,
    timer: &'a Timer,
    encoder: wgpu::CommandEncoder,
    /// The stage of each kernel so far.
    stages: Vec<usize>,
    /// When the host began to wait, and the times of stages by its clock.
    begin: Instant,
    times: Vec<Duration>,
}

impl<'a> Commands<'a> {
    /// No kernel yet, of so many stages.
    pub fn new(device: &'a Device, timer: &'a Timer, stages: usize) -> Self {
        let encoder = device.device.create_command_encoder(&Default::default());
        let times = vec![Duration::ZERO; stages];
        Self { device, timer, encoder, stages: Vec::new(), begin: Instant::now(), times }
    }

    /// Runs a kernel as a part of a stage, after those before.
    pub fn run<B: Binding + ?Sized>(
        &mut self,
        stage: usize,
        kernel: &Kernel,
        buffers: &[&B],
        workgroups: [u32; 2],
    ) {
        if self.timer.clock.is_none() && self.stages.last().is_some_and(|last| *last != stage) {
            self.flush();
        }
        let bindings = self.device.bindings(kernel, buffers);
        let index = 2 * self.stages.len() as u32;
        let clock = self.timer.clock.as_ref().filter(|_| index < 2 * MOST);
        let timestamp_writes = clock.map(|(query_set, _)| ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(index),
            end_of_pass_write_index: Some(index + 1),
        });
        let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
        let mut pass = self.encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(workgroups[0], workgroups[1], 1);
        drop(pass);
        self.stages.push(stage);
    }

    /// Does what was started, and counts the time for the last stage.
    fn flush(&mut self) {
        let next = self.device.device.create_command_encoder(&Default::default());
        self.device.queue.submit([std::mem::replace(&mut self.encoder, next).finish()]);
        // A fault is reported when results are read.
        let _ = self.device.device.poll(PollType::wait_indefinitely());
        if let Some(time) = self.stages.last().and_then(|stage| self.times.get_mut(*stage)) {
            *time += self.begin.elapsed();
        }
        self.begin = Instant::now();
    }

    /// Waits until all is done.
    pub fn finish(mut self) -> Result<(), GpuError> {
        self.flush();
        self.device.checked(())
    }

    /// What is taken from the bytes of a buffer when all is done, and the time of each stage.
    pub fn read<T>(
        mut self,
        buffer: &Buffer,
        take: impl FnOnce(&[u8]) -> T,
    ) -> Result<(T, Vec<Duration>), GpuError> {
        let Self { device, timer, .. } = self;
        if timer.clock.is_none() {
            self.flush();
        }
        let count = (2 * self.stages.len() as u32).min(2 * MOST);
        let (times, size) = (u64::from(2 * MOST) * TIME, buffer.0.size());
        if let Some((queries, resolved)) = timer.clock.as_ref().filter(|_| count > 0) {
            self.encoder.resolve_query_set(queries, 0..count, resolved, 0);
            self.encoder.copy_buffer_to_buffer(resolved, 0, &timer.copy, 0, u64::from(count) * TIME);
        }
        self.encoder.copy_buffer_to_buffer(&buffer.0, 0, &timer.copy, times, size);
        device.queue.submit([self.encoder.finish()]);
        timer.copy.map_async(wgpu::MapMode::Read, ..times + size, |_| ());
        let waited = device.device.poll(PollType::wait_indefinitely());
        device.checked(())?;
        let lost = |error: &dyn std::fmt::Display| GpuError::Lost(error.to_string());
        waited.map_err(|error| lost(&error))?;
        if timer.clock.is_some() {
            let mapped = timer.copy.get_mapped_range(..times).map_err(|error| lost(&error))?;
            let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&mapped);
            let period = f64::from(device.queue.get_timestamp_period()) * 1e-9;
            for (stage, [begin, end]) in self.stages.iter().zip(ticks.as_chunks().0) {
                let time = Duration::from_secs_f64(end.saturating_sub(*begin) as f64 * period);
                self.times[*stage] += time;
            }
        }
        let taken = {
            let mapped = timer.copy.get_mapped_range(times..times + size).map_err(|error| lost(&error))?;
            take(&mapped)
        };
        timer.copy.unmap();
        Ok((taken, self.times))
    }
}
