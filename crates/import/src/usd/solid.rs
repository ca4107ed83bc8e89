//! Shapes with a formula: spheres, cylinders, cones, capsules, cubes and planes.

use std::f64::consts::FRAC_PI_2;

use description::{MeshDesc, ShapeDesc, ShapeKind, TransformDesc};
use math::{DMat4, DVec3, Vec3};

use super::stage::Prim;
use crate::log::Result;

/// A shape, and two corners of the box around it before its transform.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub shape: ShapeDesc,
    pub bounds: [DVec3; 2],
}

/// The names of schemas that are read.
pub(super) const KINDS: [&str; 8] =
    ["Sphere", "Cube", "Cylinder", "Cylinder_1", "Cone", "Capsule", "Capsule_1", "Plane"];

impl Solid {
    fn new(kind: ShapeKind, low: DVec3, high: DVec3) -> Self {
        Self { shape: kind.into(), bounds: [low, high] }
    }

    /// The same after a transform.
    pub fn turned(mut self, matrix: DMat4) -> Self {
        self.shape.world_from_object = TransformDesc::fixed(matrix * self.shape.world_from_object.start);
        self
    }
}

/// The shapes of a prim, in its space. Shapes with an axis are made about z.
pub(super) fn read(prim: &Prim, kind: &str) -> Result<Vec<Solid>> {
    let size = |name: &str, otherwise: f64| match prim.number(name)?.unwrap_or(otherwise) {
        value if value > 0.0 => Ok(value),
        value => Err(prim.fault(name, format!("this must be above 0, not {value}"))),
    };
    // Both ends of a tube have a radius in the second version of the schemas.
    let radii = |otherwise: f64| match kind.ends_with("_1") {
        true => Ok([size("radiusBottom", otherwise)?, size("radiusTop", otherwise)?]),
        false => size("radius", otherwise).map(|radius| [radius; 2]),
    };
    let axis = prim.word("axis")?.unwrap_or_else(|| "Z".to_owned());
    if !matches!(axis.as_str(), "X" | "Y" | "Z") {
        return Err(prim.fault("axis", format!("`{axis}` is not an axis")));
    }
    let solids = match kind {
        "Sphere" => return Ok(vec![sphere(size("radius", 1.0)?)]),
        "Cube" => return Ok(vec![cube(size("size", 2.0)?)]),
        "Plane" => {
            let (width, length) = (size("width", 2.0)?, size("length", 2.0)?);
            // The width is along x, but along z where the plane faces x.
            return Ok(vec![match axis.as_str() {
                "X" => plane(DVec3::NEG_Z * width / 2.0, DVec3::Y * length / 2.0),
                "Y" => plane(DVec3::X * width / 2.0, DVec3::NEG_Z * length / 2.0),
                _ => plane(DVec3::X * width / 2.0, DVec3::Y * length / 2.0),
            }]);
        }
        "Cone" => {
            let (radius, height) = (size("radius", 1.0)?, size("height", 2.0)?);
            let cone = Solid::new(
                ShapeKind::Cone { radius: radius as f32, height: height as f32, phi_max: 360.0 },
                DVec3::new(-radius, -radius, 0.0),
                DVec3::new(radius, radius, height),
            );
            let cone = cone.turned(DMat4::from_translation(DVec3::NEG_Z * height / 2.0));
            vec![cone, disk(radius, -height / 2.0)]
        }
        "Cylinder" | "Cylinder_1" => {
            let ([bottom, top], height) = (radii(1.0)?, size("height", 2.0)?);
            let side = match bottom == top {
                true => cylinder(top, height),
                false => tapered([bottom, top], height),
            };
            vec![side, disk(bottom, -height / 2.0), disk(top, height / 2.0)]
        }
        _ => {
            let ([bottom, top], height) = (radii(0.5)?, size("height", 1.0)?);
            let half = DMat4::from_translation(DVec3::Z * height / 2.0);
            let side = match bottom == top {
                true => cylinder(top, height),
                false => tapered([bottom, top], height),
            };
            vec![side, cap(top, 1.0).turned(half), cap(bottom, -1.0).turned(half.inverse())]
        }
    };
    let turn = axis_from_z(&axis);
    Ok(solids.into_iter().map(|solid| solid.turned(turn)).collect())
}

