//! Expressions.

use std::rc::Rc;

use quote::ToTokens;
use syn::{BinOp, Expr, ExprBinary, ExprIf, ExprStruct, Lit, Member, Pat, UnOp};

use super::body::{Body, Branch, Mode, Result};
use super::intrinsics;
use super::names;
use super::types::Type;
use super::value::{Closure, Value, bare};

impl Body<'_, '_> {
    /// The value of an expression, after the statements that it needs.
    pub fn expression(&mut self, expression: &Expr) -> Result<Value> {
        match expression {
            Expr::Paren(inside) => self.expression(&inside.expr),
            Expr::Group(inside) => self.expression(&inside.expr),
            Expr::Lit(literal) => self.literal(&literal.lit),
            Expr::Path(path) => self.path(&path.path),
            Expr::Tuple(tuple) if tuple.elems.is_empty() => Ok(Value::Unit),
            Expr::Tuple(tuple) => Ok(Value::Tuple(self.all(tuple.elems.iter())?)),
            Expr::Array(array) => Ok(Value::Array(self.all(array.elems.iter())?)),
            Expr::Repeat(repeat) => {
                let (value, (count, _)) = (self.expression(&repeat.expr)?, self.plain(&repeat.len)?);
                let value = self.stored("element", value, false)?;
                let count =
                    if count.ends_with("_N") { 4 } else { count.parse().map_err(|_| "an array's length")? };
                Ok(Value::Array(vec![value; count]))
            }
            Expr::Unary(unary) => self.unary(&unary.op, &unary.expr),
            Expr::Binary(binary) => self.binary(binary),
            Expr::Cast(cast) => {
                let (text, _) = self.plain(&cast.expr)?;
                let (ty, _) = self.context.names.parse(&cast.ty).ok_or("the type of a cast")?;
                let spelled = self.translator.spell(&ty)?;
                Ok(Value::Plain(format!("{spelled}({})", bare(&text)), ty))
            }
            Expr::Reference(reference) if reference.mutability.is_some() => {
                let (text, ty) = self.plain(&reference.expr)?;
                Ok(Value::Place(text, ty))
            }
            Expr::Reference(reference) => self.expression(&reference.expr),
            Expr::Field(field) => {
                let base = self.expression(&field.base)?;
                self.field(base, &field.member)
            }
            Expr::Index(index) => {
                let (base, at) = (self.expression(&index.expr)?, self.plain(&index.index)?.0);
                self.element(base, &at)
            }
            Expr::Struct(literal) => self.structure(literal),
            Expr::Call(call) => {
                let arguments = self.all(call.args.iter())?;
                match &*call.func {
                    Expr::Path(path) => self.call_path(&path.path, arguments),
                    function => {
                        let function = self.expression(function)?;
                        self.apply(&function, arguments)
                    }
                }
            }
            Expr::MethodCall(call) => {
                let receiver = self.expression(&call.receiver)?;
                let mut arguments = vec![receiver];
                arguments.extend(self.all(call.args.iter())?);
                self.method(&call.method.to_string(), arguments)
            }
            Expr::Closure(closure) => Ok(Value::Closure(Rc::new(Closure {
                inputs: closure.inputs.iter().cloned().collect(),
                body: (*closure.body).clone(),
                context: self.context.clone(),
            }))),
            Expr::If(_) | Expr::Match(_) => self.branches(expression, Mode::Value),
            Expr::Block(block) => {
                self.context.scopes.push(Default::default());
                let value = self.block_value(&block.block);
                self.context.scopes.pop();
                value
            }
            Expr::Assign(assign) => {
                let value = self.expression(&assign.right)?;
                self.assign(&assign.left, value)?;
                Ok(Value::Unit)
            }
            Expr::Return(_) => self.effect(expression).map(|()| Value::Unit),
            Expr::Break(_) => {
                self.line("break;");
                Ok(Value::Unit)
            }
            Expr::Continue(_) => {
                self.line("continue;");
                Ok(Value::Unit)
            }
            Expr::ForLoop(repeat) => {
                self.for_loop(&repeat.pat, &repeat.expr, &repeat.body).map(|()| Value::Unit)
            }
            Expr::While(repeat) => {
                let (lines, ()) = self.captured(|body| {
                    let (condition, _) = body.plain(&repeat.cond)?;
                    body.line(&format!("if (!{condition}) {{ break; }}"));
                    body.statements(&repeat.body.stmts)
                })?;
                self.line("loop {");
                self.append(lines);
                self.line("}");
                Ok(Value::Unit)
            }
            Expr::Macro(expression) if expression.mac.path.is_ident("matches") => {
                let parse = |input: syn::parse::ParseStream| {
                    let value: Expr = input.parse()?;
                    input.parse::<syn::Token![,]>()?;
                    Ok((value, Pat::parse_multi(input)?))
                };
                let (value, pattern) =
                    expression.mac.parse_body_with(parse).map_err(|error| error.to_string())?;
                let (text, ty) = self.plain(&value)?;
                Ok(Value::bool(self.test(&pattern, &text, &ty)?.unwrap_or("true".into())))
            }
            _ => Err(format!("the expression {}", expression.to_token_stream())),
        }
    }

