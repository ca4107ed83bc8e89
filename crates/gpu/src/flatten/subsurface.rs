//! Tables of what is scattered under surfaces: one over the share of uniform light that enters, the
//! numbers of albedos and radii, the offset of the gains of rough boundaries for random walks, and
//! the number of rows of what these return. There follow albedos, radii, effective albedos, and a
//! row for each albedo of the profiles and of their integrals; and the rows of what walks return.
//! Gains and rows of walks are there only where they are needed.

use description::Span;
use scattering::{BssrdfTable, PlainBssrdfTable, SubsurfaceMethod};
use scene::material::{SubsurfaceInside, SubsurfaceMaterial};

use super::Flattener;

impl Flattener<'_> {
    /// The words and the textures of a material.
    pub(super) fn subsurface(&mut self, body: &SubsurfaceMaterial, span: Span) -> ([u32; 7], Vec<u32>) {
        self.parts.subsurface = true;
        self.parts.facets = true;
        if self.begins_at_lights {
            self.refuse("light paths under the surface of `subsurface`", span);
        }
        let SubsurfaceMaterial { table, inside, roughness, method } = body;
        let walks = *method == SubsurfaceMethod::RandomWalk;
        let (given, scale, spectra) = match *inside {
            SubsurfaceInside::Coefficients { sigma_a, sigma_s, scale } => (0, scale, [sigma_a, sigma_s]),
            SubsurfaceInside::Reflectance { reflectance, mfp, scale } => (1, scale, [reflectance, mfp]),
        };
        let (remap, mut textures) = self.roughness(roughness, span);
        textures.extend(spectra.map(|id| self.spectrum_texture(id, span)));
        let [scale, eta, g] = [scale, table.eta(), table.g()].map(f32::to_bits);
        let table = self.bssrdf_table(table, walks, given == 1);
        ([remap, table, walks.into(), given, scale, eta, g], textures)
    }

    /// The offset of a table, with the gains of walks, and what these return.
    fn bssrdf_table(&mut self, table: &BssrdfTable, has_gains: bool, has_walks: bool) -> u32 {
        let PlainBssrdfTable { exit_norm, albedos, radii, profile, cdf, effective_albedos } = table.plain();
        let gains = if has_gains { self.slab.add_numbers(table.gains().iter().copied()) } else { 0 };
        let rows = if has_gains && has_walks { table.of_walks() } else { Vec::new() };
        let counts = [albedos.len() as u32, radii.len() as u32, gains, rows.len() as u32];
        let at = self.slab.add([exit_norm.to_bits()].into_iter().chain(counts));
        for numbers in [albedos, radii, effective_albedos, &profile, &cdf] {
            self.slab.extend_numbers(numbers.iter().copied());
        }
        self.slab.extend_numbers(rows.into_iter().flatten().copied());
        at
    }
}
