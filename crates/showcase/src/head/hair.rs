//! Hair of the head, combed back, brows and lashes, as curves.
//!
//! A hair grows step by step in the direction of a field that is tangential to the scalp, at a
//! height of its own over it. Hairs of a clump come together towards their ends.

use std::collections::HashMap;
use std::f32::consts::PI;
use std::fmt::Write as _;

use math::{Vec3, lerp, smooth_step};
use sampling::Rng;

use super::face::{EYE, EYEBALL, lids};
use super::sculpture::Sculpture;
use crate::mesh::Mesh;

/// Steps of a hair.
const STEPS: usize = 6;

/// A hair by the points of its spline, with its width at the root.
pub struct Hair {
    pub points: Vec<Vec3>,
    pub width: f32,
}

/// The height where the hair begins, by the angle about the head: 0 is ahead, π behind.
pub fn hairline(angle: f32) -> f32 {
    const HEIGHTS: [f32; 10] = [68.0, 63.0, 42.0, 8.0, -4.0, 14.0, -12.0, -42.0, -56.0, -58.0];
    let t = angle / PI * 9.0;
    let i = (t as usize).min(8);
    lerp(smooth_step(t - i as f32, 0.0, 1.0), HEIGHTS[i], HEIGHTS[i + 1])
}

/// The angle of a point about the head, from 0 ahead to π behind.
fn angle(p: Vec3) -> f32 {
    p.x.abs().atan2(p.y + 12.0)
}

/// Hairs on the scalp of a mesh.
pub fn scalp(solid: &Sculpture, mesh: &Mesh, count: usize) -> Vec<Hair> {
    let mut rng = Rng::from_sequence(5);
    let is_scalp = |p: Vec3| p.z > hairline(angle(p)) - 4.0 && !solid.is_ear(p);
    let mut areas = Vec::new();
    let (mut faces, mut sum) = (Vec::new(), 0.0_f64);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        if is_scalp(a) {
            sum += f64::from((b - a).cross(c - a).length());
            areas.push(sum);
            faces.push([a, b, c]);
        }
    }
    let mut clumps: HashMap<[i32; 3], Vec<Vec3>> = HashMap::new();
    let mut hairs = Vec::with_capacity(count);
    while hairs.len() < count && !faces.is_empty() {
        let at = sum * f64::from(rng.uniform_f32());
        let [a, b, c] = faces[areas.partition_point(|area| *area <= at).min(faces.len() - 1)];
        let (u, v) = (rng.uniform_f32(), rng.uniform_f32());
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let root = a + (b - a) * u + (c - a) * v;
        // Fewer near the hairline.
        let inside = root.z - hairline(angle(root)) + 3.0 * (rng.uniform_f32() - 0.5);
        if rng.uniform_f32() > smooth_step(inside, -3.0, 6.0) {
            continue;
        }
        let style = Style::at(root, inside, &mut rng);
        let own = grow(solid, root, &style);
        let centre = clump(root);
        let guide = clumps.entry(centre.1).or_insert_with(|| {
            let mut rng = Rng::from_sequence(sampling::hash(&centre.1.map(|c| c as u32)));
            let foot = solid.foot(centre.0);
            grow(solid, foot, &Style::at(foot, 20.0, &mut rng))
        });
        hairs.push(gather(own, guide, root, &mut rng));
    }
    hairs
}

/// How a hair grows.
struct Style {
    length: f32,
    /// How far it is over the scalp.
    height: f32,
    sway: Vec3,
}

impl Style {
    fn at(root: Vec3, inside: f32, rng: &mut Rng) -> Self {
        // Long above, short at the sides and the nape.
        let top = smooth_step(root.z, 10.0, 74.0);
        let vary = 0.72 + 0.5 * rng.uniform_f32();
        let length = lerp(top, 20.0, 84.0) * vary * lerp(smooth_step(inside, 0.0, 22.0), 0.55, 1.0);
        let height = lerp(top, 2.5, 13.0) * (0.15 + 0.85 * rng.uniform_f32());
        let mut way = || rng.uniform_f32() - 0.5;
        Self { length, height, sway: Vec3::new(way(), way(), way()) }
    }
}

