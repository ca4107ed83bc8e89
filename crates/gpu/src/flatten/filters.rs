//! Pixel filters: the kind and both radii, and of those that are tabulated the distribution of
//! offsets, and a bit for each cell of it: whether the filter is negative there.

use film::Filter;
use math::Vec2;

use super::Flattener;
use crate::tags::FilterTag;

impl Flattener<'_> {
    /// A filter; its offset.
    pub fn filter(&mut self, filter: &Filter) -> u32 {
        let radius = filter.radius().to_array().map(f32::to_bits);
        let (tag, table) = match filter {
            Filter::Box(_) => (FilterTag::Box, None),
            Filter::Triangle(_) => (FilterTag::Triangle, None),
            Filter::Gaussian(_, table) | Filter::Mitchell(_, table) | Filter::LanczosSinc(_, table) => {
                (FilterTag::Table, Some(table))
            }
        };
        let kind = tag as u32;
        let Some(table) = table else { return self.slab.add([kind, radius[0], radius[1]]) };
        let distribution = self.distribution(table.distribution());
        let ([columns, rows], domain) = (table.distribution().resolution(), table.distribution().domain());
        let is_negative = |cell: usize| {
            let [x, y] = [cell % columns, cell / columns].map(|i| i as f32 + 0.5);
            filter.evaluate(domain.lerp(Vec2::new(x / columns as f32, y / rows as f32))) < 0.0
        };
        let mut signs = vec![0; (columns * rows).div_ceil(32)];
        for cell in (0..columns * rows).filter(|&cell| is_negative(cell)) {
            signs[cell / 32] |= 1 << (cell % 32);
        }
        let signs = self.slab.add(signs);
        self.slab.add([kind, radius[0], radius[1], distribution, signs])
    }
}
