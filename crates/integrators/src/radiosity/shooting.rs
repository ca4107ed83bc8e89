//! Progressive shooting: the brightest patch shoots first.
//!
//! For diffuse surfaces, B_i = E_i + ρ_i Σ_j F_ij B_j, where the radiosity B is the exitance and E
//! its emitted part. The system is solved iteratively. The patch l with the most unshot power
//! shoots it, by which every other patch receives
//!
//! ΔB_i = ρ_i B_l F_li A_l / A_i,
//!
//! and adds it to its unshot light. After each shot the solution is closer to the final one; unshot
//! light is missing. An *ambient* term approximates it: the irradiance of unshot power if it were
//! distributed uniformly and reflected with the mean reflectance ρ̄, Φ/A · (1 + ρ̄ + ρ̄² + …). It
//! is displayed but never shot, and converges to zero.
//!
//! Unshot light is stored by number of scattering events, so that `max_depth` has the same meaning
//! as everywhere: a patch shoots light that was scattered less than `max_depth` times. The same
//! form factor applies to all of it. Irradiance from lights that are not surfaces (points, distant
//! ones, the environment) is computed for every element before the first shot, by light sampling.
//!
//! If the irradiance of a shot varies over an element by more than a share of its total irradiance,
//! the element is subdivided and receives the shot again: elements become fine at the edges of the
//! shadows that the shot casts. The few points of a coarse element may miss an edge, though. So
//! where a shot has subdivided elements, their neighbours are subdivided too, until the levels of
//! neighbours differ by one at most, and each new element receives the shot again: this follows
//! edges to where they were missed ([Baum 1991]).
//!
//! Most shots are faint, and most patches are far from them. If the unoccluded irradiance of a
//! patch is much less than the variation that causes a subdivision, the patch receives it as a
//! single element, and distributes it to its elements later.
//!
//! Sources: [Cohen 1988], [Cohen 1986] for elements.

use description::{FormFactorsDesc, RadiosityDesc};
use geometry::RayStats;
use math::Normal3;
use rayon::prelude::*;
use scene::light::{Light, LightId, LightSampleContext};
use scene::{Scene, View};

use super::bands::{Bands, Wavelengths};
use super::element::{Albedo, Element, Patch};
use super::form_factor::{Emitter, Received};
use super::hemicube::Hemicube;
use super::light_samples::from_light;
use super::subdivide::Cut;
use crate::{Cancelled, Control};

/// Irradiances below this share of the mean exitance of all light count as faint.
const FAINT: f32 = 1e-3;

/// Patches receive irradiances as a single element below this share of the variation that causes a
/// subdivision.
const UNCUT: f32 = 0.04;

/// The state of a solution.
pub(crate) struct Solution {
    pub wavelengths: Wavelengths,
    pub cut: Cut,
    pub settings: RadiosityDesc,
    /// Whether the irradiance from lights that are not surfaces has been added.
    lights_received: bool,
    /// Brightness of the power of all light to be shot.
    total: f32,
    /// Number of shots.
    pub shots: u32,
}

impl Solution {
    /// The solution before the first shot.
    pub fn new(
        scene: &Scene,
        view: &View,
        settings: &RadiosityDesc,
        control: &Control,
    ) -> Result<Self, Cancelled> {
        let wavelengths = Wavelengths::new(view);
        let cut = Cut::new(scene, view, settings, &wavelengths, control)?;
        let settings = settings.clone();
        let lights_received = settings.max_depth == 0;
        let mut solution = Self { wavelengths, cut, settings, lights_received, total: 0.0, shots: 0 };
        solution.total = solution.unshot_brightness();
        Ok(solution)
    }

    /// The brightness of unshot power.
    fn unshot_brightness(&self) -> f32 {
        self.cut.patches.iter().map(|patch| patch.brightness(0) + patch.brightness(1)).sum()
    }

