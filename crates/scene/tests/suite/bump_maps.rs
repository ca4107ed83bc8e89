//! Bump maps: normals and tangents of raised surfaces against their formulas.

use crate::common::*;
use alhazen_scene::SurfaceInteraction;
use description::{
    FloatParameter, FloatTextureDesc, MaterialDesc, SceneDesc, ShapeDesc, ShapeKind, TextureKind,
    UvImageDesc, WrapMode,
};
use math::{Ray, Vec2, Vec3};
use sampling::Sampler;
use sampling::sampler::Independent;

/// A shape in a material with a displacement.
fn raised(shape: ShapeKind, displacement: impl FnOnce(&mut SceneDesc) -> FloatParameter) -> SceneDesc {
    let mut desc = SceneDesc::default();
    // Footprints are points.
    desc.options.disable_texture_filtering = true;
    let displacement = Some(displacement(&mut desc));
    let material = desc.materials.push(MaterialDesc { displacement, ..MaterialDesc::default() });
    desc.shapes.push(ShapeDesc { material: Some(material), ..shape.into() });
    desc
}

fn push(desc: &mut SceneDesc, kind: TextureKind<f32>) -> FloatParameter {
    desc.float_textures.push(FloatTextureDesc::new(kind)).into()
}

/// a·u + b·v.
fn ramp(desc: &mut SceneDesc, a: f32, b: f32) -> FloatParameter {
    push(desc, TextureKind::Bilerp { corners: [0.0, b, a, a + b], mapping: Default::default() })
}

/// a·u².
fn parabola(desc: &mut SceneDesc, a: f32) -> FloatParameter {
    let [texture, scale] = [ramp(desc, a, 0.0), ramp(desc, 1.0, 0.0)];
    push(desc, TextureKind::Scale { texture, scale })
}

/// The point that a ray hits, with the frame of its BSDF for shading.
fn shaded(desc: &SceneDesc, ray: Ray) -> SurfaceInteraction {
    let scene = scene(desc);
    let mut surface = hit(&scene, &ray).expect("a surface");
    let mut sampler = Sampler::Independent(Independent::new(1, 0));
    let bsdf = scene.bsdf(&view(desc), &mut surface, &ray.into(), &mut lambda(), &mut sampler);
    let frame = bsdf.expect("a diffuse surface").frame;
    let shading = surface.surface.shading;
    assert!((frame.z - shading.n).length() < 1e-6);
    assert!((frame.x - shading.dpdu.normalize()).length() < 1e-4);
    surface
}

/// A rectangle with |∂p/∂u| = 2 and |∂p/∂v| = 1.
fn sheet() -> ShapeKind {
    rectangle([0.0, 0.0], [2.0, 1.0])
}

fn above(uv: Vec2) -> Ray {
    ray(Vec3::new(2.0 * uv.x, uv.y, 1.0), -Vec3::Z)
}

#[test]
fn a_ramp_tilts_the_normal_against_its_slope() {
    for (a, b) in [(0.5, 0.0), (0.0, -0.7), (1.0, 2.0)] {
        let found = shaded(&raised(sheet(), |desc| ramp(desc, a, b)), above(Vec2::new(0.3, 0.6))).surface;
        let normal = Vec3::new(-a / 2.0, -b, 1.0).normalize();
        assert!((found.shading.n - normal).length() < 1e-3, "{} {normal}", found.shading.n);
        assert!((found.shading.dpdu - Vec3::new(2.0, 0.0, a)).length() < 2e-3);
        assert!((found.shading.dpdv - Vec3::new(0.0, 1.0, b)).length() < 2e-3);
        assert_eq!(found.n, Vec3::Z, "the geometric normal");
    }
}

#[test]
fn slopes_are_differences_over_half_of_the_footprint() {
    let mut desc = raised(sheet(), |desc| parabola(desc, 0.8));
    let uv = Vec2::new(0.25, 0.5);
    let slope = |found: &SurfaceInteraction| found.surface.shading.dpdu.z;
    // (u + h)² − u² = h·(2u + h).
    let sharp = shaded(&desc, above(uv));
    assert!((slope(&sharp) - 0.8 * (0.5 + 0.0005)).abs() < 1e-3, "{}", slope(&sharp));
    desc.options.disable_texture_filtering = false;
    desc.film.resolution = [8, 8];
    let blurred = shaded(&desc, above(uv));
    let footprint = blurred.footprint;
    let h = 0.5 * (footprint.dudx.abs() + footprint.dudy.abs());
    assert!(h > 0.005, "{h}");
    assert!((slope(&blurred) - 0.8 * (0.5 + h)).abs() < 1e-4, "{} {h}", slope(&blurred));
}

#[test]
fn a_sphere_that_is_raised_evenly_is_a_larger_sphere() {
    let (radius, height) = (2.0, 0.5);
    let desc = raised(sphere(radius), |_| height.into());
    for direction in [Vec3::new(1.0, 0.4, 0.3), Vec3::new(-0.2, -1.0, 0.9)] {
        let direction = direction.normalize();
        let found = shaded(&desc, ray(direction * 9.0, -direction)).surface;
        assert!((found.shading.n - direction).length() < 1e-4, "{}", found.shading.n);
        let larger = (radius + height) / radius;
        assert!((found.shading.dpdu - found.dpdu * larger).length() < 1e-3 * found.dpdu.length());
        assert!((found.shading.dpdv - found.dpdv * larger).length() < 1e-3 * found.dpdv.length());
    }
}

#[test]
fn normals_keep_their_side() {
    let mut desc = raised(sheet(), |desc| ramp(desc, 1.0, 0.0));
    for (handle, _) in desc.shapes.clone().iter() {
        desc.shapes[handle].reverse_orientation = true;
    }
    let found = shaded(&desc, above(Vec2::new(0.3, 0.6))).surface;
    assert_eq!(found.n, -Vec3::Z);
    // Raised along −z, the sheet falls towards +x.
    let normal = Vec3::new(-0.5, 0.0, -1.0).normalize();
    assert!((found.shading.n - normal).length() < 1e-3, "{}", found.shading.n);
}

#[test]
fn a_bump_map_as_steep_as_floats_allow_has_a_normal() {
    let found = shaded(&raised(sheet(), |desc| ramp(desc, 3e38, 0.0)), above(Vec2::new(0.3, 0.6))).surface;
    let (n, dpdu) = (found.shading.n, found.shading.dpdu);
    assert!((n - Vec3::new(-1.0, 0.0, 0.0)).length() < 1e-3 && dpdu.is_finite(), "{n:?} {dpdu:?}");
}

#[test]
fn a_normal_map_overrides_a_bump_map() {
    let mut desc = raised(sheet(), |desc| ramp(desc, 1.0, 0.0));
    let image = desc.images.push(rgb_image(2, 2, |_, _| [0.5, 0.5, 1.0]));
    for (handle, _) in desc.materials.clone().iter() {
        desc.materials[handle].normal_map = Some(UvImageDesc::new(image, WrapMode::Repeat));
    }
    let found = shaded(&desc, above(Vec2::new(0.3, 0.6))).surface;
    assert!((found.shading.n - Vec3::Z).length() < 1e-6);
}
