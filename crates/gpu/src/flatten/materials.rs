//! Materials: the kind and six words for each, of which a kind uses some.
//!
//! | kind | words |
//! |---|---|
//! | 0 diffuse | reflectance |
//! | 1 diffuse transmission | reflectance, transmittance, scale |
//! | 2 conductor | η, k, roughness; η is 0 where k is the reflectance |
//! | 3 dielectric | spectrum of η, whether it varies, roughness |
//! | 4 thin dielectric | spectrum of η, whether it varies |
//!
//! Roughness is the last three words: textures along u and v, and 1 where α is the square root.

use description::Span;
use scene::material::{ConductorIndex, Material, Roughness};
use spectrum::Spectrum;

use super::Flattener;

const DIFFUSE: u32 = 0;
const DIFFUSE_TRANSMISSION: u32 = 1;
const CONDUCTOR: u32 = 2;
const DIELECTRIC: u32 = 3;
const THIN_DIELECTRIC: u32 = 4;

impl Flattener<'_> {
    /// The table of materials; its offset. Materials that no geometry has are left empty.
    pub fn materials(&mut self) -> u32 {
        let mut is_used = vec![false; self.scene.materials().len()];
        self.scene.geometries().iter().for_each(|entry| is_used[entry.material.0 as usize] = true);
        let mut rows = Vec::new();
        for (entry, is_used) in self.scene.materials().iter().zip(is_used) {
            if !is_used {
                rows.extend([0; 7]);
                continue;
            }
            if entry.normal_map.is_some() || entry.bump_map.is_some() {
                self.refuse("normal and bump maps", entry.span);
            }
            rows.extend(self.material(&entry.material, entry.span));
        }
        self.slab.add(rows)
    }

    fn material(&mut self, material: &Material, span: Span) -> [u32; 7] {
        let name = match material {
            Material::Diffuse(m) => {
                return [DIFFUSE, self.spectrum_texture(m.reflectance, span), 0, 0, 0, 0, 0];
            }
            Material::DiffuseTransmission(m) => {
                let reflectance = self.spectrum_texture(m.reflectance, span);
                let transmittance = self.spectrum_texture(m.transmittance, span);
                return [DIFFUSE_TRANSMISSION, reflectance, transmittance, m.scale.to_bits(), 0, 0, 0];
            }
            Material::Conductor(m) => {
                let (eta, k) = match m.index {
                    ConductorIndex::Complex { eta, k } => (self.spectrum_texture(eta, span), k),
                    ConductorIndex::Reflectance(reflectance) => (0, reflectance),
                };
                let (k, [u, v, remap]) = (self.spectrum_texture(k, span), self.roughness(&m.roughness, span));
                return [CONDUCTOR, eta, k, 0, u, v, remap];
            }
            Material::Dielectric(m) => {
                let ([eta, varies], [u, v, remap]) = (self.index(&m.eta), self.roughness(&m.roughness, span));
                return [DIELECTRIC, eta, varies, 0, u, v, remap];
            }
            Material::ThinDielectric(m) => {
                let [eta, varies] = self.index(&m.eta);
                return [THIN_DIELECTRIC, eta, varies, 0, 0, 0, 0];
            }
            Material::CoatedDiffuse(_) => "coateddiffuse",
            Material::CoatedConductor(_) => "coatedconductor",
            Material::Hair(_) => "hair",
            Material::Measured(_) => "measured",
            Material::Subsurface(_) => "subsurface",
            Material::OpenPbr(_) => "openpbr",
            Material::Mix(_) => "mix",
            Material::Interface => "interface",
        };
        self.refuse(format!("material `{name}`"), span);
        [0; 7]
    }

    fn roughness(&mut self, roughness: &Roughness, span: Span) -> [u32; 3] {
        let [u, v] = [roughness.u, roughness.v].map(|id| self.number_texture(id, span));
        [u, v, roughness.remap.into()]
    }

    /// An index of refraction, and whether it varies with the wavelength.
    fn index(&mut self, eta: &Spectrum) -> [u32; 2] {
        [self.spectrum(eta), (!matches!(eta, Spectrum::Constant(_))).into()]
    }
}
