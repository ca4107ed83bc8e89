//! A transform that moves between two keys.
//!
//! Each key is decomposed into translation, rotation and a stretch (M = T·R·S, by polar
//! decomposition: the average of a matrix and its inverse transpose converges to its rotation);
//! translation and stretch are interpolated linearly, the rotation on the sphere of quaternions
//! ([Shoemake & Duff 1992]; [Pharr 2023 §3.9.3]).

use crate::{Bounds3, DMat4, DVec3, Point3, Transform};
use glam::{DMat3, DQuat};

/// A transform that may change over time.
#[derive(Clone, Debug)]
pub struct AnimatedTransform {
    start: Transform,
    motion: Option<Box<Motion>>,
}

#[derive(Clone, Debug)]
struct Motion {
    times: [f32; 2],
    end: Transform,
    translation: [DVec3; 2],
    rotation: [DQuat; 2],
    stretch: [DMat3; 2],
}

/// What the transform at a time is interpolated from, for engines that do so elsewhere. At both
/// keys it is translation · rotation · stretch.
#[derive(Clone, Copy, Debug)]
pub struct MotionKeys {
    /// The times of the keys.
    pub times: [f32; 2],
    /// Translations.
    pub translations: [DVec3; 2],
    /// Unit quaternions of which none is more than a right angle from the other.
    pub rotations: [DQuat; 2],
    /// Stretches.
    pub stretches: [DMat3; 2],
}

impl From<Transform> for AnimatedTransform {
    fn from(start: Transform) -> Self {
        Self { start, motion: None }
    }
}

impl AnimatedTransform {
    /// Interpolates from `start` at `times[0]` to `end` at `times[1]`, and is constant before and
    /// after. `None` when a matrix has no inverse. Equal keys make a transform at rest.
    pub fn new(start: DMat4, end: DMat4, times: [f32; 2]) -> Option<Self> {
        let first = Transform::from_f64(start)?;
        if start == end || times[0] >= times[1] {
            return Some(first.into());
        }
        let last = Transform::from_f64(end)?;
        let (t0, r0, s0) = decompose(start);
        let (t1, mut r1, s1) = decompose(end);
        if r0.dot(r1) < 0.0 {
            r1 = -r1;
        }
        let motion =
            Motion { times, end: last, translation: [t0, t1], rotation: [r0, r1], stretch: [s0, s1] };
        Some(Self { start: first, motion: Some(Box::new(motion)) })
    }

    /// Whether it changes over time.
    #[inline]
    pub fn is_moving(&self) -> bool {
        self.motion.is_some()
    }

    /// The transform at a time.
    #[inline]
    pub fn at(&self, time: f32) -> Transform {
        match &self.motion {
            None => self.start,
            Some(m) if time <= m.times[0] => self.start,
            Some(m) if time >= m.times[1] => m.end,
            Some(m) => {
                m.interpolate(((time - m.times[0]) / (m.times[1] - m.times[0])) as f64).unwrap_or(self.start)
            }
        }
    }

    /// The transform at the first key.
    #[inline]
    pub fn start(&self) -> &Transform {
        &self.start
    }

    /// What it is interpolated from; `None` at rest.
    pub fn keys(&self) -> Option<MotionKeys> {
        self.motion.as_ref().map(|motion| {
            let Motion { times, translation, rotation, stretch, .. } = **motion;
            MotionKeys { times, translations: translation, rotations: rotation, stretches: stretch }
        })
    }

    /// A box around the moving box `b` at all times.
    pub fn motion_bounds(&self, b: &Bounds3) -> Bounds3 {
        let Some(motion) = &self.motion else { return self.start.bounds(b) };
        if b.is_empty() {
            return *b;
        }
        b.corners().fold(Bounds3::EMPTY, |all, p| all.union(motion.point_bounds(p)))
    }
}

