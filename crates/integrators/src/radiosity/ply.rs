//! A solution as a mesh: elements with their radiosity as vertex colours, in the PLY format.
//!
//! Binary, little-endian. Every element is the fan of triangles between its centre and its outline,
//! so that T-vertices are included and there are no cracks. Positions are in world space. A vertex
//! has the linear RGB of its radiosity as `radiosity_red`, `radiosity_green` and `radiosity_blue`,
//! and a display colour as `red`, `green` and `blue`: encoded as sRGB, with the brightest value
//! that is not a light at 255. Each side that receives or emits light has its own vertices and
//! triangles; those of an inner side have the opposite orientation.

use math::DVec3;
use scene::Scene;
use spectrum::{RgbColorSpace, xyz_from};

use super::bands::Bands;
use super::shooting::Solution;
use super::show::Interpolation;

/// Writes the mesh.
pub(crate) fn encode(
    scene: &Scene,
    solution: &Solution,
    interpolation: &Interpolation,
    color_space: &RgbColorSpace,
) -> Vec<u8> {
    let world_from_render = scene.world_from_render();
    let cut = &solution.cut;
    let mut vertices: Vec<(DVec3, [f32; 3], bool)> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for (id, element) in (0..).zip(&cut.elements) {
        let emitted = &cut.patches[element.patch as usize].emitted;
        let cell = cut.mesh.cell(element.cell);
        let outline = interpolation.outline(id);
        let center = cut.mesh.surface(scene.world(), cell.primitive, cell.domain().center());
        let Some(center) = center else { continue };
        for (side, emitted) in emitted.iter().enumerate() {
            let radiosity = |irradiance: &[Bands; 2]| element.albedo.scatter(irradiance)[side] + *emitted;
            let corners = outline.iter().map(|corner| {
                (
                    cut.mesh.vertices()[corner.vertex as usize].p,
                    radiosity(interpolation.at_vertex(corner.vertex)),
                )
            });
            let fan: Vec<_> =
                std::iter::once((center.p.p, radiosity(&element.irradiance()))).chain(corners).collect();
            if fan.iter().all(|(_, light)| light.is_black()) {
                continue;
            }
            let first = vertices.len() as u32;
            let is_light = !emitted.is_black();
            vertices.extend(fan.iter().map(|(p, light)| {
                let p = world_from_render.transform_point3(p.as_dvec3());
                (p, rgb(solution, light, color_space), is_light)
            }));
            let n = if side == 0 { center.n } else { -center.n };
            let around = |i: usize| fan[1 + i % outline.len()].0 - center.p.p;
            for i in 0..outline.len() {
                let (a, b) = (first + 1 + i as u32, first + 1 + ((i + 1) % outline.len()) as u32);
                let turns = around(i).cross(around(i + 1)).dot(n) >= 0.0;
                triangles.push(if turns { [first, a, b] } else { [first, b, a] });
            }
        }
    }
    let brightest =
        vertices.iter().filter(|vertex| !vertex.2).flat_map(|vertex| vertex.1).fold(0.0, f32::max);
    let scale = if brightest > 0.0 { brightest.recip() } else { 1.0 };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment radiosity: vertex colours, and linear RGB in scene units\n\
         element vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n\
         property float radiosity_red\nproperty float radiosity_green\nproperty float radiosity_blue\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    );
    let mut bytes = header.into_bytes();
    for (p, rgb, _) in &vertices {
        p.to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(rgb.map(|x| shown(x * scale)));
        rgb.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    for triangle in &triangles {
        bytes.push(3);
        triangle.iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    }
    bytes
}

fn rgb(solution: &Solution, light: &Bands, color_space: &RgbColorSpace) -> [f32; 3] {
    let groups = solution.wavelengths.groups();
    let sum = groups.iter().zip(light.groups()).fold([0.0; 3], |sum, (lambda, light)| {
        let xyz = xyz_from(light, lambda);
        [sum[0] + f64::from(xyz.x), sum[1] + f64::from(xyz.y), sum[2] + f64::from(xyz.z)]
    });
    color_space.rgb_from_xyz().apply(sum.map(|x| x / groups.len() as f64)).map(|x| x as f32)
}

/// The sRGB encoding of a linear value.
fn shown(x: f32) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * lanes::pow(x, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}
