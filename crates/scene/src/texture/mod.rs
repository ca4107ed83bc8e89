//! Values that vary over surfaces.
