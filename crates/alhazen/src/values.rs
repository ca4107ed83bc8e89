//! Values of settings as text: as the command line gives them, and as reports tell them.

use description::{FormFactorsDesc, LightSamplerDesc, MltTechnique, PhotonKernel, PhotonMappingShow};

/// A place whose value can be told, and changed, by text.
pub(crate) trait Value {
    /// The value, as [`Self::set`] understands it; `None` where it is left to the algorithm.
    fn get(&self) -> Option<String>;

    /// Changes the value, or says what it has to be.
    fn set(&mut self, text: &str) -> Result<(), String>;
}

/// A value that stands elsewhere.
pub(crate) struct At<'a, T>(pub &'a mut T);

impl<T: Value> Value for At<'_, T> {
    fn get(&self) -> Option<String> {
        self.0.get()
    }

    fn set(&mut self, text: &str) -> Result<(), String> {
        self.0.set(text)
    }
}

macro_rules! parsed {
    ($($type:ty: $what:literal,)*) => {$(
        impl Value for $type {
            fn get(&self) -> Option<String> {
                Some(self.to_string())
            }

            fn set(&mut self, text: &str) -> Result<(), String> {
                *self = text.trim().parse().map_err(|_| concat!("it is ", $what))?;
                Ok(())
            }
        }
    )*};
}

parsed! {
    bool: "true or false",
    i32: "a whole number",
    f32: "a number",
}

impl<T: Value + Default> Value for Option<T> {
    fn get(&self) -> Option<String> {
        self.as_ref()?.get()
    }

    fn set(&mut self, text: &str) -> Result<(), String> {
        let mut value = T::default();
        value.set(text)?;
        *self = Some(value);
        Ok(())
    }
}

/// One of a few, which have names.
pub(crate) trait Choice: Copy + PartialEq + 'static {
    /// All with their names.
    const CHOICES: &'static [(&'static str, Self)];
}

impl<T: Choice> Value for T {
    fn get(&self) -> Option<String> {
        T::CHOICES.iter().find(|(_, value)| value == self).map(|(name, _)| (*name).to_owned())
    }

    fn set(&mut self, text: &str) -> Result<(), String> {
        *self = choose(text, T::CHOICES)?;
        Ok(())
    }
}

/// What has the name, or which names there are.
pub(crate) fn choose<T: Clone>(name: &str, choices: &[(&str, T)]) -> Result<T, String> {
    let chosen = choices.iter().find(|(known, _)| *known == name);
    chosen.map(|(_, value)| value.clone()).ok_or_else(|| {
        let names: Vec<_> = choices.iter().map(|&(name, _)| name).collect();
        format!("there are {}", names.join(", "))
    })
}

impl Choice for LightSamplerDesc {
    const CHOICES: &'static [(&'static str, Self)] = &[
        ("uniform", Self::Uniform),
        ("power", Self::Power),
        ("bvh", Self::Bvh),
        ("exhaustive", Self::Exhaustive),
    ];
}

impl Choice for FormFactorsDesc {
    const CHOICES: &'static [(&'static str, Self)] =
        &[("analytic", Self::Analytic), ("hemicube", Self::Hemicube)];
}

impl Choice for MltTechnique {
    const CHOICES: &'static [(&'static str, Self)] = &[("path", Self::Path), ("bdpt", Self::Bdpt)];
}

impl Choice for PhotonKernel {
    const CHOICES: &'static [(&'static str, Self)] =
        &[("cone", Self::Cone), ("epanechnikov", Self::Epanechnikov)];
}

impl Choice for PhotonMappingShow {
    const CHOICES: &'static [(&'static str, Self)] =
        &[("radiance", Self::Radiance), ("photons", Self::Photons)];
}

/// Flags that are one to the command line.
pub(crate) struct Flags<'a>(pub [&'a mut bool; 2]);

impl Value for Flags<'_> {
    fn get(&self) -> Option<String> {
        self.0.iter().any(|flag| **flag).get()
    }

    fn set(&mut self, text: &str) -> Result<(), String> {
        self.0.iter_mut().try_for_each(|flag| flag.set(text))
    }
}

/// The name of a PLY file.
pub(crate) struct PlyFile<'a>(pub &'a mut Option<String>);

impl Value for PlyFile<'_> {
    fn get(&self) -> Option<String> {
        self.0.clone()
    }

    fn set(&mut self, text: &str) -> Result<(), String> {
        if !text.ends_with(".ply") {
            return Err("its name ends in .ply".into());
        }
        *self.0 = Some(text.into());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_is_understood() {
        fn check<T: Value + Default>(texts: &[&str]) {
            for text in texts {
                let mut value = T::default();
                value.set(text).unwrap();
                assert_eq!(value.get().as_deref(), Some(*text));
            }
            assert!(T::default().set("nonsense").is_err());
        }
        check::<bool>(&["true", "false"]);
        check::<i32>(&["-3", "0", "2147483647"]);
        check::<f32>(&["0.3", "inf", "0.0000001", "-2"]);
        check::<Option<f32>>(&["0.25"]);
        check::<LightSamplerDesc>(&["uniform", "power", "bvh", "exhaustive"]);
        assert_eq!(None::<i32>.get(), None);
    }
}
