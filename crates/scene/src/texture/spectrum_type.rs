//! Types of spectra, and spectra compiled from their descriptions.

use description::{ColorSpaceDesc, Diagnostic, Span, SpectrumDesc};
use lanes::Real;
use spectrum::{
    Rgb, RgbAlbedoSpectrum, RgbColorSpace, RgbUnboundedSpectrum, SampledSpectrum, SampledWavelengths,
    Spectrum,
};

/// The meaning of a spectrum. An RGB value becomes a different spectrum for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpectrumType {
    /// A share of light, within [0, 1]: reflectance, transmittance.
    Albedo,
    /// Any other quantity that is not light, such as a coefficient of absorption.
    Unbounded,
    /// Light: (1, 1, 1) is the white of the colour space.
    Illuminant,
}

impl SpectrumType {
    /// All types.
    pub const ALL: [Self; 3] = [Self::Albedo, Self::Unbounded, Self::Illuminant];

    /// The spectrum of an RGB value.
    pub fn from_rgb(self, space: &RgbColorSpace, rgb: Rgb) -> Spectrum {
        match self {
            Self::Albedo => Spectrum::rgb_albedo(space, rgb),
            Self::Unbounded => Spectrum::rgb_unbounded(space, rgb),
            Self::Illuminant => Spectrum::rgb_illuminant(space, rgb),
        }
    }

    /// The spectrum of an RGB value for each lane, at sampled wavelengths.
    #[inline(always)]
    pub fn sample_rgb<R: Real>(
        self,
        space: &RgbColorSpace,
        rgb: [R; 3],
        lambda: &SampledWavelengths<R>,
    ) -> SampledSpectrum<R> {
        let mut values = *lambda.lambda();
        if let Self::Albedo = self {
            let spectrum = RgbAlbedoSpectrum::new(space, rgb);
            for value in &mut values {
                *value = spectrum.at(*value);
            }
            return SampledSpectrum(values);
        }
        let spectrum = RgbUnboundedSpectrum::new(space, rgb);
        for value in &mut values {
            let illuminant = if let Self::Illuminant = self { space.illuminant_at(*value) } else { R::one() };
            *value = spectrum.at(*value) * illuminant;
        }
        SampledSpectrum(values)
    }
}

/// The colour space of a description.
pub fn color_space(desc: ColorSpaceDesc) -> &'static RgbColorSpace {
    match desc {
        ColorSpaceDesc::Srgb => RgbColorSpace::srgb(),
        ColorSpaceDesc::DciP3 => RgbColorSpace::dci_p3(),
        ColorSpaceDesc::Rec2020 => RgbColorSpace::rec2020(),
        ColorSpaceDesc::Aces2065_1 => RgbColorSpace::aces2065_1(),
    }
}

/// The largest value of a spectrum in a scene, so that products of several stay finite.
const LARGEST_VALUE: f32 = 1e30;

/// The spectrum described at `span`. Errors and colours out of range are added to `diagnostics`.
pub fn compile_spectrum(
    desc: &SpectrumDesc,
    spectrum_type: SpectrumType,
    span: Span,
    diagnostics: &mut Vec<Diagnostic>,
) -> Spectrum {
    let mut wrong = |message: String| {
        diagnostics.push(Diagnostic::error("invalid-value", message, span));
        Spectrum::ZERO
    };
    let spectrum = match desc {
        SpectrumDesc::Constant(value) if value.is_finite() => Spectrum::Constant(*value),
        SpectrumDesc::Constant(value) => wrong(format!("{value} is not a valid value for a spectrum")),
        SpectrumDesc::Rgb { rgb, space } => {
            let [r, g, b] = *rgb;
            let rgb = Rgb::from(*rgb);
            if !rgb.is_finite() {
                return wrong(format!("({r}, {g}, {b}) is not a valid colour"));
            }
            let largest = if spectrum_type == SpectrumType::Albedo { 1.0 } else { f32::INFINITY };
            if rgb.min_component() < 0.0 || rgb.max_component() > largest {
                let range = if largest == 1.0 { "between 0 and 1" } else { "at least 0" };
                let message = format!("the components of ({r}, {g}, {b}) should be {range}; clamped");
                diagnostics.push(Diagnostic::warning("color-out-of-range", message, span));
            }
            spectrum_type.from_rgb(color_space(*space), rgb)
        }
        SpectrumDesc::Named(name) => {
            spectrum::named(name).unwrap_or_else(|| wrong(format!("there is no spectrum named `{name}`")))
        }
        SpectrumDesc::Samples(pairs) => {
            Spectrum::from_pairs(pairs).unwrap_or_else(|error| wrong(error.to_string()))
        }
        SpectrumDesc::Blackbody(kelvin) if *kelvin > 0.0 && kelvin.is_finite() => {
            Spectrum::blackbody(*kelvin)
        }
        SpectrumDesc::Blackbody(kelvin) => wrong(format!("a temperature must be above 0 K, not {kelvin}")),
        SpectrumDesc::Illuminant(space) => color_space(*space).illuminant(),
    };
    let largest = spectrum.max_value();
    if largest.is_nan() || largest > LARGEST_VALUE {
        let message = format!("the values of a spectrum must be at most {LARGEST_VALUE:e}");
        diagnostics.push(Diagnostic::error("invalid-value", message, span));
    }
    spectrum
}
