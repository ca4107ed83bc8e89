//! Bodies of functions: parameters, statements, patterns, and branches.

use std::collections::BTreeMap;

use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{
    Arm, Attribute, Block, Expr, ExprReturn, FnArg, Item, ItemFn, Local, Pat, PatType, ReceiverKind,
    ReturnType, Signature, Stmt, parse_quote,
};

use super::translator::Translator;
use super::types::{Parameters, Type};
use super::value::{Context, Value, bare};
use super::{Result, names};

/// The translation of one item. Expressions that need statements of WGSL write them first.
pub struct Body<'t, 'a> {
    pub translator: &'t mut Translator<'a>,
    pub context: Context,
    /// The source and the line that are translated, for errors.
    pub place: (usize, usize),
    /// The names in WGSL that are used, and whether they are those of variables.
    used: BTreeMap<String, bool>,
    lines: Vec<String>,
}

/// What becomes of the value of an expression.
#[derive(Clone, Copy)]
pub enum Mode {
    Ignore,
    Return,
    Take,
}

impl<'t, 'a> Body<'t, 'a> {
    pub fn new(translator: &'t mut Translator<'a>, source: usize, owner: Option<&Type>) -> Self {
        let parameters = translator.parameters(owner);
        let context = Context { source, parameters, scopes: Vec::new(), is_inlined: false };
        Self { translator, context, place: (source, 0), used: BTreeMap::new(), lines: Vec::new() }
    }

    /// An item with its documentation.
    pub fn item(&mut self, item: &Item, name: &str) -> Result<String> {
        self.place.1 = item.span().start().line;
        Ok(match item {
            Item::Fn(function) => documentation(&function.attrs) + &self.function(name, function)?,
            Item::Const(constant) => {
                let ty = Type::parse(&constant.ty, &self.context.parameters)?;
                let (value, _) = self.plain(&constant.expr)?;
                if !self.lines.is_empty() {
                    return Err("a constant that needs statements".into());
                }
                format!("const {name}: {} = {};\n", self.translator.spell(&ty)?, bare(&value))
            }
            Item::Struct(structure) => {
                let declaration = self.translator.declaration(&self.context.parameters["Self"])?;
                documentation(&structure.attrs) + &declaration
            }
            Item::Enum(item) => {
                let variants = item.variants.iter().enumerate();
                variants.map(|(i, v)| format!("const {name}_{} = {i}u;\n", v.ident)).collect()
            }
            _ => return Err("an item without a translation".into()),
        })
    }

    fn function(&mut self, name: &str, function: &ItemFn) -> Result<String> {
        let (arrow, mode) = match result_type(&function.sig, &self.context.parameters)? {
            Type::Tuple(types) if types.is_empty() => (String::new(), Mode::Ignore),
            ty => (format!(" -> {}", self.translator.spell(&ty)?), Mode::Return),
        };
        let mut spelled = Vec::new();
        let (lines, _) = self.nested(|body| {
            for (i, PatType { pat, ty, .. }) in inputs(&function.sig).iter().enumerate() {
                let input = body.identifier(&match &**pat {
                    Pat::Ident(pattern) => pattern.ident.to_string(),
                    Pat::Wild(_) => format!("unused_{i}"),
                    _ => format!("argument_{i}"),
                });
                let is_pointer = is_pointer(ty);
                let ty = Type::parse(ty, &body.context.parameters)?;
                let spelling = body.translator.spell(&ty)?;
                if is_pointer {
                    spelled.push(format!("{input}: ptr<function, {spelling}>"));
                    body.bind(pat, Value::Place(format!("(*{input})"), ty))?;
                } else {
                    spelled.push(format!("{input}: {spelling}"));
                    body.bind(pat, Value::Plain(input, ty))?;
                }
            }
            body.block(&function.block, mode)
        })?;
        Ok(format!("fn {name}({}){arrow} {{\n{}}}\n", spelled.join(", "), lines.concat()))
    }

