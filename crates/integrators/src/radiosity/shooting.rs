//! Progressive shooting: light leaves the brightest patch first.
//!
//! Of diffuse surfaces, B_i = E_i + ρ_i Σ_j F_ij B_j, where the radiosity B is what leaves an area,
//! the exitance E what leaves it of its own accord. Instead of solving the system at once, the
//! patch l that has most to send sends it: every other one receives
//!
//! ΔB_i = ρ_i B_l F_li A_l / A_i,
//!
//! keeps it, and has that much more to send itself. After each shot there is a picture, and each is
//! better than the last: what is missing is the light that has not been sent yet. Until then an
//! *ambient* term stands for it: the irradiance that unshot power would make if it were spread
//! evenly and reflected with the mean reflectance ρ̄, Φ/A · (1 + ρ̄ + ρ̄² + …). It is shown, never
//! sent, and goes to zero.
//!
//! Unshot light is kept apart by how often it was scattered, so that `max_depth` counts the edges
//! of a path as everywhere: a patch sends what was scattered less than `max_depth` times. One form
//! factor serves for all of it. Lights that are not surfaces (points, distant ones, the
//! environment) shine on every element once, before the first shot, by samples of the light.
//!
//! Where what a shot brings changes by more than a share of the light that is there, elements are
//! cut and the shot is received again: elements get fine at the edges of shadows, as those shots
//! make them that cast the shadows. An edge may pass between the few points of a coarse element,
//! though, and be missed. So where a shot has cut elements, those beside them are cut too, until
//! neighbours differ by one cut at most, and each new element is asked again: edges that were found
//! are followed to where they were missed ([Baum 1991]).
//!
//! Most shots are faint, though, and most patches are far from them: what would bring much less to
//! a patch than the change that is worth a cut, even if nothing were between, is received by the
//! patch as a whole, as if it had not been cut, and handed to its elements later.
//!
//! Sources: [Cohen 1988], [Cohen 1986] for elements.

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
use super::settings::{FormFactors, RadiositySettings};
use super::subdivide::Cut;
use crate::{Cancelled, Control};

/// The part of all light, spread evenly, below which an irradiance is next to nothing.
const FAINT: f32 = 1e-3;

/// The part of the change of light that is worth a cut, below which light comes to patches as if
/// they were not cut.
const UNCUT: f32 = 0.04;

/// The state of a solution.
pub(crate) struct Solution {
    pub wavelengths: Wavelengths,
    pub cut: Cut,
    pub settings: RadiositySettings,
    /// Whether the lights that are no surfaces have shone.
    begun: bool,
    /// Brightness of all light that there is to send.
    total: f32,
    /// How often patches have shot.
    pub shots: u32,
}

impl Solution {
    /// Nothing has been sent yet.
    pub fn new(
        scene: &Scene,
        view: &View,
        settings: &RadiositySettings,
        control: &Control,
    ) -> Result<Self, Cancelled> {
        let wavelengths = Wavelengths::new(!view.options.disable_wavelength_jitter);
        let cut = Cut::new(scene, view, settings, &wavelengths, control)?;
        let settings = settings.clone();
        let begun = settings.max_depth == 0;
        let mut solution = Self { wavelengths, cut, settings, begun, total: 0.0, shots: 0 };
        solution.total = solution.unshot_brightness();
        Ok(solution)
    }

    /// The brightness of what is still to be sent, as a power.
    fn unshot_brightness(&self) -> f32 {
        self.cut.patches.iter().map(|patch| patch.brightness(0) + patch.brightness(1)).sum()
    }

    /// The share of all light that is still to be sent: all of it, as long as it is not known how
    /// much there is.
    pub fn unshot_share(&self) -> f32 {
        match self.total > 0.0 {
            true => self.unshot_brightness() / self.total,
            false => f32::from(u8::from(!self.begun)),
        }
    }

    /// Shoots until no more than a share of all light is left to be sent.
    pub fn shoot(
        &mut self,
        scene: &Scene,
        view: &View,
        share: f32,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let mut stats = RayStats::default();
        if !self.begun {
            self.receive_lights(scene, view, control, &mut stats)?;
            self.begun = true;
        }
        while self.total > 0.0 && self.unshot_share() > share {
            let Some((patch, side)) = self.brightest() else { break };
            self.shoot_from(scene, view, patch, side, control, &mut stats)?;
        }
        self.cut.settle();
        Ok(stats)
    }

    /// The brightness of all light there is to send, spread over all surfaces.
    fn even(&self) -> f32 {
        self.total / self.cut.patches.iter().map(|patch| patch.area).sum::<f32>()
    }

    /// The side of a patch that has most to send.
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

