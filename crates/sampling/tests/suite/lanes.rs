//! Warps and samplers in lanes give the bits of single numbers.

use alhazen_sampling::Sampler;
use alhazen_sampling::sampler::*;
use alhazen_sampling::warp::*;
use lanes::{Each, Real};
use math::{Vec2, Vec3};
use testkit::{LaneFunction, lanes_agree};

struct Warps;

/// The polygons seen from a point.
struct Polygons;

impl LaneFunction for Polygons {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let at = |i: usize| Vec3::new(u[i], u[i + 1], u[i + 2]);
        let (p, corner, u) = (at(0), at(3), Vec2::new(u[12], u[13]));
        let triangle = SphericalTriangle::new([corner, at(6), at(9)], p);
        let rectangle = SphericalRectangle::new(p, corner, at(6), at(9));
        let mut results = vec![triangle.solid_angle(), rectangle.solid_angle()];
        for (point, is_valid) in [
            (triangle.sample(u), triangle.is_valid()),
            (triangle.invert(u), triangle.is_valid()),
            (rectangle.sample(u), rectangle.is_valid()),
            (rectangle.invert(at(12)), rectangle.is_valid()),
        ] {
            for x in point.to_array() {
                results.push(R::select(is_valid, x, R::zero()));
            }
        }
        results
    }
}

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

/// A sample of a sampler: pixel and dimension by the lane's numbers.
struct Draws(Sampler, u32);

impl LaneFunction for Draws {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let pixel = [u[0], u[1]].each(|u| (u * R::splat(300.0)).to_int());
        let near = Address { pixel, index: self.1, dimension: (u[2] * R::splat(5.0)).to_int() };
        let far = Address { dimension: (u[2] * R::splat(3000.0)).to_int(), ..near };
        let mut results = Vec::new();
        for address in [near, far] {
            results.push(self.0.at_1d(&address));
            results.extend(self.0.at_2d::<R>(&address));
            results.extend(self.0.at_pixel_2d::<R>(&address));
        }
        results
    }
}

#[test]
fn samplers_do_not_depend_on_the_number_of_lanes() {
    for index in [0, 13, 70_000] {
        let resolution = [300, 200];
        let large = ZSobol::new(1 << 20, [1 << 14; 2], Randomize::FastOwen, 5);
        lanes_agree(&Draws(Sampler::ZSobol(large), index), 3, 50);
        lanes_agree(&Draws(Sampler::Independent(Independent::new(16, 5)), index), 3, 50);
        for r in [Randomize::None, Randomize::PermuteDigits, Randomize::FastOwen, Randomize::Owen] {
            lanes_agree(&Draws(Sampler::Sobol(Sobol::new(16, resolution, r, 5)), index), 3, 50);
            lanes_agree(&Draws(Sampler::ZSobol(ZSobol::new(32, resolution, r, 5)), index), 3, 50);
        }
    }
}

#[test]
fn polygons_do_not_depend_on_the_number_of_lanes() {
    lanes_agree(&Polygons, 15, 500);
}
