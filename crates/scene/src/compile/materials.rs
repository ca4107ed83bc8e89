//! Materials.

use super::Compiler;
use crate::material::{
    BumpMap, Coat, CoatNormals, CoatedConductorMaterial, CoatedDiffuseMaterial, ConductorIndex,
    ConductorMaterial, DielectricMaterial, DiffuseMaterial, DiffuseTransmissionMaterial, HairAbsorption,
    HairMaterial, Material, MaterialEntry, MaterialId, MeasuredMaterial, MixMaterial, NormalMap,
    OpenPbrMaterial, Roughness, SubsurfaceMaterial, ThinDielectricMaterial,
};
use crate::texture::{SpectrumType, UvLookup, compile_spectrum};
use crate::traits::Occurrence;
use description::{
    ConductorDesc, ConductorReflectance, FloatParameter, HairColor, Handle, LayersDesc, MaterialDesc,
    MaterialKind, OpenPbrDesc, Origin, RoughnessDesc, SpectrumDesc, SpectrumParameter, SubsurfaceScattering,
    UvImageDesc,
};
use scattering::inner_reflectance;
use spectrum::Spectrum;

impl Compiler<'_> {
    /// Compiles all materials in the order of the scene, then the default material.
    pub(super) fn materials(&mut self) {
        let desc = self.desc;
        for (_, material) in desc.materials.iter() {
            let entry = self.material(&material.value, &material.origin);
            self.materials.push(entry);
        }
        let default = self.material(&MaterialDesc::default(), &Origin::default());
        self.materials.push(default);
        for (handle, material) in desc.materials.iter() {
            if self.leads_back(handle) {
                let message = format!("material `{}` is a mix of itself", material.name);
                self.error("material-cycle", message, material.origin.span);
                self.materials[handle.index()].material = Material::Interface;
            }
        }
    }

    /// The id of a shape's material.
    pub(super) fn material_id(&self, handle: Option<Handle<MaterialDesc>>) -> MaterialId {
        MaterialId(handle.map_or(self.materials.len() - 1, Handle::index) as u32)
    }

    /// Records which of the materials in use are not diffuse.
    pub(super) fn material_traits(&mut self) {
        let mut is_used = vec![false; self.materials.len()];
        let mut open: Vec<MaterialId> = self.entries.iter().map(|entry| entry.material).collect();
        while let Some(id) = open.pop() {
            let index = id.0 as usize;
            if !std::mem::replace(&mut is_used[index], true)
                && let Material::Mix(mix) = &self.materials[index].material
            {
                open.extend(mix.materials);
            }
        }
        let found = &mut self.traits.materials_not_diffuse;
        for ((_, material), is_used) in self.desc.materials.iter().zip(is_used) {
            if is_used && !material.kind.is_diffuse() {
                Occurrence::add(found, material.kind.name(), material.origin.span);
            }
        }
    }

    /// Whether a mix refers to itself, directly or through other mixes.
    fn leads_back(&self, start: Handle<MaterialDesc>) -> bool {
        let mut seen = vec![false; self.materials.len()];
        let mut open = vec![start.index()];
        while let Some(index) = open.pop() {
            let Material::Mix(mix) = &self.materials[index].material else { continue };
            for next in mix.materials.map(|id| id.0 as usize) {
                if next == start.index() {
                    return true;
                }
                if !std::mem::replace(&mut seen[next], true) {
                    open.push(next);
                }
            }
        }
        false
    }

    fn material(&mut self, desc: &MaterialDesc, origin: &Origin) -> MaterialEntry {
        let normal_map = self.normal_map(desc.normal_map, "normalmap", origin);
        let material = match &desc.kind {
            MaterialKind::OpenPbr(surface) => self.openpbr(surface, normal_map.clone(), origin),
            kind => self.material_kind(kind, origin),
        };
        let displacement = desc.displacement.as_ref().filter(|_| desc.normal_map.is_none());
        let bump_map = displacement.map(|displacement| BumpMap {
            displacement: self.float_texture(displacement, origin.parameter("displacement")),
        });
        MaterialEntry { material, normal_map, bump_map, span: origin.span }
    }

    fn normal_map(&mut self, map: Option<UvImageDesc>, name: &str, origin: &Origin) -> Option<NormalMap> {
        let map = map?;
        let image = self.desc.images[map.image].image.clone();
        if !image.is_color() {
            self.error("image-channels", "a normal map needs red, green and blue", origin.parameter(name));
            return None;
        }
        Some(NormalMap { image, lookup: UvLookup::new(&map) })
    }

    fn material_kind(&mut self, kind: &MaterialKind, origin: &Origin) -> Material {
        match kind {
            MaterialKind::Diffuse { reflectance } => self.diffuse(reflectance, origin),
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                if !(0.0..f32::INFINITY).contains(scale) {
                    let message = format!("a reflectance cannot be scaled by {scale}");
                    self.error("invalid-value", message, origin.parameter("scale"));
                }
                Material::DiffuseTransmission(DiffuseTransmissionMaterial {
                    reflectance: self.albedo(reflectance, "reflectance", origin),
                    transmittance: self.albedo(transmittance, "transmittance", origin),
                    scale: *scale,
                })
            }
            MaterialKind::Conductor(conductor) => Material::Conductor(self.conductor(conductor, "", origin)),
            MaterialKind::Dielectric { eta, roughness } => Material::Dielectric(DielectricMaterial {
                eta: self.index_of_refraction(eta, "eta", origin),
                roughness: self.roughness(roughness, "", origin),
            }),
            MaterialKind::ThinDielectric { eta } => Material::ThinDielectric(ThinDielectricMaterial {
                eta: self.index_of_refraction(eta, "eta", origin),
            }),
            MaterialKind::Mix { materials, amount } => Material::Mix(MixMaterial {
                materials: materials.map(|handle| MaterialId(handle.index() as u32)),
                amount: self.float_texture(amount, origin.parameter("amount")),
            }),
            MaterialKind::Interface => Material::Interface,
            MaterialKind::CoatedDiffuse(coated) => {
                let base =
                    DiffuseMaterial { reflectance: self.albedo(&coated.reflectance, "reflectance", origin) };
                let coat = self.coat(&coated.eta, &coated.roughness, &coated.layers, "", origin);
                Material::CoatedDiffuse(CoatedDiffuseMaterial { base, coat })
            }
            MaterialKind::CoatedConductor(coated) => {
                let base = self.conductor(&coated.conductor, "conductor.", origin);
                let coat = self.coat(&coated.eta, &coated.roughness, &coated.layers, "interface.", origin);
                Material::CoatedConductor(CoatedConductorMaterial { base, coat })
            }
            MaterialKind::Hair { color, eta, beta_m, beta_n, alpha } => {
                let absorption = match color {
                    HairColor::SigmaA(sigma_a) => HairAbsorption::Coefficient(self.spectrum_texture(
                        sigma_a,
                        SpectrumType::Unbounded,
                        origin.parameter("sigma_a"),
                    )),
                    HairColor::Reflectance(color) => {
                        HairAbsorption::Color(self.albedo(color, "reflectance", origin))
                    }
                    HairColor::Melanin { eumelanin, pheomelanin } => HairAbsorption::Pigments {
                        eumelanin: self.float_texture(eumelanin, origin.parameter("eumelanin")),
                        pheomelanin: self.float_texture(pheomelanin, origin.parameter("pheomelanin")),
                    },
                };
                Material::Hair(HairMaterial {
                    absorption,
                    eta: self.float_texture(eta, origin.parameter("eta")),
                    beta_m: self.float_texture(beta_m, origin.parameter("beta_m")),
                    beta_n: self.float_texture(beta_n, origin.parameter("beta_n")),
                    alpha: self.float_texture(alpha, origin.parameter("alpha")),
                })
            }
            MaterialKind::Subsurface { scattering, scale, eta, g, roughness, method } => {
                let inside = self.subsurface_inside(scattering, *scale, origin);
                let g = if matches!(scattering, SubsurfaceScattering::Named(_)) { 0.0 } else { *g };
                let table = self.bssrdf_table(g, *eta, origin);
                let roughness = self.roughness(roughness, "", origin);
                Material::Subsurface(SubsurfaceMaterial { table, inside, roughness, method: *method })
            }
            MaterialKind::OpenPbr(desc) => self.openpbr(desc, None, origin),
            MaterialKind::Measured { table } => Material::Measured(MeasuredMaterial { table: table.clone() }),
        }
    }

    /// A principled surface with a normal map.
    fn openpbr(&mut self, desc: &OpenPbrDesc, normal_map: Option<NormalMap>, origin: &Origin) -> Material {
        let coat = self.normal_map(desc.geometry_coat_normal, "geometry_coat_normal", origin);
        let normals = CoatNormals::new(coat, normal_map);
        let numbers = std::array::from_fn(|i| {
            let (number, span) =
                (OpenPbrDesc::NUMBERS[i], origin.parameter(OpenPbrDesc::NUMBERS[i].field.name));
            let texture = self.float_texture(&desc.numbers[i], span);
            let [least, most] = number.range;
            if let Some(value) = self.textures.textures().constant(texture)
                && !(least..=most).contains(&value)
            {
                let message = match most {
                    f32::MAX => format!("`{}` cannot be negative, as {value} is", number.field.name),
                    _ => format!(
                        "`{}` lies between {least} and {most}, as {value} does not",
                        number.field.name
                    ),
                };
                self.error("invalid-value", message, span);
            }
            texture
        });
        let colors =
            std::array::from_fn(|i| self.albedo(&desc.colors[i], OpenPbrDesc::COLORS[i].0.name, origin));
        let scale = self.albedo(&desc.subsurface_radius_scale, "subsurface_radius_scale", origin);
        let textures = self.textures.textures();
        let surface = OpenPbrMaterial::new(textures, numbers, colors, scale, desc.thin_walled, normals);
        Material::OpenPbr(Box::new(surface))
    }

    pub(super) fn albedo(
        &mut self,
        parameter: &SpectrumParameter,
        name: &str,
        origin: &Origin,
    ) -> crate::texture::SpectrumTextureId {
        self.spectrum_texture(parameter, SpectrumType::Albedo, origin.parameter(name))
    }

    /// The index of refraction of the parameter `name`.
    fn index_of_refraction(&mut self, eta: &SpectrumDesc, name: &str, origin: &Origin) -> Spectrum {
        let span = origin.parameter(name);
        let is_positive = match eta {
            SpectrumDesc::Constant(value) => *value > 0.0,
            SpectrumDesc::Rgb { rgb, .. } => rgb.iter().any(|&value| value > 0.0),
            SpectrumDesc::Samples(pairs) => pairs.iter().all(|&(_, value)| value > 0.0),
            SpectrumDesc::Named(_) | SpectrumDesc::Blackbody(_) | SpectrumDesc::Illuminant(_) => true,
        };
        if !is_positive {
            self.error("invalid-value", "an index of refraction must be above 0", span);
        }
        compile_spectrum(eta, SpectrumType::Unbounded, span, &mut self.diagnostics)
    }

    fn diffuse(&mut self, reflectance: &SpectrumParameter, origin: &Origin) -> Material {
        Material::Diffuse(DiffuseMaterial { reflectance: self.albedo(reflectance, "reflectance", origin) })
    }

    /// A metal whose parameters have `prefix` before their names.
    fn conductor(&mut self, desc: &ConductorDesc, prefix: &str, origin: &Origin) -> ConductorMaterial {
        let span = |name: &str| origin.parameter(&format!("{prefix}{name}"));
        let index = match &desc.reflectance {
            ConductorReflectance::Index { eta, k } => ConductorIndex::Complex {
                eta: self.spectrum_texture(eta, SpectrumType::Unbounded, span("eta")),
                k: self.spectrum_texture(k, SpectrumType::Unbounded, span("k")),
            },
            ConductorReflectance::Reflectance(reflectance) => {
                ConductorIndex::Reflectance(self.albedo(reflectance, "reflectance", origin))
            }
        };
        ConductorMaterial { index, roughness: self.roughness(&desc.roughness, prefix, origin) }
    }

    /// A coat, of whose surface the parameters have `prefix` before their names.
    fn coat(
        &mut self,
        eta: &SpectrumDesc,
        roughness: &RoughnessDesc,
        layers: &LayersDesc,
        prefix: &str,
        origin: &Origin,
    ) -> Coat {
        let thickness = self.float_texture(&layers.thickness, origin.parameter("thickness"));
        if let Some(value) = self.textures.textures().constant(thickness).filter(|&value| value < 0.0) {
            let message = format!("a thickness cannot be negative, as {value} is");
            self.error("invalid-value", message, origin.parameter("thickness"));
        }
        let g = self.float_texture(&layers.g, origin.parameter("g"));
        if let Some(value) = self.textures.textures().constant(g).filter(|g| !(-1.0..=1.0).contains(g)) {
            let message = format!("an asymmetry lies between −1 and 1, as {value} does not");
            self.error("invalid-value", message, origin.parameter("g"));
        }
        let eta = self.index_of_refraction(eta, &format!("{prefix}eta"), origin);
        let inner = match (&eta, self.textures.textures().constant(thickness)) {
            (&Spectrum::Constant(eta), Some(thickness)) => Some(inner_reflectance(eta, thickness.max(0.0))),
            _ => None,
        };
        Coat {
            eta,
            inner,
            roughness: self.roughness(roughness, prefix, origin),
            thickness,
            albedo: self.albedo(&layers.albedo, "albedo", origin),
            g,
            max_depth: layers.max_depth.max(1) as u32,
            samples: layers.samples.max(1) as u32,
        }
    }

    /// The roughness given by the parameters `roughness`, `uroughness` and `vroughness` with
    /// `prefix` before their names.
    fn roughness(&mut self, desc: &RoughnessDesc, prefix: &str, origin: &Origin) -> Roughness {
        let mut texture = |roughness: &FloatParameter, name: &str| {
            let given = |name: &str| {
                let named = |given: &str| given.strip_prefix(prefix) == Some(name);
                origin.parameters.iter().find(|(given, _)| named(given))
            };
            let span = given(name).or(given("roughness")).map_or(origin.span, |&(_, span)| span);
            let texture = self.float_texture(roughness, span);
            match self.textures.textures().constant(texture) {
                Some(value) if value < 0.0 => {
                    self.error("invalid-value", format!("roughness cannot be negative, as {value} is"), span);
                }
                Some(value) if value > 1.0 => {
                    let message = format!("roughness goes from 0 to 1; {value} is rougher than that");
                    self.warn("roughness-range", message, span);
                }
                _ => (),
            }
            texture
        };
        let u = texture(&desc.u, "uroughness");
        let v = if desc.v == desc.u { u } else { texture(&desc.v, "vroughness") };
        Roughness { u, v, remap: desc.remap }
    }
}
