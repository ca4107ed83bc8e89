//! Meshes and random values for the tests.

use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use sampling::warp::sample_uniform_sphere;
use std::f32::consts::{PI, TAU};

pub fn uniform_2d(rng: &mut Rng) -> Vec2 {
    Vec2::new(rng.uniform_f32(), rng.uniform_f32())
}

pub fn between(rng: &mut Rng, low: f32, high: f32) -> f32 {
    lerp(rng.uniform_f32(), low, high)
}

pub fn point_in(rng: &mut Rng, size: f32) -> Vec3 {
    Vec3::new(between(rng, -size, size), between(rng, -size, size), between(rng, -size, size))
}

pub fn direction(rng: &mut Rng) -> Vec3 {
    sample_uniform_sphere(uniform_2d(rng))
}

/// A filter that may reject any hit, or accepts all unasked. All filters of tests have this type,
/// since each type is one more copy of the ray engine to compile, for each instruction set.
pub enum Accepts<'a> {
    All,
    Some(&'a dyn Fn(&Hit) -> bool),
}

impl Filter for Accepts<'_> {
    const EVERY_SET: bool = true;

    fn accepts(&self, hit: &Hit, _: &Ray) -> bool {
        match self {
            Self::All => true,
            Self::Some(accepts) => accepts(hit),
        }
    }

    fn concerns(&self, _: GeometryId) -> bool {
        matches!(self, Self::Some(_))
    }
}

pub const KEEP_ALL: Accepts = Accepts::Some(&|_| true);

pub fn mesh(positions: Vec<Vec3>, indices: Vec<[u32; 3]>, transform: &Transform) -> TriangleMesh {
    TriangleMesh::new(positions.into(), indices.into(), MeshAttributes::default(), transform, false)
        .expect("a mesh")
}

/// A closed box.
pub fn cube(transform: &Transform) -> TriangleMesh {
    let positions = Bounds3::new(-Vec3::ONE, Vec3::ONE).corners().collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh(positions, indices, transform)
}

/// A closed, bumpy sphere of about 2·n·(n − 1) triangles, with radii between 1 − bump and 1 + bump.
pub fn ball(n: u32, bump: f32, transform: &Transform) -> TriangleMesh {
    let mut positions = vec![Vec3::Z, -Vec3::Z];
    for i in 1..n {
        for j in 0..n {
            let (theta, phi) = (i as f32 / n as f32 * PI, j as f32 / n as f32 * TAU);
            let r = 1.0 + bump * (5.0 * theta).sin() * (7.0 * phi).cos();
            positions.push(spherical_direction(theta.sin(), theta.cos(), phi) * r);
        }
    }
    let at = |i: u32, j: u32| {
        if i == 0 {
            0
        } else if i == n {
            1
        } else {
            2 + (i - 1) * n + j % n
        }
    };
    let mut indices = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            if i + 1 < n {
                indices.push([a, b, c]);
            }
            if i > 0 {
                indices.push([a, c, d]);
            }
        }
    }
    mesh(positions, indices, transform)
}

pub fn world(geometries: impl IntoIterator<Item = Geometry>) -> World {
    let mut builder = World::builder();
    for geometry in geometries {
        builder.add_geometry(GroupId::TOP, geometry);
    }
    builder.build()
}

pub fn nearest(world: &World, ray: &Ray) -> Option<Hit> {
    world.intersect(ray, f32::INFINITY, &KEEP_ALL, &mut RayStats::default())
}

/// Shapes of every kind with one transform.
pub fn shapes(m: &Transform) -> Vec<(&'static str, Shape)> {
    let rectangle = [
        Vec3::new(-1.0, -0.5, 0.2),
        Vec3::new(1.0, -0.5, 0.2),
        Vec3::new(-1.0, 0.5, 0.2),
        Vec3::new(1.0, 0.5, 0.2),
    ];
    let mut bent = rectangle;
    bent[3] += Vec3::new(0.3, 0.4, 1.0);
    let triangle = Triangle::new(
        [Vec3::new(-1.0, 0.1, 0.0), Vec3::new(0.7, -0.4, 0.3), Vec3::new(0.2, 0.9, -0.5)].map(|p| m.point(p)),
    );
    let hyperboloid = |p1: [f32; 3], p2: [f32; 3], phi_max| {
        Hyperboloid::new(m, false, [p1.into(), p2.into()], phi_max).into()
    };
    let mut shapes: Vec<(&str, Shape)> = vec![
        ("sphere", Sphere::whole(m, false, 1.0).into()),
        ("part of a sphere", Sphere::new(m, true, 1.0, [-0.6, 0.8], 250.0).into()),
        ("cylinder", Cylinder::new(m, false, 0.7, [-1.0, 0.5], 300.0).into()),
        ("cone", Cone::new(m, false, 0.9, 1.4, 360.0).into()),
        ("part of a cone", Cone::new(m, true, 0.8, 0.7, 230.0).into()),
        ("paraboloid", Paraboloid::new(m, false, 0.9, [0.2, 1.3], 290.0).into()),
        ("whole bowl", Paraboloid::new(m, true, 1.0, [0.0, 0.8], 360.0).into()),
        ("hyperboloid", hyperboloid([0.9, 0.1, -0.8], [-0.2, 0.8, 0.9], 360.0)),
        ("two cones", hyperboloid([0.6, 0.3, 0.7], [-0.4, -0.2, -0.6], 250.0)),
        ("disk", Disk::new(m, false, 0.3, 1.0, 0.0, 360.0).into()),
        ("ring", Disk::new(m, true, -0.3, 1.0, 0.4, 200.0).into()),
        ("rectangle", BilinearPatch::new(rectangle, None, None, m, false).into()),
        ("bent patch", BilinearPatch::new(bent, None, None, m, true).into()),
        ("triangle", triangle.into()),
    ];
    let centers = [Vec3::new(9.0, 0.0, 0.0), Vec3::new(0.1, -0.2, 0.1)];
    let set = SphereSet::new(centers.into(), [0.8].into(), m, true).map(Geometry::from);
    shapes.extend(set.ok().and_then(|set| Some(("sphere of a set", set.shape(1)?.into_owned()))));
    shapes
}
