// Takes keys and their values to their places: after those of lower digits, and of the same digit
// after those of the blocks before, and after those before it in its block.

@group(0) @binding(1) var<storage, read_write> counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> keys: array<u32>;
@group(0) @binding(3) var<storage, read_write> values: array<u32>;
@group(0) @binding(4) var<storage, read_write> sorted_keys: array<u32>;
@group(0) @binding(5) var<storage, read_write> sorted_values: array<u32>;

// For each digit, a bit for each thread whose key has it.
const WORDS = 8u;
var<workgroup> threads_of: array<atomic<u32>, 2048>;

// The place of the next key with each digit.
var<workgroup> places: array<u32, DIGITS>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) block: vec3u, @builtin(local_invocation_index) local: u32) {
    let total = counts[plan.blocks * DIGITS + local];
    places[local] = sum_up_to(local, total) - total + counts[plan.blocks * local + block.x];
    for (var round = 0u; round < ROUNDS; round++) {
        for (var word = 0u; word < WORDS; word++) {
            atomicStore(&threads_of[WORDS * local + word], 0u);
        }
        workgroupBarrier();
        let i = BLOCK * block.x + DIGITS * round + local;
        var key = 0u;
        if (i < plan.count) {
            key = keys[i];
            atomicOr(&threads_of[WORDS * digit_of(key) + local / 32], 1u << (local & 31));
        }
        workgroupBarrier();
        if (i < plan.count) {
            let digit = digit_of(key);
            let own = atomicLoad(&threads_of[WORDS * digit + local / 32]);
            var place = places[digit] + countOneBits(own & ((1u << (local & 31)) - 1));
            for (var word = 0u; word < local / 32; word++) {
                place += countOneBits(atomicLoad(&threads_of[WORDS * digit + word]));
            }
            sorted_keys[place] = key;
            sorted_values[place] = values[i];
        }
        workgroupBarrier();
        for (var word = 0u; word < WORDS; word++) {
            places[local] += countOneBits(atomicLoad(&threads_of[WORDS * local + word]));
        }
    }
}
