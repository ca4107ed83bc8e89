//! Pictures of a scene, sample by sample.
//!
//! A pass renders one sample of each pixel, in strips of the film's tiles, so that the results of a
//! strip need little memory however large the picture is. The CPU adds them to the film, with the
//! wavelengths and weights that it computes from the same random numbers. So it adds the splats of
//! light paths, a list with room for the most that those of a strip have.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use film::{Film, FilmTile, Splatter, TILE_SIZE};
use math::{Bounds2i, Vec2};
use rayon::prelude::*;
use sampling::Sampler;
use scene::View;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::algorithm::Algorithm;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::flatten::Flat;
use crate::shaders;

/// The most pixels of a strip, and the most splats of its light paths, unless a row of tiles has
/// more.
const MAX_PIXELS: usize = 1 << 18;
const MAX_SPLATS: usize = 1 << 20;

/// The splats that a thread adds at a time.
const SPLATS_OF_A_THREAD: usize = 1 << 12;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// The kernels of a device, each compiled when it is first used.
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

/// What the kernel is to render: `Batch` of `shaders/pixels.wgsl` and `shaders/bidirectional.wgsl`,
/// where splats follow.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Batch {
    low: [u32; 2],
    size: [u32; 2],
    index: u32,
    most: u32,
    count: u32,
    unused: u32,
}

/// Light on the film from the light path of a pixel of the batch: `Splat` of
/// `shaders/bidirectional.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Splat {
    film: [f32; 2],
    path: u32,
    unused: u32,
    l: [f32; 4],
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
    /// The most splats of a light path, and of a strip.
    splats: Option<u32>,
    most: usize,
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
        let splats = algorithm.splats();
        let samples = strips(film.pixel_bounds(), splats).map(|strip| strip.area()).max().unwrap_or(0);
        let most = samples.saturating_mul(splats.unwrap_or(0) as usize);
        let batch_bytes = size_of::<Splat>().saturating_mul(most.max(1)).saturating_add(size_of::<Batch>());
        let none = PixelSample { l: [0.0; 4], rays: 0, is_terminated: 0, unused: [0; 2] };
        let buffers = [
            device.buffer("heads of the scene", &[flat.head])?,
            device.buffer("nodes of the scene's trees", &flat.bvh.nodes)?,
            device.buffer("triangles of the scene", &flat.bvh.triangles)?,
            device.buffer("shapes and instances of the scene", &flat.bvh.items)?,
            device.buffer("tables of the scene", &flat.tables)?,
            device.zeros("splats of a strip", batch_bytes as u64)?,
            device.buffer("samples of a strip", &vec![none; samples])?,
            device.buffer("texels of the scene", &flat.texels)?,
        ];
        let bytes = flat.bytes() + samples * size_of::<PixelSample>() + batch_bytes;
        Ok(Self { kernels, kernel, buffers, splats, most, bytes })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Whether light paths add splats to the film.
    pub fn splats(&self) -> bool {
        self.splats.is_some()
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
        let opened = match self.splats {
            None => film.tiles_mut().map(|tiles| (tiles, None)),
            Some(_) => film.tiles_and_splatter().map(|(tiles, splatter)| (tiles, Some(splatter))),
        };
        let (mut tiles, splatter) = opened.map_err(|error| PassError::OutOfMemory(error.to_string()))?;
        let mut rays = 0;
        for strip in strips(bounds, self.splats) {
            if is_cancelled() {
                return Ok(None);
            }
            let samples = self.strip(index, &strip)?;
            if let Some(splatter) = &splatter {
                self.add_splats(index, &strip, view, sampler, splatter)?;
            }
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
        let low = strip.min.map(|x| x as u32);
        let batch = Batch { low, size, index, most: self.most as u32, ..Batch::default() };
        device.write(&self.buffers[5], &[batch])?;
        let [x, y] = size.map(|side| side.div_ceil(WORKGROUP));
        device.run(&self.kernel, &self.buffers.each_ref(), [x, y, 1])?;
        device.read(&self.buffers[6])
    }

    /// Adds the splats of a strip, and counts its light paths.
    fn add_splats(
        &self,
        index: u32,
        strip: &Bounds2i,
        view: &View,
        sampler: &Sampler,
        splatter: &Splatter,
    ) -> Result<(), GpuError> {
        let (device, buffer) = (self.device(), &self.buffers[5]);
        let head: Vec<Batch> = device.read_part(buffer, 0, 1)?;
        let count = head.iter().map(|batch| batch.count as usize).sum::<usize>().min(self.most);
        let splats: Vec<Splat> = device.read_part(buffer, size_of::<Batch>() as u64, count)?;
        splats.par_chunks(SPLATS_OF_A_THREAD).for_each(|splats| {
            let mut sampler = sampler.clone();
            for splat in splats {
                let [x, y] = [splat.path as i32 % strip.width(), splat.path as i32 / strip.width()];
                sampler.start_pixel_sample([strip.min[0] + x, strip.min[1] + y], index, 0);
                let lambda = wavelengths(view, sampler.get_1d(), false);
                splatter.add(Vec2::from_array(splat.film), &SampledSpectrum::new(splat.l), &lambda);
            }
        });
        splatter.add_paths(strip.area() as u64);
        Ok(())
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

/// The pixels in strips of whole tiles, given the most splats of a light path.
fn strips(bounds: Bounds2i, splats: Option<u32>) -> impl Iterator<Item = Bounds2i> {
    let row_of_tiles = bounds.width() as usize * TILE_SIZE as usize;
    let most = MAX_PIXELS.min(MAX_SPLATS / splats.unwrap_or(1).max(1) as usize);
    let height = TILE_SIZE * (most / row_of_tiles).max(1) as i32;
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
