//! Materials of the car.

use math::Vec3;

use crate::picture;

/// Texture coordinates of panels for a metre.
pub const SCALE: f32 = 8.0;

/// The normals of metal flakes in the paint as a picture in the format PFM: cells about random
/// points, each a mirror tilted at random.
pub fn flakes(size: u32) -> Vec<u8> {
    const CELLS: i32 = 150;
    let random = |i: i32, j: i32, k: u32| {
        let [i, j] = [i, j].map(|v| v.rem_euclid(CELLS) as u32);
        (sampling::hash(&[i, j, k]) >> 40) as f32 / (1 << 24) as f32
    };
    picture::square(size, |uv| {
        let [u, v] = uv.to_array().map(|v| v * CELLS as f32);
        let (mut nearest, mut cell) = (f32::INFINITY, (0, 0));
        for i in u as i32 - 1..=u as i32 + 1 {
            for j in v as i32 - 1..=v as i32 + 1 {
                let distance = (i as f32 + random(i, j, 0) - u).hypot(j as f32 + random(i, j, 1) - v);
                if distance < nearest {
                    (nearest, cell) = (distance, (i, j));
                }
            }
        }
        // A tilt with the distribution of Gaussian slopes.
        let spread = 0.13 * (-2.0 * lanes::ln(1.0 - random(cell.0, cell.1, 2))).sqrt();
        let (sin, cos) = lanes::sin_cos(std::f32::consts::TAU * random(cell.0, cell.1, 3));
        let n = Vec3::new(spread * cos, spread * sin, 1.0).normalize();
        n.map(|v| 0.5 * v + 0.5)
    })
}

pub const MATERIALS: &str = r#"# A coupé. Made by `cargo xtask scenes car`. x is to the left, y ahead, z up; metres.

# A clear coat over flakes of metal in colour.
MakeNamedMaterial "paint" "string type" "openpbr" "rgb base_color" [ 0.58 0.012 0.02 ] "float base_metalness" 0.88
    "float specular_roughness" 0.4 "string normalmap" "flakes.pfm"
    "float coat_weight" 1 "float coat_roughness" 0 "float coat_ior" 1.55 "rgb coat_color" [ 1 0.86 0.84 ]
MakeNamedMaterial "glass" "string type" "thindielectric" "float eta" 1.5
MakeNamedMaterial "red glass" "string type" "openpbr" "float transmission_weight" 1 "bool geometry_thin_walled" true
    "rgb transmission_color" [ 0.8 0.02 0.02 ] "float specular_roughness" 0
MakeNamedMaterial "crystal" "string type" "dielectric" "float eta" 1.5
MakeNamedMaterial "chrome" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.002
MakeNamedMaterial "alloy" "string type" "openpbr" "rgb base_color" [ 0.62 0.63 0.65 ] "float base_metalness" 1
    "float specular_roughness" 0.32 "float coat_weight" 0.6
MakeNamedMaterial "steel" "string type" "conductor" "rgb reflectance" [ 0.5 0.49 0.48 ] "float roughness" 0.08
MakeNamedMaterial "caliper" "string type" "openpbr" "rgb base_color" [ 0.75 0.5 0.03 ] "float specular_roughness" 0.2
MakeNamedMaterial "plastic" "string type" "openpbr" "rgb base_color" [ 0.012 0.012 0.013 ] "float specular_roughness" 0.3
MakeNamedMaterial "mesh" "string type" "openpbr" "rgb base_color" [ 0.006 0.006 0.006 ] "float specular_roughness" 0.5
MakeNamedMaterial "lining" "string type" "diffuse" "rgb reflectance" [ 0.012 0.012 0.012 ]
MakeNamedMaterial "bowl" "string type" "openpbr" "rgb base_color" [ 0.25 0.25 0.27 ] "float base_metalness" 1 "float specular_roughness" 0.25
AttributeBegin
    Scale 0.007 0.007 0.007
    Texture "grain" "float" "wrinkled" "integer octaves" 4 "float roughness" 0.6
AttributeEnd
Texture "grain height" "float" "scale" "texture tex" "grain" "float scale" 0.0011
MakeNamedMaterial "rubber" "string type" "openpbr" "rgb base_color" [ 0.016 0.016 0.017 ] "float specular_roughness" 0.55
MakeNamedMaterial "leather" "string type" "openpbr" "rgb base_color" [ 0.02 0.019 0.018 ] "float specular_roughness" 0.45 "texture displacement" "grain height"
MakeNamedMaterial "seat leather" "string type" "openpbr" "rgb base_color" [ 0.4 0.2 0.09 ] "float specular_roughness" 0.42 "texture displacement" "grain height"
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flakes_are_tilted_to_all_sides_alike() {
        let file = flakes(128);
        let head = b"PF\n128 128\n-1.0\n".len();
        let normals: Vec<Vec3> = file[head..]
            .chunks_exact(12)
            .map(|pixel| {
                let v = |i: usize| f32::from_le_bytes(pixel[4 * i..4 * i + 4].try_into().unwrap());
                Vec3::new(v(0), v(1), v(2)) * 2.0 - Vec3::ONE
            })
            .collect();
        assert_eq!(normals.len(), 128 * 128);
        assert!(normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3 && n.z > 0.5));
        let mean = normals.iter().fold(Vec3::ZERO, |sum, n| sum + *n) / normals.len() as f32;
        assert!(mean.x.abs() < 0.01 && mean.y.abs() < 0.01 && mean.z > 0.95 && mean.z < 0.995, "{mean}");
    }
}
