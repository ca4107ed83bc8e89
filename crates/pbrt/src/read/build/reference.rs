//! Makes `docs/formats/pbrt-v4.md` of what the parser reads: every type of every statement is
//! read, and its table made of the parameters that were looked up. Their meaning, unless the schema
//! of settings has it, is in `data/meanings.txt`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use description::schema::{Member, Settings};
use description::{
    AcceleratorDesc, CameraDesc, FilmDesc, FilterDesc, IntegratorDesc, LightType, MaterialType, MediumType,
    SamplerDesc, ShapeType, SpectrumDesc, Substance, TextureType, TextureValue,
};

use super::Builder;
use super::asked::{Asked, Reference};
use super::texture;
use crate::read::interpreter::{DIRECTIVES, Interpreter, Section};
use crate::read::parameter::ParameterType;
use assets::MemoryAssets;

const MEANINGS: &str = include_str!("../../../data/meanings.txt");
/// A file of one triangle.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A parameter of a type, with the statements that have it if not all do.
#[derive(Clone, PartialEq)]
struct Row {
    name: &'static str,
    types: String,
    reference: Reference,
    condition: String,
}

/// What a statement looks up, with parameters in the syntax of the format.
fn lookups(statement: &str, kind: &str, parameters: &str) -> Vec<Row> {
    let directive = statement.split(' ').next();
    let text = match DIRECTIVES.iter().find(|(name, _)| Some(*name) == directive) {
        None => "WorldBegin".to_owned(),
        Some((_, Section::Options)) => format!("{statement} \"{kind}\" {parameters} WorldBegin"),
        Some(("MakeNamedMedium", _)) => {
            format!("{statement} \"string type\" \"{kind}\" {parameters} WorldBegin")
        }
        Some(_) => format!("WorldBegin ObjectBegin \"a\" ObjectEnd {statement} \"{kind}\" {parameters}"),
    };
    let assets = MemoryAssets::default().with("a.pbrt", text.as_bytes()).with("a.ply", PLY.as_bytes());
    let mut interpreter = Interpreter::new(&assets);
    interpreter.run(Path::new("a.pbrt"));
    let Interpreter { report, sources, mut statements, .. } = interpreter;
    let mut builder = Builder::new(&statements, report, &sources, &assets);
    builder.scene(&mut statements);
    let Builder { recorded, report, .. } = builder;
    // A member that the reader forgets would be one.
    assert!(report.finish().iter().all(|diagnostic| diagnostic.code != "unknown-type"), "{text}");
    let recorded = recorded.into_iter().rev().find(|(name, _)| name == kind);
    let (_, asked) = recorded.unwrap_or_else(|| panic!("no statement was read: {text}"));
    let mut rows: Vec<Row> = Vec::new();
    for Asked { name, reference } in asked {
        // Values are taken out of a parameter when it is read.
        assert!(rows.iter().all(|row| row.name != name), "{kind} reads `{name}` twice");
        rows.push(Row { name, types: type_names(reference.types), reference, condition: String::new() });
    }
    rows
}

