//! A film for each strategy of bidirectional path tracing, unweighted, weighted, or both.
//!
//! All of them are films of splats, on which each of n paths has the weight 1/n; the sample of a
//! pixel is one of as many paths as there are pixels, and is added to that pixel. Each film takes
//! 36 bytes per pixel; 52 of them, weighted and unweighted for paths of up to 5 scattering events,
//! are 1.8 KiB per pixel. More than 2 GiB are refused.

use film::{Film, SPLAT_BYTES, Splatter};
use image::ImageError;
use spectrum::SampledSpectrum;

use crate::bidirectional::Found;

/// Longer paths have no films, as the number of strategies grows with the square of the depth.
pub(crate) const MAX_DEPTH: u32 = 8;

/// Limit on the memory of all films.
pub(crate) const MAX_BYTES: usize = 2 << 30;

/// The films.
#[derive(Debug)]
pub(super) struct Techniques {
    max_depth: u32,
    unweighted: Option<Vec<Film>>,
    weighted: Option<Vec<Film>>,
}

impl Techniques {
    /// The requested films of paths with up to `max_depth` scattering events.
    pub fn new(max_depth: u32, unweighted: bool, weighted: bool) -> Self {
        let max_depth = max_depth.min(MAX_DEPTH);
        Self { max_depth, unweighted: unweighted.then(Vec::new), weighted: weighted.then(Vec::new) }
    }

    /// Memory of the films of `pixels` pixels, in bytes.
    pub fn bytes(&self, pixels: usize) -> usize {
        let kinds = self.unweighted.iter().chain(&self.weighted).count();
        (kinds * strategies(self.max_depth).count()).saturating_mul(pixels.saturating_mul(SPLAT_BYTES))
    }

    /// Opens the films for splatting; missing ones are created with the size and settings of
    /// `film`. An error if there is no memory for them.
    pub fn open(&mut self, film: &Film) -> Result<Splatters<'_>, ImageError> {
        let count = strategies(self.max_depth).count();
        Ok(Splatters {
            unweighted: splatters(&mut self.unweighted, count, film)?,
            weighted: splatters(&mut self.weighted, count, film)?,
        })
    }

    /// The films with their names; none before the first pass.
    pub fn films(&self) -> impl Iterator<Item = (String, &Film)> {
        let kinds = [(&self.unweighted, ""), (&self.weighted, "-weighted")];
        kinds.into_iter().flat_map(|(films, suffix)| {
            let named = films.iter().flatten().zip(strategies(self.max_depth));
            named.map(move |(film, (s, t))| (format!("s{s}-t{t}{suffix}"), film))
        })
    }

    /// Continues with films from [`films`](Self::films).
    pub fn set_films(&mut self, films: Vec<(String, Film)>) {
        let mut films = films.into_iter().map(|(_, film)| film);
        let count = strategies(self.max_depth).count();
        for kind in self.unweighted.iter_mut().chain(&mut self.weighted) {
            *kind = films.by_ref().take(count).collect();
        }
    }
}

fn splatters<'film>(
    films: &'film mut Option<Vec<Film>>,
    count: usize,
    like: &Film,
) -> Result<Vec<Splatter<'film>>, ImageError> {
    let Some(films) = films else { return Ok(Vec::new()) };
    if films.is_empty() {
        *films = (0..count).map(|_| like.for_splats()).collect::<Result<_, _>>()?;
    }
    films.iter_mut().map(|film| Ok(film.tiles_and_splatter()?.1)).collect()
}

/// The films during a pass.
pub(super) struct Splatters<'film> {
    unweighted: Vec<Splatter<'film>>,
    weighted: Vec<Splatter<'film>>,
}

impl Splatters<'_> {
    /// Adds light to the films of the strategy that found it.
    pub fn add(&self, found: &Found, add: impl Fn(&Splatter, &SampledSpectrum)) {
        let index = index(found.s, found.t);
        if let Some(splatter) = self.unweighted.get(index) {
            add(splatter, &found.l);
        }
        if let Some(splatter) = self.weighted.get(index) {
            add(splatter, &found.weighted());
        }
    }

    /// Counts a path.
    pub fn add_path(&self) {
        self.unweighted.iter().chain(&self.weighted).for_each(|splatter| splatter.add_paths(1));
    }
}

/// All (s, t) of paths with up to `max_depth` scattering events, the shortest paths first. Every
/// path has a vertex on the camera. Direct views of lights have one strategy only.
fn strategies(max_depth: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..=max_depth).flat_map(|depth| {
        let most = if depth == 0 { 0 } else { depth + 1 };
        (0..=most).map(move |s| (s, depth + 2 - s))
    })
}

/// The index of a strategy.
fn index(s: u32, t: u32) -> usize {
    let depth = s + t - 2;
    let shorter = if depth == 0 { 0 } else { 1 + (depth - 1) * (depth + 4) / 2 };
    (shorter + s) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_of_strategies_are_consecutive() {
        let all: Vec<_> = strategies(4).collect();
        assert_eq!(all[..5], [(0, 2), (0, 3), (1, 2), (2, 1), (0, 4)]);
        for (place, &(s, t)) in all.iter().enumerate() {
            assert_eq!(index(s, t), place, "{s} {t}");
        }
    }

    #[test]
    fn each_film_takes_36_bytes_per_pixel() {
        for (max_depth, films) in [(0, 1), (1, 4), (5, 26), (8, 53), (100, 53)] {
            assert_eq!(Techniques::new(max_depth, true, false).bytes(10), films * 360);
            assert_eq!(Techniques::new(max_depth, true, true).bytes(10), 2 * films * 360);
        }
        assert_eq!(Techniques::new(5, false, false).bytes(10), 0);
    }
}
