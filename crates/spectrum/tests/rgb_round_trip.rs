//! RGB values uplifted to spectra and integrated with the standard observer are the same RGB
//! values.

use alhazen_spectrum::{Rgb, RgbColorSpace, SampledWavelengths, Spectrum, xyz_from};

/// The RGB values of a reflectance under the colour space's illuminant.
fn seen(space: &RgbColorSpace, reflectance: &Spectrum) -> Rgb {
    let light = space.illuminant();
    let pairs: Vec<(f32, f32)> = (360..=830)
        .map(|lambda| lambda as f32)
        .map(|lambda| (lambda, light.at(lambda) * reflectance.at(lambda)))
        .collect();
    space.to_rgb(Spectrum::from_pairs(&pairs).expect("wavelengths increase").to_xyz())
}

fn largest_difference(a: Rgb, b: Rgb) -> f32 {
    (a - b).map(f32::abs).max_component()
}

/// A grid of `steps`³ values within (0, 1).
fn grid(steps: u32) -> impl Iterator<Item = Rgb> {
    (0..steps.pow(3)).map(move |i| {
        let component = |k: u32| ((i / steps.pow(k) % steps) as f32 + 0.41) / steps as f32;
        Rgb::new(component(0), component(1), component(2))
    })
}

#[test]
fn srgb_round_trips() {
    let space = RgbColorSpace::srgb();
    for rgb in grid(9).chain(grid(9).map(|rgb| rgb * rgb * rgb)) {
        let again = seen(space, &Spectrum::rgb_albedo(space, rgb));
        let error = largest_difference(again, rgb);
        assert!(error < 1e-3 + 3e-3 * rgb.max_component(), "{rgb:?} became {again:?}");
    }
}

#[test]
fn moderate_colours_of_every_space_round_trip() {
    for space in RgbColorSpace::all() {
        for rgb in grid(6) {
            // Half way to grey: such colours have a reflectance in every space.
            let rgb = rgb.lerp(Rgb::splat(rgb.average()), 0.6) * 0.9;
            let again = seen(space, &Spectrum::rgb_albedo(space, rgb));
            assert!(largest_difference(again, rgb) < 2e-3, "{space:?}: {rgb:?} became {again:?}");
        }
    }
}

#[test]
fn saturated_colours_of_wide_spaces_round_trip() {
    for (space, rgb) in [
        (RgbColorSpace::dci_p3(), Rgb::new(0.5, 0.05, 0.025)),
        (RgbColorSpace::dci_p3(), Rgb::new(0.06, 0.5, 0.12)),
        (RgbColorSpace::dci_p3(), Rgb::new(0.01, 0.01, 0.9)),
        (RgbColorSpace::rec2020(), Rgb::new(0.08, 0.7, 0.12)),
        (RgbColorSpace::rec2020(), Rgb::new(0.5, 0.075, 0.075)),
        (RgbColorSpace::rec2020(), Rgb::new(0.035, 0.035, 0.5)),
    ] {
        let again = seen(space, &Spectrum::rgb_albedo(space, rgb));
        assert!(largest_difference(again, rgb) < 2e-3, "{space:?}: {rgb:?} became {again:?}");
    }
}

#[test]
fn black_white_and_grey_are_exact() {
    for space in RgbColorSpace::all() {
        for grey in [0.0, 1e-4, 0.18, 0.5, 1.0] {
            let again = seen(space, &Spectrum::rgb_albedo(space, Rgb::splat(grey)));
            assert!(largest_difference(again, Rgb::splat(grey)) < 1e-5, "{space:?} {grey}: {again:?}");
        }
    }
}

#[test]
fn dark_colours_keep_their_hue() {
    let space = RgbColorSpace::srgb();
    for (scale, tolerance) in [(1e-1, 2e-3), (1e-2, 5e-3), (1e-3, 2e-2), (1e-4, 2e-2), (1e-6, 0.7)] {
        for rgb in [Rgb::new(1.0, 0.3, 0.2), Rgb::new(0.1, 0.5, 1.0), Rgb::new(0.2, 1.0, 0.1)] {
            let again = seen(space, &Spectrum::rgb_albedo(space, rgb * scale)) / scale;
            assert!(largest_difference(again, rgb) < tolerance, "{scale}: {rgb:?} became {again:?}");
        }
    }
}

#[test]
fn values_above_one_round_trip() {
    for space in RgbColorSpace::all() {
        let rgb = Rgb::new(17.0, 12.0, 4.0);
        let light = space.to_rgb(Spectrum::rgb_illuminant(space, rgb).to_xyz());
        assert!(largest_difference(light, rgb) < 4e-2, "{space:?}: {light:?}");
        let unbounded = seen(space, &Spectrum::rgb_unbounded(space, rgb));
        assert!(largest_difference(unbounded, rgb) < 4e-2, "{space:?}: {unbounded:?}");
        assert_eq!(Spectrum::rgb_illuminant(space, Rgb::ZERO).to_xyz().y, 0.0);
    }
}

#[test]
fn sampled_wavelengths_preserve_colour() {
    const STEPS: u32 = 4096;
    let space = RgbColorSpace::srgb();
    let rgb = Rgb::new(0.8, 0.5, 0.2);
    let light = Spectrum::rgb_illuminant(space, rgb);
    let mean = (0..STEPS)
        .map(|i| SampledWavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32))
        .map(|lambda| space.to_rgb(xyz_from(&light.sample(&lambda), &lambda)))
        .fold(Rgb::ZERO, |sum, rgb| sum + rgb)
        / STEPS as f32;
    assert!(largest_difference(mean, rgb) < 2e-3, "{mean:?}");
}

#[test]
fn reflectances_stay_within_zero_and_one() {
    for space in RgbColorSpace::all() {
        for rgb in grid(5).map(|rgb| rgb * 1.5 - Rgb::splat(0.2)) {
            let spectrum = Spectrum::rgb_albedo(space, rgb);
            let largest = (360..=830).map(|lambda| spectrum.at(lambda as f32)).fold(0.0, f32::max);
            assert!(
                (0.0..=1.0).contains(&largest) && spectrum.max_value() >= largest - 1e-4,
                "{space:?} {rgb:?}"
            );
        }
    }
}
