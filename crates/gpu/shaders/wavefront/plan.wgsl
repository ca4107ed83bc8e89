// Plans a turn: as many paths begin as have ended before, as long as there are samples.

// The workgroups of threads for paths that begin, for all paths, and for shadow rays.
@group(0) @binding(6) var<storage, read_write> workgroups: array<vec4u, 3>;

fn workgroups_for(threads: u32) -> vec4u {
    return vec4u((threads + 63) / 64, 1, 1, 0);
}

@compute @workgroup_size(1)
fn main() {
    batch.first += batch.beginning;
    batch.beginning = min(atomicLoad(&batch.lengths[ENDED]), batch.samples - batch.first);
    batch.going_on = atomicLoad(&batch.lengths[PATHS]);
    let paths = batch.going_on + batch.beginning;
    batch.turns += u32(paths > 0);
    batch.paths += paths;
    batch.shadows = atomicLoad(&batch.lengths[SHADOWS]);
    for (var queue = 0u; queue < QUEUES; queue++) {
        atomicStore(&batch.lengths[queue], 0u);
    }
    workgroups[0] = workgroups_for(batch.beginning);
    workgroups[1] = workgroups_for(batch.going_on + batch.beginning);
    workgroups[2] = workgroups_for(batch.shadows);
}
