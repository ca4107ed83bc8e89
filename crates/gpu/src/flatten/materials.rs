//! Materials: their offsets in a table, and for each the kind, the image of its normals or 0, the
//! texture of its height or 0, the number of its textures, and eight words; then its textures.
//!
//! | kind | words | textures |
//! |---|---|---|
//! | diffuse | | reflectance |
//! | diffuse transmission | scale | reflectance, transmittance |
//! | conductor | remap, 0, 0, 1 where k is the reflectance | roughness along u and v, k, η |
//! | dielectric | remap, spectrum of η, whether it varies | roughness along u and v |
//! | thin dielectric | 0, spectrum of η, whether it varies | |
//! | mix | the two materials | the probability of the second |
//! | principled | offset of its record | numbers and colours |
//! | interface | | |
//! | hair | what absorption is given by, and of pigments the colour space | longitudinal and azimuthal roughness, η, angle of the scales, that of the absorption or both pigments |
//! | measured | offset of its record | |
//! | subsurface | remap, offset of its table, 1 for random walks, 1 where reflectance is given, factor on what is given, η, asymmetry | roughness along u and v; absorption and scattering, or reflectance and mean free path |
//! | coated diffuse, coated conductor | those of the base, η of the coat, remap, mean inner reflectance or −1, events, walks | roughness of the coat along u and v, thickness, asymmetry, albedo; those of the base |
//!
//! Where `remap` is 1, α is the square root of the roughness.

use description::Span;
use scene::GeometryEntry;
use scene::material::{
    BumpMap, Coat, CoatedConductorMaterial, CoatedDiffuseMaterial, ConductorIndex, ConductorMaterial,
    DielectricMaterial, DiffuseMaterial, DiffuseTransmissionMaterial, HairAbsorption, HairMaterial, Material,
    MaterialEntry, MaterialId, MeasuredMaterial, MixMaterial, NormalMap, Roughness, ThinDielectricMaterial,
};
use spectrum::{RgbColorSpace, Spectrum};

use super::Flattener;
use crate::tags::{AbsorptionTag, MaterialTag};

/// The tag, the words and the textures of a material.
type Record = (MaterialTag, [u32; 8], Vec<u32>);

