//! What expressions become.

use std::collections::BTreeMap;
use std::rc::Rc;

use syn::{ExprClosure, Path};

use super::types::{Parameters, Type};

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
    /// A closure, which is inlined where it is called.
    Closure(Rc<(ExprClosure, Context)>),
}

/// What names mean at a place.
#[derive(Clone)]
pub struct Context {
    pub source: usize,
    pub parameters: Parameters,
    pub scopes: Vec<BTreeMap<String, Value>>,
    /// Whether this is the body of a function or closure in the place of a call.
    pub is_inlined: bool,
}

impl Value {
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
    let mut depth = 0;
    let mut is_inside = |c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth >= 0
    };
    let inside = text.strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    inside.filter(|inside| inside.chars().all(&mut is_inside)).unwrap_or(text)
}
