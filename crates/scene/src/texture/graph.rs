//! The texture graph while a scene is compiled, and the programs compiled from it.
//!
//! Nodes are hash-consed: a new node that equals an earlier one is replaced by it, so that all
//! textures share common subexpressions. Constants are folded when a node is created, by the
//! floating-point operations that the program would have done. Operands come before the nodes that
//! use them: ascending node numbers are an order of evaluation, and nothing is recursive.
//!
//! A program visits the nodes below its root depth first and emits each after its operands. The
//! operand that needs the most slots comes first, so that a chain of any length needs few ([Sethi
//! 1970]). A slot is free again after the last operation that reads it. Constants are loaded again
//! for each use, as keeping them would occupy slots for longer.

use super::program::{Code, MAX_SLOTS, Operation, Program, Textures, mix};
use spectrum::Spectrum;
use std::collections::HashMap;
use std::mem::{Discriminant, discriminant};

/// The largest number of operations of a program.
pub const MAX_OPERATIONS: usize = 4096;

/// The largest number of operations of all programs of a scene.
pub const MAX_TOTAL_OPERATIONS: usize = 1 << 24;

/// Index of a node of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct NodeId(u32);

#[derive(Clone, Copy, Debug)]
struct Node {
    code: Code,
    /// Unused operands are node 0.
    operands: [NodeId; 4],
}

impl Node {
    fn operands(&self) -> &[NodeId] {
        &self.operands[..self.code.operand_count()]
    }

    fn is_number(&self) -> bool {
        matches!(self.code, Code::Number(_))
    }
}

/// A node's content, with numbers as their bits.
type NodeKey = (Discriminant<Code>, u32, [NodeId; 4]);

/// Why a texture has no program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ProgramError {
    /// More than [`MAX_OPERATIONS`].
    Operations,
    /// More than [`MAX_SLOTS`] values at once.
    Slots,
    /// More than [`MAX_TOTAL_OPERATIONS`].
    TotalOperations,
}

/// A hash index of a table: the positions of entries, by a hash of their content.
#[derive(Debug, Default)]
pub(super) struct Index(HashMap<[u32; 4], Vec<u32>>);

impl Index {
    /// The index of `entry` in `table`; it is added unless the table has an equal one.
    pub fn intern<T: PartialEq>(&mut self, table: &mut Vec<T>, entry: T, hash: [f32; 4]) -> u32 {
        let bucket = self.0.entry(hash.map(f32::to_bits)).or_default();
        if let Some(&known) = bucket.iter().find(|&&known| table[known as usize] == entry) {
            return known;
        }
        let index = table.len() as u32;
        table.push(entry);
        bucket.push(index);
        index
    }
}

/// Nodes, and the textures that are compiled from them.
#[derive(Debug, Default)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    ids: HashMap<NodeKey, NodeId>,
    spectra: Index,
    programs: HashMap<NodeId, u32>,
    /// The tables, with programs only for nodes in use.
    pub textures: Textures,
}

impl Graph {
    /// The node of a number, which is also the spectrum that has this value at all wavelengths.
    pub fn number(&mut self, value: f32) -> NodeId {
        self.node(Code::Number(value), &[])
    }

    /// The node of a spectrum.
    pub fn spectrum(&mut self, spectrum: Spectrum) -> NodeId {
        if let Spectrum::Constant(value) = spectrum {
            return self.number(value);
        }
        let hash = [420.0, 500.0, 580.0, 660.0].map(|lambda| spectrum.at(lambda));
        let index = self.spectra.intern(&mut self.textures.spectra, spectrum, hash);
        self.node(Code::Spectrum(index), &[])
    }

    /// `texture` times the number `scale`.
    pub fn scale(&mut self, texture: NodeId, scale: NodeId) -> NodeId {
        match (self.value(texture), self.value(scale)) {
            (Some(texture), Some(scale)) => self.number(texture * scale),
            (_, Some(1.0)) => texture,
            (Some(1.0), _) => scale,
            _ => self.node(Code::Scale, &[texture, scale]),
        }
    }

    /// 1 where the number `texture` is at least `edge`, else 0.
    pub fn step(&mut self, texture: NodeId, edge: f32) -> NodeId {
        match self.value(texture) {
            Some(value) => self.number(f32::from(u8::from(value >= edge))),
            None => self.node(Code::Step(edge), &[texture]),
        }
    }

    /// (1 − `amount`)·first + `amount`·second.
    pub fn mix(&mut self, [first, second]: [NodeId; 2], amount: NodeId) -> NodeId {
        match (self.value(first), self.value(second), self.value(amount)) {
            (_, _, Some(0.0)) => first,
            (_, _, Some(1.0)) => second,
            (Some(a), Some(b), Some(amount)) => self.number(mix([a, b], amount)),
            _ => self.node(Code::Mix, &[first, second, amount]),
        }
    }

