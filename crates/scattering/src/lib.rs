//! Light meeting matter in a local frame: BxDFs, Fresnel equations, microfacets
