//! What the kernels of a frame are told.

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
    pub unused: [u32; 3],
}
