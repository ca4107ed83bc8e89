//! Pictures of a scene, sample by sample.
//!
//! A pass renders one sample of each pixel, in strips of the film's tiles, so that the results of a
//! strip need little memory however large the picture is. The CPU adds them to the film while the
//! device makes those of the next strip. So it adds the splats of light paths, a list with room for
//! the most that those of a strip have. It finds the first hits for layers beside the colour, too.
//!
//! Metropolis light transport has [`Chains`] beside, and photon mapping [`Photons`] before.

mod chains;
mod kernels;
mod photons;
mod scene_buffers;
mod strip;
mod wavefront;

use std::sync::Arc;

use description::{BdptDesc, LightTracingDesc, MltDesc, Schedule};
use film::{Film, Splatter, TILE_SIZE};
use math::{Bounds2i, Vec2};
use rayon::prelude::*;
use scene::View;
use spectrum::SampledSpectrum;

use crate::algorithm::Algorithm;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::flatten::Flat;
use crate::records::pixels::{Batch, PixelSample, Splat};
use crate::shaders;
use chains::Chains;
pub use kernels::Kernels;
use photons::{PhotonGrid, Photons};
pub(crate) use scene_buffers::SceneBuffers;
pub use strip::FindFirstHit;
use strip::{Exposure, Started};
use wavefront::Wavefront;
pub use wavefront::lacking_stages;

/// The most pixels of a strip: enough to keep a GPU busy, and by a GPU in software fewer, so that
/// it can be cancelled soon. The most splats of its light paths. A row of tiles may have more.
const MAX_PIXELS: usize = 1 << 20;
const MAX_PIXELS_OF_SOFTWARE: usize = 1 << 18;
const MAX_SPLATS: usize = 1 << 20;

/// The splats that a thread adds at a time.
const SPLATS_OF_A_THREAD: usize = 1 << 12;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// What makes the samples of a strip.
enum Maker {
    Megakernel(Arc<Kernel>),
    Wavefront(Wavefront),
}

/// Paths that begin at lights.
enum LightPaths {
    None,
    /// One for each pixel, which has so many splats at most.
    Splatting(u32),
    /// Paths that chains propose, beside the samples of pixels.
    Chains(Chains),
    /// Light paths whose photons the samples of pixels gather.
    Photons(Photons),
}

/// A scene on a device, ready to be rendered.
pub struct Renderer {
    scene: SceneBuffers,
    maker: Maker,
    light_paths: LightPaths,
    /// What the kernel is to render, and what it finds, of a strip.
    batch: Buffer,
    samples: Buffer,
    /// The most splats of a strip.
    most: usize,
    bytes: usize,
}

