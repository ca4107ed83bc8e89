// How often each digit occurs in each block: the counts of a digit side by side.

@group(0) @binding(1) var<storage, read_write> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;

var<workgroup> count_of: array<atomic<u32>, DIGITS>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) block: vec3u, @builtin(local_invocation_index) local: u32) {
    for (var round = 0u; round < ROUNDS; round++) {
        let i = BLOCK * block.x + DIGITS * round + local;
        if (i < plan.count) {
            atomicAdd(&count_of[digit_of(keys[i])], 1u);
        }
    }
    workgroupBarrier();
    counts[plan.blocks * local + block.x] = atomicLoad(&count_of[local]);
}
