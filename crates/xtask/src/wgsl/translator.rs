//! What is needed of a library, item by item: whatever is translated requests what it uses.

use std::collections::{BTreeMap, BTreeSet};

use super::library::{Function, Library};
use super::names;
use super::types::{self, Type, TypeNames};

/// What has a body that is to be translated, by its index in the library.
pub enum Request {
    Function { index: usize, owner: Option<Type>, name: String },
    Constant { index: usize, owner: Option<Type>, name: String, ty: Type },
}

/// The translation of a library's items as they are requested.
pub struct Translator<'a> {
    pub library: &'a Library,
    /// By source, place in it and name, so that the output has the order of the input.
    items: BTreeMap<(usize, usize, String), String>,
    /// Structs of tuples, which belong to no source.
    tuples: BTreeMap<String, String>,
    pending: Vec<Request>,
    requested: BTreeSet<String>,
}

impl<'a> Translator<'a> {
    pub fn new(library: &'a Library) -> Self {
        let (items, tuples) = (BTreeMap::new(), BTreeMap::new());
        Self { library, items, tuples, pending: Vec::new(), requested: BTreeSet::new() }
    }

    /// Requests a function by its name, or a type's method or all methods of numbers with lanes.
    pub fn root(&mut self, source: usize, root: &str) -> Result<(), String> {
        let missing = || format!("there is no {root} in {}", self.library.stems[source]);
        if let Some((owner, method)) = root.split_once("::") {
            let owner = syn::parse_str(owner).ok().and_then(|path| TypeNames::default().path(&path));
            let index = owner.as_ref().and_then(|owner| self.library.method(owner.name()?, method));
            self.function(index.ok_or_else(missing)?, owner);
        } else {
            let index = self.library.function(source, root).ok_or_else(missing)?;
            self.function(index, None);
        }
        Ok(())
    }

    /// What is to be translated next.
    pub fn next(&mut self) -> Option<Request> {
        self.pending.pop()
    }

    /// Adds a translation of a source's item at its place.
    pub fn add(&mut self, source: usize, order: usize, name: String, text: String) {
        self.items.insert((source, order, name), text);
    }

    /// The translations of a source's items, in its order.
    pub fn items(&self, source: usize) -> impl Iterator<Item = &str> {
        self.items.iter().filter(move |((of, ..), _)| *of == source).map(|(_, text)| text.as_str())
    }

    /// The structs of tuples.
    pub fn tuples(&self) -> impl Iterator<Item = &str> {
        self.tuples.values().map(String::as_str)
    }

    /// Requests a function or method of a type; its name in WGSL.
    pub fn function(&mut self, index: usize, owner: Option<Type>) -> String {
        let name = self.function_name(&self.library.functions[index], owner.as_ref());
        let by_hand = super::BY_HAND.contains(&name.as_str());
        if self.requested.insert(name.clone()) && !by_hand {
            self.pending.push(Request::Function { index, owner, name: name.clone() });
        }
        name
    }

    fn function_name(&self, function: &Function, owner: Option<&Type>) -> String {
        let name = function.signature.ident.to_string();
        match owner {
            Some(owner) => format!("{}_{name}", self.mangled(owner)),
            None if self.library.is_ambiguous(&name) || names::is_taken(&name) => {
                format!("{}_{name}", self.library.stems[function.source])
            }
            None => name,
        }
    }

    /// A type in a name.
    fn mangled(&self, ty: &Type) -> String {
        match ty {
            Type::Named(name, arguments) => {
                let arguments = arguments.iter().map(|ty| format!("_{}", self.mangled(ty)));
                format!("{name}{}", arguments.collect::<String>())
            }
            Type::Array(element, length) => format!("{}{length}", self.mangled(element)),
            Type::Tuple(elements) => {
                format!(
                    "Tuple{}",
                    elements.iter().map(|ty| format!("_{}", self.mangled(ty))).collect::<String>()
                )
            }
            Type::Bool => "bool".into(),
            Type::Real => "f32".into(),
            Type::Sint => "i32".into(),
            Type::Uint | Type::Literal => "u32".into(),
            Type::Unit => "unit".into(),
        }
    }

    /// What type parameters of a struct stand for.
    pub fn names_of(&self, owner: Option<Type>) -> TypeNames {
        let mut names = TypeNames { owner, ..TypeNames::default() };
        if let Some(Type::Named(name, arguments)) = &names.owner
            && let Some(structure) = self.library.structures.get(name)
        {
            names.parameters = structure.parameters.iter().cloned().zip(arguments.iter().cloned()).collect();
        }
        names
    }

    /// A struct with the type arguments that the values of its fields have, where none are written.
    pub fn inferred(&self, ty: Type, values: &[(String, String, Type)]) -> Type {
        let Type::Named(name, arguments) = &ty else { return ty };
        let Some(structure) = self.library.structures.get(name) else { return ty };
        if arguments.len() == structure.parameters.len() {
            return ty;
        }
        let find = |parameter: &String| {
            values.iter().find_map(|(field, _, value)| {
                let (_, declared) = structure.fields.iter().find(|(known, _)| known == field)?;
                types::argument(declared, value, parameter)
            })
        };
        let found: Option<Vec<Type>> = structure.parameters.iter().map(find).collect();
        found.map_or(ty.clone(), |arguments| Type::Named(name.clone(), arguments))
    }

