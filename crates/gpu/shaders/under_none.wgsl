// In place of paths under surfaces in kernels of scenes that have no bodies.

const GOES_ON = 0u;
const LEAVES = 2u;

fn stay_above() {
}

fn is_under() -> bool {
    return false;
}

fn emerges() -> bool {
    return false;
}

fn reach_of_path() -> f32 {
    return infinity();
}

fn exit_lobe(s: Surface) -> Bsdf {
    return Bsdf();
}

fn enters_body(bsdf: Bsdf, s: Surface, sample: BsdfSample) -> bool {
    return false;
}

fn go_under(path: ptr<function, Path>, s: Surface, bsdf: Bsdf, lambda: SampledWavelengths) -> bool {
    return false;
}

fn follow_under(path: ptr<function, Path>, is_hit: bool, s: Surface) -> u32 {
    return GOES_ON;
}
