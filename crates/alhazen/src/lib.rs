//! A physically based renderer
