//! Principled surfaces: whether it is a sheet, the offset of its table, the number of textures of
//! numbers, and the place of the texture of the radius where paths go on under the surface; for
//! each colour the place of its texture; the images of the normals of the coat and of the base
//! where they differ, or 0; the values of all numbers; and for each number that has a texture, in
//! the order of the textures, which it is, its range, and 0. A texture that is not seen has
//! [`NO_TEXTURE`] for its place.
//!
//! A table has the numbers of axes, azimuths and films, the range of their thickness, and the
//! offsets of what is taken, of what is inside, and of means, whose rows are of four or eight
//! words; then its axes: which number, how it is made one from 0 to 1, its nodes, 0, its range, and
//! two zeros.

use description::{OpenPbrDesc, Span};
use scattering::OpenPbrTable;
use scene::material::{OpenPbrMaterial, PlainOpenPbr};

use super::Flattener;

/// In place of the number of a texture that is not seen.
const NO_TEXTURE: u32 = u32::MAX;

/// The number whose presence shows each colour, if there is one.
const SHOWN_BY: [Option<&str>; OpenPbrDesc::COLORS.len()] = [
    None,
    None,
    Some("transmission_weight"),
    Some("subsurface_weight"),
    Some("coat_weight"),
    Some("fuzz_weight"),
];

impl Flattener<'_> {
    /// The offset of a surface's record, and its textures.
    pub(super) fn principled(&mut self, surface: &OpenPbrMaterial, span: Span) -> (u32, Vec<u32>) {
        self.parts.principled = true;
        let textures = self.scene.textures();
        let is_body = surface.may_be_a_body(textures);
        if is_body && self.begins_at_lights {
            self.refuse("light paths under the surface of `openpbr`", span);
        }
        let is_followed = is_body && self.follows_bodies;
        self.parts.subsurface |= is_followed;
        let PlainOpenPbr { constants, varying, colors, radius_scale, is_thin, coat_normals, table } =
            surface.plain();
        let is_seen = |name: &str| {
            let Some(number) = OpenPbrDesc::number(name) else { return true };
            constants[number] > 0.0 || varying.iter().any(|(varies, _)| *varies == number)
        };
        let mut used: Vec<u32> = varying.iter().map(|(_, id)| self.number_texture(*id, span)).collect();
        let radius = if is_followed { used.len() as u32 } else { NO_TEXTURE };
        if is_followed {
            used.push(self.spectrum_texture(radius_scale, span));
        }
        let mut words = vec![is_thin.into(), self.openpbr_table(table), varying.len() as u32, radius];
        for (color, shown_by) in colors.iter().zip(SHOWN_BY) {
            let is_seen = shown_by.is_none_or(is_seen);
            words.push(if is_seen { used.len() as u32 } else { NO_TEXTURE });
            if is_seen {
                used.push(self.spectrum_texture(*color, span));
            }
        }
        for map in coat_normals.map_or([None; 2], |normals| normals.maps()) {
            words.push(map.map_or(0, |map| self.normal_map(map, span)));
        }
        words.extend(constants.map(f32::to_bits));
        for (number, _) in varying {
            let [least, most] = OpenPbrDesc::NUMBERS[number].range;
            words.extend([number as u32, least.to_bits(), most.to_bits(), 0]);
        }
        (self.slab.add(words), used)
    }

    fn openpbr_table(&mut self, table: &OpenPbrTable) -> u32 {
        let words = openpbr_table(table, |numbers| self.slab.add_numbers(numbers.iter().copied()));
        self.slab.add(words)
    }
}

/// The record of a table, of which `add` adds the rows and gives their offset.
pub fn openpbr_table(table: &OpenPbrTable, mut add: impl FnMut(&[f32]) -> u32) -> Vec<u32> {
    let table = table.plain();
    let [least, most] = table.waves.map(f32::to_bits);
    let padded = |numbers: &[f32], from: usize, to: usize| -> Vec<f32> {
        let rows = numbers.chunks_exact(from);
        rows.flat_map(|row| row.iter().copied().chain(std::iter::repeat_n(0.0, to - from))).collect()
    };
    let rows = [add(table.taken), add(&padded(table.inside, 3, 4)), add(&padded(table.means, 6, 8))];
    let mut words = vec![table.axes.len() as u32, table.azimuths, table.films, least, most];
    words.extend(rows);
    for (number, scale, nodes, range) in table.axes {
        words.extend([number, scale, nodes, 0, range[0].to_bits(), range[1].to_bits(), 0, 0]);
    }
    words
}
