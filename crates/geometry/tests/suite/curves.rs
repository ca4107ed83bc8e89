//! Curves: against dense sampling of their centre line, in a BVH, and with degenerate control
//! points.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

const NORMALS: [[Vec3; 2]; 1] = [[Vec3::Z, Vec3::Y]];

fn profiles(segments: usize) -> [CurveProfile; 3] {
    [
        CurveProfile::Flat,
        CurveProfile::Cylinder,
        CurveProfile::Ribbon(NORMALS.into_iter().cycle().take(segments).collect()),
    ]
}

fn transforms() -> [Transform; 3] {
    let turn = Transform::rotate(0.7, Vec3::new(0.3, 1.0, -0.2));
    [
        Transform::IDENTITY,
        Transform::translate(Vec3::new(0.3, -20.0, 0.1)).after(&turn),
        turn.after(&Transform::scale(Vec3::new(0.6, 1.7, -0.9))),
    ]
}

fn random_segment(rng: &mut Rng) -> CurveSegment {
    let points = [(); 4].map(|_| point_in(rng, 1.0));
    CurveSegment { points, width: [between(rng, 0.01, 0.3), between(rng, 0.01, 0.3)] }
}

/// A curve along x of nearly constant width. Where a curve turns within its own width as seen along
/// the ray, hits depend on the subdivision, which is chosen for the largest width.
fn gentle_segment(rng: &mut Rng) -> CurveSegment {
    let points = [-1.2, -0.4, 0.4, 1.2].map(|x| Vec3::X * x + point_in(rng, 0.3));
    let width = between(rng, 0.01, 0.3);
    CurveSegment { points, width: [width, width * between(rng, 0.5, 1.0)] }
}

fn straight(width: [f32; 2]) -> CurveSegment {
    CurveSegment { points: [-1.5, -0.5, 0.5, 1.5].map(|x| Vec3::new(x, 0.0, 0.0)), width }
}

/// The nearest hit of all primitives, and its primitive.
fn nearest_part(curves: &Curves, ray: &Ray) -> Option<(u32, ShapeHit)> {
    let mut nearest: Option<(u32, ShapeHit)> = None;
    for i in 0..curves.len() as u32 {
        let t_max = nearest.map_or(f32::INFINITY, |(_, hit)| hit.t);
        nearest = curves.intersect(i, ray, t_max).map(|hit| (i, hit)).or(nearest);
    }
    nearest
}

fn at(p: &[Vec3; 4], u: f32) -> Vec3 {
    let v = 1.0 - u;
    p[0] * (v * v * v) + p[1] * (3.0 * v * v * u) + p[2] * (3.0 * v * u * u) + p[3] * (u * u * u)
}

/// A ray to a point near a curve, in object space; never quite along x.
fn ray_near(rng: &mut Rng, segment: &CurveSegment) -> Ray {
    let u = rng.uniform_f32();
    let target = at(&segment.points, u) + direction(rng) * between(rng, 0.0, 0.3);
    let o = target
        + (direction(rng) + Vec3 { x: 0.0, ..direction(rng) }.normalize() * 1.5) * between(rng, 0.0, 3.0);
    Ray::new(o, (target - o) * between(rng, 0.3, 3.0), 0.0)
}

/// For points of the centre line: u, their distance from the ray in half widths (1 is the edge),
/// and their t along the ray.
fn misses(segment: &CurveSegment, ribbon: bool, ray: &Ray) -> Vec<(f32, f32, f32)> {
    const STEPS: usize = 2000;
    let d = ray.d.normalize();
    let point = |i: usize| {
        let u = i as f32 / STEPS as f32;
        let to = at(&segment.points, u) - ray.o;
        let facing = if ribbon {
            let angle = u * std::f32::consts::FRAC_PI_2;
            (Vec3::Z * angle.cos() + Vec3::Y * angle.sin()).dot(d).abs()
        } else {
            1.0
        };
        let along = to.dot(d);
        let half = 0.5 * lerp(u, segment.width[0], segment.width[1]);
        (u, 1.0 - facing + (to - d * along).length() / half, along)
    };
    (0..=STEPS).map(point).collect()
}

