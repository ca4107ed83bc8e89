//! What is refused of a binary layer before it is parsed.
//!
//! The parser takes memory for as many values as a file says it has, and follows values in values
//! wherever they point. An allocation that fails and a stack that overflows end the program, so all
//! counts are compared with the bytes that are there first, and no value may be in itself.
//!
//! A layer has a table of sections at the end. The fields of all prims are packed integers: names,
//! and value representations of 64 bits, which say where in the file a value is. What is packed by
//! LZ4 is at most 255 times as long when it is unpacked.

use std::collections::HashSet;

/// Values in values, at most.
const DEEPEST: usize = 64;
/// How much longer LZ4 can make bytes.
const RATIO: u64 = 255;
/// Paths that are always allowed: they take some hundred bytes each.
const FEW: u64 = 1 << 20;

/// Types of values by their numbers.
mod kind {
    pub const INTEGERS: std::ops::RangeInclusive<u8> = 3..=6;
    pub const FLOATS: std::ops::RangeInclusive<u8> = 7..=9;
    pub const TIME_CODE: u8 = 56;
    /// Strings, tokens, asset paths and path expressions: indices of 32 bits.
    pub const NAMES: [u8; 4] = [10, 11, 12, 57];
    pub const DICTIONARY: u8 = 31;
    /// Lists of additions and the like, with the bytes of an element.
    pub const LISTS: [(u8, u64); 8] =
        [(32, 4), (33, 4), (34, 4), (36, 4), (37, 8), (38, 4), (39, 8), (54, 4)];
    pub const REFERENCES: u8 = 35;
    pub const PAYLOADS: u8 = 55;
    /// Vectors with the bytes of an element.
    pub const VECTORS: [(u8, u64); 6] = [(40, 4), (41, 4), (45, 8), (49, 16), (50, 4), (58, 8)];
    pub const DOUBLES: u8 = 48;
    pub const TIME_SAMPLES: u8 = 46;
}

/// The bytes of an element of an array of a type: of numbers, matrices, quaternions and vectors.
fn element_size(kind: u8) -> u64 {
    match kind {
        1 | 2 => 1,
        7 => 2,
        5 | 6 | 9 | 18 | 20 | 22 | 29 | 48 | 56 => 8,
        21 | 3 | 4 | 8 => 4,
        25 => 6,
        24 | 26 => 12,
        17 | 19 | 28 | 30 => 16,
        23 => 24,
        13 | 16 | 27 => 32,
        14 => 72,
        15 => 128,
        _ => 4,
    }
}

type Checked<T = ()> = Result<T, String>;

/// A binary layer while it is checked.
struct Layer<'b> {
    bytes: &'b [u8],
    version: [u8; 3],
    done: HashSet<u64>,
    /// The values that the current one is in.
    open: Vec<u64>,
}

/// What is wrong with a binary layer that the parser would not survive.
pub(super) fn check(bytes: &[u8]) -> Checked {
    let version = bytes.get(8..11).ok_or("the file ends in its header")?;
    let version = [version[0], version[1], version[2]];
    if version < [0, 4, 0] {
        let [major, minor, patch] = version;
        return Err(format!("binary layers of the version {major}.{minor}.{patch} are not read"));
    }
    let mut layer = Layer { bytes, version, done: HashSet::new(), open: Vec::new() };
    let table = layer.number(16)?;
    layer.part(table, 8)?;
    let sections = layer.number(table)?;
    if sections > 64 {
        return Err(format!("there are {sections} sections"));
    }
    for section in 0..sections {
        let at = table + 8 + 32 * section;
        let name = layer.part(at, 16)?;
        let start = layer.number(at + 16)?;
        layer.part(start, 0)?;
        match name.split(|&byte| byte == 0).next().unwrap_or_default() {
            b"TOKENS" => layer.tokens(start)?,
            b"STRINGS" => _ = layer.elements(start, 4)?,
            b"FIELDS" => layer.fields(start)?,
            b"FIELDSETS" => _ = layer.integers(start + 8, layer.number(start)?)?,
            b"PATHS" => layer.paths(start)?,
            b"SPECS" => layer.specs(start)?,
            _ => {}
        }
    }
    Ok(())
}

