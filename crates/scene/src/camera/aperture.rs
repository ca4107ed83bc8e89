//! Shapes of aperture stops other than disks.
//!
//! A shape is an image over the square around the stop's disk, and its values, scaled to the mean
//! π/4 of a disk in that square, are shares of the light: all shapes of a diameter are equally
//! bright. pbrt-v4 defines the built-in shapes as pictures of 256 × 256 pixels, which are made here
//! by the same outlines.

use image::{Image, WrapMode};
use math::Vec2;
use std::f32::consts::{FRAC_PI_4, PI};
use std::sync::Arc;

const SIDE: u32 = 256;

/// The shares of light that pass the points of a stop.
#[derive(Clone, Debug)]
pub(super) struct ApertureMask(Arc<Image>);

impl ApertureMask {
    /// A disk that darkens outwards, as exp(−r²) − exp(−1).
    pub fn gaussian() -> Self {
        Self::shape(|p| (lanes::exp(-p.length_squared()) - lanes::exp(-1.0f32)).max(0.0))
    }

    /// A square of half the diameter.
    pub fn square() -> Self {
        Self::shape(|p| f32::from(u8::from(p.abs().max_element() < 0.5)))
    }

    /// A regular pentagon within 4/5 of the disk, with a corner downwards.
    pub fn pentagon() -> Self {
        let corners: [Vec2; 5] = std::array::from_fn(|i| 0.8 * on_circle(0.25 + i as f32 / 5.0));
        Self::shape(|p| f32::from(u8::from(is_in_polygon(&corners, p))))
    }

    /// A star of five points on the disk's border, one of them to the left.
    pub fn star() -> Self {
        // The pentagram's inner corners lie on a circle of this radius.
        let inner = lanes::cos(0.4 * PI) / lanes::cos(0.2 * PI);
        let corners: [Vec2; 10] =
            std::array::from_fn(|i| on_circle(i as f32 / 10.0) * if i % 2 == 1 { 1.0 } else { inner });
        Self::shape(|p| f32::from(u8::from(is_in_polygon(&corners, p))))
    }

    /// What a picture shows, the mean of its channels R, G and B; `None` if it is black.
    pub fn picture(picture: &Image) -> Option<Self> {
        Self::scaled(picture.width(), picture.height(), |x, y| {
            let value = picture.rgb(x, y).iter().sum::<f32>() / 3.0;
            if value.is_finite() { value.max(0.0) } else { 0.0 }
        })
    }

    /// The shares, over the square around the stop's disk, the top at y = 1; beyond it all is
    /// black.
    pub fn image(&self) -> &Image {
        &self.0
    }

    /// The share of the light at `p`, in [−1, 1]² over the stop's square, x and y as in camera
    /// space. The top of the picture is at y = 1.
    pub fn share(&self, p: [f64; 2]) -> f32 {
        let [s, t] = [0.5 + 0.5 * p[0], 0.5 - 0.5 * p[1]].map(|x| x as f32);
        self.0.bilerp(Vec2::new(s, t), 0, WrapMode::Black)
    }

    /// From a function over [−1, 1]², y down.
    fn shape(value: impl Fn(Vec2) -> f32) -> Self {
        let at = |i: u32| (2 * i + 1) as f32 / SIDE as f32 - 1.0;
        Self::scaled(SIDE, SIDE, |x, y| value(Vec2::new(at(x), at(y)))).expect("no shape is empty")
    }

    fn scaled(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> Option<Self> {
        let positions = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let sum: f64 = positions.map(|(x, y)| f64::from(value(x, y))).sum();
        let mean = sum / (f64::from(width) * f64::from(height));
        let scale = FRAC_PI_4 / mean as f32;
        scale
            .is_finite()
            .then(|| Self(Arc::new(Image::from_fn(width, height, ["Y"], |x, y| [value(x, y) * scale]))))
    }
}

/// The point of the unit circle after a fraction of a turn.
fn on_circle(turn: f32) -> Vec2 {
    let (y, x) = lanes::sin_cos(2.0 * PI * turn);
    Vec2::new(x, y)
}

/// Whether a line from `p` crosses the outline an odd number of times.
fn is_in_polygon(corners: &[Vec2], p: Vec2) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crosses = |(a, b): (&Vec2, &Vec2)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
    };
    corners.iter().zip(next).filter(|&edge| crosses(edge)).count() % 2 == 1
}
