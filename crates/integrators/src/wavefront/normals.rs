//! Shading normals by normal maps and bump maps, before a material is shaded in lanes.

use geometry::PointColumns;
use lanes::{Kernel, Real};
use math::{Frame, face_forward};
use scene::Footprint;
use scene::material::MaterialEntry;
use scene::texture::TextureContext;

use super::indices::Indices;
use super::pass::Pass;
use super::segment_columns::SegmentColumns;

/// Changes the normals and tangents of hits on a material that has a map.
pub(super) struct Perturb<'a, 'b> {
    pub pass: Pass<'a>,
    pub entry: &'a MaterialEntry,
    /// Indices of hits.
    pub hit_indices: &'b [u32],
    pub segments: &'b SegmentColumns,
    /// Their surface points; with shading geometry for a bump map.
    pub points: &'b mut PointColumns,
}

impl Kernel for Perturb<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { pass, entry, hit_indices, segments, points } = self;
        let (scene, view) = (pass.pixels.scene, pass.pixels.view);
        let with_footprints = scene.needs_footprints(view);
        for (part, hit_indices) in hit_indices.chunks(R::LANES).enumerate() {
            let first = part * R::LANES;
            let surface = points.get::<R>(first);
            if let Some(map) = &entry.normal_map {
                let frame = map.rotate(&Frame::from_z_and_x(surface.ns, surface.ss), surface.uv);
                points.set_normals(first, face_forward(frame.z, surface.n), frame.x);
            } else if let Some(map) = &entry.bump_map {
                let footprint = if with_footprints {
                    segments.footprint(view, Indices::first(hit_indices), &surface)
                } else {
                    Footprint::point()
                };
                let context = TextureContext { p: surface.p.p, n: surface.n, uv: surface.uv, footprint };
                let shading = map.perturb(&points.shading(first), &context, scene.textures());
                points.set_normals(first, shading.n, shading.dpdu);
            }
        }
    }
}