    /// The share of unshot power; 1 as long as the total is unknown.
    pub fn unshot_share(&self) -> f32 {
        match self.total > 0.0 {
            true => self.unshot_brightness() / self.total,
            false => f32::from(u8::from(!self.lights_received)),
        }
    }

    /// Shoots until at most the given share of power is unshot.
    pub fn shoot(
        &mut self,
        scene: &Scene,
        view: &View,
        share: f32,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let mut stats = RayStats::default();
        if !self.lights_received {
            self.receive_lights(scene, view, control, &mut stats)?;
            self.lights_received = true;
        }
        while self.total > 0.0 && self.unshot_share() > share {
            let Some((patch, side)) = self.brightest() else { break };
            self.shoot_from(scene, view, patch, side, control, &mut stats)?;
        }
        self.cut.push_wholes();
        Ok(stats)
    }

    /// The mean exitance of all light to be shot, as brightness.
    fn mean_exitance(&self) -> f32 {
        self.total / self.cut.patches.iter().map(|patch| patch.area).sum::<f32>()
    }

    /// The side of a patch with the most unshot power.
    fn brightest(&self) -> Option<(u32, usize)> {
        let mut best = (0.0, None);
        for (id, patch) in (0..).zip(&self.cut.patches) {
            for side in 0..2 {
                let brightness = patch.brightness(side);
                if brightness > best.0 {
                    best = (brightness, Some((id, side)));
                }
            }
        }
        best.1
    }

    /// Shoots all unshot power of one side of a patch.
    fn shoot_from(
        &mut self,
        scene: &Scene,
        view: &View,
        source: u32,
        side: usize,
        control: &Control,
        stats: &mut RayStats,
    ) -> Result<(), Cancelled> {
        let time = self.cut.mesh.time();
        let Patch { cell, area, ref unshot, .. } = self.cut.patches[source as usize];
        let layers: Vec<Bands> = unshot.iter().map(|sides| sides[side] * area.recip()).collect();
        let all: Bands = layers.iter().copied().sum();
        // Light that has `max_depth` scattering events after this shot is not shot again.
        let last_layer = self.settings.max_depth as usize - 1;
        let last = layers.get(last_layer).copied().unwrap_or_default();
        let sent_on: Bands = layers.iter().take(last_layer).copied().sum();
        let brightness = self.wavelengths.brightness(&all);
        // The irradiances of patches that receive the shot as a single element.
        let mut wholes = Vec::new();
        let received = match self.settings.form_factors {
            FormFactorsDesc::Analytic => {
                let emitter = Emitter::new(scene, &self.cut.mesh, &self.cut.patches[source as usize], side);
                let unit = self.mean_exitance() / brightness;
                let single_rays = emitter.clone().with_single_rays(FAINT * unit, self.shots);
                let too_little = UNCUT * self.settings.gradient * unit;
                let on_whole = |patch: &Patch, stats: &mut RayStats| {
                    let whole = patch.whole.as_ref().filter(|whole| emitter.most_on(whole) <= too_little)?;
                    let is_itself = whole.patch == source;
                    Some(if is_itself {
                        Received::default()
                    } else {
                        emitter.irradiate(scene, whole, time, stats)
                    })
                };
                wholes = par_map(&self.cut.patches, control, stats, on_whole)?;
                self.receive(scene, view, brightness, &wholes, |cut, ids| {
                    par_map_elements(cut, ids, control, stats, |element, stats| {
                        match element.patch == source {
                            // A curved patch is offset from the polygon of its corners, which would
                            // fill a hemisphere of its points.
                            true => Received::default(),
                            false => single_rays.irradiate(scene, element, time, stats),
                        }
                    })
                })?
            }
            FormFactorsDesc::Hemicube => {
                let hemicube = Hemicube::new(self.settings.hemicube_resolution, self.shots);
                let seen = hemicube.cast(scene, &self.cut.mesh, cell, side, control, stats)?;
                self.receive(scene, view, brightness, &wholes, |cut, ids| Ok(seen.received(cut, area, ids)))?
            }
        };
        let Cut { patches, elements, .. } = &mut self.cut;
        patches[source as usize].unshot.iter_mut().for_each(|sides| sides[side] = Bands::ZERO);
        patches[source as usize].spread.iter_mut().for_each(|sides| sides[side] = 0.0);
        let shot = Shot { wavelengths: &self.wavelengths, all, sent_on, last };
        let mut sent = vec![[Bands::ZERO; 2]; patches.len()];
        for (element, received) in elements.iter_mut().zip(&received) {
            let patch = element.patch as usize;
            shot.arrive(element, received, &mut patches[patch], &mut sent[patch]);
        }
        for ((patch, received), sent) in patches.iter_mut().zip(&wholes).zip(&mut sent) {
            if let Some(received) = received
                && let Some(mut whole) = patch.whole.take()
            {
                shot.arrive(&mut whole, received, patch, sent);
                patch.whole = Some(whole);
            }
        }
        let going_on: Vec<_> =
            (1..).zip(layers.iter().take(last_layer)).filter(|(_, layer)| !layer.is_black()).collect();
        for (patch, sent) in patches.iter_mut().zip(&sent).filter(|(_, sent)| **sent != [Bands::ZERO; 2]) {
            for &(scattered, layer) in &going_on {
                patch.add_unshot(scattered, sent.map(|side| side * *layer));
            }
        }
        self.shots += 1;
        Ok(())
    }

