//! The paths of a pixel over the picture.

use std::sync::Arc;
use std::time::Duration;

use alhazen::integrators::Control;
use alhazen_view::Renderer;
use alhazen_view::lines::{Projector, vertices};

use crate::world;

const TARGET: Duration = Duration::from_millis(33);

#[test]
fn paths_begin_at_their_pixel_and_add_up() {
    let world = Arc::new(world(16));
    let mut renderer = Renderer::new(Arc::clone(&world), TARGET);
    let pixel = [50, 60];
    let trace = renderer.trace(pixel, 16, &Control::default()).unwrap();
    let frame = renderer.step(&Control::default()).unwrap().unwrap();
    assert!(frame.n > 1);
    let projector = Projector::new(world.scene(), &frame);
    let mut brought = 0;
    for sample in &trace.samples {
        let vertices = vertices(sample);
        assert!(vertices.len() > 1 && vertices[0].p.is_none());
        assert!(vertices.iter().enumerate().all(|(i, vertex)| vertex.number == i));
        // The filter reaches over the pixel's border.
        let first = projector.film(vertices[1].p.unwrap()).unwrap();
        assert!((0..2).all(|axis| (first[axis] - pixel[axis] as f32 - 0.5).abs() < 2.5), "{first:?}");
        for c in 0..3 {
            let sum: f32 = vertices.iter().map(|vertex| vertex.rgb[c]).sum();
            assert!((sum - sample.rgb[c]).abs() < 1e-3 * (1.0 + sum.abs()), "{sum} {:?}", sample.rgb);
        }
        brought += usize::from(vertices.iter().any(|vertex| vertex.rgb != [0.0; 3]));
    }
    assert!(brought > 0);
    assert!(projector.lines(&trace).len() > 64);
    // What is behind the camera is not seen.
    let flight = world.flight();
    let behind = flight.position() - flight.forward();
    assert_eq!(projector.film(behind.as_vec3().into()), None);
}

#[test]
fn the_middle_of_the_picture_is_what_the_camera_looks_at() {
    let world = Arc::new(world(1));
    let frame = Renderer::new(Arc::clone(&world), TARGET).step(&Control::default()).unwrap().unwrap();
    let focus = world.flight().focus();
    let film = Projector::new(world.scene(), &frame).film(focus.as_vec3().into()).unwrap();
    assert!((film[0] - 48.0).abs() < 0.01 && (film[1] - 36.0).abs() < 0.01, "{film:?}");
    let seen = world.seen_at(&frame.view, film.map(|x| x / frame.n as f32)).unwrap();
    assert!(seen.distance(focus) < 1e-3 * focus.length().max(1.0));
}
