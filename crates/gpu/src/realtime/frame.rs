//! What the kernels of a frame are told.

use scene::View;
use scene::camera::Projection;

/// `FrameParameters` of `shaders/realtime/frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::NoUninit)]
pub struct Frame {
    /// The first pixel, and how many there are along each side.
    pub low: [u32; 2],
    pub size: [u32; 2],
    /// The index of the first sample of each pixel, how many there are of each, and how many there
    /// were before of the picture at rest.
    pub index: u32,
    pub samples: u32,
    pub before: u32,
    /// Which half of the buffers is of this frame, and whether the other is of the one before.
    pub half: u32,
    pub has_history: u32,
    /// Whether the camera moves, and the number of samples for which the filtered picture counts
    /// while one at rest begins.
    pub is_moving: u32,
    pub prior: f32,
    /// The camera of the frame before.
    pub eye: Eye,
}

/// A camera onto whose film points are projected: whether it is orthographic, its screen (top left
/// and pixel), and the rows of the matrix from render space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::NoUninit)]
pub struct Eye {
    is_orthographic: u32,
    screen: [f32; 4],
    rows: [[f32; 4]; 3],
}

impl Eye {
    /// The camera of a view; of one that kernels do not have, anything.
    pub fn new(view: &View) -> Self {
        let (is_orthographic, screen) = match view.camera.projection() {
            Projection::Perspective(p) => (0, p.screen()),
            Projection::Orthographic(p) => (1, p.screen()),
            Projection::Spherical(_) | Projection::Realistic(_) => return Self::default(),
        };
        let inverse = view.camera.transform().animated().start().inverse();
        Self {
            is_orthographic,
            screen: [screen.top_left.x, screen.top_left.y, screen.per_pixel.x, screen.per_pixel.y],
            rows: [0, 1, 2].map(|row| inverse.matrix().row(row).to_array()),
        }
    }
}

/// `Level` of `shaders/realtime/wavelet.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::NoUninit)]
pub struct Level {
    /// Pixels from one point of the filter to the next.
    pub step: i32,
    /// Whether what it gives goes into the history.
    pub is_kept: u32,
    pub unused: [u32; 2],
}