    /// Adds the irradiance from lights that are not surfaces to all elements.
    fn receive_lights(
        &mut self,
        scene: &Scene,
        view: &View,
        control: &Control,
        stats: &mut RayStats,
    ) -> Result<(), Cancelled> {
        let lights: Vec<LightId> = (0..scene.lights().len() as u32)
            .map(LightId)
            .filter(|&id| !matches!(scene.light(id).row(), Light::Area(_)) || scene.light(id).is_delta())
            .collect();
        if lights.is_empty() {
            return Ok(());
        }
        let wavelengths = self.wavelengths.clone();
        let time = self.cut.mesh.time();
        let shine = |element: &Element, stats: &mut RayStats| {
            let mut lit = Lit::default();
            for (point, sides) in element.points.iter().zip(&mut lit.quarters) {
                let context = LightSampleContext { p: point.p, n: point.n, ns: Normal3::ZERO, time };
                let arrived =
                    lights.iter().map(|&light| from_light(scene, &wavelengths, light, &context, stats));
                *sides = arrived.fold([Bands::ZERO; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            }
            lit
        };
        // A first evaluation for the total, a second one with subdivision.
        let ids: Vec<u32> = (0..self.cut.elements.len() as u32).collect();
        let power = |element: &Element, stats: &mut RayStats| {
            let brightnesses = shine(element, stats).brightnesses(&wavelengths);
            let sum: f32 = brightnesses.iter().zip(&element.points).map(|(b, point)| b * point.weight).sum();
            element.area * sum
        };
        self.total += par_map_elements(&self.cut, &ids, control, stats, power)?.iter().sum::<f32>();
        let lit = self
            .receive(scene, view, 1.0, &[], |cut, ids| par_map_elements(cut, ids, control, stats, shine))?;
        for (element, lit) in self.cut.elements.iter_mut().zip(&lit) {
            element.quarters = lit.quarters;
            let sides = element.irradiance();
            let scattered = element.albedo.scatter(&sides);
            let patch = &mut self.cut.patches[element.patch as usize];
            (0..2).for_each(|i| patch.faced[i] |= !sides[i].is_black());
            if self.settings.max_depth == 1 {
                element.last = sides;
                continue;
            }
            patch.add_unshot(1, scattered.map(|side| side * element.area));
            for i in 0..2 {
                let brightness = self.wavelengths.brightness(&scattered[i]) * element.area;
                let arrived = lit.brightnesses(&self.wavelengths);
                element
                    .spread(brightness, arrived)
                    .iter()
                    .zip(&mut patch.spread)
                    .for_each(|(b, to)| to[i] += b);
            }
        }
        Ok(())
    }

    /// Evaluates the light of this brightness that elements receive, and again for elements that
    /// are subdivided because of it; except elements of patches that receive it as `wholes`.
    fn receive<T: Arrival>(
        &mut self,
        scene: &Scene,
        view: &View,
        brightness: f32,
        wholes: &[Option<Received>],
        mut answer: impl FnMut(&Cut, &[u32]) -> Result<Vec<T>, Cancelled>,
    ) -> Result<Vec<T>, Cancelled> {
        let mean_exitance = self.mean_exitance();
        let mut received = Vec::new();
        let is_included = |patch: u32| wholes.get(patch as usize).is_none_or(Option::is_none);
        let elements = (0..).zip(&self.cut.elements);
        let mut fresh: Vec<u32> =
            elements.filter(|(_, element)| is_included(element.patch)).map(|(id, _)| id).collect();
        let mut has_cut = false;
        while !fresh.is_empty() {
            received.resize_with(self.cut.elements.len(), T::default);
            let answers = answer(&self.cut, &fresh)?;
            fresh.iter().zip(answers).for_each(|(&id, answer)| received[id as usize] = answer);
            let is_coarse = |&id: &u32| {
                let element = &self.cut.elements[id as usize];
                let quarters = received[id as usize].brightnesses(&self.wavelengths);
                let least = quarters.into_iter().fold(f32::INFINITY, f32::min);
                let most = quarters.into_iter().fold(0.0, f32::max);
                let contrast = (most - least) * brightness;
                let here = || self.wavelengths.brightness(&element.irradiance().into_iter().sum());
                element.level < self.settings.subdivision
                    && contrast > self.settings.gradient * mean_exitance
                    && contrast > self.settings.gradient * here()
            };
            let mut coarse: Vec<u32> = fresh.iter().copied().filter(is_coarse).collect();
            if coarse.is_empty() && has_cut {
                coarse = self.cut.unbalanced(scene, &self.settings, is_included);
            }
            has_cut |= !coarse.is_empty();
            fresh = self.cut.split(scene, view, &self.settings, &self.wavelengths, &coarse);
        }
        Ok(received)
    }

    /// The irradiance of unshot light and its interreflection, if it is distributed uniformly.
    pub fn ambient(&self) -> Bands {
        let faced = |patch: &Patch| patch.faced.iter().filter(|&&faced| faced).count() as f32;
        let patches = &self.cut.patches;
        let (mut area, mut reflecting) = (0.0, Bands::ZERO);
        for element in &self.cut.elements {
            let here = element.area * faced(&patches[element.patch as usize]);
            area += here;
            reflecting += (element.albedo.reflectance + element.albedo.transmittance) * here;
        }
        if area == 0.0 {
            return Bands::ZERO;
        }
        let rho = reflecting * area.recip();
        let mut ambient = Bands::ZERO;
        // The series of reflections ends at the depth limit, so that it is shorter for light that
        // was scattered more often.
        let mut series = Bands::splat(1.0);
        for layer in (0..self.settings.max_depth as usize).rev() {
            let of_layer = patches.iter().filter_map(|patch| patch.unshot.get(layer));
            let unshot: Bands = of_layer.map(|sides| sides[0] + sides[1]).sum();
            ambient += unshot * series * area.recip();
            series = Bands::splat(1.0) + series * rho;
        }
        ambient
    }

    /// Memory of patches, elements and the mesh, in bytes.
    pub fn bytes(&self) -> usize {
        let patch = |patch: &Patch| {
            let whole = patch.whole.as_ref().map_or(0, |whole| size_of_val(&**whole));
            size_of::<Patch>() + whole + patch.unshot.capacity() * size_of::<[Bands; 2]>()
        };
        let patches: usize = self.cut.patches.iter().map(patch).sum();
        self.cut.mesh.bytes() + patches + size_of_val(&*self.cut.elements)
    }
}

/// The radiosity of a shot.
struct Shot<'a> {
    wavelengths: &'a Wavelengths,
    all: Bands,
    /// The part that may be scattered more than once.
    sent_on: Bands,
    /// The part that may be scattered once.
    last: Bands,
}

impl Shot<'_> {
    /// Adds the light that an element of a patch receives to the element, and the scattered power
    /// of a shot of unit radiosity to `sent`.
    fn arrive(&self, element: &mut Element, received: &Received, patch: &mut Patch, sent: &mut [Bands; 2]) {
        let sides = received.sides(element);
        if sides == [0.0; 2] {
            return;
        }
        for (quarter, received) in element.quarters.iter_mut().zip(&received.quarters) {
            for (light, &factor) in quarter.iter_mut().zip(received).filter(|(_, factor)| **factor > 0.0) {
                *light += self.all * factor;
            }
        }
        let arrived = received.quarters.map(|sides| sides[0] + sides[1]);
        for (i, factor) in sides.into_iter().enumerate().filter(|(_, factor)| *factor > 0.0) {
            patch.faced[i] = true;
            element.last[i] += self.last * factor;
            let Albedo { reflectance, transmittance } = &element.albedo;
            for (albedo, side) in [(reflectance, i), (transmittance, 1 - i)] {
                if albedo.is_black() {
                    continue;
                }
                let scattered = *albedo * (factor * element.area);
                sent[side] += scattered;
                let brightness = self.wavelengths.brightness(&(scattered * self.sent_on));
                let spread = element.spread(brightness, arrived);
                spread.iter().zip(&mut patch.spread).for_each(|(b, to)| to[side] += b);
            }
        }
    }
}

