//! Layers of identifiers in the form of Cryptomatte: the identifiers of a pixel that cover most of
//! it, in pairs of channels of identifier and coverage [Friedman 2015].
//!
//! An identifier is a hash of a name whose bits make a finite single float. The manifest in the
//! header of a picture lists the names of its identifiers.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use image::{Attribute, ImageMetadata};

use crate::Layer;

/// The number of identifiers per pixel of a picture.
const RANKS: usize = 6;

/// The identifier of a name: its hash by MurmurHash3 (32 bits, seed 0), one bit of it changed where
/// it would make a float that is not finite or not normal.
pub fn id_of_name(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    match hash >> 23 & 0xff {
        0 | 0xff => hash ^ 1 << 23,
        _ => hash,
    }
}

/// MurmurHash3_x86_32 of Austin Appleby, in the public domain.
fn murmur3(bytes: &[u8]) -> u32 {
    let scramble = |k: u32| k.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte));
    let (words, rest) = (bytes.chunks_exact(4), bytes.chunks_exact(4).remainder());
    let mut hash = words.fold(0u32, |hash, bytes| {
        (hash ^ scramble(word(bytes))).rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    hash ^= scramble(word(rest)) ^ bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

/// The names of a layer's channels: of each rank identifier and coverage, two ranks in r, g, b and
/// a of one layer.
pub(crate) fn channels(layer: Layer) -> impl Iterator<Item = String> {
    (0..RANKS / 2).flat_map(move |level| {
        ["r", "g", "b", "a"].map(|channel| format!("{}{level:02}.{channel}", layer.cryptomatte()))
    })
}

/// The values of [`channels`] for a pixel with these identifiers and weights; `whole` is the weight
/// of full coverage.
pub(crate) fn ranks(covered: impl Iterator<Item = (u32, f64)>, whole: f64) -> impl Iterator<Item = f32> {
    let mut covered: Vec<_> = covered.filter(|&(_, weight)| weight > 0.0).collect();
    covered.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let empty = std::iter::repeat((0, 0.0));
    let divisor = if whole == 0.0 { 1.0 } else { whole };
    covered
        .into_iter()
        .chain(empty)
        .take(RANKS)
        .flat_map(move |(id, weight)| [f32::from_bits(id), (weight / divisor) as f32])
}

/// Writes a layer's manifest to a picture's header: of these names, those whose identifiers are in
/// the picture, as a JSON object of identifiers by name.
pub(crate) fn set_manifest<S: AsRef<str>>(
    layer: Layer,
    names: impl IntoIterator<Item = S>,
    present: &BTreeSet<u32>,
    metadata: &mut ImageMetadata,
) {
    let names = names.into_iter().map(|name| {
        let id = id_of_name(name.as_ref());
        (id, name)
    });
    let names: BTreeMap<String, u32> =
        names.filter(|(id, _)| present.contains(id)).map(|(id, name)| (quoted(name.as_ref()), id)).collect();
    let entries: Vec<_> = names.iter().map(|(name, id)| format!("{name}:\"{id:08x}\"")).collect();
    let manifest = format!("{{{}}}", entries.join(","));
    metadata.set(&attribute(layer, "manifest"), Attribute::Text(manifest));
}

/// A JSON string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            // Writing to a string never fails.
            c if c.is_control() => drop(write!(quoted, "\\u{:04x}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// Marks a layer as Cryptomatte in a picture's header.
pub(crate) fn describe(layer: Layer, metadata: &mut ImageMetadata) {
    let mut set = |key, value: &str| metadata.set(&attribute(layer, key), Attribute::Text(value.to_owned()));
    set("name", layer.cryptomatte());
    set("hash", "MurmurHash3_32");
    set("conversion", "uint32_to_float32");
}

/// The attribute with this key of a layer; the first seven digits of the hash of its name
/// distinguish it from other layers.
fn attribute(layer: Layer, key: &str) -> String {
    let digits = format!("{:08x}", id_of_name(layer.cryptomatte()));
    format!("cryptomatte/{}/{key}", &digits[..7])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_murmur3() {
        // Test vectors that are published with implementations of the hash.
        for (text, hash) in [
            ("", 0),
            ("test", 0xba6b_d213),
            ("Hello, world!", 0xc036_3e43),
            ("The quick brown fox jumps over the lazy dog", 0x2e4f_f723),
        ] {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
    }

    #[test]
    fn identifiers_make_finite_normal_floats() {
        for i in 0..10_000 {
            let id = f32::from_bits(id_of_name(&format!("object-{i}")));
            assert!(id.is_normal(), "{i}");
        }
    }

    #[test]
    fn names_are_json_strings() {
        assert_eq!(quoted("a\"b\\c\n\u{85}é"), r#""a\"b\\c\u000a\u0085é""#);
    }

    #[test]
    fn the_largest_coverage_comes_first() {
        let covered = [(1, 0.5), (2, 1.0), (3, 0.0), (4, 0.5)];
        let ranks: Vec<f32> = ranks(covered.into_iter(), 4.0).collect();
        let ids: Vec<u32> = ranks.iter().step_by(2).map(|id| id.to_bits()).collect();
        assert_eq!(ids, [2, 1, 4, 0, 0, 0]);
        let coverage: Vec<f32> = ranks.into_iter().skip(1).step_by(2).collect();
        assert_eq!(coverage, [0.25, 0.125, 0.125, 0.0, 0.0, 0.0]);
    }
}
