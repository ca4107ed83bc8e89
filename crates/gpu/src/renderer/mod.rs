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

use film::{Film, FilmTile, Splatter, TILE_SIZE};
use lanes::InstructionSet;
use math::{Bounds2i, Vec2};
use rayon::prelude::*;
use scene::View;
use spectrum::SampledSpectrum;

use crate::algorithm::Algorithm;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::flatten::Flat;
use crate::records::pixels::{Batch, PixelSample, Splat};
use crate::shaders::{self, Parts};
use chains::Chains;
pub use kernels::Kernels;
use photons::{PhotonGrid, Photons};
use scene_buffers::SceneBuffers;
pub use strip::FindFirstHit;
use strip::{AddToTile, Started};
use wavefront::Wavefront;

/// The most pixels of a strip: enough to keep a GPU busy, and by a GPU in software fewer, so that
/// it can be cancelled soon. The most splats of its light paths. A row of tiles may have more.
const MAX_PIXELS: usize = 1 << 20;
const MAX_PIXELS_OF_SOFTWARE: usize = 1 << 18;
const MAX_SPLATS: usize = 1 << 20;

/// The splats that a thread adds at a time.
const SPLATS_OF_A_THREAD: usize = 1 << 12;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// How the work of `path` is cut into kernels. Other algorithms, and `vol-path` in media, have
/// a megakernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Schedule {
    /// A thread follows a whole path.
    #[default]
    Megakernel,
    /// Paths go through each stage together, and new ones take the places of those that end.
    Wavefront,
}

/// What makes the samples of a strip.
enum Maker {
    Megakernel(Arc<Kernel>),
    Wavefront(Wavefront),
}

/// A scene on a device, ready to be rendered.
pub struct Renderer {
    scene: SceneBuffers,
    maker: Maker,
    /// What the kernel is to render, and what it finds, of a strip.
    batch: Buffer,
    samples: Buffer,
    /// The most splats of a light path, and of a strip.
    splats: Option<u32>,
    most: usize,
    chains: Option<Chains>,
    photons: Option<Photons>,
    bytes: usize,
}