/// The middle of the clump of a root, and its number.
fn clump(root: Vec3) -> (Vec3, [i32; 3]) {
    const SIZE: f32 = 7.0;
    let base = (root / SIZE).to_array().map(|v| v.floor() as i32);
    let mut nearest = (f32::INFINITY, root, base);
    for k in 0..27 {
        let cell = [base[0] + k % 3 - 1, base[1] + k / 3 % 3 - 1, base[2] + k / 9 - 1];
        let bits = sampling::hash(&cell.map(|c| c as u32));
        let at = [0, 1, 2].map(|a| cell[a] as f32 + (bits >> (21 * a) & 0xf_ffff) as f32 / (1 << 20) as f32);
        let point = Vec3::from_array(at) * SIZE;
        let distance = point.distance(root);
        if distance < nearest.0 {
            nearest = (distance, point, cell);
        }
    }
    (nearest.1, nearest.2)
}

/// The direction of combing over a point.
fn comb(p: Vec3) -> Vec3 {
    let side = smooth_step(p.x.abs(), 30.0, 70.0) * (1.0 - smooth_step(p.z, 50.0, 90.0));
    let behind = smooth_step(-p.y, 30.0, 95.0);
    let top = Vec3::new(-0.28 + 0.012 * p.x, -1.0, 0.1);
    let beside = Vec3::new(0.0, -0.8, -0.75);
    let low = Vec3::new(-0.004 * p.x, -0.15, -1.0);
    top.lerp(beside, side).lerp(low, behind)
}

/// The points of a hair from its root.
fn grow(solid: &Sculpture, root: Vec3, style: &Style) -> Vec<Vec3> {
    let step = style.length / STEPS as f32;
    let mut points = vec![root];
    let (mut p, mut normal) = (root, solid.scalp_normal(root));
    for i in 1..=STEPS {
        let t = i as f32 / STEPS as f32;
        // Waves across the hair, that those of a clump share.
        let field = comb(p) + style.sway * (0.35 + 0.5 * t);
        let along = (field - normal * field.dot(normal)).normalize_or(Vec3::Z);
        let rise = 0.75 * (1.0 - smooth_step(t, 0.0, 0.6));
        p += (along + normal * rise).normalize_or(normal) * step;
        normal = solid.scalp_normal(p);
        let target = style.height * smooth_step(t, 0.0, 0.5) * (1.0 - 0.25 * t) + 0.3;
        let off = target - solid.scalp_distance(p);
        p += normal * if off > 0.0 { off } else { 0.45 * off };
        points.push(p);
    }
    points
}

/// A hair that comes nearer to the guide of its clump.
fn gather(mut points: Vec<Vec3>, guide: &[Vec3], root: Vec3, rng: &mut Rng) -> Hair {
    let stray = rng.uniform_f32();
    let pull = if stray > 0.94 { 0.1 } else { 0.5 + 0.35 * stray };
    let offset = root - guide[0];
    for (i, (p, centre)) in points.iter_mut().zip(guide).enumerate() {
        let t = i as f32 / STEPS as f32;
        let share = pull * t * t.sqrt();
        *p = p.lerp(*centre + offset * (1.0 - 0.6 * t), share);
    }
    Hair { points: rooted(points), width: 0.075 + 0.03 * rng.uniform_f32() }
}

/// Points of a spline that begins at the first one and ends at the last one.
fn rooted(points: Vec<Vec3>) -> Vec<Vec3> {
    let last = points.len() - 1;
    let before = points[0] * 2.0 - points[1];
    let after = points[last] * 2.0 - points[last - 1];
    [before].into_iter().chain(points).chain([after]).collect()
}

