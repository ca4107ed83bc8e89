//! The contracts of BxDFs and microfacet distributions.

mod all_bxdfs;
mod completeness;
mod hair;
mod layers;
mod measured;
mod microfacets;
mod openpbr;
mod subsurface;
