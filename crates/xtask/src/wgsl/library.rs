//! The items of the sources that are translated.

use std::collections::BTreeMap;

use super::vectors;
use quote::ToTokens;
use syn::{Attribute, Block, Expr, Fields, GenericParam, ImplItem, Item, Signature, Visibility};

/// A function or method.
pub struct Function {
    /// Index of its source.
    pub source: usize,
    /// Place among all items, in the order of the sources.
    pub order: usize,
    /// The type that it is a method of.
    pub owner: Option<String>,
    /// Whether files that are not relatives see it.
    pub public: bool,
    pub signature: Signature,
    pub block: Block,
    pub docs: Vec<String>,
}

/// A struct.
pub struct Structure {
    pub source: usize,
    pub order: usize,
    pub fields: Vec<(String, syn::Type)>,
    /// Whether it is one unnamed field, which stands for it in WGSL.
    pub transparent: bool,
    /// Its type parameters but those of numbers with lanes.
    pub parameters: Vec<String>,
    pub docs: Vec<String>,
}

/// A constant of a source or of a type.
pub struct Constant {
    pub source: usize,
    pub order: usize,
    pub owner: Option<String>,
    pub name: String,
    pub ty: syn::Type,
    pub value: Expr,
}

/// An enum without data.
pub struct Enumeration {
    pub source: usize,
    pub order: usize,
    pub variants: Vec<String>,
}

/// All items of some sources.
#[derive(Default)]
pub struct Library {
    /// The names of the sources without folder and ending.
    pub stems: Vec<String>,
    pub functions: Vec<Function>,
    pub structures: BTreeMap<String, Structure>,
    pub enumerations: BTreeMap<String, Enumeration>,
    pub constants: Vec<Constant>,
    order: usize,
}

impl Library {
    /// Adds the items of a source with this stem.
    pub fn add(&mut self, stem: &str, text: &str) -> Result<(), String> {
        let file = syn::parse_file(text).map_err(|error| format!("{stem}: {error}"))?;
        self.stems.push(stem.to_owned());
        file.items.into_iter().for_each(|item| self.add_item(item));
        Ok(())
    }

    fn add_item(&mut self, item: Item) {
        let source = self.stems.len() - 1;
        self.order += 1;
        let order = self.order;
        match item {
            Item::Fn(item) => self.functions.push(Function {
                source,
                order,
                owner: None,
                public: !matches!(item.vis, Visibility::Inherited),
                docs: docs(&item.attrs),
                signature: item.sig,
                block: *item.block,
            }),
            Item::Struct(item) => {
                let transparent =
                    matches!(&item.fields, Fields::Unnamed(fields) if fields.unnamed.len() == 1);
                let name = |i: usize, field: &syn::Field| {
                    field.ident.as_ref().map_or(i.to_string(), ToString::to_string)
                };
                let fields = item.fields.iter().enumerate().map(|(i, f)| (name(i, f), f.ty.clone()));
                let structure = Structure {
                    source,
                    order,
                    fields: fields.collect(),
                    transparent,
                    parameters: parameters(&item.generics),
                    docs: docs(&item.attrs),
                };
                self.structures.insert(item.ident.to_string(), structure);
            }
            Item::Enum(item) if item.variants.iter().all(|variant| variant.fields.is_empty()) => {
                let variants = item.variants.iter().map(|variant| variant.ident.to_string()).collect();
                let enumeration = Enumeration { source, order, variants };
                self.enumerations.insert(item.ident.to_string(), enumeration);
            }
            Item::Const(item) => self.constants.push(Constant {
                source,
                order,
                owner: None,
                name: item.ident.to_string(),
                ty: *item.ty,
                value: *item.expr,
            }),
            Item::Impl(item) => {
                let syn::Type::Path(path) = &*item.self_ty else { return };
                let Some(owner) = path.path.segments.last() else { return };
                let owner = owner.ident.to_string();
                item.items.into_iter().for_each(|item| self.add_impl_item(&owner, item));
            }
            Item::Macro(definition) => {
                vectors::methods(&definition).into_iter().for_each(|item| self.add_item(item));
            }
            _ => {}
        }
    }

    fn add_impl_item(&mut self, owner: &str, item: ImplItem) {
        let source = self.stems.len() - 1;
        self.order += 1;
        let (order, owner) = (self.order, Some(owner.to_owned()));
        match item {
            ImplItem::Fn(item) => self.functions.push(Function {
                source,
                order,
                owner,
                public: true,
                docs: docs(&item.attrs),
                signature: item.sig,
                block: item.block,
            }),
            ImplItem::Const(item) => self.constants.push(Constant {
                source,
                order,
                owner,
                name: item.ident.to_string(),
                ty: item.ty,
                value: item.expr,
            }),
            _ => {}
        }
    }

    /// The method of a type.
    pub fn method(&self, owner: &str, name: &str) -> Option<usize> {
        let is_it = |f: &Function| f.owner.as_deref() == Some(owner) && f.signature.ident == name;
        self.functions.iter().position(is_it)
    }

    /// The function that a name means in a source: its own, else a public one, else one that is
    /// private to a relative.
    pub fn function(&self, source: usize, name: &str) -> Option<usize> {
        let find = |visible: &dyn Fn(&Function) -> bool| {
            self.functions.iter().position(|f| f.owner.is_none() && f.signature.ident == name && visible(f))
        };
        find(&|f| f.source == source).or_else(|| find(&|f| f.public)).or_else(|| find(&|_| true))
    }

    /// The constant that a name means in a source.
    pub fn constant(&self, source: usize, owner: Option<&str>, name: &str) -> Option<usize> {
        let is_it = |c: &Constant| c.owner.as_deref() == owner && c.name == name;
        let own = self.constants.iter().position(|c| is_it(c) && c.source == source);
        own.or_else(|| self.constants.iter().position(is_it))
    }

    /// Whether several sources have a function of this name.
    pub fn is_ambiguous(&self, name: &str) -> bool {
        self.functions.iter().filter(|f| f.owner.is_none() && f.signature.ident == name).count() > 1
    }
}

/// The type parameters that are not numbers with lanes.
fn parameters(generics: &syn::Generics) -> Vec<String> {
    let names = generics.params.iter().filter_map(|parameter| match parameter {
        GenericParam::Type(parameter) => Some(parameter.ident.to_string()),
        _ => None,
    });
    names.filter(|name| !["R", "I"].contains(&name.as_str())).collect()
}

/// The first paragraph of an item's documentation.
fn docs(attributes: &[Attribute]) -> Vec<String> {
    let lines = attributes.iter().filter(|a| a.path().is_ident("doc")).filter_map(|attribute| {
        let syn::Meta::NameValue(meta) = &attribute.meta else { return None };
        let text = meta.value.to_token_stream().to_string();
        let text: syn::LitStr = syn::parse_str(&text).ok()?;
        Some(text.value().trim().to_owned())
    });
    lines.take_while(|line| !line.is_empty()).collect()
}
