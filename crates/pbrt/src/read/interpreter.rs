//! Runs the directives of a scene and its included files: keeps the graphics state and collects
//! statements.
//!
//! After an error in a statement, reading continues at the next directive, so that all errors of a
//! scene are found in one run.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use description::{Diagnostic, FileId, SourceMap, Span, Spanned};

use super::foreign;
use super::names;
use super::parameter::{is_directive, skip_to_directive};
use super::search::find;
use super::state::{Block, BlockKind, GraphicsState, MaterialReference, TransformSet};
use super::statement::{ObjectStatement, Statements};
use super::token::{Token, TokenKind, Tokens};
use assets::number;
use assets::{AssetSource, read_unpacked};
use description::DiagnosticList;
use description::did_you_mean;

/// A statement could not be read; the error has been reported.
#[derive(Debug)]
pub(super) struct Abandoned;

pub(super) type Step<T = ()> = Result<T, Abandoned>;

/// The section of a scene in which a directive is allowed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    /// Before `WorldBegin`.
    Options,
    /// After it.
    World,
    Anywhere,
}

/// All directives and where they are allowed.
pub(super) const DIRECTIVES: [(&str, Section); 40] = [
    ("Accelerator", Section::Options),
    ("ActiveTransform", Section::Anywhere),
    ("AreaLightSource", Section::World),
    ("Attribute", Section::Anywhere),
    ("AttributeBegin", Section::World),
    ("AttributeEnd", Section::World),
    ("Camera", Section::Options),
    ("ColorSpace", Section::Anywhere),
    ("ConcatTransform", Section::Anywhere),
    ("CoordSysTransform", Section::Anywhere),
    ("CoordinateSystem", Section::Anywhere),
    ("Film", Section::Options),
    ("Identity", Section::Anywhere),
    ("Import", Section::World),
    ("Include", Section::Anywhere),
    ("Integrator", Section::Options),
    ("LightSource", Section::World),
    ("LookAt", Section::Anywhere),
    ("MakeNamedMaterial", Section::World),
    ("MakeNamedMedium", Section::Anywhere),
    ("Material", Section::World),
    ("MediumInterface", Section::Anywhere),
    ("NamedMaterial", Section::World),
    ("ObjectBegin", Section::World),
    ("ObjectEnd", Section::World),
    ("ObjectInstance", Section::World),
    ("Option", Section::Anywhere),
    ("PixelFilter", Section::Options),
    ("ReverseOrientation", Section::World),
    ("Rotate", Section::Anywhere),
    ("Sampler", Section::Options),
    ("Scale", Section::Anywhere),
    ("Shape", Section::World),
    ("Texture", Section::World),
    ("Transform", Section::Anywhere),
    ("TransformBegin", Section::World),
    ("TransformEnd", Section::World),
    ("TransformTimes", Section::Options),
    ("Translate", Section::Anywhere),
    ("WorldBegin", Section::Options),
];

pub(crate) struct Interpreter<'a> {
    assets: &'a dyn AssetSource,
    pub(super) report: DiagnosticList,
    pub(super) sources: SourceMap,
    pub(super) statements: Statements,
    pub(super) state: GraphicsState,
    pub(super) coordinate_systems: HashMap<String, TransformSet>,
    blocks: Vec<Block>,
    in_world: bool,
    /// The object that is being defined.
    pub(super) object: Option<ObjectStatement>,
    /// The files that are being read, each but the first included by the one before it.
    reading: Vec<FileId>,
    /// `Include` and `Import` directives that were run.
    included: usize,
    /// Files that were read, by path.
    files: HashMap<PathBuf, FileId>,
}

impl<'a> Interpreter<'a> {
    const DEEPEST_INCLUDE: usize = 64;
    const MAX_FILES: usize = 10_000;
    /// Files may be included again and again, but a few that double each other would not end.
    const MAX_INCLUDES: usize = 1_000_000;
    const DEEPEST_BLOCK: usize = 10_000;

