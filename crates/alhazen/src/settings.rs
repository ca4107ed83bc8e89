//! Settings of a scene by name, in any part of the scene.

use description::schema::{Member, Setting, Settings};
use description::{
    AcceleratorDesc, CameraDesc, FilmDesc, FilterDesc, IntegratorDesc, OptionsDesc, Origin, SamplerDesc,
    SamplerKind, SceneDesc, Span, Stated,
};

/// A part of a scene that has settings.
pub struct Part {
    /// Its name. Where settings of several parts share a name, `part.name` says which one is meant.
    pub name: &'static str,
    members: fn() -> Vec<Group>,
    of: fn(&mut SceneDesc) -> (&mut dyn Settings, &mut Origin),
}

/// Settings that belong together, with their defaults.
pub struct Group {
    /// The member of a set that has them; `None` of settings that all members have.
    pub member: Option<&'static Member>,
    /// The settings.
    pub settings: Vec<Setting>,
}

/// The parts of a scene that have settings.
pub static PARTS: [Part; 7] = [
    Part { name: "integrator", members: members::<IntegratorDesc>, of: |desc| split(&mut desc.integrator) },
    Part { name: "sampler", members: members::<SamplerDesc>, of: |desc| split(&mut desc.sampler) },
    Part { name: "filter", members: members::<FilterDesc>, of: |desc| split(&mut desc.filter) },
    Part { name: "film", members: members::<FilmDesc>, of: |desc| split(&mut desc.film) },
    Part { name: "camera", members: members::<CameraDesc>, of: |desc| split(&mut desc.camera) },
    Part {
        name: "accelerator",
        members: members::<AcceleratorDesc>,
        of: |desc| split(&mut desc.accelerator),
    },
    Part { name: "options", members: members::<OptionsDesc>, of: |desc| split(&mut desc.options) },
];

fn members<T: Settings + Clone + Default>() -> Vec<Group> {
    T::members().iter().map(|desc| Group { member: desc.member(), settings: desc.settings() }).collect()
}

fn split<T: Settings>(stated: &mut Stated<T>) -> (&mut dyn Settings, &mut Origin) {
    (&mut stated.value, &mut stated.origin)
}

impl Part {
    /// The settings that all members of the set have, then the further ones of each member that can
    /// be chosen.
    pub fn groups(&self) -> Vec<Group> {
        let mut groups = (self.members)();
        let has = |group: &Group, shared: &Setting| group.settings.iter().any(|setting| setting == shared);
        let mut common = groups.first().map_or(Vec::new(), |first| first.settings.clone());
        common.retain(|setting| groups.iter().all(|group| has(group, setting)));
        groups.retain(|group| group.member.is_some_and(|member| member.is_drawn));
        for group in &mut groups {
            group.settings.retain(|setting| !common.contains(setting));
        }
        groups.insert(0, Group { member: None, settings: common });
        groups
    }

    fn has(&self, name: &str) -> bool {
        (self.members)().iter().flat_map(|group| &group.settings).any(|setting| setting.field.is_called(name))
    }
}

/// The names of the integrators that can be chosen.
pub fn integrator_names() -> Vec<&'static str> {
    drawn::<IntegratorDesc>()
}

/// The names of the members of a set that can be chosen.
pub(crate) fn drawn<T: Settings + Default>() -> Vec<&'static str> {
    let members = T::members();
    let drawn = members.iter().filter_map(Settings::member).filter(|member| member.is_drawn);
    drawn.map(|member| member.names[0]).collect()
}

/// The member of a set that has the name, with default settings, if it can be chosen.
pub(crate) fn called<T: Settings + Default>(name: &str) -> Option<T> {
    T::called(name).filter(|desc| desc.member().is_some_and(|member| member.is_drawn))
}

