//! The buffer of tables.

/// The words that a kernel reads at once: records begin at multiples of them.
const QUAD: usize = 4;

/// Words of records.
#[derive(Debug)]
pub struct Slab {
    words: Vec<u32>,
}

impl Slab {
    /// A buffer without records, in which offset 0 is nothing.
    pub fn new() -> Self {
        Self { words: vec![0; QUAD] }
    }

    /// Adds a record; its offset, which is a multiple of four.
    pub fn add(&mut self, words: impl IntoIterator<Item = u32>) -> u32 {
        self.pad();
        let at = self.words.len() as u32;
        self.extend(words);
        at
    }

    /// Adds a record of numbers; its offset.
    pub fn add_numbers(&mut self, numbers: impl IntoIterator<Item = f32>) -> u32 {
        self.add(numbers.into_iter().map(f32::to_bits))
    }

    /// More words of the last record.
    pub fn extend(&mut self, words: impl IntoIterator<Item = u32>) {
        self.words.extend(words);
    }

    /// More numbers of the last record.
    pub fn extend_numbers(&mut self, numbers: impl IntoIterator<Item = f32>) {
        self.extend(numbers.into_iter().map(f32::to_bits));
    }

    /// A word of a record.
    pub fn word(&self, at: u32) -> u32 {
        self.words[at as usize]
    }

    /// The words of all records, as many as are read at once.
    pub fn into_words(mut self) -> Vec<u32> {
        self.pad();
        self.words
    }

    fn pad(&mut self) {
        self.words.resize(self.words.len().next_multiple_of(QUAD), 0);
    }
}

/// Vectors, each with the number that is read with it, which is 0.
pub fn padded(vectors: impl IntoIterator<Item = [f32; 3]>) -> Vec<f32> {
    vectors.into_iter().flat_map(|[x, y, z]| [x, y, z, 0.0]).collect()
}
