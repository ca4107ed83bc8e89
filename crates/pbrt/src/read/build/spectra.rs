//! Spectra as parameters: colours, black bodies, names, files, and pairs of wavelength and value.

use description::SpectrumDesc;

use super::reader::Reader;
use crate::read::parameter::{ParameterType, Values};

impl Reader<'_, '_> {
    /// A spectrum given by a parameter of one of the types.
    pub(super) fn spectrum_of(
        &mut self,
        name: &'static str,
        types: &'static [ParameterType],
    ) -> Option<SpectrumDesc> {
        let index = self.find(name, types)?;
        self.spectrum_at(index, name)
    }

    /// The spectrum of the parameter of an index.
    pub(super) fn spectrum_at(&mut self, index: usize, name: &'static str) -> Option<SpectrumDesc> {
        let color_space = self.given[index].parameter.color_space;
        let (kind, values, span) = self.take_at(index, name)?;
        match (kind, values) {
            (ParameterType::Rgb, Values::Floats(values)) => match values[..] {
                [r, g, b] => Some(SpectrumDesc::Rgb { rgb: [r, g, b], space: color_space }),
                _ => {
                    self.count(name, 3, values.len(), span);
                    None
                }
            },
            (ParameterType::Float, Values::Floats(values)) if values.len() == 1 => {
                Some(SpectrumDesc::Constant(values[0]))
            }
            (ParameterType::Blackbody, Values::Floats(values)) if values.len() == 2 => {
                let message =
                    format!("`{name}` takes one temperature; its brightness is now the light's `scale`");
                self.refuse(name, message);
                None
            }
            (ParameterType::Blackbody, Values::Floats(values)) if values.len() == 1 => {
                if values[0] > 0.0 {
                    return Some(SpectrumDesc::Blackbody(values[0]));
                }
                self.refuse(name, "the temperature of a black body must be above zero");
                None
            }
            (ParameterType::Spectrum, Values::Floats(values)) => self.samples(name, &values),
            (ParameterType::Spectrum, Values::Strings(values)) if values.len() == 1 => {
                self.builder.named_spectrum(&values[0])
            }
            (_, values) => {
                self.count(name, 1, values.len(), span);
                None
            }
        }
    }

    fn samples(&mut self, name: &'static str, values: &[f32]) -> Option<SpectrumDesc> {
        let (pairs, rest) = values.as_chunks::<2>();
        if pairs.is_empty() || !rest.is_empty() {
            self.refuse(name, format!("`{name}` takes pairs of wavelength and value"));
            return None;
        }
        if pairs.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
            self.refuse(name, format!("the wavelengths of `{name}` must increase"));
            return None;
        }
        // How a constant is written, over all visible wavelengths.
        if let &[[360.0, first], [830.0, last]] = pairs
            && first == last
        {
            return Some(SpectrumDesc::Constant(first));
        }
        Some(SpectrumDesc::Samples(pairs.iter().map(|&[lambda, value]| (lambda, value)).collect()))
    }
}
