//! Cameras: the kind, the upper three rows of the matrix from camera to render space, the screen
//! (top left and pixel; of a sphere its width and height in pixels) and the lens (radius and focal
//! distance); then the factors on differences to rays of neighbouring pixels, of rays that have
//! them and of others, and the smallest of these differences, of origins and of directions; then 1
//! if it moves. The matrix is then that of the first key, and there follow the times at which the
//! shutter opens and closes, for both keys the time, the translation, the unit quaternion of the
//! rotation, and the rows of the stretch, and the angle between these quaternions.

use description::{Span, SphericalMapping};
use math::MotionKeys;
use scene::View;
use scene::camera::{Projection, Screen, ThinLens, differential_scale};

use super::Flattener;
use crate::Algorithm;

const PERSPECTIVE: u32 = 0;
const ORTHOGRAPHIC: u32 = 1;
const EQUIRECTANGULAR: u32 = 2;
const EQUAL_AREA: u32 = 3;

impl Flattener<'_> {
    /// The camera of a view; its offset.
    pub fn camera(&mut self, view: &View, algorithm: &Algorithm) -> u32 {
        if algorithm.splats() && matches!(view.camera.projection(), Projection::Spherical(_)) {
            self.refuse("light paths to camera `spherical`", Span::NONE);
        }
        if algorithm.begins_at_lights() && view.camera.is_moving() {
            self.refuse("light paths to moving cameras", Span::NONE);
        }
        let words = words(view).unwrap_or_else(|what| {
            self.refuse(what, Span::NONE);
            Vec::new()
        });
        self.slab.add(words)
    }
}

/// The record of a view's camera; the error is what kernels do not draw.
pub fn words(view: &View) -> Result<Vec<u32>, &'static str> {
    let motion = view.camera.transform().animated();
    let flat = |screen: &Screen, lens: ThinLens| {
        let &Screen { top_left, per_pixel } = screen;
        [top_left.x, top_left.y, per_pixel.x, per_pixel.y, lens.radius, lens.focal_distance]
    };
    let (kind, film) = match view.camera.projection() {
        Projection::Perspective(p) => (PERSPECTIVE, flat(p.screen(), p.lens())),
        Projection::Orthographic(p) => (ORTHOGRAPHIC, flat(p.screen(), p.lens())),
        Projection::Spherical(p) => {
            let kind = match p.mapping() {
                SphericalMapping::EquiRectangular => EQUIRECTANGULAR,
                SphericalMapping::EqualArea => EQUAL_AREA,
            };
            (kind, [p.resolution().x, p.resolution().y, 1.0, 1.0, 0.0, 1.0])
        }
        Projection::Realistic(_) => return Err("camera `realistic`"),
    };
    let matrix = motion.start().matrix();
    let mut numbers: Vec<f32> = [0, 1, 2].iter().flat_map(|&row| matrix.row(row).to_array()).collect();
    numbers.extend(film);
    let samples = view.samples_per_pixel;
    let least = if view.options.disable_pixel_jitter { 1 } else { samples };
    numbers.extend([samples, least].map(differential_scale));
    let differences = view.camera.minimum_differentials().differences();
    numbers.extend(differences.as_flattened().iter().flat_map(|v| v.to_array()));
    let keys = motion.keys().map(|keys| [&view.camera.shutter()[..], &interpolated(&keys)].concat());
    let (moves, moving) = (keys.is_some().into(), keys.unwrap_or_default());
    let bits = |numbers: Vec<f32>| numbers.into_iter().map(f32::to_bits);
    Ok([kind].into_iter().chain(bits(numbers)).chain([moves]).chain(bits(moving)).collect())
}

/// The numbers of both keys of a motion, and the angle.
fn interpolated(keys: &MotionKeys) -> Vec<f32> {
    let MotionKeys { times, translations, rotations, stretches } = keys;
    let mut numbers = Vec::new();
    for i in 0..2 {
        numbers.push(times[i]);
        numbers.extend(translations[i].as_vec3().to_array());
        numbers.extend(rotations[i].as_quat().to_array());
        numbers.extend(stretches[i].transpose().as_mat3().to_cols_array());
    }
    numbers.push(rotations[0].dot(rotations[1]).clamp(-1.0, 1.0).acos() as f32);
    numbers
}
