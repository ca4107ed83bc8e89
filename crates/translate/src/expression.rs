//! Expressions.

use std::collections::BTreeMap;
use std::rc::Rc;

use quote::ToTokens;
use syn::{Expr, ExprBinary, ExprForLoop, ExprRange, ExprStruct, Item, Lit, Member, RangeLimits, UnOp};

use super::body::{Body, Mode};
use super::intrinsics::standard_constant;
use super::types::{Type, last_name, length};
use super::value::{Value, bare};
use super::{Result, names};

impl Body<'_, '_> {
    /// The value of an expression, after the statements that it needs.
    pub fn expression(&mut self, expression: &Expr) -> Result<Value> {
        match expression {
            Expr::Paren(inside) => return self.expression(&inside.expr),
            Expr::Lit(literal) => return self.literal(&literal.lit),
            Expr::Path(path) => return self.path(&path.path),
            Expr::Tuple(tuple) if tuple.elems.is_empty() => {}
            Expr::Tuple(tuple) => return self.all(&tuple.elems).map(Value::Tuple),
            Expr::Array(array) => return self.all(&array.elems).map(Value::Array),
            Expr::Repeat(repeat) => {
                let value = self.expression(&repeat.expr)?;
                let value = self.stored("element", value, false)?;
                return Ok(Value::Array(vec![value; length(&repeat.len)?]));
            }
            Expr::Unary(unary) => return self.unary(&unary.op, &unary.expr),
            Expr::Binary(binary) => return self.binary(binary),
            Expr::Cast(cast) => {
                let (text, _) = self.plain(&cast.expr)?;
                let ty = Type::parse(&cast.ty, &self.context.parameters)?;
                return Ok(Value::Plain(format!("{}({})", self.translator.spell(&ty)?, bare(&text)), ty));
            }
            Expr::Reference(reference) if reference.mutability.is_some() => {
                let (text, ty) = self.plain(&reference.expr)?;
                return Ok(Value::Place(text, ty));
            }
            Expr::Reference(reference) => return self.expression(&reference.expr),
            Expr::Field(field) => {
                let base = self.expression(&field.base)?;
                return self.field(base, &field.member);
            }
            Expr::Index(index) => {
                let (base, (at, _)) = (self.expression(&index.expr)?, self.plain(&index.index)?);
                if let (Value::Array(values), Ok(index)) = (&base, at.parse::<usize>()) {
                    return values.get(index).cloned().ok_or("an index".into());
                }
                let (text, ty) = self.materialized(base)?;
                let (element, count) = self.translator.array(&ty)?;
                return Ok(Value::Plain(part(&text, &element, count, bare(&at)), element));
            }
            Expr::Struct(literal) => return self.structure(literal),
            Expr::Call(call) => {
                let (function, arguments) = (self.expression(&call.func)?, self.all(&call.args)?);
                return self.apply(&function, arguments);
            }
            Expr::MethodCall(call) => {
                let mut arguments = vec![self.expression(&call.receiver)?];
                arguments.extend(self.all(&call.args)?);
                return self.method(&call.method.to_string(), arguments);
            }
            Expr::Closure(closure) => {
                return Ok(Value::Closure(Rc::new((closure.clone(), self.context.clone()))));
            }
            Expr::If(_) | Expr::Match(_) | Expr::Block(_) | Expr::Return(_) => {
                return self.evaluate(expression, Mode::Take);
            }
            Expr::Assign(assign) => {
                let value = self.expression(&assign.right)?;
                self.assign(&assign.left, value)?;
            }
            Expr::Break(_) => self.line("break;"),
            Expr::ForLoop(repeat) => return self.for_loop(repeat),
            Expr::While(repeat) => {
                return self.braced("loop ", |body| {
                    let (condition, _) = body.plain(&repeat.cond)?;
                    body.line(&format!("if (!{condition}) {{ break; }}"));
                    body.block(&repeat.body, Mode::Ignore)
                });
            }
            _ => return Err(format!("the expression {}", expression.to_token_stream())),
        }
        Ok(Value::Unit)
    }

