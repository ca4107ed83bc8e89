//! Pixel arrays, pyramids, file formats and error metrics