    /// Writes a line.
    pub fn line(&mut self, text: &str) {
        self.lines.push(format!("{text}\n"));
    }

    /// The lines that `write` writes, one level deeper, in a scope of their own.
    fn nested<T>(&mut self, write: impl FnOnce(&mut Self) -> Result<T>) -> Result<(Vec<String>, T)> {
        let before = std::mem::take(&mut self.lines);
        self.context.scopes.push(BTreeMap::new());
        let value = write(self)?;
        self.context.scopes.pop();
        let lines = std::mem::replace(&mut self.lines, before);
        Ok((lines.into_iter().map(|line| format!("    {line}")).collect(), value))
    }

    /// Writes lines in braces after what they belong to.
    pub fn braced(&mut self, head: &str, write: impl FnOnce(&mut Self) -> Result<Value>) -> Result<Value> {
        let (lines, _) = self.nested(write)?;
        self.line(&format!("{head}{{"));
        self.lines.extend(lines);
        self.line("}");
        Ok(Value::Unit)
    }

    /// A name in WGSL that is not used yet, like the given one.
    pub fn identifier(&mut self, like: &str) -> String {
        let like = like.trim_start_matches('_');
        let like = if like.is_empty() { "i" } else { like };
        let is_free = |name: &String| {
            !self.used.contains_key(name)
                && !names::is_taken(name)
                && self.translator.library.count(name) == 0
        };
        let numbered = (1..).map(|i| format!("{like}_{i}"));
        let name = std::iter::once(like.to_owned()).chain(numbered).find(is_free).unwrap_or_default();
        self.used.insert(name.clone(), false);
        name
    }

    /// What a name of Rust means.
    pub fn lookup(&self, name: &str) -> Option<Value> {
        let name = if name == "self" { "this_" } else { name };
        self.context.scopes.iter().rev().find_map(|scope| scope.get(name)).cloned()
    }

    /// Keeps a value that is used more than once, or later.
    pub fn stored(&mut self, like: &str, value: Value, is_variable: bool) -> Result<Value> {
        let mut stored_all = |values: Vec<Value>| -> Result<Vec<Value>> {
            let numbered = values.into_iter().enumerate();
            numbered.map(|(i, value)| self.stored(&format!("{like}_{i}"), value, false)).collect()
        };
        match value {
            Value::Tuple(values) if !is_variable => stored_all(values).map(Value::Tuple),
            Value::Array(values) if !is_variable => stored_all(values).map(Value::Array),
            Value::Plain(text, ty) if !is_variable && self.is_fixed(&text) => Ok(Value::Plain(text, ty)),
            Value::Plain(..) | Value::Tuple(_) | Value::Array(_) => {
                let (text, ty) = match self.materialized(value)? {
                    (text, Type::Literal) => (format!("u32({text})"), Type::Uint),
                    materialized => materialized,
                };
                let name = self.identifier(like);
                let keyword = if is_variable { "var" } else { "let" };
                self.line(&format!("{keyword} {name} = {};", bare(&text)));
                self.used.insert(name.clone(), is_variable);
                Ok(Value::Plain(name, ty))
            }
            other => Ok(other),
        }
    }

    /// Whether an expression is a number, or the name of what does not change.
    fn is_fixed(&self, text: &str) -> bool {
        names::is_number(text) || names::is_identifier(text) && self.used.get(text) != Some(&true)
    }

    /// An expression of a value that is used more than once, and its type.
    pub fn kept(&mut self, like: &str, value: Value) -> Result<(String, Type)> {
        let value = self.stored(like, value, false)?;
        self.materialized(value)
    }

