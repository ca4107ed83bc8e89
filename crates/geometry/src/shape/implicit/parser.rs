//! Parsing the text of a formula F(x, y, z) to a [`Program`].
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = ("+" | "-") unary | power
//! power   = atom [ "^" unary ]
//! atom    = number | name | name "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//!
//! Names are x, y, z, pi, e and the functions sqrt, abs, sin, cos, tan, exp, log, min, max and pow;
//! −x² is −(x²), and powers associate to the right. A power with an integer exponent is a product,
//! so that its base may be negative; any other needs a base of at least 0. Length, depth and
//! operations are bounded.

use super::program::{Builder, Function, Program, TooLong, Value};
use std::fmt;
use std::ops::Range;

/// The longest text in bytes.
const MAX_LENGTH: usize = 1 << 14;
/// How deep parentheses, signs and exponents may be nested.
const MAX_DEPTH: usize = 100;

/// Names that a formula may use; functions with the number of their arguments.
const NAMES: &str = "x, y, z, pi, e, sqrt, abs, sin, cos, tan, exp, log, min, max, pow";

/// A syntax error of a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulaError {
    /// The range of bytes of the text that is wrong.
    pub place: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.message)
    }
}

impl std::error::Error for FormulaError {}

/// Parses a formula.
pub(super) fn parse(text: &str) -> Result<Program, FormulaError> {
    let mut parser = Parser { text, at: 0, depth: 0, builder: Builder::default() };
    if text.len() > MAX_LENGTH {
        return Err(parser.error(0..text.len(), format!("the formula is longer than {MAX_LENGTH} bytes")));
    }
    let value = parser.sum()?;
    match parser.peek() {
        None => (),
        Some(b')') => return Err(parser.error_here("this `)` has no `(`")),
        Some(b'=') => {
            let error = parser.error_here("a formula has no `=`");
            return Err(error.with_help("the surface is where the formula is 0: write `a - b` for a = b"));
        }
        Some(_) => return Err(parser.missing_operator()),
    }
    let whole = parser.error(0..text.len(), "the formula is constant: it uses neither x, y nor z");
    parser.builder.finish(value).ok_or(whole)
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    builder: Builder,
}

type Parsed = Result<Value, FormulaError>;

impl FormulaError {
    fn with_help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }
}

