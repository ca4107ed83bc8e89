//! Helpers of the tests on data of others: scenes as text, and pictures with their standard errors.

use std::fmt::Write as _;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use alhazen::assets::{AssetSource, Files, read_obj, read_ply};
use alhazen::image::Image;
use alhazen::integrators::Control;
use alhazen::{Overrides, RenderError, render_file};
pub use testkit::data;
use testkit::{Moments, z_test};

/// All files below a folder, in order.
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files.extend(files_below(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}

/// A scene held in memory under [`Text::NAME`]; what it names is read from disk.
struct Text<'a>(&'a str);

impl Text<'_> {
    const NAME: &'static str = "text.pbrt";
}

impl AssetSource for Text<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if path == Path::new(Self::NAME) { Ok(self.0.into()) } else { Files.read(path) }
    }

    fn exists(&self, path: &Path) -> bool {
        path == Path::new(Self::NAME) || Files.exists(path)
    }
}

/// A name under which the assets beside it hold the text of a scene.
pub fn scene_text(text: &str) -> (&'static Path, impl AssetSource + '_) {
    (Path::new(Text::NAME), Text(text))
}

/// The picture of a scene written as text.
pub fn render_text(text: &str, overrides: &Overrides) -> Image {
    shown(render_file(Text::NAME, &Text(text), overrides, &Control::default()))
}

/// The picture of a scene file.
pub fn render_scene(path: &Path, overrides: &Overrides) -> Image {
    shown(render_file(path, &Files, overrides, &Control::default()))
}

fn shown(result: Result<Image, RenderError>) -> Image {
    result.unwrap_or_else(|error| match error {
        RenderError::Scene(imported) => panic!("{:#?}", imported.diagnostics),
        other => panic!("{other:?}"),
    })
}

/// A mesh file, with normals and texture coordinates where it has them, as the text of a shape.
pub fn shape(path: &Path) -> String {
    let bytes = std::fs::read(path).unwrap();
    let is_ply = path.extension().is_some_and(|extension| extension == "ply");
    let mesh = if is_ply { read_ply(&bytes) } else { read_obj(&bytes) }.unwrap();
    let mut text = String::from("Shape \"trianglemesh\" \"point3 P\" [");
    mesh.positions.iter().for_each(|p| write!(text, "{} {} {} ", p.x, p.y, p.z).unwrap());
    if !mesh.normals.is_empty() {
        text += "] \"normal N\" [";
        mesh.normals.iter().for_each(|n| write!(text, "{} {} {} ", n.x, n.y, n.z).unwrap());
    }
    if !mesh.uvs.is_empty() {
        text += "] \"point2 uv\" [";
        mesh.uvs.iter().for_each(|uv| write!(text, "{} {} ", uv.x, uv.y).unwrap());
    }
    text += "] \"integer indices\" [";
    let halves = mesh.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    for [a, b, c] in mesh.triangles.iter().copied().chain(halves) {
        write!(text, "{a} {b} {c} ").unwrap();
    }
    text + "]\n"
}

/// The mean of pictures of one scene with different seeds, and its standard error.
pub struct Estimate {
    width: usize,
    height: usize,
    /// By row, column, channel.
    values: Vec<Moments>,
}

impl Estimate {
    /// Renders a picture for each of `runs` seeds.
    pub fn new(runs: i32, mut render: impl FnMut(Overrides) -> Image) -> Self {
        let mut values = Vec::new();
        let (mut width, mut height) = (0, 0);
        for seed in 0..runs {
            let image = render(Overrides { seed: Some(seed), ..Overrides::default() });
            (width, height) = (image.width() as usize, image.height() as usize);
            values.resize(width * height * 3, Moments::default());
            values.iter_mut().zip(rgb_values(&image)).for_each(|(moments, value)| moments.push(value));
        }
        Self { width, height, values }
    }

    /// The mean of a channel over a part of the picture, and its standard error: pixels are
    /// independent of each other.
    fn mean(&self, [columns, rows]: &[Range<usize>; 2], channel: usize) -> (f64, f64) {
        let pixels = rows.clone().flat_map(|y| columns.clone().map(move |x| y * self.width + x));
        let (mut sum, mut variance, mut count) = (0.0, 0.0_f64, 0);
        for pixel in pixels {
            let value = &self.values[3 * pixel + channel];
            sum += value.mean;
            variance += value.variance_of_mean();
            count += 1;
        }
        (sum / f64::from(count), variance.sqrt() / f64::from(count))
    }

    /// Asserts that the mean of the whole picture is `expected`, which has the relative error
    /// `uncertainty`.
    pub fn assert_mean(&self, expected: [f64; 3], uncertainty: f64, tests: usize, name: &str) {
        for (channel, &expected) in expected.iter().enumerate() {
            let (mean, error) = self.mean(&[0..self.width, 0..self.height], channel);
            let result = z_test(mean, error.hypot(uncertainty * expected), expected, 3 * tests);
            result.unwrap_or_else(|text| panic!("{name}, channel {channel}: {text}"));
        }
    }

    /// Asserts that means over squares of the picture are those of a reference of the same size,
    /// which has the relative error `uncertainty` at most.
    pub fn assert_parts(&self, reference: &Image, side: usize, uncertainty: f64, tests: usize, name: &str) {
        assert_eq!(
            [reference.width() as usize, reference.height() as usize],
            [self.width, self.height],
            "{name}"
        );
        let expected: Vec<f64> = rgb_values(reference).collect();
        let parts = self.width.div_ceil(side) * self.height.div_ceil(side);
        for y in (0..self.height).step_by(side) {
            for x in (0..self.width).step_by(side) {
                let part = [x..(x + side).min(self.width), y..(y + side).min(self.height)];
                for channel in 0..3 {
                    let pixels =
                        part[1].clone().flat_map(|y| part[0].clone().map(move |x| y * self.width + x));
                    let expected: Moments = pixels.map(|pixel| expected[3 * pixel + channel]).collect();
                    let (mean, error) = self.mean(&part, channel);
                    let error = error.hypot(uncertainty * expected.mean);
                    let result = z_test(mean, error, expected.mean, 3 * parts * tests);
                    result.unwrap_or_else(|text| panic!("{name}, part {part:?}, channel {channel}: {text}"));
                }
            }
        }
    }
}

/// Red, green and blue of all pixels by rows.
pub fn rgb_values(image: &Image) -> impl Iterator<Item = f64> + '_ {
    let pixels = (0..image.height()).flat_map(move |y| (0..image.width()).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| image.rgb(x, y)).map(f64::from)
}

/// The mean of each channel.
pub fn means(image: &Image) -> [f64; 3] {
    let mut sums = [0.0; 3];
    rgb_values(image).enumerate().for_each(|(i, value)| sums[i % 3] += value);
    sums.map(|sum| sum / (f64::from(image.width()) * f64::from(image.height())))
}

/// The image with each square of `factor` × `factor` pixels averaged to one.
pub fn shrunk(image: &Image, factor: u32) -> Image {
    Image::from_fn(image.width() / factor, image.height() / factor, ["R", "G", "B"], |x, y| {
        let mut sum = [0.0; 3];
        for i in 0..factor * factor {
            let value = image.rgb(x * factor + i % factor, y * factor + i / factor);
            (0..3).for_each(|channel| sum[channel] += value[channel]);
        }
        sum.map(|sum| sum / (factor * factor) as f32)
    })
}
