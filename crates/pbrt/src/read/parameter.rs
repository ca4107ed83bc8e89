//! Parameter lists: `"type name" value` or `"type name" [ values ]`.

use std::sync::Arc;

use description::schema::Kind;
use description::{ColorSpaceDesc, Diagnostic, Span, Spanned};

use super::names;
use super::token::{Token, TokenKind, Tokens};
use assets::number;
use description::DiagnosticList;
use description::did_you_mean;

/// The declared type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ParameterType {
    Integer,
    Float,
    Bool,
    String,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal,
    Spectrum,
    Rgb,
    Blackbody,
    Texture,
}

impl ParameterType {
    /// The types of the parameters that settings of a kind have; the usual one first.
    pub(super) fn of(kind: Kind) -> &'static [Self] {
        match kind {
            Kind::Bool => &[Self::Bool],
            Kind::Integer | Kind::Count => &[Self::Integer],
            Kind::Number => &[Self::Float],
            Kind::List(kind, _) => Self::of(*kind),
            Kind::Choice(_) | Kind::Text => &[Self::String],
            Kind::Point => &[Self::Point3],
            Kind::Spectrum => &[Self::Rgb, Self::Spectrum, Self::Blackbody],
            Kind::FloatParameter => &[Self::Float, Self::Texture],
            Kind::SpectrumParameter => &[Self::Rgb, Self::Spectrum, Self::Blackbody, Self::Texture],
        }
    }

    pub(super) const ALL: [(Self, &str); 13] = [
        (Self::Integer, "integer"),
        (Self::Float, "float"),
        (Self::Bool, "bool"),
        (Self::String, "string"),
        (Self::Point2, "point2"),
        (Self::Vector2, "vector2"),
        (Self::Point3, "point3"),
        (Self::Vector3, "vector3"),
        (Self::Normal, "normal"),
        (Self::Spectrum, "spectrum"),
        (Self::Rgb, "rgb"),
        (Self::Blackbody, "blackbody"),
        (Self::Texture, "texture"),
    ];

    pub(super) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|&(_, known)| known == name).map(|(kind, _)| kind)
    }

    /// Its name in the format.
    pub(crate) fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// How many numbers make one value of this type.
    pub(crate) fn arity(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal | Self::Rgb => 3,
            _ => 1,
        }
    }
}

/// The values of a parameter. Numbers are shared with descriptions, as far as their types allow.
#[derive(Clone, Debug)]
pub(crate) enum Values {
    Floats(Arc<[f32]>),
    Integers(Arc<[i32]>),
    Bools(Vec<bool>),
    Strings(Vec<Spanned<String>>),
}

impl Values {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Bools(values) => values.len(),
            Self::Strings(values) => values.len(),
        }
    }
}

/// A parameter as it was written.
#[derive(Clone, Debug)]
pub(crate) struct RawParameter {
    pub(crate) kind: ParameterType,
    /// Whether its type was stated. If not, it [adopts](Self::adopt) one that fits.
    pub(crate) is_typed: bool,
    pub(crate) name: String,
    pub(crate) values: Values,
    /// How many values a row has, if they were given as an array of several dimensions.
    pub(crate) row: Option<usize>,
    /// The declaration and its values.
    pub(crate) span: Span,
    /// The declaration alone.
    pub(crate) declaration: Span,
    /// The current colour space.
    pub(crate) color_space: ColorSpaceDesc,
}

impl RawParameter {
    /// Becomes one of these types if it is not typed and its values fit one.
    pub(crate) fn adopt(&mut self, types: &[ParameterType]) {
        use ParameterType::{Blackbody, Normal, Vector2, Vector3};
        use ParameterType::{Float, Integer, Point2, Point3, Rgb, Spectrum, String, Texture};
        if self.is_typed || types.contains(&self.kind) {
            return;
        }
        let first = |candidates: &[ParameterType]| {
            candidates.iter().copied().find(|candidate| types.contains(candidate))
        };
        if let Values::Integers(integers) = &self.values
            && first(&[Integer]).is_none()
        {
            self.values = Values::Floats(integers.iter().map(|&integer| integer as f32).collect());
        }
        let fitting = match &mut self.values {
            Values::Strings(_) => first(&[String, Spectrum, Texture]),
            Values::Bools(_) => None,
            Values::Integers(_) => Some(Integer),
            Values::Floats(values) => match **values {
                [grey] if first(&[Float]).is_none() && first(&[Rgb]).is_some() => {
                    *values = [grey; 3].into();
                    Some(Rgb)
                }
                // The same value at all wavelengths.
                [value] if first(&[Float]).is_none() && first(&[Spectrum]).is_some() => {
                    *values = [100.0, value, 1000.0, value].into();
                    Some(Spectrum)
                }
                [_, _, _] if first(&[Rgb]).is_some() => Some(Rgb),
                // A colour of too few or too many numbers is no spectrum.
                [wavelength, ref rest @ ..]
                    if first(&[Float]).is_none()
                        && first(&[Rgb]).is_some()
                        && (rest.len() < 3 || wavelength < SHORTEST) =>
                {
                    Some(Rgb)
                }
                _ => first(&[Float, Spectrum, Point3, Vector3, Normal, Point2, Vector2, Rgb, Blackbody]),
            },
        };
        self.kind = fitting.unwrap_or(self.kind);
    }
}

