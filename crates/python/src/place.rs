//! Places in Python programs: the calls that have built a scene.

use std::sync::Arc;

use alhazen::description::{SourceMap, Span};
use pyo3::prelude::*;

/// The name of a scene that was built, and of its record of calls.
pub const BUILT: &str = "<scene>";

/// The file and the line of a Python program.
pub struct Place {
    file: String,
    line: u32,
}

impl Place {
    /// The place of the code that calls; `None` if it is no Python.
    pub fn of_caller(py: Python) -> Option<Self> {
        let find = || -> PyResult<Self> {
            let frame = py.import("sys")?.call_method0("_getframe")?;
            let file = frame.getattr("f_code")?.getattr("co_filename")?.str()?;
            Ok(Self {
                file: file.to_string_lossy().into_owned(),
                line: frame.getattr("f_lineno")?.extract()?,
            })
        };
        find().ok()
    }
}

/// The calls of a builder, one for each line of its record.
#[derive(Clone, Default)]
pub struct Calls(Vec<Call>);

#[derive(Clone)]
struct Call {
    /// The method, such as `shape`.
    method: &'static str,
    place: Option<(Arc<str>, u32)>,
}

impl Calls {
    /// Adds a call.
    pub fn add(&mut self, method: &'static str, place: Option<&Place>) {
        let last = self.0.last().and_then(|call| call.place.as_ref());
        let place = place.map(|Place { file, line }| match last {
            Some((last, _)) if **last == **file => (last.clone(), *line),
            _ => (file.as_str().into(), *line),
        });
        self.0.push(Call { method, place });
    }

    /// The call that has made a part of a scene, with its place, as in `a.py:12: in
    /// shape("sphere")`; `None` for a part that is of a file.
    pub fn describe(&self, sources: &SourceMap, span: Span) -> Option<String> {
        if sources.name(span.file) != BUILT {
            return None;
        }
        let call = self.0.get(sources.position(span).line - 1)?;
        let record = sources.line(span);
        let kind = record.split(' ').nth(1).filter(|word| word.starts_with('"')).unwrap_or_default();
        let text = match call.method {
            "emission" => "shape(…, emission=…)".to_owned(),
            method => format!("{method}({kind})"),
        };
        Some(match &call.place {
            Some((file, line)) => format!("{file}:{line}: in {text}"),
            None => format!("in {text}"),
        })
    }
}
