//! Warps in lanes give the bits of single numbers.

use alhazen_sampling::warp::*;
use lanes::Real;
use math::{Vec2, Vec3};
use testkit::{LaneFunction, lanes_agree};

struct Warps;

impl LaneFunction for Warps {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let p = Vec2::new(u[0], u[1]);
        let w = [u[2], u[3], u[4], u[5]];
        let mut results = Vec::new();
        for p in [
            sample_uniform_disk_polar(p),
            sample_uniform_disk_concentric(p),
            sample_bilinear(p, w),
            Vec2::new(bilinear_pdf(p, w), sample_linear(u[0], u[2], u[3])),
            Vec2::new(linear_pdf(u[0], u[2], u[3]), uniform_cone_pdf(u[2])),
        ] {
            results.extend(p.to_array());
        }
        for w in [
            sample_uniform_sphere(p),
            sample_uniform_hemisphere(p),
            sample_cosine_hemisphere(p),
            sample_uniform_cone(p, u[2]),
            Vec3::from_array(sample_uniform_triangle(p)),
        ] {
            results.extend(w.to_array());
            results.push(cosine_hemisphere_pdf(w.z));
        }
        results
    }
}

#[test]
fn warps_do_not_depend_on_the_number_of_lanes() {
    lanes_agree(&Warps, 6, 500);
}