/// In nanometres: samples of a spectrum that are not stated to be some begin at no shorter one.
const SHORTEST: f32 = 100.0;

/// Most parameters of one statement; no statement of the format takes a tenth of them.
const MOST_PARAMETERS: usize = 1000;

/// Reads all parameters of a statement. One that is wrong is reported and skipped.
pub(crate) fn parameters(
    tokens: &mut Tokens,
    color_space: ColorSpaceDesc,
    report: &mut DiagnosticList,
) -> Vec<RawParameter> {
    let mut parameters: Vec<RawParameter> = Vec::new();
    while matches!(tokens.peek().kind, TokenKind::Quoted | TokenKind::Unterminated) {
        if parameters.len() == MOST_PARAMETERS {
            let declaration = tokens.peek();
            let message = format!("a statement has at most {MOST_PARAMETERS} parameters");
            report.error("too-many-parameters", message, tokens.span(declaration));
            skip_to_directive(tokens);
            break;
        }
        let Some(parameter) = parameter(tokens, color_space, report) else { continue };
        if let Some(first) = parameters.iter().find(|earlier| earlier.name == parameter.name) {
            report.push(
                Diagnostic::error(
                    "duplicate-parameter",
                    format!("the parameter `{}` is given twice", parameter.name),
                    parameter.declaration,
                )
                .with_label(first.declaration, "first given here"),
            );
            continue;
        }
        parameters.push(parameter);
    }
    parameters
}

/// Reads one parameter; `None` if it is wrong, which is reported.
pub(crate) fn parameter(
    tokens: &mut Tokens,
    color_space: ColorSpaceDesc,
    report: &mut DiagnosticList,
) -> Option<RawParameter> {
    let declaration = tokens.next();
    let span = tokens.span(declaration);
    if declaration.kind == TokenKind::Unterminated {
        report.error("unterminated-string", "this string has no closing quote on its line", span);
        return None;
    }
    let text = tokens.string(declaration, report);
    let mut words = text.split_ascii_whitespace();
    let (Some(type_name), Some(name), None) = (words.next(), words.next(), words.next()) else {
        report.push(
            Diagnostic::error(
                "parameter-declaration",
                format!("`{text}` is not a parameter declaration"),
                span,
            )
            .with_help("a parameter is declared by its type and its name, as in `\"float radius\"`"),
        );
        skip_values(tokens);
        return None;
    };
    let Some(kind) = parameter_type(type_name, span, report) else {
        skip_values(tokens);
        return None;
    };
    let (values, end) = values(tokens, kind, name, span, report)?;
    Some(RawParameter {
        kind,
        is_typed: true,
        name: name.to_owned(),
        values,
        row: None,
        span: span.to(end),
        declaration: span,
        color_space,
    })
}

fn parameter_type(name: &str, span: Span, report: &mut DiagnosticList) -> Option<ParameterType> {
    if let Some(kind) = ParameterType::from_name(name) {
        return Some(kind);
    }
    let renamed = match name {
        "point" => Some(ParameterType::Point3),
        "vector" => Some(ParameterType::Vector3),
        "normal3" => Some(ParameterType::Normal),
        _ => None,
    };
    if let Some(kind) = renamed {
        let message = format!("the parameter type `{name}` is now called `{}`", kind.name());
        report.warning("deprecated", message, span);
        return renamed;
    }
    let message = format!("there is no parameter type `{name}`");
    report.push(match names::replaced("parameter-type", name) {
        Some(replacement) => Diagnostic::error("old-name", message, span).with_help(replacement),
        None => Diagnostic {
            help: did_you_mean(name, ParameterType::ALL.map(|(_, name)| name)),
            ..Diagnostic::error("unknown-parameter-type", message, span)
        },
    });
    None
}

