//! Bodies of functions: parameters, statements, patterns, and branches.

use std::collections::{BTreeMap, BTreeSet};

use quote::ToTokens;
use syn::{Block, Expr, FnArg, Local, Pat, ReceiverKind, ReturnType, Signature, Stmt};

use super::library::{Constant, Function};
use super::names;
use super::translator::{Translator, documented};
use super::types::Type;
use super::value::{Context, Value, bare};

pub type Result<T> = std::result::Result<T, String>;

/// The translation of one function. Expressions that need statements of WGSL write them first.
pub struct Body<'t, 'a> {
    pub translator: &'t mut Translator<'a>,
    pub context: Context,
    /// The names in WGSL that are variables.
    pub variables: BTreeSet<String>,
    used: BTreeSet<String>,
    lines: Vec<String>,
    depth: usize,
    /// How many functions and closures deep the translation is inlined.
    pub inlined: usize,
}

/// What becomes of the value of a branch.
#[derive(Clone, Copy, PartialEq)]
pub enum Mode {
    Statement,
    Return,
    Value,
}

/// A branch that is taken under a condition.
pub struct Branch<'x> {
    pub condition: Option<String>,
    pub body: &'x Expr,
}

impl<'t, 'a> Body<'t, 'a> {
    fn new(translator: &'t mut Translator<'a>, source: usize, owner: Option<Type>) -> Self {
        let names = translator.names_of(owner);
        Self {
            translator,
            context: Context { source, names, scopes: vec![BTreeMap::new()] },
            variables: BTreeSet::new(),
            used: BTreeSet::new(),
            lines: Vec::new(),
            depth: 1,
            inlined: 0,
        }
    }

    /// A function with its documentation.
    pub fn function(
        translator: &'t mut Translator<'a>,
        function: &Function,
        owner: Option<Type>,
        name: &str,
    ) -> Result<String> {
        let names = translator.names_of(owner.clone());
        let result = match &function.signature.output {
            ReturnType::Default => Type::Unit,
            ReturnType::Type(_, ty) => names.parse(ty).ok_or("the type of the result")?.0,
        };
        let mut body = Self::new(translator, function.source, owner);
        let mut parameters = Vec::new();
        for (i, (ty, is_pointer)) in body.parameter_types(&function.signature)?.into_iter().enumerate() {
            let spelled = body.translator.spell(&ty)?;
            let spelled = if is_pointer { format!("ptr<function, {spelled}>") } else { spelled };
            let input = &function.signature.inputs[i];
            let known = match input {
                FnArg::Receiver(_) => "this_".to_owned(),
                FnArg::Typed(input) => match &*input.pat {
                    Pat::Ident(pattern) => pattern.ident.to_string(),
                    Pat::Wild(_) => format!("unused_{i}"),
                    _ => format!("argument_{i}"),
                },
            };
            let name = body.identifier(&known);
            parameters.push(format!("{name}: {spelled}"));
            let value =
                if is_pointer { Value::Place(format!("(*{name})"), ty) } else { Value::Plain(name, ty) };
            body.bind_parameter(input, value)?;
        }
        if result == Type::Unit {
            body.statements(&function.block.stmts)?;
        } else {
            body.returning_block(&function.block)?;
        }
        let arrow = match result {
            Type::Unit => String::new(),
            ty => format!(" -> {}", body.translator.spell(&ty)?),
        };
        let (parameters, lines) = (parameters.join(", "), body.lines.concat());
        Ok(documented(&function.docs, &format!("fn {name}({parameters}){arrow} {{\n{lines}}}\n")))
    }

    /// A constant.
    pub fn constant(
        translator: &'t mut Translator<'a>,
        constant: &Constant,
        owner: Option<Type>,
        name: &str,
        ty: &Type,
    ) -> Result<String> {
        let mut body = Self::new(translator, constant.source, owner);
        let (value, _) = body.plain(&constant.value)?;
        let spelled = body.translator.spell(ty)?;
        let text = format!("const {name}: {spelled} = {};\n", bare(&value));
        body.lines.is_empty().then_some(text).ok_or("a constant that needs statements".into())
    }

    /// The types of parameters, and which of them are mutable references.
    pub fn parameter_types(&self, signature: &Signature) -> Result<Vec<(Type, bool)>> {
        let types = signature.inputs.iter().map(|input| match input {
            FnArg::Receiver(receiver) => {
                let owner = self.context.names.owner.clone().ok_or("a method without a type")?;
                Ok((owner, matches!(receiver.kind, ReceiverKind::Reference(_, _, Some(_)))))
            }
            FnArg::Typed(input) => {
                let unknown = || format!("the type {}", input.ty.to_token_stream());
                self.context.names.parse(&input.ty).ok_or_else(unknown)
            }
        });
        types.collect()
    }

    /// Gives an argument the name of its parameter.
    pub fn bind_parameter(&mut self, input: &FnArg, value: Value) -> Result<()> {
        match input {
            FnArg::Receiver(receiver) => {
                let is_variable = receiver.mutability.is_some();
                let value = self.stored("this_", value, is_variable)?;
                self.declare("self", value);
                Ok(())
            }
            FnArg::Typed(input) => self.bind(&input.pat, value),
        }
    }