/// The integrator called `name`: `current` if it is that, else one that has those settings of
/// `current` that both have and that are not at their defaults.
pub(crate) fn integrator_called(name: &str, current: &IntegratorDesc) -> Option<IntegratorDesc> {
    let mut integrator: IntegratorDesc = called(name)?;
    if integrator.name() == current.name() {
        return Some(current.clone());
    }
    let unchanged = IntegratorDesc::called(current.name()).map_or(Vec::new(), |desc| desc.settings());
    for (setting, default) in current.settings().iter().zip(unchanged) {
        if setting.value != default.value {
            integrator.visit(&mut |field, slot| {
                let old = setting.field;
                if field.is_called(old.name) || old.is_called(field.name) {
                    // A value that is invalid here is not shared.
                    let _ = field.assign(slot, &setting.value);
                }
            });
        }
    }
    Some(integrator)
}

/// The part that has the setting `key`, and the name of the setting there. Of parts with settings
/// of the same name it is the first, whichever of its members the scene has.
fn find(key: &str) -> Option<(&'static Part, &str)> {
    if let Some((part, name)) = key.split_once('.') {
        let part = PARTS.iter().find(|known| known.name == part)?;
        return part.has(name).then_some((part, name));
    }
    PARTS.iter().find(|part| part.has(key)).map(|part| (part, key))
}

/// All valid keys: settings, and the sets from which sampler and filter are chosen.
pub(crate) fn keys() -> Vec<&'static str> {
    let settings = PARTS.iter().flat_map(|part| (part.members)()).flat_map(|group| group.settings);
    let mut keys = Vec::new();
    for field in settings.map(|setting| setting.field) {
        for &name in [field.name].iter().chain(field.aliases) {
            if !keys.contains(&name) {
                keys.push(name);
            }
        }
    }
    keys.extend(["sampler", "filter"]);
    keys
}

/// Whether the setting is one of a scene with that integrator.
pub(crate) fn applies(key: &str, integrator: &IntegratorDesc) -> bool {
    match find(key) {
        Some((part, name)) if part.name == "integrator" => {
            integrator.settings().iter().any(|setting| setting.field.is_called(name))
        }
        _ => true,
    }
}

/// Why a setting was not set.
#[derive(Debug, PartialEq)]
pub(crate) enum Unset {
    /// There is no such setting.
    Unknown,
    /// What is wrong with the value.
    Value(String),
}

