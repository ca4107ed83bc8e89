//! Traces as SVG pictures.

use std::fmt::Write;

use math::Vec3;

use super::cutaway::cutaway;
use super::edges::{Edge, EdgeKind};
use super::frame::Frame;
use super::{PixelTrace, TraceStep};
use crate::Job;

/// The width of a drawing in pixels.
const WIDTH: f32 = 960.0;

/// From where a drawing shows the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From the right of the camera, which looks to the right of the drawing.
    Side,
    /// From above; the camera looks up the drawing.
    Top,
    /// As the camera looks.
    Front,
}

impl Side {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Side, Self::Top, Self::Front];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Side => "side",
            Self::Top => "top",
            Self::Front => "front",
        }
    }
}

/// A drawing of a trace over a view of the scene.
pub struct Drawing<'a> {
    trace: &'a PixelTrace,
    edges: Vec<Edge>,
    frame: Frame,
    /// What lies behind the rays.
    picture: String,
}

impl<'a> Drawing<'a> {
    /// Draws the trace of a job from a side; without one, from that on which the rays take the most
    /// space.
    pub fn new(trace: &'a PixelTrace, job: &Job, side: Option<Side>) -> Self {
        let session = &job.session;
        let edges = trace.edges();
        let camera = session.view().camera.transform().camera_from_world(0.0).inverse();
        let axis = |v: Vec3| Vec3::from(camera.transform_vector3(v.as_dvec3()).as_vec3()).normalize_or_zero();
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(axis);
        let frame = |side| match side {
            Side::Side => Frame::around(&edges, [z, -y, -x]),
            Side::Top => Frame::around(&edges, [x, -z, -y]),
            Side::Front => Frame::around(&edges, [x, -y, z]),
        };
        let size = |frame: &Frame| frame.width * frame.height;
        let all = Side::ALL.into_iter().map(frame);
        let largest = all.max_by(|a, b| size(a).total_cmp(&size(b)));
        let frame = side.map(frame).or(largest).unwrap_or_else(|| Frame::around(&edges, [x, -y, z]));
        let height = (WIDTH * frame.height / frame.width).ceil() as u32;
        let picture = cutaway(session.scene(), &frame, [WIDTH as u32 / 2, (height / 2).max(1)]);
        Self { trace, edges, frame, picture }
    }

    /// The drawing as an SVG file: rays of paths are blue, those that leave the scene dashed,
    /// shadow rays that reach a light orange, others grey. Vertices have their numbers in the words
    /// of the trace.
    pub fn to_svg(&self) -> String {
        let height = WIDTH * self.frame.height / self.frame.width;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {WIDTH} {height:.0}\" font-family=\"sans-serif\" font-size=\"14\">\n\
             <title>The rays of pixel {}, {}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
            self.trace.pixel[0], self.trace.pixel[1]
        );
        svg += &format!(
            "<image href=\"{}\" width=\"{WIDTH}\" height=\"{height:.0}\" \
             preserveAspectRatio=\"none\" opacity=\"0.6\"/>\n",
            self.picture
        );
        // Shadow rays are below the paths.
        for is_path in [false, true] {
            let of_path = |edge: &&Edge| matches!(edge.kind, EdgeKind::Path | EdgeKind::Escape);
            for edge in self.edges.iter().filter(|edge| is_path == of_path(edge)) {
                self.line(&mut svg, edge);
            }
        }
        for sample in &self.trace.samples {
            let vertices = sample.steps.iter().filter_map(|step| match step {
                TraceStep::Surface { p, .. } | TraceStep::Medium { p } => Some(*p),
                _ => None,
            });
            for (i, p) in vertices.enumerate() {
                self.vertex(&mut svg, p, &format!("{}", i + 1));
            }
        }
        if let Some(Edge { ends: [eye, _], .. }) = self.edges.first() {
            self.vertex(&mut svg, *eye, "eye");
        }
        svg + "</svg>\n"
    }

    fn line(&self, svg: &mut String, edge: &Edge) {
        let [[x1, y1], [x2, y2]] = edge.ends.map(|p| self.frame.place(p, WIDTH));
        let [r, g, b] = edge.kind.color();
        let (width, dashes) = match edge.kind {
            EdgeKind::Path => (2.5, ""),
            EdgeKind::Escape => (2.5, " stroke-dasharray=\"8 5\""),
            EdgeKind::Light => (1.2, ""),
            EdgeKind::Shadow => (1.2, " stroke-dasharray=\"2 4\""),
        };
        // Writing to a text never fails.
        let _ = writeln!(
            svg,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" \
             stroke=\"rgb({r},{g},{b})\" stroke-width=\"{width}\"{dashes}/>"
        );
    }

    fn vertex(&self, svg: &mut String, p: Vec3, label: &str) {
        let [x, y] = self.frame.place(p, WIDTH);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"rgb(180,20,20)\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{label}</text>",
            x + 7.0,
            y - 7.0
        );
    }
}
