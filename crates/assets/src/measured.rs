//! Measured BRDFs in the tensor files of the database of [Dupuy 2018].
//!
//! A file begins with `tensor_file`, a zero byte, the version 1.0 and the number of fields, of
//! which each has a name, a number of dimensions, a type, an offset into the file and the length
//! of each dimension; the last dimension varies fastest. Integers are little-endian. Of the fields,
//! all of 32-bit floats, these are read:
//!
//! | field | dimensions |
//! |---|---|
//! | `phi_i`, `theta_i` | one |
//! | `ndf`, `sigma` | azimuth, elevation |
//! | `vndf`, `luminance` | `phi_i`, `theta_i`, y, x |
//! | `spectra` and `wavelengths`, or `rgb` | `phi_i`, `theta_i`, channel, y, x |
//!
//! What the database calls the incident direction is that of the light that leaves here.
//! Anisotropic files have to cover all azimuths.

use std::f32::consts::TAU;

use scattering::{MeasuredData, MeasuredGrid, MeasuredTable};

const MAGIC: &[u8] = b"tensor_file\0\x01\x00";
/// The number by which the format calls 32-bit floats.
const FLOAT: u8 = 10;

/// Numbers of a file.
struct Tensor<'a> {
    shape: Vec<usize>,
    bytes: &'a [u8],
}

/// Reads a file; on failure, the reason.
pub fn read_measured(bytes: &[u8]) -> Result<MeasuredTable, String> {
    let file = File(bytes);
    let directions = [file.vector("phi_i")?, file.vector("theta_i")?];
    let wavelengths = file.field("spectra")?.map(|_| file.vector("wavelengths")).transpose()?;
    let [phi, theta] = directions;
    if phi.len() > 2 && ((phi[phi.len() - 1] - phi[0]) - TAU).abs() > 0.1 {
        return Err("it covers only a part of the azimuths of an anisotropic material".into());
    }
    let lengths = [phi.len(), theta.len()];
    let channels = wavelengths.as_ref().map_or(3, Vec::len);
    let values = if wavelengths.is_some() { "spectra" } else { "rgb" };
    MeasuredTable::new(MeasuredData {
        ndf: file.grid("ndf", &[])?,
        sigma: file.grid("sigma", &[])?,
        vndf: file.grid("vndf", &lengths)?,
        luminance: file.grid("luminance", &lengths)?,
        values: file.grid(values, &[lengths[0], lengths[1], channels])?,
        phi,
        theta,
        wavelengths,
    })
}

/// The bytes of a file.
struct File<'a>(&'a [u8]);

impl<'a> File<'a> {
    /// The field of a name; `None` if there is none.
    fn field(&self, name: &str) -> Result<Option<Tensor<'a>>, String> {
        let mut rest = self.0.strip_prefix(MAGIC).ok_or("it is not a tensor file of version 1.0")?;
        let cut_off = || "it ends within its list of fields".to_owned();
        let mut take = |length: usize| -> Result<&'a [u8], String> {
            let (taken, left) = rest.split_at_checked(length).ok_or_else(cut_off)?;
            rest = left;
            Ok(taken)
        };
        let fields = integer(take(4)?);
        for _ in 0..fields {
            let length = integer(take(2)?) as usize;
            let is_wanted = take(length)? == name.as_bytes();
            let dimensions = integer(take(2)?) as usize;
            let kind = take(1)?[0];
            let offset = integer(take(8)?);
            let shape = take(8 * dimensions)?.chunks_exact(8).map(integer);
            if !is_wanted {
                continue;
            }
            if kind != FLOAT {
                return Err(format!("its field `{name}` does not have 32-bit floats"));
            }
            let shape: Vec<u64> = shape.collect();
            let length = shape.iter().try_fold(4_u64, |product, &length| product.checked_mul(length));
            let bytes = length.and_then(|length| {
                let (start, length) = (usize::try_from(offset).ok()?, usize::try_from(length).ok()?);
                self.0.get(start..)?.get(..length)
            });
            let bytes = bytes.ok_or_else(|| format!("it ends within its field `{name}`"))?;
            // None is longer than the file, unless there are no numbers.
            let shape = shape.into_iter().map(|length| usize::try_from(length).unwrap_or(usize::MAX));
            return Ok(Some(Tensor { shape: shape.collect(), bytes }));
        }
        Ok(None)
    }

    fn required(&self, name: &str) -> Result<Tensor<'a>, String> {
        self.field(name)?.ok_or_else(|| format!("it has no field `{name}`"))
    }

    fn vector(&self, name: &str) -> Result<Vec<f32>, String> {
        let tensor = self.required(name)?;
        if tensor.shape.len() != 1 {
            return Err(format!("its field `{name}` has {} dimensions, not one", tensor.shape.len()));
        }
        Ok(tensor.numbers())
    }

    /// A field of layers of the given numbers.
    fn grid(&self, name: &str, layers: &[usize]) -> Result<MeasuredGrid, String> {
        let tensor = self.required(name)?;
        let Some((found, &[height, width])) = tensor.shape.split_last_chunk::<2>() else {
            return Err(format!("its field `{name}` has less than two dimensions"));
        };
        if found != layers {
            return Err(format!("its field `{name}` has layers {found:?}, not {layers:?}"));
        }
        Ok(MeasuredGrid { size: [width, height], values: tensor.numbers() })
    }
}

impl Tensor<'_> {
    fn numbers(&self) -> Vec<f32> {
        let (numbers, _) = self.bytes.as_chunks::<4>();
        numbers.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect()
    }
}

/// An integer of up to eight bytes.
fn integer(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
}
