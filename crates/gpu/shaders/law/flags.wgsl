// Translated from crates/scattering/src/flags.rs
// by `cargo xtask wgsl`, which translates it again.

const BxdfFlags_NONE: u32 = 0;

const BxdfFlags_REFLECTION: u32 = 1;

const BxdfFlags_TRANSMISSION: u32 = 1 << 1;

const BxdfFlags_DIFFUSE: u32 = 1 << 2;

const BxdfFlags_GLOSSY: u32 = 1 << 3;

const BxdfFlags_SPECULAR: u32 = 1 << 4;

const BxdfFlags_DIFFUSE_REFLECTION: u32 = BxdfFlags_DIFFUSE | BxdfFlags_REFLECTION;

const BxdfFlags_DIFFUSE_TRANSMISSION: u32 = BxdfFlags_DIFFUSE | BxdfFlags_TRANSMISSION;

const BxdfFlags_GLOSSY_REFLECTION: u32 = BxdfFlags_GLOSSY | BxdfFlags_REFLECTION;

const BxdfFlags_GLOSSY_TRANSMISSION: u32 = BxdfFlags_GLOSSY | BxdfFlags_TRANSMISSION;

const BxdfFlags_SPECULAR_REFLECTION: u32 = BxdfFlags_SPECULAR | BxdfFlags_REFLECTION;

const BxdfFlags_SPECULAR_TRANSMISSION: u32 = BxdfFlags_SPECULAR | BxdfFlags_TRANSMISSION;

// The same set in all lanes.
fn BxdfFlags_splat(flags: u32) -> u32 {
    return u32(flags);
}

// `flags` where the mask is true, else no scattering.
fn BxdfFlags_only_where(mask: bool, flags: u32) -> u32 {
    return BxdfFlags_choose(mask, flags, BxdfFlags_NONE);
}

// `a` where the mask is true, else `b`.
fn BxdfFlags_select(mask: bool, a: u32, b: u32) -> u32 {
    return select(b, a, mask);
}

// `a` where the mask is true, else `b`, each the same in all lanes.
fn BxdfFlags_choose(mask: bool, a: u32, b: u32) -> u32 {
    return BxdfFlags_select(mask, BxdfFlags_splat(a), BxdfFlags_splat(b));
}

// Whether every kind of `other` is in this set.
fn BxdfFlags_contains(this_: u32, other: u32) -> bool {
    let other_1 = u32(other);
    return (this_ & other_1) == other_1;
}

// Whether some kind of `other` is in this set.
fn BxdfFlags_intersects(this_: u32, other: u32) -> bool {
    return !((this_ & u32(other)) == 0u);
}

// Whether light is reflected.
fn BxdfFlags_is_reflective(this_: u32) -> bool {
    return BxdfFlags_contains(this_, BxdfFlags_REFLECTION);
}

// Whether light is transmitted.
fn BxdfFlags_is_transmissive(this_: u32) -> bool {
    return BxdfFlags_contains(this_, BxdfFlags_TRANSMISSION);
}

// Whether there is a diffuse lobe.
fn BxdfFlags_is_diffuse(this_: u32) -> bool {
    return BxdfFlags_contains(this_, BxdfFlags_DIFFUSE);
}

// Whether there is a glossy lobe.
fn BxdfFlags_is_glossy(this_: u32) -> bool {
    return BxdfFlags_contains(this_, BxdfFlags_GLOSSY);
}

// Whether there is a specular lobe.
fn BxdfFlags_is_specular(this_: u32) -> bool {
    return BxdfFlags_contains(this_, BxdfFlags_SPECULAR);
}

// Whether there is a lobe for which `f` is not zero: a diffuse or glossy one.
fn BxdfFlags_is_non_specular(this_: u32) -> bool {
    return BxdfFlags_intersects(this_, BxdfFlags_DIFFUSE | BxdfFlags_GLOSSY);
}

const Directions_All = 0u;
const Directions_Reflection = 1u;
const Directions_Transmission = 2u;

// Whether reflection may be sampled.
fn Directions_reflection(this_: u32) -> bool {
    return this_ != Directions_Transmission;
}

// Whether transmission may be sampled.
fn Directions_transmission(this_: u32) -> bool {
    return this_ != Directions_Reflection;
}

// Whether a BxDF with `flags` scatters to some of these directions.
fn Directions_meet(this_: u32, flags: u32) -> bool {
    if (this_ == Directions_All) {
        return BxdfFlags_intersects(flags, BxdfFlags_REFLECTION | BxdfFlags_TRANSMISSION);
    } else if (this_ == Directions_Reflection) {
        return BxdfFlags_is_reflective(flags);
    } else {
        return BxdfFlags_is_transmissive(flags);
    }
}

// The probability of reflection, where reflection has the weight `r` and transmission `t`, and
// lobes that are not requested the weight 0; and where there is one: not where all weights are
// 0.
fn Directions_probability_of_reflection(this_: u32, r: f32, t: f32) -> Tuple_f32_bool {
    var chosen: f32;
    if (Directions_reflection(this_)) {
        chosen = r;
    } else {
        chosen = 0.0f;
    }
    let r_1 = chosen;
    var chosen_1: f32;
    if (Directions_transmission(this_)) {
        chosen_1 = t;
    } else {
        chosen_1 = 0.0f;
    }
    let t_1 = chosen_1;
    return Tuple_f32_bool(r_1 / (r_1 + t_1), (r_1 + t_1) > 0.0f);
}

const TransportMode_Radiance = 0u;
const TransportMode_Importance = 1u;

// The mode of paths from the other end.
fn TransportMode_not(this_: u32) -> u32 {
    if (this_ == TransportMode_Radiance) {
        return TransportMode_Importance;
    } else {
        return TransportMode_Radiance;
    }
}
