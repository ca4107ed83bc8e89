//! The paths of a pixel over the picture: their lines as a camera sees them, and what each vertex
//! brings.

use alhazen::math::{DMat4, Vec2, Vec3};
use alhazen::scene::{Scene, View};
use alhazen::trace::{EdgeKind, PixelTrace, SampleTrace, TraceStep};

use crate::Frame;

/// The pieces of a line, each of which is projected apart: some may lie behind the camera.
const PIECES: u32 = 64;

/// Projects points of the world to the film as a picture shows them.
pub struct Projector<'a> {
    render_from_world: DMat4,
    view: &'a View,
    n: f32,
}

impl<'a> Projector<'a> {
    /// For a picture of a scene.
    pub fn new(scene: &Scene, frame: &'a Frame) -> Self {
        let render_from_world = scene.world_from_render().inverse();
        Self { render_from_world, view: &frame.view, n: frame.n as f32 }
    }

    /// The film position of a point in pixels, perhaps beside the film; `None` if the camera does
    /// not see it, for which a `realistic` one is too complex.
    pub fn film(&self, p: Vec3) -> Option<[f32; 2]> {
        let camera = &self.view.camera;
        let p = self.render_from_world.transform_point3(p.as_dvec3()).as_vec3().into();
        let film = camera.sample_wi(p, camera.sample_time(0.5), Vec2::splat(0.5))?.film;
        Some([film.x * self.n, film.y * self.n])
    }

    /// The visible pieces of the rays of a trace.
    pub fn lines(&self, trace: &PixelTrace) -> Vec<([[f32; 2]; 2], EdgeKind)> {
        let mut lines = Vec::new();
        for edge in trace.edges() {
            let [from, to] = edge.ends;
            let point = |i: u32| self.film(from + (to - from) * (i as f32 / PIECES as f32));
            let points: Vec<_> = (0..=PIECES).map(point).collect();
            let pieces = points.windows(2).filter_map(|ends| Some([ends[0]?, ends[1]?]));
            lines.extend(pieces.map(|piece| (piece, edge.kind)));
        }
        lines
    }
}

/// A vertex of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Its number, from 1 on; 0 is the camera.
    pub number: usize,
    /// Its place in the world; none for the camera.
    pub p: Option<Vec3>,
    /// What is there.
    pub what: String,
    /// The colour that the light it receives adds to the sample.
    pub rgb: [f32; 3],
}

/// The vertices of a sample, each with the light that was found there.
pub fn vertices(sample: &SampleTrace) -> Vec<Vertex> {
    let mut vertices = vec![Vertex { number: 0, p: None, what: "camera".into(), rgb: [0.0; 3] }];
    for step in &sample.steps {
        let number = vertices.len();
        match step {
            TraceStep::Surface { p, material, lobes } => {
                let what = format!("{material}: {lobes}");
                vertices.push(Vertex { number, p: Some(*p), what, rgb: [0.0; 3] });
            }
            TraceStep::Medium { p } => {
                vertices.push(Vertex { number, p: Some(*p), what: "medium".into(), rgb: [0.0; 3] });
            }
            TraceStep::Light { rgb, .. } => {
                let last = vertices.last_mut().map(|vertex| &mut vertex.rgb);
                last.into_iter().flatten().zip(rgb).for_each(|(sum, part)| *sum += part);
            }
            TraceStep::Ray { .. } | TraceStep::Shadow { .. } => (),
        }
    }
    vertices
}