    /// Binds the names of a pattern.
    pub fn bind(&mut self, pattern: &Pat, value: Value) -> Result<()> {
        match pattern {
            Pat::Wild(_) => Ok(()),
            Pat::Ident(pattern) => {
                let name = pattern.ident.to_string();
                let value = self.stored(&name, value, pattern.mutability.is_some())?;
                self.context.scopes.last_mut().map(|scope| scope.insert(name, value));
                Ok(())
            }
            Pat::Type(pattern) => self.bind(&pattern.pat, value),
            Pat::Reference(pattern) => self.bind(&pattern.pat, value),
            Pat::Tuple(syn::PatTuple { elems, .. }) | Pat::Slice(syn::PatSlice { elems, .. }) => {
                let named = elems.iter().take_while(|pattern| !matches!(pattern, Pat::Rest(_)));
                let mut parts = named.zip(self.elements(value)?);
                parts.try_for_each(|(pattern, part)| self.bind(pattern, part))
            }
            Pat::Struct(pattern) => {
                let value = self.stored("parts", value, false)?;
                pattern.fields.iter().try_for_each(|field| {
                    let part = self.field(value.clone(), &field.member)?;
                    self.bind(&field.pat, part)
                })
            }
            _ => Err(format!("the pattern {}", pattern.to_token_stream())),
        }
    }

    /// Writes the statements of a block; what becomes of its value.
    pub fn block(&mut self, block: &Block, mode: Mode) -> Result<Value> {
        let mut value = Value::Unit;
        for (i, statement) in block.stmts.iter().enumerate() {
            let place = (self.context.source, statement.span().start().line);
            let before = std::mem::replace(&mut self.place, place);
            value = self.statement(statement, if i + 1 < block.stmts.len() { Mode::Ignore } else { mode })?;
            self.place = before;
        }
        Ok(value)
    }

