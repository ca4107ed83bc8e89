//! What the author of a scene said: typed descriptions, source spans and diagnostics