    /// A node with this content.
    pub fn node(&mut self, code: Code, operands: &[NodeId]) -> NodeId {
        let mut padded = [NodeId(0); 4];
        padded[..operands.len()].copy_from_slice(operands);
        let payload = match code {
            Code::Number(value) | Code::Step(value) => value.to_bits(),
            Code::Spectrum(index)
            | Code::FloatImage(index)
            | Code::SpectrumImage(index)
            | Code::Squares(index)
            | Code::Cubes(index)
            | Code::Dots(index)
            | Code::Facing(index)
            | Code::Fbm(index)
            | Code::Wrinkled(index)
            | Code::Windy(index)
            | Code::Marble(index)
            | Code::Bilerp(index) => index,
            Code::Scale | Code::Mix => 0,
        };
        let next = NodeId(self.nodes.len() as u32);
        let id = *self.ids.entry((discriminant(&code), payload, padded)).or_insert(next);
        if id == next {
            self.nodes.push(Node { code, operands: padded });
        }
        id
    }

    /// The number that a node is, if it is a constant.
    pub fn value(&self, id: NodeId) -> Option<f32> {
        match self.nodes[id.0 as usize].code {
            Code::Number(value) => Some(value),
            _ => None,
        }
    }

    /// Index of the program that evaluates a node.
    pub fn program(&mut self, root: NodeId) -> Result<u32, ProgramError> {
        if let Some(&program) = self.programs.get(&root) {
            return Ok(program);
        }
        let operations = Schedule::new(&self.nodes, root)?.operations()?;
        let textures = &mut self.textures;
        if textures.operations.len() + operations.len() > MAX_TOTAL_OPERATIONS {
            return Err(ProgramError::TotalOperations);
        }
        let index = textures.programs.len() as u32;
        textures
            .programs
            .push(Program { first: textures.operations.len() as u32, length: operations.len() as u32 });
        textures.operations.extend(operations);
        self.programs.insert(root, index);
        Ok(index)
    }
}

/// Scheduling data of a node of a program.
#[derive(Clone, Copy, Default)]
struct Need {
    /// Number of operations that still have to read it.
    uses: u32,
    /// Slots that its evaluation needs if nothing is shared.
    slots: u32,
    /// The slot of its value, once it is computed.
    slot: Option<u8>,
}

/// The nodes below a root, in the order in which they are evaluated.
struct Schedule<'a> {
    nodes: &'a [Node],
    root: NodeId,
    needs: HashMap<NodeId, Need>,
}

impl<'a> Schedule<'a> {
    fn new(nodes: &'a [Node], root: NodeId) -> Result<Self, ProgramError> {
        let mut needs = HashMap::from([(root, Need { uses: 1, ..Need::default() })]);
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            for &operand in nodes[id.0 as usize].operands() {
                let need = needs.entry(operand).or_default();
                need.uses += 1;
                if need.uses == 1 {
                    open.push(operand);
                }
            }
            if needs.len() > MAX_OPERATIONS {
                return Err(ProgramError::Operations);
            }
        }
        let mut ascending: Vec<NodeId> = needs.keys().copied().collect();
        ascending.sort_unstable();
        for id in ascending {
            let mut slots: Vec<u32> =
                nodes[id.0 as usize].operands().iter().map(|operand| needs[operand].slots).collect();
            slots.sort_unstable_by(|a, b| b.cmp(a));
            let slots = (0..).zip(slots).map(|(kept, slots)| kept + slots).max().unwrap_or(0).max(1);
            needs.entry(id).or_default().slots = slots;
        }
        Ok(Self { nodes, root, needs })
    }

    fn operations(mut self) -> Result<Vec<Operation>, ProgramError> {
        let mut operations = Vec::with_capacity(self.needs.len());
        let mut free = u64::MAX >> (64 - MAX_SLOTS);
        // The stack of the depth-first traversal: each node is an operand of the one before it, and
        // has its operands in the order of evaluation and the number of those visited.
        let mut path = vec![self.step(self.root)];
        while let Some((id, order, done)) = path.last_mut() {
            if let Some(&operand) = order.get(*done) {
                *done += 1;
                if self.needs[&operand].slot.is_none() {
                    let step = self.step(operand);
                    path.push(step);
                }
                continue;
            }
            let id = *id;
            path.pop();
            let node = &self.nodes[id.0 as usize];
            let mut operation = Operation { code: node.code, target: 0, operands: [0; 4] };
            for (slot, operand) in operation.operands.iter_mut().zip(node.operands()) {
                let need = self.needs.entry(*operand).or_default();
                *slot = need.slot.unwrap_or_default();
            }
            for operand in node.operands() {
                let need = self.needs.entry(*operand).or_default();
                need.uses -= 1;
                if need.uses == 0 || self.nodes[operand.0 as usize].is_number() {
                    free |= need.slot.take().map_or(0, |slot| 1_u64 << slot);
                }
            }
            if free == 0 {
                return Err(ProgramError::Slots);
            }
            operation.target = free.trailing_zeros() as u8;
            free &= free - 1;
            self.needs.entry(id).or_default().slot = Some(operation.target);
            operations.push(operation);
            if operations.len() > MAX_OPERATIONS {
                return Err(ProgramError::Operations);
            }
        }
        Ok(operations)
    }

    /// A stack entry: a node with its operands in descending order of the slots that they need.
    fn step(&self, id: NodeId) -> (NodeId, Vec<NodeId>, usize) {
        let mut order = self.nodes[id.0 as usize].operands().to_vec();
        order.sort_by_key(|operand| std::cmp::Reverse(self.needs[operand].slots));
        (id, order, 0)
    }
}
