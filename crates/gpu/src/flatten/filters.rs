//! Pixel filters: the kind and both radii, and of those that are tabulated the distribution of
//! offsets.

use film::Filter;

use super::Flattener;

const BOX: u32 = 0;
const TRIANGLE: u32 = 1;
const TABLE: u32 = 2;

impl Flattener<'_> {
    /// A filter; its offset.
    pub fn filter(&mut self, filter: &Filter) -> u32 {
        let radius = filter.radius().to_array().map(f32::to_bits);
        let (kind, table) = match filter {
            Filter::Box(_) => (BOX, None),
            Filter::Triangle(_) => (TRIANGLE, None),
            Filter::Gaussian(_, table) | Filter::Mitchell(_, table) | Filter::LanczosSinc(_, table) => {
                (TABLE, Some(table.distribution()))
            }
        };
        let table = table.map_or(0, |table| self.distribution(table));
        self.slab.add([kind, radius[0], radius[1], table])
    }
}
