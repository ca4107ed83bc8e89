//! Cameras: the kind, the upper three rows of the matrix from camera to render space, the screen
//! (top left and pixel; of a sphere its width and height in pixels; behind lenses the sides of a
//! pixel and half those of the film) and the lens (radius and focal distance; behind lenses the
//! greatest distance of a point of the film from the axis); then the factors on differences to rays
//! of neighbouring pixels, of rays that have them and of others, and the smallest of these
//! differences, of origins and of directions; then 1 if it moves, the times at which the shutter
//! opens and closes, the offset of the lenses, and the least and the largest wavelength of a
//! spectral film, or zeros. The matrix of one that moves is that of the first key, and there follow
//! for both keys the time, the translation, the unit quaternion of the rotation, and the rows of
//! the stretch, and the angle between these quaternions.

use description::{Span, SphericalMapping};
use math::MotionKeys;
use scene::View;
use scene::camera::{PlainLens, Projection, Screen, ThinLens, differential_scale};

use super::Flattener;
use crate::Algorithm;
use crate::bvh::angle;

const PERSPECTIVE: u32 = 0;
const ORTHOGRAPHIC: u32 = 1;
const EQUIRECTANGULAR: u32 = 2;
const EQUAL_AREA: u32 = 3;
const REALISTIC: u32 = 4;

impl Flattener<'_> {
    /// The camera of a view; its offset.
    pub fn camera(&mut self, view: &View, algorithm: &Algorithm) -> u32 {
        if algorithm.splats() && matches!(view.camera.projection(), Projection::Spherical(_)) {
            self.refuse("light paths to camera `spherical`", Span::NONE);
        }
        if algorithm.begins_at_lights() && matches!(view.camera.projection(), Projection::Realistic(_)) {
            self.refuse("light paths to camera `realistic`", Span::NONE);
        }
        if algorithm.begins_at_lights() && view.camera.is_moving() {
            self.refuse("light paths to moving cameras", Span::NONE);
        }
        let lenses = self.lenses(view.camera.projection());
        self.slab.add(words(view, lenses))
    }
}

/// The record of a view's camera, given the offset of its lenses.
pub fn words(view: &View, lenses: u32) -> Vec<u32> {
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
        Projection::Realistic(p) => {
            let PlainLens { pixel, half, radius, .. } = p.plain();
            (REALISTIC, [pixel.x, pixel.y, half.x, half.y, radius, 1.0])
        }
    };
    let matrix = motion.start().matrix();
    let mut numbers: Vec<f32> = [0, 1, 2].iter().flat_map(|&row| matrix.row(row).to_array()).collect();
    numbers.extend(film);
    let samples = view.samples_per_pixel;
    let least = if view.options.disable_pixel_jitter { 1 } else { samples };
    numbers.extend([samples, least].map(differential_scale));
    let differences = view.camera.minimum_differentials().differences();
    numbers.extend(differences.as_flattened().iter().flat_map(|v| v.to_array()));
    let keys = motion.keys().map(|keys| interpolated(&keys));
    let moves = keys.is_some().into();
    let bits = |numbers: Vec<f32>| numbers.into_iter().map(f32::to_bits);
    let mut words = vec![kind];
    words.extend(bits(numbers).chain([moves]).chain(bits(view.camera.shutter().to_vec())));
    words.extend([lenses].into_iter().chain(view.wavelengths.unwrap_or_default().map(f32::to_bits)));
    words.extend(bits(keys.unwrap_or_default()));
    words
}

/// The numbers of both keys of a motion, and the angle.
pub(super) fn interpolated(keys: &MotionKeys) -> Vec<f32> {
    let &MotionKeys { times, translations, rotations, stretches } = keys;
    let mut numbers = Vec::new();
    for i in 0..2 {
        numbers.push(times[i]);
        numbers.extend(translations[i].as_vec3().to_array());
        numbers.extend(rotations[i].as_quat().to_array());
        numbers.extend(stretches[i].transpose().as_mat3().to_cols_array());
    }
    numbers.push(angle(keys));
    numbers
}