impl<'b> Layer<'b> {
    fn part(&self, at: u64, size: u64) -> Checked<&'b [u8]> {
        let end = at.checked_add(size).and_then(|end| usize::try_from(end).ok());
        let part = end.and_then(|end| self.bytes.get(at as usize..end));
        part.ok_or_else(|| format!("there are no {size} bytes at byte {at}"))
    }

    fn number(&self, at: u64) -> Checked<u64> {
        let bytes = self.part(at, 8)?;
        Ok(bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    /// A number of elements of a size after it: where they end.
    fn elements(&self, at: u64, size: u64) -> Checked<u64> {
        self.sized(at + 8, self.number(at)?, size)
    }

    /// Where elements of a size end.
    fn sized(&self, at: u64, count: u64, size: u64) -> Checked<u64> {
        let length = count.checked_mul(size);
        let length = length.ok_or_else(|| format!("there are no {count} elements at byte {at}"))?;
        self.part(at, length)?;
        Ok(at + length)
    }

    /// Packed bytes after their number, of some that were packed: where they end.
    fn packed(&self, at: u64, unpacked: u64) -> Checked<u64> {
        let packed = self.number(at)?;
        let end = self.sized(at + 8, packed, 1)?;
        match unpacked <= packed.saturating_mul(RATIO) {
            true => Ok(end),
            false => Err(format!("{packed} bytes at byte {at} cannot be {unpacked} bytes that were packed")),
        }
    }

    /// Packed integers, of two bits and more each: where they end.
    fn integers(&self, at: u64, count: u64) -> Checked<u64> {
        self.packed(at, count / 4)
    }

    fn tokens(&self, at: u64) -> Checked {
        self.packed(at + 16, self.number(at + 8)?).map(drop)
    }

    fn paths(&self, at: u64) -> Checked {
        let (count, encoded) = (self.number(at)?, self.number(at + 8)?);
        if count > FEW.max(64 * self.bytes.len() as u64) {
            return Err(format!("there are {count} paths in {} bytes", self.bytes.len()));
        }
        let mut end = at + 16;
        for _ in 0..3 {
            end = self.integers(end, encoded)?;
        }
        Ok(())
    }

    fn specs(&self, at: u64) -> Checked {
        let count = self.number(at)?;
        let mut end = at + 8;
        for _ in 0..3 {
            end = self.integers(end, count)?;
        }
        Ok(())
    }

    /// Checks the values of all fields.
    fn fields(&mut self, at: u64) -> Checked {
        let count = self.number(at)?;
        let start = self.integers(at + 8, count)?;
        let length = count.checked_mul(8).ok_or("there are too many fields")?;
        let end = self.packed(start, length)?;
        let packed = self.part(start + 8, end - start - 8)?;
        // The first byte is the number of further parts, which no file of ordinary size has.
        let [0, packed @ ..] = packed else { return Err("its fields are packed in parts".to_owned()) };
        let values = lz4_flex::block::decompress(packed, length as usize)
            .map_err(|error| format!("its fields cannot be unpacked: {error}"))?;
        let (values, _) = values.as_chunks::<8>();
        values.iter().try_for_each(|value| self.value(u64::from_le_bytes(*value)))
    }

    /// Checks a value and those in it.
    fn value(&mut self, value: u64) -> Checked {
        const ARRAY: u64 = 1 << 63;
        const INLINED: u64 = 1 << 62;
        const PACKED: u64 = 1 << 61;
        let (kind, at) = ((value >> 48 & 0xff) as u8, value & ((1 << 48) - 1));
        let is_array = value & ARRAY != 0 || kind == kind::DOUBLES;
        if (value & INLINED != 0 && !is_array) || self.done.contains(&value) {
            return Ok(());
        }
        if self.open.contains(&value) || self.open.len() >= DEEPEST {
            return Err(format!("the value at byte {at} is in itself, or too deep in others"));
        }
        self.open.push(value);
        match kind {
            _ if is_array => self.array(kind, at, value & PACKED != 0)?,
            kind::DICTIONARY => _ = self.dictionary(at)?,
            kind::TIME_SAMPLES => self.samples(at)?,
            kind::REFERENCES => _ = self.lists(at, &mut |layer, at| layer.references(at))?,
            kind::PAYLOADS => {
                let size = if self.version < [0, 8, 0] { 8 } else { 24 };
                self.lists(at, &mut |layer, at| layer.elements(at, size))?;
            }
            _ => {
                let size = |table: &[(u8, u64)]| {
                    table.iter().find(|(known, _)| *known == kind).map(|&(_, size)| size)
                };
                if let Some(size) = size(&kind::LISTS) {
                    self.lists(at, &mut |layer, at| layer.elements(at, size))?;
                } else if let Some(size) = size(&kind::VECTORS) {
                    self.elements(at, size)?;
                }
            }
        }
        self.open.pop();
        self.done.insert(value);
        Ok(())
    }

    fn array(&self, kind: u8, at: u64, is_packed: bool) -> Checked {
        if at == 0 && !kind::NAMES.contains(&kind) {
            return Ok(());
        }
        if matches!(kind, 10 | 12 | 57) {
            return self.elements(at, 4).map(drop);
        }
        let at = if self.version < [0, 5, 0] { at + 4 } else { at };
        let (count, at) = match self.version < [0, 7, 0] {
            true => (self.part(at, 4)?.iter().rev().fold(0, |n, &byte| n << 8 | u64::from(byte)), at + 4),
            false => (self.number(at)?, at + 8),
        };
        let is_integer = kind::INTEGERS.contains(&kind) && self.version >= [0, 5, 0];
        let is_float = kind::FLOATS.contains(&kind) || kind == kind::TIME_CODE || kind == kind::DOUBLES;
        let is_float = is_float && self.version >= [0, 6, 0];
        if !(is_packed && count >= 4 && (is_integer || is_float)) {
            return self.sized(at, count, element_size(kind)).map(drop);
        }
        if is_integer {
            return self.integers(at, count).map(drop);
        }
        match self.part(at, 1)? {
            b"i" => self.integers(at + 1, count).map(drop),
            b"t" => {
                let table = self.part(at + 1, 4)?.iter().rev().fold(0, |n, &byte| n << 8 | u64::from(byte));
                let end = self.sized(at + 5, table, element_size(kind))?;
                self.integers(end, count).map(drop)
            }
            _ => Ok(()),
        }
    }

    /// Up to six lists after a byte that says which: where they end.
    fn lists(&mut self, at: u64, list: &mut dyn FnMut(&mut Self, u64) -> Checked<u64>) -> Checked<u64> {
        let flags = self.part(at, 1)?[0];
        let mut end = at + 1;
        for _ in 0..(flags >> 1).count_ones() {
            end = list(self, end)?;
        }
        Ok(end)
    }

    /// Names, paths, offsets and a dictionary each: where they end.
    fn references(&mut self, at: u64) -> Checked<u64> {
        let count = self.number(at)?;
        self.sized(at + 8, count, 32)?;
        let mut end = at + 8;
        for _ in 0..count {
            self.part(end, 24)?;
            end = self.dictionary(end + 24)?;
        }
        Ok(end)
    }

    /// Checks the values of a dictionary: where it ends.
    fn dictionary(&mut self, at: u64) -> Checked<u64> {
        let count = self.number(at)?;
        let mut end = at + 8;
        for _ in 0..count {
            // The name, and how far behind there the value is.
            let place = self.jump(end + 4)?;
            let value = self.number(place)?;
            self.value(value)?;
            if place + 8 <= end {
                return Err(format!("the dictionary at byte {at} does not end"));
            }
            end = place + 8;
        }
        Ok(end)
    }

    /// Where an offset points.
    fn jump(&self, at: u64) -> Checked<u64> {
        let offset = self.number(at)? as i64;
        at.checked_add_signed(offset).ok_or_else(|| format!("the offset at byte {at} leaves the file"))
    }

    /// Checks times, and the values at them.
    fn samples(&mut self, at: u64) -> Checked {
        let times = self.jump(at)?;
        let value = self.number(times)?;
        self.value(value)?;
        let values = self.jump(times + 8)?;
        let count = self.number(values)?;
        self.sized(values + 8, count, 8)?;
        (0..count).try_for_each(|index| {
            let value = self.number(values + 8 + 8 * index)?;
            self.value(value)
        })
    }
}
