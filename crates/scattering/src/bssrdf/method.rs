//! The ways of following light under a surface.

/// How light is followed under a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SubsurfaceMethod {
    /// By the diffusion profile of a half space.
    #[default]
    Diffusion,
    /// By a random walk.
    RandomWalk,
}