/// From shapes about z to those about another axis.
pub(super) fn axis_from_z(axis: &str) -> DMat4 {
    match axis {
        "X" => DMat4::from_rotation_y(FRAC_PI_2),
        "Y" => DMat4::from_rotation_x(-FRAC_PI_2),
        _ => DMat4::IDENTITY,
    }
}

/// A sphere about the origin.
pub(super) fn sphere(radius: f64) -> Solid {
    let r = radius as f32;
    let kind = ShapeKind::Sphere { radius: r, z_min: -r, z_max: r, phi_max: 360.0 };
    Solid::new(kind, DVec3::splat(-radius), DVec3::splat(radius))
}

/// Half of a sphere, above or below z = 0.
fn cap(radius: f64, side: f32) -> Solid {
    let r = radius as f32;
    let (z_min, z_max) = if side > 0.0 { (0.0, r) } else { (-r, 0.0) };
    let kind = ShapeKind::Sphere { radius: r, z_min, z_max, phi_max: 360.0 };
    let corner = |z: f32, side: f64| DVec3::new(side * radius, side * radius, z.into());
    Solid::new(kind, corner(z_min, -1.0), corner(z_max, 1.0))
}

/// A disk across the z axis that faces z.
pub(super) fn disk(radius: f64, height: f64) -> Solid {
    let kind =
        ShapeKind::Disk { height: height as f32, radius: radius as f32, inner_radius: 0.0, phi_max: 360.0 };
    Solid::new(kind, DVec3::new(-radius, -radius, height), DVec3::new(radius, radius, height))
}

/// The side of a cylinder about z, whose middle is the origin.
pub(super) fn cylinder(radius: f64, height: f64) -> Solid {
    let half = height / 2.0;
    let kind = ShapeKind::Cylinder {
        radius: radius as f32,
        z_min: -half as f32,
        z_max: half as f32,
        phi_max: 360.0,
    };
    Solid::new(kind, DVec3::new(-radius, -radius, -half), DVec3::new(radius, radius, half))
}

/// The same with a radius for each end.
fn tapered([bottom, top]: [f64; 2], height: f64) -> Solid {
    let (half, most) = (height / 2.0, bottom.max(top));
    let end = |radius: f64, z: f64| Vec3::new(radius as f32, 0.0, z as f32);
    let kind = ShapeKind::Hyperboloid { ends: [end(bottom, -half), end(top, half)], phi_max: 360.0 };
    Solid::new(kind, DVec3::new(-most, -most, -half), DVec3::new(most, most, half))
}

fn cube(size: f64) -> Solid {
    let half = size / 2.0;
    let corner = |i: usize, axis: usize| if i >> axis & 1 == 0 { -half } else { half } as f32;
    let positions: Vec<_> = (0..8).map(|i| Vec3::new(corner(i, 0), corner(i, 1), corner(i, 2))).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = MeshDesc { indices, positions: positions.into(), ..MeshDesc::default() };
    Solid::new(ShapeKind::Triangles(mesh), DVec3::splat(-half), DVec3::splat(half))
}

/// A rectangle from its middle to the middles of two of its edges.
fn plane(x: DVec3, y: DVec3) -> Solid {
    let corners = [-x - y, x - y, x + y, y - x];
    let mesh = MeshDesc {
        indices: [[0, 1, 2], [0, 2, 3]].into(),
        positions: corners.map(|corner| Vec3::from(corner.as_vec3())).into(),
        ..MeshDesc::default()
    };
    let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
    Solid::new(ShapeKind::Triangles(mesh), low, high)
}
