//! The scene format of pbrt-v4 [Pharr 2023; pbrt.org/fileformat-v4], with the extensions of
//! alhazen: [`read`](fn@read) makes a description of files, [`SceneBuilder`] one of calls, and
//! [`export`] writes one.

mod read;
mod write;

pub use read::{Argument, ArgumentValues, Motion, Placement, SceneBuilder, read};
pub use write::{ExportError, Exported, export, export_camera};
