//! The contracts of BxDFs and microfacet distributions.

mod all_bxdfs;
mod layers;
mod microfacets;
