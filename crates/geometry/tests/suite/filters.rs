//! Hits that a filter rejects: all others of the same primitive are still found.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use std::cell::RefCell;

fn bodies(m: &Transform) -> Vec<(&'static str, Geometry)> {
    let torus = Formula::parse("(x^2 + y^2 + z^2 + 0.4)^2 - 2.4*(x^2 + y^2)").expect("a formula");
    let bounds = Bounds3::new(Vec3::splat(-1.5), Vec3::splat(1.5));
    let ball = || Solid::sphere(m, 1.0, [-1.0, 1.0]);
    let pipe = Solid::cylinder(m, 0.4, [-2.0, 2.0]);
    let drilled = Solid::combine(Operation::Difference, [ball(), pipe]).expect("a solid");
    let centers = [Vec3::ZERO, Vec3::new(0.5, 0.2, 0.1)];
    let set = SphereSet::new(centers.into(), [0.8].into(), &Transform::IDENTITY, false).expect("a set");
    let mut bodies: Vec<(_, Geometry)> =
        shapes(m).into_iter().map(|(name, shape)| (name, shape.into())).collect();
    bodies.push(("torus", Shape::from(Implicit::new(m, false, torus, &bounds)).into()));
    bodies.push(("drilled ball", Shape::from(drilled).into()));
    bodies.push(("spheres", set.into()));
    bodies
}

/// All hits along a ray, by a filter that rejects each of them.
fn hits(world: &World, ray: &Ray, t_max: f32) -> Vec<f32> {
    let found = RefCell::new(Vec::new());
    let reject = Accepts::Some(&|hit| {
        found.borrow_mut().push(hit.t);
        false
    });
    assert!(world.intersect(ray, t_max, &reject, &mut RayStats::default()).is_none());
    let mut found = found.into_inner();
    found.sort_by(f32::total_cmp);
    found
}

/// The hits of a ray are those of the reversed one, so that none is missed; any of them counts when
/// the others are rejected, for nearest hits and for shadow rays.
#[test]
fn rejected_hits_do_not_hide_others() {
    let rng = &mut Rng::new(3, 0);
    let m = Transform::translate(Vec3::new(0.1, 0.2, -0.3)).after(&Transform::rotate(0.7, Vec3::ONE));
    let mut most = 0;
    for (name, geometry) in bodies(&m) {
        let world = world([geometry]);
        let mut twice = 0;
        for _ in 0..400 {
            let (from, to) = (direction(rng) * 6.0, point_in(rng, 0.8));
            let ray = Ray::new(from, (to - from) * 2.0, 0.0);
            let back = Ray::new(ray.o + ray.d, -ray.d, 0.0);
            let there = hits(&world, &ray, 1.0);
            let mut again: Vec<f32> = hits(&world, &back, 1.0).into_iter().map(|t| 1.0 - t).collect();
            again.reverse();
            // Hits that nearly coincide graze the surface, and may be missed from one side.
            let grazes = there.windows(2).chain(again.windows(2)).any(|t| t[1] - t[0] < 1e-3);
            if grazes {
                continue;
            }
            let agree =
                there.len() == again.len() && there.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-4);
            assert!(agree, "{name}: {there:?} and {again:?} along {ray:?}");
            most = most.max(there.len());
            twice += (there.len() > 1) as i32;
            for &t in &there {
                let only = Accepts::Some(&|hit| hit.t == t);
                let stats = &mut RayStats::default();
                assert_eq!(world.intersect(&ray, 1.0, &only, stats).map(|hit| hit.t), Some(t), "{name}");
                assert!(world.occluded(&ray, 1.0, &only, stats), "{name}");
            }
        }
        let single = ["disk", "ring", "rectangle", "triangle", "patch"];
        assert!(twice > 0 || single.iter().any(|part| name.contains(part)), "{name} is never hit twice");
    }
    assert!(most >= 4, "the torus has four hits");
}
