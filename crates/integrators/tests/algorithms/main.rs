//! The algorithms against what is known: closed forms, each other, and the promises of the loop.

mod agreement;
mod ambient_occlusion;
mod build;
mod direct_light;
mod furnace;
mod render_loop;
mod support;
