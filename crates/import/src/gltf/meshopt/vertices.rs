//! Packed vertices: blocks of vertices, whose bytes are stored plane by plane as differences to
//! those of the vertex before, in groups of sixteen of 0, 2, 4 or 8 bits.

use super::Stream;

/// Vertices of a group.
const GROUP: usize = 16;
/// Most vertices, and most bytes, of a block.
const MOST: [usize; 2] = [256, 8192];

/// Unpacks `count` vertices of `stride` bytes.
pub(super) fn decode(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let mut stream = Stream::new(bytes, 0xa0)?;
    // The first vertex's differences are to one that is stored at the end.
    let tail = stride.max(32);
    if stream.0.len() < tail {
        return Err("the packed data end too early".into());
    }
    let mut last = bytes[bytes.len() - stride..].to_vec();
    stream.0 = &stream.0[..stream.0.len() - tail];
    let per_block = MOST[0].min(MOST[1] / stride / GROUP * GROUP);
    // Groups of zeros take two bits for sixteen vertices.
    if count.div_ceil(GROUP) * stride > bytes.len() * 4 + 4 * MOST[0] * stride {
        return Err("there are too few packed data for so many vertices".into());
    }
    let mut vertices = vec![0; count * stride];
    let mut plane = [0; MOST[0]];
    for block in vertices.chunks_mut(per_block * stride) {
        let in_block = block.len() / stride;
        for (k, last) in last.iter_mut().enumerate() {
            differences(&mut stream, &mut plane[..in_block.next_multiple_of(GROUP)])?;
            for (vertex, &code) in block.chunks_exact_mut(stride).zip(&plane) {
                let difference = (code >> 1) ^ (code & 1).wrapping_neg();
                *last = last.wrapping_add(difference);
                vertex[k] = *last;
            }
        }
    }
    Ok(vertices)
}

/// Unpacks the differences of one byte of the vertices of a block.
fn differences(stream: &mut Stream, plane: &mut [u8]) -> Result<(), String> {
    let widths = stream.take((plane.len() / GROUP).div_ceil(4))?;
    for (index, group) in plane.chunks_exact_mut(GROUP).enumerate() {
        match widths[index / 4] >> (index % 4 * 2) & 3 {
            0 => group.fill(0),
            1 => narrow(stream, group, 2)?,
            2 => narrow(stream, group, 4)?,
            _ => group.copy_from_slice(stream.take(GROUP)?),
        }
    }
    Ok(())
}

/// Unpacks differences of a few bits; those of all ones stand for a byte that follows.
fn narrow(stream: &mut Stream, group: &mut [u8], bits: usize) -> Result<(), String> {
    let packed = stream.take(GROUP * bits / 8)?;
    let escape = (1_u8 << bits) - 1;
    for (index, value) in group.iter_mut().enumerate() {
        let at = index * bits;
        *value = packed[at / 8] >> (8 - bits - at % 8) & escape;
        if *value == escape {
            *value = stream.byte()?;
        }
    }
    Ok(())
}
