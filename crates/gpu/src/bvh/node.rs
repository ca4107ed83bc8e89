//! Nodes of eight children with quantised boxes ([Ylitie et al. 2017]).
//!
//! The words of a node are, in six quadruples:
//!
//! | words | what |
//! |---|---|
//! | 0–2 | the low corner of the node's box, as floats |
//! | 3 | a byte for each axis, the biased exponent of a step's size 2ᵉ; and the stack's entries |
//! | 4–9 | a byte for each child, two words for each of the low planes of x, y and z in steps |
//! | 10–15 | the same of the high planes |
//! | 16–23 | the references of the children |
//!
//! The stack's entries are those that a ray needs below one of the children, however many others
//! wait: for each node below one, of which all children wait together.

use math::Bounds3;

use super::binary::{Below, Binary};
use super::{COUNT_BITS, Words};

/// Children of a node.
const WIDTH: usize = 8;

/// The bits of references to leaves of triangles and of items. The first primitive and
/// the number of primitives follow.
pub const TRIANGLES: u32 = 1 << 31;
pub const ITEMS: u32 = 3 << 30;

/// A leaf of nothing.
pub const EMPTY: u32 = TRIANGLES;

/// The reference of a leaf; `None` where it has too many primitives, or those before it are too
/// many.
pub fn leaf(bits: u32, first: usize, count: usize) -> Option<u32> {
    let fits = first < 1 << (30 - COUNT_BITS) && count < 1 << COUNT_BITS;
    fits.then_some(bits | (first as u32) << COUNT_BITS | count as u32)
}

/// Whether a reference is one to a leaf.
pub fn is_leaf(reference: u32) -> bool {
    reference & TRIANGLES != 0
}

/// What writes trees into a buffer of nodes.
pub struct Writer<'a> {
    nodes: &'a mut Vec<Words>,
    /// The bits of references to leaves.
    leaf: u32,
    /// The index of the first primitive.
    first: usize,
    /// The entries that a ray's stack needs for a leaf; and, when a tree is written, for its root.
    pub stack: usize,
}

impl<'a> Writer<'a> {
    pub fn new(nodes: &'a mut Vec<Words>, leaf: u32, first: usize, stack: usize) -> Self {
        Self { nodes, leaf, first, stack }
    }

    /// Writes a tree; the reference of its root. `None` where there are too many primitives.
    pub fn root(&mut self, tree: &Binary) -> Option<u32> {
        let Some(root) = tree.root() else { return Some(EMPTY) };
        let (reference, stack) = self.write(tree, root)?;
        self.stack = stack;
        Some(reference)
    }

    /// Writes what is below a binary node; its reference, and the entries that a ray's stack needs
    /// for it.
    fn write(&mut self, tree: &Binary, index: usize) -> Option<(u32, usize)> {
        let halves = match &tree.node(index).below {
            Below::Primitives(range) => {
                let leaf = leaf(self.leaf, self.first + range.start, range.len());
                return leaf.map(|leaf| (leaf, self.stack));
            }
            Below::Nodes(halves) => halves,
        };
        // The largest child is opened until there are enough; of those that are as large, the one
        // that has waited longest, so that the tree is not deep.
        let mut children = halves.to_vec();
        while children.len() < WIDTH {
            let inner =
                children.iter().enumerate().filter_map(|(place, &child)| match &tree.node(child).below {
                    Below::Nodes(halves) => Some((place, *halves, tree.node(child).bounds.surface_area())),
                    Below::Primitives(_) => None,
                });
            let largest = inner.rev().max_by(|a, b| a.2.total_cmp(&b.2));
            let Some((place, halves, _)) = largest else { break };
            children.remove(place);
            children.extend(halves);
        }
        let node = self.nodes.len() / 6;
        self.nodes.resize(6 * (node + 1), [0; 4]);
        let boxes: Vec<Bounds3> = children.iter().map(|&child| tree.node(child).bounds).collect();
        let (mut references, mut stack) = ([EMPTY; WIDTH], 0);
        for (reference, &child) in references.iter_mut().zip(&children) {
            let (written, needed) = self.write(tree, child)?;
            *reference = written;
            stack = stack.max(needed);
        }
        let words = quantised(&tree.node(index).bounds, &boxes, references, stack);
        self.nodes[6 * node..].iter_mut().zip(words).for_each(|(place, words)| *place = words);
        // All children wait together at least.
        Some((node as u32, 1 + stack))
    }
}

/// A node with these children, of which one needs so many entries of a ray's stack.
fn quantised(bounds: &Bounds3, boxes: &[Bounds3], references: [u32; WIDTH], stack: usize) -> [Words; 6] {
    let steps = [0, 1, 2].map(|axis| step(bounds.min[axis], bounds.max[axis]));
    let mut planes = [[[0u8; WIDTH]; 3]; 2];
    for axis in 0..3 {
        for (child, inside) in boxes.iter().enumerate() {
            let [low, high] =
                quantised_slab(bounds.min[axis], steps[axis], inside.min[axis], inside.max[axis]);
            (planes[0][axis][child], planes[1][axis][child]) = (low, high);
        }
    }
    let mut words = [0; 24];
    words[..3].copy_from_slice(&bounds.min.to_array().map(f32::to_bits));
    words[3] = (0..3).map(|axis| steps[axis].to_bits() >> 23 << (8 * axis)).sum();
    words[3] |= (stack.min(255) as u32) << 24;
    for (word, bytes) in words[4..16].iter_mut().zip(planes.as_flattened().as_flattened().chunks_exact(4)) {
        *word = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    }
    words[16..].copy_from_slice(&references);
    std::array::from_fn(|i| std::array::from_fn(|j| words[4 * i + j]))
}

/// The smallest power of two of which 255 steps lead from `min` to `max`, as floats are added.
fn step(min: f32, max: f32) -> f32 {
    let mut step = f32::MIN_POSITIVE;
    while min + 255.0 * step < max {
        step *= 2.0;
    }
    step
}

/// The numbers of steps to planes around a slab.
fn quantised_slab(origin: f32, step: f32, min: f32, max: f32) -> [u8; 2] {
    let plane = |steps: u8| origin + f32::from(steps) * step;
    let mut low = ((min - origin) / step) as u8;
    while low > 0 && plane(low) > min {
        low -= 1;
    }
    let mut high = ((max - origin) / step) as u8;
    while high < 255 && plane(high) < max {
        high += 1;
    }
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    #[test]
    fn quantised_slabs_contain_exact_ones() {
        let mut random = Random::new(1);
        for scale in [1e-30, 1e-3, 1.0, 1e6, 1e30] {
            for _ in 0..1000 {
                let [a, b] = random.get_2d().map(|u| (u - 0.3) * scale);
                let (origin, end) = (a.min(b), a.max(b));
                let step = step(origin, end);
                let inside = random.get_2d().map(|u| origin + u * (end - origin));
                let (min, max) = (inside[0].min(inside[1]), inside[0].max(inside[1]).min(end));
                let [low, high] =
                    quantised_slab(origin, step, min, max).map(|n| origin + f32::from(n) * step);
                assert!(low <= min && max <= high, "{min} {max} in {low} {high}");
                assert!(max - min + 4.0 * step >= high - low, "{min} {max} in {low} {high}");
            }
        }
    }

    #[test]
    fn flat_boxes_have_planes() {
        assert_eq!(quantised_slab(0.7, step(0.7, 0.7), 0.7, 0.7), [0, 0]);
    }
}
