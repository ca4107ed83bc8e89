//! Files of all formats: what they say, and what is said of their errors.

mod corpora;
mod directives;
mod hostile;
mod meshes;
mod messages;
