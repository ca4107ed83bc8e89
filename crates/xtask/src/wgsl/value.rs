//! What expressions become.

use std::collections::BTreeMap;
use std::rc::Rc;

use syn::{Expr, Pat, Path};

use super::types::{Type, TypeNames};

/// The value of an expression. Tuples, arrays and functions exist during the translation alone, as
/// long as they stay within one function.
#[derive(Clone)]
pub enum Value {
    Unit,
    /// An expression of WGSL without effects.
    Plain(String, Type),
    /// A variable or a part of one, which is referred to.
    Place(String, Type),
    Tuple(Vec<Value>),
    Array(Vec<Value>),
    Function(Path),
    Closure(Rc<Closure>),
}

/// A closure, which is inlined where it is called.
pub struct Closure {
    pub inputs: Vec<Pat>,
    pub body: Expr,
    pub context: Context,
}

/// What names mean at a place.
#[derive(Clone)]
pub struct Context {
    pub source: usize,
    pub names: TypeNames,
    pub scopes: Vec<BTreeMap<String, Value>>,
}

impl Value {
    /// A scalar expression.
    pub fn real(text: impl Into<String>) -> Self {
        Self::Plain(text.into(), Type::Real)
    }

    /// An expression that is true or false.
    pub fn bool(text: impl Into<String>) -> Self {
        Self::Plain(text.into(), Type::Bool)
    }

    /// The type, of what has one.
    pub fn ty(&self) -> Option<Type> {
        match self {
            Self::Plain(_, ty) | Self::Place(_, ty) => Some(ty.clone()),
            Self::Tuple(values) => Some(Type::Tuple(values.iter().map(Self::ty).collect::<Option<_>>()?)),
            Self::Array(values) => {
                let element = values.first()?.ty()?;
                let element = if element == Type::Literal { Type::Uint } else { element };
                Some(Type::Array(Box::new(element), values.len()))
            }
            _ => None,
        }
    }
}

/// An expression without the parentheses around all of it.
pub fn bare(text: &str) -> &str {
    let Some(inside) = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) else { return text };
    let mut depth = 0;
    for c in inside.chars() {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth < 0 {
            return text;
        }
    }
    inside
}
