//! The part of space that a drawing shows.

use math::Vec3;

use super::edges::Edge;

/// The part of space that a drawing shows: a rectangle in world space, and a direction.
pub(super) struct Frame {
    /// The upper left corner.
    corner: Vec3,
    right: Vec3,
    down: Vec3,
    pub into: Vec3,
    pub width: f32,
    pub height: f32,
}

impl Frame {
    /// The frame with these axes (to the right, down, into the drawing) that holds all rays with a
    /// margin. It lies at their mean depth.
    pub fn around(edges: &[Edge], [right, down, into]: [Vec3; 3]) -> Self {
        let points: Vec<Vec3> = edges.iter().flat_map(|edge| edge.ends).collect();
        let range = |axis: Vec3| {
            let along = points.iter().map(|p| axis.dot(*p));
            let (low, high) =
                along.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            if low <= high { (low, high) } else { (0.0, 1.0) }
        };
        let ((left, right_end), (top, bottom)) = (range(right), range(down));
        let (mut width, mut height) = (right_end - left, bottom - top);
        let size = width.max(height).max(f32::MIN_POSITIVE);
        // Neither a line nor a tower.
        width = width.max(0.5 * size) + 0.15 * size;
        height = height.max(0.4 * size) + 0.15 * size;
        let depth = points.iter().map(|p| into.dot(*p)).sum::<f32>() / points.len().max(1) as f32;
        let (u, v) = (0.5 * (left + right_end - width), 0.5 * (top + bottom - height));
        Frame { corner: right * u + down * v + into * depth, right, down, into, width, height }
    }

    /// The point at these shares of width and height.
    pub fn point(&self, u: f32, v: f32) -> Vec3 {
        self.corner + self.right * (u * self.width) + self.down * (v * self.height)
    }

    /// The place of a point in a drawing of this width.
    pub fn place(&self, p: Vec3, width: f32) -> [f32; 2] {
        let (scale, from) = (width / self.width, p - self.corner);
        [self.right.dot(from) * scale, self.down.dot(from) * scale]
    }
}
