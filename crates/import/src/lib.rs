//! Scene and mesh files read into a scene description
