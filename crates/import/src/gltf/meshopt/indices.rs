//! Packed indices: of triangles, by edges and vertices that were met before, and sequences of any
//! indices.

use super::{Stream, signed};

/// The indices met last, the newest first by [`Recent::get`].
struct Recent<T> {
    items: [T; 16],
    next: usize,
}

impl<T: Copy + Default> Recent<T> {
    fn new() -> Self {
        Self { items: [T::default(); 16], next: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.next] = item;
        self.next = (self.next + 1) % 16;
    }

    fn get(&self, age: u8) -> T {
        self.items[(self.next + 15 - usize::from(age)) % 16]
    }
}

/// Unpacks `count` indices, three for each triangle.
pub(super) fn triangles(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let mut stream = Stream::new(bytes, 0xe1)?;
    let codes = stream.take(count / 3)?;
    let Some((data, pairs)) = stream.0.split_last_chunk::<16>() else {
        return Err("the packed data end too early".into());
    };
    let mut data = Stream(data);
    let (mut edges, mut vertices) = (Recent::new(), Recent::new());
    let (mut next, mut last) = (0_u32, 0_u32);
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            let (a, b) = edges.get(high);
            let c = match low {
                0 => take(&mut next),
                1..13 => vertices.get(low),
                15 => explicit(&mut data, &mut last)?,
                _ => {
                    last = if low == 13 { last.wrapping_sub(1) } else { last.wrapping_add(1) };
                    last
                }
            };
            if low == 0 || low >= 13 {
                vertices.push(c);
            }
            edges.push((c, b));
            edges.push((a, c));
            indices.extend([a, b, c]);
            continue;
        }
        let pair = if low < 14 { pairs[usize::from(low)] } else { data.byte()? };
        if low >= 14 && pair == 0 {
            next = 0;
        }
        let corners = [if low == 15 { 15 } else { 0 }, pair >> 4, pair & 15];
        let mut triangle = [0; 3];
        // New vertices are numbered before explicit ones are read.
        for (vertex, corner) in triangle.iter_mut().zip(corners) {
            *vertex = match corner {
                0 => take(&mut next),
                _ => vertices.get(corner.wrapping_sub(1) & 15),
            };
        }
        if low >= 14 {
            for (vertex, corner) in triangle.iter_mut().zip(corners) {
                if corner == 15 {
                    *vertex = explicit(&mut data, &mut last)?;
                }
            }
        }
        for (vertex, corner) in triangle.into_iter().zip(corners) {
            if corner == 0 || (corner == 15 && low >= 14) {
                vertices.push(vertex);
            }
        }
        let [a, b, c] = triangle;
        edges.push((b, a));
        edges.push((c, b));
        edges.push((a, c));
        indices.extend(triangle);
    }
    Ok(indices)
}

/// Unpacks a sequence of `count` indices, as differences to one of two before.
pub(super) fn sequence(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let mut stream = Stream::new(bytes, 0xd1)?;
    if count > stream.0.len() {
        return Err("the packed data end too early".into());
    }
    let mut last = [0_u32; 2];
    let index = |_| {
        let code = stream.varint()?;
        let last = &mut last[code as usize & 1];
        *last = last.wrapping_add(signed(code >> 1));
        Ok(*last)
    };
    (0..count).map(index).collect()
}

fn take(next: &mut u32) -> u32 {
    let taken = *next;
    *next = next.wrapping_add(1);
    taken
}

/// An index that is stored as a difference to the explicit one before.
fn explicit(data: &mut Stream, last: &mut u32) -> Result<u32, String> {
    *last = last.wrapping_add(signed(data.varint()?));
    Ok(*last)
}
