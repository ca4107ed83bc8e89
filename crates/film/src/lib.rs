//! Radiance samples to pixels: filters, sensors and exact accumulation
