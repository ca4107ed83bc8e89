//! The footprint of a pixel where ray differentials are missing.
//!
//! After a bounce off a rough surface there are no ray differentials. The footprint is then
//! estimated as if the camera saw the point directly, from the smallest differences in origin and
//! direction between the rays of neighbouring pixels anywhere on the film: textures may be filtered
//! too little, never too much ([Pharr 2023 §10.1.1]). The differences are stored in the frame whose
//! z axis is the ray, and applied in the frame of the ray from the camera to the point: with p =
//! (0, 0, distance) and a neighbour from Δo along (0, 0, 1) + Δd,
//!
//! ```text
//! ∂p/∂x = Δo + t·((0, 0, 1) + Δd) − p        t = n·(p − Δo) / n·((0, 0, 1) + Δd)
//! ```

use super::projection::Projection;
use lanes::Real;
use math::{Frame, Normal3, Vec2, Vec3, Vector3};

/// The factor on ray differentials of one pixel: 1/√n for n samples per pixel, but at least 1/8, as
/// reconstruction filters blur the picture over a pixel for any number of samples.
pub fn differential_scale(samples_per_pixel: u32) -> f32 {
    (samples_per_pixel.max(1) as f32).sqrt().recip().max(0.125)
}

/// The smallest differences between rays of neighbouring pixels, in the frame of the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinimumDifferentials {
    /// Of origins, for the neighbours in x and y.
    origin: [Vector3; 2],
    /// Of unit directions, for the neighbours in x and y.
    direction: [Vector3; 2],
}

impl MinimumDifferentials {
    /// Searches along the diagonal of a film of `resolution` pixels.
    pub fn new(projection: &Projection, resolution: [u32; 2]) -> Self {
        const STEPS: u32 = 512;
        let film = Vec2::new(resolution[0] as f32, resolution[1] as f32);
        let keep_shorter = |shortest: &mut Vector3, v: Vector3| {
            if v.length_squared() < shortest.length_squared() {
                *shortest = v;
            }
        };
        let mut least = Self { origin: [Vec3::INFINITY; 2], direction: [Vec3::INFINITY; 2] };
        for i in 0..STEPS {
            let (o, d, weight, near) =
                projection.ray_differential(film * (i as f32 / (STEPS - 1) as f32), Vec2::splat(0.5));
            if weight == 0.0 {
                continue;
            }
            let frame = Frame::from_z(d);
            keep_shorter(&mut least.origin[0], frame.to_local(near.rx_origin - o));
            keep_shorter(&mut least.origin[1], frame.to_local(near.ry_origin - o));
            keep_shorter(&mut least.direction[0], frame.to_local(near.rx_direction.normalize()) - Vec3::Z);
            keep_shorter(&mut least.direction[1], frame.to_local(near.ry_direction.normalize()) - Vec3::Z);
        }
        least
    }

    /// The differences of origins and those of directions, for the neighbours in x and y.
    pub fn differences(&self) -> [[Vector3; 2]; 2] {
        [self.origin, self.direction]
    }

    /// The differences for pixels `n` times as wide and high, to first order.
    pub fn coarser(&self, n: u32) -> Self {
        let [origin, direction] = [self.origin, self.direction].map(|both| both.map(|v| v * n as f32));
        Self { origin, direction }
    }

    /// ∂p/∂x and ∂p/∂y in camera space, on the plane with normal `n` that the ray along the unit
    /// direction `d` hits at `distance`; zero where that plane is seen edge-on.
    #[inline(always)]
    pub fn dp_dxy<R: Real>(&self, d: Vector3<R>, distance: R, n: Normal3<R>) -> [Vector3<R>; 2] {
        let frame = Frame::from_z(d);
        let n = frame.to_local(n);
        [self.dp(0, &frame, distance, n), self.dp(1, &frame, distance, n)]
    }

    /// ∂p along an axis of the film: the neighbouring ray meets the plane farther by `along`. Both
    /// rays are hardly apart, so that their points are not subtracted from each other.
    #[inline(always)]
    fn dp<R: Real>(&self, axis: usize, frame: &Frame<R>, distance: R, n: Normal3<R>) -> Vector3<R> {
        let (o, d) = (Vec3::broadcast(self.origin[axis]), Vec3::broadcast(self.direction[axis]));
        let along = -(n.dot(o) + distance * n.dot(d)) / (n.z + n.dot(d));
        let mut dp = o + d * (distance + along);
        dp.z += along;
        Vec3::select(dp.are_finite(), frame.from_local(dp), Vec3::splat(R::zero()))
    }
}
