//! Calls of functions, methods and closures.

use quote::ToTokens;
use syn::{FnArg, GenericParam, ReturnType};

use super::body::{Body, Result};
use super::intrinsics;
use super::names;
use super::types::Type;
use super::value::{Context, Value, bare};

impl Body<'_, '_> {
    /// The type that a path names before its last part, if it does.
    pub fn owner_of(&self, path: &syn::Path) -> Option<Type> {
        let mut owner = path.clone();
        owner.segments.pop();
        let last = owner.segments.pop()?;
        let is_type = last.ident.to_string().starts_with(char::is_uppercase)
            || ["f32", "u32", "i32", "usize"].iter().any(|name| last.ident == name);
        if !is_type {
            return None;
        }
        owner.segments.push(last);
        self.context.names.path(&owner)
    }

    /// The call of a function by its path.
    pub fn call_path(&mut self, path: &syn::Path, arguments: Vec<Value>) -> Result<Value> {
        let last = path.segments.last().ok_or("an empty path")?.ident.to_string();
        if let Some(owner) = self.owner_of(path) {
            return self.associated(&owner, &last, arguments);
        }
        if let Some(value) = self.lookup(&last) {
            return self.apply(&value, arguments);
        }
        if last == "polynomial" {
            return self.polynomial(arguments);
        }
        // A struct that stands for its only field.
        if let Some(ty) = self.context.names.path(path)
            && self.translator.inside(&ty).is_some()
        {
            let value = arguments.into_iter().next().ok_or("a struct of nothing")?;
            return Ok(Value::Plain(self.materialized(value)?.0, ty));
        }
        let unknown = || format!("the function {}", path.to_token_stream());
        let index = self.translator.library.function(self.context.source, &last).ok_or_else(unknown)?;
        self.call(index, None, arguments)
    }

    /// The call of a method.
    pub fn method(&mut self, name: &str, mut arguments: Vec<Value>) -> Result<Value> {
        let receiver = arguments[0].clone();
        let ty = receiver.ty().ok_or_else(|| format!("the receiver of {name}"))?;
        match (name, &ty, arguments.len()) {
            ("into_iter" | "iter" | "copied" | "to_owned" | "clone", _, 1) => Ok(receiver),
            ("len", ..) => match self.translator.inside(&ty).unwrap_or(ty) {
                Type::Array(_, count) => Ok(Value::Plain(count.to_string(), Type::Literal)),
                ty => Err(format!("the length of {ty:?}")),
            },
            ("iter_mut", ..) => {
                let (text, ty) = self.materialized(receiver)?;
                Ok(Value::Place(text, ty))
            }
            ("enumerate", ..) => {
                let parts = self.elements(receiver)?.into_iter().enumerate();
                let numbered = |(i, part): (usize, _)| {
                    Value::Tuple(vec![Value::Plain(i.to_string(), Type::Literal), part])
                };
                Ok(Value::Array(parts.map(numbered).collect()))
            }
            ("zip", Type::Array(..), 2) => {
                let others = self.elements(arguments.remove(1))?;
                let pairs = self.elements(receiver)?.into_iter().zip(others);
                Ok(Value::Array(pairs.map(|(a, b)| Value::Tuple(vec![a, b])).collect()))
            }
            ("each" | "map", Type::Array(..), 2) => {
                let function = arguments.remove(1);
                let parts = self.elements(receiver)?;
                let mapped = parts.into_iter().map(|part| self.apply(&function, vec![part]));
                Ok(Value::Array(mapped.collect::<Result<_>>()?))
            }
            ("map" | "zip", Type::Named(..), _) if ty.coordinates().is_some() => {
                self.each_coordinate(&ty, arguments)
            }
            _ => self.associated(&ty, name, arguments),
        }
    }

    /// `map` and `zip` of a vector of `math`.
    fn each_coordinate(&mut self, ty: &Type, mut arguments: Vec<Value>) -> Result<Value> {
        let function = arguments.pop().ok_or("a function of coordinates")?;
        let stored = arguments.into_iter().map(|argument| self.stored("v", argument, false));
        let vectors = stored.collect::<Result<Vec<_>>>()?;
        let mut coordinates = Vec::new();
        for c in ["x", "y", "z"].into_iter().take(ty.coordinates().unwrap_or(0)) {
            let parts = vectors.iter().cloned().map(|vector| {
                let (text, _) = self.materialized(vector)?;
                Ok(Value::real(format!("{text}.{c}")))
            });
            let parts = parts.collect::<Result<_>>()?;
            coordinates.push(self.apply(&function, parts)?);
        }
        let (text, _) = self.materialized(Value::Array(coordinates))?;
        Ok(Value::Plain(text, ty.clone()))
    }

