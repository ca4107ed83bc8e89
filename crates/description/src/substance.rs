//! Measured substances of the format: their coefficients of scattering and absorption.

/// A measured substance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substance {
    /// Reduced coefficient of scattering for red, green and blue of sRGB, in 1/mm.
    pub sigma_s: [f32; 3],
    /// Coefficient of absorption for the same, in 1/mm.
    pub sigma_a: [f32; 3],
}

const TABLE: &str = include_str!("../data/substances.txt");

/// The fields of each line of the table.
fn lines() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> + Clone {
    TABLE.lines().filter(|line| !line.starts_with('#')).filter_map(|line| {
        let (name, coefficients) = line.split_once(" | ")?;
        let (sigma_s, sigma_a) = coefficients.split_once(" | ")?;
        Some((name, sigma_s, sigma_a))
    })
}

impl Substance {
    /// The names of all.
    pub fn names() -> impl Iterator<Item = &'static str> + Clone {
        lines().map(|(name, ..)| name)
    }

    /// The substance of a name.
    pub fn named(name: &str) -> Option<Self> {
        let (_, sigma_s, sigma_a) = lines().find(|(known, ..)| *known == name)?;
        Some(Self { sigma_s: numbers(sigma_s)?, sigma_a: numbers(sigma_a)? })
    }
}

fn numbers(text: &str) -> Option<[f32; 3]> {
    let numbers: Vec<f32> = text.split(' ').map(str::parse).collect::<Result<_, _>>().ok()?;
    numbers.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_coefficients() {
        assert_eq!(Substance::names().count(), 47);
        for name in Substance::names() {
            let Substance { sigma_s, sigma_a } = Substance::named(name).unwrap();
            assert!([sigma_s, sigma_a].as_flattened().iter().all(|&c| (0.0..100.0).contains(&c)), "{name}");
        }
        assert_eq!(Substance::named("Potato").unwrap().sigma_a, [0.0024, 0.009, 0.12]);
        assert_eq!(Substance::named("potato"), None);
    }
}