    pub(crate) fn new(assets: &'a dyn AssetSource) -> Self {
        Self {
            assets,
            report: DiagnosticList::default(),
            sources: SourceMap::default(),
            statements: Statements::default(),
            state: GraphicsState::default(),
            coordinate_systems: HashMap::new(),
            blocks: Vec::new(),
            in_world: false,
            object: None,
            reading: Vec::new(),
            included: 0,
            files: HashMap::new(),
        }
    }

    /// Runs a scene from its first file.
    pub(crate) fn run(&mut self, path: &Path) {
        let Some(file) = self.open(path, Span::NONE) else { return };
        self.file(file);
        let end = self.sources.text(file).len() as u32;
        let end = Span::new(file, end, end);
        self.close_blocks(0);
        if !self.in_world {
            let message = "the scene has no `WorldBegin`: its world is empty";
            self.report.error("missing-world", message, end);
        }
    }

    /// Runs the directives of one file.
    fn file(&mut self, file: FileId) {
        self.reading.push(file);
        let text = self.sources.shared_text(file);
        let mut tokens = Tokens::new(&text, file);
        while !self.report.has_too_many_errors() {
            let token = tokens.next();
            match token.kind {
                TokenKind::End => break,
                TokenKind::Word if is_directive(tokens.bytes(token)) => {
                    let directive = String::from_utf8_lossy(tokens.bytes(token));
                    if self.directive(&directive, token, &mut tokens).is_err() {
                        skip_to_directive(&mut tokens);
                    }
                }
                TokenKind::Unterminated => {
                    let message = "this string has no closing quote on its line";
                    self.report.error("unterminated-string", message, tokens.span(token));
                    skip_to_directive(&mut tokens);
                }
                _ => {
                    let found = String::from_utf8_lossy(tokens.bytes(token)).into_owned();
                    let message = format!("expected a directive, found {}", shortened(&found));
                    self.report.error("unexpected-token", message, tokens.span(token));
                    skip_to_directive(&mut tokens);
                }
            }
        }
        self.reading.pop();
    }

    fn directive(&mut self, name: &str, token: Token, tokens: &mut Tokens) -> Step {
        let span = tokens.span(token);
        let Some(&(_, section)) = DIRECTIVES.iter().find(|(known, _)| *known == name) else {
            return self.unknown_directive(name, span);
        };
        if section == Section::Options && self.in_world || section == Section::World && !self.in_world {
            let side = if self.in_world { "before" } else { "after" };
            let message = format!("`{name}` is only allowed {side} `WorldBegin`");
            self.report.error("misplaced-directive", message, span);
            return Err(Abandoned);
        }
        match name {
            "Film" => self.statements.film = Some(self.only(name, span, tokens, |all| all.film.as_ref())?),
            "Sampler" => {
                self.statements.sampler = Some(self.only(name, span, tokens, |all| all.sampler.as_ref())?)
            }
            "PixelFilter" => {
                self.statements.filter = Some(self.only(name, span, tokens, |all| all.filter.as_ref())?)
            }
            "Integrator" => {
                self.statements.integrator =
                    Some(self.only(name, span, tokens, |all| all.integrator.as_ref())?);
            }
            "Accelerator" => {
                self.statements.accelerator =
                    Some(self.only(name, span, tokens, |all| all.accelerator.as_ref())?);
            }
            "Camera" => self.camera(span, tokens)?,
            "Option" => self.option(tokens)?,
            "ColorSpace" => self.color_space(tokens)?,
            "WorldBegin" => self.world_begin(),
            "AttributeBegin" => self.begin_block(BlockKind::Attribute, span)?,
            "AttributeEnd" => self.end_block(BlockKind::Attribute, span)?,
            "TransformBegin" => {
                self.report.warning("deprecated", "`TransformBegin` is now written `AttributeBegin`", span);
                self.begin_block(BlockKind::Attribute, span)?;
            }
            "TransformEnd" => {
                self.report.warning("deprecated", "`TransformEnd` is now written `AttributeEnd`", span);
                self.end_block(BlockKind::Attribute, span)?;
            }
            "Attribute" => self.attribute(tokens)?,
            "ReverseOrientation" => self.state.reverse_orientation ^= true,
            "ObjectBegin" => self.object_begin(span, tokens)?,
            "ObjectEnd" => self.object_end(span)?,
            "ObjectInstance" => self.object_instance(span, tokens)?,
            "MakeNamedMaterial" => self.make_named_material(span, tokens)?,
            "NamedMaterial" => {
                self.state.material = MaterialReference::Named(self.string(tokens, "the material")?)
            }
            "Material" => self.material(span, tokens)?,
            "Texture" => self.texture(span, tokens)?,
            "MakeNamedMedium" => self.make_named_medium(span, tokens)?,
            "MediumInterface" => self.medium_interface(tokens)?,
            "LightSource" => self.light(span, tokens)?,
            "AreaLightSource" => self.area_light(span, tokens)?,
            "Shape" => self.shape(span, tokens)?,
            "Include" => self.include(tokens)?,
            "Import" => self.import(tokens)?,
            _ => self.transform(name, span, tokens)?,
        }
        Ok(())
    }

