//! Colours of vertices as an image: four texels for each triangle, of which bilinear interpolation
//! between three is linear interpolation between the corners.
//!
//! With the colours c₀, c₁ and c₂ of the corners, the texels are c₀ and c₁ in one row and c₂ and
//! c₁ + c₂ − c₀ in the next. The corners are at the centres of the first three, so that lookups
//! within the triangle read no texels of others.

use half::f16;
use image::{Image, Pixels};
use math::Point2;

use super::primitive::Primitive;

/// A primitive whose triangles share no vertices and are mapped to the image of their colours,
/// which are multiplied by a factor.
pub(crate) fn unwrapped(primitive: &Primitive, factor: [f32; 3]) -> (Primitive, Image) {
    let count = primitive.triangles.len().max(1);
    let columns = (count as f64).sqrt().ceil() as usize;
    let rows = count.div_ceil(columns);
    let (width, height) = (2 * columns, 2 * rows);
    let mut values = vec![f16::ZERO; 3 * width * height];
    let mut apart = Primitive::default();
    for (index, triangle) in primitive.triangles.iter().enumerate() {
        let (x, y) = (2 * (index % columns), 2 * (index / columns));
        let corners = triangle.map(|vertex| primitive.colors[vertex as usize]);
        let [a, b, c] = corners.map(|color| std::array::from_fn::<_, 3, _>(|i| color[i] * factor[i]));
        let fourth = std::array::from_fn(|i| b[i] + c[i] - a[i]);
        for (texel, color) in [a, b, c, fourth].into_iter().enumerate() {
            let at = 3 * ((y + texel / 2) * width + x + texel % 2);
            for (value, component) in values[at..at + 3].iter_mut().zip(color) {
                *value = f16::from_f32(component);
            }
        }
        let first = apart.positions.len() as u32;
        apart.triangles.push([first, first + 1, first + 2]);
        for (corner, &vertex) in triangle.iter().enumerate() {
            let at = |offset: usize, size: usize| (offset as f32 + 0.5) / size as f32;
            let uv = Point2::new(at(x + corner % 2, width), at(y + corner / 2, height));
            apart.uvs.push(uv);
            apart.positions.push(primitive.positions[vertex as usize]);
            apart.normals.extend(primitive.normals.get(vertex as usize));
            apart.tangents.extend(primitive.tangents.get(vertex as usize));
        }
    }
    let image = Image::new(width as u32, height as u32, ["R", "G", "B"], Pixels::F16(values));
    (apart, image.expect("invariant: as many pixels as the size says"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::WrapMode;
    use math::Vec3;

    #[test]
    fn colors_are_interpolated_linearly() {
        let colors = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.25], [0.5, 0.5, 1.0], [0.0; 3]];
        let triangles = vec![[0, 1, 2], [2, 1, 3], [3, 0, 1]];
        let positions = vec![Vec3::ZERO; 4];
        let primitive = Primitive { triangles, positions, colors, ..Primitive::default() };
        let (apart, image) = unwrapped(&primitive, [1.0, 0.5, 1.0]);
        for (triangle, corners) in primitive.triangles.iter().zip(&apart.triangles) {
            for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.5, 0.3]] {
                let mut uv = Point2::new(0.0, 0.0);
                let mut expected = [0.0; 3];
                for corner in 0..3 {
                    uv += apart.uvs[corners[corner] as usize] * weights[corner];
                    let color = primitive.colors[triangle[corner] as usize];
                    for (sum, (c, factor)) in expected.iter_mut().zip(color.into_iter().zip([1.0, 0.5, 1.0]))
                    {
                        *sum += weights[corner] * c * factor;
                    }
                }
                // Rows are counted from the top, as v is in files.
                let found = image.bilerp_rgb(uv, WrapMode::Repeat);
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!((found - expected).abs() < 2e-3, "{found} {expected}");
                }
            }
        }
    }
}