impl Renderer {
    /// Takes a scene to the device, for pictures of the pixels of `film`.
    pub fn new(
        kernels: Arc<Kernels>,
        flat: &Flat,
        algorithm: &Algorithm,
        film: &Film,
        schedule: Schedule,
    ) -> Result<Self, GpuError> {
        let scene = SceneBuffers::new(kernels.clone(), flat)?;
        let pixels = film.pixel_bounds().area();
        let (mut splats, mut chains, mut photons) = (None, None, None);
        match algorithm {
            Algorithm::RayCasting
            | Algorithm::Whitted(_)
            | Algorithm::AmbientOcclusion(..)
            | Algorithm::Path(_)
            | Algorithm::VolPath(_)
            | Algorithm::SimpleVolPath(_)
            | Algorithm::SimplePath(_)
            | Algorithm::RandomWalk(_) => {}
            Algorithm::LightTracing(desc) => splats = Some(desc.max_depth),
            Algorithm::Bdpt(desc) => splats = Some(desc.max_depth),
            Algorithm::Mlt(desc, seed) if desc.max_depth > 0 => {
                chains = Some(Chains::new(&kernels, &scene, flat, (*desc, *seed), pixels)?);
            }
            Algorithm::Mlt(..) => {}
            Algorithm::Sppm(desc, seed) => {
                photons = Some(Photons::new(&scene, (desc, *seed), pixels, flat.radius)?);
            }
        }
        let most_pixels = most_pixels(scene.device());
        let areas: Vec<usize> =
            strips(film.pixel_bounds(), splats, most_pixels).map(|strip| strip.area()).collect();
        let count = areas.iter().copied().max().unwrap_or(0);
        let is_path = matches!(algorithm, Algorithm::Path(_) | Algorithm::VolPath(_));
        // Its stages do not have what few scenes have.
        let Parts { media, subsurface, lenses, .. } = flat.parts;
        let maker = if schedule == Schedule::Wavefront && is_path && !(media || subsurface || lenses) {
            // A small picture has several samples of each pixel together.
            let samples = if areas.len() == 1 { (most_pixels / count.max(1)).max(1) } else { 1 };
            let size = wavefront::Size { pixels: count, samples: samples as u32 };
            Maker::Wavefront(Wavefront::new(&kernels, flat, size)?)
        } else {
            Maker::Megakernel(kernels.get("pixels", shaders::pixels(algorithm, flat.parts))?)
        };
        let most = count.saturating_mul(splats.unwrap_or(0) as usize);
        let batch_bytes = size_of::<Splat>().saturating_mul(most.max(1)).saturating_add(size_of::<Batch>());
        let device = scene.device();
        let batch = device.zeros("splats of a strip", batch_bytes as u64)?;
        let samples = device.zeros("samples of a strip", (count.max(1) * size_of::<PixelSample>()) as u64)?;
        let of_paths = match &maker {
            Maker::Megakernel(_) => 0,
            Maker::Wavefront(wavefront) => wavefront.bytes(),
        };
        let own =
            chains.as_ref().map_or(of_paths, Chains::bytes) + photons.as_ref().map_or(0, Photons::bytes);
        let bytes = flat.bytes() + count * size_of::<PixelSample>() + batch_bytes + own;
        Ok(Self { scene, maker, batch, samples, splats, most, chains, photons, bytes })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
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
        let lanes = InstructionSet::detect();
        let bounds = film.pixel_bounds();
        let opened = if self.splats.is_none() && self.chains.is_none() {
            film.tiles_mut().map(|tiles| (tiles, None))
        } else {
            film.tiles_and_splatter().map(|(tiles, splatter)| (tiles, Some(splatter)))
        };
        let (mut tiles, splatter) = opened.map_err(|error| PassError::OutOfMemory(error.to_string()))?;
        let mut rays = 0;
        let mut grid = None;
        if let (Some(photons), Maker::Megakernel(kernel)) = (&self.photons, &self.maker) {
            let Self { scene, samples, .. } = self;
            grid = photons.shoot(index, scene, kernel, samples, view, &is_cancelled)?;
            let Some(grid) = &grid else { return Ok(None) };
            rays += grid.rays;
        }
        let mut add = |strip: Bounds2i, samples: &[PixelSample]| {
            if let (Some(_), Some(splatter)) = (self.splats, &splatter) {
                self.add_splats(&strip, samples, view, splatter)?;
            }
            rays += samples.iter().map(|sample| u64::from(sample.rays)).sum::<u64>();
            let is_in_strip = |tile: &FilmTile| tile.bounds().min[1] < strip.max[1];
            let count = tiles.iter().take_while(|tile| is_in_strip(tile)).count();
            let rest = tiles.split_off(count);
            let lambda = grid.as_ref().map(|grid| &grid.shutter.lambda);
            std::mem::replace(&mut tiles, rest).into_par_iter().for_each(|mut tile| {
                let tile = &mut tile;
                lanes.dispatch_large(AddToTile { view, strip, samples, lambda, first_hit, tile });
            });
            Ok::<_, GpuError>(())
        };
        let mut finish = |Started { strip, samples }: Started| {
            self.device().contents(&samples, |bytes| add(strip, bytemuck::cast_slice(bytes)))?
        };
        let mut before = None;
        for strip in strips(bounds, self.splats, most_pixels(self.device())) {
            if is_cancelled() {
                return Ok(None);
            }
            let started = self.start(index, strip, grid.as_ref())?;
            // While the device makes a strip, the one before is added, unless it has splats, which
            // the device would write over.
            let done = if self.splats.is_some() { Some(started) } else { before.replace(started) };
            done.map_or(Ok(()), &mut finish)?;
        }
        before.map_or(Ok(()), finish)?;
        if let (Some(chains), Some(splatter)) = (&self.chains, &splatter) {
            let Some(more) = chains.run(index, &self.scene, view, splatter, &is_cancelled)? else {
                return Ok(None);
            };
            rays += more;
        }
        Ok(Some(rays))
    }

    /// Starts the samples of a strip, row by row; `grid` has the photons of the pass, if there are
    /// any.
    fn start(&self, index: u32, strip: Bounds2i, grid: Option<&PhotonGrid>) -> Result<Started, GpuError> {
        let Self { scene, maker, batch, samples, .. } = self;
        let kernel = match maker {
            Maker::Megakernel(kernel) => kernel,
            Maker::Wavefront(wavefront) => {
                return Ok(Started { strip, samples: wavefront.run(index, &strip, scene)? });
            }
        };
        if let Some(grid) = grid {
            grid.gather(scene, kernel, samples, &strip)?;
        } else {
            let size = [strip.width() as u32, strip.height() as u32];
            let low = strip.min.map(|x| x as u32);
            let head = Batch { low, size, index, most: self.most as u32, ..Batch::default() };
            self.device().write(batch, &[head])?;
            scene.run(kernel, [batch, samples], workgroups(size))?;
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

/// The pixels in strips of whole tiles, given the most splats of a light path and the most pixels
/// of a strip.
fn strips(bounds: Bounds2i, splats: Option<u32>, pixels: usize) -> impl Iterator<Item = Bounds2i> {
    let row_of_tiles = bounds.width() as usize * TILE_SIZE as usize;
    let most = pixels.min(MAX_SPLATS / splats.unwrap_or(1).max(1) as usize);
    let height = TILE_SIZE * (most / row_of_tiles).max(1) as i32;
    (bounds.min[1]..bounds.max[1])
        .step_by(height as usize)
        .map(move |y| Bounds2i::new([bounds.min[0], y], [bounds.max[0], (y + height).min(bounds.max[1])]))
}

/// The workgroups for a rectangle.
fn workgroups(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(WORKGROUP))
}