    fn all<'x>(&mut self, expressions: impl Iterator<Item = &'x Expr>) -> Result<Vec<Value>> {
        expressions.map(|expression| self.expression(expression)).collect()
    }

    /// An expression as one of WGSL, and its type.
    pub fn plain(&mut self, expression: &Expr) -> Result<(String, Type)> {
        let value = self.expression(expression)?;
        self.materialized(value).map_err(|error| format!("{error}: {}", expression.to_token_stream()))
    }

    /// A value as an expression of WGSL, and its type.
    pub fn materialized(&mut self, value: Value) -> Result<(String, Type)> {
        let ty = value.ty();
        match value {
            Value::Plain(text, ty) | Value::Place(text, ty) => Ok((text, ty)),
            Value::Tuple(values) | Value::Array(values) => {
                let ty = ty.ok_or("a value without a type")?;
                let spelled = self.translator.spell(&ty)?;
                let texts = values.into_iter().map(|value| {
                    let (text, _) = self.materialized(value)?;
                    Ok(bare(&text).to_owned())
                });
                let texts: Vec<String> = texts.collect::<Result<_>>()?;
                Ok((format!("{spelled}({})", texts.join(", ")), ty))
            }
            _ => Err("no value of WGSL".into()),
        }
    }

    fn literal(&mut self, literal: &Lit) -> Result<Value> {
        match literal {
            Lit::Float(float) => Ok(Value::real(format!("{}f", float.base10_digits()))),
            Lit::Int(integer) => {
                let text: String = integer.token().to_string().replace('_', "");
                let digits = text.strip_suffix(integer.suffix()).unwrap_or(&text);
                Ok(match integer.suffix() {
                    "u32" | "usize" => Value::Plain(format!("{digits}u"), Type::Uint),
                    "i32" => Value::Plain(format!("{digits}i"), Type::Sint),
                    _ => Value::Plain(digits.to_owned(), Type::Literal),
                })
            }
            Lit::Bool(value) => Ok(Value::bool(value.value.to_string())),
            _ => Err(format!("the literal {}", literal.to_token_stream())),
        }
    }

    /// A name that is not called.
    fn path(&mut self, path: &syn::Path) -> Result<Value> {
        let unknown = || format!("the name {}", path.to_token_stream());
        let last = path.segments.last().ok_or_else(unknown)?.ident.to_string();
        if let Some(name) = path.get_ident()
            && let Some(value) = self.lookup(&name.to_string())
        {
            return Ok(value);
        }
        let owner = self.owner_of(path);
        if let Some(Type::Named(name, _)) = &owner
            && let Some(variant) = self.translator.variant(name, &last)
        {
            return Ok(Value::Plain(variant, Type::named(name)));
        }
        let owner_name = owner.as_ref().and_then(Type::name);
        if let Some(index) = self.translator.library.constant(self.context.source, owner_name, &last) {
            let (name, ty) = self.translator.constant(index)?;
            return Ok(Value::Plain(name, ty));
        }
        if let Some(constant) = intrinsics::standard_constant(owner.as_ref(), &last) {
            return Ok(constant);
        }
        Ok(Value::Function(path.clone()))
    }

    fn unary(&mut self, operator: &UnOp, operand: &Expr) -> Result<Value> {
        let value = self.expression(operand)?;
        if matches!(operator, UnOp::Deref(_)) {
            return Ok(value);
        }
        let (text, ty) = self.materialized(value)?;
        match operator {
            UnOp::Neg(_) if names::is_number(&text) && !text.starts_with('-') => {
                Ok(Value::Plain(format!("-{text}"), ty))
            }
            UnOp::Neg(_) => Ok(Value::Plain(format!("(-{text})"), ty)),
            UnOp::Not(_) if ty == Type::Bool => Ok(Value::bool(format!("!{text}"))),
            UnOp::Not(_) if ty == Type::Uint => Ok(Value::Plain(format!("~{text}"), ty)),
            UnOp::Not(_) => self.method("not", vec![Value::Plain(text, ty)]),
            _ => Err("an operator".into()),
        }
    }

    fn binary(&mut self, binary: &ExprBinary) -> Result<Value> {
        let sign = binary.op.to_token_stream().to_string();
        let (left, left_type) = self.plain(&binary.left)?;
        let (right, right_type) = self.plain(&binary.right)?;
        let is_assignment =
            sign.len() > 1 && sign.ends_with('=') && !["==", "<=", ">=", "!="].contains(&&*sign);
        if is_assignment {
            self.line(&format!("{} {sign} {};", bare(&left), bare(&right)));
            return Ok(Value::Unit);
        }
        // Exclusive or.
        let sign = if left_type == Type::Bool && sign == "^" { "!=" } else { &sign };
        let text = format!("({left} {sign} {right})");
        let ty = match binary.op {
            BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) | BinOp::Eq(_) | BinOp::Ne(_) => {
                Type::Bool
            }
            BinOp::Shl(_) | BinOp::Shr(_) => left_type,
            // A vector with a number is a vector.
            _ if matches!(right_type, Type::Named(..)) || left_type == Type::Literal => right_type,
            _ => left_type,
        };
        Ok(Value::Plain(text, ty))
    }

    /// A part of a value.
    pub fn field(&mut self, base: Value, member: &Member) -> Result<Value> {
        let name = match member {
            Member::Named(name) => name.to_string(),
            Member::Unnamed(index) => index.index.to_string(),
        };
        if let Value::Tuple(values) = &base {
            let index: usize = name.parse().map_err(|_| "a field of a tuple")?;
            return values.get(index).cloned().ok_or("a field of a tuple".into());
        }
        let (text, ty) = self.materialized(base)?;
        if let Some(inside) = self.translator.inside(&ty) {
            return Ok(Value::Plain(text, inside));
        }
        if let (Type::Tuple(types), Ok(index)) = (&ty, name.parse::<usize>()) {
            let ty = types.get(index).cloned().ok_or("a field of a tuple")?;
            return Ok(Value::Plain(format!("{text}.v{index}"), ty));
        }
        let fields = self.translator.fields(&ty).ok_or_else(|| format!("the fields of {ty:?}"))?;
        let (_, field) = fields.into_iter().find(|(known, _)| *known == name).ok_or("a field")?;
        Ok(Value::Plain(format!("{text}.{}", names::member(&name)), field))
    }

    /// The element of a value at an index.
    pub fn element(&mut self, base: Value, at: &str) -> Result<Value> {
        if let (Value::Array(values), Ok(index)) = (&base, at.parse::<usize>()) {
            return values.get(index).cloned().ok_or("an index".into());
        }
        let (text, ty) = self.materialized(base)?;
        let (element, count) = match self.translator.inside(&ty).unwrap_or(ty) {
            Type::Array(element, count) => (*element, count),
            ty if ty.coordinates().is_some() => (Type::Real, 3),
            ty => return Err(format!("an element of {ty:?}")),
        };
        Ok(Value::Plain(part(&text, &element, count, bare(at)), element))
    }

    /// The parts of a tuple or array.
    pub fn elements(&mut self, value: Value) -> Result<Vec<Value>> {
        match value {
            Value::Tuple(values) | Value::Array(values) => Ok(values),
            // What is referred to has parts that may be changed.
            Value::Place(text, Type::Array(ty, count)) => {
                Ok((0..count).map(|i| Value::Place(format!("{text}[{i}]"), (*ty).clone())).collect())
            }
            value => {
                let value = self.stored("parts", value, false)?;
                let (text, ty) = self.materialized(value)?;
                match self.translator.inside(&ty).unwrap_or(ty) {
                    Type::Array(ty, count) => {
                        let part = |i: usize| part(&text, &ty, count, &i.to_string());
                        Ok((0..count).map(|i| Value::Plain(part(i), (*ty).clone())).collect())
                    }
                    Type::Tuple(types) => {
                        let parts = types.into_iter().enumerate();
                        Ok(parts.map(|(i, ty)| Value::Plain(format!("{text}.v{i}"), ty)).collect())
                    }
                    ty => Err(format!("the parts of {ty:?}")),
                }
            }
        }
    }

    fn structure(&mut self, literal: &ExprStruct) -> Result<Value> {
        let ty = self.context.names.path(&literal.path).ok_or("a struct")?;
        // Arguments that are not written are those of the type whose impl this is.
        let ty = match (&ty, &self.context.names.owner) {
            (Type::Named(name, _), Some(owner)) if owner.name() == Some(name) => owner.clone(),
            _ => ty,
        };
        let mut values = Vec::new();
        for field in &literal.fields {
            let value = self.expression(&field.expr)?;
            let (text, ty) = self.materialized(value)?;
            values.push((field.member.to_token_stream().to_string(), text, ty));
        }
        let ty = self.translator.inferred(ty, &values);
        let fields = self.translator.fields(&ty).ok_or_else(|| format!("the struct {ty:?}"))?;
        let rest = match &literal.rest {
            Some(rest) => {
                let value = self.expression(rest)?;
                Some(self.stored("rest", value, false)?)
            }
            None => None,
        };
        let mut texts = Vec::new();
        for (name, _) in &fields {
            texts.push(match (values.iter().find(|(known, ..)| known == name), &rest) {
                (Some((_, text, _)), _) => bare(text).to_owned(),
                (None, Some(Value::Plain(rest, _) | Value::Place(rest, _))) => {
                    format!("{rest}.{}", names::member(name))
                }
                _ => return Err(format!("no field {name}")),
            });
        }
        let spelled = self.translator.spell(&ty)?;
        Ok(Value::Plain(format!("{spelled}({})", texts.join(", ")), ty))
    }

    fn assign(&mut self, place: &Expr, value: Value) -> Result<()> {
        if let Expr::Tuple(syn::ExprTuple { elems, .. }) | Expr::Array(syn::ExprArray { elems, .. }) = place {
            let parts = self.elements(value)?;
            let parts: Vec<Value> =
                parts.into_iter().map(|part| self.stored("part", part, false)).collect::<Result<_>>()?;
            return elems.iter().zip(parts).try_for_each(|(place, part)| self.assign(place, part));
        }
        let ((place, _), (text, _)) = (self.plain(place)?, self.materialized(value)?);
        self.line(&format!("{} = {};", bare(&place), bare(&text)));
        Ok(())
    }

    fn for_loop(&mut self, pattern: &Pat, range: &Expr, block: &syn::Block) -> Result<()> {
        if let Expr::Range(syn::ExprRange { start: Some(start), end: Some(end), limits, .. }) = range {
            let (start, (end, ty)) = (self.plain(start)?.0, self.plain(end)?);
            let sign = if matches!(limits, syn::RangeLimits::Closed(_)) { "<=" } else { "<" };
            let suffix = if ty == Type::Sint { "i" } else { "u" };
            let counter = self.identifier(&pattern.to_token_stream().to_string());
            let (lines, ()) = self.captured(|body| {
                let ty = if ty == Type::Sint { Type::Sint } else { Type::Uint };
                body.bind(pattern, Value::Plain(counter.clone(), ty))?;
                body.statements(&block.stmts)
            })?;
            let start = if names::is_number(&start) { start + suffix } else { start };
            self.line(&format!("for (var {counter} = {start}; {counter} {sign} {end}; {counter}++) {{"));
            self.append(lines);
            self.line("}");
            return Ok(());
        }
        let range = self.expression(range)?;
        for part in self.elements(range)? {
            let (lines, ()) = self.captured(|body| {
                body.bind(pattern, part)?;
                body.statements(&block.stmts)
            })?;
            self.line("{");
            self.append(lines);
            self.line("}");
        }
        Ok(())
    }

    /// An `if` or `match`.
    pub fn branches(&mut self, expression: &Expr, mode: Mode) -> Result<Value> {
        match expression {
            Expr::If(ExprIf { cond, then_branch, else_branch, .. }) => {
                let block = then_branch.clone();
                let then = Expr::Block(syn::ExprBlock { attrs: Vec::new(), label: None, block });
                let condition = Some(self.plain(cond)?.0);
                let mut branches = vec![Branch { condition, body: &then }];
                if let Some((_, otherwise)) = else_branch {
                    branches.push(Branch { condition: None, body: otherwise });
                }
                self.write_branches(branches, mode)
            }
            Expr::Match(choice) => {
                let value = self.expression(&choice.expr)?;
                let value = self.stored("choice", value, false)?;
                let (text, ty) = self.materialized(value)?;
                let last = choice.arms.len() - 1;
                let mut branches = Vec::new();
                for (i, arm) in choice.arms.iter().enumerate() {
                    // The last one needs no test, because matches are exhaustive.
                    let test = self.test(&arm.pat, &text, &ty)?;
                    let condition = if i == last { None } else { test };
                    branches.push(Branch { condition, body: &arm.body });
                }
                self.write_branches(branches, mode)
            }
            _ => Err("a branch".into()),
        }
    }

    /// The condition under which a pattern matches; `None` if it always does.
    fn test(&mut self, pattern: &Pat, text: &str, ty: &Type) -> Result<Option<String>> {
        match pattern {
            Pat::Wild(_) => Ok(None),
            Pat::Path(pattern) => {
                let variant = pattern.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
                let name = ty.name().unwrap_or_default();
                let variant = self.translator.variant(name, &variant).ok_or("a variant")?;
                Ok(Some(format!("({text} == {variant})")))
            }
            Pat::Lit(literal) => {
                let Value::Plain(literal, _) = self.literal(&literal.lit)? else {
                    return Err("a literal".into());
                };
                Ok(Some(format!("({text} == {literal})")))
            }
            Pat::Or(pattern) => {
                let tests = pattern.cases.iter().map(|case| self.test(case, text, ty));
                let tests: Option<Vec<String>> = tests.collect::<Result<_>>()?;
                Ok(tests.map(|tests| format!("({})", tests.join(" || "))))
            }
            _ => Err(format!("the pattern {}", pattern.to_token_stream())),
        }
    }
}

/// An element of an array of `count`; the coordinates of vectors have names.
fn part(array: &str, element: &Type, count: usize, at: &str) -> String {
    let is_vector = *element == Type::Real && count <= 4;
    match ["x", "y", "z", "w"].iter().zip(0..).find(|(_, i)| is_vector && at == i.to_string()) {
        Some((coordinate, _)) => format!("{array}.{coordinate}"),
        None => format!("{array}[{at}]"),
    }
}
