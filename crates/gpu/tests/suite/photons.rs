//! Stochastic progressive photon mapping by both engines, from the same random numbers.

use alhazen_gpu::Algorithm;
use description::SppmDesc;

use crate::pictures::Case;
use crate::texts::MEDLEY;

/// So small a radius that few pixels have a photon whose path rounding changes.
fn sppm(radius: f32) -> Algorithm {
    Algorithm::Sppm(SppmDesc { max_depth: 4, radius: Some(radius), ..Default::default() }, 7)
}

#[test]
fn photons_have_the_picture_of_the_cpu() {
    assert_eq!(Case::named("cornell-box").compare("cornell-box", &sppm(0.05)), None);
    assert_eq!(Case::named("caustic-ball").compare("caustic-ball", &sppm(0.05)), None);
    assert_eq!(Case::of_text(MEDLEY).compare("medley", &sppm(0.05)), None);
    assert_eq!(Case::of_lanterns().compare("lanterns", &sppm(0.05)), None);
}
