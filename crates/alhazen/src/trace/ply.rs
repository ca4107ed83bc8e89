//! Traces as PLY files of coloured edges.

use math::Vec3;

use super::PixelTrace;

/// A PLY file in ASCII: two vertices for each ray, and an edge between them. Rays of paths are
/// blue, shadow rays that reach a light orange, others grey.
pub fn to_ply(trace: &PixelTrace) -> String {
    let edges = trace.edges();
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment rays of pixel {} {}\nelement vertex {}\n",
        trace.pixel[0],
        trace.pixel[1],
        2 * edges.len()
    );
    for property in ["float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"] {
        text += &format!("property {property}\n");
    }
    text +=
        &format!("element edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n", edges.len());
    for edge in &edges {
        let [r, g, b] = edge.kind.color();
        for Vec3 { x, y, z } in edge.ends {
            text += &format!("{x} {y} {z} {r} {g} {b}\n");
        }
    }
    for i in 0..edges.len() {
        text += &format!("{} {}\n", 2 * i, 2 * i + 1);
    }
    text
}