    /// Writes a line.
    pub fn line(&mut self, text: &str) {
        self.lines.push(format!("{}{text}\n", "    ".repeat(self.depth)));
    }

    /// The lines that `write` writes, one level deeper, in a scope of their own.
    pub fn captured<T>(&mut self, write: impl FnOnce(&mut Self) -> Result<T>) -> Result<(Vec<String>, T)> {
        let before = std::mem::take(&mut self.lines);
        self.depth += 1;
        self.context.scopes.push(BTreeMap::new());
        let value = write(self);
        self.context.scopes.pop();
        self.depth -= 1;
        Ok((std::mem::replace(&mut self.lines, before), value?))
    }

    pub fn append(&mut self, lines: Vec<String>) {
        self.lines.extend(lines);
    }

    /// A name in WGSL that is not used yet, like the given one.
    pub fn identifier(&mut self, like: &str) -> String {
        let like = match like.trim_start_matches('_') {
            "" => "i",
            like => like,
        };
        let library = self.translator.library;
        let is_free = |name: &str, used: &BTreeSet<String>| {
            let is_function = |f: &Function| f.owner.is_none() && f.signature.ident == name;
            !used.contains(name) && !names::is_taken(name) && !library.functions.iter().any(is_function)
        };
        let numbered = std::iter::once(like.to_owned()).chain((1..).map(|i| format!("{like}_{i}")));
        let name = numbered.into_iter().find(|name| is_free(name, &self.used)).unwrap_or_default();
        self.used.insert(name.clone());
        name
    }

    /// Lets a name of Rust mean a value.
    pub fn declare(&mut self, name: &str, value: Value) {
        if let Some(scope) = self.context.scopes.last_mut() {
            scope.insert(name.to_owned(), value);
        }
    }

    /// What a name of Rust means.
    pub fn lookup(&self, name: &str) -> Option<Value> {
        self.context.scopes.iter().rev().find_map(|scope| scope.get(name)).cloned()
    }

    /// Keeps a value that is used more than once, or later.
    pub fn stored(&mut self, like: &str, value: Value, is_variable: bool) -> Result<Value> {
        match value {
            Value::Tuple(values) if !is_variable => Ok(Value::Tuple(self.stored_all(like, values)?)),
            Value::Array(values) if !is_variable => Ok(Value::Array(self.stored_all(like, values)?)),
            Value::Plain(text, ty)
                if !is_variable
                    && (names::is_number(&text)
                        || names::is_identifier(&text) && !self.variables.contains(&text)) =>
            {
                Ok(Value::Plain(text, ty))
            }
            Value::Plain(..) | Value::Tuple(_) | Value::Array(_) => {
                let (text, ty) = self.materialized(value)?;
                let name = self.identifier(like);
                let (text, ty) = match ty {
                    Type::Literal => (format!("u32({text})"), Type::Uint),
                    ty => (bare(&text).to_owned(), ty),
                };
                let keyword = if is_variable { "var" } else { "let" };
                self.line(&format!("{keyword} {name} = {text};"));
                if is_variable {
                    self.variables.insert(name.clone());
                }
                Ok(Value::Plain(name, ty))
            }
            other => Ok(other),
        }
    }

    fn stored_all(&mut self, like: &str, values: Vec<Value>) -> Result<Vec<Value>> {
        let numbered = values.into_iter().enumerate();
        numbered.map(|(i, value)| self.stored(&format!("{like}_{i}"), value, false)).collect()
    }

    /// Binds the names of a pattern.
    pub fn bind(&mut self, pattern: &Pat, value: Value) -> Result<()> {
        match pattern {
            Pat::Wild(_) => Ok(()),
            Pat::Ident(pattern) => {
                let name = pattern.ident.to_string();
                let value = self.stored(&name, value, pattern.mutability.is_some())?;
                self.declare(&name, value);
                Ok(())
            }
            Pat::Type(pattern) => self.bind(&pattern.pat, value),
            Pat::Reference(pattern) => self.bind(&pattern.pat, value),
            Pat::Tuple(pattern) => self.bind_all(pattern.elems.iter(), value),
            Pat::Slice(pattern) => self.bind_all(pattern.elems.iter(), value),
            Pat::Struct(pattern) => {
                let value = self.stored("parts", value, false)?;
                for field in &pattern.fields {
                    let part = self.field(value.clone(), &field.member)?;
                    self.bind(&field.pat, part)?;
                }
                Ok(())
            }
            _ => Err(format!("the pattern {}", pattern.to_token_stream())),
        }
    }

