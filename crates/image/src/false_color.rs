//! false_color
