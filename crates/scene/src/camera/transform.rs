//! Where the camera stands, and the space in which rays are traced.
//!
//! Single precision is finest near zero, so render space is usually the world moved, without
//! turning, so that the camera stands at the origin at the middle of its motion
//! ([Pharr 2023 §5.1.1]). Matrices are joined in double precision before they are rounded; the
//! choice of space changes the picture by rounding alone.

use description::{RenderSpace, TransformDesc};
use math::{AnimatedTransform, DMat4, DVec3, Transform};

/// How camera, render and world space lie to each other. Only the camera moves against render
/// space.
#[derive(Clone, Debug)]
pub struct CameraTransform {
    render_from_camera: AnimatedTransform,
    world_from_render: DMat4,
}

impl CameraTransform {
    /// From the transform of the scene file, world to camera. `None` when a matrix has no inverse.
    pub fn new(camera_from_world: &TransformDesc, space: RenderSpace) -> Option<Self> {
        let TransformDesc { start, end, times } = camera_from_world.inverse();
        let world_from_camera = AnimatedTransform::new(start, end, times)?;
        let middle = || {
            if world_from_camera.is_moving() {
                world_from_camera.at((times[0] + times[1]) * 0.5).matrix().as_dmat4()
            } else {
                start
            }
        };
        let world_from_render = match space {
            RenderSpace::Camera => middle(),
            RenderSpace::CameraWorld => {
                // Rounded, so that the move is exact in either precision.
                DMat4::from_translation(middle().transform_point3(DVec3::ZERO).as_vec3().as_dvec3())
            }
            RenderSpace::World => DMat4::IDENTITY,
        };
        let render_from_world = world_from_render.inverse();
        let render_from_camera =
            AnimatedTransform::new(render_from_world * start, render_from_world * end, times)?;
        Some(Self { render_from_camera, world_from_render })
    }

    /// Camera to render space at a moment.
    #[inline]
    pub fn render_from_camera(&self, time: f32) -> Transform {
        self.render_from_camera.at(time)
    }

    /// Camera to render space, as it moves.
    pub fn animated(&self) -> &AnimatedTransform {
        &self.render_from_camera
    }

    /// World to render space, to be joined with other matrices before it is rounded.
    pub fn render_from_world(&self) -> DMat4 {
        self.world_from_render.inverse()
    }

    /// Render to world space.
    pub fn world_from_render(&self) -> DMat4 {
        self.world_from_render
    }

    /// World to camera space at a moment.
    pub fn camera_from_world(&self, time: f32) -> DMat4 {
        (self.world_from_render * self.render_from_camera.at(time).matrix().as_dmat4()).inverse()
    }
}
