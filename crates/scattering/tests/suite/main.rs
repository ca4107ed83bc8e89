//! The contracts of BxDFs and microfacet distributions.

mod all_bxdfs;
mod hair;
mod layers;
mod measured;
mod microfacets;
mod openpbr;
mod subsurface;
