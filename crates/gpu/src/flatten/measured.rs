//! Measured surfaces: the number and the offset of azimuths, of elevations, and of wavelengths,
//! which are none where reflectances are red, green and blue; the colour space, and a zero. Then
//! grids, by their points along x and y and the offset of the values: of facets, of their areas, of
//! visible normals and of samples, which have the offsets of integrals, too, and of reflectances.

use scattering::{MeasuredGrid, MeasuredTable};
use spectrum::RgbColorSpace;

use super::Flattener;

impl Flattener<'_> {
    /// The offset of the record of a table.
    pub(super) fn measured(&mut self, table: &MeasuredTable) -> u32 {
        let data = table.data();
        let mut words = Vec::new();
        for numbers in [&data.phi, &data.theta, data.wavelengths.as_ref().unwrap_or(&Vec::new())] {
            words.extend([numbers.len() as u32, self.slab.add_numbers(numbers.iter().copied())]);
        }
        words.extend([self.color_space(RgbColorSpace::srgb()), 0]);
        for grid in [&data.ndf, &data.sigma] {
            words.extend(self.measured_grid(grid));
        }
        for densities in table.densities() {
            words.extend(densities.size().map(|size| size as u32));
            for numbers in densities.numbers() {
                words.push(self.slab.add_numbers(numbers.iter().copied()));
            }
        }
        words.extend(self.measured_grid(&data.values));
        self.slab.add(words)
    }

    fn measured_grid(&mut self, grid: &MeasuredGrid) -> [u32; 3] {
        let [width, height] = grid.size.map(|size| size as u32);
        [width, height, self.slab.add_numbers(grid.values.iter().copied())]
    }
}
