//! Calls of functions, methods and closures.

use quote::ToTokens;
use syn::{ExprClosure, Item, PatType};

use super::body::{Body, Mode, inputs, is_pointer, result_type};
use super::intrinsics::operation;
use super::types::{Type, last_name};
use super::value::{Context, Value, bare};
use super::{Result, names};

impl Body<'_, '_> {
    /// The type that a path names before its last part, if it does.
    pub fn owner_of(&self, path: &syn::Path) -> Option<Type> {
        let mut owner = path.clone();
        owner.segments.pop();
        owner.segments.pop_punct();
        let ty = Type::of_path(&owner, &self.context.parameters).ok()?;
        // Modules have names in lower case.
        ty.name().is_none_or(|name| name.starts_with(char::is_uppercase)).then_some(ty)
    }

    /// The call of a function by its path.
    pub fn call_path(&mut self, path: &syn::Path, mut arguments: Vec<Value>) -> Result<Value> {
        let name = last_name(path);
        if let Some(owner) = self.owner_of(path) {
            return self.associated(&owner, &name, arguments);
        }
        if name == "polynomial" {
            return self.polynomial(arguments);
        }
        // A struct that stands for its only field.
        if let Ok(ty) = Type::of_path(path, &self.context.parameters)
            && self.translator.inside(&ty).is_some()
        {
            return Ok(Value::Plain(self.materialized(arguments.remove(0))?.0, ty));
        }
        let unknown = || format!("the function {}", path.to_token_stream());
        let index = self.translator.library.find(Some(self.context.source), None, &name);
        self.call(index.ok_or_else(unknown)?, None, arguments)
    }

    /// The call of a method.
    pub fn method(&mut self, name: &str, mut arguments: Vec<Value>) -> Result<Value> {
        let ty = arguments[0].ty().ok_or_else(|| format!("the receiver of {name}"))?;
        let (is_array, is_vector) = (matches!(ty, Type::Array(..)), ty.coordinates().is_some());
        match name {
            "iter" | "into_iter" => Ok(arguments.remove(0)),
            "iter_mut" => {
                let (text, ty) = self.materialized(arguments.remove(0))?;
                Ok(Value::Place(text, ty))
            }
            "enumerate" => {
                let number = |i: usize| Value::Plain(i.to_string(), Type::Literal);
                let parts = self.elements(arguments.remove(0))?.into_iter().enumerate();
                Ok(Value::Array(parts.map(|(i, part)| Value::Tuple(vec![number(i), part])).collect()))
            }
            "each" | "map" | "zip" if is_array || is_vector => {
                let is_pairs = is_array && name == "zip";
                let function = if is_pairs { None } else { arguments.pop() };
                let parts = arguments.into_iter().map(|argument| self.elements(argument));
                let parts: Vec<Vec<Value>> = parts.collect::<Result<_>>()?;
                let mapped = (0..parts[0].len()).map(|i| {
                    let parts = parts.iter().map(|parts| parts[i].clone()).collect();
                    match &function {
                        Some(function) => self.apply(function, parts),
                        None => Ok(Value::Tuple(parts)),
                    }
                });
                let mapped = Value::Array(mapped.collect::<Result<_>>()?);
                if is_array { Ok(mapped) } else { Ok(Value::Plain(self.materialized(mapped)?.0, ty)) }
            }
            _ => self.associated(&ty, name, arguments),
        }
    }

    /// The call of a function that belongs to a type.
    fn associated(&mut self, owner: &Type, name: &str, arguments: Vec<Value>) -> Result<Value> {
        if *owner == Type::Real && name == "call" {
            return self.method("run", arguments);
        }
        if let Some(index) = self.translator.library.find(None, Some(owner), name) {
            return self.call(index, Some(owner.clone()), arguments);
        }
        let texts = arguments.into_iter().map(|argument| Ok(self.materialized(argument)?.0));
        let texts = texts.collect::<Result<Vec<_>>>().map_err(|error| format!("{name}: {error}"))?;
        let number = if *owner == Type::Literal { &Type::Uint } else { owner };
        operation(number, name, &texts).ok_or_else(|| format!("the function {name} of {owner}"))
    }