/// Reads the values after a declaration, and the span of the last; `None` if there are none of the
/// right type, which is reported.
pub(crate) fn values(
    tokens: &mut Tokens,
    kind: ParameterType,
    name: &str,
    declaration: Span,
    report: &mut DiagnosticList,
) -> Option<(Values, Span)> {
    let first = tokens.peek();
    let bracketed = first.kind == TokenKind::Open;
    if !bracketed && !matches!(first.kind, TokenKind::Word | TokenKind::Quoted)
        || is_directive(tokens.bytes(first))
    {
        report.error("parameter-value", format!("the parameter `{name}` has no value"), declaration);
        return None;
    }
    if bracketed {
        tokens.next();
    }
    let mut values = match kind {
        ParameterType::Integer => Read::Integers(Vec::new()),
        ParameterType::Bool => Read::Bools(Vec::new()),
        ParameterType::String | ParameterType::Texture => Read::Strings(Vec::new()),
        ParameterType::Spectrum if tokens.peek().kind == TokenKind::Quoted => Read::Strings(Vec::new()),
        _ => Read::Floats(Vec::new()),
    };
    loop {
        let token = tokens.peek();
        match token.kind {
            TokenKind::Close if bracketed => {
                tokens.next();
                return Some((values.into(), tokens.span(token)));
            }
            TokenKind::Word | TokenKind::Quoted if push_value(tokens, token, &mut values, report) => {
                tokens.next();
                if !bracketed {
                    return Some((values.into(), tokens.span(token)));
                }
            }
            TokenKind::End | TokenKind::Unterminated | TokenKind::Open | TokenKind::Close => {
                report.error(
                    "unclosed-bracket",
                    format!("the values of `{name}` have no closing `]`"),
                    declaration,
                );
                return None;
            }
            TokenKind::Word if is_directive(tokens.bytes(token)) => {
                report.error(
                    "unclosed-bracket",
                    format!("the values of `{name}` have no closing `]`"),
                    declaration,
                );
                return None;
            }
            TokenKind::Word | TokenKind::Quoted => {
                let found = String::from_utf8_lossy(tokens.bytes(token)).into_owned();
                let expected = match values {
                    Read::Floats(_) => "a number",
                    Read::Integers(_) => "an integer",
                    Read::Bools(_) => "`true` or `false`",
                    Read::Strings(_) => "a quoted string",
                };
                let message =
                    format!("`{name}` is of type `{}` and takes {expected}, not `{found}`", kind.name());
                report.error("parameter-value", message, tokens.span(token));
                if bracketed {
                    skip_to_close(tokens);
                } else {
                    tokens.next();
                }
                return None;
            }
        }
    }
}

/// Values while they are read.
enum Read {
    Floats(Vec<f32>),
    Integers(Vec<i32>),
    Bools(Vec<bool>),
    Strings(Vec<Spanned<String>>),
}

impl From<Read> for Values {
    fn from(read: Read) -> Self {
        match read {
            Read::Floats(values) => Self::Floats(values.into()),
            Read::Integers(values) => Self::Integers(values.into()),
            Read::Bools(values) => Self::Bools(values),
            Read::Strings(values) => Self::Strings(values),
        }
    }
}

/// Adds the value of a token; false if it is of another type.
#[inline]
fn push_value(tokens: &Tokens, token: Token, values: &mut Read, report: &mut DiagnosticList) -> bool {
    let bytes = tokens.bytes(token);
    match values {
        Read::Floats(values) => number::float(bytes).map(|value| values.push(value)).is_some(),
        Read::Integers(values) => number::integer(bytes).map(|value| values.push(value)).is_some(),
        Read::Bools(values) => {
            let value = match bytes {
                b"true" | b"\"true\"" => true,
                b"false" | b"\"false\"" => false,
                _ => return false,
            };
            if token.kind == TokenKind::Quoted {
                report.warning(
                    "deprecated",
                    "`true` and `false` are written without quotes",
                    tokens.span(token),
                );
            }
            values.push(value);
            true
        }
        Read::Strings(values) => {
            let quoted = token.kind == TokenKind::Quoted;
            if quoted {
                values.push(Spanned::new(tokens.string(token, report), tokens.span(token)));
            }
            quoted
        }
    }
}

/// Whether a bare word begins a statement: an upper-case letter and then letters.
pub(crate) fn is_directive(word: &[u8]) -> bool {
    matches!(word, [b'A'..=b'Z', rest @ ..] if rest.iter().all(u8::is_ascii_alphabetic))
}

/// Skips to the next directive.
pub(crate) fn skip_to_directive(tokens: &mut Tokens) {
    loop {
        let token = tokens.peek();
        match token.kind {
            TokenKind::End => return,
            TokenKind::Word if is_directive(tokens.bytes(token)) => return,
            _ => _ = tokens.next(),
        }
    }
}

fn skip_values(tokens: &mut Tokens) {
    match tokens.peek().kind {
        TokenKind::Open => skip_to_close(tokens),
        TokenKind::Quoted => _ = tokens.next(),
        TokenKind::Word => {
            let word = tokens.peek();
            if !is_directive(tokens.bytes(word)) {
                tokens.next();
            }
        }
        _ => (),
    }
}

/// Skips past the next `]`, but never into the next statement.
fn skip_to_close(tokens: &mut Tokens) {
    loop {
        let token = tokens.peek();
        match token.kind {
            TokenKind::Close => {
                tokens.next();
                return;
            }
            TokenKind::End => return,
            TokenKind::Word if is_directive(tokens.bytes(token)) => return,
            _ => _ = tokens.next(),
        }
    }
}
