//! What the kernels of a frame are told.

use scene::View;
use scene::camera::Projection;

use crate::records::record;

record! {
    /// A frame.
    pub struct FrameParameters {
        /// The first pixel, and how many there are along each side.
        low: [u32; 2],
        size: [u32; 2],
        /// The index of the first sample of each pixel, how many there are of each, and how many
        /// there were before of the picture at rest.
        index: u32,
        samples: u32,
        before: u32,
        /// The half of the buffers that is of this frame, and whether the other is of the one
        /// before.
        half: u32,
        has_history: u32,
        /// Whether the camera moves, and the number of samples for which the filtered picture
        /// counts while one at rest begins.
        is_moving: u32,
        prior: f32,
        /// The camera of the frame before, after a word for nothing.
        unused: u32,
        eye: Eye,
    }
}

record! {
    /// A camera onto whose film points are projected: its screen (top left and pixel), the rows of
    /// the matrix from render space, and whether it is orthographic.
    #[derive(PartialEq)]
    pub struct Eye {
        screen: [f32; 4],
        rows: [[f32; 4]; 3],
        is_orthographic: u32,
        unused: u32,
        padding: [u32; 2],
    }
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
            ..Self::default()
        }
    }
}

record! {
    /// A level of the wavelet filter.
    pub struct Level {
        /// Pixels from one point of the filter to the next.
        step: i32,
        /// Whether what it gives goes into the history.
        is_kept: u32,
        unused: [u32; 2],
    }
}

record! {
    /// A step of reuse.
    pub struct Reuse {
        /// The parts of the buffer to read samples from, and to write them to.
        source: u32,
        target_part: u32,
        /// Pixels around to take samples from; with none, it is the frame before.
        neighbours: u32,
        /// Of each a bit: [`ReuseBit`](crate::tags::ReuseBit).
        flags: u32,
    }
}
