//! Subdivision: first into patches of one size, then adaptively into elements, where irradiance
//! changes fast.

use description::RadiosityDesc;
use rayon::prelude::*;
use scene::{Scene, View};

use super::bands::Wavelengths;
use super::element::{Element, Patch, PatchPart};
use super::mesh::Mesh;
use crate::{Cancelled, Control};

/// The default size of patches: the radius of the scene over this.
const PATCHES_PER_RADIUS: f32 = 10.0;

/// The scene subdivided into patches and elements.
pub(crate) struct Cut {
    pub mesh: Mesh,
    pub patches: Vec<Patch>,
    pub elements: Vec<Element>,
}

impl Cut {
    /// Subdivides until patches are at most `patch_size` long and nearly flat; each is a single
    /// element. If there are more than `max_patches`, the size is doubled, and so on. At most half
    /// of `max_patches` primitives have patches, so that large ones can always be subdivided.
    pub fn new(
        scene: &Scene,
        view: &View,
        settings: &RadiosityDesc,
        wavelengths: &Wavelengths,
        control: &Control,
    ) -> Result<Self, Cancelled> {
        let max_patches = settings.max_patches as usize;
        let [open, close] = view.camera.shutter();
        let whole = Mesh::new(scene, 0.5 * (open + close), max_patches.div_ceil(2), control)?;
        let mut size = settings.patch_size.unwrap_or(scene.sphere().radius / PATCHES_PER_RADIUS);
        // Patches are at most as large as a square with sides of this length.
        let area = whole.whole_area(scene.world());
        while f64::from(size).powi(2) * (max_patches as f64) < area {
            size *= 2.0;
        }
        let (mut mesh, leaves) = loop {
            match cut(scene, whole.clone(), size, max_patches, control)? {
                Some(cut) => break cut,
                None => size *= 2.0,
            }
        };
        let ids: Vec<(u32, u32)> = (0..).zip(leaves).collect();
        let make = |&(id, cell): &(u32, u32)| {
            control.check()?;
            let patch = Patch::new(scene, &mesh, wavelengths, cell, settings.max_depth);
            let place = PatchPart { patch: id, quarter: 0, level: 0 };
            Ok((patch, Element::new(scene, view, &mesh, wavelengths, cell, place)))
        };
        let made: Vec<(Patch, Element)> = ids.par_iter().map(make).collect::<Result<_, Cancelled>>()?;
        ids.iter().for_each(|&(id, cell)| mesh.set_element(cell, id));
        let (patches, elements) = made.into_iter().unzip();
        Ok(Self { mesh, patches, elements })
    }
}

/// Subdivides the mesh into leaves of a size; `None` if there would be more than `most` by
/// splitting.
fn cut(
    scene: &Scene,
    mut mesh: Mesh,
    size: f32,
    most: usize,
    control: &Control,
) -> Result<Option<(Mesh, Vec<u32>)>, Cancelled> {
    let world = scene.world();
    let mut rest: Vec<u32> = (0..mesh.len() as u32).rev().collect();
    let mut leaves = Vec::new();
    let mut splits = false;
    while let Some(cell) = rest.pop() {
        control.check()?;
        let length = mesh.size(world, cell);
        // Curved cells are split down to a minimum size.
        let is_bent = length > size * BENT_PART && mesh.is_bent(world, cell);
        if length > size || is_bent {
            let first = mesh.split(world, cell);
            rest.extend([first + 1, first]);
            splits = true;
        } else {
            leaves.push(cell);
        }
        if splits && leaves.len() + rest.len() > most {
            return Ok(None);
        }
    }
    Ok(Some((mesh, leaves)))
}

/// The minimum size of curved cells, as a share of the patch size.
const BENT_PART: f32 = 0.05;

impl Cut {
    /// Distributes the light that patches received as a single element to their elements.
    pub fn push_wholes(&mut self) {
        let Self { mesh, patches, elements } = self;
        elements.par_iter_mut().for_each(|element| {
            if let Some(whole) = &patches[element.patch as usize].whole {
                element.inherit(mesh, whole);
            }
        });
        patches.iter_mut().filter_map(|patch| patch.whole.as_mut()).for_each(|whole| whole.clear());
    }

    /// Elements of these patches with neighbours that are finer by more than one level. The cause,
    /// such as the edge of a shadow, may extend into the coarse element and be missed by its few
    /// points.
    pub fn unbalanced(
        &self,
        scene: &Scene,
        settings: &RadiosityDesc,
        is_included: impl Fn(u32) -> bool + Sync,
    ) -> Vec<u32> {
        let lags = |&id: &u32| {
            let element = &self.elements[id as usize];
            is_included(element.patch)
                && element.level < settings.subdivision
                && self.mesh.is_beside_finer(scene.world(), self.mesh.cell(element.cell))
        };
        (0..self.elements.len() as u32).into_par_iter().filter(lags).collect()
    }

    /// Halves elements twice, up to the maximum number of elements. The parts inherit the light of
    /// the whole. Returns the parts.
    pub fn split(
        &mut self,
        scene: &Scene,
        view: &View,
        settings: &RadiosityDesc,
        wavelengths: &Wavelengths,
        coarse: &[u32],
    ) -> Vec<u32> {
        let room = (settings.max_patches as usize).saturating_sub(self.elements.len());
        let world = scene.world();
        let mut parts = Vec::new();
        for &id in coarse.iter().take(room / 3) {
            let first = self.mesh.split(world, self.elements[id as usize].cell);
            for half in [first, first + 1] {
                let quarter = self.mesh.split(world, half);
                parts.extend([(id, quarter), (id, quarter + 1)]);
            }
        }
        let mesh = &self.mesh;
        let make = |&(whole, cell): &(u32, u32)| {
            let whole = &self.elements[whole as usize];
            let center = mesh.cell(cell).domain().center();
            let quarter_of = |cell: u32| mesh.cell(cell).domain().quarter_of(center);
            let quarter = quarter_of(self.patches[whole.patch as usize].cell);
            let place = PatchPart { patch: whole.patch, quarter, level: whole.level + 1 };
            let mut part = Element::new(scene, view, mesh, wavelengths, cell, place);
            part.inherit(mesh, whole);
            part
        };
        let made: Vec<Element> = parts.par_iter().map(make).collect();
        let mut changed = Vec::with_capacity(made.len());
        for (i, ((whole, cell), element)) in parts.into_iter().zip(made).enumerate() {
            // The first part replaces the whole.
            let id = if i % 4 == 0 { whole } else { self.elements.len() as u32 };
            if i % 4 == 0 {
                let mut whole = std::mem::replace(&mut self.elements[id as usize], element);
                if whole.level == 0 {
                    whole.clear();
                    let patch = &mut self.patches[whole.patch as usize];
                    patch.whole = Some(Box::new(whole));
                }
            } else {
                self.elements.push(element);
            }
            self.mesh.set_element(cell, id);
            changed.push(id);
        }
        changed
    }
}
