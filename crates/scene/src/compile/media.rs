//! Media and the interfaces between them.

use super::Compiler;
use crate::light::Emission;
use crate::medium::{
    CloudMedium, Coefficients, EmissionSource, Grid, GridEmission, HomogeneousMedium, LargestVoxels,
    MajorantGrid, Medium, MediumId, MediumInterface, MediumKind, NanoVdbMedium, Placement, RgbGridMedium,
    UniformGridMedium, Voxels,
};
use crate::texture::{SpectrumType, color_space, compile_spectrum};
use description::{
    CoefficientsDesc, ColorSpaceDesc, GridDesc, Handle, MediumDesc, MediumKind as Desc, Origin, Stated,
    Substance, TemperatureDesc, VoxelsDesc,
};
use math::{Bounds3, DMat4, DVec3, Point3, Transform, Vec3};
use scattering::HenyeyGreenstein;
use spectrum::{RgbUnboundedSpectrum, Spectrum};
use std::sync::Arc;

/// The asymmetry at which the phase function still has values of single precision.
const LARGEST_G: f32 = 0.99;

impl Compiler<'_> {
    /// Compiles all media, in the order of the scene.
    pub(super) fn media(&mut self) {
        let desc = self.desc;
        for (_, medium) in desc.media.iter() {
            // An error stops the compilation; empty space keeps the indices until then.
            let compiled = self.medium(medium).unwrap_or(Medium {
                kind: MediumKind::Homogeneous(HomogeneousMedium {
                    coefficients: Coefficients {
                        sigma_a: Spectrum::ZERO,
                        sigma_s: Spectrum::ZERO,
                        scale: 0.0,
                    },
                    le: None,
                    le_scale: 0.0,
                }),
                phase: HenyeyGreenstein { g: 0.0 },
            });
            self.media.push(compiled);
        }
    }

    /// `None` after an error.
    fn medium(&mut self, desc: &Stated<MediumDesc>) -> Option<Medium> {
        let origin = &desc.origin;
        let before = self.diagnostics.len();
        if desc.world_from_medium.is_animated() {
            let message = "media do not move; drawn as it is placed at the start";
            self.warn("moving-medium", message, origin.span);
        }
        if !(-1.0..=1.0).contains(&desc.g) {
            let message = format!("`g` is {}; the asymmetry must be between −1 and 1", desc.g);
            self.error("invalid-value", message, origin.parameter("g"));
        }
        let kind = match &desc.kind {
            Desc::Homogeneous { coefficients, le, le_scale } => {
                let coefficients = self.coefficients(coefficients, origin);
                let emission = le.as_ref().and_then(|le| {
                    self.factor("Lescale", *le_scale, origin);
                    self.medium_emission(le, *le_scale, origin)
                });
                let (le, le_scale) =
                    emission.map_or((None, 0.0), |Emission { spectrum, scale }| (Some(spectrum), scale));
                MediumKind::Homogeneous(HomogeneousMedium { coefficients, le, le_scale })
            }
            Desc::UniformGrid { .. } => MediumKind::UniformGrid(Box::new(self.uniform_grid(desc)?)),
            Desc::RgbGrid { .. } => MediumKind::RgbGrid(Box::new(self.rgb_grid(desc)?)),
            Desc::Cloud { bounds, coefficients, density, wispiness, frequency } => {
                let (placement, bounds) = self.placement(bounds, desc)?;
                for (name, value) in
                    [("density", density), ("wispiness", wispiness), ("frequency", frequency)]
                {
                    self.factor(name, *value, origin);
                }
                MediumKind::Cloud(Box::new(CloudMedium {
                    placement,
                    bounds,
                    coefficients: self.coefficients(coefficients, origin),
                    majorants: MajorantGrid::uniform(1.0),
                    density: *density,
                    wispiness: *wispiness,
                    frequency: *frequency,
                    instruction_set: CloudMedium::instruction_set(),
                }))
            }
            Desc::NanoVdb { .. } => MediumKind::NanoVdb(Box::new(self.nano_vdb(desc)?)),
        };
        let has_error = self.diagnostics[before..].iter().any(|diagnostic| diagnostic.is_error());
        let phase = HenyeyGreenstein { g: desc.g.clamp(-LARGEST_G, LARGEST_G) };
        (!has_error).then_some(Medium { kind, phase })
    }

    fn uniform_grid(&mut self, desc: &Stated<MediumDesc>) -> Option<UniformGridMedium> {
        let Desc::UniformGrid {
            bounds,
            coefficients,
            density,
            temperature,
            temperature_scale,
            le,
            le_scale,
            emission_scale,
        } = &desc.kind
        else {
            return None;
        };
        let origin = &desc.origin;
        self.factor("Lescale", *emission_scale, origin);
        let (placement, _) = self.placement(bounds, desc)?;
        let density = self.grid("density", density, origin)?;
        // One factor is a grid of one value, which falls off towards the boundary as all grids do.
        let factor = match le_scale {
            Some(grid) => self.grid("Lescale", grid, origin)?,
            None => Grid::new([1; 3], Arc::from([1.0])),
        };
        let source = match (temperature, le) {
            (Some(values), _) => {
                let temperature = self.temperature(*temperature_scale, origin);
                let values = self.finite_grid("temperature", values, origin)?;
                Some((EmissionSource::Temperature(values, temperature.into()), *emission_scale))
            }
            (None, Some(le)) => self
                .medium_emission(le, *emission_scale, origin)
                .map(|Emission { spectrum, scale }| (EmissionSource::Spectrum(spectrum), scale)),
            (None, None) => None,
        };
        Some(UniformGridMedium {
            placement,
            coefficients: self.coefficients(coefficients, origin),
            majorants: MajorantGrid::new(density.resolution(), |bounds| density.largest(bounds, |d| d)),
            density,
            emission: source.map(|(source, scale)| GridEmission { source, scale, factor }),
        })
    }

    fn rgb_grid(&mut self, desc: &Stated<MediumDesc>) -> Option<RgbGridMedium> {
        let Desc::RgbGrid { bounds, sigma_a, sigma_s, scale, le, le_scale, space } = &desc.kind else {
            return None;
        };
        let origin = &desc.origin;
        self.factor("scale", *scale, origin);
        self.factor("Lescale", *le_scale, origin);
        let (placement, _) = self.placement(bounds, desc)?;
        let mut spectra = |name, grid: &Option<GridDesc<[f32; 3]>>| match grid {
            Some(grid) => self.rgb_values(name, grid, *space, origin).map(Some),
            None => Some(None),
        };
        let (sigma_a, sigma_s) = (spectra("sigma_a", sigma_a)?, spectra("sigma_s", sigma_s)?);
        let le = spectra("Le", le)?;
        let resolution = sigma_a.as_ref().or(sigma_s.as_ref()).map_or([1; 3], Grid::resolution);
        let largest = |grid: &Option<Grid<RgbUnboundedSpectrum>>, bounds| {
            grid.as_ref().map_or(1.0, |grid| grid.largest(bounds, |spectrum| spectrum.max_value()))
        };
        let majorants =
            MajorantGrid::new(resolution, |bounds| largest(&sigma_a, bounds) + largest(&sigma_s, bounds));
        let space = color_space(*space);
        Some(RgbGridMedium {
            placement,
            sigma_a,
            sigma_s,
            scale: *scale,
            majorants,
            le: le.filter(|_| *le_scale > 0.0),
            le_scale: *le_scale,
            space,
        })
    }

    fn nano_vdb(&mut self, desc: &Stated<MediumDesc>) -> Option<NanoVdbMedium> {
        let Desc::NanoVdb { density, temperature, coefficients, temperature_scale, le_scale } = &desc.kind
        else {
            return None;
        };
        let origin = &desc.origin;
        self.factor("Lescale", *le_scale, origin);
        if density.values.iter().any(|d| !(d.is_finite() && *d >= 0.0)) {
            let message = "the densities of a medium must be finite and not negative";
            self.error("invalid-value", message, origin.parameter("filename"));
            return None;
        }
        let [low, high] = density.active.map(|index| DVec3::from_array(index.map(f64::from)));
        let size = high + DVec3::ONE - low;
        let render_from_world = self.render_from_world * desc.world_from_medium.start;
        let index_to_render = |voxels: &VoxelsDesc| {
            let [x, y, z] = voxels.world_from_index;
            render_from_world * DMat4::from_cols_array_2d(&[x, y, z, [0.0, 0.0, 0.0, 1.0]]).transpose()
        };
        let unit = index_to_render(density) * DMat4::from_translation(low) * DMat4::from_scale(size);
        let mut voxels = |values: &VoxelsDesc| {
            let transform = Transform::from_f64(index_to_render(values).inverse());
            if transform.is_none() {
                self.singular("medium", origin);
            }
            Some(Voxels { values: values.clone(), index_from_render: transform? })
        };
        let values = voxels(density)?;
        let temperatures = match temperature {
            Some(values) => Some(voxels(values)?),
            None => None,
        };
        let Some(unit_from_render) = Transform::from_f64(unit.inverse()) else {
            self.singular("medium", origin);
            return None;
        };
        // Bounds are known for each brick, twice as wide as the fewest values of a cell.
        let resolution = size.to_array().map(|n| (n as usize).div_ceil(2));
        let [low, size] = [low, size].map(|v| Vec3::from_array(v.as_vec3().to_array()));
        let largest = LargestVoxels::of(density);
        let majorants = MajorantGrid::new(resolution, |bounds| {
            largest.within(Bounds3::new(low + bounds.min * size, low + bounds.max * size))
        });
        let temperature_scale = self.temperature(*temperature_scale, origin);
        Some(NanoVdbMedium {
            placement: Placement::new(unit_from_render),
            coefficients: self.coefficients(coefficients, origin),
            density: values,
            majorants,
            emission: temperatures
                .filter(|_| *le_scale > 0.0)
                .map(|voxels| (voxels, temperature_scale.into(), *le_scale)),
        })
    }

    /// Coefficients, which must not be negative.
    fn coefficients(&mut self, desc: &CoefficientsDesc, origin: &Origin) -> Coefficients {
        match desc {
            CoefficientsDesc::Preset { name, scale } => {
                self.factor("scale", *scale, origin);
                let Some(Substance { sigma_s, sigma_a }) = Substance::named(name) else {
                    let message = format!("there is no measured substance `{name}`");
                    self.error("invalid-value", message, origin.parameter("preset"));
                    return Coefficients { sigma_a: Spectrum::ZERO, sigma_s: Spectrum::ZERO, scale: 0.0 };
                };
                let srgb = color_space(ColorSpaceDesc::Srgb);
                let [sigma_a, sigma_s] =
                    [sigma_a, sigma_s].map(|rgb| Spectrum::rgb_unbounded(srgb, rgb.into()).to_dense());
                Coefficients { sigma_a, sigma_s, scale: *scale }
            }
            CoefficientsDesc::Given { sigma_a, sigma_s, scale } => {
                self.factor("scale", *scale, origin);
                let [sigma_a, sigma_s] = [("sigma_a", sigma_a), ("sigma_s", sigma_s)].map(|(name, desc)| {
                    let span = origin.parameter(name);
                    let spectrum =
                        compile_spectrum(desc, SpectrumType::Unbounded, span, &mut self.diagnostics)
                            .to_dense();
                    let negative = (360..=830).any(|lambda| spectrum.at(lambda as f32) < 0.0);
                    if negative {
                        let message = format!("`{name}` of a medium must not be negative");
                        self.error("invalid-value", message, span);
                    }
                    spectrum
                });
                Coefficients { sigma_a, sigma_s, scale: *scale }
            }
        }
    }

    /// Emission of the given scale; `None` if it is black.
    fn medium_emission(
        &mut self,
        le: &description::SpectrumDesc,
        scale: f32,
        origin: &Origin,
    ) -> Option<Emission> {
        let emission = self.emission(le, scale, origin.parameter("Le"));
        (emission.scale > 0.0).then_some(emission)
    }

    /// Reports a factor that is negative or not a number.
    fn factor(&mut self, name: &str, value: f32, origin: &Origin) {
        if !(value.is_finite() && value >= 0.0) {
            let message = format!("`{name}` of a medium is {value}; it must be finite and not negative");
            self.error("invalid-value", message, origin.parameter(name));
        }
    }

    fn temperature(&mut self, desc: TemperatureDesc, origin: &Origin) -> TemperatureDesc {
        for (name, value) in [("temperatureoffset", desc.offset), ("temperaturescale", desc.scale)] {
            if !value.is_finite() {
                self.error("invalid-value", format!("`{name}` is {value}"), origin.parameter(name));
            }
        }
        desc
    }

    /// The position of a box in the medium's space.
    fn placement(
        &mut self,
        corners: &[Point3; 2],
        desc: &Stated<MediumDesc>,
    ) -> Option<(Placement, Bounds3)> {
        let bounds = Bounds3::around(*corners);
        let size = bounds.diagonal();
        if !(size.is_finite() && size.x.min(size.y).min(size.z) > 0.0) {
            let message = "the box from `p0` to `p1` of a medium must be finite and have a volume";
            self.error("invalid-value", message, desc.origin.parameter("p1"));
            return None;
        }
        let [low, size] = [bounds.min, size].map(|v| DVec3::from_array(v.to_array().map(f64::from)));
        let render_from_medium = self.render_from_world * desc.world_from_medium.start;
        let render_from_unit = render_from_medium * DMat4::from_translation(low) * DMat4::from_scale(size);
        let Some(unit_from_render) = Transform::from_f64(render_from_unit.inverse()) else {
            self.singular("medium", &desc.origin);
            return None;
        };
        Some((Placement::new(unit_from_render), bounds))
    }

    /// A grid whose values must be finite and not negative.
    fn grid(&mut self, name: &'static str, desc: &GridDesc<f32>, origin: &Origin) -> Option<Grid<f32>> {
        if desc.values.iter().any(|&value| value < 0.0) {
            let message = format!("the values of `{name}` must not be negative");
            self.error("invalid-value", message, origin.parameter(name));
            return None;
        }
        self.finite_grid(name, desc, origin)
    }

    fn finite_grid(
        &mut self,
        name: &'static str,
        desc: &GridDesc<f32>,
        origin: &Origin,
    ) -> Option<Grid<f32>> {
        if desc.values.iter().any(|value| !value.is_finite()) {
            let message = format!("the values of `{name}` must be finite");
            self.error("invalid-value", message, origin.parameter(name));
            return None;
        }
        Some(Grid::new(desc.resolution.map(|n| n as usize), desc.values.clone()))
    }

    /// The spectra of a grid of colours, which must be finite and not negative.
    fn rgb_values(
        &mut self,
        name: &'static str,
        desc: &GridDesc<[f32; 3]>,
        space: ColorSpaceDesc,
        origin: &Origin,
    ) -> Option<Grid<RgbUnboundedSpectrum>> {
        if desc.values.as_flattened().iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
            let message = format!("the values of `{name}` must be finite and not negative");
            self.error("invalid-value", message, origin.parameter(name));
            return None;
        }
        let space = color_space(space);
        let values: Arc<[_]> = desc.values.iter().map(|&rgb| RgbUnboundedSpectrum::new(space, rgb)).collect();
        Some(Grid::new(desc.resolution.map(|n| n as usize), values))
    }

    /// The interface of a shape.
    pub(super) fn medium_interface(
        &self,
        desc: Option<&description::MediumInterface>,
    ) -> Option<MediumInterface> {
        desc.map(|desc| MediumInterface { inside: medium_id(desc.inside), outside: medium_id(desc.outside) })
    }
}

/// The id of a medium of the description.
pub(crate) fn medium_id(handle: Option<Handle<MediumDesc>>) -> Option<MediumId> {
    handle.map(|handle| MediumId(handle.index() as u32))
}
