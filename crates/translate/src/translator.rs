//! What is needed of a library, item by item: whatever is translated requests what it uses.

use std::collections::BTreeMap;

use quote::ToTokens;
use syn::{Item, ItemStruct};

use super::library::Library;
use super::types::{Parameters, Type};
use super::{Result, names, stem};

/// The translation of a library's items as they are requested.
pub struct Translator<'a> {
    pub library: &'a Library,
    by_hand: &'a str,
    /// By place in the library and name, so that the output has the order of the input. Structs of
    /// tuples have no place. What is requested has no text yet.
    pub texts: BTreeMap<(Option<usize>, String), String>,
    pub pending: Vec<(usize, Option<Type>, String)>,
}

impl<'a> Translator<'a> {
    /// The translation of a library, except what there is by hand in WGSL.
    pub fn new(library: &'a Library, by_hand: &'a str) -> Self {
        Self { library, by_hand, texts: BTreeMap::new(), pending: Vec::new() }
    }

    /// Requests a function by its name, or a type's method.
    pub fn root(&mut self, source: usize, root: &str) -> Result<()> {
        let (owner, name) = root.rsplit_once("::").unwrap_or(("", root));
        let owner = syn::parse_str(owner).ok().and_then(|path| Type::of_path(&path, &Parameters::new()).ok());
        let index = self.library.find(Some(source), owner.as_ref(), name);
        let index = index.ok_or_else(|| format!("there is no {root} in {}", self.library.sources[source]))?;
        self.named(index, owner);
        Ok(())
    }

    /// The translations of a source's items, in its order; without a source, the structs of tuples.
    pub fn texts_of(&self, source: Option<usize>) -> Vec<&str> {
        let source_of = |index: usize| self.library.definitions[index].source;
        let texts = self.texts.iter().filter(|((index, _), _)| index.map(source_of) == source);
        texts.map(|(_, text)| text.as_str()).collect()
    }

    fn request(&mut self, index: usize, owner: Option<Type>, name: &str) {
        let key = (Some(index), name.to_owned());
        let declarations = [format!("fn {name}("), format!("alias {name} =")];
        let is_by_hand = declarations.iter().any(|declaration| self.by_hand.contains(declaration));
        if !is_by_hand && !self.texts.contains_key(&key) {
            self.texts.insert(key, String::new());
            self.pending.push((index, owner, name.to_owned()));
        }
    }

    /// Requests a function or constant; its name in WGSL.
    pub fn named(&mut self, index: usize, owner: Option<Type>) -> String {
        let definition = &self.library.definitions[index];
        let (name, is_constant) = (&definition.name, matches!(definition.item, Item::Const(_)));
        let name = match &owner {
            Some(owner) => format!("{owner}_{name}"),
            None if is_constant || self.library.count(name) > 1 || names::is_taken(name) => {
                format!("{}_{name}", stem(&self.library.sources[definition.source]))
            }
            None => name.clone(),
        };
        self.request(index, owner, &name);
        name
    }

    /// What `Self` and type parameters stand for in an impl for a type.
    pub fn parameters(&self, owner: Option<&Type>) -> Parameters {
        let Some(owner) = owner else { return Parameters::new() };
        let mut parameters = Parameters::from([("Self".to_owned(), owner.clone())]);
        if let (Type::Named(_, arguments), Ok(structure)) = (owner, self.structure(owner)) {
            parameters.extend(names_of_parameters(structure).zip(arguments.iter().cloned()));
        }
        parameters
    }

