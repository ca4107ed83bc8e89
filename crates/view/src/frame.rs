//! Pictures as they are shown: the values of one layer, with how they came about.

use std::time::Duration;

use alhazen::film::Layer;
use alhazen::image::{Chromaticities, Image, PixelSource};
use alhazen::integrators::Session;
use alhazen::math::Bounds2i;
use alhazen::scene::View;
use alhazen::spectrum::RgbColorSpace;
use rayon::prelude::*;

/// A picture.
pub struct Frame {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Pixels of the film along a side of one of these.
    pub n: u32,
    /// Column and row of the first pixel, in pixels of its size.
    pub(crate) first: [i32; 2],
    /// The view that it shows, in pixels of its size.
    pub view: View,
    /// Linear colours in `color_space`, or the numbers of `layer`; row by row from the upper left.
    pub pixels: Vec<[f32; 3]>,
    /// What is shown instead of colours.
    pub layer: Option<Layer>,
    /// The space of colours.
    pub color_space: &'static RgbColorSpace,
    /// Samples per pixel so far.
    pub samples: u32,
    /// Samples per pixel of the finished picture.
    pub planned: u32,
    /// How long it took since the one before.
    pub time: Duration,
    /// Rays traced for it.
    pub rays: u64,
    /// The times of its parts, where a GPU has rendered it.
    pub stages: Option<Stages>,
}

/// The times of the parts of a frame by a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stages {
    /// Rays, and what is computed where they hit.
    pub trace: Duration,
    /// From the light of samples to colours.
    pub filter: Duration,
    /// All else: commands, and the way of the picture from the GPU to the host.
    pub rest: Duration,
}

impl Frame {
    /// The picture of a session so far, in pixels `n` times as wide and high as those of the film.
    pub fn of(session: &Session, n: u32, layer: Option<Layer>) -> Self {
        let film = &session.state().film;
        let development = session.state().development();
        let channels = development.channels();
        let index = |name: &str| channels.iter().position(|channel| channel.name == name);
        let names = layer.map_or(&["R", "G", "B"][..], |layer| layer.channels(film.settings().gbuffer));
        // A layer of one number is grey, and one of two has no blue.
        let shown = |i: usize| index(names.get(i).or(names.first().filter(|_| names.len() == 1))?);
        let shown = [0, 1, 2].map(shown);
        let size = [development.width(), development.height()];
        let mut pixels = vec![[0.0; 3]; size[0] as usize * size[1] as usize];
        let rows = pixels.par_chunks_exact_mut(size[0].max(1) as usize).zip(0..size[1]);
        rows.for_each(|(row, y)| {
            let mut values = vec![0.0; row.len() * channels.len()];
            development.row(y, &mut values);
            for (pixel, values) in row.iter_mut().zip(values.chunks_exact(channels.len())) {
                *pixel = shown.map(|channel| channel.map_or(0.0, |channel| values[channel]));
            }
        });
        Self {
            size,
            n,
            first: film.pixel_bounds().min,
            view: session.view().clone(),
            pixels,
            layer,
            color_space: film.color_space(),
            samples: session.state().done.count(),
            planned: session.integrator().passes(),
            time: Duration::ZERO,
            rays: session.progress().stats.rays,
            stages: None,
        }
    }

    /// A finished picture of the pixels in `bounds`.
    #[cfg(feature = "gpu")]
    pub fn of_image(
        image: &Image,
        view: View,
        bounds: Bounds2i,
        color_space: &'static RgbColorSpace,
    ) -> Self {
        let size = [image.width(), image.height()];
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| image.rgb(x, y))).collect();
        let (first, time) = (bounds.min, Duration::ZERO);
        Self {
            size,
            n: 1,
            first,
            view,
            pixels,
            layer: None,
            color_space,
            samples: 1,
            planned: 1,
            time,
            rays: 0,
            stages: None,
        }
    }

    /// It as an image with its colour space.
    pub fn to_image(&self) -> Image {
        let [width, height] = self.size;
        let pixel = |x: u32, y: u32| self.pixels[(y * width + x) as usize];
        let mut image = Image::from_fn(width, height, ["R", "G", "B"], pixel);
        let [red, green, blue] = self.color_space.primaries();
        let white = self.color_space.white();
        image.metadata.chromaticities = Some(Chromaticities { red, green, blue, white });
        image
    }

    /// The part that shows these pixels of the film, as fractions of width and height, from the
    /// upper left to the lower right corner: large pixels may reach beyond them.
    pub fn part(&self, bounds: &Bounds2i) -> [[f32; 2]; 2] {
        [bounds.min, bounds.max].map(|corner| {
            let along = |axis: usize| {
                (corner[axis] as f32 / self.n as f32 - self.first[axis] as f32) / self.size[axis] as f32
            };
            [along(0), along(1)]
        })
    }
}
