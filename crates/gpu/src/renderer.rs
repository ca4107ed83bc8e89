//! Pictures of a scene, sample by sample.
//!
//! A pass renders one sample of each pixel, in strips of the film's tiles, so that the results of a
//! strip need little memory however large the picture is. The CPU adds them to the film, with the
//! wavelengths and weights that it computes from the same random numbers.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use film::{Film, FilmTile, TILE_SIZE};
use math::{Bounds2i, Vec2};
use rayon::prelude::*;
use sampling::Sampler;
use scene::View;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::algorithm::Algorithm;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::flatten::Flat;
use crate::shaders;

/// The most pixels of a strip, unless a row of tiles has more.
const MAX_PIXELS: usize = 1 << 18;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// The kernels of a device, each compiled when it is first used.
pub struct Kernels {
    device: Device,
    made: Mutex<BTreeMap<String, Arc<Kernel>>>,
}

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
        if let Some(kernel) = made.get(&source) {
            return Ok(kernel.clone());
        }
        let kernel = Arc::new(self.device.kernel(name, &source)?);
        made.insert(source, kernel.clone());
        Ok(kernel)
    }
}

/// What the kernel is to render: `Batch` of `shaders/pixels.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::NoUninit)]
struct Batch {
    low: [u32; 2],
    size: [u32; 2],
    index: u32,
    unused: u32,
}

/// What is found for a pixel: `Sample` of `shaders/pixels.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PixelSample {
    l: [f32; 4],
    rays: u32,
    is_terminated: u32,
    unused: [u32; 2],
}

/// A scene on a device, ready to be rendered.
pub struct Renderer {
    kernels: Arc<Kernels>,
    kernel: Arc<Kernel>,
    buffers: [Buffer; 8],
    bytes: usize,
}

impl Renderer {
    /// Takes a scene to the device, for pictures of the pixels of `film`.
    pub fn new(
        kernels: Arc<Kernels>,
        flat: &Flat,
        algorithm: &Algorithm,
        film: &Film,
    ) -> Result<Self, GpuError> {
        let kernel = kernels.get("pixels", shaders::pixels(algorithm, flat.parts))?;
        let device = &kernels.device;
        let batch = Batch { low: [0; 2], size: [0; 2], index: 0, unused: 0 };
        let samples = strips(film.pixel_bounds()).map(|strip| strip.area()).max().unwrap_or(0);
        let none = PixelSample { l: [0.0; 4], rays: 0, is_terminated: 0, unused: [0; 2] };
        let buffers = [
            device.buffer("heads of the scene", &[flat.head])?,
            device.buffer("nodes of the scene's trees", &flat.bvh.nodes)?,
            device.buffer("triangles of the scene", &flat.bvh.triangles)?,
            device.buffer("shapes and instances of the scene", &flat.bvh.items)?,
            device.buffer("tables of the scene", &flat.tables)?,
            device.buffer("batches", &[batch])?,
            device.buffer("samples of a strip", &vec![none; samples])?,
            device.buffer("texels of the scene", &flat.texels)?,
        ];
        let bytes = flat.bytes() + samples * size_of::<PixelSample>();
        Ok(Self { kernels, kernel, buffers, bytes })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// The device that renders.
    pub fn device(&self) -> &Device {
        &self.kernels.device
    }

    /// Adds the sample of an index of each pixel to the film, strip by strip, until `is_cancelled`.
    /// View and sampler are those that were flattened. Returns the number of rays, or `None` if
    /// strips are missing.
    ///
    /// # Errors
    /// Those of the device. The film has all strips that were done before.
    pub fn pass(
        &self,
        index: u32,
        view: &View,
        sampler: &Sampler,
        film: &mut Film,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<u64>, PassError> {
        let filter = film.filter().clone();
        let bounds = film.pixel_bounds();
        let mut tiles = film.tiles_mut().map_err(|error| PassError::OutOfMemory(error.to_string()))?;
        let mut rays = 0;
        for strip in strips(bounds) {
            if is_cancelled() {
                return Ok(None);
            }
            let samples = self.strip(index, &strip)?;
            rays += samples.iter().map(|sample| u64::from(sample.rays)).sum::<u64>();
            let is_in_strip = |tile: &FilmTile| tile.bounds().min[1] < strip.max[1];
            let count = tiles.iter().take_while(|tile| is_in_strip(tile)).count();
            let rest = tiles.split_off(count);
            std::mem::replace(&mut tiles, rest).into_par_iter().for_each(|mut tile| {
                let mut sampler = sampler.clone();
                let Bounds2i { min, max } = tile.bounds();
                for pixel in (min[1]..max[1]).flat_map(|y| (min[0]..max[0]).map(move |x| [x, y])) {
                    let place = (pixel[1] - strip.min[1]) * strip.width() + pixel[0] - strip.min[0];
                    let sample = &samples[place as usize];
                    sampler.start_pixel_sample(pixel, index, 0);
                    let (wavelength, place) = (sampler.get_1d(), sampler.get_pixel_2d());
                    let lambda = wavelengths(view, wavelength, sample.is_terminated == 1);
                    let weight = weight(view, &filter, place);
                    tile.add_sample(pixel, &SampledSpectrum::new(sample.l), &lambda, weight);
                }
            });
        }
        Ok(Some(rays))
    }

    /// The samples of a strip, row by row.
    fn strip(&self, index: u32, strip: &Bounds2i) -> Result<Vec<PixelSample>, GpuError> {
        let device = self.device();
        let size = [strip.width() as u32, strip.height() as u32];
        let batch = Batch { low: strip.min.map(|x| x as u32), size, index, unused: 0 };
        device.write(&self.buffers[5], &[batch])?;
        let [x, y] = size.map(|side| side.div_ceil(WORKGROUP));
        device.run(&self.kernel, &self.buffers.each_ref(), [x, y, 1])?;
        device.read(&self.buffers[6])
    }
}

/// Why a pass is not complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PassError {
    /// The device failed.
    Gpu(GpuError),
    /// The film has no memory for its tiles.
    OutOfMemory(String),
}

impl From<GpuError> for PassError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

/// The pixels in strips of whole tiles.
fn strips(bounds: Bounds2i) -> impl Iterator<Item = Bounds2i> {
    let row_of_tiles = bounds.width() as usize * TILE_SIZE as usize;
    let height = TILE_SIZE * (MAX_PIXELS / row_of_tiles).max(1) as i32;
    (bounds.min[1]..bounds.max[1])
        .step_by(height as usize)
        .map(move |y| Bounds2i::new([bounds.min[0], y], [bounds.max[0], (y + height).min(bounds.max[1])]))
}

fn wavelengths(view: &View, u: f32, is_terminated: bool) -> SampledWavelengths {
    let u = if view.options.disable_wavelength_jitter { 0.5 } else { u };
    let mut lambda = SampledWavelengths::sample_visible(u);
    if is_terminated {
        lambda.terminate_secondary();
    }
    lambda
}

fn weight(view: &View, filter: &film::Filter, place: Vec2) -> f32 {
    if view.options.disable_pixel_jitter { 1.0 } else { filter.sample(place).weight }
}
