//! The table of all BxDFs has each of them.

use alhazen_scattering::Bxdf;
use testkit::assert_complete;

use crate::all_bxdfs::members;

#[test]
fn every_bxdf_is_a_member() {
    // Fibres, measured surfaces and the lobe of light that enters a body have tests of their own.
    let elsewhere = ["Hair", "Measured", "NormalizedFresnel"];
    let names: Vec<_> = members().iter().map(Bxdf::member).chain(elsewhere).collect();
    assert_complete(Bxdf::MEMBERS, names);
}
