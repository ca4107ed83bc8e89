//! Rays against shapes: meshes, quadrics, patches, instances and the tree over them
