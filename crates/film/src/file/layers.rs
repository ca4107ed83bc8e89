//! A film's sums in a film file.

use super::FilmFileError;
use super::section::Fields;
use crate::grid::Grid;
use crate::sum::TileSums;
use crate::{Film, MAX_REJECTED_PIXELS, Rejected, TILE_SIZE};

/// Appends the totals of a film: paths of splats and refused samples.
pub fn put_totals(payload: &mut Vec<u8>, film: &Film) {
    payload.extend(film.splats.paths().to_le_bytes());
    let rejected = film.rejected();
    payload.extend(rejected.count.to_le_bytes());
    payload.push(rejected.pixels().count() as u8);
    payload.extend(rejected.pixels().flatten().flat_map(i32::to_le_bytes));
}

/// Adds what [`put_totals`] has written.
pub fn add_totals(fields: &mut Fields, film: &mut Film) -> Result<(), FilmFileError> {
    film.splats.add_paths(fields.u64()?);
    let (count, pixels) = (fields.u64()?, fields.u8()?);
    if usize::from(pixels) > MAX_REJECTED_PIXELS || u64::from(pixels) > count {
        return Err(fields.wrong(&format!("it lists {pixels} pixels of {count} refused samples")));
    }
    let mut remembered = Vec::new();
    for _ in 0..pixels {
        remembered.push([fields.i32()?, fields.i32()?]);
    }
    film.add_rejected(&Rejected::new(count, remembered));
    Ok(())
}

/// The sums of a row of tiles: tile by tile, component by component, each as a block, then
/// identifiers.
pub fn row(film: &Film, row: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let payload = &mut bytes;
    for tile in film.grid.row(row) {
        let range = film.grid.range(tile);
        let pixels = range.len();
        for c in 0..film.color.components() {
            put_block(payload, pixels, |pixel| film.color.units([tile, range.start, pixel], c));
        }
        if !film.counts.is_empty() {
            put_block(payload, pixels, |pixel| film.counts[range.start + pixel].into());
        }
        for sums in [&film.data, &film.spectrum] {
            for c in 0..sums.components() {
                put_block(payload, pixels, |pixel| sums.units([tile, range.start, pixel], c));
            }
        }
        if !film.splats.is_empty() {
            let sums = film.splats.tile(tile);
            for c in 0..sums.components() {
                put_block(payload, pixels, |pixel| sums.units(pixel, c));
            }
        }
        for ids in film.ids.iter().filter_map(|ids| ids.get(tile)) {
            payload.extend((ids.len() as u32).to_le_bytes());
            for (&(pixel, id), weight) in ids {
                payload.extend(pixel.to_le_bytes());
                payload.extend(id.to_le_bytes());
                payload.extend(weight.to_le_bytes());
            }
        }
    }
    bytes
}

/// Adds what [`row`] has.
pub fn add_row(fields: &mut Fields, film: &mut Film, row: usize) -> Result<(), FilmFileError> {
    for tile in film.grid.row(row) {
        let range = film.grid.range(tile);
        let (mut has_light, mut samples) = (false, 0);
        if film.color.components() > 0 {
            has_light = add_sums(fields, range.len(), film.color.tile(tile, range.clone()))?;
        }
        if !film.counts.is_empty() {
            let counts = block(fields, range.len())?;
            for (sum, count) in film.counts[range.clone()].iter_mut().zip(counts) {
                let count = u32::try_from(count).map_err(|_| fields.wrong(&format!("{count} samples")))?;
                *sum = sum.saturating_add(count);
                samples |= count;
            }
        }
        for own in [&mut film.data, &mut film.spectrum].into_iter().filter(|sums| sums.components() > 0) {
            has_light |= add_sums(fields, range.len(), own.tile(tile, range.clone()))?;
        }
        // A tile without samples is taken to be empty.
        if has_light && samples == 0 {
            return Err(fields.wrong("light without samples"));
        }
        if !film.splats.is_empty() {
            add_sums(fields, range.len(), film.splats.tile(tile).open())?;
        }
        for ids in film.ids.iter_mut().filter_map(|ids| ids.get_mut(tile)) {
            for _ in 0..fields.u32()? {
                let (pixel, id) = (fields.array().map(u16::from_le_bytes)?, fields.u32()?);
                if usize::from(pixel) >= range.len() {
                    return Err(fields.wrong(&format!("an identifier in pixel {pixel} of {}", range.len())));
                }
                let sum = ids.entry((pixel, id)).or_insert(0);
                *sum = sum.saturating_add(fields.array().map(i128::from_le_bytes)?);
            }
        }
    }
    Ok(())
}

