//! Distributions over rectangles: columns and rows, two zeros, the range (least and largest x,
//! least and largest y), the densities and edges of the rows together, and then the densities of
//! each and the edges of each.

use sampling::PiecewiseConstant2d;

use super::Flattener;

impl Flattener<'_> {
    /// A distribution over a rectangle; its offset.
    pub fn distribution(&mut self, distribution: &PiecewiseConstant2d) -> u32 {
        let ([columns, rows], domain) = (distribution.resolution(), distribution.domain());
        let at = self.slab.add([columns as u32, rows as u32, 0, 0]);
        self.slab.extend_numbers([domain.min.x, domain.max.x, domain.min.y, domain.max.y]);
        for (_, densities, edges) in distribution.tables() {
            self.slab.extend_numbers(densities.iter().chain(edges).copied());
        }
        at
    }
}