#[test]
fn hits_are_within_half_the_width_of_the_centre_line() {
    let rng = &mut Rng::new(1, 0);
    let (mut hits, mut disputed) = (0, 0);
    for i in 0..600 {
        let segment = gentle_segment(rng);
        let m = &transforms()[i % 3];
        let profile = profiles(1)[i / 3 % 3].clone();
        let ribbon = matches!(profile, CurveProfile::Ribbon(_));
        let curves = Curves::new(vec![segment], profile, (i % 4) as u32, m, false);
        for _ in 0..20 {
            let local = ray_near(rng, &segment);
            let ray = m.ray(&local);
            let misses = misses(&segment, ribbon, &local);
            // There are no hits behind the origin; near it there may be. The ends are flat.
            let sure = misses.windows(3).any(|of| {
                let (_, miss, t) = of[1];
                miss < 0.85 && miss <= of[0].1 && miss <= of[2].1 && t > 0.01
            });
            let possible = misses.iter().any(|&(_, miss, t)| miss < 1.1 && t > -0.01);
            match nearest_part(&curves, &ray) {
                None => assert!(!sure, "missed: {curves:?} {ray:?}"),
                Some((part, hit)) => {
                    hits += 1;
                    disputed += (!sure) as u32;
                    assert!(possible, "met: {curves:?} {ray:?}");
                    let [u, v] = hit.uv.to_array();
                    let (_, miss, t) = misses[(u * (misses.len() - 1) as f32).round() as usize];
                    assert!(
                        miss < 1.05 && (t - hit.t * local.d.length()).abs() < 3e-3,
                        "at u = {u}: {curves:?} {ray:?}"
                    );
                    assert!(ribbon || (2.0 * (v - 0.5).abs() - miss).abs() < 0.1, "{v} for {miss}");
                    let surface = curves.surface(part, &ray, &hit);
                    assert!(surface.p.p.distance(ray.at(hit.t)) < 1e-5 * (1.0 + ray.o.length()));
                }
            }
        }
    }
    assert!(hits > 2000 && disputed < hits / 3, "{hits} hits, {disputed} disputed");
}

#[test]
fn a_ribbon_facing_the_ray_is_a_rectangle() {
    let rng = &mut Rng::new(2, 0);
    let m = &transforms()[1];
    let segment = straight([0.8, 0.4]);
    let normals = CurveProfile::Ribbon(vec![[Vec3::Z; 2]]);
    let curves = Curves::new(vec![segment], normals, 2, m, false);
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let corners = [corner(-1.5, -0.4), corner(1.5, -0.2), corner(-1.5, 0.4), corner(1.5, 0.2)];
    let patch = Shape::from(BilinearPatch::new(corners, None, None, m, false));
    let mut hits = 0;
    for _ in 0..2000 {
        let target = Vec3::new(between(rng, -2.0, 2.0), between(rng, -0.6, 0.6), 0.0);
        let o = Vec3::new(target.x, between(rng, -4.0, 4.0), between(rng, -4.0, 4.0));
        let ray = m.ray(&Ray::new(o, target - o, 0.0));
        let (Some(hit), Some((part, met))) =
            (patch.intersect(&ray, f32::INFINITY), nearest_part(&curves, &ray))
        else {
            let edge = lerp(target.x / 3.0 + 0.5, 0.4, 0.2);
            let beside = (target.y.abs() - edge).abs() < 1e-3 || (target.x.abs() - 1.5).abs() < 1e-3;
            let found = [patch.intersect(&ray, 9.0).is_some(), nearest_part(&curves, &ray).is_some()];
            assert!(beside || found == [false; 2], "{target} {found:?}");
            continue;
        };
        hits += 1;
        let (expected, surface) = (patch.surface(&ray, &hit), curves.surface(part, &ray, &met));
        assert!(surface.n.dot(expected.n).abs() > 1.0 - 1e-5, "{target} {met:?} {hit:?} {o}");
        assert!((met.uv.x - hit.uv.x).abs() < 1e-3);
        let across = (met.uv.y - 0.5).abs() - (hit.uv.y - 0.5).abs();
        assert!(across.abs() < 1e-3, "{met:?} {hit:?}");
    }
    assert!(hits > 500);
}