impl Parser<'_> {
    fn error(&self, place: Range<usize>, message: impl Into<String>) -> FormulaError {
        FormulaError { place, message: message.into(), help: None }
    }

    /// An error about the next word or character.
    fn error_here(&mut self, message: impl Into<String>) -> FormulaError {
        self.peek();
        let rest = &self.text[self.at..];
        let word = rest.len() - rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_').len();
        let length = if word > 0 { word } else { rest.chars().next().map_or(0, char::len_utf8) };
        self.error(self.at..self.at + length, message)
    }

    fn missing_operator(&mut self) -> FormulaError {
        let error = self.error_here("");
        let found = &self.text[error.place.clone()];
        let begins_factor = found.starts_with(|c: char| c.is_alphanumeric() || c == '(' || c == '.');
        let message = if begins_factor {
            format!("an operator is missing before `{found}`")
        } else {
            format!("`{found}` has no meaning in a formula")
        };
        let help = begins_factor.then(|| "products are written with `*`".to_owned());
        FormulaError { message, help, ..error }
    }

    /// The next byte that is no white space.
    fn peek(&mut self) -> Option<u8> {
        let rest = &self.text[self.at..];
        self.at = self.text.len() - rest.trim_ascii_start().len();
        self.text.as_bytes().get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn checked(&self, start: usize, value: Result<Value, TooLong>) -> Parsed {
        value.map_err(|TooLong| {
            let message = format!("the formula has more than {} steps", Builder::MAX_STEPS);
            self.error(start..self.at, message)
        })
    }

    fn sum(&mut self) -> Parsed {
        let start = self.at;
        let mut value = self.product()?;
        loop {
            let sum = if self.take(b'+') {
                let term = self.product()?;
                self.builder.add(value, term)
            } else if self.take(b'-') {
                let term = self.product()?;
                self.builder.sub(value, term)
            } else {
                return Ok(value);
            };
            value = self.checked(start, sum)?;
        }
    }

    fn product(&mut self) -> Parsed {
        let start = self.at;
        let mut value = self.unary()?;
        loop {
            let product = if self.take(b'*') {
                if self.peek() == Some(b'*') {
                    let error = self.error(self.at - 1..self.at + 1, "`**` is not an operator");
                    return Err(error.with_help("powers are written with `^`"));
                }
                let factor = self.unary()?;
                self.builder.mul(value, factor)
            } else if self.take(b'/') {
                let divisor = self.unary()?;
                self.builder.div(value, divisor)
            } else {
                return Ok(value);
            };
            value = self.checked(start, product)?;
        }
    }

    fn unary(&mut self) -> Parsed {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error_here(format!("the formula is nested more than {MAX_DEPTH} deep")));
        }
        let start = self.at;
        let value = if self.take(b'-') {
            let value = self.unary()?;
            let minus = self.builder.neg(value);
            self.checked(start, minus)
        } else if self.take(b'+') {
            self.unary()
        } else {
            self.power()
        };
        self.depth -= 1;
        value
    }

    fn power(&mut self) -> Parsed {
        let start = self.at;
        let base = self.atom()?;
        if !self.take(b'^') {
            return Ok(base);
        }
        let exponent = self.unary()?;
        let power = self.builder.pow(base, exponent);
        self.checked(start, power)
    }

    fn atom(&mut self) -> Parsed {
        match self.peek() {
            Some(b'(') => {
                let open = self.at;
                self.at += 1;
                let value = self.sum()?;
                self.close(open)?;
                Ok(value)
            }
            Some(b'0'..=b'9' | b'.') => self.number(),
            Some(byte) if byte.is_ascii_alphabetic() => self.name(),
            None => {
                let message = if self.text.trim_ascii().is_empty() {
                    "the formula is empty"
                } else {
                    "expected a number or a name, found the end of the formula"
                };
                let end = self.text.len();
                Err(self.error(end..end, message))
            }
            Some(_) => {
                let error = self.error_here("");
                let message =
                    format!("expected a number or a name, found `{}`", &self.text[error.place.clone()]);
                Err(FormulaError { message, ..error })
            }
        }
    }

    fn close(&mut self, open: usize) -> Result<(), FormulaError> {
        if self.take(b')') {
            return Ok(());
        }
        match self.peek() {
            None => Err(self.error(open..open + 1, "this `(` has no `)`")),
            Some(b',') => Err(self.error_here("too many arguments")),
            Some(_) => Err(self.missing_operator()),
        }
    }

    fn number(&mut self) -> Parsed {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut end = start + digits(start);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        // An e is an exponent only if digits follow; otherwise it is a name that lacks its
        // operator.
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits((end + 1 + sign).min(bytes.len()));
            if exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        self.at = end;
        match self.text[start..end].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Value::Known(value)),
            Ok(_) => Err(self.error(start..end, "this number is too large")),
            Err(_) => Err(self.error(start..end, "this is not a number")),
        }
    }

    fn name(&mut self) -> Parsed {
        let start = self.at;
        let rest = &self.text[start..];
        let length =
            rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
        self.at += length;
        let name = &rest[..length];
        let value = match name {
            "x" => self.builder.coordinate(0),
            "y" => self.builder.coordinate(1),
            "z" => self.builder.coordinate(2),
            "pi" => Ok(Value::Known(std::f64::consts::PI)),
            "e" => Ok(Value::Known(std::f64::consts::E)),
            "sqrt" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Sqrt, a)
            }
            "abs" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Abs, a)
            }
            "sin" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Sin, a)
            }
            "cos" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Cos, a)
            }
            "tan" => {
                let [a] = self.arguments(name)?;
                let sin = self.builder.apply(Function::Sin, a);
                let sin = self.checked(start, sin)?;
                let cos = self.builder.apply(Function::Cos, a);
                let cos = self.checked(start, cos)?;
                self.builder.div(sin, cos)
            }
            "exp" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Exp, a)
            }
            "log" => {
                let [a] = self.arguments(name)?;
                self.builder.apply(Function::Log, a)
            }
            "min" | "max" => {
                let [a, b] = self.arguments(name)?;
                self.builder.extreme(name == "min", a, b)
            }
            "pow" => {
                let [a, b] = self.arguments(name)?;
                self.builder.pow(a, b)
            }
            _ => return Err(self.unknown(start, name)),
        };
        self.checked(start, value)
    }

    fn unknown(&self, start: usize, name: &str) -> FormulaError {
        let error = self.error(start..start + name.len(), format!("there is no `{name}` in formulas"));
        let lower = name.to_ascii_lowercase();
        let meant = match lower.as_str() {
            "ln" => Some("log"),
            "power" => Some("pow"),
            "fabs" => Some("abs"),
            _ => NAMES.split(", ").find(|known| *known == lower),
        };
        // Variables side by side, as in xy.
        let factors: Vec<_> = name.split("").filter(|c| !c.is_empty()).collect();
        let help = match meant {
            Some(meant) => format!("did you mean `{meant}`?"),
            None if factors.iter().all(|c| matches!(*c, "x" | "y" | "z")) => {
                format!("did you mean `{}`?", factors.join("*"))
            }
            None => format!("known here: {NAMES}"),
        };
        error.with_help(help)
    }

    fn arguments<const N: usize>(&mut self, name: &str) -> Result<[Value; N], FormulaError> {
        let open = self.at;
        if !self.take(b'(') {
            let place = open - name.len()..open;
            return Err(self.error(place, format!("`{name}` needs its argument in parentheses")));
        }
        let mut arguments = [Value::Known(0.0); N];
        for (i, argument) in arguments.iter_mut().enumerate() {
            if i > 0 && !self.take(b',') {
                let message = format!("`{name}` needs {N} arguments, separated by commas");
                return Err(self.error_here(message));
            }
            *argument = self.sum()?;
        }
        self.close(open)?;
        Ok(arguments)
    }
}