/// The irradiance that an element receives.
trait Arrival: Clone + Default {
    /// Brightness of the irradiance of each quarter, summed over both sides; for a shot, relative
    /// to its brightness.
    fn brightnesses(&self, wavelengths: &Wavelengths) -> [f32; 4];
}

impl Arrival for Received {
    fn brightnesses(&self, _: &Wavelengths) -> [f32; 4] {
        self.quarters.map(|[outer, inner]| outer + inner)
    }
}

/// Irradiance from lights that are not surfaces, on both sides of each quarter.
#[derive(Clone, Default)]
struct Lit {
    quarters: [[Bands; 2]; 4],
}

impl Arrival for Lit {
    fn brightnesses(&self, wavelengths: &Wavelengths) -> [f32; 4] {
        self.quarters.map(|[outer, inner]| wavelengths.brightness(&(outer + inner)))
    }
}

/// A parallel map over the elements with the given indices.
fn par_map_elements<T: Send>(
    cut: &Cut,
    ids: &[u32],
    control: &Control,
    stats: &mut RayStats,
    answer: impl Fn(&Element, &mut RayStats) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    par_map(ids, control, stats, |&id, stats| answer(&cut.elements[id as usize], stats))
}

/// A parallel map, which can be cancelled.
fn par_map<I: Sync, T: Send>(
    asked: &[I],
    control: &Control,
    stats: &mut RayStats,
    answer: impl Fn(&I, &mut RayStats) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    let some = |asked: &[I]| {
        let mut stats = RayStats::default();
        let mut answer = |one: &I| {
            control.check()?;
            Ok(answer(one, &mut stats))
        };
        let answers: Vec<T> = asked.iter().map(&mut answer).collect::<Result<_, Cancelled>>()?;
        Ok((answers, stats))
    };
    let answers: Vec<_> = asked.par_chunks(64).map(some).collect::<Result<_, Cancelled>>()?;
    answers.iter().for_each(|(_, some)| *stats += *some);
    Ok(answers.into_iter().flat_map(|(answers, _)| answers).collect())
}
