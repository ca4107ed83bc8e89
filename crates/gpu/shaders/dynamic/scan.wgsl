// Sums over the threads of a workgroup.

const THREADS = 256u;

var<workgroup> sums: array<u32, THREADS>;

// The sum of the numbers of the threads up to this one. All threads call it.
fn sum_up_to(local: u32, number: u32) -> u32 {
    sums[local] = number;
    workgroupBarrier();
    for (var distance = 1u; distance < THREADS; distance *= 2) {
        var before = 0u;
        if (local >= distance) {
            before = sums[local - distance];
        }
        workgroupBarrier();
        sums[local] += before;
        workgroupBarrier();
    }
    return sums[local];
}
