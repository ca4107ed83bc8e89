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

// The samples of a rectangle of pixels, of each as many as of the others from an index on; and the
// places for paths. Each sample has a number: those of the first index come first, row by row.
struct Batch {
    low: vec2u,
    size: vec2u,
    index: u32,
    samples: u32,
    places: u32,
    // The kinds of materials that are hit, a bit for each, and the number of queues of hits.
    kinds: u32,
    sorts: u32,
    // Of a turn: the number of the first sample that begins and how many do, the paths that go on,
    // and the shadow rays of the turn before.
    first: u32,
    beginning: u32,
    going_on: u32,
    shadows: u32,
    lengths: array<atomic<u32>, QUEUES>,
    queues: array<u32>,
}

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
