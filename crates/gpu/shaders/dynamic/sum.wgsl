// Of the counts of a digit, those of the blocks before each; and after all counts, the sum for each
// digit. A workgroup has a digit.

@group(0) @binding(1) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) digit: vec3u, @builtin(local_invocation_index) local: u32) {
    var before = 0u;
    for (var first = 0u; first < plan.blocks; first += THREADS) {
        let block = first + local;
        let at = plan.blocks * digit.x + block;
        var count = 0u;
        if (block < plan.blocks) {
            count = counts[at];
        }
        let sum = sum_up_to(local, count);
        if (block < plan.blocks) {
            counts[at] = before + sum - count;
        }
        before += sums[THREADS - 1];
        workgroupBarrier();
    }
    if (local == 0) {
        counts[plan.blocks * DIGITS + digit.x] = before;
    }
}
