//! Cameras:
//!
//! | words | what |
//! |---|---|
//! | 0–2 | the kind, 1 if it moves, the offset of the lenses |
//! | 4–15 | the upper three rows of the matrix from camera to render space; of one that moves, of its first key |
//! | 16–19 | the screen: top left and pixel; of a sphere its width and height in pixels; behind lenses the sides of a pixel and half those of the film |
//! | 20, 21 | the lens: radius and focal distance; behind lenses the greatest distance of a point of the film from the axis |
//! | 22, 23 | the factors on differences to rays of neighbouring pixels, of rays that have them and of others |
//! | 24–27 | the times at which the shutter opens and closes, and the least and the largest wavelength of a spectral film, or zeros |
//! | 28–43 | the smallest of the differences, of origins and of directions, four words each |
//! | 44–83 | the motion of one that moves |
//!
//! A motion has two keys, of five times four words each: translation and time, the unit quaternion
//! of the rotation, and the rows of the stretch, of which the first of the first key has the angle
//! between the quaternions as its fourth word.

use description::{Span, SphericalMapping};
use math::MotionKeys;
use scene::View;
use scene::camera::{PlainLens, Projection, Screen, ThinLens, differential_scale};

use super::Flattener;
use super::slab::padded;
use super::textures::rows;
use crate::Algorithm;
use crate::bvh::angle;
use crate::tags::CameraTag;

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
        Projection::Perspective(p) => (CameraTag::Perspective, flat(p.screen(), p.lens())),
        Projection::Orthographic(p) => (CameraTag::Orthographic, flat(p.screen(), p.lens())),
        Projection::Spherical(p) => {
            let kind = match p.mapping() {
                SphericalMapping::EquiRectangular => CameraTag::EquiRectangular,
                SphericalMapping::EqualArea => CameraTag::EqualArea,
            };
            (kind, [p.resolution().x, p.resolution().y, 1.0, 1.0, 0.0, 1.0])
        }
        Projection::Realistic(p) => {
            let PlainLens { pixel, half, radius, .. } = p.plain();
            (CameraTag::Realistic, [pixel.x, pixel.y, half.x, half.y, radius, 1.0])
        }
    };
    let mut numbers = rows(motion.start());
    numbers.extend(film);
    let samples = view.samples_per_pixel;
    let least = if view.options.disable_pixel_jitter { 1 } else { samples };
    numbers.extend([samples, least].map(differential_scale));
    let differences = view.camera.minimum_differentials().differences();
    numbers.extend(view.camera.shutter());
    numbers.extend(view.wavelengths.unwrap_or_default());
    numbers.extend(padded(differences.as_flattened().iter().map(|v| v.to_array())));
    let keys = motion.keys().map(|keys| interpolated(&keys));
    let moves = keys.is_some().into();
    numbers.extend(keys.unwrap_or_default());
    [kind as u32, moves, lenses, 0].into_iter().chain(numbers.into_iter().map(f32::to_bits)).collect()
}

/// The numbers of a motion.
pub(super) fn interpolated(keys: &MotionKeys) -> Vec<f32> {
    let &MotionKeys { times, translations, rotations, stretches } = keys;
    let key = |i: usize| {
        let fourth = if i == 0 { angle(keys) } else { 0.0 };
        let [x, y, z] = stretches[i].transpose().as_mat3().to_cols_array_2d();
        [
            translations[i].as_vec3().extend(times[i]).to_array(),
            rotations[i].as_quat().to_array(),
            [x[0], x[1], x[2], fourth],
            [y[0], y[1], y[2], 0.0],
            [z[0], z[1], z[2], 0.0],
        ]
    };
    [key(0), key(1)].concat().concat()
}