/// Sets `key`. Later errors about it are reported at `span`.
pub(crate) fn set(desc: &mut SceneDesc, key: &str, text: &str, span: Span) -> Result<(), Unset> {
    let no_member = |known: Vec<&str>| Unset::Value(format!("it is one of {}", known.join(", ")));
    match key {
        "sampler" => {
            let mut kind: SamplerKind = called(text).ok_or_else(|| no_member(drawn::<SamplerKind>()))?;
            kind.set_samples_per_pixel(desc.sampler.kind.samples_per_pixel());
            desc.sampler.kind = kind;
        }
        "filter" => {
            desc.filter.value = called(text).ok_or_else(|| no_member(drawn::<FilterDesc>()))?;
        }
        _ => {
            let (part, name) = find(key).ok_or(Unset::Unknown)?;
            let (settings, origin) = (part.of)(desc);
            let names =
                settings.set_text(name, text).map_err(|values| Unset::Value(format!("it is {values}")))?;
            if names.is_empty() {
                return Err(Unset::Value(format!("the scene's {} has no such setting", part.name)));
            }
            names.into_iter().for_each(|name| origin.set_parameter(name, span));
            // Errors about settings that depend on this one, and that are not given.
            origin.span = span;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use description::schema::Value;
    use description::{PathDesc, PhotonMappingDesc, RadiosityDesc, SppmDesc, VcmDesc};

    #[test]
    fn integrators_are_called_by_all_their_names() {
        assert!(integrator_names().contains(&"photon-mapping") && !integrator_names().contains(&"lightpath"));
        for (name, shown) in [
            ("vol-path", "vol-path"),
            ("volpath", "vol-path"),
            ("photonmapping", "photon-mapping"),
            ("lightpath", "light-tracing"),
        ] {
            assert_eq!(integrator_called(name, &IntegratorDesc::RayCasting).unwrap().name(), shown);
        }
        assert_eq!(integrator_called("functions", &IntegratorDesc::RayCasting), None);
    }

    #[test]
    fn the_same_integrator_keeps_all_that_was_set() {
        let sppm =
            SppmDesc { photons_per_iteration: Some(7), radius: Some(3.0), seed: Some(5), max_depth: 9 };
        let sppm = IntegratorDesc::Sppm(sppm);
        assert_eq!(integrator_called("sppm", &sppm), Some(sppm));
    }

    #[test]
    fn another_integrator_keeps_common_settings() {
        let mut photons =
            PhotonMappingDesc { max_depth: 9, radius: Some(3.0), ..PhotonMappingDesc::default() };
        let called = |photons: &PhotonMappingDesc, name| {
            integrator_called(name, &IntegratorDesc::PhotonMapping(*photons)).unwrap()
        };
        let vcm = VcmDesc { max_depth: 9, radius: Some(3.0), ..VcmDesc::default() };
        assert_eq!(called(&photons, "vcm"), IntegratorDesc::Vcm(vcm));
        let mut sppm = SppmDesc { max_depth: 9, radius: Some(3.0), ..SppmDesc::default() };
        assert_eq!(called(&photons, "sppm"), IntegratorDesc::Sppm(sppm), "no default goes over");
        photons.photons = 1000;
        photons.gather = 4;
        sppm.photons_per_iteration = Some(1000);
        assert_eq!(called(&photons, "sppm"), IntegratorDesc::Sppm(sppm));
        let back = integrator_called("photon-mapping", &IntegratorDesc::Sppm(sppm)).unwrap();
        assert_eq!(back, IntegratorDesc::PhotonMapping(PhotonMappingDesc { gather: 0, ..photons }));
        let radiosity = RadiosityDesc { max_depth: 9, gather: 4, ..RadiosityDesc::default() };
        assert_eq!(called(&photons, "radiosity"), IntegratorDesc::Radiosity(radiosity));
        photons.max_depth = 101;
        let radiosity = RadiosityDesc { gather: 4, ..RadiosityDesc::default() };
        assert_eq!(called(&photons, "radiosity"), IntegratorDesc::Radiosity(radiosity), "no depth of 101");
    }

    #[test]
    fn every_setting_takes_its_default_by_name_and_refuses_nonsense() {
        for part in &PARTS {
            for setting in part.groups().iter().flat_map(|group| &group.settings) {
                assert!(part.has(setting.field.name), "{}.{}", part.name, setting.field.name);
            }
        }
        for name in ["path", "sppm", "radiosity"] {
            let mut integrator = IntegratorDesc::called(name).unwrap();
            for setting in integrator.settings() {
                let (key, text) = (setting.field.name, setting.value.to_string());
                if setting.value != Value::Automatic {
                    assert_eq!(integrator.set_text(key, &text), Ok(vec![key]));
                }
                assert!(integrator.set_text(key, "nonsense").is_err(), "{key}");
            }
            assert_eq!(Some(integrator), IntegratorDesc::called(name));
        }
    }

    #[test]
    fn a_name_of_several_parts_means_the_first_unless_a_part_is_named() {
        let mut desc = SceneDesc::default();
        let mut set = |key, text| set(&mut desc, key, text, Span::NONE);
        assert_eq!(set("sigma", "2"), Err(Unset::Value("the scene's integrator has no such setting".into())));
        assert_eq!(set("filter.sigma", "2"), Ok(()));
        assert_eq!(set("filter.maxdepth", "2"), Err(Unset::Unknown));
        assert_eq!(set("film.iso", "0"), Err(Unset::Value("it is a number above 0".into())));
        assert_eq!(set("integrator.maxdepth", "2"), Ok(()));
        assert_eq!(desc.filter.value, FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 2.0 });
        let path = PathDesc { max_depth: 2, ..PathDesc::default() };
        assert_eq!(desc.integrator.value, IntegratorDesc::VolPath(path));
    }
}