    fn unknown_directive(&mut self, name: &str, span: Span) -> Step {
        if name == "WorldEnd" {
            self.report.warning(
                "deprecated",
                "`WorldEnd` is not needed any more: the world ends with the file",
                span,
            );
            return Ok(());
        }
        let message = format!("there is no directive `{}`", shortened(name));
        self.report.push(match names::replaced("directive", name) {
            Some(replacement) => Diagnostic::error("old-name", message, span).with_help(replacement),
            None => Diagnostic {
                help: did_you_mean(name, DIRECTIVES.map(|(known, _)| known)),
                ..Diagnostic::error("unknown-directive", message, span)
            },
        });
        Err(Abandoned)
    }

    fn world_begin(&mut self) {
        self.in_world = true;
        self.state.ctm = TransformSet::IDENTITY;
        self.state.active = [true; 2];
        self.coordinate_systems.insert("world".into(), self.state.ctm);
    }

    pub(super) fn begin_block(&mut self, kind: BlockKind, span: Span) -> Step {
        if self.blocks.len() >= Self::DEEPEST_BLOCK {
            let message = format!("blocks are nested more than {} deep", Self::DEEPEST_BLOCK);
            self.report.error("unbalanced-block", message, span);
            return Err(Abandoned);
        }
        self.blocks.push(Block { kind, span, state: self.state.clone() });
        Ok(())
    }

    pub(super) fn end_block(&mut self, kind: BlockKind, span: Span) -> Step {
        match self.blocks.last() {
            Some(block) if block.kind == kind => {
                if let Some(block) = self.blocks.pop() {
                    self.state = block.state;
                }
                Ok(())
            }
            Some(block) => {
                let message = format!("`{}` found where `{}` is expected", kind.end(), block.kind.end());
                let opened = Diagnostic::error("unbalanced-block", message, span)
                    .with_label(block.span, "opened here");
                self.report.push(opened);
                Err(Abandoned)
            }
            None => {
                let message = format!("`{}` has no `{}` before it", kind.end(), kind.begin());
                self.report.error("unbalanced-block", message, span);
                Err(Abandoned)
            }
        }
    }

    /// Reports and ends the blocks above a depth.
    fn close_blocks(&mut self, depth: usize) {
        while self.blocks.len() > depth
            && let Some(block) = self.blocks.pop()
        {
            let message = format!("this `{}` has no `{}`", block.kind.begin(), block.kind.end());
            self.report.error("unbalanced-block", message, block.span);
            self.state = block.state;
            if block.kind == BlockKind::Object {
                self.statements.objects.extend(self.object.take());
            }
        }
    }

    /// Reads another file as if its text were here.
    fn include(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the file's name")?;
        if let Some(file) = self.open_named(&name) {
            self.file(file);
        }
        Ok(())
    }

    /// Reads another file and restores the graphics state afterwards.
    fn import(&mut self, tokens: &mut Tokens) -> Step {
        let name = self.string(tokens, "the file's name")?;
        if let Some(file) = self.open_named(&name) {
            let (state, systems, depth) =
                (self.state.clone(), self.coordinate_systems.clone(), self.blocks.len());
            self.file(file);
            self.close_blocks(depth);
            (self.state, self.coordinate_systems) = (state, systems);
        }
        Ok(())
    }

