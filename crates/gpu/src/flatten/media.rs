//! Participating media: that of the camera, those on the two sides of each geometry, and what they
//! are made of. A medium is the offset of its record, or 0 for empty space.
//!
//! The first record is the camera's medium, three zeros, and for each geometry four words: 1 where
//! its sides differ, the medium inside, that outside, and 0. A medium has
//!
//! | words | what |
//! |---|---|
//! | 0 | its tag |
//! | 1 | the asymmetry of its phase function |
//! | 2–4 | σ_a and σ_s, of colours as grids or 0, and a factor on both |
//! | 5 | its emission, or 0 |
//! | 6 | the grid of densities, the cloud or the voxels |
//! | 7 | its majorants: numbers of cells in x, y and z, 0, and bounds of densities |
//! | 8–19 | three rows from render space to the unit cube |
//!
//! and what these refer to
//!
//! | words | what |
//! |---|---|
//! | grid or 0, factor, spectrum or 0, temperatures, offset, scale | emission |
//! | numbers of values in x, y and z, first texel | a grid, of colours four words each |
//! | lowest corner, factor on the noise, size, fraying, frequency | a cloud |
//! | three rows to index space, first index, numbers of bricks, first texels of table and of values | voxels |

use description::Span;
use scene::medium::{
    CloudMedium, Coefficients, EmissionSource, Grid, GridEmission, HomogeneousMedium, MajorantGrid, Medium,
    MediumId, MediumKind, NanoVdbMedium, Placement, RgbGridMedium, Temperature, UniformGridMedium, Voxels,
};
use spectrum::RgbUnboundedSpectrum;

use super::Flattener;
use super::textures::rows;
use crate::tags::MediumTag;

/// The words of a medium but for its phase function and its place.
struct Matter {
    tag: MediumTag,
    /// σ_a, σ_s and their factor.
    coefficients: [u32; 3],
    emission: u32,
    values: u32,
}

