//! The algorithms of light transport and the one loop that runs them