    /// The call of a closure or of a function that is a value.
    pub fn apply(&mut self, function: &Value, arguments: Vec<Value>) -> Result<Value> {
        match function {
            Value::Function(path) => self.call_path(path, arguments),
            Value::Closure(closure) => {
                let (ExprClosure { inputs, body: value, .. }, context) = &**closure;
                self.inline(context.clone(), |body| {
                    let mut inputs = inputs.iter().zip(arguments);
                    inputs.try_for_each(|(input, argument)| body.bind(input, argument))?;
                    body.expression(value)
                })
            }
            _ => Err("a call of what is no function".into()),
        }
    }

    /// Translates what is called in the place of the call.
    fn inline(&mut self, context: Context, call: impl FnOnce(&mut Self) -> Result<Value>) -> Result<Value> {
        let before = std::mem::replace(&mut self.context, Context { is_inlined: true, ..context });
        self.context.scopes.push(Default::default());
        let value = call(self);
        self.context = before;
        value
    }

    /// The call of a function of the library.
    fn call(&mut self, index: usize, owner: Option<Type>, arguments: Vec<Value>) -> Result<Value> {
        let definition = &self.translator.library.definitions[index];
        let Item::Fn(function) = &definition.item else {
            return Err(format!("a call of {}", definition.name));
        };
        let (inputs, generics) = (inputs(&function.sig), &function.sig.generics);
        let parameters = self.translator.parameters(owner.as_ref());
        // Functions are no arguments in WGSL, and the lengths of arrays are known.
        let is_function = |input: &PatType| matches!(&*input.ty, syn::Type::ImplTrait(_));
        if inputs.iter().any(is_function) || generics.const_params().next().is_some() {
            let context =
                Context { source: definition.source, parameters, scopes: Vec::new(), is_inlined: true };
            return self.inline(context, |body| {
                for (input, argument) in inputs.iter().zip(arguments) {
                    body.bind(&input.pat, argument)?;
                }
                body.block(&function.block, Mode::Take)
            });
        }
        let mut texts = Vec::new();
        for (input, argument) in inputs.iter().zip(arguments) {
            let (text, _) = self.materialized(argument)?;
            let pointer = text.strip_prefix("(*").and_then(|text| text.strip_suffix(')'));
            texts.push(match pointer {
                _ if !is_pointer(&input.ty) => bare(&text).to_owned(),
                Some(pointer) => pointer.to_owned(),
                None if names::is_identifier(&text) => format!("&{text}"),
                None => return Err(format!("a reference to a part, {text}")),
            });
        }
        let result = result_type(&function.sig, &parameters)?;
        let call = format!("{}({})", self.translator.named(index, owner), texts.join(", "));
        if result == Type::Tuple(Vec::new()) {
            self.line(&format!("{call};"));
            return Ok(Value::Unit);
        }
        // Functions by hand do not declare it themselves.
        if matches!(result, Type::Tuple(_)) {
            self.translator.spell(&result)?;
        }
        // Effects happen in the order of the calls.
        if inputs.iter().any(|input| is_pointer(&input.ty)) {
            let name = self.identifier("result");
            self.line(&format!("let {name} = {call};"));
            return Ok(Value::Plain(name, result));
        }
        Ok(Value::Plain(call, result))
    }

    /// A polynomial with known coefficients, by Horner's rule.
    fn polynomial(&mut self, mut arguments: Vec<Value>) -> Result<Value> {
        let coefficients = self.elements(arguments.pop().ok_or("a polynomial")?)?;
        let (x, _) = self.kept("x", arguments.pop().ok_or("a polynomial")?)?;
        let texts = coefficients.into_iter().rev().map(|c| Ok(self.materialized(c)?.0));
        let texts = texts.collect::<Result<Vec<_>>>()?.into_iter();
        let sum = texts.reduce(|sum, c| format!("({sum} * {x} + {c})"));
        Ok(Value::Plain(sum.unwrap_or_default(), Type::Real))
    }
}