    /// Sends all that one side of a patch has to send.
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
        // What was scattered last before it is scattered for the last time is not sent on.
        let last_layer = self.settings.max_depth as usize - 1;
        let last = layers.get(last_layer).copied().unwrap_or_default();
        let sent_on: Bands = layers.iter().take(last_layer).copied().sum();
        let brightness = self.wavelengths.brightness(&all);
        // What patches receive as wholes.
        let mut wholes = Vec::new();
        let received = match self.settings.form_factors {
            FormFactors::Analytic => {
                let careful = Emitter::new(scene, &self.cut.mesh, &self.cut.patches[source as usize], side);
                let unit = self.even() / brightness;
                let hasty = careful.clone().hastily(FAINT * unit, self.shots);
                let too_little = UNCUT * self.settings.gradient * unit;
                let on_whole = |patch: &Patch, stats: &mut RayStats| {
                    let whole = patch.whole.as_ref().filter(|whole| careful.most_on(whole) <= too_little)?;
                    let is_itself = whole.patch == source;
                    Some(if is_itself {
                        Received::default()
                    } else {
                        careful.shine(scene, whole, time, stats)
                    })
                };
                wholes = each(&self.cut.patches, control, stats, on_whole)?;
                self.receive(scene, view, brightness, &wholes, |cut, ids| {
                    each_element(cut, ids, control, stats, |element, stats| match element.patch == source {
                        // What is bent stands off its chord, and would see it: from behind, as if
                        // it filled the sky.
                        true => Received::default(),
                        false => hasty.shine(scene, element, time, stats),
                    })
                })?
            }
            FormFactors::Hemicube { resolution } => {
                let hemicube = Hemicube::new(resolution, self.shots);
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

    /// Light from lights that are no surfaces, on all elements.
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
        // Once to know how much light there is, and again to see where it changes fast.
        let ids: Vec<u32> = (0..self.cut.elements.len() as u32).collect();
        let power = |element: &Element, stats: &mut RayStats| {
            let brightnesses = shine(element, stats).brightnesses(&wavelengths);
            let sum: f32 = brightnesses.iter().zip(&element.points).map(|(b, point)| b * point.weight).sum();
            element.area * sum
        };
        self.total += each_element(&self.cut, &ids, control, stats, power)?.iter().sum::<f32>();
        let lit =
            self.receive(scene, view, 1.0, &[], |cut, ids| each_element(cut, ids, control, stats, shine))?;
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

    /// Asks all elements what they receive of light of this brightness, and those again that are
    /// cut because of it; but not those of patches that receive it as `wholes`.
    fn receive<T: Arrival>(
        &mut self,
        scene: &Scene,
        view: &View,
        brightness: f32,
        wholes: &[Option<Received>],
        mut answer: impl FnMut(&Cut, &[u32]) -> Result<Vec<T>, Cancelled>,
    ) -> Result<Vec<T>, Cancelled> {
        let even = self.even();
        let mut received = Vec::new();
        let is_asked = |patch: u32| wholes.get(patch as usize).is_none_or(Option::is_none);
        let elements = (0..).zip(&self.cut.elements);
        let mut fresh: Vec<u32> =
            elements.filter(|(_, element)| is_asked(element.patch)).map(|(id, _)| id).collect();
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
                    && contrast > self.settings.gradient * even
                    && contrast > self.settings.gradient * here()
            };
            let mut coarse: Vec<u32> = fresh.iter().copied().filter(is_coarse).collect();
            if coarse.is_empty() && has_cut {
                coarse = self.cut.lagging(scene, &self.settings, is_asked);
            }
            has_cut |= !coarse.is_empty();
            fresh = self.cut.split(scene, view, &self.settings, &self.wavelengths, &coarse);
        }
        Ok(received)
    }

    /// The irradiance that the light still to be sent will make, if it is spread evenly.
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
        // Light that was scattered last counts once; what was scattered less often, as often as it
        // may be scattered yet.
        let mut series = Bands::splat(1.0);
        for layer in (0..self.settings.max_depth as usize).rev() {
            let of_layer = patches.iter().filter_map(|patch| patch.unshot.get(layer));
            let unshot: Bands = of_layer.map(|sides| sides[0] + sides[1]).sum();
            ambient += unshot * series * area.recip();
            series = Bands::splat(1.0) + series * rho;
        }
        ambient
    }

    /// Bytes of memory that patches, elements and the mesh take.
    pub fn bytes(&self) -> usize {
        let patch = |patch: &Patch| {
            let whole = patch.whole.as_ref().map_or(0, |whole| size_of_val(&**whole));
            size_of::<Patch>() + whole + patch.unshot.capacity() * size_of::<[Bands; 2]>()
        };
        let patches: usize = self.cut.patches.iter().map(patch).sum();
        self.cut.mesh.bytes() + patches + size_of_val(&*self.cut.elements)
    }
}

/// The light of a shot, per area of the patch that it leaves.
struct Shot<'a> {
    wavelengths: &'a Wavelengths,
    all: Bands,
    /// That which may be scattered more than once.
    sent_on: Bands,
    /// That which may be scattered once.
    last: Bands,
}

impl Shot<'_> {
    /// Lets light arrive at an element of a patch, which has more to send then, and adds what is
    /// scattered of light of unit radiosity.
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

/// What arrives at an element.
trait Arrival: Clone + Default {
    /// At each quarter, on both sides; of a shot, in parts of its brightness.
    fn brightnesses(&self, wavelengths: &Wavelengths) -> [f32; 4];
}

impl Arrival for Received {
    fn brightnesses(&self, _: &Wavelengths) -> [f32; 4] {
        self.quarters.map(|[outer, inner]| outer + inner)
    }
}

/// Irradiance from lights that are no surfaces, on both sides of each quarter.
#[derive(Clone, Default)]
struct Lit {
    quarters: [[Bands; 2]; 4],
}

impl Arrival for Lit {
    fn brightnesses(&self, wavelengths: &Wavelengths) -> [f32; 4] {
        self.quarters.map(|[outer, inner]| wavelengths.brightness(&(outer + inner)))
    }
}

/// Asks elements by their indices.
fn each_element<T: Send>(
    cut: &Cut,
    ids: &[u32],
    control: &Control,
    stats: &mut RayStats,
    answer: impl Fn(&Element, &mut RayStats) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    each(ids, control, stats, |&id, stats| answer(&cut.elements[id as usize], stats))
}

/// Asks all of them, on all threads.
fn each<I: Sync, T: Send>(
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
