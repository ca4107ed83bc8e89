//! The methods of vectors, which `math` makes by a macro for each number of coordinates.

use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use syn::{Item, ItemMacro};

/// The vectors of `math` and their coordinates.
const VECTORS: [(&str, &[&str]); 2] = [("Vec2", &["x", "y"]), ("Vec3", &["x", "y", "z"])];

/// The methods that the macro `vector` makes for all vectors; nothing of other macros.
pub fn methods(definition: &ItemMacro) -> Vec<Item> {
    if definition.ident.as_ref().is_none_or(|name| name != "vector") {
        return Vec::new();
    }
    let body = definition.mac.tokens.clone().into_iter().find_map(|token| match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some(group.stream()),
        _ => None,
    });
    let files = VECTORS.iter().filter_map(|(name, coordinates)| {
        syn::parse2::<syn::File>(expanded(body.clone()?, name, coordinates, None)).ok()
    });
    let items = files.flat_map(|file| file.items);
    items.filter(|item| matches!(item, Item::Impl(item) if item.trait_.is_none())).collect()
}

/// The macro's body for a vector; within a repetition, for one of its coordinates.
fn expanded(body: TokenStream, name: &str, coordinates: &[&str], coordinate: Option<&str>) -> TokenStream {
    let mut output = Vec::new();
    let mut tokens = body.into_iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Punct(sign) if sign.as_char() == '$' => match tokens.next() {
                Some(TokenTree::Ident(parameter)) => {
                    let meaning = match parameter.to_string().as_str() {
                        "vector" => name.to_owned(),
                        "c" => coordinate.unwrap_or_default().to_owned(),
                        "n" | "i" => {
                            let place = coordinates.iter().position(|c| Some(*c) == coordinate);
                            let number = place.unwrap_or(coordinates.len());
                            output.push(proc_macro2::Literal::usize_unsuffixed(number).into());
                            continue;
                        }
                        other => other.to_owned(),
                    };
                    output.push(Ident::new(&meaning, Span::call_site()).into());
                }
                Some(TokenTree::Group(group)) => {
                    let is_end =
                        |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == '*');
                    let separator: Vec<TokenTree> =
                        tokens.by_ref().take_while(|token| !is_end(token)).collect();
                    for (i, coordinate) in coordinates.iter().enumerate() {
                        if i > 0 {
                            output.extend(separator.clone());
                        }
                        output.extend(expanded(group.stream(), name, coordinates, Some(coordinate)));
                    }
                }
                _ => {}
            },
            TokenTree::Group(group) => {
                let inside = expanded(group.stream(), name, coordinates, coordinate);
                output.push(Group::new(group.delimiter(), inside).into());
            }
            token => output.push(token),
        }
    }
    output.into_iter().collect()
}
