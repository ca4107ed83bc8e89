//! Photons on meshes.

use std::path::Path;

use alhazen::Overrides;

use crate::common::render_scene;

/// A search for photons finds those of neighbouring faces, too. Where they graze the face that the
/// camera sees they are not rare, so none of them may count much more than others: the brightest
/// pixel had a value of 4988 once, and nearly all of the light.
#[test]
fn photons_of_neighbouring_faces_count_as_others() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/subsurface.pbrt");
    let settings = [("radius", "1"), ("photons", "40000")];
    let overrides = Overrides {
        integrator: Some("sppm".into()),
        settings: settings.map(|(name, value)| (name.into(), value.into())).to_vec(),
        samples_per_pixel: Some(48),
        resolution: Some([48, 26]),
        ..Overrides::default()
    };
    let picture = render_scene(&scene, &overrides);
    let brightest = picture.values().fold(0.0, f32::max);
    // What is seen has values of 1 and less, lights aside.
    assert!(brightest < 4.0, "{brightest}");
}
