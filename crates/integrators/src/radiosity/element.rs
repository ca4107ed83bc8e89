//! Elements, which receive light, and patches, which shoot it.
//!
//! A *patch* is a cell of the size given by the settings; it shoots the light that it has received
//! and scattered. An *element* is a leaf of the mesh within a patch; it stores the irradiance of
//! its two sides. Elements may be much finer than patches, as light is shot coarsely and received
//! finely [Cohen 1986].

use geometry::{Hit, SurfacePoint};
use math::{Normal3, Point3, Point3Error, RayDifferential, Vec2};
use sampling::sampler::Independent;
use sampling::{Sampler, warp};
use scattering::{Bsdf, Bxdf, Directions, TransportMode};
use scene::{Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::bands::{Bands, Wavelengths};
use super::domain::Domain;
use super::mesh::{Cell, Mesh};

/// Diffuse reflectance and transmittance of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Albedo {
    pub reflectance: Bands,
    pub transmittance: Bands,
}

impl Albedo {
    /// The exitance of both sides for their irradiance.
    pub fn scatter(&self, sides: &[Bands; 2]) -> [Bands; 2] {
        [0, 1].map(|i| self.reflectance * sides[i] + self.transmittance * sides[1 - i])
    }

    fn scaled(&self, factor: f32) -> Self {
        Self { reflectance: self.reflectance * factor, transmittance: self.transmittance * factor }
    }

    /// The albedo at a surface that `ray` has hit; of a BSDF that is not diffuse, its mean over all
    /// directions. Also applies the normal map. `None` for an interface between media.
    pub fn at(
        scene: &Scene,
        view: &View,
        interaction: &mut SurfaceInteraction,
        ray: &RayDifferential,
        wavelengths: &Wavelengths,
    ) -> Option<Self> {
        // Only used by scenes that force diffuse surfaces.
        let mut sampler = Sampler::Independent(Independent::new(1, 0));
        let pair = wavelengths.sample_pair(|lambda| {
            let bsdf = scene.bsdf(view, interaction, ray, &mut lambda.clone(), &mut sampler)?;
            Some(match bsdf.bxdf {
                Bxdf::Diffuse(bxdf) => [bxdf.reflectance, SampledSpectrum::ZERO],
                Bxdf::DiffuseTransmission(bxdf) => [bxdf.reflectance, bxdf.transmittance],
                _ => mean_albedo(&bsdf),
            })
        });
        pair.map(|[reflectance, transmittance]| Self { reflectance, transmittance })
    }
}

/// ρ_hh by fixed samples, separately for reflection and transmission.
fn mean_albedo(bsdf: &Bsdf<Bxdf>) -> [SampledSpectrum; 2] {
    const STRATA: usize = 4;
    let mut shares = [SampledSpectrum::ZERO; 2];
    for i in 0..STRATA * STRATA {
        let place = |i: usize| (i as f32 + 0.5) / STRATA as f32;
        let (x, y) = (i % STRATA, i / STRATA);
        let wo = bsdf.frame.from_local(warp::sample_cosine_hemisphere(Vec2::new(place(x), place(y))));
        let (uc, u) =
            (place((x + y) % STRATA), Vec2::new(place((x + 2 * y) % STRATA), place((2 * x + y) % STRATA)));
        let Some(sample) = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All) else {
            continue;
        };
        let cos_theta = bsdf.render_to_local(sample.wi).z;
        shares[usize::from(cos_theta < 0.0)] += sample.f * (cos_theta.abs() / sample.pdf);
    }
    shares.map(|share| share.map(|x| (x / (STRATA * STRATA) as f32).min(1.0)))
}

/// A sample point at the centre of a quarter of an element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SamplePoint {
    pub p: Point3Error,
    pub n: Normal3,
    /// The quarter's share of the area.
    pub weight: f32,
}

/// The position of an element in its patch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchPart {
    /// The patch that it is a part of.
    pub patch: u32,
    /// The quarter of that patch in which its middle lies.
    pub quarter: usize,
    /// How often its patch was quartered to make it.
    pub level: u32,
}

/// An element of the mesh, which receives light.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    /// Its leaf cell.
    pub cell: u32,
    /// The patch that it is a part of.
    pub patch: u32,
    /// The quarter of that patch in which its middle lies.
    pub quarter: usize,
    /// How often its patch was quartered to make it.
    pub level: u32,
    pub area: f32,
    pub points: [SamplePoint; 4],
    pub albedo: Albedo,
    /// Irradiance of the outer and the inner side, in each quarter.
    pub quarters: [[Bands; 2]; 4],
    /// The part of the irradiance whose scattering here is the last that `max_depth` allows.
    pub last: [Bands; 2],
}

