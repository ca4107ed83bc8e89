//! The buffer of tables.

/// Words of records.
#[derive(Debug)]
pub struct Slab {
    pub words: Vec<u32>,
}

impl Slab {
    /// A buffer without records, in which offset 0 is nothing.
    pub fn new() -> Self {
        Self { words: vec![0] }
    }

    /// Adds a record; its offset.
    pub fn add(&mut self, words: impl IntoIterator<Item = u32>) -> u32 {
        let at = self.words.len() as u32;
        self.words.extend(words);
        at
    }

    /// Adds a record of numbers; its offset.
    pub fn add_numbers(&mut self, numbers: impl IntoIterator<Item = f32>) -> u32 {
        self.add(numbers.into_iter().map(f32::to_bits))
    }
}
