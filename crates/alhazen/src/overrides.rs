//! Changes to a scene before it is rendered: the options of the command line.

use std::fmt;

use description::schema::Settings;
use description::{AcceleratorDesc, Diagnostic, FileId, IntegratorDesc, SceneDesc, Span, Spanned};
use film::Layer;

use crate::settings::{self, Unset, applies, called, drawn, integrator_called};

/// Changes to a scene. `None` keeps the value of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The name of the integrator, as in [`integrator_names`](crate::integrator_names). Settings
    /// that both integrators have are kept, all if it is the scene's own.
    pub integrator: Option<String>,
    /// Settings by their names in [`PARTS`](crate::PARTS), with their values as text. `sampler` and
    /// `filter` choose another sampler and another filter.
    pub settings: Vec<(String, String)>,
    /// The name of the acceleration structure: `bvh` or `none`.
    pub accelerator: Option<String>,
    /// Samples per pixel.
    pub samples_per_pixel: Option<u32>,
    /// Width and height of the whole image in pixels.
    pub resolution: Option<[i32; 2]>,
    /// The part to render as fractions `[x0, x1, y0, y1]` of the whole image, y down.
    pub crop: Option<[f32; 4]>,
    /// The one pixel to render, as column and row of the whole image.
    pub pixel: Option<[i32; 2]>,
    /// Seed of all random numbers.
    pub seed: Option<i32>,
    /// The names of layers beside the colour, in addition to the scene's.
    pub layers: Vec<String>,
}

/// A change that is not valid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverrideError(String);

impl fmt::Display for OverrideError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for OverrideError {}

impl Overrides {
    /// These changes for another integrator of the scene, without settings that it does not have.
    pub fn with_integrator(&self, name: &str, desc: &SceneDesc) -> Self {
        let mut overrides = Self { integrator: Some(name.to_owned()), ..self.clone() };
        if let Some(integrator) = integrator_called(name, &desc.integrator) {
            overrides.settings.retain(|(name, _)| applies(name, &integrator));
        }
        overrides
    }

    /// Changes the scene; the first change that is not valid is the error.
    pub fn apply(&self, desc: &mut SceneDesc) -> Result<(), OverrideError> {
        let resolution = desc.film.resolution;
        if let Some(name) = &self.integrator {
            let changed = integrator_called(name, &desc.integrator)
                .ok_or_else(|| unknown("integrator", name, &drawn::<IntegratorDesc>()))?;
            if changed.name() != desc.integrator.name() {
                // Its fault is not one of the scene's statement.
                desc.integrator.origin.span = Span::NONE;
            }
            desc.integrator.value = changed;
        }
        if let Some(name) = &self.accelerator {
            let changed = called(name);
            desc.accelerator.value =
                changed.ok_or_else(|| unknown("accelerator", name, &drawn::<AcceleratorDesc>()))?;
        }
        for (index, (name, value)) in self.settings.iter().enumerate() {
            let span = Span::new(FileId::CALLER, index as u32, index as u32);
            settings::set(desc, name, value, span).map_err(|unset| match unset {
                Unset::Unknown => unknown("setting", name, &settings::keys()),
                Unset::Value(reason) => cannot_set(name, value, &reason),
            })?;
        }
        if let Some(samples) = self.samples_per_pixel {
            if !(1..=i32::MAX as u32).contains(&samples) {
                return Err(OverrideError(format!("samples per pixel are from 1 to {}", i32::MAX)));
            }
            desc.set_samples_per_pixel(samples);
        }
        if let Some(resolution) = self.resolution {
            desc.film.resolution = resolution;
            desc.film.origin.span = Span::NONE;
        }
        import::refit_camera(desc, resolution);
        if let Some(crop) = self.crop {
            desc.film.pixel_bounds = None;
            desc.film.crop_window = Some(crop);
            desc.film.origin.span = Span::NONE;
        }
        if let Some([x, y]) = self.pixel {
            let [width, height] = desc.film.resolution;
            if !((0..width).contains(&x) && (0..height).contains(&y)) {
                return Err(OverrideError(format!(
                    "pixel {x},{y} is not in the image of {width} × {height} pixels"
                )));
            }
            desc.film.pixel_bounds = Some([x, x + 1, y, y + 1]);
            desc.film.crop_window = None;
        }
        for name in &self.layers {
            if Layer::from_name(name).is_none() {
                return Err(unknown("layer", name, &Layer::ALL.map(Layer::name)));
            }
            desc.film.layers.push(Spanned::new(name.clone(), Span::NONE));
        }
        if let Some(seed) = self.seed {
            desc.options.seed = seed;
            desc.sampler.seed = Some(seed);
            desc.integrator.seed_mut().into_iter().for_each(|seed| *seed = None);
        }
        Ok(())
    }