impl Element {
    /// An element with irradiance 0.
    pub fn new(
        scene: &Scene,
        view: &View,
        mesh: &Mesh,
        wavelengths: &Wavelengths,
        cell: u32,
        place: PatchPart,
    ) -> Self {
        let PatchPart { patch, quarter, level } = place;
        let world = scene.world();
        let leaf = mesh.cell(cell);
        let quarters = leaf.domain().quarters();
        let areas = quarters.each_ref().map(|quarter| mesh.area(world, leaf, quarter));
        let area: f32 = areas.iter().sum();
        let mut albedo = Albedo::default();
        let mut point = |i: usize| {
            let Some(surface) = mesh.surface(world, leaf.primitive, quarters[i].center()) else {
                return SamplePoint { p: Point3Error::exact(Point3::ZERO), n: Normal3::ZERO, weight: 0.0 };
            };
            let weight = if area > 0.0 { areas[i] / area } else { 0.0 };
            let here = albedo_at(scene, view, mesh.primitive(leaf), &surface, wavelengths)
                .unwrap_or_default()
                .scaled(weight);
            albedo.reflectance += here.reflectance;
            albedo.transmittance += here.transmittance;
            SamplePoint { p: surface.p, n: surface.n, weight }
        };
        let points = [point(0), point(1), point(2), point(3)];
        let dark = [Bands::ZERO; 2];
        Self { cell, patch, quarter, level, area, points, albedo, quarters: [dark; 4], last: dark }
    }

    /// Mean irradiance of the outer and the inner side.
    pub fn irradiance(&self) -> [Bands; 2] {
        weighted(&self.quarters, self.points.each_ref().map(|point| point.weight))
    }

    /// Irradiance of its sides at a point, linear over the element. Beyond the centres of the
    /// quarters it is extrapolated, by at most half of the range of their values.
    pub fn irradiance_at(&self, domain: &Domain, uv: Vec2) -> [Bands; 2] {
        let at = weighted(&self.quarters, domain.weights(uv));
        [0, 1].map(|i| {
            let [a, b, c, d] = self.quarters.each_ref().map(|sides| sides[i]);
            let (least, most) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
            let beyond = (most + least * -1.0) * 0.5;
            at[i].max(least + beyond * -1.0).min(most + beyond).max(Bands::ZERO)
        })
    }

    /// Adds the irradiance of a larger element that contains this one.
    pub fn inherit(&mut self, mesh: &Mesh, whole: &Self) {
        let domain = mesh.cell(whole.cell).domain();
        let quarters = mesh.cell(self.cell).domain().quarters();
        let inherited = quarters.map(|quarter| whole.irradiance_at(&domain, quarter.center()));
        let all = weighted(&inherited, self.points.each_ref().map(|point| point.weight));
        let last = whole.last_part();
        for i in 0..2 {
            self.quarters.iter_mut().zip(&inherited).for_each(|(own, light)| own[i] += light[i]);
            self.last[i] += all[i] * last[i];
        }
    }

    /// Resets the irradiance to 0.
    pub fn clear(&mut self) {
        (self.quarters, self.last) = ([[Bands::ZERO; 2]; 4], [Bands::ZERO; 2]);
    }

    /// The distribution of scattered light of the given brightness over the quarters of its patch,
    /// for the light `arrived` in its own quarters.
    pub fn spread(&self, brightness: f32, arrived: [f32; 4]) -> [f32; 4] {
        if self.level > 0 {
            return std::array::from_fn(|quarter| if quarter == self.quarter { brightness } else { 0.0 });
        }
        let parts: [f32; 4] = std::array::from_fn(|k| arrived[k] * self.points[k].weight);
        let sum: f32 = parts.iter().sum();
        parts.map(|part| if sum > 0.0 { brightness * part / sum } else { 0.0 })
    }

    /// The share of the irradiance of its sides whose scattering here is the last.
    pub fn last_part(&self) -> [Bands; 2] {
        let all = self.irradiance();
        [0, 1].map(|i| self.last[i].part_of(all[i]))
    }

    /// The exitance of its two sides in one quarter, without emission, that may be scattered once
    /// more.
    pub fn radiosity(&self, quarter: usize) -> [Bands; 2] {
        let last = self.last_part();
        let going_on = |i: usize| self.quarters[quarter][i] * (Bands::splat(1.0) + last[i] * -1.0);
        self.albedo.scatter(&[0, 1].map(going_on))
    }
}

