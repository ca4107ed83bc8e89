//! Display views: from the linear colours of a scene, which have no upper limit, to what a display
//! shows.
//!
//! A view is a pure function of one colour. It takes linear colour in its own space
//! ([`DisplayInput`]), on which exposure and white balance have acted before, and gives linear sRGB
//! in [0, 1]; the codes of a file are that in the encoding of sRGB. [`standard`] is the identity.
//! The others compress bright and saturated light, so that it does not end in flat patches of
//! clipped colour.

pub mod aces;
pub mod agx;
pub mod filmic;
pub mod khronos_neutral;
pub mod standard;

use spectrum::{Matrix3, RgbColorSpace, daylight, white_balance};

/// A display view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DisplayView {
    /// The colours as they are, clipped.
    #[default]
    Standard,
    /// The base look of AgX.
    Agx,
    /// The output transform of ACES 2.0 for Rec. 709 at 100 nits.
    Aces,
    /// The tone mapper "PBR Neutral" of Khronos.
    KhronosNeutral,
    /// A film-like curve for each of red, green and blue.
    Filmic,
}

/// The space that a view takes colours in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayInput {
    /// sRGB's primaries, without adaptation to its white.
    Srgb,
    /// The primaries of ACES "AP1", adapted to its white.
    AcesAp1,
}

impl DisplayView {
    /// Every view.
    pub const ALL: [Self; 5] = [Self::Standard, Self::Agx, Self::Aces, Self::KhronosNeutral, Self::Filmic];

    /// Its name, as the command line and the headers of files have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Agx => "agx",
            Self::Aces => "aces",
            Self::KhronosNeutral => "khronos-neutral",
            Self::Filmic => "filmic",
        }
    }

    /// The view of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.name() == name)
    }

    /// The space of the colours that it takes.
    fn input(self) -> DisplayInput {
        match self {
            Self::Aces => DisplayInput::AcesAp1,
            Self::Standard | Self::Agx | Self::KhronosNeutral | Self::Filmic => DisplayInput::Srgb,
        }
    }

    /// Linear sRGB in [0, 1] for a linear colour in its input space, not a number for none.
    fn show(self, color: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Standard => standard::show(color),
            Self::Agx => agx::show(color),
            Self::Aces => aces::show(color),
            Self::KhronosNeutral => khronos_neutral::show(color),
            Self::Filmic => filmic::show(color),
        }
    }
}

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DisplaySettings {
    /// The view.
    pub view: DisplayView,
    /// Exposure in stops: each doubles the light.
    pub exposure: f32,
    /// The light that becomes white; `None` leaves colours as they are.
    pub white: Option<DisplayWhite>,
}

/// A light that becomes white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DisplayWhite {
    /// Daylight of this colour temperature in kelvin, below 4000 K a blackbody.
    Kelvin(f32),
    /// Light of this CIE xy chromaticity.
    Chromaticity([f32; 2]),
}

impl DisplayWhite {
    /// Its chromaticity.
    fn xy(self) -> [f32; 2] {
        match self {
            Self::Kelvin(kelvin) => daylight(kelvin).to_xyz().xy(),
            Self::Chromaticity(xy) => xy,
        }
    }
}

/// What shows the colours of pictures in one colour space.
#[derive(Clone, Debug)]
pub struct Display {
    view: DisplayView,
    /// From the picture's colours to those that the view takes, exposure and white balance
    /// included.
    input_from_picture: Matrix3,
}

impl Display {
    /// For pictures in this colour space.
    pub fn new(settings: &DisplaySettings, space: &RgbColorSpace) -> Self {
        let scale = libm::pow(2.0_f64, settings.exposure.into());
        let exposed = Matrix3::diagonal([scale; 3]);
        let balanced = settings.white.map_or(exposed, |white| {
            let balance = white_balance(white.xy(), space.white());
            exposed * space.rgb_from_xyz() * balance * space.xyz_from_rgb()
        });
        let input_from_picture = match settings.view.input() {
            DisplayInput::Srgb => space.convert(RgbColorSpace::srgb()) * balanced,
            DisplayInput::AcesAp1 => aces::ap1_from(space) * balanced,
        };
        Self { view: settings.view, input_from_picture }
    }