impl Motion {
    fn matrix(&self, t: f64) -> DMat4 {
        let stretch = self.stretch[0] * (1.0 - t) + self.stretch[1] * t;
        let rotation = DMat3::from_quat(self.rotation[0].slerp(self.rotation[1], t));
        let mut m = DMat4::from_mat3(rotation * stretch);
        m.w_axis = self.translation[0].lerp(self.translation[1], t).extend(1.0);
        m
    }

    fn interpolate(&self, t: f64) -> Option<Transform> {
        Transform::from_f64(self.matrix(t))
    }

    /// A box around the path of one point. The path p(t) = T(t) + R(t)·S(t)·p has |p″| ≤ θ²·|Sp| +
    /// 2θ·|ΔS·p|, so that a chord over a step h deviates from it by at most |p″|·h²/8.
    fn point_bounds(&self, p: Point3) -> Bounds3 {
        const STEPS: usize = 32;
        let p = p.as_dvec3();
        let angle = self.rotation[0].angle_between(self.rotation[1]);
        let reach = (self.stretch[0] * p).length().max((self.stretch[1] * p).length());
        let change = ((self.stretch[1] - self.stretch[0]) * p).length();
        let stray = (angle * angle * reach + 2.0 * angle * change) / (8.0 * (STEPS * STEPS) as f64);
        let keys = (0..=STEPS).map(|i| self.matrix(i as f64 / STEPS as f64).transform_point3(p));
        let path = Bounds3::around(keys.map(|q| q.as_vec3().into()));
        let size = path.min.abs().max(path.max.abs()).max_element();
        path.expand(stray as f32 + size * crate::gamma(4))
    }
}

fn decompose(m: DMat4) -> (DVec3, DQuat, DMat3) {
    let linear = DMat3::from_mat4(m);
    let mut rotation = linear;
    for _ in 0..100 {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let change = (next - rotation).to_cols_array().iter().fold(0f64, |a, x| a.max(x.abs()));
        rotation = next;
        if change < 1e-12 {
            break;
        }
    }
    // A reflection is no rotation, so it becomes part of the stretch.
    if rotation.determinant() < 0.0 {
        rotation *= -1.0;
    }
    (m.w_axis.truncate(), DQuat::from_mat3(&rotation).normalize(), rotation.transpose() * linear)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    fn turning() -> AnimatedTransform {
        let start = DMat4::from_translation(DVec3::new(1.0, 0.0, 0.0));
        let end = DMat4::from_rotation_z(2.0) * DMat4::from_scale(DVec3::new(2.0, 1.0, 3.0));
        AnimatedTransform::new(start, end, [0.0, 2.0]).expect("invertible")
    }

    #[test]
    fn keys_are_reproduced() {
        let a = turning();
        let p = Vec3::new(0.3, 0.4, 0.5);
        assert!((a.at(-1.0).point(p) - (p + Vec3::X)).length() < 1e-6);
        let end = Transform::rotate(2.0, Vec3::Z).after(&Transform::scale(Vec3::new(2.0, 1.0, 3.0)));
        assert!((a.at(5.0).point(p) - end.point(p)).length() < 1e-5);
        assert!((a.at(1.9999).point(p) - end.point(p)).length() < 1e-3);
    }

    #[test]
    fn motion_bounds_contain_all_times() {
        let a = turning();
        let b = Bounds3::new(Vec3::new(-1.0, -2.0, 0.5), Vec3::new(1.0, 1.0, 2.0));
        let all = a.motion_bounds(&b);
        for i in 0..1000 {
            let t = a.at(i as f32 / 500.0);
            assert!(b.corners().all(|p| all.contains(t.point(p))));
        }
        assert!(all.surface_area() < 600.0, "loose bounds: {all:?}");
    }

    #[test]
    fn reflections_decompose() {
        let m = DMat4::from_scale(DVec3::new(-1.0, 2.0, 1.0)) * DMat4::from_rotation_x(0.4);
        let (_, r, s) = decompose(m);
        let back = DMat3::from_quat(r) * s;
        assert!((back - DMat3::from_mat4(m)).to_cols_array().iter().all(|x| x.abs() < 1e-9));
    }
}