    fn bind_all<'x>(&mut self, patterns: impl Iterator<Item = &'x Pat>, value: Value) -> Result<()> {
        let parts = self.elements(value)?;
        for (pattern, part) in patterns.take_while(|pattern| !matches!(pattern, Pat::Rest(_))).zip(parts) {
            self.bind(pattern, part)?;
        }
        Ok(())
    }

    /// Writes statements, whose values do not matter.
    pub fn statements(&mut self, statements: &[Stmt]) -> Result<()> {
        statements.iter().try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Stmt) -> Result<()> {
        match statement {
            Stmt::Local(Local { pat, init: Some(init), .. }) if init.diverge.is_none() => {
                let value = self.expression(&init.expr)?;
                self.bind(pat, value)
            }
            Stmt::Item(syn::Item::Const(constant)) => {
                let value = self.expression(&constant.expr)?;
                self.declare(&constant.ident.to_string(), value);
                Ok(())
            }
            Stmt::Expr(expression, _) => self.effect(expression),
            Stmt::Macro(statement) if statement.mac.path.is_ident("debug_assert") => Ok(()),
            _ => Err(format!("the statement {}", statement.to_token_stream())),
        }
    }

    /// Writes an expression for its effect.
    pub fn effect(&mut self, expression: &Expr) -> Result<()> {
        match expression {
            Expr::If(_) | Expr::Match(_) => self.branches(expression, Mode::Statement).map(|_| ()),
            Expr::Block(block) => {
                let (lines, ()) = self.captured(|body| body.statements(&block.block.stmts))?;
                self.line("{");
                self.append(lines);
                self.line("}");
                Ok(())
            }
            Expr::Return(result) => match &result.expr {
                _ if self.inlined > 0 => Err("a return from what is inlined".into()),
                Some(result) => self.returned(result),
                None => {
                    self.line("return;");
                    Ok(())
                }
            },
            _ => match self.expression(expression)? {
                Value::Plain(text, _) if !names::is_identifier(&text) && !names::is_number(&text) => {
                    self.line(&format!("_ = {text};"));
                    Ok(())
                }
                _ => Ok(()),
            },
        }
    }

    /// Writes the return of an expression's value.
    pub fn returned(&mut self, expression: &Expr) -> Result<()> {
        match expression {
            Expr::If(_) | Expr::Match(_) => self.branches(expression, Mode::Return).map(|_| ()),
            Expr::Block(block) => self.returning_block(&block.block),
            Expr::Return(_) => self.effect(expression),
            _ => {
                let (text, _) = self.plain(expression)?;
                self.line(&format!("return {};", bare(&text)));
                Ok(())
            }
        }
    }

    fn returning_block(&mut self, block: &Block) -> Result<()> {
        match block.stmts.split_last() {
            Some((Stmt::Expr(last, None), before)) => {
                self.statements(before)?;
                self.returned(last)
            }
            _ => self.statements(&block.stmts),
        }
    }

    /// The value of a block, after its statements.
    pub fn block_value(&mut self, block: &Block) -> Result<Value> {
        match block.stmts.split_last() {
            Some((Stmt::Expr(last, None), before)) => {
                self.statements(before)?;
                self.expression(last)
            }
            _ => self.statements(&block.stmts).map(|()| Value::Unit),
        }
    }

    /// Writes branches, of which the first is taken whose condition holds.
    pub fn write_branches(&mut self, branches: Vec<Branch>, mode: Mode) -> Result<Value> {
        let mut written = Vec::new();
        for Branch { condition, body: expression } in branches {
            let (lines, value) = self.captured(|body| match (mode, expression) {
                (Mode::Value, _) => {
                    let value = body.expression(expression)?;
                    if matches!(value, Value::Unit) { Ok(None) } else { body.materialized(value).map(Some) }
                }
                (Mode::Return, _) => body.returned(expression).map(|()| None),
                (_, Expr::Block(block)) => body.statements(&block.block.stmts).map(|()| None),
                (Mode::Statement, _) => body.effect(expression).map(|()| None),
            })?;
            written.push((condition, lines, value));
        }
        // A choice between two values that need no statements.
        if let [(Some(condition), a_lines, Some((a, ty))), (None, b_lines, Some((b, _)))] = &written[..]
            && a_lines.is_empty()
            && b_lines.is_empty()
            && [a, b].iter().all(|text| names::is_identifier(text) || names::is_number(text))
        {
            return Ok(Value::Plain(format!("select({b}, {a}, {})", bare(condition)), ty.clone()));
        }
        let mut result = Value::Unit;
        if let Some((_, ty)) = written.iter().find_map(|(.., value)| value.clone()) {
            let name = self.identifier("chosen");
            let spelled = self.translator.spell(&ty)?;
            self.line(&format!("var {name}: {spelled};"));
            self.variables.insert(name.clone());
            result = Value::Plain(name, ty);
        }
        let count = written.len();
        for (i, (condition, lines, value)) in written.into_iter().enumerate() {
            let start = if i == 0 { "" } else { "} else " };
            match condition {
                Some(condition) => self.line(&format!("{start}if ({}) {{", bare(&condition))),
                None => self.line(&format!("{start}{{")),
            }
            self.append(lines);
            if let (Some((text, _)), Value::Plain(name, _)) = (value, &result) {
                self.line(&format!("    {name} = {};", bare(&text)));
            }
            if i + 1 == count {
                self.line("}");
            }
        }
        Ok(result)
    }
}
