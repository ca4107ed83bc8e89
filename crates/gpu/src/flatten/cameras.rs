//! Cameras: the kind, the upper three rows of the matrix from camera to render space, the screen
//! (top left and pixel) and the lens (radius and focal distance); then the factors on differences
//! to rays of neighbouring pixels, of rays that have them and of others, and the smallest of these
//! differences, of origins and of directions.

use description::Span;
use scene::View;
use scene::camera::{Projection, Screen, ThinLens, differential_scale};

use super::Flattener;

const PERSPECTIVE: u32 = 0;
const ORTHOGRAPHIC: u32 = 1;

impl Flattener<'_> {
    /// The camera of a view; its offset.
    pub fn camera(&mut self, view: &View) -> u32 {
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
    if motion.is_moving() {
        return Err("moving cameras");
    }
    let (kind, screen, lens) = match view.camera.projection() {
        Projection::Perspective(p) => (PERSPECTIVE, p.screen(), p.lens()),
        Projection::Orthographic(p) => (ORTHOGRAPHIC, p.screen(), p.lens()),
        Projection::Spherical(_) => return Err("camera `spherical`"),
        Projection::Realistic(_) => return Err("camera `realistic`"),
    };
    let &Screen { top_left, per_pixel } = screen;
    let ThinLens { radius, focal_distance } = lens;
    let matrix = motion.start().matrix();
    let mut numbers: Vec<f32> = [0, 1, 2].iter().flat_map(|&row| matrix.row(row).to_array()).collect();
    numbers.extend([top_left.x, top_left.y, per_pixel.x, per_pixel.y, radius, focal_distance]);
    let samples = view.samples_per_pixel;
    let least = if view.options.disable_pixel_jitter { 1 } else { samples };
    numbers.extend([samples, least].map(differential_scale));
    let differences = view.camera.minimum_differentials().differences();
    numbers.extend(differences.as_flattened().iter().flat_map(|v| v.to_array()));
    Ok([kind].into_iter().chain(numbers.into_iter().map(f32::to_bits)).collect())
}
