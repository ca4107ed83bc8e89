//! Shaders without the branches that their constants exclude.
//!
//! A kernel has parts that its scene does not need ([`Parts`]): they are in branches on constants.
//! Drivers find that out only after they have put all functions into one, so what a scene does not
//! need would cost much of the time of compiling its kernels. Here such branches are replaced by
//! the block that is taken, and functions that nothing calls any more are left out.
//!
//! [`Parts`]: crate::shaders::Parts

use std::collections::HashMap;

use wgpu::naga::compact::{KeepUnused, compact};
use wgpu::naga::front::wgsl;
use wgpu::naga::{
    Arena, BinaryOperator, Block, Constant, Expression, Function, Handle, Literal, LocalVariable, Module,
    Span, Statement, UnaryOperator,
};

/// The module of a shader, without what never runs. The error says where the shader is wrong.
pub fn parsed(source: &str) -> Result<Module, String> {
    let mut module = wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    prune(&mut module);
    Ok(module)
}

fn prune(module: &mut Module) {
    let Module { functions, entry_points, constants, global_expressions, .. } = module;
    let all = functions.iter_mut().map(|(_, function)| function);
    for function in all.chain(entry_points.iter_mut().map(|entry| &mut entry.function)) {
        let body = std::mem::take(&mut function.body);
        let mut pruning = Pruning { function, constants, global_expressions, known: HashMap::new() };
        function.body = pruning.block(body);
        // The names of values would keep those that are left out.
        function.named_expressions.clear();
    }
    compact(module, KeepUnused::No);
}

/// The bindings of the first group that an entry point of a module uses.
pub fn bindings(module: &Module, entry: &str) -> Vec<u32> {
    let mut alone = module.clone();
    alone.entry_points.retain(|other| other.name == entry);
    compact(&mut alone, KeepUnused::No);
    alone.global_variables.iter().filter_map(|(_, variable)| Some(variable.binding?.binding)).collect()
}

/// A function whose branches are replaced.
struct Pruning<'a> {
    function: &'a Function,
    constants: &'a Arena<Constant>,
    global_expressions: &'a Arena<Expression>,
    /// The results of `&&` and `||`, which are variables without a name that a branch sets.
    known: HashMap<Handle<LocalVariable>, bool>,
}

impl Pruning<'_> {
    fn block(&mut self, block: Block) -> Block {
        let mut pruned = Block::with_capacity(block.len());
        for (statement, span) in block.span_into_iter() {
            let ends = self.statement(statement, span, &mut pruned);
            // Nothing may follow.
            if ends {
                break;
            }
        }
        pruned
    }

    /// Adds what is left of a statement to a block; whether the block ends with it.
    fn statement(&mut self, statement: Statement, span: Span, pruned: &mut Block) -> bool {
        let statement = match statement {
            Statement::If { condition, accept, reject } => match self.value(condition) {
                Some(is_accepted) => {
                    let taken = if is_accepted { accept } else { reject };
                    let ends = taken.span_into_iter().any(|(statement, span)| {
                        if let Statement::Store { pointer, value } = statement {
                            self.learn(pointer, value);
                        }
                        self.statement(statement, span, pruned)
                    });
                    return ends;
                }
                None => Statement::If { condition, accept: self.block(accept), reject: self.block(reject) },
            },
            Statement::Block(block) => Statement::Block(self.block(block)),
            Statement::Switch { selector, mut cases } => {
                for case in &mut cases {
                    case.body = self.block(std::mem::take(&mut case.body));
                }
                Statement::Switch { selector, cases }
            }
            Statement::Loop { body, continuing, break_if } => {
                let (body, continuing) = (self.block(body), self.block(continuing));
                Statement::Loop { body, continuing, break_if }
            }
            other => other,
        };
        let ends = ends(&statement);
        pruned.push(statement, span);
        ends
    }

    /// Remembers the result of an operator whose first operand is constant: the branch that sets it
    /// runs wherever the result is used.
    fn learn(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) {
        if let Expression::LocalVariable(variable) = self.function.expressions[pointer]
            && self.function.local_variables[variable].name.is_none()
            && let Some(value) = self.value(value)
        {
            self.known.insert(variable, value);
        }
    }

    /// The value of a condition, if it is constant.
    fn value(&self, condition: Handle<Expression>) -> Option<bool> {
        match self.function.expressions[condition] {
            Expression::Literal(Literal::Bool(value)) => Some(value),
            Expression::Constant(constant) => match self.global_expressions[self.constants[constant].init] {
                Expression::Literal(Literal::Bool(value)) => Some(value),
                _ => None,
            },
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => self.value(expr).map(|value| !value),
            Expression::Binary { op: BinaryOperator::LogicalAnd, left, right } => {
                Some(self.value(left)? && self.value(right)?)
            }
            Expression::Binary { op: BinaryOperator::LogicalOr, left, right } => {
                Some(self.value(left)? || self.value(right)?)
            }
            Expression::Load { pointer } => match self.function.expressions[pointer] {
                Expression::LocalVariable(variable) => self.known.get(&variable).copied(),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether nothing may follow a statement in its block.
fn ends(statement: &Statement) -> bool {
    match statement {
        Statement::Block(block) => block.last().is_some_and(ends),
        Statement::Return { .. } | Statement::Break | Statement::Continue | Statement::Kill => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;

    const TEXT: &str = "
        const HAS = true;
        const HAS_NOT = false;
        @group(0) @binding(0) var<storage, read_write> used: array<u32>;
        @group(0) @binding(1) var<storage, read_write> unused: array<u32>;
        @group(0) @binding(2) var<storage, read_write> of_other: array<u32>;
        fn called_if(x: u32) -> bool { return x > 1; }
        fn called_never(x: u32) -> bool { return unused[x] > 1; }
        fn called_after(x: u32) -> u32 { return x + unused[x]; }
        fn called_last(x: u32) -> u32 { return x + 2; }
        fn early(x: u32) -> u32 {
            if (!HAS_NOT || called_never(x)) {
                { return called_last(x); }
            }
            return called_after(x);
        }
        @compute @workgroup_size(1) fn main() {
            let x = used[0];
            for (var i = 0u; i < x; i++) {
                if ((HAS_NOT && called_never(i)) || (HAS && called_if(i))) {
                    used[i] = early(i);
                } else if (HAS_NOT) {
                    let never = called_after(i);
                    used[i] = never;
                } else {
                    continue;
                }
            }
        }
        @compute @workgroup_size(1) fn other() { of_other[0] = 1; }";

    #[test]
    fn branches_that_constants_exclude_are_left_out() {
        let module = parsed(TEXT).expect("a shader");
        let names: Vec<&str> =
            module.functions.iter().filter_map(|(_, function)| function.name.as_deref()).collect();
        assert_eq!(names, ["called_if", "called_last", "early"]);
        assert_eq!(bindings(&module, "main"), [0]);
        assert_eq!(bindings(&module, "other"), [2]);
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        validator.validate(&module).expect("a valid module");
        // What follows a return is left out with it.
        let early = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some("early"));
        let body = &early.expect("a function").1.body;
        assert!(body.last().is_some_and(ends), "{body:?}");
        assert!(body.iter().all(|statement| !matches!(statement, Statement::If { .. })), "{body:?}");
    }
}
