//! Random numbers, warps with their densities, distributions, low-discrepancy samplers
