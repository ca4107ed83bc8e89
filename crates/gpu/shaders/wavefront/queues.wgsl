// The queues of a wavefront: of the paths whose rays are extended next, of the places of those that
// have ended, of shadow rays, and of what rays have hit, by kinds of materials.
//
// Stages append to queues that are empty when they begin, each workgroup's paths together, so that
// those that have ended leave no gap. In which order paths are in a queue depends on threads, what
// they find does not.

const PATHS = 0u;
const ENDED = 1u;
const SHADOWS = 2u;
const HITS = 3u;
const QUEUES = 17u;

@group(0) @binding(5) var<storage, read_write> batch: Batch;

// No path: what threads have beyond the end of a queue.
const NO_PATH = 0xffffffffu;

// The path at a place of a queue of this length.
fn path_in(queue: u32, i: u32, length: u32) -> u32 {
    if (i >= length) {
        return NO_PATH;
    }
    return batch.queues[queue * batch.places + i];
}