impl Flattener<'_> {
    /// The table of media, with that of the camera; its offset.
    pub fn media(&mut self, of_camera: Option<MediumId>) -> u32 {
        let media = self.scene.media();
        let offsets: Vec<u32> = media.iter().map(|medium| self.medium(medium)).collect();
        let offset = |id: Option<MediumId>| id.map_or(0, |id| offsets[id.0 as usize]);
        let mut words = vec![offset(of_camera), 0, 0, 0];
        for entry in self.scene.geometries() {
            words.extend(match entry.media.filter(|media| media.is_transition()) {
                Some(media) => [1, offset(media.inside), offset(media.outside), 0],
                None => [0; 4],
            });
        }
        self.slab.add(words)
    }

    fn medium(&mut self, medium: &Medium) -> u32 {
        let (matter, placement, majorants) = match &medium.kind {
            MediumKind::Homogeneous(HomogeneousMedium { coefficients, le, le_scale }) => {
                let emission = le.as_ref().map_or(0, |le| {
                    let le = self.spectrum(le);
                    self.slab.add([0, le_scale.to_bits(), le, 0, 0, 0])
                });
                let coefficients = self.coefficients(coefficients);
                (Matter { tag: MediumTag::Homogeneous, coefficients, emission, values: 0 }, None, None)
            }
            MediumKind::UniformGrid(m) => (self.densities(m), Some(&m.placement), Some(&m.majorants)),
            MediumKind::RgbGrid(m) => (self.colours(m), Some(&m.placement), Some(&m.majorants)),
            MediumKind::Cloud(m) => (self.cloud(m), Some(&m.placement), Some(&m.majorants)),
            MediumKind::NanoVdb(m) => (self.sparse(m), Some(&m.placement), Some(&m.majorants)),
        };
        let Matter { tag, coefficients, emission, values } = matter;
        let majorants = majorants.map_or(0, |majorants| self.majorants(majorants));
        let words =
            [&[tag as u32, medium.phase.g.to_bits()], &coefficients[..], &[emission, values, majorants]];
        let at = self.slab.add(words.concat());
        self.slab.extend_numbers(placement.map(Placement::unit_from_render).map_or(vec![0.0; 12], rows));
        at
    }

    fn densities(&mut self, medium: &UniformGridMedium) -> Matter {
        let UniformGridMedium { placement: _, coefficients, density, majorants: _, emission } = medium;
        let emission = emission.as_ref().map_or(0, |GridEmission { source, scale, factor }| {
            let factor = self.grid(factor);
            let [spectrum, temperatures, offset, kelvin] = match source {
                EmissionSource::Spectrum(spectrum) => [self.spectrum(spectrum), 0, 0, 0],
                EmissionSource::Temperature(values, temperature) => {
                    let [offset, scale] = kelvin(temperature);
                    [0, self.grid(values), offset, scale]
                }
            };
            self.slab.add([factor, scale.to_bits(), spectrum, temperatures, offset, kelvin])
        });
        let coefficients = self.coefficients(coefficients);
        Matter { tag: MediumTag::Densities, coefficients, emission, values: self.grid(density) }
    }

    fn colours(&mut self, medium: &RgbGridMedium) -> Matter {
        let RgbGridMedium { placement: _, sigma_a, sigma_s, scale, majorants: _, le, le_scale, space } =
            medium;
        let [sigma_a, sigma_s] =
            [sigma_a, sigma_s].map(|grid| grid.as_ref().map_or(0, |grid| self.grid_of_colours(grid)));
        let emission = le.as_ref().map_or(0, |le| {
            let (grid, illuminant) = (self.grid_of_colours(le), self.spectrum(&space.illuminant()));
            self.slab.add([grid, le_scale.to_bits(), illuminant, 0, 0, 0])
        });
        let coefficients = [sigma_a, sigma_s, scale.to_bits()];
        Matter { tag: MediumTag::Colours, coefficients, emission, values: 0 }
    }

    fn cloud(&mut self, medium: &CloudMedium) -> Matter {
        let CloudMedium {
            placement: _,
            bounds,
            coefficients,
            majorants: _,
            density,
            wispiness,
            frequency,
            instruction_set: _,
        } = medium;
        let [low, size] = [bounds.min, bounds.diagonal()].map(|v| v.to_array());
        let numbers = [&low[..], &[*density], &size, &[*wispiness], &[*frequency]];
        let values = self.slab.add_numbers(numbers.concat());
        let coefficients = self.coefficients(coefficients);
        Matter { tag: MediumTag::Cloud, coefficients, emission: 0, values }
    }

    fn sparse(&mut self, medium: &NanoVdbMedium) -> Matter {
        let NanoVdbMedium { placement: _, coefficients, density, majorants: _, emission } = medium;
        let emission = emission.as_ref().map_or(0, |(voxels, temperature, factor)| {
            let ([offset, scale], voxels) = (kelvin(temperature), self.voxels(voxels));
            self.slab.add([0, factor.to_bits(), 0, voxels, offset, scale])
        });
        let coefficients = self.coefficients(coefficients);
        Matter { tag: MediumTag::Voxels, coefficients, emission, values: self.voxels(density) }
    }

    fn coefficients(&mut self, Coefficients { sigma_a, sigma_s, scale }: &Coefficients) -> [u32; 3] {
        [self.spectrum(sigma_a), self.spectrum(sigma_s), scale.to_bits()]
    }

    fn majorants(&mut self, majorants: &MajorantGrid) -> u32 {
        let [x, y, z] = majorants.resolution().map(|n| n as u32);
        let at = self.slab.add([x, y, z, 0]);
        self.slab.extend_numbers(majorants.values().iter().copied());
        at
    }

    fn grid(&mut self, grid: &Grid<f32>) -> u32 {
        let first = self.values(grid.values().iter().map(|value| value.to_bits()));
        let [x, y, z] = grid.resolution().map(|n| n as u32);
        self.slab.add([x, y, z, first])
    }

    fn grid_of_colours(&mut self, grid: &Grid<RgbUnboundedSpectrum>) -> u32 {
        let words = grid.values().iter().flat_map(|colour| {
            let [a, b, c] = colour.polynomial().coefficients;
            [colour.scale(), a, b, c].map(f32::to_bits)
        });
        let first = self.values(words);
        let [x, y, z] = grid.resolution().map(|n| n as u32);
        self.slab.add([x, y, z, first])
    }

    fn voxels(&mut self, Voxels { values, index_from_render }: &Voxels) -> u32 {
        let table = self.values(values.table.iter().copied());
        let first = self.values(values.values.iter().map(|value| value.to_bits()));
        let at = self.slab.add_numbers(rows(index_from_render));
        self.slab.extend(
            values.origin.map(i32::cast_unsigned).into_iter().chain(values.bricks).chain([table, first]),
        );
        at
    }

    /// Words in the buffer of texels; where they begin.
    fn values(&mut self, words: impl Iterator<Item = u32>) -> u32 {
        let at = self.texels.words.len();
        self.texels.words.extend(words);
        if self.texels.words.len() * 4 > self.largest_buffer {
            self.texels.words.truncate(at);
            self.refuse(format!("media of more than {} MiB", self.largest_buffer >> 20), Span::NONE);
        }
        at as u32
    }
}

/// Offset and scale of temperatures.
fn kelvin(Temperature { offset, scale }: &Temperature) -> [u32; 2] {
    [offset, scale].map(|number| number.to_bits())
}
