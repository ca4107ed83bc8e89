//! Measured materials as tensor files of the database of [Dupuy 2018].
//!
//! The fields are those that pbrt-v4 needs; all but two are of 32-bit floats. The layout is that of
//! the importer's reader: a list of fields with their types, places and lengths, and the data.

use scattering::{MeasuredData, MeasuredGrid};

const MAGIC: &[u8] = b"tensor_file\0\x01\x00";
/// The numbers by which the format calls types.
const BYTE: u8 = 1;
const FLOAT: u8 = 10;
/// Data begin at multiples of this.
const ALIGNMENT: usize = 8;

/// A field: its name, its type, the length of each dimension, and its bytes.
struct Field(&'static str, u8, Vec<usize>, Vec<u8>);

impl Field {
    fn floats(name: &'static str, shape: Vec<usize>, values: &[f32]) -> Self {
        Self(name, FLOAT, shape, values.iter().flat_map(|value| value.to_le_bytes()).collect())
    }

    fn grid(name: &'static str, layers: &[usize], grid: &MeasuredGrid) -> Self {
        let [width, height] = grid.size;
        Self::floats(name, [layers, &[height, width]].concat(), &grid.values)
    }
}

/// A file of measurements.
pub(super) fn bytes(data: &MeasuredData) -> Vec<u8> {
    let MeasuredData { phi, theta, wavelengths, ndf, sigma, vndf, luminance, values } = data;
    let directions = [phi.len(), theta.len()];
    let description = b"written by alhazen".to_vec();
    let mut fields = vec![
        Field("description", BYTE, vec![description.len()], description),
        Field::floats("phi_i", vec![phi.len()], phi),
        Field::floats("theta_i", vec![theta.len()], theta),
        Field::grid("sigma", &[], sigma),
        Field::grid("ndf", &[], ndf),
        Field::grid("vndf", &directions, vndf),
        Field::grid("luminance", &directions, luminance),
        // Values have the factor that samples by visible normals need.
        Field("jacobian", BYTE, vec![1], vec![1]),
    ];
    let channels = wavelengths.as_ref().map_or(3, Vec::len);
    let layers = [directions[0], directions[1], channels];
    match wavelengths {
        Some(wavelengths) => {
            fields.push(Field::floats("wavelengths", vec![channels], wavelengths));
            fields.push(Field::grid("spectra", &layers, values));
        }
        None => fields.push(Field::grid("rgb", &layers, values)),
    }

    let entry = |Field(name, _, shape, _): &Field| 2 + name.len() + 2 + 1 + 8 + 8 * shape.len();
    let head = MAGIC.len() + 4 + fields.iter().map(entry).sum::<usize>();
    let mut at = head.next_multiple_of(ALIGNMENT);
    let mut bytes = MAGIC.to_vec();
    bytes.extend((fields.len() as u32).to_le_bytes());
    for Field(name, kind, shape, data) in &fields {
        bytes.extend((name.len() as u16).to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes.extend((shape.len() as u16).to_le_bytes());
        bytes.push(*kind);
        bytes.extend((at as u64).to_le_bytes());
        bytes.extend(shape.iter().flat_map(|&length| (length as u64).to_le_bytes()));
        at += data.len().next_multiple_of(ALIGNMENT);
    }
    for Field(.., data) in &fields {
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        bytes.extend(data);
    }
    bytes
}
