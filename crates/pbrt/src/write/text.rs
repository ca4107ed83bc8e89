//! The text of a scene: lines, blocks, and the colour space in force.

use description::{ColorSpaceDesc, TransformDesc};
use math::DMat4;

use crate::write::number::decimal;
use crate::write::statement::{Statement, Written, quoted};

/// The most characters of a line.
const WIDTH: usize = 100;

/// The text so far.
pub(crate) struct Text {
    text: String,
    /// The colour space in force in each open block.
    spaces: Vec<ColorSpaceDesc>,
    /// The first reason why the scene cannot be written.
    problem: Option<String>,
}

impl Text {
    pub(crate) fn new() -> Self {
        Self { text: String::new(), spaces: vec![ColorSpaceDesc::Srgb], problem: None }
    }

    /// The text, or why the scene cannot be written.
    pub(crate) fn finish(self) -> Result<String, String> {
        self.problem.map_or(Ok(self.text), Err)
    }

    /// Notes why the scene cannot be written.
    pub(crate) fn fail(&mut self, problem: impl Into<String>) {
        self.problem.get_or_insert(problem.into());
    }

    fn indent(&self) -> usize {
        4 * (self.spaces.len() - 1)
    }

    /// Begins a paragraph: an empty line, unless there is one.
    pub(crate) fn paragraph(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.line("");
        }
    }

    /// A line in the current block.
    pub(crate) fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.text.extend(std::iter::repeat_n(' ', self.indent()));
        }
        self.text += line;
        self.text.push('\n');
    }

    /// Begins a block by a line.
    pub(crate) fn begin(&mut self, line: &str) {
        self.line(line);
        self.spaces.push(self.space());
    }

    /// Ends a block by a line.
    pub(crate) fn end(&mut self, line: &str) {
        self.spaces.pop();
        self.line(line);
    }

    /// The lines that `write` writes, in a block of attributes if `needed`.
    pub(crate) fn block(&mut self, needed: bool, write: impl FnOnce(&mut Self)) {
        if needed {
            self.begin("AttributeBegin");
        }
        write(self);
        if needed {
            self.end("AttributeEnd");
        }
    }

    fn space(&self) -> ColorSpaceDesc {
        self.spaces.last().copied().unwrap_or_default()
    }

    fn set_space(&mut self, space: ColorSpaceDesc) {
        if space != self.space() {
            self.line(&format!("ColorSpace {}", quoted(space.name())));
            self.spaces.last_mut().into_iter().for_each(|current| *current = space);
        }
    }

    /// Replaces the current transform of a new block, or of the settings.
    pub(crate) fn transform(&mut self, transform: &TransformDesc) {
        if !transform.is_animated() {
            return self.matrix(&transform.start);
        }
        for (time, matrix) in [("StartTime", &transform.start), ("EndTime", &transform.end)] {
            self.line(&format!("ActiveTransform {time}"));
            self.matrix(matrix);
        }
        self.line("ActiveTransform All");
    }

    /// Replaces the current transform, which is the identity.
    pub(crate) fn matrix(&mut self, matrix: &DMat4) {
        if *matrix == DMat4::IDENTITY {
            return;
        }
        if !matrix.is_finite() || matrix.determinant() == 0.0 {
            self.fail("a transform is singular");
        }
        let numbers = matrix.to_cols_array().map(decimal).to_vec();
        self.values("Transform", &numbers);
    }

    /// A statement, in its colour space. Parameters in another one are given as defaults before it.
    pub(crate) fn statement(&mut self, statement: Statement) {
        let Statement { head, parameters, space, target, problem } = statement;
        if let Some(problem) = problem {
            self.fail(format!("{head}: {problem}"));
        }
        let own = space.or_else(|| parameters.iter().find_map(|parameter| parameter.space));
        let is_elsewhere = |parameter: &Written| parameter.space.is_some_and(|space| Some(space) != own);
        let (elsewhere, parameters): (Vec<_>, Vec<_>) = parameters.into_iter().partition(is_elsewhere);
        self.block(!elsewhere.is_empty(), |text| {
            for parameter in elsewhere {
                text.set_space(parameter.space.unwrap_or_default());
                text.parameters(&format!("Attribute {}", quoted(target)), &[parameter]);
            }
            if let Some(own) = own {
                text.set_space(own);
            }
            text.parameters(&head, &parameters);
        });
    }

    /// A statement on one line if it fits, else with a line for each parameter.
    fn parameters(&mut self, head: &str, parameters: &[Written]) {
        let mut line = head.to_owned();
        for Written { declaration, values, .. } in parameters {
            if line.len() > WIDTH {
                break;
            }
            line += &match &values[..] {
                [value] => format!(" {} {value}", quoted(declaration)),
                values => format!(" {} [ {} ]", quoted(declaration), values.join(" ")),
            };
        }
        if self.indent() + line.chars().count() <= WIDTH {
            return self.line(&line);
        }
        self.line(head);
        self.spaces.push(self.space());
        for Written { declaration, values, .. } in parameters {
            match &values[..] {
                [value] => self.line(&format!("{} {value}", quoted(declaration))),
                values => self.values(&quoted(declaration), values),
            }
        }
        self.spaces.pop();
    }

    /// Values in brackets after a head, on as many lines as they need.
    fn values(&mut self, head: &str, values: &[String]) {
        let mut line = format!("{head} [");
        let mut is_first = true;
        for value in values {
            let width = if is_first { self.indent() } else { self.indent() + 4 };
            if width + line.len() + 1 + value.len() > WIDTH {
                self.line(&format!("{}{line}", if is_first { "" } else { "    " }));
                (line, is_first) = (String::new(), false);
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += value;
        }
        self.line(&format!("{}{line} ]", if is_first { "" } else { "    " }));
    }
}