fn weighted(quarters: &[[Bands; 2]; 4], weights: [f32; 4]) -> [Bands; 2] {
    [0, 1].map(|i| quarters.iter().zip(weights).map(|(sides, weight)| sides[i] * weight).sum())
}

/// The albedo of a primitive at a point, times alpha. `None` for an interface between media.
pub(crate) fn albedo_at(
    scene: &Scene,
    view: &View,
    primitive: &Hit,
    surface: &SurfacePoint,
    wavelengths: &Wavelengths,
) -> Option<Albedo> {
    let ray = RayDifferential::from(surface.spawn_ray(surface.n));
    let mut interaction = scene.interaction(primitive, *surface);
    let coverage = scene.coverage(primitive, surface);
    Some(Albedo::at(scene, view, &mut interaction, &ray, wavelengths)?.scaled(coverage))
}

/// A patch of the mesh, which shoots light.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub cell: u32,
    pub area: f32,
    /// Emitted exitance of its two sides.
    pub emitted: [Bands; 2],
    /// Unshot power of either side, by number of scattering events; missing entries are 0.
    pub unshot: Vec<[Bands; 2]>,
    /// Distribution of the brightness of unshot light over the quarters.
    pub spread: [[f32; 2]; 4],
    /// Which sides have received light.
    pub faced: [bool; 2],
    /// If it is subdivided: the patch as a single element, with the faint light that it received as
    /// a whole.
    pub whole: Option<Box<Element>>,
}

impl Patch {
    /// A patch with all its emission unshot; it shoots light that was scattered less than `depth`
    /// times.
    pub fn new(scene: &Scene, mesh: &Mesh, wavelengths: &Wavelengths, cell: u32, depth: u32) -> Self {
        let area = {
            let leaf = mesh.cell(cell);
            leaf.domain().quarters().iter().map(|quarter| mesh.area(scene.world(), leaf, quarter)).sum()
        };
        let emitted = emission(scene, mesh, mesh.cell(cell), wavelengths);
        let sends = depth > 0 && emitted.iter().any(|side| !side.is_black());
        let unshot = if sends { vec![emitted.map(|side| side * area)] } else { Vec::new() };
        let even = emitted.map(|side| if sends { wavelengths.brightness(&side) * area / 4.0 } else { 0.0 });
        Self { cell, area, emitted, unshot, spread: [even; 4], faced: [false; 2], whole: None }
    }

    /// Adds unshot power of either side that was scattered `scattered` times.
    pub fn add_unshot(&mut self, scattered: usize, power: [Bands; 2]) {
        if self.unshot.len() <= scattered {
            self.unshot.resize(scattered + 1, [Bands::ZERO; 2]);
        }
        (0..2).for_each(|i| self.unshot[scattered][i] += power[i]);
    }

    /// The unshot light of one side in each quarter, relative to the mean.
    pub fn quarter_factors(&self, side: usize) -> [f32; 4] {
        let sum = self.brightness(side);
        self.spread.map(|sides| if sum > 0.0 { 4.0 * sides[side] / sum } else { 1.0 })
    }

    /// Brightness of the unshot power of one side.
    pub fn brightness(&self, side: usize) -> f32 {
        self.spread.iter().map(|sides| sides[side]).sum()
    }
}

/// The radiant exitance of the two sides of a cell, from 64 points.
fn emission(scene: &Scene, mesh: &Mesh, cell: &Cell, wavelengths: &Wavelengths) -> [Bands; 2] {
    let hit = mesh.primitive(cell);
    let at = |uv: Vec2| mesh.surface(scene.world(), cell.primitive, uv);
    let is_light = at(cell.domain().center()).is_some_and(|s| scene.interaction(hit, s).area_light.is_some());
    if !is_light {
        return [Bands::ZERO; 2];
    }
    let quarters = cell.domain().quarters().into_iter().flat_map(|quarter| quarter.quarters());
    let places = quarters.flat_map(|quarter| quarter.quarters());
    let mut sum = [Bands::ZERO; 2];
    for surface in places.filter_map(|place| at(place.center())) {
        let interaction = scene.interaction(hit, surface);
        let scale = scene.coverage(hit, &surface) * std::f32::consts::PI / 64.0;
        for (sum, w) in sum.iter_mut().zip([surface.n, -surface.n]) {
            let emitted = |lambda: &SampledWavelengths| scene.emitted(&interaction, w, lambda);
            *sum += wavelengths.sample(emitted) * scale;
        }
    }
    sum
}
