// The binary tree: a child of it is an inner node, or a leaf, which is a place in the order of
// Morton codes.

const IS_LEAF = 0x80000000u;

// The other end of the primitives of an inner node, of which one has the node's own index; and the
// last primitive of its first child.
struct Inner {
    end: u32,
    split: u32,
}

// The children of an inner node.
fn halves(index: u32, inner: Inner) -> vec2u {
    let ends = vec2u(min(index, inner.end), max(index, inner.end));
    let children = vec2u(inner.split, inner.split + 1);
    return select(children, children | vec2u(IS_LEAF), children == ends);
}
