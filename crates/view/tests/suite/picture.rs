//! Pictures as codes of a display.

use std::sync::Arc;
use std::time::Duration;

use alhazen::film::Layer;
use alhazen::image::{ColorEncoding, Display, DisplaySettings, DisplayView};
use alhazen::integrators::Control;
use alhazen_view::{Frame, Renderer, Shot, develop, layers};

use crate::world;

fn frame(layer: Option<Layer>) -> Frame {
    let mut renderer = Renderer::new(Arc::new(world(1)), Duration::from_millis(33));
    renderer.aim(Shot { layer, ..renderer.shot().clone() });
    renderer.step(&Control::default()).unwrap().unwrap()
}

#[test]
fn colours_are_shown_by_their_view() {
    let frame = frame(None);
    let display = DisplaySettings { view: DisplayView::Agx, exposure: 1.0, white: None };
    let codes = develop(&frame, &display);
    let display = Display::new(&display, frame.color_space);
    for (codes, pixel) in codes.chunks_exact(4).zip(&frame.pixels) {
        let expected = display.show(*pixel).map(|light| ColorEncoding::Srgb.quantize(light));
        assert_eq!((&codes[..3], codes[3]), (&expected[..], 255));
    }
}

#[test]
fn every_layer_can_be_shown() {
    assert!(layers().count() > 15);
    for layer in layers() {
        let frame = frame(Some(layer));
        let codes = develop(&frame, &DisplaySettings::default());
        let distinct: std::collections::HashSet<_> = codes.chunks_exact(4).collect();
        // Without motion, volumes and transmission these are black, and all samples are in view.
        // The lamp is as bright everywhere.
        let is_empty = [Layer::Motion, Layer::Volume, Layer::Transmission, Layer::Specular].contains(&layer);
        let is_even = [Layer::Samples, Layer::Alpha, Layer::Variance, Layer::Emission].contains(&layer);
        assert!(is_empty || is_even || distinct.len() > 2, "{layer}: {}", distinct.len());
    }
    // The wall at the back is a grey between those of the floor's front and of what is farthest.
    let depth = frame(Some(Layer::Depth));
    assert!(depth.pixels.iter().all(|[r, g, b]| r == g && g == b));
}
