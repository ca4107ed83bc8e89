//! The hemicube: all form factors of a patch at once, from its centre.
//!
//! Half a cube of 2 × 2 × 1 is placed around the centre of a patch, and its faces are divided into
//! pixels. A ray through each pixel finds the visible element; the element's form factor is the sum
//! over its pixels of
//!
//! ΔF = ΔA / (π (x² + y² + 1)²) on the face above, ΔF = z ΔA / (π (y² + z² + 1)²) on the faces at
//! the sides,
//!
//! cosθ dω/π of the pixel. Each shot rotates the cube about the normal by another angle, so that
//! the errors of different shots differ. In a closed scene the factors sum to one, so that energy
//! is conserved exactly.
//!
//! It is biased by its resolution, by which elements smaller than a pixel are overestimated or
//! missed, and by taking the centre for the whole patch, which is wrong for near elements. Pixels
//! are found by rays instead of by a z-buffer; the factors are those of the original. Source:
//! [Cohen 1985].

use geometry::RayStats;
use math::{Frame, Vec2, Vector3};
use rayon::prelude::*;
use sampling::hash_float;
use scene::Scene;
use std::f32::consts::{PI, TAU};

use super::form_factor::Received;
use super::mesh::Mesh;
use super::subdivide::Cut;
use super::surfaces::{first_solid, seen_side};
use crate::{Cancelled, Control};

/// Elements that cover at least this many pixels are subdivided by differences between their
/// pixels.
const MIN_PIXELS: u32 = 16;

/// A hemicube of pixels.
pub(crate) struct Hemicube {
    /// Pixels along an edge, an even number.
    resolution: u32,
    /// The angle of rotation about the normal.
    angle: f32,
}

/// The visible surface in a pixel.
struct Pixel {
    /// The root cell of the primitive there, and the parameters.
    root: u32,
    uv: Vec2,
    /// The side that is seen.
    side: u8,
    factor: f32,
}

/// The surfaces visible from a patch.
pub(crate) struct VisiblePixels(Vec<Pixel>);

impl Hemicube {
    /// The hemicube of the `shot`th shot.
    pub fn new(resolution: u32, shot: u32) -> Self {
        Self { resolution: resolution.max(2).next_multiple_of(2), angle: TAU * hash_float(&[shot]) }
    }

    /// The directions of a row of pixels in a frame with the normal along +z, and their form
    /// factors. Rows of the top face come first, then those of the four side faces, which have half
    /// as many.
    fn row(&self, row: u32) -> impl Iterator<Item = (Vector3, f32)> {
        let n = self.resolution;
        let step = 2.0 / n as f32;
        let place = move |i: u32| (i as f32 + 0.5) * step - 1.0;
        let (sin, cos) = lanes::sin_cos(self.angle);
        (0..n).map(move |column| {
            let (d, factor) = if row < n {
                (Vector3::new(place(column), place(row), 1.0), 1.0)
            } else {
                let (face, below) = ((row - n) / (n / 2), (row - n) % (n / 2));
                let z = (below as f32 + 0.5) * step;
                let (x, y) = [
                    (1.0, place(column)),
                    (-1.0, place(column)),
                    (place(column), 1.0),
                    (place(column), -1.0),
                ][face as usize % 4];
                (Vector3::new(x, y, z), z)
            };
            let turned = Vector3::new(d.x * cos - d.y * sin, d.x * sin + d.y * cos, d.z);
            (turned.normalize(), factor * step * step / (PI * d.length_squared().powi(2)))
        })
    }

    fn rows(&self) -> u32 {
        self.resolution + 4 * (self.resolution / 2)
    }

    /// Casts a ray through each pixel from the centre of a cell, on one side of it.
    pub fn cast(
        &self,
        scene: &Scene,
        mesh: &Mesh,
        cell: u32,
        side: usize,
        control: &Control,
        stats: &mut RayStats,
    ) -> Result<VisiblePixels, Cancelled> {
        let cell = mesh.cell(cell);
        let Some(eye) = mesh.surface(scene.world(), cell.primitive, cell.domain().center()) else {
            return Ok(VisiblePixels(Vec::new()));
        };
        let frame = Frame::from_z(if side == 0 { eye.n } else { -eye.n });
        let look = |row: u32| {
            control.check()?;
            let mut stats = RayStats::default();
            let pixels = self.row(row).filter_map(|(d, factor)| {
                let ray = eye.spawn_ray(frame.from_local(d));
                let (hit, surface) = first_solid(scene, ray, &mut stats)?;
                let (root, uv) = mesh.place(scene.world(), &hit, &surface)?;
                Some(Pixel { root, uv, side: seen_side(&surface) as u8, factor })
            });
            let pixels: Vec<Pixel> = pixels.collect();
            Ok((pixels, stats))
        };
        let rows: Vec<_> = (0..self.rows()).into_par_iter().map(look).collect::<Result<_, Cancelled>>()?;
        rows.iter().for_each(|(_, some)| *stats += *some);
        Ok(VisiblePixels(rows.into_iter().flat_map(|(pixels, _)| pixels).collect()))
    }
}

impl VisiblePixels {
    /// The irradiance of the elements `ids` by unit radiosity of a patch of the given area.
    pub fn received(&self, cut: &Cut, area: f32, ids: &[u32]) -> Vec<Received> {
        let mut all = vec![(Received::default(), 0); cut.elements.len()];
        for &Pixel { root, uv, side, factor } in &self.0 {
            let leaf = cut.mesh.leaf_in(root, uv);
            let (received, pixels) = &mut all[leaf.element as usize];
            let element = &cut.elements[leaf.element as usize];
            let quarter = leaf.domain().quarter_of(uv);
            let factor = factor * area / (element.area * element.points[quarter].weight);
            received.quarters[quarter][usize::from(side)] += factor;
            *pixels += 1;
        }
        let answer = |&id: &u32| {
            let (received, pixels) = all[id as usize];
            let even = received.sides(&cut.elements[id as usize]);
            if pixels < MIN_PIXELS { Received { quarters: [even; 4] } } else { received }
        };
        ids.iter().map(answer).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_of_all_pixels_sum_to_one() {
        for resolution in [16, 64, 256] {
            let cube = Hemicube::new(resolution, 3);
            let pixels = (0..cube.rows()).flat_map(|row| cube.row(row));
            let (sum, up) =
                pixels.fold((0.0, 0.0), |(sum, up), (d, factor)| (sum + factor, up + factor * d.z));
            let error = 4.0 / (resolution * resolution) as f32 + 1e-5;
            assert!((sum - 1.0).abs() < error, "{resolution}: {sum}");
            // ∫ cos²θ dω / π = 2/3.
            assert!((up - 2.0 / 3.0).abs() < error, "{resolution}: {up}");
        }
    }
}
