//! Numbers within a file.

/// Bytes, and the little-endian numbers in them. It is an error to read beyond their end.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    pub(super) fn len(self) -> usize {
        self.0.len()
    }

    /// A number of bytes from a place on.
    pub(super) fn part(self, at: usize, length: u64) -> Result<&'a [u8], String> {
        let rest = self.0.get(at..).unwrap_or(&[]);
        usize::try_from(length).ok().and_then(|length| rest.get(..length)).ok_or_else(|| {
            let total = self.len();
            format!("it is cut off or damaged: there are no {length} bytes from byte {at} of {total} on")
        })
    }

    pub(super) fn array<const N: usize>(self, at: usize) -> Result<[u8; N], String> {
        let part = self.part(at, N as u64)?;
        Ok(std::array::from_fn(|i| part[i]))
    }

    pub(super) fn u16(self, at: usize) -> Result<u16, String> {
        self.array(at).map(u16::from_le_bytes)
    }

    pub(super) fn u32(self, at: usize) -> Result<u32, String> {
        self.array(at).map(u32::from_le_bytes)
    }

    pub(super) fn u64(self, at: usize) -> Result<u64, String> {
        self.array(at).map(u64::from_le_bytes)
    }

    pub(super) fn f32(self, at: usize) -> Result<f32, String> {
        self.array(at).map(f32::from_le_bytes)
    }

    pub(super) fn f64(self, at: usize) -> Result<f64, String> {
        self.array(at).map(f64::from_le_bytes)
    }

    /// The place that a node at `from` refers to by the signed distance at `at`.
    pub(super) fn target(self, from: usize, at: usize) -> Result<usize, String> {
        let distance = self.u64(at)?.cast_signed();
        let target = i64::try_from(from).ok().and_then(|from| from.checked_add(distance));
        target
            .and_then(|target| usize::try_from(target).ok())
            .ok_or_else(|| format!("it is damaged: a node at byte {from} refers to one {distance} bytes on"))
    }
}

/// A text up to a zero.
pub(super) fn text(bytes: &[u8]) -> String {
    let text = bytes.split(|&byte| byte == 0).next().unwrap_or(&[]);
    String::from_utf8_lossy(text).into_owned()
}
