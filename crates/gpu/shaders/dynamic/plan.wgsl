// What the kernels that build a tree share.

struct Plan {
    // Primitives, and the leaves of the pyramid: a power of two.
    count: u32,
    leaves: u32,
    // Which of the runs of a kernel this is: the digit that is sorted by, from the lowest on; the
    // part of the pyramid, from its base on; the level of nodes, from the root on.
    step: u32,
    // Blocks of keys.
    blocks: u32,
    // The first of the items or triangles, and of the nodes.
    first_item: u32,
    first_node: u32,
    // The bits of references to leaves, and the entries of a ray's stack that a leaf needs.
    leaf_bits: u32,
    leaf_stack: u32,
}

@group(0) @binding(0) var<uniform> plan: Plan;
