//! Types, as far as the translation needs them: to find methods, and to declare variables.

use std::collections::BTreeMap;

use syn::{Expr, GenericArgument, PathArguments};

/// A type of one lane.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Type {
    Unit,
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
    Tuple(Vec<Type>),
    /// A struct or enum, and its type arguments.
    Named(String, Vec<Type>),
}

impl Type {
    /// A type without arguments.
    pub fn named(name: &str) -> Self {
        Self::Named(name.to_owned(), Vec::new())
    }

    /// The name of a named type.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Named(name, _) => Some(name),
            _ => None,
        }
    }

    /// The number of coordinates of a vector of `math`.
    pub fn coordinates(&self) -> Option<usize> {
        match self.name()? {
            "Vec2" => Some(2),
            "Vec3" => Some(3),
            _ => None,
        }
    }
}

/// What names of types mean at a place.
#[derive(Clone, Default)]
pub struct TypeNames {
    /// The type whose impl this is in.
    pub owner: Option<Type>,
    /// What type parameters stand for.
    pub parameters: BTreeMap<String, Type>,
}

impl TypeNames {
    /// The type of an annotation, and whether it is a mutable reference; `None` where it has no
    /// translation.
    pub fn parse(&self, ty: &syn::Type) -> Option<(Type, bool)> {
        let parsed = match ty {
            syn::Type::Paren(ty) => return self.parse(&ty.elem),
            syn::Type::Reference(reference) => {
                return Some((self.parse(&reference.elem)?.0, reference.mutability.is_some()));
            }
            syn::Type::Tuple(tuple) if tuple.elems.is_empty() => Type::Unit,
            syn::Type::Tuple(tuple) => {
                Type::Tuple(tuple.elems.iter().map(|ty| Some(self.parse(ty)?.0)).collect::<Option<_>>()?)
            }
            syn::Type::Array(array) => {
                let Expr::Lit(length) = &array.len else {
                    // The number of wavelengths of a path.
                    let is_n = matches!(&array.len, Expr::Path(path) if path.path.is_ident("N"));
                    return is_n.then_some((Type::Array(Box::new(self.parse(&array.elem)?.0), 4), false));
                };
                let syn::Lit::Int(length) = &length.lit else { return None };
                Type::Array(Box::new(self.parse(&array.elem)?.0), length.base10_parse().ok()?)
            }
            syn::Type::Path(path) => self.path(&path.path)?,
            _ => return None,
        };
        Some((parsed, false))
    }

    /// The type of a path.
    pub fn path(&self, path: &syn::Path) -> Option<Type> {
        let last = path.segments.last()?;
        let name = last.ident.to_string();
        let arguments: Vec<Type> = match &last.arguments {
            PathArguments::AngleBracketed(list) => {
                let types = list.args.iter().filter_map(|argument| match argument {
                    GenericArgument::Type(ty) => self.parse(ty).map(|(ty, _)| ty),
                    _ => None,
                });
                types.collect()
            }
            _ => Vec::new(),
        };
        Some(match name.as_str() {
            "R" | "f32" | "Real" => Type::Real,
            "I" | "Int" | "u32" | "usize" => Type::Uint,
            "i32" => Type::Sint,
            "Mask" | "bool" => Type::Bool,
            "Self" => self.owner.clone()?,
            "Point2" => Type::named("Vec2"),
            "Point3" | "Vector3" | "Normal3" => Type::named("Vec3"),
            "Option" => return None,
            name if self.parameters.contains_key(name) => self.parameters[name].clone(),
            // Numbers with lanes are no arguments in the translation.
            _ => {
                let is_number = |ty: &Type| matches!(ty, Type::Real | Type::Uint | Type::Bool);
                Type::Named(name, arguments.into_iter().filter(|ty| !is_number(ty)).collect())
            }
        })
    }
}

/// What a type parameter stands for, given a type that has it in its declaration and the type that
/// this has in a value.
pub fn argument(declared: &syn::Type, value: &Type, parameter: &str) -> Option<Type> {
    match declared {
        syn::Type::Reference(reference) => argument(&reference.elem, value, parameter),
        syn::Type::Path(path) if path.path.is_ident(parameter) => Some(value.clone()),
        syn::Type::Path(path) => {
            let (Type::Named(_, arguments), PathArguments::AngleBracketed(list)) =
                (value, &path.path.segments.last()?.arguments)
            else {
                return None;
            };
            // Numbers with lanes are no arguments of values.
            let is_number = |ty: &syn::Type| matches!(ty, syn::Type::Path(p) if p.path.is_ident("R"));
            let types = list.args.iter().filter_map(|argument| match argument {
                GenericArgument::Type(ty) if !is_number(ty) => Some(ty),
                _ => None,
            });
            types.zip(arguments).find_map(|(ty, value)| argument(ty, value, parameter))
        }
        _ => None,
    }
}