    /// The call of a function that belongs to a type.
    fn associated(&mut self, owner: &Type, name: &str, mut arguments: Vec<Value>) -> Result<Value> {
        if *owner == Type::Real && name == "call" {
            return self.method("run", arguments);
        }
        let method = owner.name().and_then(|owner| self.translator.library.method(owner, name));
        if let Some(index) = method.filter(|_| !intrinsics::is_operation(owner, name)) {
            // The type's arguments may only be known from a value.
            let same = |ty: &Type| ty.name() == owner.name();
            let owner = arguments.iter().filter_map(Value::ty).find(same).unwrap_or(owner.clone());
            return self.call(index, Some(owner), arguments);
        }
        let texts: Vec<String> = arguments
            .drain(..)
            .map(|argument| Ok(self.materialized(argument)?.0))
            .collect::<Result<_>>()
            .map_err(|error: String| format!("{name}: {error}"))?;
        intrinsics::operation(owner, name, &texts).ok_or_else(|| format!("the function {name} of {owner:?}"))
    }

    /// The call of a closure or of a function that is a value.
    pub fn apply(&mut self, function: &Value, arguments: Vec<Value>) -> Result<Value> {
        match function {
            Value::Function(path) => self.call_path(path, arguments),
            Value::Closure(closure) => self.inline(closure.context.clone(), |body| {
                for (input, argument) in closure.inputs.iter().zip(arguments) {
                    body.bind(input, argument)?;
                }
                body.expression(&closure.body)
            }),
            _ => Err("a call of what is no function".into()),
        }
    }

    /// Translates something in another context, in place.
    fn inline(
        &mut self,
        context: Context,
        translate: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<Value> {
        let before = std::mem::replace(&mut self.context, context);
        self.context.scopes.push(Default::default());
        self.inlined += 1;
        let value = translate(self);
        self.inlined -= 1;
        self.context = before;
        value
    }

    /// The call of a function of the library.
    fn call(&mut self, index: usize, owner: Option<Type>, arguments: Vec<Value>) -> Result<Value> {
        let function = &self.translator.library.functions[index];
        let names = self.translator.names_of(owner.clone());
        let has_functions = function.signature.inputs.iter().any(
            |input| matches!(input, FnArg::Typed(input) if matches!(&*input.ty, syn::Type::ImplTrait(_))),
        );
        let constants = &function.signature.generics.params;
        if has_functions || constants.iter().any(|p| matches!(p, GenericParam::Const(_))) {
            let context = Context { source: function.source, names, scopes: Vec::new() };
            return self.inline(context, |body| {
                for (input, argument) in function.signature.inputs.iter().zip(arguments) {
                    body.bind_parameter(input, argument)?;
                }
                body.block_value(&function.block)
            });
        }
        let result = match &function.signature.output {
            ReturnType::Default => Type::Unit,
            ReturnType::Type(_, ty) => names.parse(ty).ok_or("the type of a result")?.0,
        };
        let before = std::mem::replace(&mut self.context.names, names);
        let types = self.parameter_types(&function.signature);
        self.context.names = before;
        let name = self.translator.function(index, owner);
        let (mut texts, mut returned) = (Vec::new(), Vec::new());
        for (argument, (_, is_pointer)) in arguments.into_iter().zip(types?) {
            let (text, _) = self.materialized(argument)?;
            texts.push(match (is_pointer, text.strip_prefix("(*").and_then(|text| text.strip_suffix(')'))) {
                (false, _) => bare(&text).to_owned(),
                (true, Some(pointer)) if names::is_identifier(pointer) => pointer.to_owned(),
                (true, _) if names::is_identifier(&text) => format!("&{text}"),
                // A pointer to a part of a variable is no argument.
                (true, _) => {
                    let part = self.identifier("part");
                    self.line(&format!("var {part} = {text};"));
                    returned.push(format!("{text} = {part};"));
                    format!("&{part}")
                }
            });
        }
        let has_effect =
            texts.iter().any(|text| text.starts_with('&')) || changes_arguments(&function.signature);
        let call = format!("{name}({})", texts.join(", "));
        if matches!(result, Type::Tuple(_)) {
            self.translator.spell(&result)?;
        }
        let value = match result {
            Type::Unit => {
                self.line(&format!("{call};"));
                Value::Unit
            }
            // Effects happen in the order of the calls.
            ty if has_effect => {
                let result = self.identifier("result");
                self.line(&format!("let {result} = {call};"));
                Value::Plain(result, ty)
            }
            ty => Value::Plain(call, ty),
        };
        returned.iter().for_each(|line| self.line(line));
        Ok(value)
    }

    /// A polynomial with known coefficients, by Horner's rule.
    fn polynomial(&mut self, arguments: Vec<Value>) -> Result<Value> {
        let Ok([x, coefficients]) = <[Value; 2]>::try_from(arguments) else {
            return Err("a polynomial".into());
        };
        let x = self.stored("x", x, false)?;
        let (x, _) = self.materialized(x)?;
        let mut sum = String::new();
        for coefficient in self.elements(coefficients)?.into_iter().rev() {
            let (coefficient, _) = self.materialized(coefficient)?;
            sum = if sum.is_empty() { coefficient } else { format!("({sum} * {x} + {coefficient})") };
        }
        Ok(Value::real(sum))
    }
}

/// Whether a function changes what it is given.
fn changes_arguments(signature: &syn::Signature) -> bool {
    signature.inputs.iter().any(|input| match input {
        FnArg::Receiver(receiver) => matches!(receiver.kind, syn::ReceiverKind::Reference(_, _, Some(_))),
        FnArg::Typed(input) => matches!(&*input.ty, syn::Type::Reference(r) if r.mutability.is_some()),
    })
}
