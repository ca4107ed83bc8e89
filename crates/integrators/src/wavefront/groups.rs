//! Hits grouped by material.

use scene::material::MaterialId;

/// Hits of a batch, grouped by material by a counting sort.
#[derive(Default)]
pub(super) struct Groups {
    /// Material, index of the hit, path.
    hits: Vec<(MaterialId, u32, u32)>,
    /// For each material the number of hits; once sorted, the end of its group.
    ends: Vec<u32>,
    /// The materials that have hits.
    used: Vec<MaterialId>,
    /// The sorted indices of the hits, and their paths.
    turns: Vec<u32>,
    rows: Vec<u32>,
}

impl Groups {
    /// Removes all hits. Materials have ids below `materials`.
    pub fn clear(&mut self, materials: usize) {
        self.hits.clear();
        self.used.iter().for_each(|id| self.ends[id.0 as usize] = 0);
        self.used.clear();
        self.ends.resize(materials, 0);
    }

    /// Adds a hit.
    #[inline]
    pub fn push(&mut self, material: MaterialId, turn: u32, row: u32) {
        let count = &mut self.ends[material.0 as usize];
        if *count == 0 {
            self.used.push(material);
        }
        *count += 1;
        self.hits.push((material, turn, row));
    }

    /// Sorts the hits.
    pub fn sort(&mut self) {
        let mut first = 0;
        for id in &self.used {
            let end = &mut self.ends[id.0 as usize];
            first += std::mem::replace(end, first);
        }
        self.turns.resize(self.hits.len(), 0);
        self.rows.resize(self.hits.len(), 0);
        for &(material, turn, row) in &self.hits {
            let end = &mut self.ends[material.0 as usize];
            self.turns[*end as usize] = turn;
            self.rows[*end as usize] = row;
            *end += 1;
        }
    }

    /// The groups of sorted hits: material, indices of the hits, and their paths.
    pub fn iter(&self) -> impl Iterator<Item = (MaterialId, &[u32], &[u32])> {
        let mut first = 0;
        self.used.iter().map(move |&material| {
            let end = self.ends[material.0 as usize] as usize;
            let group = first..end;
            first = end;
            (material, &self.turns[group.clone()], &self.rows[group])
        })
    }
}
