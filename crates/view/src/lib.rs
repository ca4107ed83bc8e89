//! Scenes walked through.
//!
//! An [`Engine`] renders on a thread of its own what a [`Shot`] asks for: drafts while the camera
//! moves, in a resolution that holds the frame time ([`Pace`]), and the picture itself when it
//! rests, sample by sample, until it is that of `alhazen render`. A [`Flight`] moves the camera,
//! [`knobs`] change lights and materials, [`lines`] shows the paths of a pixel. All this works
//! without a display; a [`Report`] has the frame times of a camera path.
//!
//! With the feature `gpu`, a [`Rasterized`] scene is drawn by a GPU beside it ([`split`]).
//! With the feature `window` there is a window of it: [`window`].

mod display;
mod engine;
mod flight;
mod frame;
mod headless;
pub mod knobs;
pub mod lines;
#[cfg(feature = "gpu")]
mod on_device;
mod pace;
pub mod planet;
#[cfg(feature = "gpu")]
mod rasterized;
mod renderer;
#[cfg(feature = "gpu")]
pub mod split;
mod step;
#[cfg(feature = "window")]
pub mod window;
mod world;

pub use display::{develop, layers};
pub use engine::{Engine, Output};
pub use flight::{Flight, Mode};
pub use frame::{Frame, Stages};
pub use headless::Report;
pub use pace::Pace;
#[cfg(feature = "gpu")]
pub use rasterized::{Raster, Rasterized};
pub use renderer::Renderer;
pub use step::StepError;
pub use world::{Shot, World};