#[test]
fn splitting_does_not_change_hits() {
    let rng = &mut Rng::new(3, 0);
    let (mut hits, mut differences) = (0, 0);
    for i in 0..300 {
        let segment = gentle_segment(rng);
        let [whole, split] = [0, 5].map(|depth| {
            Curves::new(vec![segment], profiles(1)[i % 3].clone(), depth, &transforms()[i / 3 % 3], false)
        });
        assert_eq!((whole.len(), split.len()), (1, 32));
        for _ in 0..20 {
            let ray = transforms()[i / 3 % 3].ray(&ray_near(rng, &segment));
            match (nearest_part(&whole, &ray), nearest_part(&split, &ray)) {
                (Some((_, a)), Some((_, b))) => {
                    hits += 1;
                    differences += ((a.t - b.t).abs() > 0.02 || (a.uv.x - b.uv.x).abs() > 0.02) as u32;
                }
                (a, b) => differences += (a.is_some() != b.is_some()) as u32,
            }
        }
    }
    // Silhouettes shift by a fraction of the width, since segments of segments are straighter.
    assert!(hits > 1000 && differences < hits / 30, "{differences} of {hits}");
}

#[test]
fn the_bvh_finds_the_nearest_hit() {
    let rng = &mut Rng::new(4, 0);
    for (i, m) in transforms().iter().enumerate() {
        let segments: Vec<_> = (0..40).map(|_| random_segment(rng)).collect();
        let curves = Curves::new(segments.clone(), profiles(40)[i].clone(), 3, m, false);
        let world = world([curves.clone().into()]);
        let mut hits = 0;
        for _ in 0..2000 {
            let ray = m.ray(&ray_near(rng, &segments[0]));
            let expected = nearest_part(&curves, &ray);
            let found = nearest(&world, &ray);
            assert_eq!(found.map(|hit| hit.t), expected.map(|(_, hit)| hit.t), "{ray:?}");
            let stats = &mut RayStats::default();
            assert_eq!(world.occluded(&ray, f32::INFINITY, &KEEP_ALL, stats), expected.is_some());
            if let (Some(hit), Some((part, met))) = (found, expected) {
                hits += 1;
                let (surface, same) = (world.surface(&ray, &hit), curves.surface(part, &ray, &met));
                assert!(hit.primitive != part || surface == same);
            }
        }
        assert!(hits > 1000);
    }
}

#[test]
fn v_and_tangents_follow_pbrts_conventions() {
    // A ray along −z at a curve along +x: v grows towards d × x = −y, and so does ∂p/∂v.
    let ray = Ray::new(Vec3::new(0.3, -0.1, 5.0), -Vec3::Z, 0.25);
    let m = &Transform::IDENTITY;
    let at = |profile, reverse| {
        let curves = Curves::new(vec![straight([0.4; 2])], profile, 0, m, reverse);
        let hit = curves.intersect(0, &ray, 9.0).expect("a hit");
        assert!((hit.t - 5.0).abs() < 1e-6 && hit.uv.distance(Vec2::new(0.6, 0.75)) < 1e-6, "{hit:?}");
        curves.surface(0, &ray, &hit)
    };
    let flat = at(CurveProfile::Flat, false);
    assert!(flat.dpdu.distance(Vec3::X * 3.0) < 1e-6 && flat.dpdv.distance(Vec3::Y * -0.4) < 1e-6);
    assert!(flat.n.distance(-Vec3::Z) < 1e-6 && flat.shading.n == flat.n && flat.time == 0.25);
    assert!(at(CurveProfile::Flat, true).n.distance(Vec3::Z) < 1e-6);
    assert_eq!(flat.p.p, Vec3::new(0.3, -0.1, 0.0));
    assert!(flat.p.error.min_element() >= 0.4);
    // An eighth of a turn at v = 3/4.
    let tube = at(CurveProfile::Cylinder, false);
    assert!(tube.n.distance((-Vec3::Z - Vec3::Y).normalize()) < 1e-6, "{}", tube.n);
    assert!((tube.dpdv.length() - 0.4).abs() < 1e-6 && tube.dpdu == flat.dpdu);
    let ribbon = at(CurveProfile::Ribbon(vec![[Vec3::Z * 7.0; 2]]), false);
    assert!(ribbon.n.distance(Vec3::Z) < 1e-6 && ribbon.dpdv.distance(Vec3::Y * 0.4) < 1e-6);
    let mirrored = Curves::new(
        vec![straight([0.4; 2])],
        CurveProfile::Flat,
        0,
        &Transform::scale(Vec3::new(1.0, 1.0, -1.0)),
        false,
    );
    let hit = mirrored.intersect(0, &ray, 9.0).expect("a hit");
    assert!(mirrored.surface(0, &ray, &hit).n.distance(Vec3::Z) < 1e-6, "a reflection flips normals");
}

