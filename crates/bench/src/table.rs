//! Markdown tables.

use std::fmt;

/// A table with a header, and rows of a name and values.
pub struct Table {
    text: String,
}

impl Table {
    /// An empty table with these column heads.
    pub fn new<'a>(heads: impl IntoIterator<Item = &'a str>) -> Self {
        let heads: Vec<&str> = heads.into_iter().collect();
        let text = line(heads.iter()) + &line(heads.iter().map(|_| "---"));
        Self { text }
    }

    /// Adds a row.
    pub fn row(&mut self, name: &str, values: impl IntoIterator<Item = String>) {
        self.text += &line(std::iter::once(name.to_owned()).chain(values));
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn line(cells: impl Iterator<Item = impl fmt::Display>) -> String {
    let cells: String = cells.map(|cell| format!(" {cell} |")).collect();
    format!("|{cells}\n")
}

/// The ratios of values, as text.
pub fn ratios(values: &[f64], others: &[f64]) -> Vec<String> {
    values.iter().zip(others).map(|(value, other)| format!("{:.2}", value / other)).collect()
}