/// Adds the blocks of all components to the sums of a tile of so many pixels; whether there are any
/// but zeros.
fn add_sums(fields: &mut Fields, pixels: usize, mut sums: TileSums) -> Result<bool, FilmFileError> {
    let mut all = 0;
    for c in 0..sums.components() {
        for (pixel, units) in block(fields, pixels)?.enumerate() {
            sums.add_units(pixel, c, units);
            all |= units;
        }
    }
    Ok(all != 0)
}

/// The most bytes that a row of tiles takes; any number that fits in `limit` where there are
/// identifiers.
pub fn max_row_bytes(film: &Film, limit: u64) -> u64 {
    if film.ids.iter().any(|ids| !ids.is_empty()) {
        return limit;
    }
    let Grid(bounds) = film.grid;
    let count = usize::from(!film.counts.is_empty());
    let splats = if film.splats.is_empty() { 0 } else { film.splats.tile(0).components() };
    let sums = [&film.color, &film.data, &film.spectrum].map(|sums| sums.components());
    let components = sums.iter().sum::<usize>() + count + splats;
    let tile = 1 + 16 * TILE_SIZE as u64 * TILE_SIZE as u64;
    (bounds.width() as u64).div_ceil(TILE_SIZE as u64) * components as u64 * tile
}

/// Appends `count` whole numbers, each in as many bytes as the longest of them needs, with that
/// length before them.
fn put_block(payload: &mut Vec<u8>, count: usize, number: impl Fn(usize) -> i128) {
    // Those below 0 need as many bits as their complements.
    let (mut bits, mut is_zero) = (0, true);
    for number in (0..count).map(&number) {
        bits |= number ^ number >> 127;
        is_zero &= number == 0;
    }
    let length = if is_zero { 0 } else { byte_length(bits) };
    payload.push(length as u8);
    // Sixteen bytes are written of each, of which the next number overwrites what is too much.
    let start = payload.len();
    payload.resize(start + length * count + 16, 0);
    for (index, number) in (0..count).map(&number).enumerate() {
        let at = start + length * index;
        payload[at..at + 16].copy_from_slice(&number.to_le_bytes());
    }
    payload.truncate(start + length * count);
}

/// The bytes that a number that is not negative needs in two's complement.
fn byte_length(value: i128) -> usize {
    let bits = i128::BITS - value.leading_zeros();
    (bits as usize + 1).div_ceil(8)
}

/// Reads a block of `count` numbers.
fn block<'a>(
    fields: &mut Fields<'a>,
    count: usize,
) -> Result<impl Iterator<Item = i128> + use<'a>, FilmFileError> {
    let length = usize::from(fields.u8()?);
    if length > 16 {
        return Err(fields.wrong(&format!("a number of {length} bytes")));
    }
    let bytes = fields.bytes(length * count)?;
    let unused = 128 - 8 * length as u32;
    Ok((0..count).map(move |index| {
        let rest = &bytes[length * index..];
        let number = match rest.first_chunk() {
            Some(sixteen) => i128::from_le_bytes(*sixteen),
            None => {
                let mut sixteen = [0; 16];
                sixteen[..rest.len()].copy_from_slice(rest);
                i128::from_le_bytes(sixteen)
            }
        };
        number.checked_shl(unused).unwrap_or(0) >> unused.min(127)
    }))
}

#[cfg(test)]
mod tests {
    use super::super::section::Section;
    use super::*;
    use crate::compile;
    use description::SceneDesc;

    #[test]
    fn light_without_samples_is_damage() {
        let empty = || compile(&SceneDesc::default()).unwrap().film;
        for (has_light, counts, is_damaged) in [(false, 0, false), (true, 1, false), (true, 0, true)] {
            let mut film = empty();
            let range = film.grid.range(0);
            film.color.tile(0, range).add_units(3, 1, has_light.into());
            film.counts[5] = counts;
            let section = Section { tag: *b"ROWS", payload: row(&film, 0) };
            let added = add_row(&mut section.fields(), &mut empty(), 0);
            assert_eq!(added.is_err(), is_damaged, "{added:?}");
        }
    }

    #[test]
    fn numbers_of_any_length_survive() {
        for values in [
            vec![],
            vec![0; 5],
            vec![127, -128, 0],
            vec![128, -129],
            vec![-1; 3],
            vec![i128::MAX, i128::MIN, 1 << 96],
        ] {
            let mut payload = Vec::new();
            put_block(&mut payload, values.len(), |index| values[index]);
            let section = Section { tag: *b"ROWS", payload };
            let mut fields = section.fields();
            assert!(block(&mut fields, values.len()).unwrap().eq(values));
            fields.finish().unwrap();
        }
        for (value, length) in [(0, 0), (1, 1), (-1, 1), (127, 1), (128, 2), (-128, 1), (-129, 2)] {
            let mut payload = Vec::new();
            put_block(&mut payload, 2, |index| [0, value][index]);
            assert_eq!((payload[0], payload.len()), (length, 1 + 2 * usize::from(length)));
        }
    }
}
