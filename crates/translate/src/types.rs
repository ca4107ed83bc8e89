//! Types, as far as the translation needs them: to find methods, and to declare variables.

use std::collections::BTreeMap;
use std::fmt;

use quote::ToTokens;
use syn::{Expr, GenericArgument, PathArguments};

use super::Result;

/// A type of one lane.
#[derive(Clone, PartialEq)]
pub enum Type {
    Bool,
    /// `f32`.
    Real,
    /// `u32`, and `usize`.
    Uint,
    /// `i32`.
    Sint,
    /// An integer literal, of any integer type.
    Literal,
    Array(Box<Type>, usize),
    /// Without elements, that of no value.
    Tuple(Vec<Type>),
    /// A struct or enum, and its type arguments but numbers with lanes.
    Named(String, Vec<Type>),
}

/// What type parameters, and `Self`, stand for at a place.
pub type Parameters = BTreeMap<String, Type>;

impl Type {
    /// The type of an annotation; that of a reference is what it refers to.
    pub fn parse(ty: &syn::Type, parameters: &Parameters) -> Result<Self> {
        Ok(match ty {
            syn::Type::Reference(reference) => Self::parse(&reference.elem, parameters)?,
            syn::Type::Tuple(tuple) => {
                let elements = tuple.elems.iter().map(|ty| Self::parse(ty, parameters));
                Self::Tuple(elements.collect::<Result<_>>()?)
            }
            syn::Type::Array(array) => {
                Self::Array(Box::new(Self::parse(&array.elem, parameters)?), length(&array.len)?)
            }
            syn::Type::Path(path) => Self::of_path(&path.path, parameters)?,
            _ => return Err(format!("the type {}", ty.to_token_stream())),
        })
    }

    /// The type of a path.
    pub fn of_path(path: &syn::Path, parameters: &Parameters) -> Result<Self> {
        let name = last_name(path);
        if let Some(ty) = parameters.get(&name) {
            return Ok(ty.clone());
        }
        Ok(match name.as_str() {
            "R" | "f32" | "Real" => Self::Real,
            "I" | "Int" | "u32" | "usize" => Self::Uint,
            "i32" => Self::Sint,
            "Mask" | "bool" => Self::Bool,
            "Point2" => Self::Named("Vec2".into(), Vec::new()),
            "Point3" | "Vector3" | "Normal3" => Self::Named("Vec3".into(), Vec::new()),
            "Self" | "Option" => return Err(format!("the type {name}")),
            _ => {
                let mut types = Vec::new();
                if let Some(PathArguments::AngleBracketed(list)) = path.segments.last().map(|s| &s.arguments)
                {
                    for argument in &list.args {
                        if let GenericArgument::Type(ty) = argument
                            && let Ok(ty @ Self::Named(..)) = Self::parse(ty, parameters)
                        {
                            types.push(ty);
                        }
                    }
                }
                Self::Named(name, types)
            }
        })
    }

    /// The name of a struct or enum.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Named(name, _) => Some(name),
            _ => None,
        }
    }

    /// The number of coordinates of a vector of `math`.
    pub fn coordinates(&self) -> Option<usize> {
        self.name()?.strip_prefix("Vec")?.parse().ok()
    }

    /// What names in this type stand for where a value has the type `known` instead.
    pub fn infer(&self, known: &Self, names: &mut Parameters) {
        let Self::Named(name, types) = self else { return };
        names.insert(name.clone(), known.clone());
        if let Self::Named(_, known) = known {
            types.iter().zip(known).for_each(|(ty, known)| ty.infer(known, names));
        }
    }
}

/// As a name, or as a part of one.
impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (name, types) = match self {
            Self::Bool => ("bool", &[][..]),
            Self::Real => ("f32", &[][..]),
            Self::Uint | Self::Literal => ("u32", &[][..]),
            Self::Sint => ("i32", &[][..]),
            Self::Array(element, count) => return write!(f, "{element}{count}"),
            Self::Tuple(types) => ("Tuple", &types[..]),
            Self::Named(name, types) => (name.as_str(), &types[..]),
        };
        f.write_str(name)?;
        types.iter().try_for_each(|ty| write!(f, "_{ty}"))
    }
}

/// The length of an array; `N` is the number of wavelengths of a path.
pub fn length(expression: &Expr) -> Result<usize> {
    match expression.to_token_stream().to_string().as_str() {
        "N" => Ok(4),
        text => text.parse().map_err(|_| format!("the length {text}")),
    }
}

/// The last name of a path.
pub fn last_name(path: &syn::Path) -> String {
    path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default()
}