    /// Linear sRGB in [0, 1] for a linear colour of the picture; black for what is not finite.
    pub fn show(&self, rgb: [f32; 3]) -> [f32; 3] {
        let color = self.input_from_picture.apply(rgb.map(f64::from));
        if !color.iter().all(|c| c.is_finite()) {
            return [0.0; 3];
        }
        self.view.show(color).map(|c| c.clamp(0.0, 1.0) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::srgb_from_linear;

    fn display(view: DisplayView) -> Display {
        Display::new(&DisplaySettings { view, ..DisplaySettings::default() }, RgbColorSpace::srgb())
    }

    #[test]
    fn names_are_found() {
        for view in DisplayView::ALL {
            assert_eq!(DisplayView::from_name(view.name()), Some(view));
        }
        assert_eq!(DisplayView::from_name("sRGB"), None);
    }

    #[test]
    fn greys_stay_grey_and_brighten_with_exposure() {
        for view in DisplayView::ALL {
            let display = display(view);
            let mut before = -1.0;
            for step in -40..=40 {
                let grey = 0.18 * 2f32.powf(step as f32 / 4.0);
                let shown = display.show([grey; 3]);
                let [least, most] =
                    [shown.iter().copied().fold(1.0, f32::min), shown.iter().copied().fold(0.0, f32::max)];
                assert!(most - least < 2e-3 * most.max(1e-3), "{view:?} {grey}: {shown:?}");
                let is_clipped = before >= 0.999;
                assert!(
                    shown[1] > before || is_clipped && shown[1] >= before - 1e-4,
                    "{view:?} {grey}: {shown:?}"
                );
                before = shown[1];
            }
            assert!(before > 0.98, "{view:?}: {before}");
            assert_eq!(display.show([f32::NAN, 0.0, 1.0]), [0.0; 3]);
            assert!(display.show([0.0; 3]).iter().all(|c| *c < 0.003), "{view:?} is black at 0");
        }
    }

    #[test]
    fn no_hue_flips() {
        // Six hues, at all exposures: the order of red, green and blue stays, or colours meet.
        for view in DisplayView::ALL {
            let display = display(view);
            for color in [
                [0.8, 0.3, 0.1],
                [0.6, 0.8, 0.1],
                [0.1, 0.7, 0.3],
                [0.1, 0.5, 0.8],
                [0.3, 0.1, 0.9],
                [0.8, 0.2, 0.6],
            ] {
                for stop in -6..=8 {
                    let shown = display.show(color.map(|c: f32| c * 2f32.powi(stop)));
                    for i in 0..3 {
                        for j in 0..3 {
                            let ordered = shown[i] >= shown[j] - 0.03;
                            assert!(color[i] < color[j] || ordered, "{view:?} {color:?} {stop}: {shown:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn middle_grey_and_white_are_shown_as_published() {
        // Codes of sRGB for 18 % grey and for diffuse white, by the definition of each view.
        for (view, grey, white) in [
            (DisplayView::Standard, 0.4613, 1.0),
            // The sigmoid goes through one half at middle grey.
            (DisplayView::Agx, 0.5, 0.7875),
            // About 10 nits of 100, and what OpenColorIO 2.6 gives for 1.
            (DisplayView::Aces, 0.3492, 0.7067),
            // 4 % less, and 1 − 0.24² / (0.96 + 1 − 2 · 0.76).
            (DisplayView::KhronosNeutral, 0.4100, 0.9401),
            (DisplayView::Filmic, 0.3935, 0.7307),
        ] {
            let shown = [0.18, 1.0].map(|l| srgb_from_linear(display(view).show([l; 3])[1]));
            for (shown, known) in shown.into_iter().zip([grey, white]) {
                assert!((shown - known).abs() < 5e-4, "{view:?}: {shown} is not {known}");
            }
        }
    }

    #[test]
    fn exposure_counts_stops_and_white_balance_makes_its_light_white() {
        let space = RgbColorSpace::rec2020();
        let settings = DisplaySettings { exposure: -2.0, ..DisplaySettings::default() };
        let dark = Display::new(&settings, RgbColorSpace::srgb()).show([0.8, 0.4, 0.2]);
        assert!((0..3).all(|c| (dark[c] - [0.2, 0.1, 0.05][c]).abs() < 1e-6), "{dark:?}");
        for white in [DisplayWhite::Kelvin(4500.0), DisplayWhite::Chromaticity([0.4476, 0.4075])] {
            let xyz = spectrum::Xyz::from_xy(white.xy(), 0.5);
            let light = space.to_rgb(xyz).to_array();
            let settings = DisplaySettings { white: Some(white), ..DisplaySettings::default() };
            let shown = Display::new(&settings, space).show(light);
            assert!((0..3).all(|c| (shown[c] - 0.5).abs() < 3e-3), "{white:?}: {shown:?}");
        }
    }
}