impl Renderer {
    /// Takes a scene to the device, for pictures of the pixels of `film`. Where [`lacking_stages`]
    /// gives a reason, it has a megakernel.
    pub fn new(
        kernels: Arc<Kernels>,
        flat: &Flat,
        algorithm: &Algorithm,
        film: &Film,
        schedule: Schedule,
    ) -> Result<Self, GpuError> {
        let scene = SceneBuffers::new(kernels.clone(), flat, &flat.tables)?;
        let kernel = || kernels.get("pixels", shaders::pixels(algorithm, flat.parts));
        let pixels = film.pixel_bounds().area();
        let light_paths = match algorithm {
            Algorithm::RayCasting
            | Algorithm::Whitted(_)
            | Algorithm::AmbientOcclusion(..)
            | Algorithm::Path(_)
            | Algorithm::VolPath(_)
            | Algorithm::SimpleVolPath(_)
            | Algorithm::SimplePath(_)
            | Algorithm::RandomWalk(_) => LightPaths::None,
            Algorithm::LightTracing(LightTracingDesc { max_depth, .. })
            | Algorithm::Bdpt(BdptDesc { max_depth, .. }) => LightPaths::Splatting(*max_depth),
            Algorithm::Mlt(MltDesc { max_depth: 0, .. }, _) => LightPaths::None,
            Algorithm::Mlt(desc, seed) => {
                LightPaths::Chains(Chains::new(&kernels, &scene, flat, *desc, *seed, pixels)?)
            }
            Algorithm::Sppm(desc, seed) => {
                LightPaths::Photons(Photons::new(&scene, kernel()?, desc, *seed, pixels, flat.radius)?)
            }
        };
        let (splats, most_pixels) = (light_paths.splats(), most_pixels(scene.device()));
        let areas: Vec<usize> =
            strips(film.pixel_bounds(), splats, most_pixels).map(|strip| strip.area()).collect();
        let count = areas.iter().copied().max().unwrap_or(0);
        let maker = if schedule == Schedule::Wavefront && lacking_stages(algorithm, flat.parts).is_none() {
            // A small picture has several samples of each pixel together.
            let samples = if areas.len() == 1 { (most_pixels / count.max(1)).max(1) } else { 1 };
            let size = wavefront::Size { pixels: count, samples: samples as u32 };
            Maker::Wavefront(Wavefront::new(&kernels, flat, size)?)
        } else {
            Maker::Megakernel(kernel()?)
        };
        let most = count.saturating_mul(splats as usize);
        let batch_bytes = size_of::<Splat>().saturating_mul(most.max(1)).saturating_add(size_of::<Batch>());
        let samples_bytes = count.max(1) * size_of::<PixelSample>();
        let batch = scene.device().zeros("splats of a strip", batch_bytes as u64)?;
        let samples = scene.device().zeros("samples of a strip", samples_bytes as u64)?;
        let bytes = flat.bytes() + samples_bytes + batch_bytes + maker.bytes() + light_paths.bytes();
        Ok(Self { scene, maker, light_paths, batch, samples, most, bytes })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// The paths of a step of the wavefront, relative to the places for paths, in the mean of the
    /// passes so far; `None` of a megakernel, and before the first pass.
    pub fn occupancy(&self) -> Option<f64> {
        match &self.maker {
            Maker::Megakernel(_) => None,
            Maker::Wavefront(wavefront) => wavefront.occupancy(),
        }
    }

    /// The device that renders.
    pub fn device(&self) -> &Device {
        self.scene.device()
    }

    /// Adds the sample of an index of each pixel to the film, strip by strip, until `is_cancelled`.
    /// The view is the one that was flattened; `first_hit` is asked where the film has layers of
    /// first hits. Returns the number of rays, or `None` if strips are
    /// missing.
    ///
    /// # Errors
    /// Those of the device. The film has all strips that were done before.
    pub fn pass(
        &self,
        index: u32,
        view: &View,
        film: &mut Film,
        first_hit: &FindFirstHit,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<u64>, PassError> {
        let bounds = film.pixel_bounds();
        let opened = match self.light_paths {
            LightPaths::None | LightPaths::Photons(_) => film.tiles_mut().map(|tiles| (tiles, None)),
            LightPaths::Splatting(_) | LightPaths::Chains(_) => {
                film.tiles_and_splatter().map(|(tiles, splatter)| (tiles, Some(splatter)))
            }
        };
        let (tiles, splatter) = opened.map_err(|error| PassError::OutOfMemory(error.to_string()))?;
        let mut grid = None;
        if let LightPaths::Photons(photons) = &self.light_paths {
            grid = photons.shoot(index, &self.scene, &self.samples, view, &is_cancelled)?;
            if grid.is_none() {
                return Ok(None);
            }
        }
        let lambda = grid.as_ref().map(|grid| &grid.shutter.lambda);
        let rays = grid.as_ref().map_or(0, |grid| grid.rays);
        let mut exposure = Exposure { view, lambda, first_hit, tiles, rays };
        let mut before: Option<Started> = None;
        for strip in strips(bounds, self.light_paths.splats(), most_pixels(self.device())) {
            if is_cancelled() {
                return Ok(None);
            }
            let started = self.start(index, strip, grid.as_ref())?;
            if let (LightPaths::Splatting(_), Some(splatter)) = (&self.light_paths, &splatter) {
                // The next strip's splats would be written over these.
                started.finish(self.device(), &mut exposure, |samples| {
                    self.add_splats(&strip, samples, view, splatter)
                })?;
            } else if let Some(before) = before.replace(started) {
                // Meanwhile the device makes the next strip.
                before.finish(self.device(), &mut exposure, |_| Ok(()))?;
            }
        }
        if let Some(last) = before {
            last.finish(self.device(), &mut exposure, |_| Ok(()))?;
        }
        let rays = exposure.rays;
        match (&self.light_paths, &splatter) {
            (LightPaths::Chains(chains), Some(splatter)) => {
                let of_chains = chains.run(index, &self.scene, view, splatter, &is_cancelled)?;
                Ok(of_chains.map(|more| rays + more))
            }
            _ => Ok(Some(rays)),
        }
    }

    /// Starts the samples of a strip, row by row; `grid` has the photons of the pass, if there are
    /// any.
    fn start(&self, index: u32, strip: Bounds2i, grid: Option<&PhotonGrid>) -> Result<Started, GpuError> {
        let Self { scene, maker, batch, samples, .. } = self;
        match (maker, grid) {
            (_, Some(grid)) => grid.gather(scene, samples, &strip)?,
            (Maker::Wavefront(wavefront), None) => {
                return Ok(Started { strip, samples: wavefront.run(index, &strip, scene)? });
            }
            (Maker::Megakernel(kernel), None) => {
                let size = [strip.width() as u32, strip.height() as u32];
                let low = strip.min.map(|x| x as u32);
                let head = Batch { low, size, index, most: self.most as u32, ..Batch::default() };
                self.device().write(batch, &[head])?;
                scene.run(kernel, [batch, samples], workgroups(size))?;
            }
        }
        let bytes = (strip.area() * size_of::<PixelSample>()) as u64;
        Ok(Started { strip, samples: self.device().copy(samples, 0, bytes)? })
    }

    /// Adds the splats of a strip, and counts its light paths.
    fn add_splats(
        &self,
        strip: &Bounds2i,
        samples: &[PixelSample],
        view: &View,
        splatter: &Splatter,
    ) -> Result<(), GpuError> {
        let (device, buffer) = (self.device(), &self.batch);
        let head: Vec<Batch> = device.read_part(buffer, 0, 1)?;
        let count = head.iter().map(|batch| batch.count as usize).sum::<usize>().min(self.most);
        let splats: Vec<Splat> = device.read_part(buffer, size_of::<Batch>() as u64, count)?;
        splats.par_chunks(SPLATS_OF_A_THREAD).for_each(|splats| {
            for splat in splats {
                let Some(sample) = samples.get(splat.path as usize) else { continue };
                let lambda = sample.wavelengths(view);
                splatter.add(Vec2::from_array(splat.film), &SampledSpectrum::new(splat.l), &lambda);
            }
        });
        splatter.add_paths(strip.area() as u64);
        Ok(())
    }
}

impl Maker {
    /// The bytes of what it has of its own.
    fn bytes(&self) -> usize {
        match self {
            Self::Megakernel(_) => 0,
            Self::Wavefront(wavefront) => wavefront.bytes(),
        }
    }
}

impl LightPaths {
    /// The most splats of the path of a pixel.
    fn splats(&self) -> u32 {
        if let Self::Splatting(splats) = self { *splats } else { 0 }
    }

    /// The bytes of what they have of their own.
    fn bytes(&self) -> usize {
        match self {
            Self::None | Self::Splatting(_) => 0,
            Self::Chains(chains) => chains.bytes(),
            Self::Photons(photons) => photons.bytes(),
        }
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

/// The most pixels of a strip on a device.
fn most_pixels(device: &Device) -> usize {
    if device.is_software() { MAX_PIXELS_OF_SOFTWARE } else { MAX_PIXELS }
}

/// The pixels in strips of whole tiles, given the most splats of a pixel's light path and the most
/// pixels of a strip.
fn strips(bounds: Bounds2i, splats: u32, pixels: usize) -> impl Iterator<Item = Bounds2i> {
    let row_of_tiles = bounds.width() as usize * TILE_SIZE as usize;
    let most = pixels.min(MAX_SPLATS / splats.max(1) as usize);
    let height = TILE_SIZE * (most / row_of_tiles).max(1) as i32;
    (bounds.min[1]..bounds.max[1])
        .step_by(height as usize)
        .map(move |y| Bounds2i::new([bounds.min[0], y], [bounds.max[0], (y + height).min(bounds.max[1])]))
}

/// The workgroups for a rectangle.
fn workgroups(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(WORKGROUP))
}