    fn statement(&mut self, statement: &Stmt, mode: Mode) -> Result<Value> {
        match statement {
            Stmt::Local(Local { pat, init: Some(init), .. }) if init.diverge.is_none() => {
                let value = self.expression(&init.expr)?;
                self.bind(pat, value)?;
            }
            Stmt::Item(Item::Const(constant)) => {
                let (name, value) = (&constant.ident, self.expression(&constant.expr)?);
                self.bind(&parse_quote!(#name), value)?;
            }
            Stmt::Expr(expression, None) => return self.evaluate(expression, mode),
            Stmt::Expr(expression, Some(_)) => {
                self.evaluate(expression, Mode::Ignore)?;
            }
            Stmt::Macro(statement) if statement.mac.path.is_ident("debug_assert") => {}
            _ => return Err(format!("the statement {}", statement.to_token_stream())),
        }
        Ok(Value::Unit)
    }

    /// Writes an expression; what becomes of its value.
    pub fn evaluate(&mut self, expression: &Expr, mode: Mode) -> Result<Value> {
        match (expression, mode) {
            (Expr::If(_) | Expr::Match(_), _) => self.branches(expression, mode),
            (Expr::Block(block), _) => {
                self.context.scopes.push(BTreeMap::new());
                let value = self.block(&block.block, mode);
                self.context.scopes.pop();
                value
            }
            (Expr::Return(_), _) if self.context.is_inlined => Err("a return from what is inlined".into()),
            (Expr::Return(ExprReturn { expr: Some(result), .. }), _) => self.evaluate(result, Mode::Return),
            (Expr::Return(_), _) => {
                self.line("return;");
                Ok(Value::Unit)
            }
            (_, Mode::Return) => {
                let (text, _) = self.plain(expression)?;
                self.line(&format!("return {};", bare(&text)));
                Ok(Value::Unit)
            }
            _ => self.expression(expression),
        }
    }

    /// Writes an `if` or `match`; what becomes of its value.
    fn branches(&mut self, expression: &Expr, mode: Mode) -> Result<Value> {
        let mut branches: Vec<(Option<String>, Block)> = Vec::new();
        match expression {
            Expr::If(choice) => {
                branches.push((Some(self.plain(&choice.cond)?.0), choice.then_branch.clone()));
                branches.extend(choice.else_branch.iter().map(|(_, other)| (None, parse_quote!({ #other }))));
            }
            Expr::Match(choice) => {
                let value = self.expression(&choice.expr)?;
                let (value, _) = self.kept("choice", value)?;
                for (i, Arm { pat, body, .. }) in choice.arms.iter().enumerate() {
                    let test = self.test(pat, &value)?;
                    // The last one needs no test, because matches are exhaustive.
                    branches.push((test.filter(|_| i + 1 < choice.arms.len()), parse_quote!({ #body })));
                }
            }
            _ => {}
        }
        let mut written = Vec::new();
        for (condition, block) in branches {
            let (lines, value) = self.nested(|body| match body.block(&block, mode)? {
                Value::Unit => Ok(None),
                value => body.materialized(value).map(Some),
            })?;
            written.push((condition, lines, value));
        }
        let mut result = Value::Unit;
        if let Some((_, ty)) = written.iter().find_map(|(.., value)| value.clone()) {
            let name = self.identifier("chosen");
            let spelled = self.translator.spell(&ty)?;
            self.line(&format!("var {name}: {spelled};"));
            self.used.insert(name.clone(), true);
            result = Value::Plain(name, ty);
        }
        for (i, (condition, lines, value)) in written.into_iter().enumerate() {
            let start = if i == 0 { "" } else { "} else " };
            let test = condition.map_or(String::new(), |test| format!("if ({}) ", bare(&test)));
            self.line(&format!("{start}{test}{{"));
            self.lines.extend(lines);
            if let (Some((text, _)), Value::Plain(name, _)) = (value, &result) {
                self.line(&format!("    {name} = {};", bare(&text)));
            }
        }
        self.line("}");
        Ok(result)
    }

    /// The condition under which a pattern matches; `None` if it always does.
    fn test(&mut self, pattern: &Pat, text: &str) -> Result<Option<String>> {
        let value = match pattern {
            Pat::Wild(_) => return Ok(None),
            Pat::Path(path) => Expr::Path(path.clone()),
            Pat::Lit(literal) => Expr::Lit(literal.clone()),
            _ => return Err(format!("the pattern {}", pattern.to_token_stream())),
        };
        Ok(Some(format!("({text} == {})", self.plain(&value)?.0)))
    }
}

/// The type of a function's result.
pub fn result_type(signature: &Signature, parameters: &Parameters) -> Result<Type> {
    match &signature.output {
        ReturnType::Default => Ok(Type::Tuple(Vec::new())),
        ReturnType::Type(_, ty) => Type::parse(ty, parameters),
    }
}

/// The parameters of a function; the receiver is one, too, with its name in WGSL.
pub fn inputs(signature: &Signature) -> Vec<PatType> {
    let typed = signature.inputs.iter().map(|input| match input {
        FnArg::Typed(input) => input.clone(),
        FnArg::Receiver(receiver) => match (&receiver.kind, receiver.mutability) {
            (ReceiverKind::Reference(_, _, mutability), _) => parse_quote!(this_: &#mutability Self),
            (_, mutability) => parse_quote!(#mutability this_: Self),
        },
    });
    typed.collect()
}

/// Whether the type of a parameter is a mutable reference.
pub fn is_pointer(ty: &syn::Type) -> bool {
    matches!(ty, syn::Type::Reference(reference) if reference.mutability.is_some())
}

fn documentation(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter(|a| a.path().is_ident("doc")).filter_map(|attribute| {
        let syn::Meta::NameValue(meta) = &attribute.meta else { return None };
        let text: syn::LitStr = syn::parse2(meta.value.to_token_stream()).ok()?;
        Some(text.value().trim().to_owned())
    });
    let first_paragraph = lines.take_while(|line| !line.is_empty());
    first_paragraph.map(|line| format!("// {line}\n")).collect()
}
