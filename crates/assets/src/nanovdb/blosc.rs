//! Buffers packed by Blosc ([Blosc 2010]), as far as NanoVDB uses it: blocks packed by LZ4, their
//! bytes shuffled or not.

use super::bytes::Bytes;

const HEADER: usize = 16;

/// Appends the `length` bytes of a buffer.
pub(super) fn unpack(packed: Bytes, length: usize, unpacked: &mut Vec<u8>) -> Result<(), String> {
    let [_, _, flags, size] = packed.array(0)?;
    let [total, block] = [packed.u32(4)? as usize, packed.u32(8)? as usize];
    if total != length || block == 0 {
        return Err(format!("it is damaged: {total} bytes of Blosc stand for {length}"));
    }
    const SHUFFLED: u8 = 1;
    const COPIED: u8 = 2;
    const BITS_SHUFFLED: u8 = 4;
    const WHOLE: u8 = 16;
    if flags & COPIED != 0 {
        unpacked.extend_from_slice(packed.part(HEADER, length as u64)?);
        return Ok(());
    }
    if flags & BITS_SHUFFLED != 0 || flags >> 5 != 1 {
        return Err("it is packed by Blosc in a way that is not supported; \
                    `nanovdb_convert --zip` packs it by another codec"
            .into());
    }
    let size = usize::from(size.max(1));
    let mut shuffled = Vec::new();
    for (index, start) in (0..length).step_by(block).enumerate() {
        let bytes = block.min(length - start);
        // Whole blocks have a stream for each byte of a number, if these are long enough.
        let is_split = flags & WHOLE == 0 && bytes == block && size <= 16 && block / size >= 128;
        let stream_length = if is_split && block % size == 0 { block / size } else { bytes };
        let mut at = packed.u32(HEADER + 4 * index)? as usize;
        shuffled.resize(bytes, 0);
        for stream in shuffled.chunks_exact_mut(stream_length) {
            let source = packed.part(at + 4, packed.u32(at)?.into())?;
            at += 4 + source.len();
            if source.len() == stream.len() {
                stream.copy_from_slice(source);
            } else if lz4_flex::block::decompress_into(source, stream).ok() != Some(stream.len()) {
                return Err("it is damaged: a block of Blosc cannot be unpacked".into());
            }
        }
        if flags & SHUFFLED != 0 && size > 1 {
            append_in_order(&shuffled, size, unpacked);
        } else {
            unpacked.extend_from_slice(&shuffled);
        }
    }
    Ok(())
}

/// Appends numbers of `size` bytes that are stored as their first bytes, their second bytes and so
/// on, and what is left when their bytes are divided by `size`.
fn append_in_order(shuffled: &[u8], size: usize, numbers: &mut Vec<u8>) {
    let count = shuffled.len() / size;
    for i in 0..count {
        numbers.extend((0..size).map(|byte| shuffled[byte * count + i]));
    }
    numbers.extend_from_slice(&shuffled[size * count..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The buffer of [`numbers`] as c-blosc 1.21 packs it: a whole block of four streams, of which
    /// the second is not packed, and the rest.
    const PACKED: &str = "020121044302000040020000e400000018000000dd0000000f0000005f00010203040500735004\
        000102039000000000010409101924314051647990a9c4e10526496e95bee91b4a7baee31f5893d0145598dd2972bd0f5e\
        af075cb3116cc92d8ef15bc2309b0d7ced65da56cf4fcc50d159de6af38315a43acd67039c3cd97d23c6701cc57527d68c\
        44f9b57333f0b47a420cd3a1714317e8c09a76543416f5dbc3ad998777695d534b45413f3f41454b535d69778799adc3db\
        f5163454760b0000001f000100775000000000000b0000001f000100775000000000000300000078797a";

    fn packed() -> Vec<u8> {
        let digits = PACKED.as_bytes().as_chunks::<2>().0;
        digits.iter().map(|pair| u8::from_str_radix(str::from_utf8(pair).unwrap(), 16).unwrap()).collect()
    }

    fn numbers() -> Vec<u8> {
        let numbers = (0..144_u32).flat_map(|i| (i % 5 + 256 * (i * i % 251)).to_le_bytes());
        numbers.chain(*b"xyz").collect()
    }

    fn unpacked(packed: &[u8]) -> Result<Vec<u8>, String> {
        let mut unpacked = Vec::new();
        unpack(Bytes(packed), 579, &mut unpacked).map(|()| unpacked)
    }

    #[test]
    fn a_buffer_of_the_library_is_unpacked() {
        assert_eq!(unpacked(&packed()).unwrap(), numbers());
    }

    #[test]
    fn copied_buffers_are_unpacked() {
        let mut copied = packed()[..16].to_vec();
        copied[2] |= 2;
        copied.extend(numbers());
        assert_eq!(unpacked(&copied).unwrap(), numbers());
    }

    #[test]
    fn damaged_buffers_are_errors() {
        let good = packed();
        for length in 0..good.len() {
            assert!(unpacked(&good[..length]).is_err(), "{length}");
        }
        for (at, byte, message) in [
            (2, 0x25, "in a way that is not supported"),
            (2, 0x81, "in a way that is not supported"),
            (4, 0x44, "stand for 579"),
            (8, 0, "cannot be unpacked"),
            (16, 0xff, "cut off or damaged"),
            (28, 0xff, "cannot be unpacked"),
        ] {
            let mut bad = good.clone();
            bad[at] = byte;
            let error = unpacked(&bad).unwrap_err();
            assert!(error.contains(message), "{at}: {error}");
        }
        let mut endless = good;
        endless[8..12].fill(0);
        assert!(unpacked(&endless).is_err());
    }
}