    /// The types of a struct's fields.
    pub fn fields(&self, ty: &Type) -> Option<Vec<(String, Type)>> {
        if let Some(count) = ty.coordinates() {
            return Some(["x", "y", "z"][..count].iter().map(|c| (c.to_string(), Type::Real)).collect());
        }
        let structure = self.library.structures.get(ty.name()?)?;
        let names = self.names_of(Some(ty.clone()));
        let typed = structure.fields.iter().map(|(name, ty)| Some((name.clone(), names.parse(ty)?.0)));
        typed.collect()
    }

    /// What a struct of one unnamed field stands for.
    pub fn inside(&self, ty: &Type) -> Option<Type> {
        let structure = self.library.structures.get(ty.name()?)?;
        let [(_, inside)] = <[_; 1]>::try_from(self.fields(ty)?).ok()?;
        structure.transparent.then_some(inside)
    }

    /// A type in WGSL; requests its declaration.
    pub fn spell(&mut self, ty: &Type) -> Result<String, String> {
        Ok(match ty {
            Type::Unit => return Err("a value without a type".into()),
            Type::Array(element, count @ 2..=4) if **element == Type::Real => format!("vec{count}f"),
            Type::Array(element, count) => format!("array<{}, {count}>", self.spell(element)?),
            Type::Tuple(elements) => {
                let fields = elements.iter().enumerate().map(|(i, ty)| (format!("v{i}"), ty.clone()));
                self.aggregate(ty, fields.collect())?
            }
            Type::Named(name, _) if self.library.enumerations.contains_key(name) => "u32".into(),
            Type::Named(name, _) if super::RECORDS.contains(&name.as_str()) => "u32".into(),
            Type::Named(name, _) if ty.coordinates().is_some() => name.to_lowercase() + "f",
            Type::Named(..) => match self.inside(ty) {
                Some(inside) => self.spell(&inside)?,
                None => self.structure(ty)?,
            },
            _ => self.mangled(ty),
        })
    }

    fn aggregate(&mut self, ty: &Type, fields: Vec<(String, Type)>) -> Result<String, String> {
        let name = self.mangled(ty);
        if self.requested.insert(name.clone()) {
            let text = self.declaration(&name, fields)?;
            self.tuples.insert(name.clone(), text);
        }
        Ok(name)
    }

    fn structure(&mut self, ty: &Type) -> Result<String, String> {
        let name = self.mangled(ty);
        if self.requested.insert(name.clone()) {
            let library = self.library;
            let base = ty.name().unwrap_or_default();
            let structure = library.structures.get(base).ok_or_else(|| format!("no struct {base}"))?;
            let fields =
                self.fields(ty).ok_or_else(|| format!("{name} has a field without a translation"))?;
            let text = documented(&structure.docs, &self.declaration(&name, fields)?);
            self.add(structure.source, structure.order, name.clone(), text);
        }
        Ok(name)
    }

    fn declaration(&mut self, name: &str, fields: Vec<(String, Type)>) -> Result<String, String> {
        let mut text = format!("struct {name} {{\n");
        for (field, ty) in fields {
            text += &format!("    {}: {},\n", names::member(&field), self.spell(&ty)?);
        }
        Ok(text + "}\n")
    }

    /// Requests a constant; its name in WGSL and its type.
    pub fn constant(&mut self, index: usize) -> Result<(String, Type), String> {
        let library = self.library;
        let constant = &library.constants[index];
        let owner = constant.owner.as_deref().map(Type::named);
        let names = self.names_of(owner.clone());
        let name = match &owner {
            Some(owner) => format!("{}_{}", self.mangled(owner), constant.name),
            None => format!("{}_{}", library.stems[constant.source], constant.name),
        };
        let (ty, _) = names.parse(&constant.ty).ok_or_else(|| format!("the type of {name}"))?;
        if self.requested.insert(name.clone()) {
            self.pending.push(Request::Constant { index, owner, name: name.clone(), ty: ty.clone() });
        }
        Ok((name, ty))
    }

    /// Requests an enum; the name of one of its variants in WGSL.
    pub fn variant(&mut self, name: &str, variant: &str) -> Option<String> {
        let enumeration = self.library.enumerations.get(name)?;
        let constant = |(i, variant)| format!("const {name}_{variant} = {i}u;\n");
        let text = enumeration.variants.iter().enumerate().map(constant).collect();
        self.add(enumeration.source, enumeration.order, name.to_owned(), text);
        enumeration.variants.iter().any(|known| known == variant).then(|| format!("{name}_{variant}"))
    }
}

/// A declaration after its documentation.
pub fn documented(docs: &[String], declaration: &str) -> String {
    docs.iter().map(|line| format!("// {line}\n")).collect::<String>() + declaration
}
