//! The camera of a raster pass, as shaders have it.

use math::{DMat4, Vec3};

use super::fog::Fog;
use super::lens::Lens;
use super::pond::Pond;
use crate::records::record;

record! {
    /// The uniforms of a pass.
    pub struct Eye {
        /// The matrices to and from the picture.
        clip_from_render: [[f32; 4]; 4],
        render_from_clip: [[f32; 4]; 4],
        /// Where the camera is; w is the radius of the scene.
        position: [f32; 4],
        /// The plane behind which nothing is drawn, n·p + w = 0 with n towards what is; 0 for none.
        cut: [f32; 4],
        /// The plane of water, its index of refraction, and what deep water reflects.
        pond: [f32; 4],
        water: [f32; 4],
        /// Extinction of the fog; the ball that it fills with its radius, 0 for all of space.
        extinction: [f32; 4],
        ball: [f32; 4],
        /// Width and height of the picture in pixels.
        size: [f32; 4],
        /// Harmonics of irradiance, and of the light that the fog scatters.
        irradiance: [[f32; 4]; 9],
        glow: [[f32; 4]; 9],
    }
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
