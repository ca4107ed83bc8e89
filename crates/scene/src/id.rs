//! Indices into the tables of a scene, by which its parts refer to each other.

/// Index of a material in [`Scene::materials`](crate::Scene::materials).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// Index of a light in its scene. The lights of an emitting geometry have consecutive indices, in
/// the order of its primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LightId(pub u32);

/// Index of an emission in [`Scene::emissions`](crate::Scene::emissions).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EmissionId(pub u32);

/// Index of a medium in [`Scene::media`](crate::Scene::media).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MediumId(pub u32);
