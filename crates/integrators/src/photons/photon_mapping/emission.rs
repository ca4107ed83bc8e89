//! Emission of photons.
//!
//! Light subpaths start at lights in proportion to their power and are scattered by BSDF sampling,
//! so that all photons carry about the same power and are dense where light is bright. The photon
//! at the first surface that is not purely specular is direct light if no surface comes before it,
//! and a caustic if specular surfaces do; later photons are indirect light. A body of material
//! `subsurface` stores photons, too, but one with a smooth boundary reflects light as a mirror
//! does. Light that goes under its surface is indirect from there on.

use geometry::RayStats;
use image::require_memory;
use rayon::prelude::*;
use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::ShutterSample;

use crate::bidirectional::{Arrival, Bidirectional, Vertex, Walk};
use crate::transport::Tracer;
use crate::{Cancelled, Control, PassError};

/// Number of subpaths per parallel task.
const CHUNK: u32 = 2048;

/// The photons that a map stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Those from lights that are scattered by specular surfaces only, at least one.
    Caustic,
    /// Those scattered by a surface that is not specular, or from media.
    Indirect,
    /// All.
    All,
}

impl Kind {
    /// Whether to keep a photon, the first of its subpath or not.
    fn keeps(self, vertex: &Vertex, first: bool) -> bool {
        match self {
            Self::Caustic => first && vertex.depth > 1 && !vertex.begins_in_medium,
            Self::Indirect => !first || vertex.begins_in_medium,
            Self::All => true,
        }
    }

    /// The sampler's pixel: one for each kind of map.
    fn pixel(self) -> i32 {
        match self {
            Self::Caustic => 1,
            Self::Indirect | Self::All => 0,
        }
    }
}

/// The emission of a pass.
pub(super) struct Emission<'a> {
    pub paths: &'a Bidirectional<'a>,
    pub shutter: ShutterSample,
    pub seed: u32,
    /// The number of the pass among all of the seed.
    pub generation: u32,
}

