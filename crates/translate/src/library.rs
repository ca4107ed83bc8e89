//! The items of the sources that are translated.

use std::collections::BTreeMap;

use quote::ToTokens;
use syn::{Block, Item, ItemMacro, Stmt};

use super::Result;
use super::types::{Type, last_name};

/// What may be translated. The conventions for names tell kinds apart.
pub struct Definition {
    /// Index of its source.
    pub source: usize,
    pub name: String,
    /// A function, a constant, a struct, or an enum without data.
    pub item: Item,
}

/// All items of some sources.
#[derive(Default)]
pub struct Library {
    /// The paths of the sources.
    pub sources: Vec<String>,
    pub definitions: Vec<Definition>,
    /// The places of the definitions of a type, or of none, with a name.
    places: BTreeMap<(Option<String>, String), Vec<usize>>,
    macros: BTreeMap<String, String>,
}

impl Library {
    /// Adds the items of a source.
    pub fn add(&mut self, path: &str, text: &str) -> Result<()> {
        let file = syn::parse_file(text).map_err(|error| format!("{path}: {error}"))?;
        self.sources.push(path.to_owned());
        file.items.into_iter().for_each(|item| self.add_item(None, item));
        Ok(())
    }

    fn add_item(&mut self, owner: Option<String>, item: Item) {
        let name = match &item {
            Item::Fn(item) => item.sig.ident.to_string(),
            Item::Const(item) => item.ident.to_string(),
            Item::Struct(item) => item.ident.to_string(),
            Item::Enum(item) if item.variants.iter().all(|v| v.fields.is_empty()) => item.ident.to_string(),
            Item::Impl(block) => {
                if let syn::Type::Path(path) = &*block.self_ty {
                    // What is in an impl is written as elsewhere.
                    let items = block.items.iter().map(|item| syn::parse2(item.to_token_stream()));
                    items.flatten().for_each(|item| self.add_item(Some(last_name(&path.path)), item));
                }
                return;
            }
            Item::Macro(item) => return self.add_macro(item),
            _ => return,
        };
        self.places.entry((owner, name.clone())).or_default().push(self.definitions.len());
        self.definitions.push(Definition { source: self.sources.len() - 1, name, item });
    }

    /// Keeps the rule of a macro; adds the items that a use of one makes, if the rule is
    /// `($parameter:ident) => { … }`.
    fn add_macro(&mut self, item: &ItemMacro) {
        let tokens = item.mac.tokens.to_string();
        if let Some(name) = &item.ident {
            self.macros.insert(name.to_string(), tokens);
        } else if let Some(rule) = self.macros.get(&last_name(&item.mac.path))
            && let Some((parameter, body)) = rule.split_once("=>")
            && let Some((parameter, _)) = parameter.trim_start_matches('(').split_once(" :")
            && let Ok(block) =
                syn::parse_str::<Block>(&body.trim_end_matches(';').replace(parameter, &tokens))
        {
            for statement in block.stmts {
                if let Stmt::Item(item) = statement {
                    self.add_item(None, item);
                }
            }
        }
    }

    /// What a name means in a source: an item of its own, else the only one that there is.
    pub fn find(&self, source: Option<usize>, owner: Option<&Type>, name: &str) -> Option<usize> {
        let owner = match owner {
            Some(owner) => Some(owner.name()?.to_owned()),
            None => None,
        };
        let places = self.places.get(&(owner, name.to_owned()))?;
        let own = places.iter().find(|&&index| Some(self.definitions[index].source) == source);
        own.or(places.first().filter(|_| places.len() == 1)).copied()
    }

    /// The number of items of this name that belong to no type.
    pub fn count(&self, name: &str) -> usize {
        self.places.get(&(None, name.to_owned())).map_or(0, Vec::len)
    }
}