    fn structure(&self, ty: &Type) -> Result<&'a ItemStruct> {
        let index = ty.name().and_then(|name| self.library.find(None, None, name));
        match index.map(|index| &self.library.definitions[index].item) {
            Some(Item::Struct(item)) => Ok(item),
            _ => Err(format!("the struct {ty}")),
        }
    }

    /// A struct with the type arguments that the values of its fields have, where none are written.
    pub fn inferred(&self, ty: Type, values: &BTreeMap<String, (String, Type)>) -> Result<Type> {
        let mut arguments = Parameters::new();
        for (name, declared) in self.fields(&ty)? {
            values.get(&name).inspect(|(_, known)| declared.infer(known, &mut arguments));
        }
        match &ty {
            Type::Named(name, written) if written.is_empty() => {
                let inferred = names_of_parameters(self.structure(&ty)?).map(|parameter| {
                    arguments.remove(&parameter).ok_or_else(|| format!("the type {parameter} of {ty}"))
                });
                Ok(Type::Named(name.clone(), inferred.collect::<Result<_>>()?))
            }
            _ => Ok(ty),
        }
    }

    /// The fields of a struct or tuple, and their types.
    pub fn fields(&self, ty: &Type) -> Result<Vec<(String, Type)>> {
        if let Type::Tuple(types) = ty {
            return Ok(types.iter().enumerate().map(|(i, ty)| (i.to_string(), ty.clone())).collect());
        }
        let structure = self.structure(ty)?;
        let parameters = self.parameters(Some(ty));
        let typed = structure.fields.members().zip(&structure.fields).map(|(name, field)| {
            Ok((name.to_token_stream().to_string(), Type::parse(&field.ty, &parameters)?))
        });
        typed.collect()
    }

    /// What a struct of one unnamed field stands for.
    pub fn inside(&self, ty: &Type) -> Option<Type> {
        match &self.fields(ty).ok()?[..] {
            [(name, inside)] if name == "0" => Some(inside.clone()),
            _ => None,
        }
    }

    /// The type and the number of the elements of an array, or of what is one in WGSL.
    pub fn array(&self, ty: &Type) -> Result<(Type, usize)> {
        match self.inside(ty).unwrap_or(ty.clone()) {
            Type::Array(element, count) => Ok((*element, count)),
            ty => Ok((Type::Real, ty.coordinates().ok_or_else(|| format!("the elements of {ty}"))?)),
        }
    }

    /// A type in WGSL; requests its declaration.
    pub fn spell(&mut self, ty: &Type) -> Result<String> {
        Ok(match ty {
            Type::Array(element, count @ 2..=4) if **element == Type::Real => format!("vec{count}f"),
            Type::Array(element, count) => format!("array<{}, {count}>", self.spell(element)?),
            Type::Tuple(types) if types.is_empty() => return Err("no value".into()),
            Type::Tuple(_) => {
                let text = self.declaration(ty)?;
                self.texts.insert((None, ty.to_string()), text);
                ty.to_string()
            }
            Type::Named(name, _) if ty.coordinates().is_some() => name.to_lowercase() + "f",
            Type::Named(name, _) => {
                let index = self.library.find(None, None, name).ok_or_else(|| format!("the type {name}"))?;
                match (&self.library.definitions[index].item, self.inside(ty)) {
                    (Item::Enum(_), _) => "u32".into(),
                    (_, Some(inside)) => self.spell(&inside)?,
                    _ => {
                        self.request(index, Some(ty.clone()), &ty.to_string());
                        ty.to_string()
                    }
                }
            }
            _ => ty.to_string(),
        })
    }

    /// The declaration of a struct.
    pub fn declaration(&mut self, ty: &Type) -> Result<String> {
        let mut text = format!("struct {ty} {{\n");
        for (field, ty) in self.fields(ty)? {
            text += &format!("    {}: {},\n", names::member(&field), self.spell(&ty)?);
        }
        Ok(text + "}\n")
    }

    /// Requests an enum; the name of one of its variants in WGSL.
    pub fn variant(&mut self, ty: &Type, variant: &str) -> Option<String> {
        let index = self.library.find(None, None, ty.name()?)?;
        let Item::Enum(item) = &self.library.definitions[index].item else { return None };
        self.request(index, None, ty.name()?);
        item.variants.iter().any(|known| known.ident == variant).then(|| format!("{ty}_{variant}"))
    }
}

/// The type parameters of a struct but those of numbers with lanes.
fn names_of_parameters(structure: &ItemStruct) -> impl Iterator<Item = String> {
    let names = structure.generics.type_params().map(|parameter| parameter.ident.to_string());
    names.filter(|name| name != "R" && name != "I")
}