    fn open_named(&mut self, name: &Spanned<String>) -> Option<FileId> {
        if self.reading.len() > Self::DEEPEST_INCLUDE {
            let message = format!("files include each other more than {} deep", Self::DEEPEST_INCLUDE);
            self.report.error("include-limit", message, name.span);
            return None;
        }
        self.included += 1;
        if self.included > Self::MAX_INCLUDES {
            let message = format!("files are included more than {} times", Self::MAX_INCLUDES);
            self.report.error("include-limit", message, name.span);
            return None;
        }
        let naming_file = self.sources.name(name.span.file);
        let path = find(self.assets, &name.value, naming_file, self.sources.name(FileId(0)));
        let file = self.open(&path, name.span)?;
        if let Some(first) = self.reading.iter().position(|&reading| reading == file) {
            let cycle: Vec<_> =
                self.reading[first..].iter().chain([&file]).map(|&file| self.sources.name(file)).collect();
            let message = format!("files include each other in a cycle: {}", cycle.join(" → "));
            self.report.error("include-cycle", message, name.span);
            return None;
        }
        Some(file)
    }

    fn open(&mut self, path: &Path, span: Span) -> Option<FileId> {
        if let Some(&file) = self.files.get(path) {
            return Some(file);
        }
        if self.files.len() > Self::MAX_FILES {
            let message = format!("more than {} different files are included", Self::MAX_FILES);
            self.report.error("include-limit", message, span);
            return None;
        }
        let shown = path.to_string_lossy().into_owned();
        match read_unpacked(self.assets, path) {
            Ok(text) if u32::try_from(text.len()).is_ok() => {
                if let Some(diagnostic) = foreign::refused(&shown, &text, span) {
                    self.report.push(diagnostic);
                    return None;
                }
                let file = self.sources.add(shown, text);
                self.files.insert(path.to_owned(), file);
                Some(file)
            }
            Ok(_) => {
                self.report.error("unreadable-file", format!("`{shown}` is larger than 4 GiB"), span);
                None
            }
            Err(error) => {
                self.report.error("unreadable-file", format!("cannot read `{shown}`: {error}"), span);
                None
            }
        }
    }

    /// Takes a quoted string.
    pub(super) fn string(&mut self, tokens: &mut Tokens, what: &str) -> Step<Spanned<String>> {
        let token = tokens.peek();
        if token.kind != TokenKind::Quoted {
            return self.unexpected(tokens, token, &format!("{what} in quotes"));
        }
        tokens.next();
        Ok(Spanned::new(tokens.string(token, &mut self.report), tokens.span(token)))
    }

    /// Takes numbers, with or without brackets around them.
    pub(super) fn numbers<const N: usize>(&mut self, tokens: &mut Tokens) -> Step<[f64; N]> {
        let bracketed = tokens.peek().kind == TokenKind::Open;
        if bracketed {
            tokens.next();
        }
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let token = tokens.peek();
            match number::double(tokens.bytes(token)).filter(|value| value.is_finite()) {
                Some(value) => *number = value,
                None => return self.unexpected(tokens, token, &format!("a number ({N} in all)")),
            }
            tokens.next();
        }
        if bracketed {
            let token = tokens.peek();
            if token.kind != TokenKind::Close {
                return self.unexpected(tokens, token, &format!("`]` after {N} numbers"));
            }
            tokens.next();
        }
        Ok(numbers)
    }

    /// Reports a token where another was expected.
    pub(super) fn unexpected<T>(&mut self, tokens: &Tokens, token: Token, expected: &str) -> Step<T> {
        let found = match token.kind {
            TokenKind::End => "the end of the file".to_owned(),
            _ => shortened(&String::from_utf8_lossy(tokens.bytes(token))),
        };
        let message = format!("expected {expected}, found {found}");
        self.report.error("unexpected-token", message, tokens.span(token));
        Err(Abandoned)
    }
}

/// A token, shortened for a message.
fn shortened(word: &str) -> String {
    const LONGEST: usize = 40;
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &word[..end]),
        None => word.to_owned(),
    }
}