/// Parameters that a statement needs; and another one, of a type and name, with values by which the
/// statement looks up different ones.
fn examples(statement: &str, kind: &str) -> (&'static str, [&'static str; 2], &'static [&'static str]) {
    const NONE: [&str; 2] = ["", ""];
    const MAPPING: [&str; 2] = ["string", "mapping"];
    const MAPPINGS: &[&str] = &["spherical", "cylindrical", "planar", "affine"];
    match (statement.split(' ').next().unwrap_or(""), kind) {
        ("Shape", "bilinearmesh" | "curve") => (r#""point3 P" [0 0 0 1 0 0 0 1 0 1 1 0]"#, NONE, &[]),
        ("Shape", "trianglemesh" | "polygon" | "loopsubdiv" | "spheres") => {
            (r#""point3 P" [0 0 0 1 0 0 0 1 0]"#, NONE, &[])
        }
        ("Shape", "plymesh") => (r#""string filename" "a.ply""#, NONE, &[]),
        ("Shape", "implicit") => (r#""string f" "x""#, NONE, &[]),
        ("Shape", "csg") => (r#""string operation" "union" "string operands" ["a" "a"]"#, NONE, &[]),
        ("Camera", "realistic") => (r#""string lensfile" "a""#, NONE, &[]),
        ("MakeNamedMedium", "rgbgrid") => (r#""rgb sigma_s" [1 1 1]"#, NONE, &[]),
        ("Texture", "imagemap") => (r#""string filename" "a.png""#, MAPPING, MAPPINGS),
        ("Texture", "bilerp" | "checkerboard" | "dots") => ("", MAPPING, MAPPINGS),
        ("Material", "measured")
        | ("LightSource", "projection")
        | ("MakeNamedMedium", "nanovdb")
        | ("Texture", "ptex") => (r#""string filename" "a""#, NONE, &[]),
        _ => ("", NONE, &[]),
    }
}

/// The parameters of a type.
fn rows(statement: &str, kind: &str) -> Vec<Row> {
    let (needed, [other_type, other], values) = examples(statement, kind);
    let mut rows = lookups(statement, kind, needed);
    for bare in lookups(statement, kind, "").into_iter().filter(|bare| bare.reference.is_required) {
        rows.iter_mut().filter(|row| row.name == bare.name).for_each(|row| row.reference.is_required = true);
    }
    let usual = rows.len();
    for &value in values {
        let quote = if other_type == "string" { "\"" } else { "" };
        let given = format!("{needed} \"{other_type} {other}\" {quote}{value}{quote}");
        let found = lookups(statement, kind, &given);
        for row in &mut rows[..usual] {
            if found.iter().all(|found| found.name != row.name) {
                row.condition += &match row.condition.is_empty() {
                    true if values.len() == 1 => format!("Not with `{other}`"),
                    true => format!("Not with `{other}` {value}"),
                    false => format!(", {value}"),
                };
            }
        }
        for mut row in found {
            if rows.iter().all(|known| known.name != row.name) {
                if other != row.name {
                    row.condition = format!("With `{other}` {value}");
                }
                rows.push(row);
            }
        }
    }
    rows
}

fn texture_rows(kind: &str) -> Vec<Row> {
    fn of<V: TextureValue>(kind: &str) -> Option<Vec<Row>> {
        let statement = format!("Texture \"a\" \"{}\"", V::NAME);
        texture::names::<V>().contains(&kind).then(|| rows(&statement, kind))
    }
    let (mut rows, spectra) = match (of::<f32>(kind), of::<SpectrumDesc>(kind)) {
        (Some(numbers), Some(spectra)) => (numbers, spectra),
        (numbers, spectra) => return numbers.or(spectra).unwrap_or_default(),
    };
    for row in &mut rows {
        match spectra.iter().find(|spectrum| spectrum.name == row.name) {
            None => row.condition = "Of `float` textures".into(),
            Some(spectrum) if spectrum.reference != row.reference => {
                row.types += &format!("; of `spectrum` textures {}", spectrum.types);
            }
            Some(_) => (),
        }
    }
    assert!(spectra.iter().all(|spectrum| rows.iter().any(|row| row.name == spectrum.name)), "{kind}");
    rows
}

fn type_names(types: &[ParameterType]) -> String {
    types.iter().map(|kind| format!("`{}`", kind.name())).collect::<Vec<_>>().join(", ")
}

/// The lines of `data/meanings.txt` by what they are about, and those that were used.
struct Meanings {
    texts: BTreeMap<&'static str, &'static str>,
    used: BTreeSet<&'static str>,
    missing: Vec<String>,
}

impl Meanings {
    fn new() -> Self {
        let lines = MEANINGS.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let texts = lines.map(|line| line.split_once(" | ").unwrap_or_else(|| panic!("no ` | `: {line}")));
        Self { texts: texts.collect(), used: BTreeSet::new(), missing: Vec::new() }
    }

    /// The text of the first of some keys; `otherwise` follows it.
    fn of(&mut self, keys: &[String], otherwise: &str) -> String {
        let found = keys.iter().find_map(|key| self.texts.get_key_value(key.as_str()));
        if found.is_none() && otherwise.is_empty() {
            self.missing.extend(keys.first().cloned());
        }
        let text = found.map_or("", |(key, text)| {
            self.used.insert(key);
            text
        });
        let space = if text.is_empty() || otherwise.is_empty() { "" } else { " " };
        format!("{text}{space}{otherwise}")
    }

    fn table(&mut self, directive: &str, kind: &str, rows: &[Row]) -> String {
        let mut text = String::new();
        if !rows.is_empty() {
            text += "| parameter | type | default | values | meaning |\n|---|---|---|---|---|\n";
        }
        for Row { name, types, reference, condition } in rows {
            let keys = [format!("{directive} {kind} {name}"), format!("{directive} * {name}")];
            let meaning = self.of(&keys, reference.help);
            let condition = if condition.is_empty() { String::new() } else { format!("{condition}. ") };
            let default = match &reference.default {
                _ if reference.is_required => "required".to_owned(),
                default if default.is_empty() => String::new(),
                default => format!("`{default}`"),
            };
            let values = reference.values.replace(" separated by commas", "");
            _ = writeln!(text, "| `{name}` | {types} | {default} | {values} | {condition}{meaning} |");
        }
        text
    }

    /// A section: the parameters that all types have, and then each type with its others.
    fn section(&mut self, title: &str, directive: &str, types: &[(Member, Vec<Row>)]) -> String {
        let mut text = format!("## {title}\n\n");
        let lists: Vec<&Vec<Row>> = types.iter().map(|(_, rows)| rows).collect();
        let mut shared = lists[0].clone();
        shared.retain(|row| lists.len() > 1 && lists.iter().all(|rows| rows.contains(row)));
        if !shared.is_empty() {
            text += &format!("All types have\n\n{}\n", self.table(directive, "*", &shared));
        }
        for (Member { names, help, is_drawn: _, is_extension }, rows) in types {
            let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
            text += &format!("### `{directive}` {}\n\n", quoted.join(" or "));
            let help = self.of(&[format!("{directive} {}", names[0])], help);
            let own: Vec<Row> = rows.iter().filter(|row| !shared.contains(row)).cloned().collect();
            let table = self.table(directive, names[0], &own);
            let extension = if *is_extension { "**Extension.** " } else { "" };
            text += &format!("{extension}{help}\n\n{table}{}", if own.is_empty() { "" } else { "\n" });
        }
        text
    }

    /// A section whose types have the parameters that a statement looks up.
    fn members(&mut self, title: &str, directive: &str, statement: &str, members: &[Member]) -> String {
        let types: Vec<_> =
            members.iter().map(|&member| (member, rows(statement, member.names[0]))).collect();
        self.section(title, directive, &types)
    }

    fn settings<T: Settings + Default>(&mut self, title: &str, directive: &str) -> String {
        self.members(title, directive, directive, &members::<T>().copied().collect::<Vec<_>>())
    }
}

fn members<T: Settings + Default>() -> impl Iterator<Item = &'static Member> {
    T::members().into_iter().filter_map(|desc| desc.member())
}

/// The part of the page that is made of the code.
fn tables() -> String {
    let mut meanings = Meanings::new();
    let mut text = "## Directives\n\n| directive | `WorldBegin` | meaning |\n|---|---|---|\n".to_owned();
    for (name, section) in DIRECTIVES {
        let place = match section {
            Section::Options => "before",
            Section::World => "after",
            Section::Anywhere => "",
        };
        _ = writeln!(text, "| `{name}` | {place} | {} |", meanings.of(&[format!("directive {name}")], ""));
    }
    text += "\n## Types of parameters\n\n| type | values |\n|---|---|\n";
    for (_, name) in ParameterType::ALL {
        _ = writeln!(text, "| `{name}` | {} |", meanings.of(&[format!("type {name}")], ""));
    }
    text += "\n## Options\n\n";
    text += &meanings.table("Option", "*", &lookups("", "Option", ""));
    text += "\n";
    text += &meanings.settings::<FilmDesc>("Films", "Film");
    text += &meanings.settings::<CameraDesc>("Cameras", "Camera");
    text += &meanings.settings::<SamplerDesc>("Samplers", "Sampler");
    text += &meanings.settings::<FilterDesc>("Pixel filters", "PixelFilter");
    text += &meanings.settings::<IntegratorDesc>("Integrators", "Integrator");
    text += &meanings.settings::<AcceleratorDesc>("Accelerators", "Accelerator");
    let polygon = Member {
        names: &["polygon"],
        help: "A planar polygon with holes.",
        is_drawn: true,
        is_extension: true,
    };
    text += &meanings.members("Shapes", "Shape", "Shape", &[ShapeType::MEMBERS, &[polygon]].concat());
    text += &meanings.members("Materials", "Material", "Material", MaterialType::MEMBERS);
    let textures = TextureType::MEMBERS.iter().map(|&member| (member, texture_rows(member.names[0])));
    text += &meanings.section("Textures", "Texture", &textures.collect::<Vec<_>>());
    text += &meanings.members("Lights", "LightSource", "LightSource", LightType::MEMBERS);
    let diffuse = Member {
        names: &["diffuse"],
        help: "A surface that emits alike in all directions.",
        is_drawn: true,
        is_extension: false,
    };
    text += &meanings.members("Area lights", "AreaLightSource", "AreaLightSource", &[diffuse]);
    text += &meanings.members("Media", "MakeNamedMedium", "MakeNamedMedium \"a\"", MediumType::MEMBERS);
    let list = |names: Vec<&str>| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    text += &format!("## Names of spectra\n\n{}\n\n", list(spectrum::names().collect()));
    text += &format!("## Names of substances\n\n{}\n", list(Substance::names().collect()));
    let unused: Vec<_> = meanings.texts.keys().filter(|key| !meanings.used.contains(*key)).collect();
    let missing = &meanings.missing;
    assert!(missing.is_empty(), "data/meanings.txt has no lines for {missing:#?}");
    assert!(unused.is_empty(), "lines of data/meanings.txt about nothing: {unused:#?}");
    text
}

#[test]
fn the_page_about_the_format_is_generated() {
    let part = ["## Directives\n", "\n## Where alhazen differs from pbrt-v4\n"];
    testkit::check_generated("docs/formats/pbrt-v4.md", part, &tables());
}

#[test]
fn types_that_are_not_drawn_say_what_replaces_them() {
    fn names<T: Settings + Default>(directive: &str) -> Vec<String> {
        let members = members::<T>().filter(|member| !member.is_drawn);
        members.map(|member| format!("{directive} {}", member.names[0])).collect()
    }
    let texts = Meanings::new().texts;
    let lists = [names::<SamplerDesc>("Sampler"), names::<IntegratorDesc>("Integrator")];
    for name in lists.concat().into_iter().chain(names::<AcceleratorDesc>("Accelerator")) {
        assert!(texts.get(&*name).is_some_and(|text| text.starts_with("**Replaced")), "{name}");
    }
}
