//! A preview before the first pass: one sample per pixel in a lower resolution, enlarged to the
//! size of the picture.
//!
//! A sketch is a [`Session`] of its own ([`draft`]): of the same scene and algorithm, with a view
//! and a film that have n times fewer pixels along each side. So it shows what the picture will
//! show, with the noise of one sample in squares of n × n pixels. Work that does not depend on the
//! number of pixels, such as tracing photons, is divided by n²; `whitted` follows no more than five
//! scattering events, and `radiosity` does not subdivide its patches. Film, statistics and
//! integrator of the picture are not touched.

use std::sync::Arc;

use description::{Diagnostic, IntegratorDesc, RadiosityDesc, SceneDesc};
use film::Film;
use image::{Image, Pixels, Window};
use integrators::{Control, Limits, Session, SessionState};
use math::Bounds2i;
use scene::{Scene, View};

use crate::Header;

/// The maximum number of pixels of a sketch.
const MOST_PIXELS: usize = 1 << 16;

/// The plan of a sketch.
pub(crate) struct Sketch {
    /// Pixels of the picture along a side of a pixel of the sketch.
    n: u32,
    /// The description of the picture, without geometry.
    desc: SceneDesc,
}

/// A session of the picture that `desc` describes, on the compiled scene, in pixels `n` times as
/// wide and high, with this number of samples per pixel. Film position x of it is n·x of the
/// picture. The geometry of the description does not count.
pub fn draft(
    scene: &Arc<Scene>,
    mut desc: SceneDesc,
    n: u32,
    samples: u32,
) -> Result<Session, Vec<Diagnostic>> {
    let view = View::compile(&desc, scene.world_from_render())?.view.coarser(n);
    lighten(&mut desc, n, samples);
    let mut film = film::compile(&desc)?.film;
    let integrator = integrators::build(&desc)?.integrator;
    if integrator.splats() {
        film.reserve_splats().map_err(|error| {
            vec![Diagnostic::error("invalid-film", error.to_string(), desc.film.origin.span)]
        })?;
    }
    let view = View { samples_per_pixel: samples, ..view };
    Ok(Session::new(Arc::clone(scene), view, integrator, SessionState::new(film)))
}

impl Sketch {
    /// A sketch of the picture on `film`; `None` if that is as small itself.
    pub fn new(desc: &SceneDesc, film: &Film) -> Option<Self> {
        let bounds = film.pixel_bounds();
        if bounds.area() <= MOST_PIXELS {
            return None;
        }
        let n = (2..i32::MAX).find(|&n| coarse(&bounds, n).area() <= MOST_PIXELS)?;
        Some(Self { n: n as u32, desc: desc.without_geometry() })
    }

    /// Renders the sketch of the picture of `session`; `None` if it was cancelled, or memory is
    /// short.
    pub fn draw(&self, session: &Session, header: &Header, control: &Control) -> Option<Image> {
        let mut sketch = draft(session.scene(), self.desc.clone(), self.n, 1).ok()?;
        sketch.run(0..1, &Limits::default(), control, &mut |_| ()).ok()?;
        let samples = session.integrator().passes();
        let picture = header.picture_of(sketch.state(), samples).ok()?;
        enlarged(&picture, self.n, &session.state().film)
    }
}

/// The pixels, `n` times as wide and high as those within `bounds`, that cover them.
pub(crate) fn coarse(bounds: &Bounds2i, n: i32) -> Bounds2i {
    Bounds2i::new(bounds.min.map(|x| x / n), bounds.max.map(|x| div_ceil(x, n)))
}

fn div_ceil(x: i32, n: i32) -> i32 {
    x / n + i32::from(x % n > 0)
}

/// Reduces film and sampler of a description, and work that does not depend on the number of
/// pixels, and removes other outputs. Pixels as large as those of the picture keep all its work.
fn lighten(desc: &mut SceneDesc, n: u32, samples: u32) {
    let Bounds2i { min, max } = coarse(&film::pixel_bounds(&desc.film), n as i32);
    desc.film.resolution = desc.film.resolution.map(|side| div_ceil(side, n as i32));
    desc.film.crop_window = None;
    desc.film.pixel_bounds = Some([min[0], max[0], min[1], max[1]]);
    desc.set_samples_per_pixel(samples);
    if n == 1 {
        return;
    }
    desc.integrator.remove_extra_outputs();
    let fewer = |count: &mut u32| *count = count.div_ceil(n.saturating_pow(2));
    match &mut desc.integrator.value {
        // At glass, rays double at each event.
        IntegratorDesc::Whitted(desc) => desc.max_depth = desc.max_depth.min(5),
        IntegratorDesc::PhotonMapping(desc) => {
            fewer(&mut desc.photons);
            fewer(&mut desc.caustic_photons);
        }
        IntegratorDesc::Sppm(desc) => desc.photons_per_iteration.iter_mut().for_each(fewer),
        IntegratorDesc::Radiosity(desc) => {
            *desc = RadiosityDesc {
                subdivision: 0,
                max_patches: desc.max_patches.min(1000),
                tolerance: desc.tolerance.max(0.3),
                steps: 1,
                gather: 0,
                ..desc.clone()
            };
        }
        _ => (),
    }
}

/// The picture of `film`'s size in which each pixel of the sketch covers `n` × `n` pixels; `None`
/// if there is no memory for it.
fn enlarged(sketch: &Image, n: u32, film: &Film) -> Option<Image> {
    let bounds = film.pixel_bounds();
    let [width, height] = [bounds.width() as u32, bounds.height() as u32];
    let pixels = match sketch.pixels() {
        Pixels::F16(values) => Pixels::F16(repeated(values, sketch.width(), n, &bounds)?),
        Pixels::F32(values) => Pixels::F32(repeated(values, sketch.width(), n, &bounds)?),
        Pixels::U8(..) => return None,
    };
    let mut picture = Image::new(width, height, sketch.channels().iter().map(String::as_str), pixels).ok()?;
    picture.metadata = sketch.metadata.clone();
    picture.metadata.data_window = Some(Window { min: bounds.min, max: bounds.max });
    picture.metadata.display_window = Some(Window { min: [0, 0], max: film.full_resolution() });
    Some(picture)
}

/// The values of the pixels within `bounds`, of RGB values of pixels `n` times as large.
fn repeated<T: Copy>(values: &[T], width: u32, n: u32, bounds: &Bounds2i) -> Option<Vec<T>> {
    let mut repeated = Vec::new();
    repeated.try_reserve_exact(3 * bounds.area()).ok()?;
    // Which row or column of large pixels a coordinate is in, from that of the first.
    let large = |x: i32, first: i32| (x as u32 / n - first as u32 / n) as usize;
    for y in bounds.min[1]..bounds.max[1] {
        let row = large(y, bounds.min[1]) * width as usize;
        for x in bounds.min[0]..bounds.max[0] {
            let first = 3 * (row + large(x, bounds.min[0]));
            repeated.extend_from_slice(&values[first..first + 3]);
        }
    }
    Some(repeated)
}