#[test]
fn spawned_rays_do_not_hit_a_straight_curve() {
    let rng = &mut Rng::new(5, 0);
    for (i, m) in transforms()[..2].iter().enumerate() {
        for profile in profiles(1).into_iter().take(2) {
            for size in [1e-3, 1.0] {
                let segment = straight([0.02 * size, 0.3 * size]);
                let curves = Curves::new(vec![segment], profile.clone(), i as u32, m, false);
                for _ in 0..500 {
                    let ray = m.ray(&ray_near(rng, &segment));
                    let Some((part, hit)) = nearest_part(&curves, &ray) else { continue };
                    let surface = curves.surface(part, &ray, &hit);
                    for _ in 0..10 {
                        let w = direction(rng);
                        let again = nearest_part(&curves, &surface.spawn_ray(w));
                        // The far side of a cylinder's rim is within its width.
                        let grazes = surface.n.dot(surface.wo).abs() < 0.5
                            && surface.n.dot(w) * surface.n.dot(surface.wo) < 0.0;
                        assert!(again.is_none() || grazes, "{curves:?} {ray:?} {w} {again:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn degenerate_curves_do_not_panic() {
    let rng = &mut Rng::new(6, 0);
    let values = [0.0, -1.0, 1.0, 1e-38, 1e38, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for i in 0..2000 {
        let mut pick = || {
            if rng.uniform_f32() < 0.6 {
                between(rng, -1.0, 1.0)
            } else {
                values[(rng.uniform_f32() * 9.0) as usize]
            }
        };
        let points = [(); 4].map(|_| Vec3::new(pick(), pick(), pick()));
        let points = if i % 5 == 0 { [points[0]; 4] } else { points };
        let segment = CurveSegment { points, width: [pick(), pick()] };
        let normals = [Vec3::new(pick(), pick(), pick()), Vec3::new(pick(), pick(), pick())];
        let profile = match profiles(1)[i % 3].clone() {
            CurveProfile::Ribbon(_) => CurveProfile::Ribbon(vec![normals]),
            other => other,
        };
        let curves = Curves::new(vec![segment], profile, (i % 3) as u32, &Transform::IDENTITY, false);
        let world = world([curves.into()]);
        for _ in 0..10 {
            let ray = Ray::new(point_in(rng, 3.0), direction(rng), 0.0);
            if let Some(hit) = nearest(&world, &ray) {
                let surface = world.surface(&ray, &hit);
                assert!(hit.t > 0.0 && hit.t.is_finite() && hit.uv.is_finite(), "{segment:?} {hit:?}");
                assert!(
                    surface.p.p.is_finite() && (surface.n.length() - 1.0).abs() < 1e-4,
                    "{segment:?} {surface:?}"
                );
            }
        }
    }
    let none = Curves::new(vec![straight([0.0, -1.0])], CurveProfile::Flat, 0, &Transform::IDENTITY, false);
    assert_eq!(nearest_part(&none, &Ray::new(Vec3::Z, -Vec3::Z, 0.0)), None, "no width");
    assert_eq!(nearest_part(&none, &Ray::new(Vec3::Z, Vec3::ZERO, 0.0)), None);
    let finest =
        Curves::new(vec![straight([0.1; 2])], CurveProfile::Flat, u32::MAX, &Transform::IDENTITY, false);
    assert_eq!(finest.len(), 1 << 25);
    assert!(Curves::new(Vec::new(), CurveProfile::Flat, 3, &Transform::IDENTITY, false).is_empty());
}

#[test]
fn memory_is_proportional_to_segments() {
    assert_eq!(size_of::<CurveSegment>(), 56);
}
