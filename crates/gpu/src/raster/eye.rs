//! What shaders know of a camera: `Eye` of `shaders/raster.wgsl`.

use math::{DMat4, Vec3};

use super::fog::Fog;
use super::lens::Lens;
use super::pond::Pond;

/// The uniforms of a pass.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::NoUninit)]
pub struct Eye {
    clip_from_render: [[f32; 4]; 4],
    render_from_clip: [[f32; 4]; 4],
    position: [f32; 4],
    cut: [f32; 4],
    pond: [f32; 4],
    water: [f32; 4],
    extinction: [f32; 4],
    ball: [f32; 4],
    size: [f32; 4],
    irradiance: [[f32; 4]; 9],
    glow: [[f32; 4]; 9],
}

impl Eye {
    /// The light of a scene of this radius, without a camera.
    pub fn of_light(irradiance: [Vec3; 9], fog: &Fog, radius: f32) -> Self {
        let harmonics = |all: [Vec3; 9]| all.map(|light| light.extend(0.0).to_array());
        let (center, ball) = fog.ball.unwrap_or_default();
        Self {
            position: [0.0, 0.0, 0.0, radius],
            extinction: fog.extinction.extend(0.0).to_array(),
            ball: center.extend(ball).to_array(),
            irradiance: harmonics(irradiance),
            glow: harmonics(fog.glow),
            ..Self::default()
        }
    }

    /// The same light seen through a lens, in a picture of this size, without what is behind its
    /// mirror.
    pub fn through(&self, lens: &Lens, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as f32);
        let radius = self.position[3];
        let position = lens.eye.extend(radius).to_array();
        Self {
            position,
            cut: lens.cut,
            size: [width, height, 0.0, 0.0],
            ..self.of_clip(lens.clip_from_render)
        }
    }

    /// The same light with another clip space.
    pub fn of_clip(&self, clip_from_render: DMat4) -> Self {
        Self {
            clip_from_render: clip_from_render.as_mat4().to_cols_array_2d(),
            render_from_clip: clip_from_render.inverse().as_mat4().to_cols_array_2d(),
            ..*self
        }
    }

    /// With a pond in a plane.
    pub fn with(&self, plane: [f32; 4], pond: &Pond) -> Self {
        Self { pond: plane, water: pond.deep.extend(pond.index).to_array(), ..*self }
    }
}