/// Brows over both eyes.
pub fn brows(solid: &Sculpture) -> Vec<Hair> {
    let mut rng = Rng::from_sequence(11);
    let mut hairs = Vec::new();
    for i in 0..1100 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let t = rng.uniform_f32();
        let (u, v) = (rng.uniform_f32() - 0.5, rng.uniform_f32());
        // The line of the brow, and its breadth.
        let x = lerp(t, 12.5, 51.0);
        let z = 18.0 + 9.0 * t - 10.5 * t * t * t;
        let breadth = 5.6 * smooth_step(t, -0.25, 0.2) * (1.0 - 0.8 * smooth_step(t, 0.45, 1.0));
        let foot = solid.front(side * x, z + breadth * u);
        let normal = solid.normal(foot);
        // Upwards near the nose, then outwards and a little down.
        let turn = lerp(smooth_step(t, 0.0, 0.35), 1.15, 0.3) - 0.75 * smooth_step(t, 0.4, 1.0) - 0.7 * u * t;
        let (sin, cos) = lanes::sin_cos(turn + 0.4 * (v - 0.5));
        let way = Vec3::new(side * cos, 0.0, sin);
        let way = (way - normal * way.dot(normal)).normalize_or(Vec3::Z);
        let length = lerp(v, 5.0, 9.0) * lerp(t, 1.0, 0.75);
        let points = (0..4).map(|k| {
            let s = k as f32 / 3.0;
            let p = foot + way * (length * s);
            p + normal * (0.25 + 1.1 * s * (1.0 - 0.6 * s) - 0.9 * solid.distance(p).min(3.0) * s)
        });
        hairs.push(Hair { points: rooted(points.collect()), width: 0.085 });
    }
    hairs
}

/// Lashes of both eyes.
pub fn lashes() -> Vec<Hair> {
    let mut rng = Rng::from_sequence(13);
    let mut hairs = Vec::new();
    for i in 0..520 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let is_upper = i % 3 != 0;
        let (t, v) = (1.9 * rng.uniform_f32() - 0.95, rng.uniform_f32());
        let x = 12.4 * t;
        let [lower, upper] = lids(x);
        let z = if is_upper { upper + 0.3 } else { lower - 0.3 };
        let reach = EYEBALL + 1.3 + 0.5 * v;
        let y = (reach * reach - x * x - z * z).max(0.0).sqrt();
        let foot = Vec3::new(side * (EYE[0] + x), EYE[1] + y, EYE[2] + z);
        // They fan out to the sides and curl.
        let out = Vec3::new(side * (0.75 * t + 0.2), 1.0, 0.0).normalize_or(Vec3::Y);
        let (length, lift) = if is_upper { (lerp(v, 6.0, 9.0), 1.0) } else { (lerp(v, 3.0, 5.0), -0.8) };
        let spread = 0.25 * (rng.uniform_f32() - 0.5);
        let points = (0..4).map(|k| {
            let s = k as f32 / 3.0;
            let bend = lift * (0.75 * s * s - 0.1 * s);
            foot + (out + Vec3::X * spread) * (length * s * (1.0 - 0.2 * s)) + Vec3::Z * (length * bend)
        });
        hairs.push(Hair { points: rooted(points.collect()), width: 0.13 });
    }
    hairs
}

/// Hairs as statements.
pub fn curves(hairs: &[Hair]) -> String {
    let mut text = String::new();
    for Hair { points, width } in hairs {
        let _ = write!(
            text,
            "Shape \"curve\" \"string basis\" \"bspline\" \"integer splitdepth\" 1 \"float width0\" {width:.3} \
             \"float width1\" {:.3} \"point3 P\" [",
            0.35 * width
        );
        for p in points {
            let _ = write!(text, " {:.2} {:.2} {:.2}", p.x, p.y, p.z);
        }
        text += " ]\n";
    }
    text
}

/// Every so many hairs, wider by a factor.
pub fn thinned(hairs: &[Hair], every: usize, wider: f32) -> Vec<Hair> {
    let hairs = hairs.iter().step_by(every);
    hairs.map(|hair| Hair { points: hair.points.clone(), width: wider * hair.width }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::head::{LOW_HIGH, nets};

    #[test]
    fn hairs_grow_out_of_the_scalp_alone() {
        let solid = Sculpture::new();
        let mesh = nets::mesh(&solid, LOW_HIGH, 6.0);
        let hairs = scalp(&solid, &mesh, 300);
        assert_eq!(hairs.len(), 300);
        for hair in &hairs {
            let root = hair.points[1];
            assert!(root.z > hairline(angle(root)) - 6.0, "{root}");
            let inside = hair.points[2..].iter().filter(|p| solid.scalp_distance(**p) < -1.5).count();
            assert!(inside < 2, "{root}");
        }
        assert!(lashes().iter().all(|lash| lash.points[4].y > lash.points[1].y));
    }
}
