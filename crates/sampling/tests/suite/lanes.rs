//! Warps, tables and samplers in lanes give the bits of single numbers.

use alhazen_sampling::sampler::*;
use alhazen_sampling::warp::*;
use alhazen_sampling::{PiecewiseConstant2d, Sampler};
use lanes::{Each, Int, Real};
use math::{Bounds2, Vec2, Vec3};
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
            Vec2::new(sample_tent(u[0], u[2]), sample_tent(u[1], u[3])),
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

/// A sample of a table.
struct Table(PiecewiseConstant2d);

impl LaneFunction for Table {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let (p, pdf, [column, row]) = self.0.sample(Vec2::new(u[0], u[1]));
        vec![p.x, p.y, pdf, column.to_real(), row.to_real()]
    }
}

#[test]
fn tables_do_not_depend_on_the_number_of_lanes() {
    let domain = Bounds2::new(Vec2::new(-1.0, 0.5), Vec2::new(3.0, 0.75));
    // Steep in one half, zero in the other, and nowhere positive.
    let steep = |i: usize| if i % 17 < 9 { 0.0 } else { (i as f32).exp2() };
    let tables = [(0..77).map(steep).collect::<Vec<f32>>(), vec![0.0; 77], vec![-2.5]];
    for values in &tables {
        lanes_agree(&Table(PiecewiseConstant2d::new(values, values.len().min(11), domain)), 2, 200);
    }
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
        for spp in [1, 32, 1 << 31] {
            lanes_agree(&Draws(Sampler::Pmj02Bn(Pmj02Bn::new(spp, 5)), index), 3, 50);
        }
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
