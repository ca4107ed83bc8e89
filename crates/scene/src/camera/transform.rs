//! The position of a camera, and the choice of the space in which rays are traced.
//!
//! Single precision has the smallest absolute error near zero. Render space is therefore usually
//! world space translated so that the camera of the description is at the origin in the middle of
//! its motion ([Pharr 2023 §5.1.1]). It is chosen once, when a scene is compiled; other cameras are
//! placed in that same space. Matrices are multiplied in double precision before they are rounded,
//! so the choice of space changes a picture by rounding alone.

use description::{RenderSpace, TransformDesc};
use lanes::{Each, MAX_LANES, Real};
use math::{AnimatedTransform, DMat4, DVec3, Ray, Transform, Vec3, affine_ray};

/// The transforms between camera, render and world space. Only the camera moves relative to render
/// space.
#[derive(Clone, Debug)]
pub struct CameraTransform {
    render_from_camera: AnimatedTransform,
    world_from_render: DMat4,
}

impl CameraTransform {
    /// From the description's transform, world to camera, and a render space given by its transform
    /// to world space. `None` if a matrix has no inverse.
    pub fn new(camera_from_world: &TransformDesc, world_from_render: DMat4) -> Option<Self> {
        let TransformDesc { start, end, times } = camera_from_world.inverse();
        let render_from_world = world_from_render.inverse();
        let render_from_camera =
            AnimatedTransform::new(render_from_world * start, render_from_world * end, times)?;
        Some(Self { render_from_camera, world_from_render })
    }

    /// Camera to render space at a time.
    #[inline]
    pub fn render_from_camera(&self, time: f32) -> Transform {
        self.render_from_camera.at(time)
    }

    /// A ray of camera space in render space.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, ray: &Ray<R>) -> Ray<R> {
        if !self.render_from_camera.is_moving() {
            return self.render_from_camera.start().ray(ray);
        }
        let time = ray.time.to_array();
        let mut columns = [[[0.0; MAX_LANES]; 3]; 4];
        for lane in 0..R::LANES {
            let matrix = self.render_from_camera.at(time[lane]).matrix().to_cols_array_2d();
            for (column, values) in columns.iter_mut().zip(matrix) {
                for (numbers, value) in column.iter_mut().zip(values) {
                    numbers[lane] = value;
                }
            }
        }
        let columns = columns.each(|column| Vec3::from_array(column.each(|numbers| R::load(&numbers))));
        affine_ray(&columns, ray)
    }

    /// Camera to render space, as a function of time.
    pub fn animated(&self) -> &AnimatedTransform {
        &self.render_from_camera
    }

    /// Render to world space.
    pub fn world_from_render(&self) -> DMat4 {
        self.world_from_render
    }

    /// World to camera space at a time.
    pub fn camera_from_world(&self, time: f32) -> DMat4 {
        (self.world_from_render * self.render_from_camera.at(time).matrix().as_dmat4()).inverse()
    }
}

/// The render space of a camera's description, as its transform to world space; world space if the
/// camera's transform has no inverse.
pub fn world_from_render(camera_from_world: &TransformDesc, space: RenderSpace) -> DMat4 {
    let TransformDesc { start, end, times } = camera_from_world.inverse();
    let Some(world_from_camera) = AnimatedTransform::new(start, end, times) else { return DMat4::IDENTITY };
    let middle = || {
        if world_from_camera.is_moving() {
            world_from_camera.at((times[0] + times[1]) * 0.5).matrix().as_dmat4()
        } else {
            start
        }
    };
    match space {
        RenderSpace::Camera => middle(),
        RenderSpace::CameraWorld => {
            // Rounded, so that the translation is exact in both precisions.
            DMat4::from_translation(middle().transform_point3(DVec3::ZERO).as_vec3().as_dvec3())
        }
        RenderSpace::World => DMat4::IDENTITY,
    }
}