    fn all<'x>(&mut self, expressions: impl IntoIterator<Item = &'x Expr>) -> Result<Vec<Value>> {
        expressions.into_iter().map(|expression| self.expression(expression)).collect()
    }

    /// An expression as one of WGSL, and its type.
    pub fn plain(&mut self, expression: &Expr) -> Result<(String, Type)> {
        let value = self.expression(expression)?;
        self.materialized(value).map_err(|error| format!("{error}: {}", expression.to_token_stream()))
    }

    /// A value as an expression of WGSL, and its type.
    pub fn materialized(&mut self, value: Value) -> Result<(String, Type)> {
        match value {
            Value::Plain(text, ty) | Value::Place(text, ty) => Ok((text, ty)),
            Value::Tuple(ref values) | Value::Array(ref values) => {
                let ty = value.ty().ok_or("a part without a type")?;
                let spelled = self.translator.spell(&ty)?;
                let texts = values.iter().map(|value| {
                    let (text, _) = self.materialized(value.clone())?;
                    Ok(bare(&text).to_owned())
                });
                Ok((format!("{spelled}({})", texts.collect::<Result<Vec<_>>>()?.join(", ")), ty))
            }
            _ => Err("no value of WGSL".into()),
        }
    }

    fn literal(&mut self, literal: &Lit) -> Result<Value> {
        let (text, ty) = match literal {
            Lit::Float(float) => (format!("{}f", float.base10_digits()), Type::Real),
            Lit::Int(integer) => {
                let text = integer.token().to_string().replace('_', "");
                let digits = text.strip_suffix(integer.suffix()).unwrap_or(&text);
                match integer.suffix() {
                    "u32" | "usize" => (format!("{digits}u"), Type::Uint),
                    "i32" => (format!("{digits}i"), Type::Sint),
                    _ => (digits.to_owned(), Type::Literal),
                }
            }
            Lit::Bool(value) => (value.value.to_string(), Type::Bool),
            _ => return Err(format!("the literal {}", literal.to_token_stream())),
        };
        Ok(Value::Plain(text, ty))
    }

    /// A name that is not called.
    fn path(&mut self, path: &syn::Path) -> Result<Value> {
        let name = last_name(path);
        if let Some(value) = self.lookup(&name).filter(|_| path.get_ident().is_some()) {
            return Ok(value);
        }
        let owner = self.owner_of(path);
        if let Some(ty) = &owner
            && let Some(variant) = self.translator.variant(ty, &name)
        {
            return Ok(Value::Plain(variant, ty.clone()));
        }
        let library = self.translator.library;
        if let Some(index) = library.find(Some(self.context.source), owner.as_ref(), &name)
            && let Item::Const(constant) = &library.definitions[index].item
        {
            let ty = Type::parse(&constant.ty, &self.translator.parameters(owner.as_ref()))?;
            return Ok(Value::Plain(self.translator.named(index, owner), ty));
        }
        let constant = standard_constant(owner.as_ref(), &name);
        Ok(constant.unwrap_or_else(|| Value::Function(path.clone())))
    }

    fn unary(&mut self, operator: &UnOp, operand: &Expr) -> Result<Value> {
        let value = self.expression(operand)?;
        if matches!(operator, UnOp::Deref(_)) {
            return Ok(value);
        }
        let (text, ty) = self.materialized(value)?;
        let text = match (operator, &ty) {
            (UnOp::Neg(_), _) if names::is_number(&text) && !text.starts_with('-') => format!("-{text}"),
            (UnOp::Neg(_), _) => format!("(-{text})"),
            (UnOp::Not(_), Type::Bool) => format!("!{text}"),
            _ => return self.method("not", vec![Value::Plain(text, ty)]),
        };
        Ok(Value::Plain(text, ty))
    }

    fn binary(&mut self, binary: &ExprBinary) -> Result<Value> {
        let sign = binary.op.to_token_stream().to_string();
        let (left, left_type) = self.plain(&binary.left)?;
        let (right, right_type) = self.plain(&binary.right)?;
        // Exclusive or.
        let sign = if sign == "^" && left_type == Type::Bool { "!=" } else { &sign };
        let ty = match sign {
            "<" | "<=" | ">" | ">=" | "==" | "!=" => Type::Bool,
            _ if sign.ends_with('=') => {
                self.line(&format!("{} {sign} {};", bare(&left), bare(&right)));
                return Ok(Value::Unit);
            }
            "<<" | ">>" => left_type,
            // A vector with a number is a vector.
            _ if matches!(right_type, Type::Named(..)) || left_type == Type::Literal => right_type,
            _ => left_type,
        };
        Ok(Value::Plain(format!("({left} {sign} {right})"), ty))
    }

    /// A part of a value.
    pub fn field(&mut self, base: Value, member: &Member) -> Result<Value> {
        let name = member.to_token_stream().to_string();
        let missing = || format!("the field {name}");
        if let (Value::Tuple(values), Ok(index)) = (&base, name.parse::<usize>()) {
            return values.get(index).cloned().ok_or_else(missing);
        }
        let (text, ty) = self.materialized(base)?;
        if let Some(inside) = self.translator.inside(&ty) {
            return Ok(Value::Plain(text, inside));
        }
        let mut fields = self.translator.fields(&ty)?.into_iter();
        let (_, field) = fields.find(|(known, _)| *known == name).ok_or_else(missing)?;
        Ok(Value::Plain(format!("{text}.{}", names::member(&name)), field))
    }

    /// The parts of a tuple or array.
    pub fn elements(&mut self, value: Value) -> Result<Vec<Value>> {
        match value {
            Value::Tuple(values) | Value::Array(values) => return Ok(values),
            // What is referred to has parts that may be changed.
            Value::Place(text, Type::Array(ty, count)) => {
                return Ok((0..count).map(|i| Value::Place(format!("{text}[{i}]"), (*ty).clone())).collect());
            }
            _ => {}
        }
        let (text, ty) = self.kept("parts", value)?;
        if let Type::Tuple(types) = ty {
            let parts = types.into_iter().enumerate();
            return Ok(parts.map(|(i, ty)| Value::Plain(format!("{text}.v{i}"), ty)).collect());
        }
        let (element, count) = self.translator.array(&ty)?;
        let text_at = |i: usize| part(&text, &element, count, &i.to_string());
        Ok((0..count).map(|i| Value::Plain(text_at(i), element.clone())).collect())
    }

    fn structure(&mut self, literal: &ExprStruct) -> Result<Value> {
        let ty = Type::of_path(&literal.path, &self.context.parameters)?;
        let mut values = BTreeMap::new();
        for field in &literal.fields {
            values.insert(field.member.to_token_stream().to_string(), self.plain(&field.expr)?);
        }
        let ty = self.translator.inferred(ty, &values)?;
        let fields = self.translator.fields(&ty)?;
        if let Some(rest) = &literal.rest {
            let rest = self.expression(rest)?;
            let (rest, _) = self.kept("rest", rest)?;
            for (name, ty) in &fields {
                let text = format!("{rest}.{}", names::member(name));
                values.entry(name.clone()).or_insert((text, ty.clone()));
            }
        }
        let texts = fields.iter().map(|(name, _)| match values.get(name) {
            Some((text, _)) => Ok(bare(text)),
            None => Err(format!("no field {name}")),
        });
        let texts = texts.collect::<Result<Vec<_>>>()?.join(", ");
        Ok(Value::Plain(format!("{}({texts})", self.translator.spell(&ty)?), ty))
    }

    fn assign(&mut self, place: &Expr, value: Value) -> Result<()> {
        if let Expr::Tuple(syn::ExprTuple { elems, .. }) | Expr::Array(syn::ExprArray { elems, .. }) = place {
            let parts = self.elements(value)?.into_iter();
            let parts: Vec<Value> =
                parts.map(|part| self.stored("part", part, false)).collect::<Result<_>>()?;
            return elems.iter().zip(parts).try_for_each(|(place, part)| self.assign(place, part));
        }
        let ((place, _), (text, _)) = (self.plain(place)?, self.materialized(value)?);
        self.line(&format!("{} = {};", bare(&place), bare(&text)));
        Ok(())
    }

    fn for_loop(&mut self, repeat: &ExprForLoop) -> Result<Value> {
        let loops = match &*repeat.expr {
            Expr::Range(ExprRange { start: Some(start), end: Some(end), limits, .. }) => {
                let ((start, _), (end, ty)) = (self.plain(start)?, self.plain(end)?);
                let sign = if matches!(limits, RangeLimits::Closed(_)) { "<=" } else { "<" };
                let (ty, suffix) = if ty == Type::Sint { (ty, "i") } else { (Type::Uint, "u") };
                let start = if names::is_number(&start) { start + suffix } else { start };
                let counter = self.identifier(&repeat.pat.to_token_stream().to_string());
                let head = format!("for (var {counter} = {start}; {counter} {sign} {end}; {counter}++) ");
                vec![(head, Value::Plain(counter, ty))]
            }
            parts => {
                let parts = self.expression(parts)?;
                self.elements(parts)?.into_iter().map(|part| (String::new(), part)).collect()
            }
        };
        for (head, value) in loops {
            self.braced(&head, |body| {
                body.bind(&repeat.pat, value)?;
                body.block(&repeat.body, Mode::Ignore)
            })?;
        }
        Ok(Value::Unit)
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