impl Emission<'_> {
    /// The values of `keep` for the photons of `paths` subpaths, in path order.
    pub fn emit<T: Send>(
        &self,
        kind: Kind,
        paths: u32,
        control: &Control,
        keep: impl Fn(&Vertex, &mut Tracer) -> T + Sync,
    ) -> Result<(Vec<T>, RayStats), PassError> {
        // A subpath has about two photons, which are copied once.
        require_memory((4 * size_of::<T>()).saturating_mul(paths as usize))?;
        // Stratified over all subpaths of the generation, which decorrelates dimensions.
        let sampler = Sampler::PaddedSobol(PaddedSobol::new(paths, Randomize::FastOwen, self.seed));
        let chunks: Vec<_> = (0..paths.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                control.check()?;
                let (mut kept, mut stats) = (Vec::new(), RayStats::default());
                let mut sampler = sampler.clone();
                let start = chunk * CHUNK;
                for path in start..paths.min(start.saturating_add(CHUNK)) {
                    sampler.start_pixel_sample([self.generation as i32, kind.pixel()], path, 0);
                    let Bidirectional { scene, view, .. } = *self.paths;
                    let mut tracer = Tracer::new(scene, view, control, &mut sampler, &mut stats);
                    self.follow(kind, &mut tracer, |vertex, tracer| kept.push(keep(vertex, tracer)));
                    tracer.finish()?;
                }
                control.count(&stats);
                Ok((kept, stats))
            })
            .collect::<Result<_, Cancelled>>()?;
        let mut all = Vec::with_capacity(chunks.iter().map(|(kept, _)| kept.len()).sum());
        let mut sum = RayStats::default();
        for (kept, stats) in chunks {
            all.extend(kept);
            sum += stats;
        }
        Ok((all, sum))
    }

    /// Samples a subpath as far as it may have photons of the kind.
    fn follow(&self, kind: Kind, tracer: &mut Tracer, mut visit: impl FnMut(&Vertex, &mut Tracer)) {
        let time = self.shutter.time(self.paths.view);
        let Some(mut walk) = Walk::from_light(self.paths, time, self.shutter.lambda, tracer) else {
            return;
        };
        let mut first = true;
        while walk.depth < self.paths.max_depth || walk.is_under_surface() {
            let Arrival::At(mut interaction) = walk.intersect(tracer) else { return };
            let Some(vertex) = walk.arrive(&mut interaction, tracer) else { continue };
            if vertex.takes_photons() && kind.keeps(&vertex, first) {
                visit(&vertex, tracer);
            }
            if vertex.is_connectible() || vertex.is_exit {
                if kind == Kind::Caustic {
                    return;
                }
                first = false;
            }
            if !walk.leave(&vertex, &interaction, tracer) {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bidirectional::{Balance, Lights};
    use crate::photons::photon::Photon;
    use description::{
        AreaLightDesc, MaterialKind, RoughnessDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc,
    };
    use scene::{Scene, View};
    use spectrum::SampledWavelengths;
    use testkit::{Moments, t_test, welch_test};

    /// The inside of an emissive ball of albedo ½, optionally with a ball of glass in it.
    fn furnace(with_glass: bool) -> (Scene, View) {
        let mut desc = SceneDesc::default();
        let ball = |radius: f32| {
            ShapeDesc::from(ShapeKind::Sphere { radius, z_min: -radius, z_max: radius, phi_max: 360.0 })
        };
        let material = Some(desc.materials.push(MaterialKind::Diffuse { reflectance: 0.5.into() }.into()));
        let area_light = Some(desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::Constant(1.0))));
        desc.shapes.push(ShapeDesc { material, area_light, reverse_orientation: true, ..ball(1.0) });
        if with_glass {
            let eta = SpectrumDesc::Constant(1.5);
            let glass = MaterialKind::Dielectric { eta, roughness: RoughnessDesc::default() };
            let material = Some(desc.materials.push(glass.into()));
            desc.shapes.push(ShapeDesc { material, ..ball(0.6) });
        }
        let scene = scene::compile(desc.clone()).expect("a scene").scene;
        let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
        (scene, view)
    }

    const PATHS: u32 = 30_000;

    fn emit(scene: &Scene, view: &View, kind: Kind, max_depth: u32) -> Vec<Photon> {
        let lights = Lights::of(scene, &Control::default()).unwrap();
        let balance = Balance::connecting(1.0);
        let (light_goes_under, regularize) = (true, false);
        let paths =
            Bidirectional { scene, view, lights: &lights, balance, max_depth, light_goes_under, regularize };
        let shutter = ShutterSample::new(view, 0.3, 0.0);
        let emission = Emission { paths: &paths, shutter, seed: 5, generation: 2 };
        let keep = |vertex: &Vertex, _: &mut Tracer| Photon::at(vertex);
        emission.emit(kind, PATHS, &Control::default(), keep).expect("nobody cancels it").0
    }

    /// The power of `photons` over the power of the lights; each subpath has at most one of the
    /// photons.
    fn shares<'a>(scene: &Scene, photons: impl Iterator<Item = &'a Photon>) -> Moments {
        let power = scene.light(scene::light::LightId(0)).phi(&SampledWavelengths::sample_visible(0.3))[0];
        let mut shares: Vec<f64> = photons.map(|photon| f64::from(photon.beta[0] / power)).collect();
        shares.resize(PATHS as usize, 0.0);
        shares.into_iter().collect()
    }

    #[test]
    fn photon_power_falls_with_depth_by_the_albedo() {
        let (scene, view) = furnace(false);
        let photons = emit(&scene, &view, Kind::All, 6);
        assert!(photons.iter().all(|photon| (1..=6).contains(&photon.depth)));
        for depth in 1..=6 {
            let found = shares(&scene, photons.iter().filter(|photon| photon.depth == depth));
            let expected = 0.5f64.powi(depth as i32 - 1);
            if (found.mean - expected).abs() > 1e-6 {
                t_test(&found, expected, 6)
                    .unwrap_or_else(|difference| panic!("depth {depth}: {difference}"));
            }
        }
    }

    #[test]
    fn photon_kinds_are_disjoint_and_complete() {
        let (scene, view) = furnace(true);
        let [all, indirect, caustic] =
            [Kind::All, Kind::Indirect, Kind::Caustic].map(|kind| emit(&scene, &view, kind, 8));
        // The maps of all and of indirect light have the same subpaths.
        let mut rest = indirect.iter().peekable();
        let first: Vec<_> = all.iter().filter(|photon| rest.next_if_eq(photon).is_none()).collect();
        assert!(rest.next().is_none() && !indirect.is_empty());
        assert!(caustic.iter().all(|photon| photon.depth > 1));
        let direct = shares(&scene, first.iter().copied().filter(|photon| photon.depth == 1));
        let expected = shares(&scene, first.iter().copied().filter(|photon| photon.depth > 1));
        assert!(direct.mean > 0.3 && expected.mean > 0.3);
        welch_test(&shares(&scene, caustic.iter()), &expected, 1).unwrap_or_else(|e| panic!("{e}"));
    }
}