    /// The number of passes of a render that has planned some, `u32::MAX` where it has no limit:
    /// where time or noise ends the render, and no samples per pixel were asked for.
    pub fn passes(&self, planned: u32, ends_otherwise: bool) -> u32 {
        if ends_otherwise && self.samples_per_pixel.is_none() { u32::MAX } else { planned }
    }

    /// The first of these errors of the changed scene that one of the changes has caused.
    pub fn blamed(&self, diagnostics: &[Diagnostic]) -> Option<OverrideError> {
        let errors = diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
        let mut of_caller = errors.filter(|error| error.span().file == FileId::CALLER);
        of_caller.find_map(|error| {
            let (name, value) = self.settings.get(error.span().start as usize)?;
            Some(cannot_set(name, value, &error.message))
        })
    }
}

fn cannot_set(name: &str, value: &str, reason: &str) -> OverrideError {
    OverrideError(format!("cannot set {name} to `{value}`: {reason}"))
}

/// The error of an unknown name, with the nearest known one, or all.
fn unknown(what: &str, name: &str, known: &[&str]) -> OverrideError {
    let instead = match description::closest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there are {}", known.join(", ")),
    };
    OverrideError(format!("no {what} is called `{name}`; {instead}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator_names;
    use description::schema::Value;
    use description::{FilterDesc, LightSamplerDesc, PathDesc, SamplerKind, SppmDesc};

    fn changed(overrides: Overrides) -> Result<SceneDesc, OverrideError> {
        let mut desc = SceneDesc::default();
        overrides.apply(&mut desc).map(|()| desc)
    }

    fn with_settings(settings: &[(&str, &str)]) -> Result<SceneDesc, OverrideError> {
        let settings = settings.iter().map(|&(name, value)| (name.into(), value.into())).collect();
        changed(Overrides { settings, ..Overrides::default() })
    }

    #[test]
    fn another_algorithm_keeps_the_settings_that_it_shares() {
        let mut desc = SceneDesc::default();
        let light_sampler = LightSamplerDesc::Power;
        desc.integrator.value =
            IntegratorDesc::Path(PathDesc { max_depth: 9, regularize: true, light_sampler });
        for name in integrator_names() {
            let mut copy = desc.clone();
            let integrator = Some(name.to_owned());
            Overrides { integrator, ..Overrides::default() }.apply(&mut copy).unwrap();
            for setting in copy.integrator.settings() {
                match setting.field.name {
                    "maxdepth" => assert_eq!(setting.value, Value::Integer(9), "{name}"),
                    "regularize" => assert_eq!(setting.value, Value::Bool(true), "{name}"),
                    _ => (),
                }
            }
        }
        let integrator = Some("volpath".to_owned());
        let desc = changed(Overrides { integrator, ..Overrides::default() }).unwrap();
        assert_eq!(desc.integrator.value, IntegratorDesc::VolPath(PathDesc::default()));
    }

    #[test]
    fn an_accelerator_is_chosen_by_name() {
        let with = |name: &str| changed(Overrides { accelerator: Some(name.into()), ..Overrides::default() });
        assert_eq!(with("none").unwrap().accelerator.value, AcceleratorDesc::None);
        assert_eq!(with("bvh").unwrap().accelerator.value, AcceleratorDesc::default());
        assert_eq!(
            with("grid").unwrap_err().to_string(),
            "no accelerator is called `grid`; there are bvh, none"
        );
    }

    #[test]
    fn settings_reach_the_scene_in_order() {
        let desc =
            with_settings(&[("maxdepth", "3"), ("filter", "box"), ("filterradius", "2"), ("iso", "400")])
                .unwrap();
        assert!(matches!(desc.integrator.value, IntegratorDesc::VolPath(PathDesc { max_depth: 3, .. })));
        assert_eq!(desc.filter.value, FilterDesc::Box { radius: [2.0, 2.0] });
        assert_eq!(desc.film.sensor.iso, 400.0);
    }

    #[test]
    fn invalid_overrides_are_errors() {
        let message = |settings| with_settings(settings).unwrap_err().to_string();
        assert_eq!(
            message(&[("maxdepth", "deep")]),
            "cannot set maxdepth to `deep`: it is a whole number of 0 or more"
        );
        assert!(message(&[("depth", "5")]).starts_with("no setting is called `depth`; there are maxdepth, "));
        assert_eq!(
            message(&[("cossample", "true")]),
            "cannot set cossample to `true`: the scene's integrator has no such setting"
        );
        let pixel = Overrides { pixel: Some([2000, 0]), ..Overrides::default() };
        assert_eq!(
            changed(pixel).unwrap_err().to_string(),
            "pixel 2000,0 is not in the image of 1280 × 720 pixels"
        );
    }

    #[test]
    fn errors_of_what_is_changed_are_not_those_of_the_file() {
        let file = Span::new(FileId(0), 1, 2);
        let mut desc = SceneDesc::default();
        for origin in [&mut desc.camera.origin, &mut desc.film.origin] {
            origin.span = file;
        }
        desc.camera.origin.set_parameter("fov", file);
        let settings = vec![("camera.shutteropen".into(), "1".into())];
        let overrides = Overrides { settings, resolution: Some([9, 9]), ..Overrides::default() };
        overrides.apply(&mut desc).unwrap();
        // Of the shutter nothing is said in the file; the field of view is.
        assert_eq!(desc.camera.origin.parameter("shutterclose").file, FileId::CALLER);
        assert_eq!(desc.camera.origin.parameter("fov"), file);
        assert!(desc.film.origin.span.is_none());
        let errors = film::compile(&desc).map(|_| ()).unwrap_err();
        let blamed = overrides.blamed(&errors).unwrap().to_string();
        assert!(
            blamed.starts_with("cannot set camera.shutteropen to `1`: the shutter is open for 0 s"),
            "{blamed}"
        );
    }

    #[test]
    fn strata_make_the_samples_asked_for() {
        for (samples, strata) in [(1, [1, 1]), (12, [4, 3]), (16, [4, 4]), (17, [17, 1])] {
            let mut desc = with_settings(&[("sampler", "stratified")]).unwrap();
            Overrides { samples_per_pixel: Some(samples), ..Overrides::default() }.apply(&mut desc).unwrap();
            assert!(
                matches!(desc.sampler.kind, SamplerKind::Stratified { strata: found, .. } if found == strata)
            );
        }
    }

    #[test]
    fn size_part_and_seed_replace_those_of_the_scene() {
        let desc = changed(Overrides {
            resolution: Some([100, 50]),
            crop: Some([0.0, 0.5, 0.0, 1.0]),
            pixel: Some([99, 49]),
            seed: Some(7),
            ..Overrides::default()
        });
        let desc = desc.unwrap();
        assert_eq!((desc.film.resolution, desc.film.pixel_bounds), ([100, 50], Some([99, 100, 49, 50])));
        assert_eq!((desc.options.seed, desc.sampler.seed), (7, Some(7)));

        let photons = SppmDesc { seed: Some(3), ..SppmDesc::default() };
        let mut desc = SceneDesc { integrator: IntegratorDesc::Sppm(photons).into(), ..SceneDesc::default() };
        Overrides { seed: Some(7), ..Overrides::default() }.apply(&mut desc).unwrap();
        assert_eq!(desc.integrator.value, IntegratorDesc::Sppm(SppmDesc::default()), "no seed of its own");
    }
}