impl Flattener<'_> {
    /// The table of the materials' offsets; its offset, and the kinds of materials that geometries
    /// have, a bit for each. Materials that nothing has are left out.
    pub fn materials(&mut self) -> (u32, u32) {
        let materials = self.scene.materials();
        let mut is_used = vec![false; materials.len()];
        let mut used: Vec<u32> = self.scene.geometries().iter().map(|entry| entry.material.0).collect();
        while let Some(id) = used.pop() {
            if !std::mem::replace(&mut is_used[id as usize], true)
                && let Material::Mix(mix) = &materials[id as usize].material
            {
                used.extend(mix.materials.map(|material| material.0));
            }
        }
        let mut offsets = Vec::new();
        for (entry, is_used) in materials.iter().zip(is_used) {
            offsets.push(if is_used { self.entry(entry) } else { 0 });
        }
        let kind = |entry: &GeometryEntry| {
            let offset: u32 = offsets[entry.material.0 as usize];
            self.slab.word(offset)
        };
        let kinds = self.scene.geometries().iter().fold(0, |kinds, entry| kinds | 1 << kind(entry));
        (self.slab.add(offsets), kinds)
    }

    fn entry(&mut self, entry: &MaterialEntry) -> u32 {
        let &MaterialEntry { ref material, ref normal_map, bump_map, span } = entry;
        let (tag, words, textures) = self.material(material, span);
        let normals = normal_map.as_ref().map_or(0, |map| self.normal_map(map, span));
        let height = bump_map.map_or(0, |BumpMap { displacement }| self.number_texture(displacement, span));
        self.parts.bumps |= normal_map.is_some() || bump_map.is_some();
        let head = [tag as u32, normals, height, textures.len() as u32];
        self.slab.add(head.into_iter().chain(words).chain(textures))
    }

    /// The image of normals.
    pub(super) fn normal_map(&mut self, map: &NormalMap, span: Span) -> u32 {
        let NormalMap { image, lookup } = map;
        self.uv_image(image, lookup, span)
    }

    fn material(&mut self, material: &Material, span: Span) -> Record {
        match material {
            Material::Diffuse(DiffuseMaterial { reflectance }) => {
                (MaterialTag::Diffuse, [0; 8], vec![self.spectrum_texture(*reflectance, span)])
            }
            Material::DiffuseTransmission(DiffuseTransmissionMaterial {
                reflectance,
                transmittance,
                scale,
            }) => {
                let textures = [reflectance, transmittance].map(|id| self.spectrum_texture(*id, span));
                (MaterialTag::DiffuseTransmission, words([scale.to_bits()]), textures.to_vec())
            }
            Material::Conductor(m) => {
                let (remap, is_reflectance, textures) = self.conductor(m, span);
                (MaterialTag::Conductor, words([remap, 0, 0, is_reflectance]), textures)
            }
            Material::Dielectric(DielectricMaterial { eta, roughness }) => {
                self.parts.facets = true;
                let (remap, textures) = self.roughness(roughness, span);
                let [eta, varies] = self.index(eta);
                (MaterialTag::Dielectric, words([remap, eta, varies]), textures)
            }
            Material::ThinDielectric(ThinDielectricMaterial { eta }) => {
                self.parts.facets = true;
                let [eta, varies] = self.index(eta);
                (MaterialTag::ThinDielectric, words([0, eta, varies]), Vec::new())
            }
            Material::Mix(MixMaterial { materials, amount }) => {
                let is_interface = |id: &MaterialId| {
                    matches!(self.scene.materials()[id.0 as usize].material, Material::Interface)
                };
                if materials.iter().any(is_interface) {
                    self.refuse("mixes with material `interface`", span);
                }
                let pair = materials.map(|material| material.0);
                (MaterialTag::Mix, words(pair), vec![self.number_texture(*amount, span)])
            }
            Material::CoatedDiffuse(CoatedDiffuseMaterial {
                base: DiffuseMaterial { reflectance },
                coat,
            }) => {
                let base = vec![self.spectrum_texture(*reflectance, span)];
                self.coated(MaterialTag::CoatedDiffuse, coat, [0, 0], base, span)
            }
            Material::CoatedConductor(CoatedConductorMaterial { base, coat }) => {
                let (remap, is_reflectance, base) = self.conductor(base, span);
                self.coated(MaterialTag::CoatedConductor, coat, [remap, is_reflectance], base, span)
            }
            Material::OpenPbr(m) => {
                let (record, textures) = self.principled(m, span);
                (MaterialTag::Principled, words([record]), textures)
            }
            Material::Interface => (MaterialTag::Interface, [0; 8], Vec::new()),
            Material::Hair(m) => self.hair(m, span),
            Material::Measured(MeasuredMaterial { table }) => {
                self.parts.measured = true;
                (MaterialTag::Measured, words([self.measured(table)]), Vec::new())
            }
            Material::Subsurface(m) => {
                let (given, textures) = self.subsurface(m, span);
                (MaterialTag::Subsurface, words(given), textures)
            }
        }
    }

    fn hair(&mut self, hair: &HairMaterial, span: Span) -> Record {
        self.parts.hair = true;
        let &HairMaterial { absorption, eta, beta_m, beta_n, alpha } = hair;
        let mut textures = [beta_m, beta_n, eta, alpha].map(|id| self.number_texture(id, span)).to_vec();
        let given = match absorption {
            HairAbsorption::Coefficient(sigma_a) => {
                textures.push(self.spectrum_texture(sigma_a, span));
                [AbsorptionTag::Coefficient as u32, 0]
            }
            HairAbsorption::Color(color) => {
                textures.push(self.spectrum_texture(color, span));
                [AbsorptionTag::Color as u32, 0]
            }
            HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                textures.extend([eumelanin, pheomelanin].map(|id| self.number_texture(id, span)));
                [AbsorptionTag::Pigments as u32, self.color_space(RgbColorSpace::srgb())]
            }
        };
        (MaterialTag::Hair, words(given), textures)
    }

    /// A coat over a base, of which two words and the textures are given.
    fn coated(
        &mut self,
        tag: MaterialTag,
        coat: &Coat,
        base: [u32; 2],
        textures: Vec<u32>,
        span: Span,
    ) -> Record {
        self.parts.coats = true;
        let Coat { eta, roughness, thickness, albedo, g, inner, max_depth, samples } = coat;
        let (remap, mut all) = self.roughness(roughness, span);
        all.extend([thickness, g].map(|id| self.number_texture(*id, span)));
        all.push(self.spectrum_texture(*albedo, span));
        all.extend(textures);
        let [eta, varies] = self.index(eta);
        let inner = inner.unwrap_or(-1.0).to_bits();
        (tag, [base[0], eta, varies, base[1], remap, inner, *max_depth, *samples], all)
    }

    /// Of a metal whether α is the square root, whether k is its reflectance, and its textures.
    fn conductor(&mut self, metal: &ConductorMaterial, span: Span) -> (u32, u32, Vec<u32>) {
        self.parts.facets = true;
        let ConductorMaterial { index, roughness } = metal;
        let (remap, mut textures) = self.roughness(roughness, span);
        let (is_reflectance, spectra) = match *index {
            ConductorIndex::Complex { eta, k } => (0, vec![k, eta]),
            ConductorIndex::Reflectance(reflectance) => (1, vec![reflectance]),
        };
        textures.extend(spectra.into_iter().map(|id| self.spectrum_texture(id, span)));
        (remap, is_reflectance, textures)
    }

    /// Whether α is the square root, and the textures of roughness.
    pub(super) fn roughness(&mut self, roughness: &Roughness, span: Span) -> (u32, Vec<u32>) {
        let &Roughness { u, v, remap } = roughness;
        (remap.into(), [u, v].map(|id| self.number_texture(id, span)).to_vec())
    }

    /// An index of refraction, and whether it varies with the wavelength.
    fn index(&mut self, eta: &Spectrum) -> [u32; 2] {
        [self.spectrum(eta), (!matches!(eta, Spectrum::Constant(_))).into()]
    }
}

/// The words of a material, and zeros.
fn words<const N: usize>(first: [u32; N]) -> [u32; 8] {
    std::array::from_fn(|i| first.get(i).copied().unwrap_or(0))
}
